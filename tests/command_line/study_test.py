"""`hapticgiant study`: planned, checked, simulated, continued, forgotten.

    study_test.py PROGRAM
"""

import csv
import importlib.util
import json
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
import unittest

from program import PROGRAM, TemporaryFolder, run

STUDY = """\
conditions:
  light: {twin.joints.hinge.damping_Nms_per_rad: 1}
  heavy: {twin.joints.hinge.damping_Nms_per_rad: 6}
fixed: {scenario: door, duration_s: 3}
design: {kind: within, order: williams, participants: 4, repetitions: 2}
questionnaires:
  tlx: {kind: nasa_tlx, weighted: true}
  sus: {kind: sus, after: end}
measures:
  peak_force_N: {}
  path_length_m: {}
  half: {expression: "max(norm(robot.w_h[0], robot.w_h[1], robot.w_h[2])) / 2", unit: N}
  started: {expression: "event('locked')", unit: s}
exclusion:
  - {trial: peak_force_N > 1000, why: too strong}
analysis:
  tests: [{outcome: peak_force_N, test: mixed}]
simulation:
  hand:
    light: {"script.segments[0].fz_N": {mean: -30, sd: 2}}
    heavy: {"script.segments[0].fz_N": {mean: -30, sd: 2}}
  expected:
    peak_force_N: {light: 10, heavy: 12, between: 1, within: 1}
"""
TRIALS = 4 * 2 * 2


class Study(TemporaryFolder):
    def setUp(self):
        super().setUp()
        self.file = self.folder / "study.yaml"
        self.file.write_text(STUDY)
        self.out = self.folder / "study.study"

    def study(self, command, *words, code=0):
        """Standard output and standard error of a command that ends with this code."""
        words = (words[0], self.file, *words[1:]) if command == "forget" else (self.file, *words)
        found, out, err = run("study", command, *words)
        self.assertEqual(found, code, out + err)
        return out, err

    def table(self, name):
        with open(self.out / f"{name}.csv", newline="") as file:
            return list(csv.DictReader(file))

    def files(self):
        return {file.relative_to(self.out): (file.stat().st_mtime_ns, file.read_bytes())
                for file in self.out.glob("sub-*/*")}

    def hashes_are_right(self):
        subprocess.run(["sha256sum", "-c", "--quiet", "--strict", "hashes.sha256"], cwd=self.out, check=True)


class Before(Study):
    def test_order_is_balanced_and_the_same_again(self):
        first, _ = self.study("plan")
        rows = [line.split() for line in first.splitlines()]
        self.assertEqual([row[0] for row in rows], ["P01", "P02", "P03", "P04"])
        self.assertEqual(sorted(row[1] for row in rows), ["heavy", "heavy", "light", "light"])
        self.assertEqual(first, self.study("plan")[0])
        self.assertIn("form", self.study("plan", "--participant", "P02")[0])
        self.assertIn("did you mean 'P0", self.study("plan", "--participant", "P5", code=2)[1])

    def test_check_plays_measures_and_simulates(self):
        out, _ = self.study("check", "--simulations", 200, code=1)
        self.assertRegex(out, r"started +1\.\d+ +1\.\d+ +s")
        self.assertIn("ends with exit code 1", out)  # of a door that is too short for its events

    def test_check_finds_what_would_ruin_a_study(self):
        words = ("--no-trials", "--simulations", 200)
        self.study("check", *words)
        for old, new, message in (
                ("participants: 4", "participants: 5", "the order is not balanced"),
                ("within, order: williams, participants: 4", "between, order: random, participants: 1",
                 "never occurs"),
                ("heavy: 12", "heavy: 10.1", "too few people for peak_force_N")):
            self.assertEqual(STUDY.count(old), 1, old)
            text = STUDY.replace(old, new)
            if "between, " in text:
                text = text.replace("test: mixed", "test: welch_t")
            self.file.write_text(text)
            self.assertIn(message, self.study("check", *words, code=1)[0])

    def test_check_says_that_markers_need_pylsl(self):
        """Where pylsl is installed, it is hidden by a folder of Python that has another one, without a library."""
        (self.folder / "pylsl.py").write_text("raise RuntimeError('LSL binary library file was not found.')")
        self.file.write_text(STUDY + "lab_streaming: {markers: [all]}\n")
        out = subprocess.run([PROGRAM, "study", "check", self.file, "--no-trials", "--simulations", "100"], text=True,
                             capture_output=True, env={**os.environ, "PYTHONPATH": str(self.folder)}).stdout
        self.assertIn("PROBLEM: lab_streaming: needs pylsl: pip install pylsl (LSL binary library", out)

    def test_a_column_that_does_not_exist_has_its_place(self):
        self.file.write_text(STUDY.replace("robot.w_h[0],", "robot.w_j[0],"))
        _, err = self.study("check", code=2)
        self.assertEqual(err, f"{self.file}:12:9: measures.half: no column is called 'robot.w_j[0]', did you "
                              "mean 'robot.w_h'?\n")

    def test_preregistration_has_all_that_is_planned(self):
        out, _ = self.study("preregistration", "--simulations", 100)
        for part in ("williams", "peak_force_N", "power", "too strong", "mixed model", "holm"):
            self.assertIn(part, out)


class Words(TemporaryFolder):
    def test_a_word_that_does_not_exist_has_the_nearest_one(self):
        for words, line in ((("study", "repot", "x.yaml"), "repot: no such subcommand of hapticgiant study, did you mean 'report'?"),
                            (("study", "simulate", "x.yaml", "--particpants", "3"),
                             "--particpants: no such option of hapticgiant study simulate, did you mean '--participants'?"),
                            (("sweep", "chek", "x.yaml"), "chek: no such subcommand of hapticgiant sweep, did you mean 'check'?"),
                            (("sweep", "check", "x.yaml", "--cuont=3"),
                             "--cuont: no such option of hapticgiant sweep check, did you mean '--count'?"),
                            (("imus", "x.urdf", "--mesure", "gramian"),
                             "--mesure: no such option of hapticgiant imus, did you mean '--measure'?"),
                            (("imus", "x.urdf", "--measure", "gramia"), "did you mean 'gramian'?")):
            code, out, err = run(*words)
            self.assertEqual((code, out), (2, ""), err)
            self.assertIn(line, err)


class Simulated(Study):
    def test_from_trials_to_tables_and_one_forgotten(self):
        out, _ = self.study("simulate", "--participants", 2, "--keep-recordings")
        self.assertIn("8 trials of simulated people", out)
        self.hashes_are_right()
        rows = self.table("trials")
        self.assertEqual(len(rows), 8)
        for row in rows:
            self.assertAlmostEqual(float(row["half"]), float(row["peak_force_N"]) / 2)
            self.assertTrue((self.out / f"sub-{row['participant']}" / row["recording"]).is_file())
        self.assertEqual(len({row["state_hash"] for row in rows}), 8)
        forms = {row["form"] for row in self.table("answers")}
        self.assertEqual(forms, {"tlx", "sus"})
        pairs = [row for row in self.table("answers") if row["kind"] == "pair"]
        self.assertEqual(len(pairs), 15 * 2 * 2)
        described = {row["column"] for row in self.table("data_dictionary")}
        self.assertLessEqual(set(rows[0]), described)
        # the command of a trial makes the same trial again
        trial = json.loads(next(self.out.glob("sub-P01/*_trial.json")).read_text())
        words = shlex.split(trial["command"])[1:]
        again = subprocess.run([PROGRAM, *words, "--no-recording"], capture_output=True, text=True)
        self.assertIn(trial["state_hash"], again.stdout)

        if importlib.util.find_spec("jinja2"):
            self.study("report")
            for name, begin in (("report.html", "<h1>Simulated people"), ("report.tex", "% THE PEOPLE OF THIS")):
                self.assertIn(begin, (self.out / name).read_text())
            self.hashes_are_right()
            # the script that is left with the data says the same, without HapticGiant
            script = shutil.copytree(self.out, self.folder / "copy") / "code" / "analysis.py"
            said = subprocess.run([sys.executable, "-I", script], capture_output=True, text=True, check=True).stdout
            statistic, = re.findall(r"F\(1, 1\) = [0-9.]+", said)
            self.assertIn(statistic, (self.out / "report.html").read_text())

        out, _ = self.study("forget", "P01")
        self.assertFalse((self.out / "report.html").exists())
        self.assertFalse((self.out / "sub-P01").exists())
        for file in self.out.glob("*.csv"):
            self.assertNotIn("P01,", file.read_text(), file)
        self.assertEqual(len(self.table("trials")), 4)
        self.hashes_are_right()
        self.study("simulate", "--participants", 2)  # the code is not given away
        self.assertFalse((self.out / "sub-P01").exists())
        self.assertIn("P01: 0 files deleted", self.study("forget", "P01")[0])
        self.assertIn("did you mean 'P02'", self.study("forget", "P03", code=2)[1])

    def test_a_measure_that_fails_is_a_fault_of_its_trial(self):
        """How many joints there are is a matter of the device."""
        self.file.write_text(STUDY.replace("event('locked')", "max(sensors.q_m[99])"))
        out, err = self.study("simulate", "--participants", 1, code=1)
        self.assertIn("0 trials of simulated people, 4 without a result", out)
        self.assertIn("P01 light 1: ", err)
        self.assertIn("no column is called 'sensors.q_m[99]'", err)
        self.assertEqual(len(self.table("participants")), 1)  # forms are answered all the same

    def test_a_killed_study_continues_and_nothing_is_written_twice(self):
        process = subprocess.Popen([PROGRAM, "study", "simulate", self.file, "--jobs", "1"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            deadline = time.monotonic() + 100
            while len(list(self.out.glob("sub-*/*_trial.json"))) < 3:
                self.assertLess(time.monotonic(), deadline)
                time.sleep(0.01)
        finally:
            process.send_signal(signal.SIGKILL)
            process.wait()
        before = self.files()
        self.assertLess(sum(str(name).endswith("_trial.json") for name in before), TRIALS)
        out, _ = self.study("simulate")
        self.assertIn("of them from before", out)
        after = self.files()
        self.assertEqual(before, {name: after[name] for name in before})
        self.assertEqual(len(self.table("trials")), TRIALS)
        self.assertFalse((self.out / ".running").exists())
        tables = {file.name: file.read_bytes() for file in self.out.glob("*.csv")}
        self.study("simulate")
        self.assertEqual(after, self.files())
        self.assertEqual(tables, {file.name: file.read_bytes() for file in self.out.glob("*.csv")})

        self.file.write_text(STUDY + "title: Other\n")
        self.assertIn("holds another study", self.study("simulate", code=2)[1])


if __name__ == "__main__":
    unittest.main()
