"""`hapticgiant sweep`: tables of parameters, continued, sharded, merged and repeated.

    sweep_test.py PROGRAM
"""

import json
import math
import os
import pathlib
import signal
import stat
import subprocess
import sys
import time
import unittest

from program import PROGRAM, TemporaryFolder, run

SWEEP = pathlib.Path("python/hapticgiant/sweep").resolve()
TABLE = """\
fixed: {scenario: door, duration_s: 0.6}
parameters:
  seed: {from: 1, to: 2, count: 2}
  twin.joints.hinge.damping_Nms_per_rad: [1, 4.5]
measures: [force.*, limits_held]
"""
RUNS = 4


class Sweep(TemporaryFolder):
    def setUp(self):
        super().setUp()
        self.file = self.folder / "sweep.yaml"
        self.file.write_text(TABLE)
        self.out = self.folder / "sweep.sweep"

    def sweep(self, *words, code=0):
        """Standard output and standard error of a sweep that ends with this code."""
        found, out, err = run("sweep", *words)
        self.assertEqual(found, code, out + err)
        return out, err

    def manifest(self, out=None):
        files = sorted((out or self.out).glob("manifest*.jsonl"))
        return [json.loads(line) for file in files for line in file.read_text().splitlines()]

    def table(self, out=None):
        return next((out or self.out).glob("results.*")).read_bytes()

    def test_plays_each_run_once_and_keeps_a_line_of_each(self):
        out, _ = self.sweep(self.file, "--jobs", 2)
        self.assertIn(f"{RUNS} runs of 'sweep'", out)
        records = {record["run"]: record for record in self.manifest()}
        self.assertEqual(sorted(records), list(range(1, RUNS + 1)))
        self.assertEqual(records[4]["parameters"],
                         {"seed": "2", "twin.joints.hinge.damping_Nms_per_rad": "4.5"})
        self.assertEqual(records[4]["seed"], 2)
        self.assertEqual(len({record["state_hash"] for record in records.values()}), RUNS)
        before = self.table()
        out, _ = self.sweep(self.file)
        self.assertIn(f"{RUNS} of them from before", out)
        self.assertEqual(len(self.manifest()), RUNS)
        self.assertEqual(self.table(), before)

    def test_the_command_of_a_run_gives_its_hash(self):
        self.sweep(self.file)
        command, _ = self.sweep("show", self.file, "--run", 4)
        summary = self.folder / "summary.json"
        subprocess.run([*command.split(), "--summary", summary], capture_output=True, check=False)
        record = next(record for record in self.manifest() if record["run"] == 4)
        self.assertEqual(json.loads(summary.read_text())["state_hash"], record["state_hash"])

    def test_shards_and_one_worker_give_the_table_of_the_whole(self):
        self.sweep(self.file, "--jobs", 2)
        other = self.folder / "other"
        self.sweep(self.file, "--out", other, "--jobs", 1, "--shard", "2/2")
        self.sweep("merge", self.file, "--out", other, code=1)
        self.assertNotEqual(self.table(other), self.table())
        self.sweep(self.file, "--out", other, "--jobs", 1, "--shard", "1/2")
        self.sweep("merge", self.file, "--out", other)
        self.assertEqual(self.table(other), self.table())

    def test_a_killed_sweep_continues(self):
        self.file.write_text(TABLE.replace("to: 2, count: 2", "to: 6, count: 6"))
        process = subprocess.Popen([PROGRAM, "sweep", self.file, "--jobs", "1"])
        deadline = time.monotonic() + 60
        lines = self.out / "manifest.jsonl"
        while not (lines.exists() and lines.stat().st_size > 0) and time.monotonic() < deadline:
            time.sleep(0.01)
        process.send_signal(signal.SIGKILL)
        process.wait()
        played = len(self.manifest())
        self.assertGreater(played, 0)
        self.assertLess(played, 12)
        with open(lines, "a") as file:
            file.write('{"run": 12, "half of a li')
        out, _ = self.sweep(self.file)
        self.assertIn(f"{played} of them from before", out)
        self.assertEqual(sorted(record["run"] for record in self.manifest()), list(range(1, 13)))
        self.sweep(self.file, "--out", self.folder / "whole")
        self.assertEqual(self.table(self.folder / "whole"), self.table())

    def test_wrong_keys_are_refused_before_the_first_run(self):
        for wrong, place, message in (
                ("seed: {", "3:3", "seeds: no such option, did you mean 'seed'?"),
                ("twin.joints", "4:3", "twim.joints.hinge.damping_Nms_per_rad: no such part, did "
                                       "you mean 'twin'?"),
                ("hinge", "4:3", "twin.joints.hing: must be a joint of the twin, got 'hing', did "
                                 "you mean 'hinge'?"),
                ("damping", "4:3", "twin.joints.hinge.dampin_Nms_per_rad: unknown key, did you "
                                   "mean 'damping_Nms_per_rad'?"),
                ("4.5", "4:3", "twin.joints.hinge.damping_Nms_per_rad: must be a number in "
                               "Nms/rad, got 'x'"),
                ("force.*", "", "no measure 'forc.*', did you mean 'force'?"),
                ("count: 2", "3:26", "seed: unknown key, did you mean 'count'?"),
                ("to: 2, count: 2", "3:33", "seed.count: must be at least 2, got 1"),
                ("from: 1", "3:9", "seed: 'from' must be below 'to', got 2 and 2")):
            right = {"to: 2, count: 2": "to: 2, count: 1", "from: 1": "from: 2", "seed: {": "seeds: {", "twin.joints": "twim.joints", "hinge": "hing",
                     "damping": "dampin", "4.5": "x", "force.*": "forc.*", "count: 2": "cout: 2"}
            self.file.write_text(TABLE.replace(wrong, right[wrong]))
            _, err = self.sweep(self.file, code=2)
            with self.subTest(wrong, said=err):
                self.assertIn(message.split(": ")[-1], err)
                self.assertIn(f"{self.file}:{place}" if place else str(self.file), err)
        self.assertFalse(self.out.exists())

    def test_a_wrong_key_beside_an_option_of_its_part_has_its_own_place(self):
        self.file.write_text("fixed:\n  twin: door\nparameters:\n  twin.joints.hing.friction_Nm: [1, 3]\n")
        self.assertIn(f"{self.file}:4:3: twin.joints.hing: ", self.sweep(self.file, code=2)[1])

    def test_an_option_that_the_program_refuses_is_named_with_its_place(self):
        self.file.write_text(TABLE + "rows: [{hand: stif}]\n")
        _, err = self.sweep(self.file, code=2)
        self.assertIn(f"{self.file}:6:9: --hand", err)

    def test_another_sweep_is_refused_until_again(self):
        self.sweep(self.file)
        self.file.write_text(TABLE.replace("4.5", "5"))
        _, err = self.sweep(self.file, code=2)
        self.assertIn("holds runs of another sweep", err)
        self.sweep("merge", self.file, code=2)
        out, _ = self.sweep(self.file, "--again")
        self.assertNotIn("from before", out)

    def test_another_program_and_another_file_are_distinguished(self):
        self.sweep(self.file)
        header = self.out / "sweep.json"
        right = json.loads(header.read_text())
        for key, message in (("program", "runs of another program"),
                             ("files", "a scenario, device, twin, simulation or script has changed")):
            header.write_text(json.dumps({**right, key: "0"}))
            _, err = self.sweep(self.file, code=2)
            self.assertIn(message, err)

    def test_check_finds_a_run_that_is_not_the_same_again(self):
        self.sweep(self.file)
        out, _ = self.sweep("check", self.file, "--count", 2)
        self.assertIn("2 runs played again: 2 the same, 0 not", out)
        file = self.out / "manifest.jsonl"
        records = self.manifest()
        true = records[1]["state_hash"]
        records[1]["state_hash"] = "0" * 16
        file.write_text("".join(json.dumps(record) + "\n" for record in records))
        out, _ = self.sweep("check", self.file, "--all", code=1)
        self.assertIn(f"run {records[1]['run']}: state_hash {'0' * 16}, now {true}", out)

    def test_samples_fill_their_ranges_and_are_the_same_again(self):
        text = ("fixed: {scenario: door, duration_s: 0.6}\nparameters:\n"
                "  twin.mass_scale: {from: 0.5, to: 2, spacing: log}\n"
                "  simulation.factors.friction: {from: 0.8, to: 1.2}\n"
                "samples: {method: METHOD, count: 8, seed: 3}\n")
        for method in ("sobol", "latin_hypercube"):
            self.file.write_text(text.replace("METHOD", method))
            commands, _ = self.sweep("show", self.file)
            self.assertEqual(commands, self.sweep("show", self.file)[0])
            scales = sorted(float(line.split("mass_scale=")[1].split()[0])
                            for line in commands.splitlines())
            self.assertEqual(len(scales), 8)
            for i, scale in enumerate(scales):  # one in each eighth
                self.assertTrue(0.5 * 4 ** (i / 8) <= scale <= 0.5 * 4 ** ((i + 1) / 8), scales)

    def test_lines_that_are_damaged_are_played_again(self):
        self.sweep(self.file)
        before = self.table()
        file = self.out / "manifest.jsonl"
        lines = file.read_bytes().splitlines(keepends=True)
        lines[1] = lines[1][:40] + b"\n"  # cut in its middle
        lines[2] = b"\0\xff\0\n"  # what a power cut leaves
        whole = json.loads(lines[0])
        other = [{"run": [1]}, {"run": "1"}, {"exit_code": None}, {"measures": []}, {"measures": {"a": math.nan}},
                 {"results": {"a": 1}}]
        lines += [json.dumps(whole | each).encode() + b"\n" for each in other]
        lines += [b"[" * 100_000 + b"\n", b"null\n", b"{}\n", b"\n"]
        file.write_bytes(b"".join(lines))
        out, err = self.sweep(self.file)
        self.assertIn("manifest.jsonl:2: is damaged", err)
        self.assertIn("manifest.jsonl:3: is damaged", err)
        self.assertEqual(err.count("is damaged; its run is played again\n"), 12)
        self.assertNotIn("Traceback", err)
        self.assertIn("2 of them from before", out)
        self.assertEqual(self.table(), before)

    def test_a_folder_whose_header_is_lost_or_damaged_is_refused_until_again(self):
        self.sweep(self.file)
        header = self.out / "sweep.json"
        for text in ("", "[]", '{"format": 1}', "null", "NaN", "[" * 100_000, "\udcff", None):
            header.unlink() if text is None else header.write_text(text, errors="surrogateescape")
            for words in ([], ["merge"], ["check"]):
                _, err = self.sweep(*words, self.file, code=2)
                self.assertIn("--again", err)
                self.assertEqual(len(err.splitlines()), 1, err)
        self.sweep(self.file, "--again")

    def test_again_deletes_no_file_of_others(self):
        self.sweep(self.file)
        mine = {"results.docx": "mine", "manifest_of_cargo.jsonl": "mine\n", "notes.txt": "mine"}
        for name, text in mine.items():
            (self.out / name).write_text(text)
        self.sweep(self.file, "--again")
        for name, text in mine.items():
            self.assertEqual((self.out / name).read_text(), text)
        other = self.folder / "other"
        other.mkdir()
        for name in ("results.csv", "sweep.json", "manifest.jsonl"):
            (other / name).write_text("mine\n")
            for words in ([], ["--again"]):
                if name == "sweep.json" and not words:
                    continue  # is refused as a damaged one
                _, err = self.sweep(self.file, "--out", other, *words, code=2)
                self.assertIn("take another --out", err)
            self.assertEqual((other / name).read_text(), "mine\n")
            (other / name).unlink()

    def test_an_option_is_no_value(self):
        self.file.write_text('fixed:\n  scenario: "--help"\n')
        _, err = self.sweep(self.file, code=2)
        self.assertIn(":2:13: scenario: expected a value, got the option '--help'", err)

    def test_a_second_sweep_in_the_folder_is_refused_and_forgets_nothing(self):
        slow = 'case "$*" in *0.6*) sleep 1;; esac'
        first = self.start_with(slow, self.file, "--jobs", 1)
        lines = self.out / "manifest.jsonl"
        self.wait_for(lines.exists)
        for words in ([], ["--again"]):
            second = self.sweep_with("", self.file, *words)
            self.assertEqual(second.returncode, 2)
            self.assertIn("another", second.stderr)
        out, err = first.communicate(timeout=120)
        self.assertEqual(first.returncode, 0, out + err)
        self.assertEqual(len(self.manifest()), RUNS)

    def test_ctrl_c_ends_all_processes_and_the_sweep_continues(self):
        slow = (f'case "$*" in *0.6*) echo $$ >> {self.folder}/pids; '
                f'[ -e {self.folder}/go ] || sleep 60;; esac')
        process = self.start_with(slow, self.file, "--jobs", 2)
        pids = self.folder / "pids"
        self.wait_for(lambda: pids.exists() and len(pids.read_text().split()) == 2)
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGTERM)  # while it cleans up
        _, err = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 130, err)
        self.assertIn("the same command continues", err)
        self.assertNotIn("Traceback", err)
        for pid in pids.read_text().split():
            self.assertFalse(pathlib.Path("/proc", pid).exists(), "still runs")
        (self.folder / "go").touch()
        done = self.sweep_with(slow, self.file)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(len(self.manifest()), RUNS)

    def test_a_full_disk_is_named_and_costs_only_what_it_could_not_keep(self):
        code = ("import resource, sys, runpy; resource.setrlimit(resource.RLIMIT_FSIZE, (6000, 6000));"
                "import signal; signal.signal(signal.SIGXFSZ, signal.SIG_IGN);"
                f"sys.argv[0] = '{SWEEP}'; runpy.run_path('{SWEEP}', run_name='__main__')")
        done = subprocess.run([sys.executable, "-B", "-c", code, self.file, "--jobs", "1"],
                              capture_output=True, text=True, timeout=120,
                              env={**os.environ, "HAPTICGIANT_PROGRAM": str(PROGRAM)})
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertRegex(done.stderr, r"(?m)^sweep: .*: '.*manifest\.jsonl'$")
        kept = (self.out / "manifest.jsonl").read_text().count("\n")
        self.assertGreater(kept, 0)
        self.assertLess(kept, RUNS)
        out, _ = self.sweep(self.file)
        self.assertIn(f"{kept} of them from before", out)
        self.assertEqual(len(self.manifest()), RUNS)

    def test_numbers_that_are_none_and_names_that_are_not_ascii(self):
        for key, values in (("twin.mass_scale", "[1, nan, 2]"), ("twin.mass_scale", "[1, .inf]"),
                            ("duration_s", "[inf]"), ("twin.joints.tür.damping_Nms_per_rad", "[1]")):
            self.file.write_text(f"fixed: {{scenario: door}}\nparameters:\n  {key}: {values}\n",
                                  encoding="utf-8")
            _, err = self.sweep(self.file, code=2)
            with self.subTest(key, said=err):
                self.assertIn(f"{self.file}:3:3: ", err)
        self.assertIn("tür", err)
        self.assertFalse(self.out.exists())

    def test_a_file_of_a_command_that_is_wrong_is_refused(self):
        for text, message in (("parts: 2", "1:8: parts: only beside 'command'"),
                              ("command: [faults]", "key 'parts' is missing"),
                              ("command: []\nparts: 2", "expected a list of words"),
                              ("command: [faults]\nparts: 2\nmeasures: [x]", "not beside 'command'")):
            self.file.write_text(text)
            _, err = self.sweep(self.file, code=2)
            self.assertIn(message, err)
        self.file.write_text("command: [version]\nparts: 2\n")
        out, _ = self.sweep(self.file, code=1)
        self.assertIn("2 without a result", out)

    def test_a_command_plays_its_parts_as_runs_and_continues(self):
        folder, json_file = self.folder / "kept", self.folder / "faults.json"
        words = ["faults", "--cases", 14, "--scenario", "door", "--json", json_file]
        code, out, err = run(*words)
        self.assertIn(code, (0, 1), out + err)
        whole = json.loads(json_file.read_text())
        self.assertEqual(len(whole["cases"]), 14)
        json_file.unlink()
        code, out, err = run(*words, "--sweep", folder)
        self.assertIn(code, (0, 1), out + err)
        self.assertEqual(json.loads(json_file.read_text()), whole)
        out, _ = self.sweep(folder / "sweep.yaml")
        self.assertIn("2 runs of 'faults', 2 of them from before", out)
        out, _ = self.sweep("check", folder / "sweep.yaml", "--count", 1)
        self.assertIn("1 run played again: 1 the same", out)
        code, _, err = run("faults", "--cases", 15, "--scenario", "door", "--json", json_file,
                           "--sweep", folder)
        self.assertEqual(code, 2)
        self.assertIn("another sweep", err)

    def test_a_command_whose_runs_need_what_is_missing_says_so_in_a_line(self):
        bare = self.folder / "bare"
        bare.write_text(f"#!/bin/sh\nexec {sys.executable} -S -I \"$@\"\n")
        bare.chmod(0o755)
        for python in (bare, "/bin/false-no-such-python"):
            done = subprocess.run([PROGRAM, "faults", "--cases", "2", "--json", self.folder / "x",
                                   "--sweep", self.folder / "y"],
                                  capture_output=True, text=True, timeout=60,
                                  env={**os.environ, "HAPTICGIANT_PYTHON": str(python)})
            self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
            self.assertRegex(done.stderr, r"^.* needs PyYAML; .*\n$")

    def wait_for(self, what):
        deadline = time.monotonic() + 60
        while not what():
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.02)

    # with a program in the place of ours that sometimes dies
    def start_with(self, script, *words):
        fake = self.folder / ("fake" if script else "plain")
        fake.write_text(f"#!/bin/sh\n{script}\nexec {PROGRAM} \"$@\"\n")
        fake.chmod(fake.stat().st_mode | stat.S_IEXEC)
        return subprocess.Popen([sys.executable, "-B", SWEEP, *map(str, words)], text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                env={**os.environ, "HAPTICGIANT_PROGRAM": str(fake)})

    def sweep_with(self, script, *words):
        process = self.start_with(script, *words)
        out, err = process.communicate(timeout=120)
        return subprocess.CompletedProcess(words, process.returncode, out, err)

    def test_a_run_that_was_killed_or_interrupted_is_played_again(self):
        once = (f'case "$*" in *0.6*"--seed 2 "*) mkdir {self.folder}/cut 2>/dev/null && '
                """{ printf '{"summary": {"a": 0.' >&3; kill -9 $$; };; """
                f'*0.6*"--seed 1 "*) mkdir {self.folder}/ended 2>/dev/null && '
                """{ echo '{"summary": {"interrupted": true}}' >&3; exit 0; };; esac""")
        done = self.sweep_with(once, self.file, "--jobs", 2)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertTrue((self.folder / "cut").exists() and (self.folder / "ended").exists())
        self.sweep(self.file, "--out", self.folder / "whole")
        self.assertEqual(self.table(), self.table(self.folder / "whole"))

    def test_a_run_that_crashes_is_named_with_its_command_and_does_not_end_the_others(self):
        crash = 'case "$*" in *0.6*"--seed 2 "*) echo "out of order" >&2; exit 1;; esac'
        done = self.sweep_with(crash, self.file, "--jobs", 2)
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertIn("2 without a result", done.stdout)
        self.assertRegex(done.stdout, r"run 3: \S+fake run door .*--seed 2 .*\n    out of order")
        self.assertEqual(len([record for record in self.manifest() if record["state_hash"]]), RUNS - 2)


if __name__ == "__main__":
    unittest.main()
