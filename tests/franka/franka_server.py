"""franka-sim's server with our arm, a hand at its grip, and an estimate of the hand's wrench.

    franka_server.py URDF --port N [--pull N] [--away RAD] [--estimate weight|opposite|none]
                     [--torque-rate NM_PER_S] [--without-time-limits] [--in-reflex]
                     [--counts FILE]

Runs in the environment that franka_test.py makes. The model is made from the numbers of our URDF,
without meshes; a tool of 0.35 kg is part of it. Its joints start --away from where the drawer is
held. Without time limits a busy computer does not make it stop for late commands. The hand pulls
along x of the base for two seconds and pushes back for two, 1.5 s after a motion has begun and every
8 s from then on.
With --in-reflex it stands in an old reflex when a client comes. The file of --counts says after a
motion how many cycles it had and how many were not answered in time.
"""

import argparse
import contextlib
import json
import logging
import math
import os
import pathlib
import sys
import time
import xml.etree.ElementTree as ET

import mujoco
import numpy as np

POSTURE = [0.0, 0.028, 0.0, -2.091, 0.0, 2.119, 0.0]  # of fci.yaml
ARMATURE = [0.1, 0.1, 0.1, 0.1, 0.05, 0.05, 0.05]  # kg m^2
FRICTION = [0.5, 0.5, 0.5, 0.5, 0.3, 0.3, 0.3]  # Nm
FLANGE = 0.107  # m behind the last joint
HANDLE = 0.09  # m behind the flange
TOOL = {"mass": "0.35", "pos": f"0 0 {FLANGE + 0.08}", "diaginertia": "0.0008 0.0008 0.0001"}
CARTESIAN_REFLEX = 7  # number of this error
NOISE = 0.02  # N and Nm, of the estimate


def quaternion(rpy):
    r, p, y = (float(value) / 2 for value in rpy.split())
    cr, sr, cp, sp, cy, sy = (f(a) for a in (r, p, y) for f in (math.cos, math.sin))
    return (f"{cr * cp * cy + sr * sp * sy} {sr * cp * cy - cr * sp * sy} "
            f"{cr * sp * cy + sr * cp * sy} {cr * cp * sy - sr * sp * cy}")


def mjcf_of(urdf):
    """The seven joints of a URDF as MJCF: frames, inertias, limits, friction."""
    robot = ET.parse(urdf).getroot()
    root = ET.Element("mujoco", model="fr3")
    ET.SubElement(root, "compiler", angle="radian")
    body = ET.SubElement(ET.SubElement(root, "worldbody"), "body", name="fr3_link0")
    for i in range(1, 8):
        joint = robot.find(f"joint[@name='fr3_joint{i}']")
        origin, limit = joint.find("origin"), joint.find("limit")
        body = ET.SubElement(body, "body", name=f"fr3_link{i}", pos=origin.get("xyz"),
                             quat=quaternion(origin.get("rpy", "0 0 0")))
        ET.SubElement(body, "joint", name=f"fr3_joint{i}", axis="0 0 1",
                      range=f"{limit.get('lower')} {limit.get('upper')}",
                      armature=str(ARMATURE[i - 1]), frictionloss=str(FRICTION[i - 1]))
        inertial = robot.find(f"link[@name='fr3_link{i}']/inertial")
        values = [inertial.find("inertia").get(name)
                  for name in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")]
        ET.SubElement(body, "inertial", pos=inertial.find("origin").get("xyz"),
                      mass=inertial.find("mass").get("value"), fullinertia=" ".join(values))
    ET.SubElement(ET.SubElement(body, "body", name="tool"), "inertial", TOOL)
    return ET.tostring(root, encoding="unicode")


def pull_after(since, force):
    """What a hand does, N, `since` s after a motion has begun: with `force` to and fro, again and
    again."""
    since = -1.0 if since < 1.5 else (since - 1.5) % 8.0
    sign = 1.0 if 0.0 <= since < 2.0 else -1.0 if 2.0 <= since < 4.0 else 0.0
    return sign * force


def before_other_programs():
    """Runs before other programs, where that is allowed."""
    with contextlib.suppress(OSError):
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(5))


def make_simulation(options):
    from franka_sim import mujoco_franka_sim
    from franka_sim.control_modes import ControlMode

    mujoco_franka_sim.ARM_INITIAL_Q = np.array(POSTURE) + options.away

    class HeldArm(mujoco_franka_sim.MujocoFrankaSim):
        """The arm of the simulator with a hand at its grip."""

        began = None
        load = 0.0  # kg, that the robot knows of
        noise = np.random.default_rng(1)

        def pull(self):
            if self.control_mode not in (ControlMode.TORQUE, ControlMode.VELOCITY):
                self.began = None
                return np.zeros(3)
            if self.began is None:
                self.began = self.data.time
            return pull_after(self.data.time - self.began, np.array([options.pull, 0.0, 0.0]))

        def run_simulation(self):
            """Nothing: the server below steps, one period per state that it sends."""
            self._read_and_publish_state()
            while self.running:
                time.sleep(0.05)

        def _apply_control(self):
            super()._apply_control()
            self.data.xfrc_applied[:] = 0.0
            force = self.pull()
            rotation = self.data.xmat[self.ee_body_id].reshape(3, 3)
            # at the centre of mass of the last link, about which MuJoCo takes torques
            grip = self.data.xpos[self.ee_body_id] + rotation[:, 2] * (FLANGE + HANDLE)
            arm = grip - self.data.xipos[self.ee_body_id]
            self.data.xfrc_applied[self.ee_body_id] = np.hstack((force, np.cross(arm, force)))

        def _read_and_publish_state(self):
            super()._read_and_publish_state()
            rotation = self.data.xmat[self.ee_body_id].reshape(3, 3)
            force = rotation.T @ self.pull()
            of_hand = np.hstack((force, np.cross([0.0, 0.0, HANDLE], force)))
            unknown = rotation.T @ [0.0, 0.0, -9.81 * (float(TOOL["mass"]) - self.load)]
            of_hand += np.hstack((unknown, np.cross([0.0, 0.0, 0.08], unknown)))
            if options.estimate == "opposite":
                of_hand = -of_hand
            # of the robot on its surroundings, at the flange and resolved in it
            of_robot = -of_hand + NOISE * self.noise.standard_normal(6)
            in_base = np.hstack((rotation @ of_robot[:3], rotation @ of_robot[3:]))
            flange = self.data.xpos[self.ee_body_id] + rotation[:, 2] * FLANGE
            jacobian = np.zeros((6, self.model.nv))
            mujoco.mj_jac(self.model, self.data, jacobian[:3], jacobian[3:], flange, self.ee_body_id)
            tau_ext = (jacobian.T @ in_base)[self.arm_dofs_idx]
            if options.estimate == "weight":  # as franky-sim
                tau_ext = tau_ext + self.data.qfrc_bias[self.arm_dofs_idx]
            if options.estimate != "none":
                self._state_snapshot.update(tau_ext_hat_filtered=tau_ext, O_F_ext_hat_K=in_base,
                                            K_F_ext_hat_K=of_robot)

    return HeldArm()


def limits_of_franka_sim(torque_rate):
    """A robot that stops itself at smaller steps of torque than a Franka, so that one happens."""
    from franka_sim.limits import checker, tables

    tables.MAX_TORQUE_RATE = checker.MAX_TORQUE_RATE = (torque_rate,) * 7


def make_server(options):
    from franka_sim import FrankaSimServer
    from franka_sim.server.constants import RobotMode

    counts = {"cycles": 0, "unanswered": 0, "in_a_row": 0}  # while torques were expected

    class InStep(FrankaSimServer):
        """Of a busy computer the threads of physics and states drift apart; on a robot they cannot."""

        def _publish_elbow(self, sim_state):
            super()._publish_elbow(sim_state)
            self.physics_sim.load = self.robot_state.state["m_load"]
            self.physics_sim.step()

        def start_robot_state_transmission(self, *client):
            if options.in_reflex:
                self.robot_state.state.update(robot_mode=RobotMode.kReflex,
                                              errors=[i == CARTESIAN_REFLEX for i in range(41)])
            super().start_robot_state_transmission(*client)

        def _account_for_communication_cycle(self):
            super()._account_for_communication_cycle()
            comm = self.comm
            if options.counts and comm.active:
                counts["cycles"] += 1
                counts["unanswered"] += comm.consecutive_lost > 0
                counts["in_a_row"] = max(counts["in_a_row"], comm.consecutive_lost)
            elif options.counts and counts["cycles"] and not options.counts.exists():
                options.counts.write_text(json.dumps(counts))

    return InStep(host="127.0.0.1", port=options.port, physics_sim=make_simulation(options),
                  enable_gripper=False, enforce_comm_constraints=not options.without_time_limits,
                  enforce_motion_limits=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("urdf")
    parser.add_argument("--port", type=int, required=True)
    parser.add_argument("--pull", type=float, default=0.0)
    parser.add_argument("--away", type=float, default=0.0)
    parser.add_argument("--without-time-limits", action="store_true")
    parser.add_argument("--estimate", choices=("hand", "weight", "opposite", "none"), default="hand")
    parser.add_argument("--torque-rate", type=float)
    parser.add_argument("--in-reflex", action="store_true")
    parser.add_argument("--counts", type=pathlib.Path)
    options = parser.parse_args()
    logging.basicConfig(level=logging.WARNING)
    model = pathlib.Path(sys.prefix, "fr3.xml")
    model.write_text(mjcf_of(options.urdf), encoding="utf-8")
    os.environ["FR3_MJCF"] = str(model)
    before_other_programs()
    if options.torque_rate:
        limits_of_franka_sim(options.torque_rate)
    make_server(options).start()


if __name__ == "__main__":
    main()
