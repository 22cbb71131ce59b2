"""What the simulated machine does beyond springs and Coulomb friction, against MuJoCo.

One joint on a carriage that yields: MuJoCo's own springs, dampers and friction loss; backlash is
the dead band of a tendon. Cogging and the two elements of Maxwell slip are torques that are worked
out here from their equations. Arguments: the program plant_trajectory. Exits with 77 where MuJoCo is
missing.
"""

import math
import subprocess
import sys
import unittest

SKIPPED = 77
MASK = 2**64 - 1
STEP = 2e-5  # s
INTERVAL = 1e-3
# both are of first order in the step, and a stuck motor of MuJoCo creeps
TOLERANCE = 0.01

try:
    import mujoco
    import numpy as np
except ImportError as error:
    print(f"{error}: pip install -r tools/requirements-test.txt")
    sys.exit(SKIPPED)

MODEL = """
<mujoco>
  <option timestep="{step}" gravity="0 0 0" integrator="implicit" solver="Newton" iterations="50"
    tolerance="1e-12"/>
  <worldbody>
    <body name="carriage">
      <joint name="sway" type="slide" axis="1 0 0" stiffness="2e5" damping="100"/>
      <inertial pos="0 0 0" mass="20" diaginertia="1 1 1"/>
      <body name="link">
        <joint name="turn" type="hinge" axis="0 0 1"/>
        <inertial pos="0.3 0 0" mass="4" diaginertia="0.1 0.1 0.1"/>
      </body>
      <body name="rotor">
        <joint name="motor" type="hinge" axis="0 0 1" damping="1" armature="0.5"
          frictionloss="{friction}" solreffriction="2e-4 1" solimpfriction="0.9999 0.9999 0.001"/>
        <inertial pos="0 0 0" mass="1e-6" diaginertia="1e-8 1e-8 1e-8"/>
      </body>
    </body>
  </worldbody>
  <tendon>
    <fixed name="gear" stiffness="3000" damping="{damping}" springlength="{play}">
      <joint joint="motor" coef="1"/>
      <joint joint="turn" coef="-1"/>
    </fixed>
  </tendon>
</mujoco>
"""


class MaxwellSlip:
    """A spring in series with Coulomb friction, with a damper beside the spring."""

    def __init__(self, friction, stiffness, damping):
        self.friction, self.stiffness, self.damping = friction, stiffness, damping
        self.way = 0.0

    def force(self, speed):
        stuck = -(self.stiffness * (self.way + STEP * speed) + self.damping * speed)
        force = min(max(stuck, -self.friction), self.friction)
        give = STEP * self.stiffness + self.damping
        self.way += STEP * -(force + self.stiffness * self.way) / give
        return force


def mixed(z):
    """SplitMix64, as in hg/simulator/random_stream.h."""
    z = (z + 0x9E3779B97F4A7C15) & MASK
    z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
    z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
    return z ^ (z >> 31)


def cogging_phase(seed):
    state = mixed((mixed(seed) + mixed(16 * 256)) & MASK)
    return 2.0 * math.pi * (mixed(state) >> 11) * 2.0**-53


def theirs(effect):
    play = 2e-3 if effect == "backlash" else 0.0
    model = mujoco.MjModel.from_xml_string(MODEL.format(
        step=STEP, friction=3.0 if effect == "friction" else 0.0,
        damping=0.0 if effect == "backlash" else 5.0, play=f"{-play} {play}"))
    data = mujoco.MjData(model)
    sway, turn, motor = (model.joint(name).qposadr[0] for name in ("sway", "turn", "motor"))
    data.qpos[turn], data.qpos[motor] = 0.7, 0.7 + play
    presliding, hysteresis = MaxwellSlip(3.0, 5e3, 5.0), MaxwellSlip(2.0, 3e3, 0.0)
    phase = cogging_phase(1)
    rows = []
    for k in range(round(1.0 / STEP)):
        if k % round(INTERVAL / STEP) == 0:
            rows.append([k * STEP, data.qpos[sway], data.qpos[turn], data.qpos[motor]])
        torque = 12.0 * math.sin(2.0 * math.pi * 3.0 * k * STEP)
        slip = data.qvel[motor] - data.qvel[turn]
        data.qfrc_applied[:] = 0.0
        if effect == "cogging":
            torque += 1.5 * math.sin(60.0 * data.qpos[motor] + phase)
        if effect == "presliding":
            torque += presliding.force(data.qvel[motor])
        if effect == "hysteresis":
            force = hysteresis.force(slip)
            torque += force
            data.qfrc_applied[turn] -= force
        if effect == "backlash":  # the damper is in the teeth, and never pulls
            twist = data.qpos[motor] - data.qpos[turn]
            depth = max(abs(twist) - play, 0.0)
            if depth > 0.0:
                side = math.copysign(1.0, twist)
                push = max(5.0 * slip * side, -3000.0 * depth) * side
                torque -= push
                data.qfrc_applied[turn] += push
        data.qfrc_applied[motor] += torque
        mujoco.mj_step(model, data)
    return np.array(rows)


class SameJoint(unittest.TestCase):
    def compare(self, effect):
        text = subprocess.run([PROGRAM, effect, str(STEP)], capture_output=True, text=True,
                              check=True).stdout
        ours = np.array([[float(x) for x in line.split(",")] for line in text.splitlines()])
        judge = theirs(effect)
        self.assertEqual(ours.shape, judge.shape)
        for column, name in ((1, "sway"), (2, "link"), (3, "motor")):
            error = np.abs(ours[:, column] - judge[:, column]).max()
            span = np.ptp(judge[:, column])
            with self.subTest(effect=effect, of=name):
                print(f"{effect:10s} {name:5s} differs by {error / span:.2%} of {span:.3g}")
                self.assertLess(error, TOLERANCE * span)
        return ours

    def test_springs(self):
        self.compare("none")

    def test_friction(self):
        self.compare("friction")

    def test_presliding(self):
        self.compare("presliding")

    def test_backlash(self):
        self.compare("backlash")

    def test_cogging(self):
        self.compare("cogging")

    def test_hysteresis(self):
        self.compare("hysteresis")

    def test_effects_matter(self):
        def columns(effect):
            rows = theirs(effect)
            return np.column_stack([rows[:, 1:], rows[:, 2] - rows[:, 3]])

        plain = columns("none")
        for effect in ("friction", "presliding", "backlash", "hysteresis", "cogging"):
            change = np.abs(columns(effect) - plain).max(axis=0) / np.ptp(plain, axis=0)
            with self.subTest(effect=effect):
                self.assertGreater(change.max(), 5 * TOLERANCE)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
