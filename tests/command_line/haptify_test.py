"""The Haptify benchmark as its user meets it, with few samples.

Usage: haptify_test.py PROGRAM   (from the repository root)
"""

import csv
import os
import subprocess
import unittest

from program import PROGRAM, TemporaryFolder, run

TABLE = ["workspace_volume", "free_space_force", "free_space_vibration", "free_space_centroid",
         "frictionless_surface", "stiffness_accuracy", "stiffness_peak_force"]
BEYOND = ["transparency_bandwidth", "position_bandwidth", "force_bandwidth", "latency", "z_width",
          "z_width_light", "free_space_centroid_seen", "impact_depth", "impact_rebound",
          "felt_mass_20", "felt_mass_60", "smallest_inertia", "spring_frequency"]


def cells(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


class Haptify(TemporaryFolder):
    def measure(self, name, *arguments):
        folder = self.folder / name
        code, out, err = run("haptify", "--quick", "--repetitions", 2, "--out", folder, *arguments)
        self.assertEqual(code, 0, out + err)
        return folder, out

    def test_all_rows_are_in_all_files(self):
        one, out = self.measure("one")
        names = sorted(file.name for file in one.iterdir())
        self.assertLessEqual({"results.json", "figures.json", "report.txt", "report.html",
                              "report.md", "table.tex", "haptify.csv", "repetitions.csv",
                              "transparency.csv", "z_width.csv", "impacts.csv",
                              "felt_mass.csv", "rotation.csv", "springs.csv"}, set(names))
        with open(one / "haptify.csv") as stream:
            rows = {row["id"]: row for row in csv.DictReader(stream)}
        for name in TABLE + BEYOND:
            self.assertTrue(float(rows[name]["mean"]) > 0.0, name)
        for name in TABLE:
            self.assertEqual(rows[name]["repetitions"], "2")
        # Table III of the paper
        self.assertEqual([float(rows[name]["paper"]) for name in TABLE],
                         [12.2, 1.28, 0.81, 77.3, 1.96, 109.0, 76.7])
        for name in ("report.html", "report.md", "table.tex"):
            text = (one / name).read_text()
            self.assertIn("real machines in real hands; ours is a simulated machine", text, name)
            self.assertNotIn("nan", text.split(), name)
        self.assertIn("ours, simulated", out)
        self.check_that_forms_agree(one, rows)
        self.check_pictures((one / "report.html").read_text())

    def check_pictures(self, html):
        self.assertIn("at a glance", html)
        self.assertEqual(html.count("<svg"), 11)
        for outside in ("<script", "<link", "src="):
            self.assertNotIn(outside, html)

    def test_without_python_nothing_is_measured(self):
        environment = {**os.environ, "HAPTICGIANT_PYTHON": "/bin/false-no-such-python"}
        done = subprocess.run([PROGRAM, "haptify", "--quick", "--out", self.folder / "no"],
                              capture_output=True, text=True, timeout=60, env=environment)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertIn("needs scipy, matplotlib and jinja2; tools/setup.sh build", done.stderr)
        self.assertNotIn("runs", done.stderr)

    def check_that_forms_agree(self, folder, rows):
        markdown = (folder / "report.md").read_text()
        missed = markdown[markdown.index("## Goals that are missed"):
                          markdown.index("## Beyond the paper")]
        latex = (folder / "table.tex").read_text()
        html = (folder / "report.html").read_text()
        for name in TABLE:
            row = rows[name]
            line = next(line for line in markdown.splitlines()
                        if line.startswith(f"| {row['name']} |"))
            _, unit, ours, paper, *_, met = cells(line)
            mean, half_width = (float(part) for part in ours.split(" +- "))
            digits = len(ours.split(" ")[0].partition(".")[2])
            self.assertEqual(unit, row["unit"])
            self.assertAlmostEqual(mean, float(row["mean"]), delta=0.51 * 10 ** -digits)
            self.assertAlmostEqual(half_width, float(row["half_width_95"]),
                                   delta=0.51 * 10 ** -digits)
            self.assertEqual(float(paper), float(row["paper"]))
            is_met = (float(row["goal_min"] or "-inf") <= float(row["mean"])
                      <= float(row["goal_max"] or "inf"))
            self.assertEqual(met, "yes" if is_met else "no", name)
            # every missed goal has its reason, and only those
            reason = next((line for line in missed.splitlines()
                           if line.startswith(f"- {row['name']}:")), "")
            self.assertTrue(reason == "" if is_met else len(reason) > 100, reason)
            self.assertIn(f"{row['name']} & ", latex)
            self.assertIn(f"& ${ours.replace('+-', chr(92) + 'pm')}$ & ${paper}$ &", latex)
            self.assertIn(ours, html)
        with open(folder / "repetitions.csv") as stream:
            for name in TABLE:
                stream.seek(0)
                values = [float(row["value"]) for row in csv.DictReader(stream)
                          if row["id"] == name]
                mean = float(rows[name]["mean"])
                self.assertAlmostEqual(sum(values) / len(values), mean, delta=1e-4 * abs(mean))

    def read_goals(self, folder):
        """Rows by their names, and the values behind each."""
        with open(folder / "goals.csv") as stream:
            rows = {row["figure"]: row for row in csv.DictReader(stream)}
        values = {}
        with open(folder / "goals_runs.csv") as stream:
            for run_ in csv.DictReader(stream):
                values.setdefault(run_["id"], []).append(float(run_["value"]))
        self.assertEqual(len(rows), len(values))
        return rows, dict(zip(rows, values.values()))

    def test_goals_are_reported_at_their_worst(self):
        folder, out = self.measure("goals", "--goals")
        again, _ = self.measure("again", "--goals", "--sweep", self.folder / "sweep")
        for file in folder.iterdir():  # as a sweep, too
            self.assertEqual(file.read_bytes(), (again / file.name).read_bytes(), file.name)
        rows, values = self.read_goals(folder)
        report = (folder / "goals.md").read_text()
        for name, row in rows.items():
            self.assertEqual(len(values[name]), 2, name)  # one per seed
            digits = len(row["least"].partition(".")[2])
            for column, value in (("least", min(values[name])), ("largest", max(values[name]))):
                self.assertAlmostEqual(float(row[column]), value, delta=0.51 * 10 ** -digits)
            if row["goal"] == "-":
                self.assertEqual(row["within"], "-")
            else:
                first, _, last = row["goal"].partition(" ")
                low = float({">=": last, "<=": "-inf"}.get(first, first))
                high = float({">=": "inf", "<=": last}.get(first, last.split(" ")[-1]))
                met = sum(low <= value <= high for value in values[name])
                self.assertEqual(row["within"], f"{met} of 2", name)
            self.assertIn(f"| {name} | {row['unit']} | {row['goal']} |", report)
            self.assertIn(name, out)
        # a light body needs little force, one of 6 kg more than Touch X in the paper
        heavy, _ = self.read_goals(self.measure("heavy", "--goals", "--twin", "free_space")[0])
        self.assertLess(float(rows["Free-space force"]["largest"]), 0.87)
        self.assertGreater(float(heavy["Free-space force"]["least"]), 0.87)

    def test_bad_options_are_refused(self):
        for option, value in (("--repetitions", "1"), ("--seed", "-1"), ("--repetitions", "2.5")):
            code, _, err = run("haptify", option, value)
            self.assertEqual(code, 2)
            self.assertIn(option, err)
        code, _, err = run("haptify", "--goals", "--twin", "lihgt")
        self.assertEqual(code, 2)
        self.assertIn("lihgt: no such twin file, did you mean 'light'?", err)


if __name__ == "__main__":
    unittest.main()
