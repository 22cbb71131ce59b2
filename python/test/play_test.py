"""hapticgiant.play(): whole runs inside Python; needs the extension _run, which comes with the program."""

import importlib.util
import os
import pathlib
import signal
import subprocess
import tempfile
import threading
import unittest

import hapticgiant

QUIET = {"fast": True, "recording": False, "flight_recorder": "off"}


@unittest.skipUnless(importlib.util.find_spec("hapticgiant._run"), "without the program")
class Play(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_two_runs_have_the_state_of_the_program(self):
        events = []
        first = hapticgiant.play("door", **QUIET, on_event=events.append)
        again = hapticgiant.play("door", **QUIET)
        self.assertEqual((first.exit_code, first.recording), (0, None))
        self.assertEqual(first.summary["state_hash"], again.summary["state_hash"])
        phases = [each["phase"] for each in events if "phase" in each]
        begins = [phases.index(name) for name in ("armed", "running", "over")]
        self.assertEqual(begins, sorted(begins))
        self.assertEqual(phases[-1], "over")
        self.assertEqual(events[-1]["summary"]["state_hash"], first.summary["state_hash"])
        names = [each["event"] for each in events if "event" in each]
        self.assertIn("locked", names)
        if program := os.environ.get("HAPTICGIANT_PROGRAM"):
            summary = self.folder / "summary.json"
            subprocess.run([program, "run", "door", "--fast", "--no-recording", "--flight-recorder", "off",
                            "--summary", summary], check=True, capture_output=True)
            self.assertIn(first.summary["state_hash"], summary.read_text())

    def test_ctrl_c_ends_a_run_in_order(self):
        def interrupt(report):
            if report.get("phase") == "running":
                threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT)).start()

        # a shell's background job begins with Ctrl-C ignored
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        with self.assertRaises(KeyboardInterrupt) as ended:
            hapticgiant.play("free_space", duration=600, viewer=False, recordings=str(self.folder),
                             despite=[], priority=0, on_event=interrupt)
        outcome = ended.exception.outcome
        self.assertTrue(outcome.summary["interrupted"])
        self.assertEqual(outcome.exit_code, 0)
        if outcome.recording is not None:
            self.assertGreater(len(hapticgiant.read_recording(outcome.recording)["time_s"]), 100)

    def test_what_on_event_raises_ends_the_run_and_comes_out(self):
        def fail(report):
            if "status" in report:
                raise ValueError("enough")

        with self.assertRaisesRegex(ValueError, "enough"):
            hapticgiant.play("door", **QUIET, duration=600, on_event=fail)

    def test_bad_input_is_a_setup_error(self):
        for options, message in (({"scenario": "dor"}, "did you mean 'door'"),
                                 ({"duratio": 3}, "did you mean 'duration'"),
                                 ({"duration": 0}, "--duration: must be more than 0"),
                                 ({"fast": 1}, "--fast: expected true or false")):
            with self.subTest(options), self.assertRaisesRegex(hapticgiant.SetupError, message):
                hapticgiant.play(**{**QUIET, **options})


if __name__ == "__main__":
    unittest.main()
