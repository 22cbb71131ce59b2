"""franky-sim's server with a tool, a hand at its grip, and an estimate of the hand's wrench.

    franky_server.py [--pull X_N Y_N] [--posture Q1 ... Q7]

At 127.0.0.1:1337. Runs in the environment that franka_test.py makes. Arm, physics and protocol are
franky-sim's; its gripper is our tool, of the same mass, and no end effector that the robot knows. The
frame in which the estimate is given is neither flange nor grip, and turned about all axes, so that a
driver which mistakes it feels another hand. The hand does what that of franka_server.py does.
"""

import argparse
import logging

import mujoco
import numpy as np
from franka_server import (FLANGE, HANDLE, NOISE, POSTURE, TOOL, before_other_programs, pull_after)
from franky_sim import SimulationServer, mujoco_simulator
from franky_sim.base_simulator import RobotParameters

MASS = float(TOOL["mass"])  # kg
CENTRE = 0.08  # m behind the flange
FINGERS, FINGERS_AT = 0.03, 0.0584  # kg, m: of the gripper
NO_MASS = 1e-3  # kg, franky-sim divides by it
# of its own joint control; with its own values the last joint shakes by 0.08 rad/s
STIFFNESS = (*mujoco_simulator.MUJOCO_DEFAULT_KP[:6], 500.0)  # Nm/rad
DAMPING = (*mujoco_simulator.MUJOCO_DEFAULT_KV[:6], 50.0)  # Nms/rad
FRAME_TURNED = (0.5, -0.4, 2.5)  # rad, roll, pitch and yaw in the flange


class HeldRobot(mujoco_simulator.FrankaMujocoRobot):
    """The robot of the simulator with a hand at its grip."""

    pull_N = np.zeros(3)  # in the base
    began = None  # s
    noise = np.random.default_rng(1)

    def _attach_to_scene(self, model, data, prefix):
        super()._attach_to_scene(model, data, prefix)
        self.wrist = model.body(f"{prefix}fr3_link7").id

    def pull(self):
        if not self.server.current_motion_id:
            self.began = None
            return np.zeros(3)
        if self.began is None:
            self.began = self.data.time
        return pull_after(self.data.time - self.began, self.pull_N)

    def _pre_step(self):
        super()._pre_step()
        force = self.pull()
        # at the centre of mass of the last link, about which MuJoCo takes torques
        arm = self._behind_flange(HANDLE) - self.data.xipos[self.wrist]
        self.data.xfrc_applied[self.wrist] = np.hstack((force, np.cross(arm, force)))

    def _behind_flange(self, distance):
        rotation = self.data.xmat[self.wrist].reshape(3, 3)
        return self.data.xpos[self.wrist] + rotation[:, 2] * (FLANGE + distance)

    @property
    def state(self):
        state = super().state
        if self.data is None:
            return state
        T_F_K = (np.reshape(state.F_T_EE, (4, 4), order="F") @
                 np.reshape(state.EE_T_K, (4, 4), order="F"))
        rotation = self.data.xmat[self.wrist].reshape(3, 3)
        K = self._behind_flange(0.0) + rotation @ T_F_K[:3, 3]
        R_K = rotation @ T_F_K[:3, :3]
        force, weight = self.pull(), np.array([0.0, 0.0, -9.81 * (MASS - self.m_load)])
        torque = (np.cross(self._behind_flange(HANDLE) - K, force) +
                  np.cross(self._behind_flange(CENTRE) - K, weight))
        # of the robot on its surroundings, at K
        of_robot = -np.hstack((force + weight, torque)) + NOISE * self.noise.standard_normal(6)
        jacobian = np.zeros((6, self.model.nv))
        mujoco.mj_jac(self.model, self.data, jacobian[:3], jacobian[3:], K, self.wrist)
        return state.replace(
            tau_ext_hat_filtered=tuple((jacobian.T @ of_robot)[self._dof_addrs]),
            O_F_ext_hat_K=tuple(of_robot),
            K_F_ext_hat_K=(*(R_K.T @ of_robot[:3]), *(R_K.T @ of_robot[3:])))


def make_tool(sim):
    hand = sim.worldbody.find(".//body[@name='robot0_hand']/inertial")
    hand.set("mass", str(MASS - FINGERS))
    hand.set("pos", f"0 0 {(MASS * CENTRE - FINGERS * FINGERS_AT) / (MASS - FINGERS)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pull", type=float, nargs=2, default=(0.0, 0.0))
    parser.add_argument("--posture", type=float, nargs=7, default=POSTURE)
    options = parser.parse_args()
    HeldRobot.pull_N = np.array([*options.pull, 0.0])
    logging.basicConfig(level=logging.WARNING)
    before_other_programs()
    mujoco_simulator.FrankaMujocoRobot = HeldRobot
    with mujoco_simulator.MujocoSimulator() as sim:
        sim.add_robot(initial_q=options.posture, robot_parameters=RobotParameters(
            ee_mass=NO_MASS, ee_tcp_rpy=FRAME_TURNED), kp=STIFFNESS, kv=DAMPING)
        make_tool(sim)
        with SimulationServer(sim, hostname_candidates=["127.0.0.1"]) as server:
            server.run_forever()


if __name__ == "__main__":
    main()
