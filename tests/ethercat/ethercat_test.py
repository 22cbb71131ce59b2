"""The simulated EtherCAT segment, judged by two masters that are not ours, ethercrab and SOEM, and
`hapticgiant bus` on it.

    ethercat_test.py PROGRAM SEGMENT [ETHERCRAB_MASTER]

Both masters obey the same commands, one a line, and answer in JSON:

    scan                      all slaves with identity and delay, in PRE-OP
    read I INDEX SUB SIZE     an object of slave I, in hex, or {"abort": code}
    write I INDEX SUB HEX
    configure                 process data and clocks, to SAFE-OP; sizes of outputs and inputs
    operate                   to OP
    cycle MS HEX,HEX,...      one exchange with these outputs ('-': none), waiting at most so long:
                              working counter (null: no answer) and inputs
    states                    AL status and code of each slave (null: no answer)
    register I ADDRESS HEX    writes 16 bits of a slave's controller

Needs network namespaces, virtual interfaces and raw sockets; where the kernel forbids them it is
skipped (exit code 77), and so is a master that cannot be installed.
"""

import math
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import bus
from bus import (APRD, APRW, APWR, ARMW, BRD, BRW, BWR, CONTROL, CST, CSV, ERROR, FPRD, FPRW, FPWR,
                 FRMW, LRD, LRW, LWR, MODE, MODE_NOW, NOP, OP, POSITION, STATUS, TARGET,
                 TARGET_TORQUE, TARGET_VELOCITY, TORQUE, VELOCITY)

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "packages"))
from environment import make_environment  # noqa: E402

VENV = ROOT / "build" / "ethercat_venv"
PYTHON = VENV / "bin" / "python"
REQUIREMENTS = ROOT / "tools" / "requirements-ethercat.txt"
COMMANDS = ROOT / "docs" / "reference" / "ethercat_segment_commands.csv"
SKIPPED = 77
HOP_NS = 345
AXES = [f"axis_{i}" for i in range(1, 7)]
TURN = {name: 65536 if name in ("axis_5", "axis_6") else 1048576 for name in AXES}
COUNTER = 6 * 3 + 2 * 1 + 3  # drives and I/O read and write, sensors are read
SAFE_OP_ERROR = 0x14
WATCHDOG = 0x001B
PROGRAM = SEGMENT = ETHERCRAB = None


def number(data):
    return int.from_bytes(data, "little", signed=True)


class Masters:
    """What each master must find; a class of its own per master has its command."""

    def bus(self):
        return bus.Bus(SEGMENT, self.words())

    def expect(self, one, counter):
        found, inputs = one.cycle()
        self.assertEqual(found, counter)
        return inputs

    def test_slaves_are_found_and_obey_sdo(self):
        with self.bus() as one:
            found = one.ask("scan")
            kinds = ["CiA 402 drive"] * 6 + ["inertial unit", "force sensor", "digital I/O"]
            self.assertEqual([slave["name"] for slave in found], kinds)
            ours, theirs = 0x00FFFF00, 0x00FFFF01
            self.assertEqual([(slave["vendor"], slave["product"], slave["revision"])
                              for slave in found],
                             [(ours, 0x101, 1)] * 4 + [(theirs, 0x205, 7)] * 2
                             + [(ours, product, 1) for product in (0x301, 0x302, 0x401)])
            for i, slave in enumerate(found[:8]):  # the last has no clock
                self.assertAlmostEqual(slave["delay_ns"], i * HOP_NS, delta=2)
            self.assertEqual(one.read("wrist", 0x1018, 4), 8)
            self.assertEqual(one.read("axis_1", 0x1000), 0x00020192)
            # a text is longer than what an expedited transfer carries
            text = one.ask("read", 0, "0x1008", 0, 13)
            self.assertEqual(bytes.fromhex(text), b"CiA 402 drive")
            for value, size in ((500, 2), (-2, 1), (123456, 4)):
                index, subindex = {2: (0x6072, 0), 1: (0x60C2, 2), 4: (0x607D, 2)}[size]
                self.assertEqual(one.write("axis_2", index, subindex, value, size), {})
                self.assertEqual(one.read("axis_2", index, subindex, size, value < 0), value)
            for words, abort in ((("axis_1", 0x5555, 0, 0, 2), 0x06020000),
                                 (("axis_1", 0x607D, 9, 0, 4), 0x06090011),
                                 (("axis_1", 0x6041, 0, 0, 2), 0x06010002),
                                 (("axis_1", 0x6072, 0, 1, 4), 0x06070010),
                                 (("axis_1", 0x6072, 0, 3001, 2), 0x06090030),
                                 (("axis_1", 0x6060, 0, 1, 1), 0x06090030),
                                 (("axis_1", 0x1600, 1, 0x60410010, 4), 0x06010003),
                                 (("axis_5", 0x1600, 0, 0, 1), 0x06010002)):
                with self.subTest(words):
                    self.assertEqual(one.write(*words), {"abort": abort})

    def test_another_mapping_is_taken(self):
        with self.bus() as one:
            one.ask("scan")
            for assignment, pdo in ((0x1C12, 0x1601), (0x1C13, 0x1A01)):
                for subindex, value, size in ((0, 0, 1), (1, pdo, 2), (0, 1, 1)):
                    self.assertEqual(one.write("axis_3", assignment, subindex, value, size), {})
            self.assertEqual(one.write("axis_4", 0x1600, 0, 0, 1), {})
            self.assertEqual(one.write("axis_4", 0x1600, 1, 0x60410010, 4), {"abort": 0x06040041})
            self.assertEqual(one.write("axis_4", 0x1600, 2, 0x607A0020, 4), {})
            self.assertEqual(one.write("axis_4", 0x1600, 0, 2, 1), {})
            sizes = one.ask("configure")
            self.assertEqual(sizes[:4], [[14, 14], [14, 14], [10, 10], [6, 14]])
            self.assertEqual(one.write("axis_4", 0x1600, 0, 0, 1), {"abort": 0x08000022})

    def test_drives_follow(self):
        with self.bus() as one:
            self.assertEqual(one.operate(), [[14, 14]] * 4 + [[10, 10]] * 2
                             + [[0, 32], [0, 32], [1, 1]])
            self.assertEqual(one.ask("states"), [OP] * 9)
            one.enable(*AXES)
            worst = 0
            cycles = 300
            for k in range(cycles):
                for i, name in enumerate(AXES):
                    turns = (0.05 + 0.01 * i) * (1 - math.cos(2 * math.pi * k / cycles)) / 2
                    one.targets[name][TARGET] = round(turns * TURN[name])
                last = {name: one.targets[name][TARGET] for name in AXES}
                inputs = self.expect(one, COUNTER)
                if k > 0:
                    worst = max(worst, max(abs(before[name] - inputs[name][POSITION]) / TURN[name]
                                           for name in AXES))
                before = last
            self.assertLess(worst, 0.003)  # turns
            self.check_clocks(one)
            self.check_other_modes(one)

    def check_clocks(self, one):
        """Clocks that drift by up to 300 ppm are held together by the cycles."""
        for _ in range(200):
            self.expect(one, COUNTER)
            ahead = max(abs(slave.get("ahead_ns", 0)) for slave in one.segment.show())
            if ahead < 20_000:
                return
        self.fail(f"clocks differ by {ahead} ns")

    def check_other_modes(self, one):
        targets = one.targets["axis_1"]
        targets.update({MODE: CSV, TARGET_VELOCITY: TURN["axis_1"] // 2})
        for _ in range(60):
            inputs = self.expect(one, COUNTER)
        self.assertEqual(inputs["axis_1"][MODE_NOW], CSV)
        self.assertAlmostEqual(inputs["axis_1"][VELOCITY] / TURN["axis_1"], 0.5, delta=0.05)
        targets.update({MODE: CST, TARGET_TORQUE: 50})  # per mille of 1 Nm
        before = inputs["axis_1"][VELOCITY]
        for _ in range(10):
            inputs = self.expect(one, COUNTER)
        self.assertEqual(inputs["axis_1"][TORQUE], 50)
        self.assertGreater(inputs["axis_1"][VELOCITY], before)
        # a limit by SDO holds, and the drive says so
        one.write("axis_1", 0x6072, 0, 20, 2)
        for _ in range(2):
            inputs = self.expect(one, COUNTER)
        self.assertEqual(inputs["axis_1"][TORQUE], 20)
        self.assertTrue(inputs["axis_1"][STATUS] & 0x0800)

    def test_sensors_and_signals_arrive(self):
        with self.bus() as one:
            one.operate()
            for command in ("set imu.az 9.81", "set wrist.fz -12.5", "set panel.in3 1"):
                one.segment.command(command)
            inputs = self.expect(one, COUNTER)
            counted = number(inputs["wrist"][28:32])
            self.assertEqual(number(inputs["imu"][8:12]), 98100)
            self.assertEqual(number(inputs["wrist"][8:12]), -12_500_000)
            self.assertEqual(inputs["panel"], b"\x04")
            _, inputs = one.cycle(panel=0xA5)
            self.assertEqual(number(inputs["wrist"][28:32]), counted + 1)
            self.assertEqual(one.segment.show()[-1]["outputs"], 0xA5)
            one.segment.command("trip wrist 3")
            for _ in range(2):
                inputs = self.expect(one, COUNTER)
            self.assertEqual(number(inputs["wrist"][24:28]), 3)
            self.assertEqual(number(inputs["wrist"][28:32]), counted + 2)

    def test_faults_of_frames_are_seen(self):
        with self.bus() as one:
            one.operate()
            one.segment.command("lose 3")
            for _ in range(3):
                self.assertIsNone(one.cycle(patience_ms=30)[0])
            samples = number(self.expect(one, COUNTER)["wrist"][28:32])
            # a late answer is none, and is not taken for that of another cycle
            one.segment.command("late 1 500000")
            self.assertIsNone(one.cycle(patience_ms=30)[0])
            self.expect(one, COUNTER)
            time.sleep(0.6)
            for k in range(2):
                inputs = self.expect(one, COUNTER)
                self.assertEqual(number(inputs["wrist"][28:32]), samples + 3 + k)
            one.segment.command("miscount axis_3 2")
            self.expect(one, COUNTER - 3)
            self.expect(one, COUNTER - 3)
            self.expect(one, COUNTER)
            # a mail whose answer is lost on its way back is asked for again, or says so
            one.segment.command("lose 1 any")
            try:
                self.assertEqual(one.read("axis_1", 0x1000), 0x00020192)
            except AssertionError as error:
                self.assertIn("Timeout", str(error))
            self.assertEqual(one.read("axis_1", 0x1000), 0x00020192)

    def test_a_slave_that_falls_out_is_seen_and_comes_back(self):
        with self.bus() as one:
            one.operate()
            one.enable("axis_2", "axis_3")
            one.segment.command("fall axis_2 safeop 0x0050")
            inputs = self.expect(one, COUNTER - 2)  # its outputs are closed
            self.assertEqual(one.ask("states"), [OP, [SAFE_OP_ERROR, 0x0050]] + [OP] * 7)
            self.assertEqual(inputs["axis_2"][STATUS] & 0x4F, 0x08)
            self.assertTrue(bus.is_following(inputs["axis_3"]))
            self.assertEqual(one.read("axis_2", ERROR, 0, 2), 0x7500)
            # without acknowledgement it stays
            one.ask("register", 1, "0x0120", "0800")
            self.expect(one, COUNTER - 2)
            one.ask("register", 1, "0x0120", "1400")
            self.assertEqual(one.ask("states")[1], [4, 0])
            one.ask("register", 1, "0x0120", "0800")
            self.expect(one, COUNTER)
            self.assertEqual(one.ask("states"), [OP] * 9)
            one.enable("axis_2")
            one.segment.command("fall axis_6 init 0x0001")
            self.expect(one, COUNTER - 3)
            self.assertEqual(one.ask("states")[5], [0x11, 0x0001])

    def test_the_watchdog_of_a_slave_stops_its_drive(self):
        with self.bus() as one:
            one.operate()
            one.enable("axis_1", "axis_2")
            one.ask("register", 0, "0x0420", "f401")  # 50 ms
            until = time.monotonic() + 20
            while one.segment.is_op("axis_1") and time.monotonic() < until:
                time.sleep(0.02)
            inputs = self.expect(one, COUNTER - 2)
            self.assertEqual(one.ask("states"), [[SAFE_OP_ERROR, WATCHDOG]] + [OP] * 8)
            self.assertEqual(inputs["axis_1"][STATUS] & 0x4F, 0x08)
            self.assertTrue(one.segment.show()[0]["brake_is_closed"])
            self.assertTrue(bus.is_following(inputs["axis_2"]))

    def test_an_open_cable_is_seen(self):
        with self.bus() as one:
            one.operate()
            one.segment.command("open axis_4")
            self.expect(one, 4 * 3)
            self.assertEqual(one.ask("states"), [OP] * 4 + [None] * 5)
            one.segment.command("close")
            self.expect(one, COUNTER)
            self.assertEqual(one.ask("states"), [OP] * 9)

    def test_a_drive_that_trips_says_why_and_is_reset(self):
        with self.bus() as one:
            one.operate()
            one.enable("axis_1", "axis_2")
            one.segment.command("trip axis_1 0x3210")
            for _ in range(3):
                inputs = self.expect(one, COUNTER)
            self.assertEqual(inputs["axis_1"][STATUS] & 0x4F, 0x08)
            self.assertEqual(one.read("axis_1", ERROR, 0, 2), 0x3210)
            shown = one.segment.show()
            self.assertTrue(shown[0]["brake_is_closed"] and not shown[1]["brake_is_closed"])
            one.enable("axis_1")
            self.assertEqual(one.read("axis_1", ERROR, 0, 2), 0)
            # the command to reset is its edge
            one.targets["axis_1"][CONTROL] = 0x8F
            self.expect(one, COUNTER)
            one.segment.command("trip axis_1 0x4310")
            for _ in range(4):
                inputs = self.expect(one, COUNTER)
            self.assertEqual(inputs["axis_1"][STATUS] & 0x4F, 0x08)
            # a target far away is not followed
            one.targets["axis_2"][TARGET] = 2 * TURN["axis_2"]
            for _ in range(100):
                inputs = self.expect(one, COUNTER)
            self.assertEqual(inputs["axis_2"][STATUS] & 0x204F, 0x2008)
            self.assertEqual(one.read("axis_2", ERROR, 0, 2), 0x8611)


class Ethercrab(Masters, unittest.TestCase):
    def setUp(self):
        if ETHERCRAB is None:
            self.skipTest("ethercrab was not built: no cargo with rustc 1.85, or no network for it")

    def words(self):
        return [ETHERCRAB]


class Soem(Masters, unittest.TestCase):
    def setUp(self):
        if why := os.environ.get("HG_ETHERCAT_NO_SOEM"):
            self.skipTest(f"pysoem cannot be installed: {why}")

    def words(self):
        return [str(PYTHON), str(ROOT / "tests" / "ethercat" / "pysoem_master.py")]


class Frames(unittest.TestCase):
    """Rules of the standard that masters do not try, by hand."""

    def setUp(self):
        self.segment = bus.Segment(SEGMENT)
        self.wire = bus.Wire()

    def tearDown(self):
        self.wire.close()
        self.segment.close()

    def count(self, *words):
        return self.wire.count(*words)

    def read(self, i, address, size):
        data, counter = self.wire.exchange(APRD, (-i, address), bytes(size))
        self.assertEqual(counter, 1)
        return int.from_bytes(data, "little")

    def write(self, i, address, data):
        self.assertEqual(self.count(APWR, (-i, address), data), 1)

    def ask_state(self, i, control):
        """Asks for a state; AL status and code."""
        self.write(i, 0x0120, bytes([control, 0]))
        return self.read(i, 0x0130, 2), self.read(i, 0x0134, 2)

    def configure_manager(self, i, number, start, length, control):
        data = start.to_bytes(2, "little") + length.to_bytes(2, "little") + bytes([control, 0, 1, 0])
        self.write(i, 0x0800 + 8 * number, data)

    def configure_mailbox(self, i):
        self.configure_manager(i, 0, 0x1000, 128, 0x26)
        self.configure_manager(i, 1, 0x1080, 128, 0x22)

    def map(self, i, number, logical, bits, physical, kind):
        """Maps bits (first, last) of the slave to the start of a logical byte."""
        data = (logical.to_bytes(4, "little") + (1).to_bytes(2, "little")
                + bytes([0, bits[1] - bits[0]]) + physical.to_bytes(2, "little")
                + bytes([bits[0], kind, 1, 0, 0, 0]))
        self.write(i, 0x0600 + 16 * number, data)

    def test_counters_follow_the_kind_of_datagram(self):
        slaves = 9
        for i in range(slaves):
            self.write(i, 0x0010, (0x1001 + i).to_bytes(2, "little"))
        register = 0x0420
        here, all_of_them = (0x1003, register), (0, register)
        for command, address, counter in (
                (NOP, here, 0), (APRD, (-2, register), 1), (APWR, (-2, register), 1),
                (APRW, (-2, register), 3), (FPRD, here, 1), (FPWR, here, 1), (FPRW, here, 3),
                (BRD, all_of_them, slaves), (BWR, all_of_them, slaves),
                (BRW, all_of_them, 3 * slaves), (ARMW, (-2, register), slaves),
                (FRMW, here, slaves), (LRD, 0x1000, 0), (LWR, 0x1000, 0), (LRW, 0x1000, 0),
                (APRD, (-slaves, register), 0), (FPRD, (0x2000, register), 0),
                (BRD, (0, 0x3000), 0), (BRD, (0, 0x0910), 8)):
            with self.subTest(command=command, address=address):
                self.assertEqual(self.count(command, address, b"\x10\x27"), counter)
        # what one slave reads those behind it get
        self.write(2, register, b"\x34\x12")
        self.wire.exchange(FRMW, here, b"\0\0")
        self.assertEqual([self.read(i, register, 2) for i in range(slaves)],
                         [0, 0] + [0x1234] * 7)
        # each slave moves a position on, and all values are combined
        self.write(4, register, b"\x00\x80")
        self.wire.send(BRD, all_of_them, b"\0\0")
        source, data, _ = self.wire.receive()
        self.assertEqual((source[0], data), (0x12, b"\x34\x92"))

    def test_states_are_refused_with_their_codes(self):
        drive, panel = 0, 8
        for i, control, status, code in ((drive, 4, 0x11, 0x11), (drive, 8, 0x11, 0x11),
                                         (drive, 3, 0x11, 0x13), (drive, 6, 0x11, 0x12),
                                         (drive, 2, 0x11, 0x16)):
            with self.subTest(control=control):
                self.assertEqual(self.ask_state(i, control | 0x10), (status, code))
        self.configure_manager(drive, 0, 0x1000, 100, 0x26)  # too short
        self.configure_manager(drive, 1, 0x1080, 128, 0x22)
        self.assertEqual(self.ask_state(drive, 0x12), (0x11, 0x16))
        self.configure_mailbox(drive)
        self.assertEqual(self.ask_state(drive, 0x02), (0x11, 0x16))  # not acknowledged
        self.assertEqual(self.ask_state(drive, 0x12), (0x02, 0))
        self.assertEqual(self.ask_state(drive, 0x04), (0x12, 0x1D))
        self.configure_manager(drive, 2, 0x1100, 14, 0x64)
        self.configure_manager(drive, 3, 0x1400, 13, 0x20)
        self.assertEqual(self.ask_state(drive, 0x14), (0x12, 0x1E))
        self.configure_manager(drive, 3, 0x1400, 14, 0x20)
        self.write(drive, 0x0981, b"\x03")
        self.assertEqual(self.ask_state(drive, 0x14), (0x12, 0x30))
        self.write(drive, 0x09A0, (1_000_000).to_bytes(4, "little"))
        self.assertEqual(self.ask_state(drive, 0x14), (0x04, 0))
        # OP waits for outputs, for a second
        self.assertEqual(self.ask_state(drive, 0x08), (0x04, 0))
        time.sleep(1.1)
        self.assertEqual(self.read(drive, 0x0130, 2), 0x14)
        self.assertEqual(self.read(drive, 0x0134, 2), 0x19)
        # a plain slave needs no mailbox
        self.assertEqual(self.ask_state(panel, 0x02), (0x02, 0))

    def test_single_bits_are_mapped(self):
        panel = 8
        self.assertEqual(self.ask_state(panel, 0x02), (0x02, 0))
        self.configure_manager(panel, 0, 0x1100, 1, 0x44)
        self.configure_manager(panel, 1, 0x1400, 1, 0x00)
        self.map(panel, 0, 0x10000, (0, 7), 0x1100, 2)
        self.map(panel, 1, 0x10001, (2, 4), 0x1400, 1)  # inputs 3 to 5
        self.assertEqual(self.count(LRW, 0x10000, b"\0\0"), 0)  # closed in PRE-OP
        self.assertEqual(self.ask_state(panel, 0x04), (0x04, 0))
        self.write(panel, 0x0120, b"\x08\0")
        for channel in ("in3", "in5", "in6"):
            self.segment.command(f"set panel.{channel} 1")
        data, counter = self.wire.exchange(LRW, 0x10000, b"\x81\xff")
        self.assertEqual((data, counter), (b"\x81\xfd", 3))
        self.assertEqual(self.count(LRD, 0x10000, b"\0\0"), 1)
        self.assertEqual(self.count(LWR, 0x10000, b"\x42\0"), 1)
        self.assertEqual(self.read(panel, 0x0130, 2), 8)
        self.assertEqual(self.segment.show()[panel]["outputs"], 0x42)

    def test_mailboxes_are_written_empty_and_read_full(self):
        drive = 1
        self.configure_mailbox(drive)
        self.assertEqual(self.ask_state(drive, 0x02), (0x02, 0))
        to, back = (-drive, 0x1000), (-drive, 0x1080)
        mail = b"\x0a\0\0\0\0\x13\0\x20\x40\0\x10\0\0\0\0\0"  # an upload of 0x1000
        self.assertEqual(self.count(APRD, back, bytes(128)), 0)
        self.assertEqual(self.count(APWR, (-drive, 0x1001), bytes(127)), 0)  # not from its start
        self.assertEqual(self.count(APWR, to, mail.ljust(128, b"\0")), 1)
        self.assertEqual(self.read(drive, 0x080D, 1) & 8, 8)
        answer, counter = self.wire.exchange(APRD, back, bytes(128))
        self.assertEqual((counter, answer[6:16]), (1, b"\0\x30\x43\0\x10\0\x92\x01\x02\0"))
        self.assertEqual(self.count(APRD, back, bytes(128)), 0)
        # the same again, for a master that lost it
        self.write(drive, 0x080E, b"\x03")
        self.assertEqual(self.read(drive, 0x080F, 1) & 2, 2)
        self.assertEqual(self.wire.exchange(APRD, back, bytes(128)), (answer, 1))
        # no file access here
        foe = b"\x06\0\0\0\0\x24\x01\0\0\0\0\0"
        self.assertEqual(self.count(APWR, to, foe.ljust(128, b"\0")), 1)
        answer, _ = self.wire.exchange(APRD, back, bytes(128))
        self.assertEqual(answer[:10], b"\x04\0\0\0\0\x20\x01\0\x02\0")

    def test_the_eeprom_can_be_written(self):
        panel = 8
        for control, errors in ((b"\x01\x02", 0), (b"\x00\x02", 0x60)):
            self.write(panel, 0x0502, control + (4).to_bytes(4, "little") + b"\x34\x12")
            self.assertEqual(self.read(panel, 0x0503, 1), errors)
        self.assertEqual(self.read_eeprom(panel, 4), 0x1234)

    def read_eeprom(self, i, word):
        self.write(i, 0x0502, b"\x00\x01" + word.to_bytes(4, "little"))
        return self.read(i, 0x0508, 2)

    def test_the_eeprom_has_its_checksum(self):
        head = b"".join(self.read_eeprom(0, word).to_bytes(2, "little") for word in range(8))
        crc = 0xFF  # polynomial x^8 + x^2 + x + 1
        for byte in head[:14]:
            crc ^= byte
            for _ in range(8):
                crc = (crc << 1) ^ (0x107 if crc & 0x80 else 0)
        self.assertEqual(head[14], crc)


class Bus(unittest.TestCase):
    """`hapticgiant bus` on the segment."""

    def scan(self, interface=bus.MASTER_END):
        """Exit code and what it said."""
        tried = subprocess.run([PROGRAM, "bus", "scan", interface], capture_output=True, text=True,
                               timeout=100)
        return tried.returncode, tried.stdout + tried.stderr

    def test_scan_lists_the_slaves(self):
        segment = bus.Segment(SEGMENT)
        code, said = self.scan()
        segment.close()
        self.assertEqual(code, 0, said)
        lines = said.splitlines()
        self.assertEqual((lines[0], len(lines)), ("9 slaves on master0", 12))
        for i, words in ((0, "1 0x1000 0x00ffff00 0x00000101 1 1 0 ns PRE-OP CiA 402 drive"),
                         (4, "5 0x1004 0x00ffff01 0x00000205 7 5 1380 ns PRE-OP CiA 402 drive"),
                         (7, "8 0x1007 0x00ffff00 0x00000302 1 8 2415 ns PRE-OP force sensor"),
                         (8, "9 0x1008 0x00ffff00 0x00000401 1 9 - PRE-OP digital I/O")):
            found, wanted = lines[3 + i].split(), words.split()
            if "ns" in wanted:  # a rounded half
                self.assertAlmostEqual(int(found.pop(6)), int(wanted.pop(6)), delta=2)
            self.assertEqual(found, wanted)

    def test_scan_names_what_is_wrong(self):
        code, said = self.scan("nowhere0")
        self.assertEqual((code, said.strip()), (2, "nowhere0: No such device (os error 19)"))
        code, said = self.scan()  # no slave is there
        self.assertEqual(code, 2)
        self.assertIn("master0: no slave answers: is the interface up", said)
        segment = bus.Segment(SEGMENT)
        segment.command("refuse axis_2 0x0016")
        code, said = self.scan()
        self.assertEqual(code, 2)
        self.assertIn("slave 2 of 9 (0x1001) stays in INIT: AL status code 0x0016: ", said)
        segment.command("refuse axis_2 0")
        self.assertEqual(self.scan()[0], 0)
        segment.close()


    def test_watch_names_slaves_that_drop_out(self):
        segment = bus.Segment(SEGMENT)
        watch = subprocess.Popen([PROGRAM, "bus", "watch", bus.MASTER_END, "--seconds", "60",
                                  "--watchdog-ms", "6553"], stdout=subprocess.PIPE, text=True)

        def expect(words):
            # a busy computer may answer late in between
            for line in watch.stdout:
                if words in line:
                    return line
            self.fail("never said: " + words)

        expect("9 slaves in OP, working counter 23")
        self.assertTrue(all(slave["status"] == 8 for slave in segment.show()))
        for command, words in (("miscount axis_3 40", "working counter 20 of 23\n"),
                               ("lose 40", "no answer"),
                               ("fall axis_2 safeop 0x001B",
                                "working counter 21 of 23; slave 2 (0x1001, CiA 402 drive): "
                                "SAFE-OP + error, AL status code 0x001b"),
                               ("open wrist", "; slave 9 (0x1008, digital I/O): does not answer")):
            segment.command(command)
            expect(words)
        watch.send_signal(signal.SIGINT)
        said, _ = watch.communicate(timeout=60)
        self.assertEqual(watch.returncode, 1, said)
        self.assertRegex(said, r"\d+ exchanges, \d+ without an answer, \d+ incomplete")
        wire = bus.Wire()
        self.assertEqual(wire.exchange(FPRD, (0x1000, 0x0420), b"\0\0"), (b"\xfa\xff", 1))
        wire.close()
        segment.close()

    def test_watch_names_slaves_without_watchdog(self):
        with tempfile.NamedTemporaryFile("w") as file:
            file.write("drive a\ndrive b watchdog=off\nimu c watchdog=off\nio d watchdog=off\n")
            file.flush()
            segment = bus.Segment(SEGMENT, file.name)
            tried = subprocess.run([PROGRAM, "bus", "watch", bus.MASTER_END, "--seconds", "0.1"],
                                   capture_output=True, text=True, timeout=100)
            segment.close()
        found = re.findall(r"slave (\d) .*: its watchdog is switched off \(bit 6 of the control byte "
                           r"(0x..) of sync manager (\d)\)", tried.stdout)
        self.assertEqual(found, [("2", "0x24", "2"), ("4", "0x04", "0")], tried.stdout + tried.stderr)

    def test_watch_counts_and_ends(self):
        segment = bus.Segment(SEGMENT)
        tried = subprocess.run([PROGRAM, "bus", "watch", bus.MASTER_END, "--seconds", "0.1"],
                               capture_output=True, text=True, timeout=100)
        self.assertIn(tried.returncode, (0, 1), tried.stderr)
        is_clean = ", 0 without an answer, 0 incomplete" in tried.stdout
        self.assertEqual(tried.returncode == 0, is_clean, tried.stdout)
        segment.close()


class Words(unittest.TestCase):
    """Commands and files of people who make mistakes."""

    def test_wrong_commands_are_explained(self):
        segment = bus.Segment(SEGMENT)
        for command, words in (("trip axis_9 1", "no slave 'axis_9'; there are axis_1, axis_2"),
                               ("set imu.bx 1", "'imu' has no channel 'bx'; it has ax, ay"),
                               ("set imu.ax much", "expected a number, got 'much'"),
                               ("fall imu off 1", "expected init, preop or safeop, got 'off'"),
                               ("trip panel 1", "'panel' has no faults"),
                               ("brake imu", "'imu' has no brake"),
                               ("trip axis_1 0x12345", "expected a code of 16 bits"),
                               ("after 5", "cannot read 'after 5'"),
                               ("loose 1", "cannot read 'loose 1'; commands: after, lose")):
            with self.subTest(command):
                self.assertIn("error: " + words, segment.ask(command))
        segment.close()

    def test_wrong_files_are_explained(self):
        for text, words in (("", "no slaves: expected lines such as 'drive axis_1'"),
                            ("dirve a", "line 1: unknown kind 'dirve', expected drive, imu"),
                            ("\nimu product=2", "line 2: expected a name behind the kind"),
                            ("io a\nio a", "line 2: there is a slave 'a' already"),
                            ("imu a turn=9", "line 1: unknown key 'turn', expected vendor"),
                            ("drive a drift=5000", "drift: expected a number from -1000 to 1000"),
                            ("drive a watchdog=no", "watchdog: expected on or off, got 'no'"),
                            ("drive a joint=8", "joint: expected 1 to 7, got '8'"),
                            ("drive a mapping=any",
                             "mapping: expected free, fixed or joint, got 'any'")):
            with self.subTest(text), tempfile.NamedTemporaryFile("w") as file:
                file.write(text)
                file.flush()
                tried = subprocess.run([SEGMENT, bus.SEGMENT_END, file.name], capture_output=True,
                                       text=True)
                self.assertEqual(tried.returncode, 2)
                self.assertIn(words, tried.stderr)
        tried = subprocess.run([SEGMENT, "nowhere0", bus.MACHINE], capture_output=True, text=True)
        self.assertIn("segment: nowhere0: No such device", tried.stderr)

    def test_the_table_of_the_page_has_all_commands(self):
        segment = bus.Segment(SEGMENT)
        commands = segment.ask("?").split("commands: ")[1].split(", ")
        segment.close()
        self.assertEqual(bus.undocumented(COMMANDS.read_text(), commands), [])


def main():
    global PROGRAM, SEGMENT, ETHERCRAB
    if bus.INSIDE not in os.environ:
        os.environ["HG_ETHERCAT_NO_SOEM"] = make_environment(VENV, REQUIREMENTS)
        print(f"ethercat: skipped, {bus.enter_namespace()}")
        return SKIPPED
    bus.make_interfaces()
    programs = [word for word in sys.argv[1:4] if not word.startswith("-") and "/" in word]
    PROGRAM, SEGMENT, ETHERCRAB = (programs + [None])[:3]
    result = unittest.main(argv=[sys.argv[0], *sys.argv[1 + len(programs):]], exit=False).result
    if not result.wasSuccessful():
        return 1
    for test, why in result.skipped[:1]:
        print(f"ethercat: {len(result.skipped)} tests skipped: {why}")
    return SKIPPED if result.skipped else 0


if __name__ == "__main__":
    sys.exit(main())
