"""The HapticGiant in MuJoCo, as a server of the device protocol.

The protocol: docs/reference/device_protocol.md. The links come from the URDF. Each joint has a motor behind a spring (handbook 1.2: rotor inertia,
stiffness, damping, friction), the gantry follows its drive model, the scenario's person holds the
handle. Sensors are exact. Needs the packages hapticgiant and mujoco.

    python examples/python/mujoco_device.py door --listen 127.0.0.1:4810 --fast
    hapticgiant run door --device-address 127.0.0.1:4810 --fast
"""

import argparse
import collections
import secrets
import socket
import time

import mujoco
import numpy as np

import hapticgiant as hg
from device_client import (COMMAND, GOODBYE, HELLO, READY, SENSORS, WELCOME, decode_any, encode, read_key,
                           text, unpack_command, vector)

STEP_S = 0.5e-3
LATENCY_S, CURRENT_LAG_S = 1e-3, 0.5e-3  # from a command's frame to the motors
TORQUE, LOCK_STEP_TIMEOUT_S, COMMAND_TIMEOUT_S = 2, 5.0, 0.05
READY_TIMEOUT_S = 5.0  # a client that sends only a hello blocks others for as long
# rotor inertia, stiffness, damping, Coulomb and viscous friction, peak torque, rad/s with full
# torque and with none; sizes of joints m1..m6
SIZES = {
    7005: (1.46, 12000.0, 12.0, 4.0, 3.0, 176.0, 2.0, 4.0),
    5005: (0.61, 7000.0, 6.0, 2.5, 1.5, 110.0, 2.6, 5.2),
    3008: (0.12, 3000.0, 2.0, 1.0, 0.5, 40.0, 3.5, 7.0),
}
ACTUATORS = np.array([SIZES[size] for size in (7005, 7005, 5005, 5005, 3008, 3008)]).T
ROTOR, STIFFNESS, DAMPING, COULOMB, VISCOUS, PEAK, SPEED_FULL, SPEED_NONE = ACTUATORS
LOAD_FRICTION = 0.06  # more Coulomb friction per torque of the spring
DEAD_TIME_S, LAG_S, SPEED_MAX, ACCELERATION_MAX = 4e-3, 40e-3, 1.5, 2.5  # gantry drives
PRESCRIBED = 1e7  # kg on the gantry, so that nothing but its drives moves it
PAYLOAD_KG, PAYLOAD_COM = 1.18, np.array([0.0, 0.0, -0.003])  # beyond the sensor, in H
PAYLOAD_INERTIA = np.diag([0.0034, 0.0034, 0.00107])
CURRENT_SHARE = 1.0 - np.exp(-STEP_S / CURRENT_LAG_S)  # of the way to the command, per step
BODY = mujoco.mjtObj.mjOBJ_XBODY
NO_TORQUE, NO_SPEED = np.zeros(6), np.zeros(2)
P_M6_H, P_H_S = np.array([0.0, 0.0, 0.12]), np.array([0.0, 0.0, -0.0375])


def cross(a, b):
    """np.cross of two vectors, ten times as fast."""
    (a_x, a_y, a_z), (b_x, b_y, b_z) = a, b
    return np.array([a_y * b_z - a_z * b_y, a_z * b_x - a_x * b_z, a_x * b_y - a_y * b_x])


def limited(value, least, most):
    """np.clip, three times as fast."""
    return np.minimum(np.maximum(value, least), most)


def build_model():
    """The URDF with rotors, springs between them and the links, and sensors."""
    spec = mujoco.MjSpec.from_file(str(hg.MODELS / "haptic_giant" / "haptic_giant.urdf"))
    spec.option.timestep = STEP_S
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    flags = mujoco.mjtDisableBit
    spec.option.disableflags |= int(flags.mjDSBL_CONTACT) | int(flags.mjDSBL_LIMIT)
    for i in range(6):
        rotor = spec.worldbody.add_body(name=f"rotor{i + 1}")
        rotor.gravcomp = 1.0
        rotor.mass, rotor.inertia, rotor.explicitinertial = 1e-6, [1e-9] * 3, True
        joint = rotor.add_joint(name=f"theta{i + 1}", type=mujoco.mjtJoint.mjJNT_HINGE)
        joint.axis, joint.armature, joint.frictionloss = [0, 0, 1], ROTOR[i], COULOMB[i]
        joint.solref_friction = [2 * STEP_S, 1.0]
        spring = spec.add_tendon(name=f"spring{i + 1}")
        spring.springlength = [0, 0]
        spring.wrap_joint(f"theta{i + 1}", 1.0)
        spring.wrap_joint(f"m{i + 1}", -1.0)
    site = spec.body("m6").add_site(name="S", pos=P_M6_H + P_H_S)
    spec.add_sensor(name="a_S", type=mujoco.mjtSensor.mjSENS_ACCELEROMETER,
                    objtype=mujoco.mjtObj.mjOBJ_SITE, objname=site.name)
    spec.add_sensor(name="omega_S", type=mujoco.mjtSensor.mjSENS_GYRO,
                    objtype=mujoco.mjtObj.mjOBJ_SITE, objname=site.name)
    for name in ("ppu1", "ppu2"):
        spec.joint(name).armature = PRESCRIBED
    model = spec.compile()
    for i in range(6):
        rotor, spring = model.joint(f"theta{i + 1}"), model.tendon(f"spring{i + 1}")
        model.dof_damping[rotor.dofadr] = VISCOUS[i]
        model.tendon_stiffness[spring.id], model.tendon_damping[spring.id] = STIFFNESS[i], DAMPING[i]
    return model


class World:
    """The arm, its drives and the person; one call of live() is one period."""

    def __init__(self, scenario):
        self.model = build_model()
        self.data = mujoco.MjData(self.model)
        self.person = hg.Person(scenario)
        self.steps = round(1.0 / scenario.rate_Hz / STEP_S)
        self.p = self.dofs(["ppu1", "ppu2"])
        self.m = self.dofs([f"m{i}" for i in range(1, 7)])
        self.theta = self.dofs([f"theta{i}" for i in range(1, 7)])
        self.hand = self.model.body("m6").id
        q_p, q_m = hg.start_posture(scenario)
        self.data.qpos[self.p], self.data.qpos[self.m] = q_p, q_m
        mujoco.mj_forward(self.model, self.data)
        weight = np.array(self.data.qfrc_bias[self.m])  # the springs carry it
        self.data.qpos[self.theta] = q_m + weight / STIFFNESS
        self.sequence = self.at_work = 0
        self.random = np.random.default_rng(1)
        self.time_s = 0.0
        self.tau = np.zeros(6)  # of the motors, behind their current
        self.tau_cmd, self.dq_p_cmd, self.is_enabled = np.zeros(6), np.zeros(2), False
        self.torques = collections.deque()  # (due, sequence, enable, tau_m): on their way
        self.speeds = collections.deque([np.zeros(2)] * round(DEAD_TIME_S / STEP_S))
        self.target = hg.HandTarget()
        mujoco.mj_forward(self.model, self.data)
        self.look()

    def dofs(self, names):
        """Of joints that follow each other, as a slice: numpy gives a view and not a copy."""
        first = int(self.model.joint(names[0]).dofadr[0])
        return slice(first, first + len(names))

    def look(self):
        """Where the handle is and what the person does; all that depends on positions and speeds."""
        mujoco.mj_step1(self.model, self.data)
        rotation = self.data.xmat[self.hand].reshape(3, 3)
        velocity = np.zeros(6)  # rotation first
        mujoco.mj_objectVelocity(self.model, self.data, BODY, self.hand, velocity, 0)
        arm = rotation @ P_M6_H
        self.handle = self.data.xpos[self.hand] + arm
        twist = np.concatenate([velocity[3:] + cross(velocity[:3], arm), velocity[:3]])
        pose = hg.Pose(self.handle, rotation)
        self.w_H = np.asarray(self.person.wrench(self.time_s, pose, twist, self.target))

    def at_sensor(self):
        """Wrench, acceleration and angular velocity at S, in S, of the last step."""
        rotation = self.data.xmat[self.hand].reshape(3, 3)
        acceleration = np.zeros(6)
        mujoco.mj_objectAcceleration(self.model, self.data, BODY, self.hand, acceleration, 0)
        a_S, omega = (np.array(self.data.sensor(name).data) for name in ("a_S", "omega_S"))
        alpha = rotation.T @ acceleration[:3]
        force, torque = rotation.T @ self.w_H[:3], rotation.T @ self.w_H[3:]
        to_com = PAYLOAD_COM - P_H_S
        a_com = a_S + cross(alpha, to_com) + cross(omega, cross(omega, to_com))
        inertia_force = PAYLOAD_KG * a_com  # a_S has gravity in it
        inertia_torque = PAYLOAD_INERTIA @ alpha + cross(omega, PAYLOAD_INERTIA @ omega)
        w_S = np.concatenate([
            force - inertia_force,
            torque - cross(P_H_S, force) - inertia_torque - cross(to_com, inertia_force)])
        return np.concatenate([w_S, a_S, omega])

    def live(self, command):
        self.target.active, self.target.p_b, self.target.press = command["hand"]
        due = self.sequence * self.steps + round(LATENCY_S / STEP_S)
        self.torques.append((due, command))
        for step in range(self.sequence * self.steps, (self.sequence + 1) * self.steps):
            self.take_due_commands(step)
            self.step()
        self.sequence += 1
        # what arrives at the moment of the sample is at work
        self.take_due_commands(self.sequence * self.steps)

    def take_due_commands(self, step):
        while self.torques and self.torques[0][0] <= step:
            arrived = self.torques.popleft()[1]
            self.at_work, self.is_enabled = arrived["sequence"], arrived["enable"]
            self.tau_cmd, self.dq_p_cmd = np.array(arrived["tau_m"]), np.array(arrived["dq_p"])

    def step(self):
        data, model = self.data, self.model
        theta, dtheta = data.qpos[self.theta], data.qvel[self.theta]
        stretch = STIFFNESS * (theta - data.qpos[self.m])
        share = (np.abs(dtheta) - SPEED_FULL) / (SPEED_NONE - SPEED_FULL)
        drives = self.tau * dtheta > 0.0
        most = np.where(drives, PEAK * (1.0 - limited(share, 0.0, 1.0)), PEAK)
        wanted = self.tau_cmd if self.is_enabled else NO_TORQUE
        self.tau += CURRENT_SHARE * (wanted - self.tau)
        model.dof_frictionloss[self.theta] = COULOMB + LOAD_FRICTION * np.abs(stretch)
        self.speeds.append(self.dq_p_cmd if self.is_enabled else NO_SPEED)
        speed = limited(self.speeds.popleft(), -SPEED_MAX, SPEED_MAX)
        ddq_p = limited((speed - data.qvel[self.p]) / LAG_S, -ACCELERATION_MAX, ACCELERATION_MAX)
        force = data.qfrc_applied
        force[:] = 0.0
        mujoco.mj_applyFT(model, data, self.w_H[:3], self.w_H[3:], self.handle, self.hand, force)
        force[self.theta] += limited(self.tau, -most, most)
        force[self.p] = PRESCRIBED * ddq_p
        held = theta.copy()
        mujoco.mj_step2(model, data)
        if not self.is_enabled:  # the brakes hold the rotors
            theta[:], dtheta[:] = held, 0.0
        self.time_s += STEP_S
        self.look()

    def sensors(self):
        """The fields of a sensors message."""
        q, dq = self.data.qpos, self.data.qvel
        q_m, theta = q[self.m], q[self.theta]
        tau = STIFFNESS * (theta - q_m) + DAMPING * (dq[self.theta] - dq[self.m])
        wrapped = np.array(q_m)
        wrapped[0] = (q_m[0] + np.pi) % (2.0 * np.pi) - np.pi  # m1 turns without end
        # sensors that show the same bits again and again count as broken: a trace of noise
        tau = tau + 1e-6 * self.random.standard_normal(len(tau))
        at_sensor = self.at_sensor() + 1e-6 * self.random.standard_normal(12)
        return [self.sequence, self.time_s, self.at_work, int(self.person.is_holding(self.time_s)),
                0, 1, 0, 1, 0, 0, 0, *vector(wrapped), *vector(dq[self.m]), *vector(theta), *vector(tau),
                *vector(q[self.p], 2), *at_sensor, *vector([])]


def off(sequence):
    return {"sequence": sequence, "enable": False, "hand": (False, (0.0, 0.0, 0.0), 0.0),
            "tau_m": np.zeros(6), "dq_p": np.zeros(2)}


class Server:
    def __init__(self, address, scenario, is_lock_step, key=None):
        host, port = address.rsplit(":", 1)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind((host, int(port)))
        self.scenario, self.is_lock_step = scenario, is_lock_step
        self.device = (b"HapticGiant", 2, 6, scenario.rate_Hz, TORQUE, int(is_lock_step))
        self.client, self.session, self.number, self.seen = None, 0, 0, 0
        self.sequence, self.key = 0, key  # of the newest frame that was sent

    def send(self, kind, *values):
        self.number += 1
        self.socket.sendto(encode(kind, self.session, self.number, *values, key=self.key),
                           self.client)
        if kind == SENSORS:
            self.sequence = values[0]

    def receive(self, until_s):
        """Type and fields of the next message of the client; None when the time has come.

        Commands are unpacked; one that is malformed is ignored.
        """
        while True:
            left_s = until_s - time.monotonic()
            self.socket.settimeout(max(left_s, 0.0))  # 0: what waits already
            try:
                data, sender = self.socket.recvfrom(2048)
            except (TimeoutError, BlockingIOError):
                return None
            message, is_tag_good = decode_any(data, self.key)
            if message and message[0] == HELLO:
                self.answer(message[3], sender, is_tag_good)
            elif is_tag_good and sender == self.client and message[1] == self.session:
                if message[2] <= self.seen:  # a newer one has overtaken it
                    continue
                self.seen, fields = message[2], message[3]
                if message[0] == COMMAND:
                    n_p, n_m = self.device[1:3]
                    fields = unpack_command(fields, n_m, n_p, TORQUE)
                    if fields and fields["sequence"] > self.sequence:  # of a frame that never was
                        fields = None
                if fields is not None:
                    return message[0], fields

    def answer(self, hello, sender, is_tag_good):
        actual = (self.device[0].ljust(64, b"\0"), *self.device[1:])
        refusal, reason = 0, b""
        if not is_tag_good:
            refusal, reason = 4, b"its key is another one, or only one side has one (--key-file)"
        elif self.client not in (None, sender):
            refusal, reason = 1, b"another client has the device"
        elif hello[1:7] != actual:
            refusal, reason = 3, b"this is the HapticGiant in MuJoCo: %d joints, %g Hz, torques, %s" % (
                6, self.device[3], b"lock-step" if self.is_lock_step else b"real time")
        if refusal == 0:
            self.client = sender
        timeout_s = LOCK_STEP_TIMEOUT_S if self.is_lock_step else COMMAND_TIMEOUT_S
        self.number += 1
        self.socket.sendto(encode(WELCOME, 0 if refusal else self.session, self.number, hello[0],
                                  refusal, 1, *actual, timeout_s, b"mujoco_device.py", reason,
                                  key=None if refusal else self.key), sender)

    def serve(self):
        """One session after the other."""
        while True:
            self.client, self.number, self.seen = None, 0, 0
            self.session = secrets.randbelow(2**32 - 1) + 1
            while self.client is None:
                self.receive(time.monotonic() + 1.0)
            message = self.receive(time.monotonic() + READY_TIMEOUT_S)
            if message is None or message[0] != READY:
                continue
            world = World(self.scenario)
            begin = time.monotonic()
            (self.lock_step if self.is_lock_step else self.real_time)(world)
            print(f"session of {world.time_s:.1f} s in {time.monotonic() - begin:.1f} s", flush=True)

    def lock_step(self, world):
        while True:
            self.send(SENSORS, *world.sensors())
            deadline = time.monotonic() + LOCK_STEP_TIMEOUT_S
            while True:
                message = self.receive(deadline)
                if message is None or message[0] == GOODBYE:
                    return self.say_goodbye(message)
                is_command = message[0] == COMMAND
                if is_command and message[1]["sequence"] == world.sequence:
                    break
                if message[0] == READY or is_command and message[1]["sequence"] < world.sequence:
                    self.send(SENSORS, *world.sensors())
            world.live(message[1])

    def real_time(self, world):
        command, heard_s = off(0), time.monotonic()
        due_s = heard_s
        while time.monotonic() - heard_s < COMMAND_TIMEOUT_S:
            self.send(SENSORS, *world.sensors())
            due_s = max(due_s + 1.0 / self.scenario.rate_Hz, time.monotonic() - 0.01)
            while (message := self.receive(due_s)) is not None:
                if message[0] == GOODBYE:
                    return self.say_goodbye(message)
                if message[0] != COMMAND:
                    continue
                age_s = (world.sequence - message[1]["sequence"]) / self.scenario.rate_Hz
                if age_s <= COMMAND_TIMEOUT_S:  # a client that falls behind is not followed
                    command, heard_s = message[1], time.monotonic()
            world.live(command)
        self.say_goodbye(None)

    def say_goodbye(self, message):
        if message is None:
            print("no command came in time: drives off", flush=True)
            self.send(GOODBYE, 3, 0, b"no command came in time: drives off, brakes closed")
        else:
            print(f"the client left: {text(message[1][2])}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenario", nargs="?", default="door")
    parser.add_argument("--listen", metavar="HOST:PORT", required=True)
    parser.add_argument("--fast", action="store_true", help="lock-step instead of real time")
    parser.add_argument("--rate-hz", type=float, default=1000.0)
    parser.add_argument("--key-file", help="the secret that clients must have, too")
    arguments = parser.parse_args()
    scenario = hg.load_scenario(arguments.scenario)
    scenario.rate_Hz = arguments.rate_hz
    try:
        key = None if arguments.key_file is None else read_key(arguments.key_file)
        Server(arguments.listen, scenario, arguments.fast, key).serve()
    except KeyboardInterrupt:
        pass


if __name__ == "__main__":
    main()
