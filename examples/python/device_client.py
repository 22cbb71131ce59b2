"""A client of the device protocol with nothing but the standard library.

The protocol: docs/reference/device_protocol.md.

Connects to a server, for example `hapticgiant simulate door --listen 127.0.0.1:4810`, takes the
device as it is, prints what its sensors say, and holds the arm where it is.

    python examples/python/device_client.py 127.0.0.1:4810 --seconds 5
"""

import argparse
import hmac
import math
import os
import random
import socket
import stat
import struct
import time
import zlib

HELLO, WELCOME, READY, SENSORS, COMMAND, GOODBYE = range(1, 7)
MAGIC, VERSION = 0x50444748, 2
TAG_SIZE = 16
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


def read_key(file):
    """The shared key, which only its owner may read."""
    try:
        with open(file, "rb", opener=lambda name, flags: os.open(name, flags | os.O_NONBLOCK)) as stream:
            facts, key = os.fstat(stream.fileno()), stream.read(4097)
    except OSError as error:
        raise SystemExit(f"{file}: cannot be read: {error.strerror}") from None
    mode = stat.S_IMODE(facts.st_mode)
    if not stat.S_ISREG(facts.st_mode):
        raise SystemExit(f"{file}: the key must be a file")
    if facts.st_uid not in (os.geteuid(), 0):
        raise SystemExit(f"{file}: the key must be a file of yours or of root")
    if mode & 0o077:
        raise SystemExit(f"{file}: the key must be its owner's only, got mode {mode:04o}: chmod 600 {file}")
    if not 32 <= len(key) <= 4096:
        raise SystemExit(f"{file}: a key has 32 to 4096 bytes, got {len(key)}")
    if not any(key):
        raise SystemExit(f"{file}: a key of zeros is none")
    return key


def tag_of(key, data):
    """What a datagram carries behind its fields; nothing without a key."""
    return hmac.digest(key, data, "sha256")[:TAG_SIZE] if key else b""


def encode(kind, session, number, *values, key=None):
    """One datagram."""
    fields = FIELDS[kind].pack(*values)
    length = HEADER.size + len(fields) + (TAG_SIZE if key else 0) + 4
    data = HEADER.pack(MAGIC, VERSION, kind, length, session, number, time.monotonic_ns()) + fields
    data += tag_of(key, data)
    return data + struct.pack("<I", zlib.crc32(data))


def decode_any(data, key):
    """Type, session, number and fields of a datagram, and whether its tag is the one of the key, or
    there is neither; None, False if it is not a good one."""
    bad = None, False
    if len(data) < HEADER.size + 4 or zlib.crc32(data[:-4]) != struct.unpack("<I", data[-4:])[0]:
        return bad
    magic, version, kind, length, session, number, _ = HEADER.unpack_from(data)
    if (magic, version, length) != (MAGIC, VERSION, len(data)) or kind not in FIELDS:
        return bad
    size = HEADER.size + FIELDS[kind].size
    tag = data[size:-4]
    if len(data) != size + len(tag) + 4 or len(tag) not in (0, TAG_SIZE):
        return bad
    message = kind, session, number, FIELDS[kind].unpack_from(data, HEADER.size)
    return message, hmac.compare_digest(tag, tag_of(key, data[:size]))


def decode(data, key=None):
    """The same of a datagram with the right tag; None of all others."""
    message, is_tag_good = decode_any(data, key)
    return message if is_tag_good else None


def text(field):
    """For people: without the control characters that a terminal would obey."""
    decoded = field.split(b"\0")[0].decode(errors="replace")
    return "".join(c if c.isprintable() else "?" for c in decoded)


def vector(values, room=7):
    """count, zero, and the values with room for the largest device."""
    values = list(values)
    return [len(values), 0] + values + [0.0] * (room - len(values))


def take_vectors(fields, **rooms):
    """The vectors by name, how many fields they take, and whether they are as they may be."""
    at, vectors, is_good = 0, {}, True
    for name, room in rooms.items():
        count, zero, values = fields[at], fields[at + 1], fields[at + 2:at + 2 + room]
        is_good = is_good and count <= room and zero == 0 and not any(values[count:])
        vectors[name] = values[:count]
        at += 2 + room
    return vectors, at, is_good


def unpack_sensors(fields):
    """The fields of a sensors message by name; None if it is malformed."""
    flags = ["dead_man", "emergency_stop", "operator_enable", "override_key", "is_field_clear",
             "has_disagreement"]
    names = ["sequence", "time_s", "answered_sequence", *flags, "driver_fault", "bus_errors"]
    sensors = dict(zip(names, fields))
    at = len(names)
    vectors, size, is_good = take_vectors(fields[at:], q_m=7, dq_m=7, theta_m=7, tau_m=7, q_p=2)
    rest = fields[at + size:]
    heat, _, is_heat_good = take_vectors(rest[12:], temperature_m=7)
    is_good = is_good and is_heat_good and max(sensors[flag] for flag in flags) <= 1
    if not is_good or not all(map(math.isfinite, fields)):
        return None
    return sensors | vectors | {"w_S": rest[:6], "a_S": rest[6:9], "omega_S": rest[9:12]} | heat


def unpack_command(fields, n_m, n_p, interface):
    """The fields of a command message by name; None if it is malformed for such a device."""
    sequence, enable, hand_active, *hand_p_B, hand_press = fields[:7]
    panel = fields[7:12]  # of a simulated operator: stop, enabling switch, key, scanner, reset
    vectors, _, is_good = take_vectors(fields[13:], q_m=7, dq_m=7, ddq_m=7, tau_m=7, dq_p=2)
    sizes = {"q_m": n_m, "dq_m": n_m, "ddq_m": n_m, "tau_m": n_m if interface == 2 else 0, "dq_p": n_p}
    is_good = is_good and sizes == {name: len(values) for name, values in vectors.items()}
    is_good = is_good and max(enable, hand_active, *panel) <= 1 and fields[12] == 0
    if not is_good or not all(map(math.isfinite, fields)):
        return None
    if not 0.0 <= hand_press <= 1.0:
        return None
    return {"sequence": sequence, "enable": bool(enable),
            "hand": (bool(hand_active), hand_p_B, hand_press)} | vectors


def pack_command(sequence, enable, q_m, dq_m, ddq_m, tau_m, dq_p):
    """The fields of a command message; a hand that is nowhere."""
    return [sequence, enable, 0, 0.0, 0.0, 0.0, 0.0, 0, 1, 0, 0, 0, 0, *vector(q_m), *vector(dq_m),
            *vector(ddq_m), *vector(tau_m), *vector(dq_p, 2)]


class Client:
    def __init__(self, host, port, name, key=None):
        self.key = key
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.connect((host, port))
        self.session = self.number = 0
        self.last = None
        welcome = self.request([b"?", 0, 0, 0.0, 1, 0], name)
        if welcome[1] == 3:  # refused as something else was expected: take the device as it is
            welcome = self.request(welcome[3:9], name)
        if welcome[1] != 0:
            raise SystemExit(f"the device refuses: {text(welcome[11])}")
        self.device, (self.n_p, self.n_m, self.rate_Hz, self.interface, self.is_lock_step) = (
            text(welcome[3]), welcome[4:9])
        self.send(READY)

    def request(self, description, name):
        nonce = random.getrandbits(64)
        self.socket.settimeout(0.1)
        for _ in range(30):
            self.send(HELLO, nonce, *description, name.encode())
            try:
                message, is_tag_good = decode_any(self.socket.recv(2048), self.key)
            except (TimeoutError, ConnectionRefusedError):
                time.sleep(0.1)
                continue
            if message and message[0] == WELCOME and message[3][0] == nonce:
                if not is_tag_good and message[3][1] == 0:  # only a refusal needs none
                    raise SystemExit("the device's answer is not of the key that was given (--key-file)")
                self.session = message[1]
                return message[3]
        raise SystemExit("no device answers there")

    def send(self, kind, *values):
        self.number += 1
        self.last = (kind, values)
        self.socket.send(encode(kind, self.session, self.number, *values, key=self.key))

    def sensors(self, timeout_s=1.0):
        """The next frame; repeats the last message when nothing comes."""
        self.socket.settimeout(0.02)
        for _ in range(int(timeout_s / 0.02)):
            try:
                message = decode(self.socket.recv(2048), self.key)
            except TimeoutError:
                self.send(self.last[0], *self.last[1])
                continue
            if message is None or message[1] != self.session:
                continue
            if message[0] == GOODBYE:
                raise SystemExit(f"the device says goodbye: {text(message[3][2])}")
            if message[0] == SENSORS and (sensors := unpack_sensors(message[3])):
                return sensors
        raise SystemExit("the device is silent")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("address", metavar="HOST:PORT")
    parser.add_argument("--seconds", type=float, default=5.0)
    parser.add_argument("--key-file", help="the secret that the device has, too")
    arguments = parser.parse_args()
    host, port = arguments.address.rsplit(":", 1)
    key = None if arguments.key_file is None else read_key(arguments.key_file)
    client = Client(host, int(port), "device_client.py", key)
    mode = "lock-step" if client.is_lock_step else "real time"
    print(f"{client.device}: {client.n_p} gantry axes, {client.n_m} joints, {client.rate_Hz:g} Hz, {mode}")

    first = last = client.sensors()
    while last["time_s"] - first["time_s"] < arguments.seconds:
        tau_m = ()  # with interface 1
        if client.interface == 2:  # carry the weight as at the start, pull back softly
            tau_m = [tau - 200.0 * (q - q_0) - 20.0 * dq for tau, q, q_0, dq in
                     zip(first["tau_m"], last["q_m"], first["q_m"], last["dq_m"])]
        zeros = [0.0] * client.n_m
        client.send(COMMAND, *pack_command(last["sequence"], 1, first["q_m"], zeros, zeros, tau_m,
                                           [0.0] * client.n_p))
        last = client.sensors()
        if last["sequence"] % round(client.rate_Hz / 2) == 0:
            print(f"{last['time_s']:8.3f} s  q_m", *(f"{q:8.4f}" for q in last["q_m"]),
                  "  w_S", *(f"{w:7.2f}" for w in last["w_S"]))
    for _ in range(3):
        client.send(GOODBYE, 1, 0, b"done")
    moved = max(abs(a - b) for a, b in zip(last["q_m"], first["q_m"]))
    print(f"held for {arguments.seconds:g} s, moved by at most {moved:.4f} rad")


if __name__ == "__main__":
    main()
