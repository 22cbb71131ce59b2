"""A simulated segment and a master on it, for the tests of EtherCAT.

Both are programs of their own, joined by a pair of virtual interfaces in a network namespace that
goes with the last of its processes.
"""

import json
import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
MACHINE = HERE / "machine.txt"
MASTER_END, SEGMENT_END = "master0", "segment0"
INSIDE = "HG_ETHERCAT_NAMESPACE"  # set in the namespace

OUTPUTS, INPUTS = 0x1C12, 0x1C13
CONTROL, STATUS, MODE, MODE_NOW = 0x6040, 0x6041, 0x6060, 0x6061
TARGET, POSITION, ERROR = 0x607A, 0x6064, 0x603F
TARGET_VELOCITY, VELOCITY, TARGET_TORQUE, TORQUE = 0x60FF, 0x606C, 0x6071, 0x6077
CSP, CSV, CST = 8, 9, 10
OP = [8, 0]


def enter_namespace():
    """Starts this program again in a network namespace of its own; why it cannot, or nothing."""
    if shutil.which("ip") is None or shutil.which("unshare") is None:
        return "'ip' (iproute2) or 'unshare' (util-linux) is missing"
    prefix = ["unshare", "--net"]
    if os.geteuid() != 0:
        prefix += ["--user", "--map-root-user"]
    for words, what in ((["true"], "network namespaces"),
                        (["ip", "link", "add", MASTER_END, "type", "veth", "peer", "name", SEGMENT_END],
                         "virtual interfaces (veth)"),
                        ([sys.executable, "-c", "import socket as s; s.socket(s.AF_PACKET, "
                          "s.SOCK_RAW)"], "raw sockets")):
        tried = subprocess.run(prefix + words, capture_output=True, text=True)
        if tried.returncode != 0:
            return f"no {what} here: {tried.stderr.strip().splitlines()[-1]}"
    os.environ[INSIDE] = "1"
    os.execvp("unshare", prefix + [sys.executable, *sys.argv])


def make_interfaces():
    subprocess.run(["ip", "link", "add", MASTER_END, "type", "veth", "peer", "name", SEGMENT_END],
                   check=True)
    for end in ("lo", MASTER_END, SEGMENT_END):
        subprocess.run(["ip", "link", "set", end, "up"], check=True)


class Program:
    """A program that answers each line with one line."""

    def __init__(self, *words):
        self.words = words
        self.process = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        text=True)

    def ask(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        return self.hear()

    def hear(self):
        answer = self.process.stdout.readline()
        if not answer:
            raise AssertionError(f"{self.words[0]} has ended")
        return answer.strip()

    def close(self):
        self.process.stdin.close()
        self.process.wait(10)
        self.process.stdout.close()


class Segment(Program):
    def __init__(self, program, layout=MACHINE, plant=None):
        super().__init__(program, SEGMENT_END, str(layout), *([plant] if plant else []))
        self.hear()

    def command(self, command):
        answer = self.ask(command)
        if answer != "ok":
            raise AssertionError(f"{command}: {answer}")

    def show(self):
        return json.loads(self.ask("show"))

    def is_op(self, name):
        return next(slave["status"] for slave in self.show() if slave["name"] == name) == 8

    def names(self):
        words = (line.split("#")[0].split() for line in MACHINE.read_text().splitlines())
        return [line[1] for line in words if line]


class Bus:
    """A master and its segment: `with Bus(segment, master) as bus`."""

    def __init__(self, segment_program, master_words):
        self.segment = Segment(segment_program)
        try:
            self.master = Program(*master_words, MASTER_END)
        except OSError:
            self.segment.close()
            raise
        self.names = self.segment.names()
        self.targets = {}  # outputs of each drive: values by index of their object
        self.mapping = {}  # of each drive: outputs, inputs

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.master.close()
        self.segment.close()

    def ask(self, *words):
        answer = json.loads(self.master.ask(" ".join(str(word) for word in words)))
        if isinstance(answer, dict) and "error" in answer:
            raise AssertionError(f"{' '.join(map(str, words))}: {answer['error']}")
        return answer

    # --- SDO -------------------------------------------------------------------------------------

    def read(self, name, index, subindex=0, size=4, signed=False):
        """The value of an object, or {"abort": code}."""
        read = self.ask("read", self.names.index(name), hex(index), subindex, size)
        return read if isinstance(read, dict) else int.from_bytes(bytes.fromhex(read), "little",
                                                                  signed=signed)

    def write(self, name, index, subindex, value, size):
        data = value.to_bytes(size, "little", signed=value < 0)
        return self.ask("write", self.names.index(name), hex(index), subindex, data.hex())

    def entries(self, name, assignment):
        """(index, bits) of all that is mapped, as the slave itself says."""
        found = []
        for i in range(1, self.read(name, assignment, 0, 1) + 1):
            pdo = self.read(name, assignment, i, 2)
            for k in range(1, self.read(name, pdo, 0, 1) + 1):
                entry = self.read(name, pdo, k)
                found.append((entry >> 16, entry & 0xFF))
        return found

    # --- process data ----------------------------------------------------------------------------

    def operate(self):
        """Takes all slaves to OP, with watchdogs that a busy computer does not trip."""
        self.ask("scan")
        for name in self.names:
            if name.startswith("axis"):
                self.mapping[name] = (self.entries(name, OUTPUTS), self.entries(name, INPUTS))
                self.targets[name] = {MODE: CSP}
        sizes = self.ask("configure")
        for i in range(len(self.names)):
            self.ask("register", i, "0x0420", "ffff")
        self.ask("operate")
        return sizes

    def cycle(self, patience_ms=5000, panel=0):
        """One exchange: working counter (None: lost) and the inputs of each slave by name."""
        outputs = []
        for name in self.names:
            if name in self.mapping:
                outputs.append(self.pack(name).hex())
            else:
                outputs.append(f"{panel:02x}" if name == "panel" else "-")
        answer = self.ask("cycle", patience_ms, ",".join(outputs))
        if answer["counter"] is None:
            return None, {}
        inputs = {name: bytes.fromhex(data) for name, data in zip(self.names, answer["inputs"])}
        return answer["counter"], {name: self.unpack(name, data) for name, data in inputs.items()}

    def pack(self, name):
        data = b""
        for index, bits in self.mapping[name][0]:
            value = self.targets[name].get(index, 0)
            data += (value & (1 << bits) - 1).to_bytes(bits // 8, "little")
        return data

    def unpack(self, name, data):
        if name not in self.mapping:
            return data
        values, at = {}, 0
        for index, bits in self.mapping[name][1]:
            is_signed = index not in (STATUS, ERROR)
            values[index] = int.from_bytes(data[at:at + bits // 8], "little", signed=is_signed)
            at += bits // 8
        return values

    def enable(self, *names):
        """Enables drives where they stand, as CiA 402 says; the inputs of the last cycle."""
        for _ in range(40):
            _, inputs = self.cycle()
            for name in names:
                status = inputs[name][STATUS]
                self.targets[name][TARGET] = inputs[name][POSITION]
                self.targets[name][CONTROL] = next_control(status)
            if all(is_following(inputs[name]) for name in names):
                return inputs
        raise AssertionError("not enabled: " + str({n: hex(inputs[n][STATUS]) for n in names}))


def next_control(status):
    """The control word that leads a drive on to operation enabled."""
    if status & 0x4F == 0x08:
        return 0x80  # fault: reset
    if status & 0x4F == 0x40:
        return 0x06  # switch on disabled: shutdown
    if status & 0x6F == 0x21:
        return 0x07  # ready to switch on: switch on
    return 0x0F


def is_following(inputs):
    """Whether a drive is enabled and its brake open."""
    return inputs[STATUS] & 0x106F == 0x1027


# --- frames by hand ------------------------------------------------------------------------------

NOP, APRD, APWR, APRW, FPRD, FPWR, FPRW, BRD, BWR, BRW, LRD, LWR, LRW, ARMW, FRMW = range(15)


class Wire:
    """Frames by hand on the master's end."""

    def __init__(self):
        self.socket = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(0x88A4))
        self.socket.bind((MASTER_END, 0))
        self.socket.settimeout(10)

    def close(self):
        self.socket.close()

    def send(self, command, address, data):
        """One datagram; address: (position or station, offset), or a logical one."""
        if isinstance(address, tuple):
            where = (address[0] & 0xFFFF).to_bytes(2, "little") + address[1].to_bytes(2, "little")
        else:
            where = address.to_bytes(4, "little")
        body = (bytes([command, 7]) + where + len(data).to_bytes(2, "little") + b"\0\0" + data
                + b"\0\0")
        header = (len(body) | 0x1000).to_bytes(2, "little")
        frame = b"\xff" * 6 + b"\x10" * 6 + b"\x88\xa4" + header + body
        self.socket.send(frame.ljust(60, b"\0"))

    def receive(self):
        """Source address, data and working counter of the answer."""
        while True:
            frame, origin = self.socket.recvfrom(1600)
            if origin[2] != socket.PACKET_OUTGOING:
                break
        length = int.from_bytes(frame[22:24], "little") & 0x07FF
        data, counter = frame[26:26 + length], frame[26 + length:28 + length]
        return frame[6:12], data, int.from_bytes(counter, "little")

    def exchange(self, command, address, data):
        self.send(command, address, data)
        return self.receive()[1:]

    def count(self, command, address, data):
        return self.exchange(command, address, data)[1]


def undocumented(text, words):
    """Which of the words a text does not have as code."""
    return [word for word in words if not re.search(rf"`{re.escape(word)}\b", text)]
