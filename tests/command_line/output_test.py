"""Where the program prints to: closed descriptors, full disks, pipes that close, terminals.

Usage: output_test.py PROGRAM   (from the repository root)
"""

import contextlib
import json
import os
import re
import signal
import subprocess
import time
import unittest

from program import MODELS, PROGRAM, TemporaryFolder, run

NOT_WRITTEN = 4
SHORT = ("--fast", "--no-viewer", "--user", "none", "--duration", "0.5")
ESCAPE = "\x1b]0;x\x07"
# what a terminal takes for more than text, as characters and as bytes that are none
CONTROL = re.compile(rb"[\x00-\x08\x0b-\x1f\x7f]|\xc2[\x80-\x9f]")


class ClosedDescriptors(TemporaryFolder):
    """A program that is started with `>&-` and the like."""

    def play(self, *closed):
        folder = self.folder / "_".join(map(str, closed))
        streams = {1: subprocess.PIPE, 2: subprocess.PIPE}
        process = subprocess.Popen(
            [PROGRAM, "run", "door", *SHORT, "--recordings", folder], stdin=subprocess.DEVNULL,
            stdout=streams[1], stderr=streams[2], text=True,
            preexec_fn=lambda: [os.close(each) for each in closed])
        out, err = process.communicate(timeout=60)
        file, = (f for f in folder.glob("*.mcap") if not f.is_symlink())
        return process.returncode, out, err, file

    def test_nothing_is_printed_into_files_of_the_program(self):
        for closed in ((0,), (1,), (2,), (0, 1), (1, 2), (0, 1, 2)):
            code, out, err, file = self.play(*closed)
            self.assertEqual(code, NOT_WRITTEN if 1 in closed else 0, (closed, out, err))
            self.assertEqual("HapticGiant" in out, 1 not in closed, closed)
            if 1 in closed and 2 not in closed:
                self.assertEqual(err, "standard output could not be written: Bad file descriptor\n")
            whole = file.read_bytes()
            self.assertNotIn(b"HapticGiant ", whole)
            self.assertTrue(whole.startswith(b"\x89MCAP0\r\n"), closed)
            self.assertEqual(run("explain", file)[0], 0, closed)


class Unwritable(TemporaryFolder):
    def to(self, stdout, *arguments):
        done = subprocess.run([PROGRAM, *map(str, arguments)], stdin=subprocess.DEVNULL,
                              stdout=stdout, stderr=subprocess.PIPE, text=True, timeout=120)
        return done.returncode, done.stderr

    def test_a_result_that_cannot_be_printed_is_reported(self):
        file = self.folder / "r"
        code, out, _ = run("run", "door", *SHORT, "--recordings", file)
        self.assertEqual(code, 0, out)
        recording = file / "latest.mcap"
        commands = (("--version",), ("--help",), ("run", "--help"),
                    ("run", "door", *SHORT, "--no-recording"),
                    ("check", MODELS / "haptic_giant/device.yaml"),
                    ("doctor", "--seconds", "0.1"), ("explain", recording),
                    ("replay", recording), ("compare", recording, recording),
                    ("hqp", "solve", "tests/reference/exc_two.hqp.gz", "--problem", "7"),
                    ("identify", "payload", "--poses", "12"),
                    ("new", "twin", MODELS / "examples/gate.urdf", "-o", self.folder / "t.yaml"))
        with open("/dev/full", "w") as full:
            for command in commands:
                code, err = self.to(full, *command)
                self.assertIn(code, (1, NOT_WRITTEN) if command[0] == "doctor" else (NOT_WRITTEN,),
                              (command, err))
                self.assertEqual(err.splitlines()[-1], "standard output could not be written: "
                                 "No space left on device", command)
                self.assertEqual(err.count("standard output"), 1)

    def test_what_is_worse_keeps_its_exit_code(self):
        with open("/dev/full", "w") as full:
            code, err = self.to(full, "check", "nowhere.yaml")
        self.assertEqual(code, 2, err)

    def test_a_reader_who_goes_ends_the_program_without_a_word(self):
        reads, writes = os.pipe()
        os.close(reads)
        try:
            code, err = self.to(writes, "check", MODELS / "haptic_giant/device.yaml")
            self.assertEqual((code, err), (-13, ""))  # SIGPIPE
            code, err = self.to(writes, "run", "door", *SHORT, "--no-recording")
            self.assertEqual((code, err), (0, ""))  # continues
        finally:
            os.close(writes)


class Bursts(TemporaryFolder):
    """More text at once than a pipe takes."""

    def play(self, *arguments, letters, **options):
        text = (MODELS / "scenarios/door.yaml").read_text().replace("../", f"{MODELS}/")
        scenario = self.folder / "door.yaml"
        scenario.write_text(re.sub(r"(?m)^title:.*$", "title: " + letters * "x", text))
        process = subprocess.Popen(
            [PROGRAM, "run", scenario, "--no-viewer", "--user", "none", "--no-recording",
             *arguments], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        return process

    def test_a_long_text_is_whole(self):
        process = self.play("--fast", "--duration", "0.5", letters=100_000)
        out, err = process.communicate(timeout=60)
        self.assertEqual((process.returncode, err), (0, ""))
        self.assertEqual(out.count("x" * 100_000), 2)  # at the beginning and in the summary

    def test_an_unread_summary_is_reported(self):
        process = self.play("--duration", "600", letters=100_000)
        process.stdout.read(1)  # no more than that, and what the reader takes along
        process.send_signal(signal.SIGINT)
        err = process.stderr.read()
        self.assertEqual(process.wait(timeout=60), NOT_WRITTEN)
        self.assertRegex(err, r"^standard output could not be written: \d+ texts? not read\n$")
        process.stdout.close()
        process.stderr.close()


class FullPipe(TemporaryFolder):
    def test_an_unread_start_test_keeps_its_result_and_ends(self):
        reads, writes = os.pipe()
        os.set_blocking(writes, False)
        with contextlib.suppress(BlockingIOError):
            while True:
                os.write(writes, bytes(4096))
        os.set_blocking(writes, True)
        process = subprocess.Popen([PROGRAM, "start-test", "--recordings", self.folder],
                                   stdout=writes, stderr=subprocess.PIPE, text=True)
        os.close(writes)
        self.addCleanup(os.close, reads)
        self.addCleanup(process.kill)
        file = self.folder / "start_test_HapticGiant_simulated.json"
        deadline = time.monotonic() + 120.0
        while not (file.exists() and json.loads(file.read_text())["items"]):
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        err = process.communicate(timeout=60)[1]
        self.assertEqual(process.returncode, NOT_WRITTEN)
        self.assertIn("not read", err)


class Escapes(TemporaryFolder):
    """Titles, names and recordings say nothing to a terminal but text."""

    def prints_text_only(self, *arguments):
        done = subprocess.run([PROGRAM, *map(str, arguments)], stdin=subprocess.DEVNULL,
                              capture_output=True, timeout=120)
        for stream in (done.stdout, done.stderr):
            self.assertIsNone(CONTROL.search(stream), stream)
        return (done.stdout + done.stderr).decode()

    def test_of_a_title_an_event_and_a_file(self):
        text = (MODELS / "scenarios/door.yaml").read_text().replace("../", f"{MODELS}/")
        quoted = '"{}\\e]0;x\\a\\x7f\\u009b2J"'
        text = re.sub(r"(?m)^title:.*$", lambda _: "title: " + quoted.format("Door"), text)
        text, count = re.subn(r"(?m)^(  - \{?name: ?)\w+", lambda m: m[1] + quoted.format("event"),
                              text, count=1)
        scenario = self.folder / f"door{ESCAPE}.yaml"
        scenario.write_text(text)
        self.assertEqual(count, 1)
        out = self.prints_text_only("run", scenario, "--fast", "--no-viewer", "--recordings",
                                    self.folder / "r")
        self.assertIn(r"Door\x1b]0;x\x07\x7f\xc2\x9b2J", out)
        file, = (f for f in self.folder.glob("r/*.mcap") if not f.is_symlink())
        for command in ("explain", "replay"):
            out = self.prints_text_only(command, file)
            self.assertIn(r"Door\x1b]0;x\x07", out)
            self.assertIn(r"event\x1b]0;x\x07", out)
        self.assertIn(r"door\x1b]0;x\x07.yaml: scenario", self.prints_text_only("check", scenario))
        self.assertIn(r"\x1b]0;x\x07", self.prints_text_only("run", ESCAPE))
        self.assertIn(r"\xe0\x80\x9b\xe2\x80\xae",
                      self.prints_text_only("run", b"\xe0\x80\x9b".decode(errors="surrogateescape")
                                            + "\u202e"))
        self.assertIn(r"\x1b]0;x\x07", self.prints_text_only(ESCAPE))
        self.assertIn(r"\x1b]0;x\x07", self.prints_text_only("run", f"--{ESCAPE}"))

    def test_of_a_urdf(self):
        device = self.folder / "arm.urdf"
        text = (MODELS / "examples/arm.urdf").read_text()
        joint = re.search(r'<joint name="([^"]+)"', text)[1]
        device.write_text(text.replace(f'"{joint}"', f'"{joint}\x7f\u009b"'))
        out = self.prints_text_only("new", "device", device, "-o", self.folder / "device.yaml")
        out += self.prints_text_only("check", self.folder / "device.yaml")
        self.assertIn(joint + r"\x7f\xc2\x9b", out)


if __name__ == "__main__":
    unittest.main()
