"""The map of a device's force, and the report of its tuning.

Usage: device_report_test.py   (from anywhere; needs scipy, matplotlib and jinja2, no compiled part)
"""

import csv
import pathlib
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import matplotlib
import numpy as np
from matplotlib.figure import Figure

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from hapticgiant.figures import SETTINGS
from hapticgiant.report import capability, tuning
from report_test import overlapping, said


def reached(**more):
    """A cube of 2 m with its middle at (1, 2, 3); the force grows with x."""
    axes = np.linspace(-1.0, 1.0, 41)
    points = [[1.0 + x, 2.0 + y, 3.0 + z, 100.0 * (1.0 + x)]
              for x in axes for y in axes for z in axes]
    return {"kind": "capability", "device": "Arm & <more>", "points": points,
            "box_m": [[0.5, 1.5], [1.5, 2.5], [2.5, 3.5]], **more}


class Capability(unittest.TestCase):
    def test_a_cell_has_the_median_of_what_is_near_the_section(self):
        points = np.array([[0.0, 0.0, -1.0, 9.0], [0.0, 0.0, 1.0, 9.0], [1.0, 1.0, 0.0, 3.0],
                           [0.02, 0.01, 0.04, 1.0], [0.03, 0.04, -0.04, 2.0], [0.0, 0.0, 0.0, 8.0]])
        force, x, y = capability.median_per_cell(points, 0, 1, 0.1)
        self.assertEqual(force.shape, (10, 10))
        self.assertEqual((force[0, 0], force[9, 9]), (2.0, 3.0))
        self.assertEqual(np.isfinite(force).sum(), 2)
        np.testing.assert_allclose((x[0], x[-1], y[0], y[-1]), (0.0, 1.0, 0.0, 1.0), atol=1e-12)

    def test_the_scale_ends_at_a_round_number(self):
        for value, rounded in ((0.8, 1.0), (1.2, 2.0), (180.0, 200.0), (201.0, 500.0), (700.0, 1e3)):
            self.assertAlmostEqual(capability.round_number(value), rounded)

    def test_the_picture_has_no_overlaps(self):
        with matplotlib.rc_context(SETTINGS):
            for points in (reached(), reached(box_m=[[None, None]] * 3)):
                self.assertEqual(overlapping(capability.figure_of(points)), [])

    def test_the_file_is_a_picture_even_of_nothing(self):
        unlimited = [[*point[:3], None] for point in reached()["points"]]
        for points in (reached(), reached(points=unlimited), reached(points=[])):
            with tempfile.TemporaryDirectory() as name:
                folder = pathlib.Path(name)
                capability.write(points, folder)
                text = (folder / "map.svg").read_text()
            self.assertTrue(text.startswith("<svg"))
            xml.etree.ElementTree.fromstring(text)
            self.assertIn("Arm &amp; &lt;more&gt;", text)


def loop(share, **more):
    return {"limit_m_per_s2": 0.03 * share, "vibration_m_per_s2": 0.029 * share,
            "centroid_Hz": 90.0, "transparency_Hz": 15.0 * share, "latency_s": 0.004 / share,
            "distortion": 0.4, "friction_N": 0.18, "arm_radius": 0.994, "hand_radius": 0.9995,
            "friction_radius": 0.0, "is_proven": True,
            "worst": {"arm": "springs x 0.75", "hand": "stiff hand, 0.4 kg"},
            "values": [100.0 * share, 80.0, 0.0036], **more}


def tuned(**more):
    felt = {"frequency_Hz": [0.5, 5.0, 50.0], "least": [0.9, 0.8, 0.3], "largest": [1.0, 1.2, 2.0]}
    radii = {"arm": [0.99, 0.994], "hand": [0.9990, 0.9995]}
    return {"kind": "tuning", "device": "Arm", "command": "hapticgiant tune arm.yaml --front",
            "postures": 2, "felt_postures": 2, "cases": 60, "held_before": 1, "arm_limit": 0.995,
            "hand_limit": 0.9996,
            "knobs": [{"section": "estimation", "key": "wrench_Hz"},
                      {"section": "control", "key": "follower_Hz"},
                      {"section": "control", "key": "lead_s"}],
            "friction_most_N": 0.2, "before": loop(1.0, is_proven=False), "front": [loop(1.2), loop(0.7, is_proven=False)],
            "felt_before": felt, "felt": felt, "radii_before": radii, "radii": radii, **more}


class Tuning(unittest.TestCase):
    def write(self, results):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            self.verdict, self.shown = said(tuning.write, results, folder)
            return {file.name: file.read_bytes() for file in folder.iterdir()}

    def test_lines_for_device_yaml_are_the_same_everywhere(self):
        files = self.write(tuned())
        lines = tuning.yaml_of(tuned())
        self.assertIn("estimation:\n  wrench_Hz: 120  # was 100\ncontrol:\n"
                      "  follower_Hz: 80  # was 80\n  lead_s: 0.0036  # was 0.0036\n", lines)
        for name in ("report.txt", "report.md"):
            self.assertIn(lines, files[name].decode())

    def test_the_table_compares_now_and_tuned(self):
        text = tuning.text(tuned())
        self.assertRegex(text, r"transparency, Hz +15\.0 +18\.0\n")
        self.assertRegex(text, r"proven +NO +yes\n")
        self.assertRegex(text, r"errors left after 0\.1 s +0\.548 +0\.548\n")
        self.assertNotIn("friction gives way", text)
        self.assertIn("now         nearest to its limit: springs x 0.75", text)
        worst = {**loop(1.0)["worst"], "friction": "it slips"}
        text = tuning.text(tuned(before=loop(1.0, friction_radius=0.99, worst=worst)))
        self.assertRegex(text, r"while friction gives way +0\.366 +0\.000\n")
        self.assertNotIn("\nnow   ", text)

    def test_the_csv_has_a_row_per_loop(self):
        rows = list(csv.DictReader(self.write(tuned())["front.csv"].decode().splitlines()))
        self.assertEqual([row["is_proven"] for row in rows], ["0", "1", "0"])
        self.assertEqual([float(row["wrench_Hz"]) for row in rows], [100.0, 120.0, 70.0])

    def test_lines_that_must_not_be_used_are_1(self):
        self.assertEqual(tuning.lack_of(tuned()), "")
        for lack, loop_ in (("not proven", loop(1.2, is_proven=False)), ("missed: vibration 0.0430", loop(
                1.2, vibration_m_per_s2=0.043)), ("friction 0.210 N, at most 0.200", loop(1.2, friction_N=0.21))):
            self.assertIn(lack, tuning.lack_of(tuned(front=[loop_])))
        for proven, verdict in ((False, 1), (True, 0)):
            self.write(tuned(front=[], before=loop(1.0, is_proven=proven)))
            self.assertEqual(self.verdict, verdict)

    def test_a_check_is_only_text(self):
        files = self.write(tuned(front=[]))
        self.assertEqual(set(files), {"report.txt"})
        self.assertIn(b"holds in 1 of 2 postures", files["report.txt"])

    def test_the_figure_has_no_overlaps(self):
        with matplotlib.rc_context(SETTINGS):
            figure = Figure()
            tuning.draw(figure, tuned())
            self.assertEqual(overlapping(figure), [])


if __name__ == "__main__":
    unittest.main()
