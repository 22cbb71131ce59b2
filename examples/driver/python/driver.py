"""A driver of one's own: a robot that `hapticgiant` moves over the network.

Needs Python 3.9 and nothing else. Fill in the class Robot, down to the line "from here on"; the rest
speaks the protocol (docs/reference/device_protocol.md). docs/start/own_driver.md leads through it.

    python driver.py --simulated
    hapticgiant run free_space --device models/examples/arm.yaml --rate-hz 250 --device-address 127.0.0.1:4810
"""

import argparse
import collections
import dataclasses
import hmac
import math
import os
import random
import secrets
import select
import signal
import socket
import stat
import struct
import sys
import time
import zlib

NAME = "example arm"  # `name` of the device file; also --name


@dataclasses.dataclass
class Sensors:
    """One sample. For a prismatic joint read m for rad and N for Nm."""

    q_m: list  # rad, a value per joint; those without limits in [-pi, pi)
    dq_m: list  # rad/s
    q_p: list  # m, a value per gantry axis; [] without a gantry
    w_S: list  # wrench of the user on the handle, at the sensor, in its axes: 3 forces N, 3 torques Nm
    dead_man: bool  # a hand holds the handle
    theta_m: list = dataclasses.field(default_factory=list)  # rad, motor encoders behind the gear; [] = none
    tau_m: list = dataclasses.field(default_factory=list)  # Nm, joint torque sensors; [] = none
    a_S: tuple = (0.0, 0.0, 0.0)  # m/s^2, accelerometer: +9.81 upwards at rest; zeros = none
    omega_S: tuple = (0.0, 0.0, 0.0)  # rad/s, gyroscope; zeros = none
    temperature_m: list = dataclasses.field(default_factory=list)  # degrees Celsius; [] = none
    emergency_stop: bool = False  # it is pressed
    operator_enable: bool = True  # the enabling switch is held, or there is none
    override_key: bool = False  # slow motion without a hand is permitted
    is_field_clear: bool = True  # no person in the field of a scanner, or there is none
    has_disagreement: bool = False  # the channels of one of these inputs differed for too long
    driver_fault: int = 0  # a number of hg/signals/fault.h; 0 = none
    bus_errors: int = 0  # answers of a fieldbus that are missing in this sample


@dataclasses.dataclass
class Command:
    """What the robot is to do until the next one."""

    enable: bool  # False: drives off, brakes closed, whatever the other fields say
    q_m: list  # rad, where the joints are to be one period from now
    dq_m: list  # rad/s
    ddq_m: list  # rad/s^2
    tau_m: list  # Nm, torques of the motors; [] with --interface position
    dq_p: list  # m/s, speeds of the gantry axes


class Robot:
    """PUT YOUR ROBOT HERE. read() and then write() are called once per period.

    Neither may wait. An exception ends the session with the drives off. write() with `enable`
    False must switch the drives off and close the brakes; it is the last call of every session.

    This stand-in has no masses and no weight: joints that follow their reference, also where the
    drives take torques, and a hand that takes the handle when the drives are on for half a second,
    and then pushes along x and back with 5 N.
    """

    LIMITS = 5.0, 100.0  # rad/s, rad/s^2

    def __init__(self, joints, axes, rate_Hz, has_torques):
        self.period_s, self.has_torques = 1.0 / rate_Hz, has_torques
        self.q_m = [0.0, 0.6, 1.2, 0.0, 0.8, 0.0, 0.0][:joints]
        self.dq_m, self.tau_m = [0.0] * joints, [0.0] * joints
        self.q_p, self.on_s = [0.0] * axes, 0.0
        self.noise = random.Random(1)

    def read(self):
        push = 5.0 * math.cos(math.pi * (self.on_s - 1.0)) if self.on_s > 1.0 else 0.0
        wrench = [push, 0.0, 0.0, 0.0, 0.0, 0.0]
        return Sensors(q_m=list(self.q_m), dq_m=list(self.dq_m), q_p=list(self.q_p),
                       w_S=[w + self.noise.gauss(0.0, 0.001) for w in wrench],
                       dead_man=self.on_s > 0.5,
                       theta_m=list(self.q_m) if self.has_torques else [],
                       tau_m=list(self.tau_m) if self.has_torques else [])

    def write(self, command):
        if not command.enable:  # the brakes hold at once
            self.on_s, self.dq_m, self.tau_m = 0.0, [0.0] * len(self.q_m), [0.0] * len(self.q_m)
            return
        dt, (dq_max, ddq_max) = self.period_s, self.LIMITS
        self.on_s, self.tau_m = self.on_s + dt, command.tau_m
        for i, (q, dq) in enumerate(zip(self.q_m, self.dq_m)):
            lag, dlag = command.q_m[i] - q, command.dq_m[i] - dq
            ddq = command.ddq_m[i] + 0.04 / dt**2 * lag + 0.4 / dt * dlag
            ddq = min(max(ddq, -ddq_max), ddq_max)
            ddq = (min(max(dq + dt * ddq, -dq_max), dq_max) - dq) / dt
            self.q_m[i] += dt * dq + 0.5 * dt * dt * ddq
            self.dq_m[i] += dt * ddq
        self.q_p = [q + dt * dq for q, dq in zip(self.q_p, command.dq_p)]


# From here on nothing depends on the robot.

HELLO, WELCOME, READY, SENSORS, COMMAND, GOODBYE = range(1, 7)
MAGIC, VERSION, TAG_SIZE, WINDOW = 0x50444748, 2, 16, 64
HEADER = struct.Struct("<IHHIIQQ")  # magic, version, type, length, session, number, time_ns
DESCRIPTION = "64sIIdII"  # device, n_p, n_m, rate_Hz, interface, is_lock_step
FIELDS = {
    HELLO: struct.Struct("<Q" + DESCRIPTION + "64s"),
    WELCOME: struct.Struct("<QII" + DESCRIPTION + "d64s192s"),
    READY: struct.Struct("<"),
    SENSORS: struct.Struct("<QdQ8I" + 4 * "II7d" + "II2d" + "6d3d3d" + "II7d"),
    COMMAND: struct.Struct("<QII3dd6I" + 4 * "II7d" + "II2d"),
    GOODBYE: struct.Struct("<II64s"),
}
BUSY, OTHER_VERSION, MISMATCH, OTHER_KEY = 1, 2, 3, 4  # refusals
DONE, SILENCE = 1, 3  # farewells
COMMAND_TIMEOUT_S, LOCK_STEP_TIMEOUT_S, READY_TIMEOUT_S = 0.05, 5.0, 30.0


def tag_of(key, data):
    return hmac.digest(key, data, "sha256")[:TAG_SIZE] if key else b""


def encode(kind, session, number, *values, key=None):
    """One datagram."""
    fields = FIELDS[kind].pack(*values)
    length = HEADER.size + len(fields) + (TAG_SIZE if key else 0) + 4
    data = HEADER.pack(MAGIC, VERSION, kind, length, session, number, time.monotonic_ns()) + fields
    data += tag_of(key, data)
    return data + struct.pack("<I", zlib.crc32(data))


def decode(data, key):
    """Version, type, session, number, fields and whether the tag is good; None of a broken datagram."""
    if len(data) < HEADER.size + 4 or zlib.crc32(data[:-4]) != struct.unpack("<I", data[-4:])[0]:
        return None
    magic, version, kind, length, session, number, _ = HEADER.unpack_from(data)
    if (magic, length) != (MAGIC, len(data)) or kind not in FIELDS:
        return None
    if version != VERSION:
        return version, kind, session, number, (), False
    end = HEADER.size + FIELDS[kind].size
    if len(data) - end - 4 not in (0, TAG_SIZE):
        return None
    is_tag_good = hmac.compare_digest(data[end:-4], tag_of(key, data[:end]))
    return version, kind, session, number, FIELDS[kind].unpack_from(data, HEADER.size), is_tag_good


def text(field):
    """For people: without the control characters that a terminal would obey."""
    decoded = field.split(b"\0")[0].decode(errors="replace")
    return "".join(c if c.isprintable() else "?" for c in decoded)


def exactly(size, name, values):
    if len(values) != size:
        raise ValueError(f"read() gives {len(values)} values of {name}, expected {size}")
    return values


def vector(size, name, values, room=7, may_be_empty=False):
    """count, zero, and the values with room for the largest device."""
    if not may_be_empty or len(values) > 0:
        exactly(size, name, values)
    return [len(values), 0, *values, *[0.0] * (room - len(values))]


def unpack_command(fields, n_m, n_p, has_torques):
    """Sequence and Command; None if it is malformed for this device."""
    truths, press, zero = (*fields[1:3], *fields[7:12]), fields[6], fields[12]
    is_good = max(truths) <= 1 and zero == 0 and all(map(math.isfinite, fields)) and 0.0 <= press <= 1.0
    at, vectors = 13, []
    for size, room in ((n_m, 7), (n_m, 7), (n_m, 7), (n_m if has_torques else 0, 7), (n_p, 2)):
        count, zero, values = fields[at], fields[at + 1], fields[at + 2:at + 2 + room]
        is_good = is_good and count == size and zero == 0 and not any(values[size:])
        vectors.append(list(values[:size]))
        at += 2 + room
    return (fields[0], Command(bool(fields[1]), *vectors)) if is_good else None


def read_key(file):
    """The shared key, which only its owner may read."""
    try:
        with open(file, "rb", opener=lambda name, flags: os.open(name, flags | os.O_NONBLOCK)) as stream:
            facts, key = os.fstat(stream.fileno()), stream.read(4097)
    except OSError as error:
        raise SystemExit(f"{file}: cannot be read: {error.strerror}") from None
    if not stat.S_ISREG(facts.st_mode) or facts.st_uid not in (os.geteuid(), 0) or facts.st_mode & 0o077:
        raise SystemExit(f"{file}: the key must be a file that only you can read: chmod 600 {file}")
    if not 32 <= len(key) <= 4096 or not any(key):
        raise SystemExit(f"{file}: a key has 32 to 4096 bytes that are not all zero")
    return key


def say(*words):
    print(*words, flush=True)


class Client:
    """One that was welcomed: its address, and which of its numbers have come."""

    def __init__(self, peer, session, nonce, name):
        self.peer, self.session, self.nonce, self.name = peer, session, nonce, name
        self.sent = self.newest = self.seen = 0  # bit i of `seen`: newest - i has come
        self.was_overtaken = False  # the last one, by a newer one

    def accept(self, number):
        """False: it has come before, or may have."""
        age = self.newest - number
        self.was_overtaken = age > 0
        if age >= WINDOW or age >= 0 and self.seen >> age & 1:
            return False
        if age < 0:
            self.seen, self.newest, age = self.seen << min(-age, WINDOW) & (1 << WINDOW) - 1, number, 0
        self.seen |= 1 << age
        return True


class Server:
    def __init__(self, options, key):
        self.options, self.key = options, key
        self.has_torques = options.interface == "torque"
        self.device = (options.name.encode(), options.axes, options.joints, options.rate_hz,
                       2 if self.has_torques else 1, int(options.fast))
        self.timeout_s = LOCK_STEP_TIMEOUT_S if options.fast else options.timeout_s
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            host, port = options.listen.rsplit(":", 1)
            self.socket.bind((host, int(port)))
        except (ValueError, OverflowError, OSError) as error:
            raise SystemExit(f"--listen {options.listen}: expected HOST:PORT that is free: {error}") from None
        self.socket.setblocking(False)
        self.secret, self.sessions = secrets.token_bytes(32), 0
        self.client, self.welcomed = None, collections.OrderedDict()  # by address, the last 16
        self.sequence = 0  # of the newest frame
        self.reads_after_due = 0  # looks into the socket when the time was over, since that frame
        self.ignored = collections.Counter()

    def send(self, client, kind, *values):
        client.sent += 1
        self.send_bytes(encode(kind, client.session, client.sent, *values, key=self.key), client.peer)

    def send_bytes(self, data, peer):
        try:
            self.socket.sendto(data, peer)
        except OSError:
            pass  # a full buffer or a client that has gone: as if it were lost on its way

    def session_of(self, peer, age=0):
        """Only who has received its welcome knows it, so no record of other clients is needed."""
        words = repr((self.sessions, peer, int(time.monotonic() / READY_TIMEOUT_S) - age)).encode()
        return int.from_bytes(hmac.digest(self.secret, words, "sha256")[:4], "little") | 1

    def receive(self, until_s):
        """Type and fields of the next message for the session, a command unpacked; None: time is over."""
        while True:
            wait_s = max(until_s - time.monotonic(), 0.0)
            self.reads_after_due += wait_s == 0.0
            # what waits is read, but the next period must begin
            is_flood = wait_s == 0.0 and self.reads_after_due > 64
            if is_flood or not select.select([self.socket], [], [], wait_s)[0]:
                return None
            try:
                data, peer = self.socket.recvfrom(2048)
            except OSError:
                continue
            message = self.judge(decode(data, self.key), peer)
            if message is not None:
                return message

    def judge(self, message, peer):
        """Type and fields of a message that counts; in the order of the protocol's table."""
        if message is not None and message[1] == HELLO:
            return self.answer(message, peer)
        if self.client is None:
            return self.begin(message, peer)
        if peer != self.client.peer:
            self.other = self.other or peer
            return self.ignore("from others")
        if message is None or message[1] not in (READY, COMMAND, GOODBYE):
            return self.ignore("broken or foreign")
        version, kind, session, number, fields, is_tag_good = message
        if version != VERSION or not is_tag_good:
            return self.ignore("forged" if version == VERSION else "wrong version")
        if session != self.client.session or not self.client.accept(number):
            return self.ignore("duplicate" if session == self.client.session else "wrong session")
        if kind == COMMAND:
            fields = unpack_command(fields, self.options.joints, self.options.axes, self.has_torques)
            if fields is None or fields[0] > self.sequence:  # or it answers a frame that never was
                return self.ignore("malformed")
        return kind, fields

    def ignore(self, why):
        self.ignored[why] += 1

    def answer(self, message, peer):
        """Welcomes who says hello, or says why not."""
        version, _, _, _, fields, is_tag_good = message
        refusal, reason, nonce = 0, "", fields[0] if fields else 0
        is_client = self.client is not None and (peer, nonce) == (self.client.peer, self.client.nonce)
        if version != VERSION:
            refusal, reason = OTHER_VERSION, f"protocol: version {VERSION}, expected {version}"
        elif not is_tag_good:
            refusal, reason = OTHER_KEY, ("its key is another one, or none was given (--key-file)" if self.key
                                          else "it has no key (--key-file), and none may be given")
        elif self.client is not None and not is_client:
            refusal, reason = BUSY, f"{self.client.name} has the device"
        else:
            names = ("device", "gantry axes", "joints", "rate in Hz", "interface (1 position, 2 torque)",
                     "lock-step")
            expected = text(fields[1]).encode(), *fields[2:7]
            for name, mine, theirs in zip(names, self.device, expected):
                if mine != theirs:
                    mine, theirs = (text(x) if isinstance(x, bytes) else f"{x:g}" for x in (mine, theirs))
                    refusal, reason = MISMATCH, f"{name}: {mine}, expected {theirs}"
                    break
        words = (refusal, int(self.options.simulated), *self.device, self.timeout_s, b"driver.py",
                 reason.encode()[:191])
        if refusal:
            if self.client is None:
                say(f"refused {peer[0]}:{peer[1]}: {reason}")
            else:  # no words while the robot moves: a terminal may make them wait
                self.ignore("refused")
            self.send_bytes(encode(WELCOME, 0, 1, nonce, *words), peer)  # without a tag
        elif is_client:
            self.send(self.client, WELCOME, nonce, *words)
        else:
            client = self.welcomed.pop(peer, None)
            if client is None or client.nonce != nonce:
                client = Client(peer, self.session_of(peer), nonce, text(fields[7]) or "a client")
            self.welcomed[peer] = client
            if len(self.welcomed) > 16:
                self.welcomed.popitem(last=False)
            self.send(client, WELCOME, nonce, *words)

    def begin(self, message, peer):
        """The first welcomed client that is ready gets the device."""
        if message is None or message[1] not in (READY, GOODBYE) or not message[5]:
            return None
        _, kind, session, number, _, _ = message
        client = self.welcomed.get(peer)
        if client is None or client.session != session:
            if session not in (self.session_of(peer), self.session_of(peer, 1)):
                return None
            client = Client(peer, session, None, "a client")
            client.sent = 2 * WINDOW  # its welcomes, which are forgotten
        if not client.accept(number):
            return None
        self.welcomed.pop(peer, None)
        if kind == GOODBYE:
            return None
        self.client, self.sessions = client, self.sessions + 1
        for other in self.welcomed.values():
            self.farewell(other, DONE, f"{client.name} has the device")
        self.welcomed.clear()
        return READY, ()

    def farewell(self, client, kind, reason):
        for _ in range(3):  # it is not acknowledged
            self.send(client, GOODBYE, kind, 0, reason.encode()[:63])

    def send_sensors(self, sensors, time_s, answered):
        self.sequence, self.reads_after_due = self.sequence + 1, 0
        n_m, s = self.options.joints, sensors
        self.frame = (
            self.sequence, time_s, answered, int(s.dead_man), int(s.emergency_stop), int(s.operator_enable),
            int(s.override_key), int(s.is_field_clear), int(s.has_disagreement), s.driver_fault, s.bus_errors,
            *vector(n_m, "q_m", s.q_m), *vector(n_m, "dq_m", s.dq_m),
            *vector(n_m, "theta_m", s.theta_m, may_be_empty=not self.has_torques),
            *vector(n_m, "tau_m", s.tau_m, may_be_empty=not self.has_torques),
            *vector(self.options.axes, "q_p", s.q_p, room=2), *exactly(6, "w_S", s.w_S),
            *exactly(3, "a_S", s.a_S), *exactly(3, "omega_S", s.omega_S),
            *vector(n_m, "temperature_m", s.temperature_m, may_be_empty=True))
        self.send(self.client, SENSORS, *self.frame)

    def off(self):
        zeros = [0.0] * self.options.joints
        tau_m = zeros if self.has_torques else []
        return Command(False, zeros, zeros, zeros, tau_m, [0.0] * self.options.axes)

    def serve(self, robot):
        """One session after the other."""
        while True:
            self.client, self.sequence, self.reads_after_due = None, 0, 0
            while self.client is None:
                self.receive(time.monotonic() + 1.0)
            self.ignored.clear()
            self.other = None  # the first who sends into this session
            say(f"session {self.sessions}: {self.client.name} at {self.client.peer[0]}:{self.client.peer[1]}")
            kind, reason = DONE, "the server was stopped"
            try:
                end = (self.lock_step if self.options.fast else self.real_time)(robot)
                if end is None:
                    kind, reason = SILENCE, "no command came in time: drives off, brakes closed"
                else:
                    kind, reason = None, f"the client left: {text(end[2])}"
            except Exception as error:
                reason = f"the driver has failed: {error!r}"
                raise
            finally:
                try:
                    robot.write(self.off())
                finally:
                    if kind is not None:
                        self.farewell(self.client, kind, reason)
                    ignored = ", ".join(f"{count} {why}" for why, count in self.ignored.items())
                    if self.other is not None:
                        ignored += f" ({self.other[0]}:{self.other[1]})"
                    say(f"  {reason}; {self.sequence} samples; ignored: {ignored or 'nothing'}")

    def lock_step(self, robot):
        """Fields of the client's goodbye; None: it is silent."""
        answered, period_s = 0, 1.0 / self.options.rate_hz
        while True:
            self.send_sensors(robot.read(), (self.sequence + 1) * period_s, answered)
            deadline_s = time.monotonic() + self.timeout_s
            while True:
                message = self.receive(deadline_s)
                if message is None or message[0] == GOODBYE:
                    return message and message[1]
                if message[0] == COMMAND and message[1][0] == self.sequence:
                    break
                self.send(self.client, SENSORS, *self.frame)  # it has missed the frame
            answered, command = message[1]
            robot.write(command)

    def real_time(self, robot):
        """The same."""
        answered, command, period_s = 0, self.off(), 1.0 / self.options.rate_hz
        begin_s = due_s = heard_s = time.monotonic()
        while time.monotonic() - heard_s <= self.timeout_s:
            self.send_sensors(robot.read(), time.monotonic() - begin_s, answered)
            due_s = max(due_s + period_s, time.monotonic())  # after a delay: from now on
            while True:
                message = self.receive(due_s)
                if message is None:
                    break
                if message[0] == GOODBYE:
                    return message[1]
                if message[0] != COMMAND:
                    continue
                age_s = (self.sequence - message[1][0]) * period_s
                if self.client.was_overtaken or age_s > self.timeout_s:
                    self.ignore("late")  # a client that falls behind is not followed
                else:
                    (answered, command), heard_s = message[1], time.monotonic()
            robot.write(command)
        return None


STOPS = signal.SIGINT, signal.SIGTERM


def stop(*_):
    """Ctrl-C; a second one must not interrupt that the drives are switched off."""
    for number in STOPS:
        signal.signal(number, signal.SIG_IGN)
    raise KeyboardInterrupt


def take_priority():
    """Before everything else on this computer; it sleeps between two periods."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(70))
    except (AttributeError, OSError) as error:
        say(f"note: no real-time priority ({error}): other programs may make the robot stop (fault 103)")


def read_options(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--name", default=NAME, help="as in the device file")
    parser.add_argument("--joints", type=int, default=6, choices=(6, 7))
    parser.add_argument("--axes", type=int, default=0, choices=(0, 1, 2), help="of a gantry")
    parser.add_argument("--rate-hz", type=float, default=250.0)
    parser.add_argument("--interface", choices=("position", "torque"), default="position",
                        help="what the drives take")
    parser.add_argument("--listen", metavar="HOST:PORT", default="127.0.0.1:4810")
    parser.add_argument("--simulated", action="store_true", help="report to clients that no machine moves")
    parser.add_argument("--fast", action="store_true", help="lock-step: not for a machine")
    parser.add_argument("--timeout-s", type=float, default=COMMAND_TIMEOUT_S,
                        help="time without a command after which the drives go off (not with --fast)")
    parser.add_argument("--key-file", help="the secret that clients must have, too")
    options = parser.parse_args(arguments)
    if not 100.0 <= options.rate_hz <= 20000.0:
        parser.error("--rate-hz: expected 100..20000")
    if not options.simulated and not 0.0 < options.timeout_s <= COMMAND_TIMEOUT_S:
        parser.error(f"--timeout-s: a machine is switched off within {COMMAND_TIMEOUT_S} s")
    if options.fast and not options.simulated:
        parser.error("--fast: a machine keeps its own time; for a stand-in give --simulated, too")
    return options


def main():
    options = read_options(sys.argv[1:])
    for number in STOPS:
        signal.signal(number, stop)
    server = Server(options, None if options.key_file is None else read_key(options.key_file))
    robot = Robot(options.joints, options.axes, options.rate_hz, server.has_torques)
    try:
        host, port = server.socket.getsockname()
        say(f"{options.name} at {host}:{port}: {options.joints} joints, {options.axes} gantry axes, "
            f"{options.rate_hz:g} Hz, {options.interface}, {'lock-step' if options.fast else 'real time'}, "
            f"{'simulated' if options.simulated else 'A MACHINE'}")
        if not options.fast:
            take_priority()
        server.serve(robot)
    except KeyboardInterrupt:
        robot.write(server.off())
        say("stopped: drives off")


if __name__ == "__main__":
    main()
