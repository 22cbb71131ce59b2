"""Measures, statements and comparisons of runs, on runs whose answers are known.

Usage: runs_test.py   (from anywhere; needs scipy, matplotlib and jinja2, no compiled part)
"""

import json
import math
import pathlib
import tempfile
import unittest

import numpy as np
from report_test import said  # also finds the package

from hapticgiant.report import experiments, recordings, runs

RUNNING, LOCK = 3, 4
DOOR_EVENTS = {"locked": 2.0, "handle pressed": 5.5, "pulled": 6.0, "locked again": 7.4,
               "unlocked": 9.0, "open stop": 10.0, "velocity limit": 12.0,
               "closed and locked": 13.0}


def table(seconds=15.0, rate_Hz=100.0):
    """Columns of a device with seven joints and a twin with a hinge and a lever."""
    time = np.arange(int(seconds * rate_Hz)) / rate_Hz
    kinds = [("time_s", "<f8"), ("cycle", "<u8"), ("mode", "|u1"), ("state_hash", "<u8"),
             ("felt_limit", "<i4"), ("sync_error", "<f8"), ("robot.w_h", "<f8", (6,)),
             ("robot.q_p", "<f8", (2,)), ("robot.dq_p", "<f8", (2,)), ("reference.q_m", "<f8", (7,)),
             ("reference.dq_m", "<f8", (7,)), ("handle.p", "<f8", (3,)), ("handle.r", "<f8", (9,)),
             ("p_b_elbow", "<f8", (3,)), ("twin.q_a", "<f8", (2,)), ("twin.dq_a", "<f8", (2,)),
             ("tau_a", "<f8", (2,)), ("limits.cause", "|u1", (2,))]
    rows = np.zeros(len(time), kinds)
    rows["time_s"], rows["cycle"], rows["mode"] = time, np.arange(len(time)), RUNNING
    rows["state_hash"] = np.arange(len(time), dtype="<u8") + np.uint64(2**63)
    rows["felt_limit"] = -1
    rows["robot.w_h"][:, 0], rows["robot.w_h"][:, 1] = 3.0, 4.0
    rows["handle.r"][:, 2] = 1.0
    return rows


def joint(name, unit="rad", **more):
    return {"name": name, "unit": unit, "lower": -1.0, "upper": 1.75} | more


def event(name, time_s, what="", **condition):
    return {"name": name, "what": what or f"{name} happens", "time_s": time_s,
            "all_of": [{"kind": "locked", "value": 0.0, "of": "hinge", "unit": "rad"} | condition]}


def facts(kind="door", times=None):
    twin = [joint("hinge", speed_max=1.2, q=0, v=0), joint("lever", speed_max=None, q=1, v=1)]
    times = DOOR_EVENTS if times is None else times
    return {"kind": kind, "title": "Door", "source": "Fig. 9", "command": "hapticgiant x", "version": "1",
            "device": "Device", "rate_Hz": 100.0, "grasp_s": 0.7, "seed": 1, "running_mode": RUNNING,
            "lock_cause": LOCK, "manipulator": [joint(f"m{n}") for n in range(1, 8)],
            "virtual": [joint("m1+m2", weights=[1, 1, 0, 0, 0, 0, 0])],
            "gantry": [joint("x", "m"), joint("y", "m")], "twin": twin,
            "limits": [joint("hinge"), joint("lever")], "box": {"x": [-1, 1], "y": [-1, None]},
            "has_elbow": True, "events": [event(name, time) for name, time in times.items()],
            "failures": []}


def summary(**more):
    limits = {"hinge": {"worst_violation": 0.0, "unit": "rad"},
              "hand x": {"worst_violation": 1.2e-4, "unit": "m"}}
    return {"scenario": "door", "law": "gauss", "bounds": "recoverable", "rate_Hz": 100.0,
            "duration_s": 15.0, "limits": limits, "limits_held": True, "wall_time_s": 3.0,
            "sync_error": {"max_m": 1e-4}, "force": {"mean_N": 5.0, "max_N": 9.0, "max_torque_Nm": 1.0},
            "solver": {"status": {"solved": 1500, "failed": 2, "not run": 7},
                       "active_set_changes_per_second": 1.5},
            "acceleration_change_per_cycle": {"mean": 0.1},
            "cycle_time_us": {"median": 10.0, "p99_9": 20.0, "max": 0.0},
            "fault": {"code": 0, "what": "none"}} | more


class Folders(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def run_folder(self, rows, run, timing=None, name="run"):
        folder = self.folder / name
        folder.mkdir()
        np.save(folder / "signals.npy", rows)
        (folder / "run.json").write_text(json.dumps(run))
        (folder / "timing.json").write_text(json.dumps(timing or summary()))
        return folder


class Signals(Folders):
    def test_columns_have_the_names_and_units_of_the_models(self):
        rows = table()
        rows["reference.q_m"][:, 0], rows["reference.q_m"][:, 1] = 0.25, 0.5
        rows["handle.r"][:, 5] = 1.0
        rows["tau_a"][:, 1] = 0.7
        signals = runs.Run(self.run_folder(rows, facts())).signals()
        for name, value in (("force_N", 5.0), ("running", 1.0), ("m1+m2_rad", 0.75), ("lever_Nm", 0.7),
                            ("hand_azimuth_rad", math.pi / 4), ("y_m_per_s", 0.0)):
            self.assertAlmostEqual(signals[name][7], value, msg=name)
        self.assertEqual(list(signals)[:3], ["time_s", "running", "force_N"])

    def test_the_file_has_a_row_per_period_and_six_digits(self):
        rows = table(0.1, 1000.0)
        rows["robot.w_h"][:] = 0.0
        rows["robot.w_h"][:, 2] = 1.0 / 3.0
        run = runs.Run(self.run_folder(rows, facts()))
        run.save_csv()
        lines = (run.folder / "signals.csv").read_text().splitlines()
        self.assertEqual(len(lines), 11)
        self.assertTrue(lines[2].startswith("0.01,1,0.333333,0,-1,"), lines[2])

    def test_locked_phases_begin_and_end_with_their_rows(self):
        rows = table(1.0)
        rows["limits.cause"][:20, 0] = LOCK
        rows["limits.cause"][50:61, 1] = LOCK
        rows["limits.cause"][90:, 0] = LOCK
        phases = [(phase["joint"], round(phase["from_s"], 3), round(phase["to_s"], 3))
                  for phase in runs.Run(self.run_folder(rows, facts())).locked()]
        self.assertEqual(phases, [("hinge", 0.0, 0.19), ("lever", 0.5, 0.6), ("hinge", 0.9, 0.99)])

    def test_conditions_in_words_and_as_data(self):
        for condition, text, data in (
                ({"kind": "limit", "of": "elbow x", "unit": "m", "side": "upper", "value": 0.0},
                 "elbow x within 2 mm of its upper limit, which acts",
                 {"kind": "limit", "of": "elbow x", "side": "upper"}),
                ({"kind": "speed limit", "of": "hinge", "unit": "rad", "value": 0.0},
                 "the speed limit of hinge acts",
                 {"kind": "speed_limit", "of": "hinge", "side": "either"}),
                ({"kind": "force above", "value": 10.0}, "force of the user > 10 N",
                 {"kind": "force_above_N", "value": 10.0}),
                ({"kind": "turns", "of": "m1", "unit": "rad", "value": -1.0},
                 "m1 has turned by -1 turn since the start",
                 {"kind": "turns", "of": "m1", "value": -1.0}),
                ({"kind": "gantry below", "of": "ppu2", "unit": "m", "value": 1.5},
                 "gantry ppu2 < 1.5 m", {"kind": "gantry_below_m", "of": "ppu2", "value": 1.5}),
                ({"kind": "twin above", "of": "lever", "unit": "rad", "value": 0.5},
                 "lever > 0.5 rad", {"kind": "twin_above", "of": "lever", "value": 0.5}),
                ({"kind": "elapsed", "value": 2.0}, "at least 2 s after the hand has taken the handle",
                 {"kind": "elapsed_s", "value": 2.0}),
                ({"kind": "locked", "of": "hinge", "unit": "rad", "value": 0.0}, "a lock holds hinge",
                 {"kind": "locked", "of": "hinge"}),
                ({"kind": "surface", "of": "chair", "unit": "m", "value": 0.0},
                 "of all surfaces chair pushes the twin most",
                 {"kind": "surface", "of": "chair"})):
            self.assertEqual(runs.condition_text(condition), text)
            self.assertEqual(runs.condition_data(condition), data)

    def test_events_have_the_names_of_the_paper(self):
        self.assertEqual(runs.label_of({"name": "t_b'", "what": "t_x: no"}), "t_b'")
        self.assertEqual(runs.label_of({"name": "locked", "what": "t_a: the locked door"}), "t_a")
        self.assertEqual(runs.label_of({"name": "unload", "what": "the bucket"}), "unload")


class Experiments(Folders):
    def measured(self, rows=None, run=None, timing=None):
        return experiments.Measured(self.run_folder(table() if rows is None else rows, run or facts(),
                                                    timing))

    def test_all_as_expected(self):
        run = self.measured()
        self.assertEqual(run.failures, [])
        self.assertEqual(run.events[0]["expected"], {
            "from_s": 1.7, "to_s": 4.7,
            "because": "the hand pushes and pulls without pressing the lever"})
        self.assertNotIn("wall_time_s", run.summary)

    def test_what_failed(self):
        times = DOOR_EVENTS | {"pulled": None, "unlocked": 10.5}
        timing = summary(limits_held=False, fault={"code": 111, "what": "joint torque exceeded"})
        run = self.measured(run=facts(times=times), timing=timing)
        self.assertEqual(run.failures, [
            "pulled did not happen: pulled happens",
            "unlocked happened at 10.500 s, expected 8.7 .. 9.6 s: the hand leans against the door and "
            "presses the lever",
            "a limit was exceeded, see the table", "fault 111: joint torque exceeded"])
        self.assertEqual(experiments.event_rows([run])[3][3], "MISSING")
        self.assertEqual(experiments.event_rows([run])[5][3], "10.500 s, NOT THERE")

    def test_statements_of_the_door_take_their_limits_from_the_model(self):
        rows = table()
        time = rows["time_s"]
        rows["twin.q_a"][(time >= 9.5), 0] = 1.75
        rows["twin.dq_a"][(time >= 12.0) & (time < 12.5), 0] = -1.2
        rows["limits.cause"][time < 5.505, 0] = LOCK
        ours = {what: ours for what, _, ours in self.measured(rows).statements}
        self.assertEqual(ours["t_d: fully open"], "hinge at most 1.7500 rad (limit 1.75)")
        self.assertEqual(ours["t_e: slams shut"],
                         "fastest -1.2000 rad/s (limit -1.2), from 12.00 s on")
        self.assertEqual(ours["locked"], "0.00 .. 5.50 s")
        self.assertEqual(ours["t_a: pushed and pulled, not pressed"],
                         "hinge moves by 0.000 mrad under up to 5.0 N")

    def test_an_event_that_is_missing_leaves_a_dash(self):
        run = self.measured(run=facts(times={name: None for name in DOOR_EVENTS}))
        ours = {what: ours for what, _, ours in run.statements}
        self.assertEqual(ours["t_c: leaned against, pressed"],
                         "force - N before, hinge at - rad/s 0.3 s later")

    def test_forces_with_and_without_a_limit(self):
        rows = table(1.0)
        rows["felt_limit"][:25] = 2
        rows["robot.w_h"][:25] *= 4.0
        rows["mode"][:5] = 0
        free, felt, most, share = experiments.limit_forces(self.measured(rows))
        self.assertEqual((free, felt, most), (5.0, 20.0, 20.0))
        self.assertAlmostEqual(share, 20 / 95)

    def path(self, miss_m):
        """A hand that walks along x with 1 m/s, past places at x = 1 .. 6 m."""
        rows = table(8.0)
        rows["handle.p"][:, 0] = rows["time_s"]
        run = facts("path", {})
        run["events"] = [event(f"checkpoint {n}", float(n), kind="handle at", place=[n, miss_m, 0.5])
                         for n in range(1, 7)]
        return self.measured(rows, run)

    def test_the_path_is_measured_between_its_checkpoints(self):
        run = self.path(0.02)
        self.assertEqual(run.failures, [])
        ours = {what: ours for what, _, ours in run.statements}
        self.assertEqual(ours["checkpoint 3"], "within 2.0 cm and 28.6 degrees at 3.0 s")
        self.assertEqual(ours["from the first to the last"],
                         "5.0 s, 4.99 m, 0.998 times the straight lines")

    def test_a_checkpoint_passed_too_far_away_is_a_failure(self):
        self.assertEqual(self.path(0.06).failures[0],
                         "checkpoint 1 was passed at 6.0 cm, expected within 5 cm")

    def test_one_sample_without_a_value_leaves_none_to_a_stretch(self):
        for place in range(3):
            values = np.arange(3.0)
            values[place] = math.nan
            found = experiments.Stretch(values)
            for value in (found.mean, found.least, found.most, found.magnitude, experiments.largest(values)):
                self.assertEqual(experiments.text(value, 1), "-")

    def test_a_report_of_two_laws_and_its_verdict(self):
        one = self.run_folder(table(), facts(), name="gauss")
        two = self.run_folder(table(), facts(times=DOOR_EVENTS | {"pulled": None}),
                              summary(law="paper"), name="paper")
        verdict, shown = said(experiments.write, {"runs": [one, two]}, self.folder)
        self.assertEqual(verdict, 1)
        self.assertIn("NOT AS EXPECTED: pulled did not happen", shown)
        page = (self.folder / "report.html").read_text()
        self.assertIn("simulated, law gauss</th><th>simulated, law paper", page)
        self.assertIn("1500 / 2", page)
        self.assertIn("hand x by 0.120 mm", page)
        self.assertIn("Law gauss: all 8 events as expected", page)
        self.assertEqual(page.count("<svg"), 1)
        self.assertTrue((one / "results.json").exists())
        fault = self.run_folder(table(), facts(), summary(fault={"code": 5, "what": "x"}), "fault")
        self.assertEqual(said(experiments.write, {"runs": [fault]}, self.folder)[0], 3)


class Comparison(unittest.TestCase):
    def recorded(self, name, rows, **more):
        run = facts() | {"kind": "compare", "file": name, "is_complete": True, "losses": "",
                         "configuration": {"arguments": "", "door.yaml": "a"}, "summary": summary()}
        return {"facts": run | more,
                "columns": {name: rows[name].tolist() for name in ("cycle", "state_hash")}}

    def compare(self, rows, other_rows, of_first=None, **more):
        both = [self.recorded("a", rows, summary=summary(**of_first or {})), self.recorded("b", other_rows, **more)]
        return said(recordings.write, {"kind": "compare", "runs": both}, None)

    def test_the_same(self):
        code, text = self.compare(table(), table())
        self.assertEqual(code, 0)
        self.assertIn("state          the same in every cycle", text)
        self.assertIn("events         nothing changed", text)

    def test_what_changed(self):
        other = table(14.0)
        other["state_hash"][700:] += np.uint64(1)
        events = [event(name, time + 0.02) for name, time in DOOR_EVENTS.items() if name != "pulled"]
        changed = summary(force={"mean_N": 5.04, "max_N": 12.0, "max_torque_Nm": 1.0},
                          cycle_time_us={"median": 11.0, "p99_9": 20.1, "max": 5.0})
        changed["limits"]["hand x"]["worst_violation"] = 3e-4
        code, text = self.compare(table(), other, events=events, summary=changed,
                                  configuration={"arguments": "--seed 2\n", "new.yaml": "b"})
        self.assertEqual(code, 1)
        for line in ("options: none -> --seed 2", "door.yaml: only in the first",
                     "new.yaml: only in the second", "different from cycle 700 (7.000 s) on",
                     "1500 -> 1400 cycles", "pulled (6.000 s) is missing in the second",
                     "locked 20 ms later (2.000 -> 2.020 s)", "largest 9.0 -> 12.0 N",
                     "hand x exceeded by 0.12 -> 0.30 mm", "median 10.0 -> 11.0 us"):
            self.assertIn(line, text)
        for line in ("mean 5", "99.9 %", "cycles are in", "largest 0.0"):
            self.assertNotIn(line, text)

    def test_cycles_that_are_lost_in_one(self):
        rows = table()
        code, text = self.compare(np.delete(rows, [3, 4]), np.delete(rows, [9]))
        self.assertEqual(code, 1)
        self.assertIn("1 cycles are in the first only, 2 in the second only", text)
        self.assertNotIn("different from", text)

    def test_a_value_that_is_missing_in_one_is_reported(self):
        for wrong in (None, math.nan, math.inf):
            other = summary(force={"mean_N": wrong, "max_N": 9.0, "max_torque_Nm": 1.0})
            code, text = self.compare(table(), table(), summary=other)
            self.assertEqual(code, 1)
            self.assertIn("forces         mean has no value in the second", text)

    def test_an_oscillation_of_hand_and_device(self):
        still, shaken = ({"shaking": {"duration_s": duration_s}} for duration_s in (0.0, 0.25))
        code, text = self.compare(table(), table(), of_first=still, summary=summary(**shaken))
        self.assertEqual(code, 1)
        self.assertIn("vibration      hand and device oscillate for 0.00 -> 0.25 s", text)
        for one, other in ((shaken, shaken), (shaken, {}), ({}, shaken)):  # a summary of an earlier program has none
            code, text = self.compare(table(), table(), of_first=one, summary=summary(**other))
            self.assertEqual(code, 0)
            self.assertIn("vibration      nothing changed", text)

    def test_timing_alone_is_no_difference(self):
        other = summary(cycle_time_us={"median": 15.0, "p99_9": 20.0, "max": 0.0})
        code, text = self.compare(table(), table(), summary=other)
        self.assertEqual(code, 0)
        self.assertIn("timing         median 10.0 -> 15.0 us", text)


if __name__ == "__main__":
    unittest.main()
