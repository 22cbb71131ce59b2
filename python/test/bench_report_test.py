"""Tables and figures of a benchmark: percentiles, histograms, exponents, text.

Usage: bench_report_test.py   (from anywhere; needs scipy, matplotlib and jinja2, no compiled part)
"""

import csv
import json
import pathlib
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import matplotlib
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from hapticgiant.figures import SETTINGS
from hapticgiant.report import bench, pages
from report_test import overlapping, said

STAGES = ["supervision", "estimation", "prepositioning", "rendering set-up", "solver", "reactions"]


def times(count, scale=1000.0):
    return [int(ns) for ns in scale * np.exp(np.random.default_rng(count).normal(size=count))]


def solver_set(name, solvers=("warm", "cold", "cascade")):
    return {"set": name, "variables": 12, "levels": 7, "problems": 1500, "runs": [
        {"solver": solver, "ns": times(1500, 1000.0 * (1 + place)), "active_sets_tried": 3000,
         "failed": 0, "wrong": 0 if solver == "cold" else None}
        for place, solver in enumerate(solvers)]}


def law_run(law, **more):
    return {"scenario": "door", "law": law, "bounds": "recoverable", "events": 7,
            "expected_events": 8, "missing_events": ["locked"], "fault": "no fault", "cycles": 1001,
            "unsolved": 0, "duration_s": 1.0, "changes": 10, "changed_cycles": 5,
            "sum_acceleration_change": 2.0, "max_acceleration_change": 3.0,
            "worst_violation": {"limit": "hinge", "value": 0.002, "unit": "rad"},
            "solver_ns": times(999), "cycle_ns": times(1001), **more}


def results(**more):
    """A benchmark with everything, and long names."""
    return {"kind": "bench",
            "machine": {"date": "2026-11-25", "cpu": "a < b & c", "cores": 2, "compiler": "GNU 12",
                        "version": "1"}, "passes": 2,
            "most_problems": 500, "most_cycles": None, "remarks": ["cascade: not built"],
            "solver": [solver_set("free_space, gauss, recoverable"), solver_set("door, paper, paper"),
                       solver_set("say \"c\"", ("cold",))],
            "cycles": [{"scenario": name, "total": times(2000, 6000.0),
                        "stages": {stage: times(2000) for stage in STAGES}}
                       for name in ("door", "chain_30", "excavator")],
            "growth": [{"variables": n, "levels": levels, "rows": 5 * n // 2,
                        "cold_ns": [n ** 3] * 20, "cold_active_sets_tried": 4.0,
                        "warm_ns": [2000 * levels] * 20, "warm_active_sets_tried": 1.5, "failed": 0}
                       for n in (12, 24, 48, 84) for levels in (1, 2, 5, 10, 20)],
            "laws": [law_run("gauss"), law_run("paper", missing_events=[], unsolved=2)], **more}


class Times(unittest.TestCase):
    def test_percentiles_are_exact(self):
        self.assertEqual(bench.distribution([1000 * it for it in range(2000, 0, -1)]),
                         {"median_us": 1000.0, "p99_9_us": 1998.0, "max_us": 2000.0})

    def test_of_fewer_than_a_thousand_there_is_no_tail(self):
        self.assertEqual(bench.distribution([2000] * 1000)["p99_9_us"], 2.0)
        for count in (0, 999):
            found = bench.distribution([2000] * count)
            self.assertIsNone(found["p99_9_us"])
            self.assertEqual(found["max_us"], 2.0 if count else 0.0)
            most = "2.0" if count else "0.0"
            self.assertEqual(bench.as_csv([found]), f"median_us,p99_9_us,max_us\n{most},,{most}\n")
            self.assertEqual(bench.number(found["p99_9_us"], 2), "-")

    def test_every_time_is_in_the_bin_that_holds_it(self):
        edges, counts = bench.histogram([1000, 1010, 3000, 200])
        self.assertEqual(counts.sum(), 4)
        np.testing.assert_allclose(edges[1:] / edges[:-1], 10 ** 0.05)
        self.assertLessEqual(edges[0], 0.2)
        self.assertLess(0.2, edges[1])
        self.assertEqual((counts[0], counts[-1]), (1, 1))
        self.assertLess(edges[-2], 3.0)
        self.assertGreater(edges[-1], 3.0)
        self.assertEqual(len(bench.histogram([])[1]), 0)

    def test_the_power_of_a_power_law_is_found(self):
        found = bench.exponent_rows(bench.growth_rows(results()))
        self.assertEqual([it["at"] for it in found],
                         ["1 levels", "2 levels", "5 levels", "10 levels", "20 levels",
                          "84 variables"])
        self.assertEqual(found[-1]["with"], "levels")
        for it in found[:-1]:
            self.assertAlmostEqual(it["cold"], 3.0)
            self.assertAlmostEqual(it["warm"], 0.0)
        self.assertAlmostEqual(found[-1]["warm"], 1.0)
        self.assertEqual(bench.exponent_rows([]), [])


class Report(unittest.TestCase):
    def test_figures_have_no_overlaps(self):
        with matplotlib.rc_context(SETTINGS):
            for name, figure in bench.figures_of(results()).items():
                self.assertEqual(overlapping(figure), [], name)

    def test_a_solver_keeps_its_colour_where_others_are_missing(self):
        with matplotlib.rc_context(SETTINGS):
            panels = bench.solver_figure(results()).axes
        colours = [[patch.get_edgecolor() for patch in panel.patches] for panel in panels[:3]]
        self.assertEqual([len(it) for it in colours], [3, 3, 1])
        self.assertEqual(colours[2], colours[0][1:2])

    def test_a_page_of_the_documentation_is_refreshed(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            page = folder / "benchmarks.md"
            page.write_text(f"before\n\n{pages.BEGIN}stale\n{pages.END}\nafter\n")
            said(bench.write, results(), folder, docs=folder)
            text = page.read_text()
            with open(folder / "benchmarks_solver.csv", newline="") as file:
                rows = list(csv.DictReader(file, strict=True))
        self.assertTrue(text.startswith("before\n") and text.endswith("\nafter\n"), text)
        self.assertNotIn("stale", text)
        for words in ("`make bench`, a < b & c, 2 shared cores, GNU 12.\n", "\nVersion ",
                      "## Solver\n", "[Table: benchmarks_solver.csv](benchmarks_solver.csv)\n",
                      "[Table: benchmarks_cycle.csv](benchmarks_cycle.csv)\n",
                      "missing: locked", "- cascade: not built\n"):
            self.assertIn(words, text)
        self.assertEqual(rows[1]["cascade"], "1.5 x")

    def test_all_files_are_written_and_repeat(self):
        texts = []
        for _ in range(2):
            with tempfile.TemporaryDirectory() as name:
                folder = pathlib.Path(name)
                said(bench.write, results(), folder)
                texts.append({file.name: file.read_text() for file in folder.iterdir()})
                with open(folder / "solver.csv", newline="") as file:
                    rows = list(csv.DictReader(file, strict=True))
        self.assertEqual(texts[0], texts[1])
        self.assertEqual(len(texts[0]), 13)
        for name, text in texts[0].items():
            if name.endswith(".svg"):
                xml.etree.ElementTree.fromstring(text)
        self.assertEqual(rows[-1]["set"], "say \"c\"")
        self.assertEqual((rows[-1]["wrong"], rows[-1]["cascade_takes_times"]), ("0", ""))
        self.assertAlmostEqual(float(rows[1]["cascade_takes_times"]), 1.5, delta=0.01)
        self.assertEqual(rows[1]["active_sets_tried"], "2.0")
        self.assertEqual(rows[2]["active_sets_tried"], "")
        page = texts[0]["README.md"]
        for words in ("- cpu: a < b & c\n", "--quick: only the first 500 problems of each set",
                      "missing: locked", "2 cycles not solved", "- cascade: not built\n",
                      "2.00 mrad hinge", "k = 3.00 cold"):
            self.assertIn(words, page)
        self.assertNotIn("only the first None", page)
        laws = json.loads(texts[0]["bench.json"])["runs"]
        self.assertIsNone(laws[0]["solver_us"]["p99_9"])
        self.assertEqual(laws[0]["active_set_changes_per_second"], 10.0)
        self.assertTrue(texts[0]["laws.csv"].startswith(
            "scenario,law,bounds,events,missing_events,fault,cycles,unsolved,"))

    def test_nothing_measured_is_no_error(self):
        empty = results(solver=[], cycles=[], growth=[], laws=[], remarks=[])
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            said(bench.write, empty, folder)
            self.assertEqual((folder / "solver.csv").read_text(), "")


if __name__ == "__main__":
    unittest.main()
