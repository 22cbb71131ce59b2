"""An arm in MuJoCo as the remote machine of a teleoperation, for a leader elsewhere.

It presses on a wall, opens a drawer or puts a peg into a hole. The arm's own controller holds the
tool upright and follows the target with a spring and a damper; the package has the other half of the
method, the limits and the watchdog. Needs the packages hapticgiant and mujoco.

    python examples/python/mujoco_remote.py drawer --listen 127.0.0.1:4820 --fast
    hapticgiant run remote_arm --user remote_drawer --fast --no-viewer \\
        --set scenario.teleoperation.remote.udp=127.0.0.1:4820
"""

import argparse
import json
import time

import mujoco
import numpy as np

from hapticgiant.remote import RemoteServer

STEPS = 1  # of the simulation per period
STIFFNESS, DAMPING = 5000.0, 200.0  # of the arm's controller, N/m and Ns/m
TURN_STIFFNESS, TURN_DAMPING = 200.0, 8.0  # the same for its orientation, Nm/rad
FORCE_MAX = 80.0  # N along each axis
POSTURE = [0.0, 0.6, 1.4, np.pi - 2.0, 0.0, 0.0]  # the tool points down
RADIUS = 0.01  # of the tool, m
LOWEST, HIGHEST = [0.3, -0.35, 0.1], [0.8, 0.35, 0.6]  # range of the tip, m

ARM = """
<mujoco>
  <option timestep="{step}" integrator="implicitfast" cone="elliptic" impratio="10"/>
  <default>
    <joint armature="0.05" damping="0.5"/>
    <geom contype="0" conaffinity="0" rgba="0.75 0.75 0.78 1"/>
    <default class="touch">
      <geom contype="1" conaffinity="1" friction="0.2 0.005 0.0001" solref="0.02 1" rgba="0.8 0.55 0.3 1"/>
    </default>
  </default>
  <worldbody>
    <light pos="0 0 3"/>
    <body name="turret"><joint axis="0 0 1"/>
      <geom type="cylinder" fromto="0 0 0 0 0 0.3" size="0.06" mass="4"/>
      <body name="upper" pos="0 0 0.3"><joint axis="0 1 0"/>
        <geom type="capsule" fromto="0 0 0 0 0 0.4" size="0.045" mass="3"/>
        <body name="fore" pos="0 0 0.4"><joint axis="0 1 0"/>
          <geom type="capsule" fromto="0 0 0 0 0 0.4" size="0.035" mass="2"/>
          <body name="wrist" pos="0 0 0.4"><joint axis="0 1 0"/>
            <geom type="sphere" size="0.03" mass="0.4"/>
            <body name="wrist2"><joint axis="1 0 0"/>
              <geom type="sphere" size="0.028" mass="0.3"/>
              <body name="tool"><joint axis="0 0 1"/>
                <geom type="cylinder" fromto="0 0 0 0 0 0.08" size="0.02" mass="0.3"/>
                <geom name="tip" class="touch" type="capsule" fromto="0 0 0.09 0 0 0.15" size="{radius}"
                  mass="0.1"/>
                <site name="tip" pos="0 0 0.15"/>
              </body></body></body></body></body></body>
    {scene}
  </worldbody>
</mujoco>
"""


def box(pos, size, more=""):
    numbers = " ".join(f"{x:.6g}" for x in (*pos,)), " ".join(f"{x:.6g}" for x in size)
    return f'<geom class="touch" type="box" pos="{numbers[0]}" size="{numbers[1]}" {more}/>'


def wall(p):
    return box(p + [0.0, 0.2 + RADIUS + 0.05, 0.0], [0.2, 0.05, 0.2])


def drawer(p):
    """Its handle is two bars, between which the tool is."""
    bars = "".join(box([0.0, y, 0.0], [0.05, 0.005, 0.03], 'mass="0.1"') for y in (-0.025, 0.025))
    front = box([0.0, 0.1, -0.05], [0.15, 0.01, 0.015], 'mass="1.5" contype="0" conaffinity="0"')
    return (f'<body name="drawer" pos="{p[0]} {p[1]} {p[2] + 0.02}"><joint name="drawer" type="slide" '
            f'axis="0 -1 0" range="0 0.2" limited="true" damping="10" frictionloss="4" armature="0"/>'
            f"{bars}{front}</body>")


def peg(p):
    """A hole to the left, below the tool, with a rim that guides: 2.5 mm wider than the peg."""
    half, wide, top = RADIUS + 0.0025, 0.08, p[2] - 0.06
    geoms = []
    for x, y, turn in ((1, 0, "0 -45 0"), (-1, 0, "0 45 0"), (0, 1, "45 0 0"), (0, -1, "-45 0 0")):
        side = np.array([x, y, 0.0])
        middle = np.array([p[0], p[1] + 0.1, top - 0.045])
        along = np.array([wide if x == 0 else wide / 2, wide if y == 0 else wide / 2, 0.03])
        geoms.append(box(middle + side * (half + wide / 2), along))
        rim = middle + side * (half + 0.0155) + [0.0, 0.0, 0.045 - 0.0035]
        size = [0.003 if x else 0.03, 0.003 if y else 0.03, 0.022]
        geoms.append(box(rim, size, f'euler="{turn}"'))
    return "".join(geoms)


SCENES = {"wall": wall, "drawer": drawer, "peg": peg}


class Arm:
    """The arm and what it meets; one call of live() is one period."""

    def __init__(self, task, period_s):
        self.task = task
        bare = mujoco.MjModel.from_xml_string(ARM.format(step=period_s / STEPS, radius=RADIUS, scene=""))
        at = mujoco.MjData(bare)
        at.qpos[:6] = POSTURE
        mujoco.mj_forward(bare, at)
        start = np.array(at.site("tip").xpos)
        scene = SCENES[task](start)
        self.model = mujoco.MjModel.from_xml_string(
            ARM.format(step=period_s / STEPS, radius=RADIUS, scene=scene))
        self.data = mujoco.MjData(self.model)
        self.data.qpos[:6] = POSTURE
        mujoco.mj_forward(self.model, self.data)
        self.site, self.tip = self.model.site("tip").id, self.model.geom("tip").id
        self.start, self.upright = start, np.array(self.data.site("tip").xmat).reshape(3, 3)
        self.jacobian = np.zeros((3, self.model.nv)), np.zeros((3, self.model.nv))
        self.force, self.mass = np.zeros(3), self.mass_of_tip()
        self.period_s = period_s
        self.force_max = self.pressed_s = self.distance = 0.0

    def mass_of_tip(self):
        """Mean of what a push at the tip has to move, kg."""
        mujoco.mj_jacSite(self.model, self.data, *self.jacobian, self.site)
        full = np.zeros((self.model.nv, self.model.nv))
        mujoco.mj_fullM(self.model, self.data, full)
        moves = self.jacobian[0] @ np.linalg.solve(full, self.jacobian[0].T)
        return float(3.0 / np.trace(moves))

    def state(self):
        """Position, velocity and force of the surroundings."""
        mujoco.mj_jacSite(self.model, self.data, *self.jacobian, self.site)
        return np.array(self.data.site_xpos[self.site]), self.jacobian[0] @ self.data.qvel, self.force

    def live(self, x_target, v_target, f_target):
        force = np.zeros(3)
        for step in range(STEPS):
            x, v, _ = self.state()
            push = STIFFNESS * (x_target - x) + DAMPING * (v_target - v) + f_target
            push = np.clip(push, -FORCE_MAX, FORCE_MAX)
            rotation = np.array(self.data.site_xmat[self.site]).reshape(3, 3)
            error = sum(np.cross(rotation[:, i], self.upright[:, i]) for i in range(3)) / 2.0
            turn = TURN_STIFFNESS * error - TURN_DAMPING * (self.jacobian[1] @ self.data.qvel)
            torque = self.jacobian[0].T @ push + self.jacobian[1].T @ turn
            self.data.qfrc_applied[:6] = (torque + self.data.qfrc_bias)[:6]
            mujoco.mj_step(self.model, self.data)
            force += self.contact_force() / STEPS
        self.force = force
        self.judge()

    def contact_force(self):
        total, one = np.zeros(3), np.zeros(6)
        for i in range(self.data.ncon):
            contact = self.data.contact[i]
            if self.tip not in (contact.geom1, contact.geom2):
                continue
            mujoco.mj_contactForce(self.model, self.data, i, one)
            along = contact.frame.reshape(3, 3).T @ one[:3]  # on geom2
            total += along if contact.geom2 == self.tip else -along
        return total

    def judge(self):
        force = float(np.linalg.norm(self.force))
        self.force_max = max(self.force_max, force)
        if force > 3.0:
            self.pressed_s += self.period_s
        tip = self.data.site_xpos[self.site]
        if self.task == "wall":  # depth of the tip in the wall
            self.distance = max(self.distance, float(tip[1] - self.start[1] - 0.2))
        elif self.task == "drawer":
            self.distance = max(self.distance, float(self.data.joint("drawer").qpos[0]))
        else:  # depth of the tip in the hole
            self.distance = max(self.distance, float(self.start[2] - 0.06 - tip[2] + RADIUS))

    def result(self):
        """By what the simulation knows."""
        is_done = {"wall": self.pressed_s > 1.0 and self.distance < 0.005,
                   "drawer": self.distance > 0.12, "peg": self.distance > 0.04}[self.task]
        return {"task": self.task, "success": bool(is_done), "force_max_N": round(self.force_max, 2),
                "pressed_s": round(self.pressed_s, 2), "distance_m": round(self.distance, 4)}


def serve(server, arm, arguments):
    """One leader after the other; the arm stays where the last one has left it."""
    period_s = 1.0 / arguments.rate_hz
    due_s = time.monotonic()
    had_leader = False
    while True:
        target = server.step(*(v.tolist() for v in arm.state()))
        if target is not None:
            arm.live(*(np.array(v) for v in target))
        news = server.news()
        if news:
            print(news, end="", flush=True)
        if had_leader and not server.has_leader:
            print(json.dumps(arm.result()), flush=True)
            if arguments.once:
                return
        had_leader = server.has_leader
        if not arguments.fast:
            due_s = max(due_s + period_s, time.monotonic() - 0.01)
            time.sleep(max(0.0, due_s - time.monotonic()))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("task", choices=sorted(SCENES))
    parser.add_argument("--listen", metavar="HOST:PORT", required=True)
    parser.add_argument("--fast", action="store_true", help="lock-step instead of real time")
    parser.add_argument("--once", action="store_true", help="until the first leader has left")
    parser.add_argument("--rate-hz", type=float, default=1000.0)
    parser.add_argument("--key-file", default="", help="the secret that leaders must have, too")
    arguments = parser.parse_args()
    arm = Arm(arguments.task, 1.0 / arguments.rate_hz)
    server = RemoteServer(arguments.listen, LOWEST, HIGHEST, mass=arm.mass, stiffness=STIFFNESS,
                          damping=DAMPING, force=FORCE_MAX, rate_Hz=arguments.rate_hz,
                          is_lock_step=arguments.fast, key_file=arguments.key_file,
                          server="mujoco_remote.py")
    print(f"{arguments.task} at {server.address}, {arm.mass:.2f} kg at the tip", flush=True)
    try:
        serve(server, arm, arguments)
    except KeyboardInterrupt:
        pass


if __name__ == "__main__":
    main()
