"""The simulated device of a scenario behind the device protocol, in real time, with its true motion.

docs/reference/device_protocol.md; one session. One call of `advance` is one period, so that the test decides in
between what happens to the client.
"""

import math
import pathlib
import secrets
import socket
import sys
import time

import hapticgiant as hg
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "examples" / "python"))
from device_client import (COMMAND, GOODBYE, HELLO, READY, SENSORS, WELCOME, decode, encode, unpack_command,  # noqa: E402
                           vector)

COMMAND_TIMEOUT_S = 0.05  # without a command: drives off
LATE_S = 0.05  # a command that answers an older frame does not count
BEHIND_S = 0.01  # periods further behind are left out
STANDSTILL = 0.02  # rad/s and m/s


class Motion:
    """True motion of the axes from the first call of `look` on."""

    def __init__(self, stop_distance_rad, gantry_stop_distance_m):
        self.stop_distance_rad, self.gantry_stop_distance_m = stop_distance_rad, gantry_stop_distance_m
        self.begin = None
        self.watched_s = self.energy_J = self.most_energy_J = self.travel_share = 0.0
        self.rest_s = math.nan
        """From the first call until all axes stood still for good; NaN: they have not."""

    def look(self, truth, dt):
        q_m, q_p = np.array(truth.q_m), np.array(truth.q_p)
        if self.begin is None:
            self.begin = q_m, q_p
        travel = [*abs(q_m - self.begin[0]) / self.stop_distance_rad, *abs(q_p - self.begin[1]) / self.gantry_stop_distance_m]
        self.travel_share = max(self.travel_share, *travel)
        self.energy_J -= dt * float(np.dot(truth.w_h, truth.twist))
        self.most_energy_J = max(self.most_energy_J, self.energy_J)
        self.watched_s += dt
        speeds = abs(np.array(truth.dq_m))
        if len(truth.dtheta_m):  # behind a closed brake the link swings on its spring, and the motor stands
            speeds = np.minimum(speeds, abs(np.array(truth.dtheta_m)))
        if max(*speeds, *abs(np.array(truth.dq_p))) >= STANDSTILL:
            self.rest_s = math.nan
        elif math.isnan(self.rest_s):
            self.rest_s = self.watched_s


class ServedDevice:
    """The device, which one client may lead. Raises hapticgiant.SetupError."""

    def __init__(self, scenario_file, motion):
        self.scenario = hg.load_scenario(scenario_file)
        self.device = hg.SimulatedDevice(self.scenario)
        self.dt = 1.0 / self.scenario.rate_Hz
        self.motion, self.is_watched = motion, False
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.address = "127.0.0.1:{}".format(self.socket.getsockname()[1])
        self.client, self.session, self.number, self.newest = None, secrets.randbelow(2**32 - 1) + 1, 0, 0
        self.state = "waiting"  # then "serving", and "alone" when the session is over
        self.command, self.is_on, self.was_on = hg.CommandFrame(), False, False
        self.periods = 0
        self.due_s = self.heard_s = 0.0

    def advance(self):
        """One period: waits for a client, serves it, or lets the device continue without one."""
        if self.state == "waiting":
            if self._receive(time.monotonic() + 0.1) == READY:
                self.state, self.due_s, self.heard_s = "serving", time.monotonic(), time.monotonic()
            return
        sensors = self.device.read()
        if self.state == "serving":
            self._serve(sensors)
        else:
            self.due_s = max(self.due_s + self.dt, time.monotonic() - BEHIND_S)
            time.sleep(max(0.0, self.due_s - time.monotonic()))
        self.device.write(self.command)
        self.periods += self.state == "serving"
        if self.is_watched:
            self.motion.look(self.device.truth, self.dt)

    def close(self):
        self.socket.close()

    def _serve(self, sensors):
        self._send(SENSORS, *fields_of(sensors))
        self.due_s = max(self.due_s + self.dt, time.monotonic() - BEHIND_S)
        while (kind := self._receive(self.due_s, sensors.sequence)) is not None:
            if kind == GOODBYE:
                return self._leave()
        if time.monotonic() - self.heard_s > COMMAND_TIMEOUT_S:
            for _ in range(3):
                self._send(GOODBYE, 3, 0, b"no command came in time: drives off, brakes closed")
            self._leave()
        return None

    def _leave(self):
        self.state, self.command, self.is_on = "alone", hg.CommandFrame(), False

    def _send(self, kind, *values):
        self.number += 1
        self.socket.sendto(encode(kind, self.session, self.number, *values), self.client)

    def _receive(self, until_s, sequence=0):
        """The type of the next message of the client, None at that time. A hello is answered, a command is kept."""
        while True:
            self.socket.settimeout(max(until_s - time.monotonic(), 0.0))
            try:
                data, sender = self.socket.recvfrom(2048)
            except (TimeoutError, BlockingIOError):
                return None
            message = decode(data)
            if message is None:
                continue
            kind, session, number, fields = message
            if kind == HELLO and self.state == "waiting":
                self.client, self.newest = sender, 0
                self.n_p, self.n_m, self.interface = fields[2], fields[3], fields[5]
                self._send(WELCOME, fields[0], 0, 1, *fields[1:7], COMMAND_TIMEOUT_S, b"process_faults", b"")
            elif sender == self.client and session == self.session and number > self.newest:
                self.newest = number
                if kind == COMMAND:
                    self._take(unpack_command(fields, self.n_m, self.n_p, self.interface), sequence)
                return kind

    def _take(self, words, sequence):
        if words is None or words["sequence"] > sequence or (sequence - words["sequence"]) * self.dt > LATE_S:
            return
        self.heard_s = time.monotonic()
        command = hg.CommandFrame()
        command.sequence, command.enable = words["sequence"], words["enable"]
        for name in ("q_m", "dq_m", "ddq_m", "tau_m", "dq_p"):
            setattr(command, name, np.array(words[name]))
        self.command, self.is_on = command, words["enable"]
        self.was_on = self.was_on or self.is_on


def fields_of(sensors):
    """The fields of a sensors message."""
    safety = sensors.safety
    flags = (sensors.dead_man, safety.emergency_stop, safety.operator_enable, safety.override_key, safety.is_field_clear,
             safety.has_disagreement)
    vectors = (each for values in (sensors.q_m, sensors.dq_m, sensors.theta_m, sensors.tau_m) for each in vector(values))
    return [sensors.sequence, sensors.time_s, sensors.answered_sequence, *map(int, flags), int(sensors.driver_fault.value),
            sensors.bus_errors, *vectors, *vector(sensors.q_p, 2), *sensors.w_s, *sensors.a_s, *sensors.omega_s,
            *vector(sensors.temperature_m)]
