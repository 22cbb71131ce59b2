"""Figures, tables and texts that are made from measurements.

Usage: benchmark_test.py   (from anywhere; needs scipy, matplotlib and jinja2, no compiled part)
"""

import copy
import json
import math
import pathlib
import random
import tempfile
import unittest

from report_test import said

from hapticgiant.report import benchmark, goals, haptify, measures, surfaces

BODY, LIGHT = {"mass": 6.0, "damping": 4.0}, {"mass": 3.0, "damping": 2.0}
FREE_SPACE = {"force": 0.9, "own_share": 0.8, "extra": 0.13, "speed_rms": 0.2, "path": 12.0,
              "vibration_rms": 0.04, "centroid_Hz": 91.5, "band_rms": [0.03, 0.02, 0.01, 0.005],
              "spectrum": {"step_Hz": 2.0, "magnitude": [0.1] * 300}, "seen_rms": 0.07,
              "seen_centroid_Hz": 230.0, "distance_rms": 2e-4, "failure": ""}
SLIDE = {"force": 1.5, "own_share": 1.4, "inertial": 1.3, "viscous": 0.4, "extra": 0.2,
         "normal": 3.5, "speed": 0.1, "failure": ""}
DYNAMICS = {"fit": {"inertia": 6.1, "damping": 4.2, "friction": 0.1, "r2": 0.99}, "mean": 2.0,
            "largest": 5.0, "failure": ""}
IMPACT = {"speed": 0.5, "depth": 0.02, "braking": 8.0, "bound": 0.016, "onset": 0.005,
          "spring": 0.002, "allowed": 0.03, "rebound": 0.05, "rest_s": 0.3, "energy_in": 1.0,
          "energy_out": 0.8, "peak_force": 40.0, "felt_force": 30.0, "end": "", "failure": ""}
SWING = {"true_handle": {"frequency_Hz": 2.2, "damping_ratio": 0.02, "amplitude": 0.003},
         "ideal_Hz": 2.25, "ideal_damping": 0.01, "failure": ""}
SEEDS = (1, 2)


def runs(result, conditions):
    return [{**copy.deepcopy(result), **condition} for condition in conditions]


def each_seed(*conditions):
    return [{**condition, "seed": seed} for condition in conditions for seed in SEEDS]


def each_axis(**condition):
    return [{"axis": axis, **condition} for axis in range(3)]


def answers(**values):
    return [{"frequency_Hz": f, **values} for f in (1.0, 10.0)]


def of(settings, result, conditions):
    return {"settings": settings, "runs": runs(result, conditions)}


def measurements_of_motion():
    """What the program plays up to the latency."""
    felt = answers(impedance=[4.0, 37.0], twin=[4.0, 37.0], following=[0.0, 0.9])
    forces = answers(rendered=[0.0, 1.1], ideal=[0.0, 1.0])
    views = [{"across": 0, "up": 1, "left": -1.0, "bottom": -1.0, "cell": 0.05,
              "rows": [[1, 2], [3, 0]], "box": [None, 1.0, -1.0, 1.0]}]
    shape = {"volume": 12.0, "nominal_volume": 8.2, "has_box": True, "box_volume": 12.23,
             "lower": [-1.6, -2.0, -1.0], "upper": [1.6, 2.0, -0.31], "views": views,
             "unreached": [{"axis": 2, "limit": -0.3, "short_by": 0.011, "volume": 0.14,
                            "at_limit": [["m4", 2.45], ["q4+q5", 2.88]]}]}
    return {
        "workspace": of({}, shape, each_seed({})),
        "free space": of({"duration_s": 60.0, "body": BODY, "light_body": LIGHT,
                          "accelerometer_noise": 1e-3}, FREE_SPACE,
                         each_seed({"body": BODY}, {"body": LIGHT})),
        "sources of vibration": of(
            {"duration_s": 60.0, "band_edges": [20.0, 50.0, 100.0, 200.0, 500.0]}, FREE_SPACE,
            [{"name": "as shipped", "changes_way": False},
             {"name": "no friction", "changes_way": False},
             {"name": "no noise", "changes_way": False, "vibration_rms": 0.01},
             {"name": "stiff", "changes_way": True}]),
        "frictionless surface": of(
            {"stiffness": 2000.0, "stroke": 0.2, "stroke_s": 2.0, "slow_stroke_s": 4.0,
             "light_body": LIGHT}, SLIDE,
            each_seed({"variant": ""}, {"variant": "lighter body"}, {"variant": "slower strokes"})),
        "stiffness": of({"stiffness": [1000.0, 4000.0], "force": 40.0},
                        {"accuracy": 99.5, "twin_accuracy": 100.5, "force": 40.0, "failure": ""},
                        each_seed({"stiffness": 1000.0}, {"stiffness": 4000.0})),
        "peak force": of({"stiffness": 4000.0, "tolerance": 0.1, "force": 140.0,
                          "force_max": 150.0},
                         {"force": 94.0, "end": "farther than 10 % from the line", "failure": ""},
                         each_seed({})),
        "strokes": of({}, DYNAMICS, each_seed(*({"axis": axis} for axis in range(6)))),
        "transparency": of({"highest_Hz": 50.0}, {"answers": felt, "transparency_Hz": 15.0,
                                                  "position_Hz": 14.0, "failure": ""}, each_axis()),
        "force response": of({}, {"answers": forces, "force_Hz": 36.0, "absolute_Hz": 0.7,
                                  "failure": ""}, each_axis()),
        "latency": of({}, {"motion_s": 3.5e-3, "sensed_s": 3.4e-3, "failure": ""},
                      each_seed(*each_axis())),
    }


def measurements_of_contact():
    """What the program plays from the Z-width on."""
    return {
        "Z-width": of({"stiffness": [1000.0, 8000.0], "damping": [0.0, 20.0],
                       "largest_stiffness": 5e4}, {"verdict": "stable", "failure": ""},
                      [{"body": body, "is_prompt": prompt, "stiffness": k, "damping": d}
                       for body, prompt in ((BODY, False), (LIGHT, False), (LIGHT, True))
                       for k in (1000.0, 8000.0) for d in (0.0, 20.0)]),
        "impacts": of({"deepest": 1.3, "rest_speed": 5e-3}, IMPACT,
                      [{"hand": "normal", "mass": 6.0, "wanted_speed": 0.5, "stiffness": k}
                       for k in (2000.0, 50000.0)]),
        "felt mass": of({"mass": 6.0}, {"mass": 6.5, "failure": ""},
                        each_seed(*each_axis(force=20.0), *each_axis(force=60.0))),
        "transparency of hard pushes": of({}, {"transparency_Hz": 14.9, "end": ""},
                                          each_axis(force=20.0) + each_axis(force=60.0)),
        "light rotations": of({"inertia": [0.005, 0.02], "torque": 1.5, "duration_s": 0.01,
                               "calm_speed": 0.06, "calm_s": 3.5},
                              {"verdict": "stable", "failure": ""},
                              [{"hand": hand, "inertia": inertia} for hand in ("normal", "stiff")
                               for inertia in (0.005, 0.02)]),
        "springs": of({"inertia": 2.5, "damping": 1.0, "radius": 0.75, "swings": 4}, SWING,
                      each_seed({"stiffness": 500.0, "deflection": 0.002})),
    }


def measurements():
    """Everything that the program plays, with the same result in all runs of a measurement."""
    return {**measurements_of_motion(), **measurements_of_contact()}


def results_of(measured, kind="haptify"):
    return {"kind": kind, "version": "1", "command": "hapticgiant haptify", "device": "Device",
            "seed": 1, "repetitions": 2, "is_quick": False, "measurements": measured}


def figures(results):
    return {it["id"]: it for it in results["table"] + results["beyond"]}


def rows_of(results, name):
    return next(table["rows"] for table in results["tables"] if table["id"] == name)


class Statistics(unittest.TestCase):
    def test_students_interval_of_a_known_example(self):
        # NIST/SEMATECH e-Handbook 1.3.5.2, data set ZARR13: 195 values with mean 9.261460 and
        # standard deviation 0.022789 have the interval 9.258242 .. 9.264679
        values = [9.261460] + [9.261460 - 0.022789, 9.261460 + 0.022789] * 97
        self.assertAlmostEqual(measures.mean(values), 9.261460, delta=1e-9)
        self.assertAlmostEqual(measures.half_width(values), 9.264679 - 9.261460, delta=2e-6)

    def test_few_values(self):
        self.assertAlmostEqual(measures.half_width([1.0, 2.0, 3.0, 4.0, 5.0]),
                               2.776445 * math.sqrt(2.5 / 5.0), delta=1e-6)
        self.assertTrue(math.isnan(measures.half_width([7.0])))
        self.assertTrue(math.isnan(measures.mean([])))
        self.assertEqual(measures.mean_text([], 2), "not measured")
        self.assertEqual(measures.mean_text([7.0], 1), "7.0")

    def test_the_truth_is_inside_in_95_of_100_cases(self):
        numbers = random.Random(3)
        held, cases = 0, 4000
        for _ in range(cases):
            values = [numbers.gauss(0.0, 1.0) for _ in range(5)]
            held += abs(measures.mean(values)) <= measures.half_width(values)
        self.assertAlmostEqual(held / cases, 0.95, delta=0.012)  # three standard deviations

    def test_goals(self):
        self.assertEqual([measures.goal_text(it) for it in ((3, None), (None, 3), (3, 4),
                                                            (None, None))],
                         [">= 3", "<= 3", "3 .. 4", "-"])
        self.assertTrue(measures.within(3.0, (3.0, 4.0)))
        self.assertFalse(measures.within(4.1, (3.0, 4.0)))
        self.assertFalse(measures.within(math.nan, (None, 4.0)))


class Benchmark(unittest.TestCase):
    def test_what_has_worked_has_figures_and_reasons(self):
        found = benchmark.figures(results_of(measurements()))
        self.assertEqual(found["failures"], [])
        self.assertEqual([it["id"] for it in found["table"]], list(measures.TABLE_III))
        for it in figures(found).values():
            self.assertIsNotNone(it["mean"], it["id"])
            for text in (it["name"], it["note"], it["why"]):
                self.assertNotRegex(text, r"\{|\bnan\b")
        it = figures(found)
        self.assertEqual(it["free_space_force"]["met"], "no")
        self.assertEqual(it["latency"]["measured"], "3.50 +- 0.00")
        self.assertEqual(it["felt_mass_60"]["name"], "Felt mass under 60 N")
        self.assertEqual(it["z_width"]["values"], [8000.0])
        self.assertEqual(it["smallest_inertia"]["values"], [0.005])
        self.assertEqual(it["impact_misses"]["values"], [0.0])
        self.assertIn("\"no noise\" leaves only 0.0100 m/s^2", it["free_space_centroid"]["why"])
        self.assertIn("z = -0.30 m is missed by 11 mm, 0.14 m^3 of the box: where the handle comes "
                      "nearest, m4 at 2.45 rad and q4+q5 at 2.88 rad.",
                      it["workspace_volume"]["why"])

    def test_a_measurement_that_fails_has_no_figure(self):
        without = {
            "frictionless surface": ("frictionless_surface",
                                     "frictionless surface, lighter body, "),
            "stiffness": ("stiffness_accuracy", "stiffness 1000 N/m, seed 1: "),
            "peak force": ("stiffness_peak_force", "peak force, seed 1: "),
            "free space": ("free_space_force", "free space, body of 6 kg, seed 1: "),
            "transparency": ("transparency_bandwidth", "transparency along x: "),
            "force response": ("force_bandwidth", "force response along x: "),
            "latency": ("latency", "latency, axis 0, seed 1: "),
            "Z-width": ("z_width", "Z-width, 6 kg, 4 Ns/m, 1000 N/m, 0 Ns/m: "),
            "impacts": ("impact_depth", "impact, normal hand, 6 kg, 0.5 m/s on 2000 N/m: "),
            "felt mass": ("felt_mass_20", "felt mass, 20 N along axis 0, seed 1: "),
            "light rotations": ("smallest_inertia", "rotation, normal hand, 0.005 kg m^2: "),
            "springs": ("spring_frequency", "spring of 500 Nm/rad from 2 mm, seed 1: "),
        }
        for name, (key, words) in without.items():
            measured = measurements()
            for run in measured[name]["runs"]:
                run["failure"] = "fault 9"
            found = benchmark.figures(results_of(measured))
            it = figures(found).get(key, {"values": [], "measured": "not measured"})
            self.assertEqual(it["values"], [], name)
            self.assertEqual(it["measured"], "not measured")
            self.assertEqual(len(found["failures"]), len(measured[name]["runs"]))
            self.assertTrue(any(it.startswith(words) for it in found["failures"]),
                            found["failures"])
        measured = measurements()
        measured["strokes"]["runs"][0]["failure"] = "fault 9"
        found = benchmark.figures(results_of(measured))
        self.assertEqual(found["failures"], ["strokes, x, seed 1: fault 9"])

    def test_one_axis_that_fails_hides_the_worst(self):
        measured = measurements()
        measured["transparency"]["runs"][2]["failure"] = "fault 9"
        measured["latency"]["runs"][0]["failure"] = "fault 9"
        it = figures(benchmark.figures(results_of(measured)))
        self.assertEqual(it["position_bandwidth"]["values"], [])
        self.assertEqual(len(it["latency"]["values"]), 1)  # of the other repetition

    def test_the_stiffest_calm_surface_is_below_the_first_that_is_not(self):
        def of(*verdicts):
            return surfaces.stiffest_calm([{"stiffness": float(2 ** n), "verdict": verdict}
                                            for n, verdict in enumerate(verdicts)])
        self.assertEqual(of("stable", "stable", "stable"), 4.0)
        self.assertEqual(of("stable", "slow decay", "stable"), 1.0)
        self.assertEqual(of("diverges", "stable", "stable"), 0.0)

    def test_impacts_name_what_they_miss(self):
        measured = measurements()
        measured["impacts"]["runs"][0].update(rest_s=math.nan, energy_out=1.2)
        measured["impacts"]["runs"][1].update(end="fault 9")
        found = benchmark.figures(results_of(measured))
        rows = rows_of(found, "impacts")
        self.assertEqual([row[-1] for row in rows], ["rest, energy", "fault 9"])
        self.assertEqual(rows[0][12], "never")
        first, _ = next(it["points"] for it in found["tables"] if it["id"] == "impacts")
        self.assertEqual((first["mass"], first["impact_rest"]), (6.0, None))
        self.assertEqual(figures(found)["impact_misses"]["values"], [2.0])
        self.assertIsNone(figures(found)["impact_rest"]["mean"])
        self.assertEqual(figures(found)["impact_rest"]["met"], "no")

    def test_what_ends_a_hard_push_is_a_result(self):
        measured = measurements()
        measured["transparency of hard pushes"]["runs"][1]["end"] = "fault 9"
        found = benchmark.figures(results_of(measured))
        self.assertEqual([row[-1] for row in rows_of(found, "felt_mass")], ["fault 9", "14.9"])
        self.assertEqual(found["failures"], [])


def goal_runs():
    conditions = [{"seed": seed, "height": -0.775, "hand": "normal"} for seed in SEEDS]
    results = {
        "transparency, 10 N": {"transparency_Hz": 15.0},
        "transparency, 40 N": {"transparency_Hz": 9.0}, "latency": {"motion_s": 3e-3},
        "free space": FREE_SPACE, "kick, 0.3 kg": {"last_speed": 5e-3},
        "kick, 0.4 kg": {"last_speed": 7e-3}, "plane of 20 kN/m, 6 kg": {"verdict": "stable"},
        "plane of 20 kN/m, 3 kg": {"verdict": "hunts"}, "stiffness": {"accuracy": 99.5},
        "free space, light body": FREE_SPACE, "frictionless surface": SLIDE}
    return {name: {"settings": {"body": BODY},
                   "runs": runs(result, [{**it, "value": value} for it in conditions
                                         for value in range(3)])}
            for name, result in results.items()}


class Goals(unittest.TestCase):
    def test_rows_say_the_worst(self):
        measured = goal_runs()
        for number, run in enumerate(measured["transparency, 10 N"]["runs"]):
            run["transparency_Hz"] = 13.0 + number  # 13, 14, 15 and 16, 17, 18
        found = goals.figures(results_of(measured, "goals"))
        rows = {row[0]: row[1:] for row in found["tables"][0]["rows"]}
        self.assertEqual(list(rows), [it.name for it in measures.GOALS.values()])
        self.assertEqual(rows["Transparency bandwidth, 10 N"][:6],
                         ["Hz", ">= 14", "16.0", "13.0", "16.0", "1 of 2"])
        self.assertEqual(rows["Plane of 20 kN/m under 3 kg: calm"][2:6], ["0", "0", "0", "0 of 6"])
        self.assertEqual(rows["Vibration of that body"][5], "-")
        self.assertIn("body of 6 kg, 4 Ns/m", rows["Free-space force"][6])

    def test_a_run_that_fails_has_no_value(self):
        measured = goal_runs()
        measured["latency"]["runs"][4]["failure"] = "fault 9"
        found = goals.figures(results_of(measured, "goals"))
        self.assertEqual(found["failures"], ["latency, seed 2, -0.775 m, normal hand: fault 9"])
        self.assertEqual(len(figures(found)["latency"]["values"]), 1)


class Files(unittest.TestCase):
    def test_all_forms_are_written_and_say_the_same(self):
        measured = measurements()
        measured["impacts"]["runs"][0]["rest_s"] = None  # as JSON has it
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            verdict, text = said(haptify.write, results_of(measured), folder)
            self.assertEqual(text, (folder / "report.txt").read_text())
            self.assertIn(f"{'Mean free-space force':<40}{'N':<7}{'0.90 +- 0.00':>18}", text)
            self.assertIn("Mean free-space force: 0.90 +- 0.00 instead of <= 0.7 N. 0.80 N of it "
                          "is what a free body of 6 kg, 4 Ns/m needs", text)
            self.assertIn("0.90 +- 0.00", (folder / "report.html").read_text())
            found = json.loads((folder / "figures.json").read_text())
            self.assertIsNone(figures(found)["impact_rest"]["mean"])
            self.assertEqual(found["workspace"][0]["box"], [None, 1.0, -1.0, 1.0])
            verdict, text = said(haptify.write, results_of(goal_runs(), "goals"), folder)
            self.assertIn(f"{'Latency from wrench to motion':<38}{'ms':<7}", text)


if __name__ == "__main__":
    unittest.main()
