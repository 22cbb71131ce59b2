"""`hapticgiant bench`, `hqp solve` and the problems that `run` keeps, as their user meets them.

Usage: solver_commands_test.py PROGRAM   (from the repository root)
"""

import csv
import datetime
import json
import os
import pathlib
import re
import shutil
import subprocess
import unittest
import unittest.mock
import xml.etree.ElementTree

from program import MODELS, PROGRAM, TemporaryFolder, run


class Bench(TemporaryFolder):
    SETS = ["door, gauss, recoverable", "door, paper, paper"]

    def rows(self, name):
        with open(self.out / f"{name}.csv", newline="") as file:
            return list(csv.DictReader(file, strict=True))

    @staticmethod
    def solves(row):
        """How many were timed: a first one has nothing to start from."""
        return int(row["problems"]) - (row["solver"] == "warm")

    def copied_page(self):
        docs = self.folder / "docs"
        docs.mkdir()
        shutil.copy("docs/reports/benchmarks.md", docs)
        return docs

    def check_histograms(self, solver):
        """Histograms count every problem and cycle."""
        counted = {}
        for row in self.rows("solver_histogram"):
            key = row["set"], row["solver"]
            counted[key] = counted.get(key, 0) + int(row["count"])
        for row in solver:
            self.assertEqual(counted[row["set"], row["solver"]], self.solves(row), row)

    def test_a_quick_run_of_the_door_fills_every_table_and_figure(self):
        self.out = self.folder / "new" / "results"
        reported = self.folder / "bench.json"
        docs = self.copied_page()
        code, out, err = run("bench", "door", "--quick", "--json", reported, "--out", self.out,
                             "--docs", docs)
        self.assertEqual((code, err), (0, ""), out)
        self.assertIn("--quick: only the first 500 problems of each set", out)
        self.assertIn("--quick: only the first 2000 cycles", out)
        reported = json.loads(reported.read_text())
        self.assertEqual(out, (self.out / "README.md").read_text())
        self.assertIn("--quick: only the first 500", (docs / "benchmarks.md").read_text())
        self.assertTrue((docs / "benchmarks_laws.csv").read_text().startswith("scenario,law,"))

        # both laws play the scenario to its end
        self.assertEqual([(r["law"], r["bounds"]) for r in reported["runs"]],
                         [("gauss", "recoverable"), ("paper", "recoverable"),
                          ("gauss", "paper"), ("paper", "paper")])
        for played in reported["runs"]:
            self.assertEqual(played["missing_events"], [])
            self.assertGreater(played["cycles"], 10000)
        self.assertEqual([r["law"] for r in self.rows("laws")],
                         [r["law"] for r in reported["runs"]])

        # the solver: recorded problems and reference data, ours without a mistake
        solver = self.rows("solver")
        self.assertEqual(len(solver), len(reported["solver"]))
        names = {row["set"] for row in solver}
        self.assertLess({*self.SETS, "exc_two"}, names)
        for row in solver:
            self.assertEqual(row["p99_9_us"] != "", self.solves(row) >= 1000, row)
            p99_9_us = float(row["p99_9_us"] or row["median_us"])
            self.assertLessEqual(float(row["median_us"]), p99_9_us)
            self.assertLessEqual(p99_9_us, float(row["max_us"]))
            if row["solver"] != "cascade":
                self.assertEqual(row["failed"], "0", row)
                self.assertIn(row["wrong"], ("", "0"), row)
        if not any(row["solver"] == "cascade" for row in solver):
            self.assertIn("the paper's cascade was not built", out)

        self.check_histograms(solver)

        # the stages make up the cycle; they are measured in other plays, so about
        stages = {row["stage"]: row for row in self.rows("cycle")}
        self.assertEqual(len(stages), 11)
        self.assertEqual({row["cycles"] for row in stages.values()}, {"2000"})
        total = float(stages.pop("total")["mean_us"])
        together = sum(float(row["mean_us"]) for row in stages.values())
        self.assertTrue(total / 3 < together < 3 * total, (total, together))

        self.assertEqual({row["failed"] for row in self.rows("growth")}, {"0"})
        self.assertEqual([r["with"] for r in self.rows("growth_exponents")][-1], "levels")
        for name in ("solver_histogram", "cycle_histogram", "growth"):
            figure = xml.etree.ElementTree.parse(self.out / f"{name}.svg").getroot()
            lines = figure.findall(".//{http://www.w3.org/2000/svg}path")
            self.assertGreaterEqual(len(lines), 4, name)
        machine = (self.out / "machine.txt").read_text()
        for key in ("date: 20", "cpu: ", "compiler: ", "flags: ", "commit: "):
            self.assertIn(key, machine)

    def test_without_python_nothing_is_measured(self):
        with unittest.mock.patch.dict(os.environ, HAPTICGIANT_PYTHON="/bin/false-no-such-python"):
            code, out, err = run("bench", "door", "--out", self.folder / "none")
        self.assertEqual((code, out), (2, ""))
        self.assertIn("needs scipy, matplotlib and jinja2; tools/setup.sh build", err)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_a_missing_event_is_1(self):
        text = (MODELS / "scenarios" / "door.yaml").read_text().replace("../", f"{MODELS}/")
        impossible = self.folder / "impossible.yaml"
        impossible.write_text(text.replace("force_above_N: 10", "force_above_N: 1000"))
        code, out, _ = run("bench", impossible, "--quick")
        self.assertEqual(code, 1)
        self.assertIn("missing: locked", out)

    def test_bad_input_is_one_message_and_leaves_nothing(self):
        a_file = self.folder / "file"
        a_file.touch()
        for words, message in (
                (["doors", "--out", self.folder / "new"], "did you mean 'door'"),
                (["door", "--out", a_file], "expected a folder"),
                (["door", "--json", self.folder / "none" / "b.json"], "cannot be written")):
            code, out, err = run("bench", "--quick", *words)
            self.assertEqual((code, out), (2, ""))
            self.assertEqual(err.count("\n"), 1, err)
            self.assertIn(message, err)
        self.assertEqual([p.name for p in self.folder.iterdir()], ["file"])

        bad = self.folder / "bad.hqp"
        bad.write_text("hqp 2\n")
        for reference, message in ((self.folder, f"{bad}:1: expected a number of levels"),
                                   (self.folder / "none", "HG_REFERENCE_DATA: expected a folder")):
            with unittest.mock.patch.dict(os.environ, HG_REFERENCE_DATA=str(reference)):
                code, out, err = run("bench", "door", "--quick")
            self.assertEqual((code, out), (2, ""))
            self.assertIn(message, err)


class KeptProblems(TemporaryFolder):
    """Problems of the solver that took long; here all, as one active set is long."""

    def setUp(self):
        super().setUp()
        self.folder = self.folder / "it's made" / "here"

    def play(self, *arguments):
        code, out, err = run("run", "door", "--fast", "--duration", 1, "--recordings", self.folder,
                             *arguments)
        self.assertEqual(err, "")
        return out

    def test_are_written_reported_and_reproduced(self):
        out = self.play("--slow-solve", 1)
        self.assertEqual(out.count("to look at it:"), 1)
        command = re.search(r"to look at it:\n  (\S+ hqp solve \S.* --explain)\n", out)[1]
        reported = subprocess.run(command, shell=True, capture_output=True, text=True, check=True)
        self.assertIn("problem 0, Door, ", reported.stdout)
        stem = re.search(r"\n  recording +(.*)\.mcap\n", out)[1]
        self.assertRegex(out, r"\n  problems     in 1\d{3} cycles .*, 5 written: "
                         + re.escape(stem) + r"_hqp_\*\.hqp\n")
        stem = pathlib.Path(stem).name
        files = sorted(self.folder.glob("*.hqp"))
        self.assertEqual(len(files), 5)
        for file in files:
            code, out, err = run("hqp", "solve", file, "--explain")
            self.assertEqual((code, err), (0, ""))
            cycle, tried = re.search(r"problem 0, Door, law gauss, .*, cycle (\d+), solved after "
                                     r"(\d+) active set", out).groups()
            self.assertEqual(file.name, f"{stem}_hqp_{cycle}.hqp")
            self.assertIn(f"\nsolved: {tried} active set", out)

        self.play("--slow-solve", 1)  # keeps its own beside them
        self.assertEqual(len(list(self.folder.glob("*.hqp"))), 10)

    def test_an_ordinary_run_has_none(self):
        out = self.play()
        self.assertNotIn("problems", out)
        self.assertEqual(list(self.folder.glob("*.hqp")), [])

    def test_are_only_counted_without_a_recording(self):
        out = self.play("--slow-solve", 1, "--no-recording")
        self.assertRegex(out, r"\n  problems     in 1\d{3} cycles .*, none was written\n")
        self.assertFalse(self.folder.exists())

    def test_a_file_that_cannot_be_written_stops_nothing(self):
        self.play("--slow-solve", 1)
        first = min(int(file.stem.split("_")[-1]) for file in self.folder.glob("*.hqp"))
        now = datetime.datetime.now(datetime.timezone.utc)
        for seconds in range(120):  # whenever it starts
            stamp = (now + datetime.timedelta(seconds=seconds)).strftime("%Y%m%d_%H%M%S")
            for number in ("", "_2"):
                file = self.folder / f"door_{stamp}{number}_hqp_{first}.hqp"
                if not file.exists():  # one of the first run
                    file.mkdir()
        out = self.play("--slow-solve", 1)
        self.assertEqual(out.count("cannot be written"), 1)
        self.assertIn("none was written", out)

    def test_a_named_pipe_is_not_waited_for(self):
        self.folder.mkdir(parents=True)
        now = datetime.datetime.now(datetime.timezone.utc)
        for seconds in range(120):  # whenever it starts
            stamp = (now + datetime.timedelta(seconds=seconds)).strftime("%Y%m%d_%H%M%S")
            os.mkfifo(self.folder / f"door_{stamp}_hqp_0.hqp")
        out = self.play("--slow-solve", 1)
        self.assertRegex(out, r"solver: \S.*_hqp_0\.hqp cannot be written")
        self.assertIn("none was written", out)


class HqpSolve(TemporaryFolder):
    """Two problems: x0 <= 1 at any rate, then x0 + x1 = 3, then x0 = 5; and one with a bad row."""

    TEXT = ("hqp 2 3\nname example\noptions max_iterations 50\nlevel 0 1\n1 0 -inf 1\n"
            "level 1 0\n1 1 3\nlevel 1 0\n1 0 5 weight 0.5\nguess u=<\nend\n"
            "hqp 1 2\nlevel 1 0\n1 4\nlevel 0 1\n2 4 3 bad\nend\n")

    def setUp(self):
        super().setUp()
        self.file = self.folder / "two.hqp"
        self.file.write_text(self.TEXT)

    def test_numbers(self):
        code, out, err = run("hqp", "solve", self.file)
        self.assertEqual((code, out), (1, "1 2 0 0 4\n4 0 0\n"))
        self.assertEqual(err, "problem 1: bad row, row 1 (level 1): 2 x0 in [4, 3]: lb must not be "
                              "above ub\n")

    def test_one_problem_in_words(self):
        code, out, err = run("hqp", "solve", self.file, "--problem", 0, "--level", 2)
        self.assertEqual((code, err), (0, ""))
        for words in ("problem 0, example\n", "max_iterations 50", "solved: 1 active set tried",
                      "  optimal, blocked by row 0\n",
                      "row 0 (level 0): x0 in [-inf, 1]: held at its upper bound, value 1\n",
                      "row 2 (level 2): x0 = 5, weight 0.5: violated, too small by 4, value 1\n",
                      "x = 1 2\n", "multipliers of level 2", "\n            1  row 0 (level 0)"):
            self.assertIn(words, out)

    def test_a_bad_row_in_words(self):
        code, out, _ = run("hqp", "solve", self.file, "--problem", 1, "--explain")
        self.assertEqual(code, 1)
        self.assertIn("row 1 (level 1): 2 x0 in [4, 3]: lb must not be above ub\n", out)
        self.assertIn("    1     1  ignored\n", out)

    def test_times(self):
        code, out, _ = run("hqp", "solve", self.file, "--problem", 0, "--timing")
        self.assertEqual(code, 0)
        us = r"( +\d+\.\d\d){2}         - +\d+\.\d\d\n"  # no tail of so few
        self.assertRegex(out, r"^1 problem, microseconds per problem\n"
                         rf"start    median      mean    99\.9 %       max\ncold {us}warm {us}$")
        code, out, err = run("hqp", "solve", self.file, "--timing")
        self.assertEqual((code, out.split("\n")[0]), (1, "2 problems, microseconds per problem"))
        self.assertEqual(err.count("problem 1: bad row"), 2)

    def test_times_and_explanations_exclude_each_other(self):
        for words in (["--explain"], ["--level", 1]):
            code, out, err = run("hqp", "solve", self.file, "--timing", *words)
            self.assertEqual((code, out), (2, ""))
            self.assertIn(f"leave out {words[0]}, or --timing", err)

    def test_no_such_problem_or_level(self):
        for arguments, words in ((["--problem", 2], "has the problems 0..1, got 2"),
                                 (["--level", 2, "--problem", 1], "has the levels 0..1, got 2"),
                                 (["--problem", -1], "--problem: must be at least 0, got -1"),
                                 (["--level", "x"], "--level: expected a number, got 'x'")):
            code, _, err = run("hqp", "solve", self.file, *arguments)
            self.assertEqual(code, 2, err)
            self.assertIn(words, err)

    def test_files_that_cannot_be_read(self):
        broken = self.folder / "broken.hqp"
        broken.write_text("hqp 2 1\nlevel 1 0\n1 nonsense 3\nend\n")
        code, _, err = run("hqp", "solve", broken)
        self.assertEqual(code, 2)
        self.assertIn("broken.hqp:3", err)
        code, _, err = run("hqp", "solve", self.folder / "none.hqp")
        self.assertEqual(code, 2)
        self.assertIn("none.hqp", err)


if __name__ == "__main__":
    unittest.main(verbosity=1)
