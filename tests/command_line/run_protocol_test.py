"""`hapticgiant run --request --report-to`: runs played by other programs (docs/reference/run_protocol.md).

Usage: run_protocol_test.py PROGRAM   (from the repository root)
"""

import json
import os
import pathlib
import signal
import subprocess
import time
import unittest

from program import PROGRAM, TemporaryFolder

QUIET = {"recording": False, "flight_recorder": "off"}
FAST = {**QUIET, "fast": True}


class Played:
    """A run by a request on standard input; its reports come through a pipe."""

    def __init__(self, request, *words, reads=True):
        self.reports_end, write_end = os.pipe()
        self.process = subprocess.Popen(
            [PROGRAM, "run", "--request", "-", "--report-to", str(write_end), *words], pass_fds=(write_end,),
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        os.close(write_end)
        self.process.stdin.write(request if isinstance(request, str) else json.dumps(request))
        self.process.stdin.close()
        self.process.stdin = None
        self.reports = open(self.reports_end, encoding="utf-8") if reads else None

    def next(self, key):
        """The next report of this kind."""
        for line in self.reports:
            if next(iter(report := json.loads(line))) == key:
                return report
        raise AssertionError(f"the reports have ended without {key}")

    def end(self):
        """All reports that are left, exit code, standard output and error."""
        reports = [json.loads(line) for line in self.reports] if self.reports else []
        out, err = self.process.communicate(timeout=60)
        if self.reports:
            self.reports.close()
        return reports, self.process.returncode, out, err


def kinds(reports):
    return [next(iter(report)) for report in reports]


class RunProtocol(TemporaryFolder):
    def test_reports_that_a_full_disk_takes_are_missing_and_the_exit_code_says_so(self):
        with open("/dev/full", "wb", buffering=0) as full:
            done = subprocess.run([PROGRAM, "run", "door", "--fast", "--no-viewer", "--no-recording", "--report-to",
                                   str(full.fileno())], pass_fds=(full.fileno(),), capture_output=True, text=True,
                                  check=False)
        self.assertEqual(done.returncode, 4)
        self.assertIn("No space left on device: reports are missing", done.stderr)

    def test_a_run_takes_one_request_and_says_what_happens(self):
        reports, code, out, err = Played({**FAST, "scenario": "door"}).end()
        self.assertEqual((code, err), (0, ""))
        phases = [report["phase"] for report in reports if "phase" in report]
        first = [phases.index(name) for name in ("ready", "armed", "running", "stopping", "over")]
        self.assertEqual(first, sorted(first))
        self.assertEqual(phases[-1], "over")
        self.assertIn("locked", [report["event"] for report in reports if "event" in report])
        self.assertEqual(kinds(reports)[-1], "summary")
        self.assertEqual(reports[-1]["exit_code"], 0)
        summary = self.folder / "summary.json"
        subprocess.run([PROGRAM, "run", "door", "--fast", "--no-recording", "--flight-recorder", "off",
                        "--summary", summary], check=True, capture_output=True)
        written = json.loads(summary.read_text())
        self.assertEqual(reports[-1]["summary"]["state_hash"], written["state_hash"])
        self.assertEqual(reports[-1]["summary"].keys(), written.keys())
        self.assertIn("HapticGiant", out)

    def test_the_options_of_a_request_are_those_of_the_command_line(self):
        words = ["free_space", "--seed", "7", "--duration", "1", "--set", "twin.mass_scale=2", "--law", "paper"]
        request = {"scenario": "free_space", "seed": 7, "duration": 1, "set": ["twin.mass_scale=2"], "law": "paper"}
        summary = self.folder / "summary.json"
        subprocess.run([PROGRAM, "run", *words, "--fast", "--no-recording", "--flight-recorder", "off",
                        "--summary", summary], check=False, capture_output=True)
        reports, *_ = Played({**FAST, **request}).end()
        self.assertEqual(reports[-1]["summary"]["state_hash"], json.loads(summary.read_text())["state_hash"])

    def test_a_request_that_is_wrong_is_refused_on_the_pipe_too(self):
        for request, message in (({"duratio": 3}, "did you mean 'duration'?"), ("[1]", "one JSON object"),
                                 ({"scenario": "dor"}, "did you mean 'door'?"),
                                 ({"user": "mouse", **FAST}, "needs --duration")):
            with self.subTest(request):
                reports, code, _, err = Played(request).end()
                self.assertEqual((code, kinds(reports)), (2, ["refused"]))
                self.assertIn(message, reports[0]["refused"])
                self.assertIn(message, err)

    def test_options_beside_a_request_are_refused(self):
        reports, code, _, err = Played(FAST, "--fast").end()
        self.assertEqual((reports, code), ([], 2))
        self.assertIn("--fast: --request has all options of the run, leave it out", err)

    def test_only_a_descriptor_of_its_own_is_written_to(self):
        for number in ("1", "99"):
            done = subprocess.run([PROGRAM, "run", "door", "--fast", "--report-to", number],
                                  capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn("--report-to: expected a descriptor from 3 on", done.stderr)

    def test_sigint_ends_a_run_in_order(self):
        played = Played({"scenario": "free_space", "viewer": False, "duration": 600, "priority": 0,
                         "recordings": str(self.folder)})
        while played.next("phase")["phase"] != "running":
            pass
        self.assertEqual(played.next("status")["status"]["mode"], "running")
        played.process.send_signal(signal.SIGINT)
        reports, code, _, _ = played.end()
        self.assertEqual(code, 0)
        self.assertTrue(reports[-1]["summary"]["interrupted"])
        if recording := reports[-1]["summary"]["recording"]:
            self.assertTrue(pathlib.Path(recording).is_file())

    def test_a_reader_that_reads_nothing_holds_nothing_up(self):
        played = Played({"scenario": "free_space", "viewer": False, "duration": 3, "priority": 0, **QUIET}, reads=False)
        self.addCleanup(os.close, played.reports_end)
        start = time.monotonic()
        self.assertIn(played.end()[1], (0, 1))
        self.assertLess(time.monotonic() - start, 30)

    def test_a_reader_that_has_gone_ends_nothing(self):
        summary = self.folder / "summary.json"
        played = Played({**FAST, "scenario": "door"}, "--summary", str(summary), reads=False)
        os.close(played.reports_end)
        self.assertEqual(played.end()[1], 0)
        self.assertIn("state_hash", json.loads(summary.read_text()))


if __name__ == "__main__":
    unittest.main()
