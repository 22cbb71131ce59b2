"""A run whose disk takes no more: what is reported, what is kept.

Usage: disk_test.py PROGRAM   (from the repository root)
"""

import contextlib
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import time
import unittest

from program import MODELS, PROGRAM, TemporaryFolder, run
from web_socket import Page

NOT_WRITTEN = 4


class FullDisk(TemporaryFolder):
    def setUp(self):
        super().setUp()
        self.temporary = self.folder / "temporary"
        self.temporary.mkdir()

    def play(self, recordings, *options, limit=resource.RLIM_INFINITY):
        summary = self.folder / "summary.json"
        done = subprocess.run(
            [PROGRAM, "run", "door", "--fast", "--no-viewer", "--recordings", recordings,
             "--summary", summary, *options], stdin=subprocess.DEVNULL, capture_output=True,
            text=True, timeout=300, env={**os.environ, "TMPDIR": str(self.temporary)},
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
        return done.returncode, done.stdout, done.stderr, json.loads(summary.read_text())

    def is_reported(self, why, code, out, err, reported):
        self.assertEqual(code, NOT_WRITTEN, out + err)
        reported_at, = (n for n, line in enumerate(out.splitlines())
                        if "has ended early, the run continues: " + why in line)
        self.assertTrue(any(" unlocked " in line for line in out.splitlines()[reported_at:]), out)
        self.assertIn(f"{reported['unrecorded_samples']} samples of the recording: {why}", out)
        self.assertIn("recording ended early: " + why, err)
        self.assertTrue(reported["recording_error"].startswith(why))
        self.assertEqual(reported["missing_events"], [])
        code, out, err = run("explain", reported["recording"])
        self.assertEqual((code, err), (0, ""))
        kept = int(re.search(r" (\d+) samples; CUT OFF", out)[1])
        # a chunk of 250 samples without its index counts as lost and can be read all the same
        self.assertIn(kept - reported["cycles"] + reported["unrecorded_samples"], range(0, 251))

    def test_a_limit_of_file_sizes_ends_the_recording_not_the_run(self):
        result = self.play(self.folder / "r", limit=1_000_000)
        self.is_reported("File too large", *result)
        self.assertIn("the last seconds could not be written", result[2])

    def test_the_last_seconds_go_among_the_temporary_files(self):
        disk = self.folder / "disk"
        disk.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "none", disk],
                          capture_output=True).returncode != 0:
            self.skipTest("may not mount")
        with contextlib.ExitStack() as stack:
            stack.callback(subprocess.run, ["umount", disk], check=True)
            result = self.play(disk)
            self.is_reported("No space left on device", *result)
            self.assertNotIn("the last seconds could not be written", result[2])
            file, = self.temporary.glob("hapticgiant_*/door_stop_*.mcap")
            self.assertIn(f"explain {file}", result[1])
            code, out, err = run("explain", file)
            self.assertEqual((code, err), (0, ""))
            self.assertIn(" 10000 samples\n", out)
            self.assertEqual(len([f for f in disk.glob("*.mcap") if not f.is_symlink()]), 1)

    def harm(self, harm):
        """What a run says whose recording is harmed after half a second."""
        recordings, summary = self.folder / "r", self.folder / "summary.json"
        process = subprocess.Popen(
            [PROGRAM, "run", "door", "--user", "none", "--duration", "5", "--no-viewer",
             "--recordings", recordings, "--summary", summary], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, text=True, env={**os.environ, "TMPDIR": str(self.temporary)})
        self.addCleanup(process.kill)
        while not (files := list(recordings.glob("*.partial.mcap"))) or (
                files[0].stat().st_size < 50_000):
            self.assertIsNone(process.poll())
            time.sleep(0.05)
        harm(files[0])
        out, err = process.communicate(timeout=120)
        return process.returncode, out, err, json.loads(summary.read_text())

    def test_a_deleted_or_truncated_recording_is_lost(self):
        for harm, why, named in (
                (pathlib.Path.unlink, "the file was deleted, moved or replaced", "none"),
                (lambda file: os.truncate(file, 3000), "the file was changed: it had", ".partial.mcap"),
                (lambda file: shutil.rmtree(file.parent), "the file was deleted", "none")):
            code, out, err, reported = self.harm(harm)
            self.assertEqual(code, NOT_WRITTEN, out + err)
            self.assertIn("has ended early, the run continues: " + why, out)
            self.assertRegex(out, rf"recording +(\S+{named}|{named})\n")
            self.assertIn(f"{reported['cycles']} samples of the recording: {why}", out)
            self.assertEqual(reported["unrecorded_samples"], reported["cycles"])
            kept = re.search(r"explain (\S+)", out)[1]  # the last seconds
            code, out, err = run("explain", kept)
            self.assertEqual((code, err), (0, ""))
            self.assertIn(f" {reported['cycles']} samples\n", out)
            shutil.rmtree(self.folder / "r", ignore_errors=True)

    def test_what_has_the_name_of_a_recording_or_of_the_link_stays(self):
        recordings = self.folder / "r"
        recordings.mkdir()
        (recordings / "latest.mcap").write_text("mine")
        process = subprocess.Popen(
            [PROGRAM, "run", "door", "--user", "none", "--duration", "600", "--no-viewer",
             "--recordings", recordings], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        process.stdout.readline()
        partial, = recordings.glob("*.partial.mcap")
        (recordings / partial.name.replace(".partial", "")).mkdir()
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
        self.assertEqual(process.returncode, NOT_WRITTEN, out + err)
        self.assertIn(f"the recording is complete, but keeps its name {partial}: ", err)
        self.assertIn("latest.mcap is no link of this program and stays as it is", out)
        self.assertEqual((recordings / "latest.mcap").read_text(), "mine")
        code, out, err = run("explain", partial)
        self.assertEqual((code, err), (0, ""))
        self.assertNotIn("CUT OFF", out)

    def test_the_page_gets_the_event_when_it_happens(self):
        shutil.copytree(MODELS, self.folder / "models")  # the page is looked for beside models
        (self.folder / "viewer/dist").mkdir(parents=True)
        (self.folder / "viewer/dist/index.html").write_text("the page")
        process = subprocess.Popen(
            [PROGRAM, "run", "door", "--no-browser", "--duration", "600", "--recordings",
             self.folder / "r"], cwd=self.folder, text=True, stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (500_000, 500_000)))
        try:
            while not (link := re.search(r"http://\S+", process.stdout.readline())):
                self.assertIsNone(process.poll())
            page = Page(link[0])
            self.addCleanup(page.close)
            event = page.next("event", lambda event: event["name"] == "recording")
            self.assertIn("has ended early, the run continues: File too large", json.dumps(event))
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=60)
            self.assertEqual(process.returncode, NOT_WRITTEN)
        finally:
            process.kill()
            process.communicate()

    def test_a_summary_that_cannot_be_written_affects_nothing_else(self):
        code, out, err = run("run", "door", "--fast", "--no-recording", "--summary", "/dev/full")
        self.assertEqual(code, NOT_WRITTEN, out)
        self.assertEqual(err, "/dev/full: could not be written: No space left on device\n")


if __name__ == "__main__":
    unittest.main()
