"""Tables and pictures of experiments and of computing times.

Usage: series_test.py   (from anywhere; needs scipy, matplotlib and jinja2, no compiled part)
"""

import pathlib
import tempfile
import unittest

import matplotlib
import numpy as np
from report_test import overlapping, said  # also finds the package

from hapticgiant import figures
from hapticgiant.report import series, timing


class Reports(unittest.TestCase):
    def report(self, module, results, docs=None):
        """(verdict, what is said, folder)"""
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        folder = pathlib.Path(scratch.name)
        return *said(module.write, results, folder, docs=docs), folder


def seeded(trial=0, excess=0.0, **more):
    return {"trial": trial, "scenario": "walk", "hand": "", "seed": 1, "held": True, "fault": 0,
            "fault_text": "none", "ended_s": 1.0, "expected_events": 3, "missing_events": 0,
            "angle_rad": {"excess": 0.0, "limit": ""},
            "length_m": {"excess": excess, "limit": "elbow x" if excess else ""},
            "joint_error_rad": 1e-3, "handle_distance_m": 2e-4, "torque_share": 0.5,
            "vibration_m_per_s2": 0.02} | more


class Seeds(Reports):
    def test_the_table_has_median_and_worst(self):
        runs = [seeded(excess=1e-3 * i * i) for i in range(3)]
        verdict, said, folder = self.report(series, {"kind": "seeds", "runs": runs})
        self.assertEqual(verdict, 0)
        self.assertIn("| 3 of 3 | 3 of 3 | 0.00 / 0.00 | - | 1.00 / 4.00 | elbow x |",
                      (folder / "seeds.md").read_text())
        self.assertIn("1.00 / 4.00", said)

    def test_a_fault_is_reported_and_makes_the_verdict(self):
        runs = [seeded(), seeded(trial=1, hand="stiff", held=False, fault=100, seed=4, ended_s=12.34,
                                 fault_text="measured value is not finite", expected_events=0)]
        verdict, said, folder = self.report(series, {"kind": "seeds", "runs": runs})
        self.assertEqual(verdict, 1)
        line = ("- walk, stiff hand: 100 measured value is not finite in 1 runs, first at 12.34 s with "
                "seed 4\n")
        self.assertIn(line, said)
        page = (folder / "seeds.md").read_text()
        self.assertTrue(page.startswith("# "))
        self.assertIn(line, page)
        self.assertIn("| walk | stiff | 0 of 1 | - |", page)


def contact_case(**more):
    run = {"max_force_N": 100.0, "max_pressure_N_per_cm2": 10.0, "settled_force_N": 20.0,
           "impulse_Ns": 3.0, "contact_s": 0.1}
    return {"hit_by": "wrist", "body_part": "upper_arm", "speed_m_per_s": 0.5, "is_clamped": True,
            "permissible_transient_N": 150.0, "permissible_quasi_static_N": 75.0,
            "permissible_pressure_N_per_cm2": 60.0, "without": run | {"max_force_N": 151.0},
            "with": run | {"reported_s": 0.012}} | more


class Contact(Reports):
    def test_the_picture_has_no_overlaps(self):
        cases = [contact_case(hit_by=f"a link with the long name {link}", speed_m_per_s=speed)
                 for link in range(16) for speed in (0.25, 0.5, 1.0)]
        with matplotlib.rc_context(figures.SETTINGS):
            self.assertEqual(overlapping(series.contact_figure({"settled_s": 0.5, "cases": cases})), [])

    def test_what_is_too_much_is_marked_and_counted(self):
        case = contact_case()
        docs = pathlib.Path(tempfile.mkdtemp())
        (docs / "contact.md").write_text("a\n<!-- figures: begin -->\nb\n<!-- figures: end -->\nc\n")
        verdict, said, _ = self.report(series, {"kind": "contact", "seeds": 4, "settled_s": 0.5,
                                                 "cases": [case]}, docs)
        self.assertEqual(verdict, 0)
        self.assertIn("1 of 1 without compliance, 0 with it", said)
        page = (docs / "contact.md").read_text()
        self.assertIn("| wrist | upper arm, clamped | 0.5 | 151! | 100 | 150 | 10 / 10 | 3.0 / 3.0 | "
                      "100 / 100 | 20 | 20 | 75 | 12 | - / - |", page)
        self.assertTrue((docs / "contact.svg").read_text().startswith("<svg"))
        self.assertTrue(page.startswith("a\n") and page.endswith("c\n") and "b" not in page.split())


class Inertial(Reports):
    def test_medians_over_the_seeds(self):
        def run(units, seed):
            errors = {"joint_speed": 1e-3 * seed, "joint_acceleration": 0.1 * seed,
                      "gantry_acceleration": 0.0, "handle_speed": 2e-3, "handle_acceleration": 0.3}
            return {"scenario": "walk", "units": units, "seed": seed, "reference": errors,
                    "encoders": errors, "inertial": errors, "lateness_s": 2e-3, "largest_change": 1.5,
                    "fault": 111 if seed == 9 else 0, "fault_text": "torque"}
        runs = [run(units, seed) for units in ("all", "arm") for seed in (1, 9, 3)]
        _, said, _ = self.report(series, {"kind": "inertial", "runs": runs})
        lines = [line.split() for line in said.splitlines()]
        self.assertEqual(lines[2][:9], ["walk", "-", "encoders,", "reference", "3.00", "0.300", "0.000",
                                        "2.00", "0.300"])
        self.assertEqual(len(lines), 2 + 2 + 2 + 2)
        self.assertIn("walk, arm, seed 9: fault 111 torque", said)
        self.assertNotIn("what a hand feels", said)

    def test_what_a_hand_feels_follows_where_it_was_measured(self):
        felt = {"transparency_Hz": 15.6, "latency_s": 2.9e-3, "extra_N": 0.19, "vibration_m_per_s2": 0.06,
                "centroid_Hz": 97.7, "joint_error_rad": 1e-3, "light_normal_m_per_s": 5e-3,
                "light_stiff_m_per_s": 7e-3, "wall": ["stable", "hunts"]}
        _, said, _ = self.report(series, {"kind": "inertial", "runs": [],
                                           "felt": {"encoders alone": felt}})
        self.assertRegex(said, r"encoders alone +15.6 +2.9 +0.19 +0.060 +98 +1.00 +5.0 +7.0  stable, hunts")


def variant(name, extra, vibration, **more):
    return {"name": name, "takes_away": True, "joint_error_rad": 2e-3, "torque_share": 0.5,
            "measured": {"force_N": 1.0, "own_share_N": 0.8, "extra_N": extra, "centroid_Hz": 90.0,
                         "vibration_m_per_s2": vibration,
                         "acceleration_above_5_Hz_m_per_s2": 0.1}} | more


class FreeSpace(Reports):
    def test_the_removal_that_helps_most_is_named(self):
        variants = [variant("as shipped", 0.2, 0.06, takes_away=False), variant("no noise", 0.15, 0.03),
                    variant("no friction", 0.1, 0.07), variant("slow", 0.01, 0.01, takes_away=False),
                    variant("dead", 0.0, 0.0, failure="fault 100")]
        _, said, _ = self.report(series, {"kind": "free-space", "force_below_Hz": 20,
                                           "vibration_above_Hz": 20, "variants": variants})
        self.assertIn("most by 'no friction': 0.100 instead of 0.200 N\n", said)
        self.assertIn("most by 'no noise': 0.030 instead of 0.060 m/s^2\n", said)
        self.assertRegex(said, "above 5 Hz +no removal makes it smaller\n")
        self.assertRegex(said, r"dead +1.00 +0.80 +0.00 +0.000 +90 +0.100 +2.00 +0.50  failed: fault 100\n")


class Impedance(Reports):
    def test_deflection_of_a_spring_and_the_share_of_a_twin(self):
        def run(frequency, impedance, **more):
            mobility = 1.0 / impedance
            return {"name": "modal", "axis": "x", "frequency_Hz": [frequency],
                    "mobility_m_per_Ns": [[mobility.real, mobility.imag]]} | more
        omega = 2.0 * np.pi
        spring = run(1.0, -1j * 2e4 / omega, is_rigid=True, static_peak_m=2e-3, static_end_m=1e-3)
        half = run(1.0, 0.5 * (1j * omega * 6.0 + 4.0), is_rigid=False)
        _, said, _ = self.report(series, {
            "kind": "impedance", "twin": {"mass_kg": 6.0, "damping_Ns_per_m": 4.0}, "static_force_N": 50.0,
            "static_end_s": 1.55, "runs": [half, spring]})
        self.assertRegex(said, r"modal, along x +50.0 +2.00 mm +1.00 mm\n")
        self.assertRegex(said, r"felt / rendered +1 Hz\nmodal, along x +0.50\n")


def stability():
    def row(hand, damping, verdicts, stable_from):
        return {"hand": hand, "damping_Ns_per_m": damping, "stable_from_kg": stable_from,
                "cells": [{"verdict": verdict} for verdict in verdicts]}
    rows = [("300 N/m", ["diverges", "hunts"], 1.25), ("stiff", ["sustained", "sustained"], None),
            ("a hand with a very long name", ["stable", "slow decay"], 0.1)]
    return {"kind": "stability-map", "device": "HapticGiant, modal control", "mass_kg": [1, 2],
            "least_mass_kg": 0.1, "arm_kg": 1.5, "kick_N": 15, "kick_s": 0.01, "watched_s": 4,
            "calm_m_per_s": 6e-3,
            "rows": [row(hand, damping, *more) for damping in (4, 20) for hand, *more in rows]}


class Stability(Reports):
    def test_text_and_map_have_all_verdicts_and_masses(self):
        verdict, said, folder = self.report(series, stability())
        self.assertEqual(verdict, 0)
        for line in ("300 N/m       X    h       1.25", "stiff         U    U       none",
                     ".    r       <= 0.1", "2 of 12 cells hunt (h), 6 swing or diverge"):
            self.assertIn(line, said)
        self.assertTrue((folder / "map.svg").read_text().startswith("<svg"))

    def test_the_map_has_no_overlaps(self):
        with matplotlib.rc_context(figures.SETTINGS):
            self.assertEqual(overlapping(series.stability_figure(stability())), [])


class Timing(Reports):
    def test_times_stand_beside_the_paper(self):
        row = {"law": "gauss", "rate_Hz": 2000.0, "total": [2000, 9000, 9000, 20000],
               "stages": {"estimation": [6000, 6000], "solver": [2000, 4000]}}
        results = {"kind": "timing", "has_two_laws": False, "duration_s": 2.0,
                   "machine": {"date": "today", "cpu": "<one>"}, "rows": [row]}
        _, said, folder = self.report(timing, results)
        self.assertRegex(said, r"paper .*\| 1000 \| 529 \| 616 \| 707 \| 92.6 % \| 52.9 %")
        self.assertIn("| ours, law gauss | 2000 | 10.0 | - | 20.0 | 33.3 % | 2.0 % |", said)
        self.assertEqual((folder / "timing.csv").read_text().splitlines()[1],
                         "gauss,2000,4,10.000,9.000,-,20.000,33.33")
        self.assertIn("gauss,2000,8.913,10,2\n", (folder / "histogram.csv").read_text())
        page = (folder / "report.html").read_text()
        self.assertIn("&lt;one&gt;", page)
        self.assertEqual(page.count("<svg"), 1)


if __name__ == "__main__":
    unittest.main()
