"""`hapticgiant run --lsl`: what pylsl receives is what the recording of the same run has.

Usage: lab_streams_test.py BUILD PROGRAM   (from the repository root). Ends with 77 where pylsl cannot
be installed.
"""

import os
import pathlib
import re
import subprocess
import sys
import unittest

import numpy as np

BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
sys.path[:0] = ["tests/command_line", "tests/packages"]
import recorded  # noqa: E402
from environment import make_environment  # noqa: E402
from lab_network import CONFIGURATION  # noqa: E402
from program import PROGRAM, TemporaryFolder  # noqa: E402

JUDGES = BUILD.parent / "connect_venv"
SECONDS = 4


class Streams(TemporaryFolder):
    def setUp(self):
        super().setUp()
        (self.folder / "lsl.cfg").write_text(CONFIGURATION.format(session=os.getpid()))
        (self.library,) = JUDGES.glob("lib/python3*/site-packages/pylsl/lib/liblsl.so")
        self.environment = {**os.environ, "LSLAPICFG": str(self.folder / "lsl.cfg"),
                            "PYLSL_LIB": str(self.library)}

    def start(self, *options, **environment):
        return subprocess.Popen(
            [PROGRAM, "run", "door", "--lsl", "--no-viewer", "--priority", "0", "--recordings",
             self.folder, *options], env={**self.environment, **environment}, text=True,
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def check_numbers(self, values, records):
        """Every number is that of the recording."""
        for prefix, entries, of in (("position", "xyz", lambda r: r.handle.p),
                                    ("velocity", "xyz", lambda r: r.v_h),
                                    ("force", "xyz", lambda r: r.robot.w_h[:3]),
                                    ("torque", "xyz", lambda r: r.robot.w_h[3:])):
            got = np.column_stack([values[f"{prefix}.{entry}"] for entry in entries])
            np.testing.assert_array_equal(got, [of(record) for record in records], prefix)
        for i, joint in enumerate(("hinge", "lever")):
            np.testing.assert_array_equal(values[f"twin.{joint}"],
                                          [record.twin.q_a[i] for record in records])
        got = np.column_stack([values[f"orientation.q{entry}"] for entry in "xyzw"])
        expected = np.array([recorded.quaternion(record.handle.r) for record in records])
        self.assertLess(np.abs(np.abs((got * expected).sum(axis=1)) - 1).max(), 1e-12)
        # angular velocity: turns of the handle between samples
        for k in (1, len(records) // 2, len(records) - 1):
            before, after = (np.reshape(records[k - n].handle.r, (3, 3)) for n in (1, 0))
            skew = (after @ before.T - (after @ before.T).T) / 2 / 1e-3
            np.testing.assert_allclose([values[f"angular_velocity.{e}"][k] for e in "xyz"],
                                       [skew[2, 1], skew[0, 2], skew[1, 0]], atol=1e-6)

    def test_a_reader_gets_the_samples_and_events_of_the_recording(self):
        received = self.folder / "received.npz"
        environment = dict(self.environment)
        reader = subprocess.Popen([JUDGES / "bin" / "python", "tests/connect/lab_streams_reader.py",
                                   received], env=environment, stdout=subprocess.PIPE, text=True)
        self.assertEqual(reader.stdout.readline(), "looking\n")
        run = self.start("--duration", str(SECONDS))
        out, err = run.communicate(timeout=120)
        self.assertEqual(reader.stdout.readline(), "ready\n")
        reader.communicate(timeout=60)
        self.assertEqual(err, "")

        stream = np.load(received)
        samples = recorded.samples((self.folder / "latest.mcap").resolve())
        events = recorded.events((self.folder / "latest.mcap").resolve())
        sent = re.search(r"lab streams +(\d+) samples, (\d+) markers$", out, re.MULTILINE)
        self.assertEqual(int(sent[1]), len(samples), out)
        self.assertEqual(int(sent[2]), len(events), out)

        # no gap from the first sample that the reader saw to the end of the run
        values = {label: stream["values"][:, i] for i, (label, _) in enumerate(stream["labels"])}
        by_time = {sample.record.time_s: sample.record for sample in samples}
        first = samples.index(next(s for s in samples if s.record.time_s == values["time"][0]))
        records = [sample.record for sample in samples[first:]]
        np.testing.assert_array_equal(values["time"], [record.time_s for record in records])
        self.assertGreater(len(records), 500, "the reader came too late to show anything")
        self.assertEqual(len(by_time), len(samples))

        self.check_numbers(values, records)

        # the clock: the offset that the recording names, in the order of its events
        offsets = np.array(recorded.lab_clock((self.folder / "latest.mcap").resolve()))
        self.assertTrue(len(offsets))
        for offset in stream["times"] - values["time"]:
            self.assertLess(np.abs(offsets - offset).min(), 1e-6)
        self.assertTrue((np.diff(stream["times"]) > 0).all())
        self.assertGreater(stream["delays"].min(), 0.0)
        self.assertLess(stream["delays"].min(), 0.1)

        markers = [(f"{name}: {text}" if text else name) for _, name, text in events]
        received = [str(text) for text in stream["texts"]]
        self.assertEqual(received, markers[len(markers) - len(received):])
        self.assertTrue(any("t_a" in text for text in received), received)

        self.assertEqual((float(stream["rate"]), str(stream["type"])), (1000.0, "Haptics"))
        units = dict(map(tuple, stream["labels"]))
        for label, unit in (("time", "s"), ("position.x", "m"), ("force.z", "N"),
                            ("torque.z", "Nm"), ("twin.hinge", "rad")):
            self.assertEqual(units[label], unit)

    def test_a_run_that_ends_before_the_clock_is_known_is_sent_nevertheless(self):
        out, err = self.start("--duration", "0.05").communicate(timeout=60)
        samples = recorded.samples((self.folder / "latest.mcap").resolve())
        sent = re.search(r"lab streams +(\d+) samples, (\d+) markers$", out, re.MULTILINE)
        self.assertTrue(sent, out + err)
        self.assertEqual(int(sent[1]), len(samples), out)

    def test_without_the_library_no_run_begins(self):
        run = self.start(PYLSL_LIB=str(self.folder / "none.so"))
        out, err = run.communicate(timeout=60)
        self.assertEqual((run.returncode, out), (2, ""))
        self.assertIn(f"needs liblsl, which is in none of these: {self.folder}/none.so", err)
        self.assertIn("pip install pylsl", err)
        self.assertFalse(list(self.folder.glob("*.mcap")))

    def test_another_library_is_refused_by_the_function_that_it_lacks(self):
        run = self.start(PYLSL_LIB="libz.so.1")
        _, err = run.communicate(timeout=60)
        self.assertEqual(run.returncode, 2)
        self.assertIn("libz.so.1 has no lsl_create_streaminfo", err)

    def test_a_run_as_fast_as_it_can_has_no_time_to_share(self):
        run = self.start("--fast")
        _, err = run.communicate(timeout=60)
        self.assertEqual(run.returncode, 2)
        self.assertIn("--fast", err)


if __name__ == "__main__":
    why = make_environment(JUDGES, pathlib.Path("tools/requirements-connect.txt").resolve())
    if why:
        print(f"skipped: pylsl cannot be installed: {why}")
        sys.exit(77)
    unittest.main()
