"""Tables of injected faults: what is counted, and which cases are named.

Usage: faults_report_test.py   (from anywhere; no compiled part)
"""

import json
import pathlib
import tempfile
import unittest

from report_test import said

from hapticgiant.report import faults, tables


def injected(kind):
    return {"fault": kind, "index": 4, "magnitude": 1.0, "at_s": 4.0}


def case(outcome="noticed", **more):
    found = {"scenario": "Walk", "fault": "motor_dead", "index": 1, "magnitude": 0.0, "at_s": 2.0,
             "phase": "running", "outcome": outcome, "peak_force_N": 60.0, "worst_excess": 0.01,
             "worst_distance_m": 0.001, "travel_share": 0.1, "energy_J": 0.5,
             "recording_complete": True}
    if outcome == "noticed":
        found |= {"code": 106, "code_in_words": "sensors contradict", "stop": "STO",
                  "noticed_s": 0.002, "at_rest_after_s": 0.1}
    return {**found, **more}


def results(*cases):
    kinds = [{"name": "motor_dead", "what": "no torque", "unit": "", "has_sign": False, "least": 0,
              "most": 0},
             {"name": "link_encoder_jump", "what": "jumps", "unit": "rad", "has_sign": True,
              "least": 0.02, "most": 0.5},
             {"name": "brake_weak", "what": "does not hold", "unit": "", "has_sign": False,
              "least": 0, "most": 0}]
    return {"seed": 3, "scenarios": ["Door", "Walk"], "excess_bound": 0.1, "force_bound_N": 280.0,
            "energy_bound_J": 30.0, "kinds": kinds, "cases": list(cases)}


def judged(*cases):
    found = results(*cases)
    faults.judge(found)
    return found


def fallen(**more):
    """An arm that falls in an emergency stop because a brake does not hold."""
    return case(**{"travel_share": 3.0, "brake_slips": True,
                   "and": injected("brake_weak"), **more})


def cells(table, row=1):
    return dict(zip(table[0], table[row]))


class Faults(unittest.TestCase):
    def test_a_row_has_counts_of_all_and_times_of_faults_alone(self):
        row = cells(faults.table_of(judged(
            case(), case(noticed_s=0.004, at_rest_after_s=0.3), case(noticed_s=0.01, code=0),
            case(**{"and": injected("motor_dead"), "noticed_s": 5.0, "peak_force_N": 90.0}),
            case("harmless", travel_share=0.25), case("unnoticed", worst_excess=0.02))))
        self.assertEqual(row, {
            "fault": "motor_dead", "cases": "6", "noticed": "4", "harmless": "1", "unnoticed": "1",
            "noticed ms": "4 / 10", "at rest ms": "100 / 300", "stop": "STO", "N": "90",
            "outside": "0.0200", "way %": "25", "J": "0.5", "most often": "106 sensors contradict"})

    def test_kinds_without_cases_are_left_out_and_what_was_not_noticed_has_no_times(self):
        table = faults.table_of(results(case("harmless")))
        self.assertEqual(len(table), 2)
        self.assertEqual((cells(table)["noticed ms"], cells(table)["most often"]), ("-", ""))

    def test_a_stop_without_a_fault_is_named_so(self):
        self.assertEqual(cells(faults.table_of(results(case(code=0))))["most often"], "no fault")

    def test_failures_are_named_one_by_one(self):
        text = faults.text(judged(case(), fallen(brake_slips=False, recording_complete=False)))
        self.assertIn("case 1: motor_dead of 1 by 0  at 2.000 s and brake_weak of 4 by 1  at "
                      "4.000 s in Walk, running: noticed 106, 60 N", text)
        self.assertIn("its recording has lost cycles", text)
        self.assertNotIn("case 0", text)
        self.assertIn("\n1 of 2 cases went unnoticed", text)
        self.assertNotIn("fell because", text)

    def test_an_arm_that_no_software_holds_is_counted_separately(self):
        text = faults.text(judged(fallen(), case()))
        self.assertIn("0 of 2 cases went unnoticed", text)
        self.assertIn("1 of 2 cases fell because a brake did not hold", text)

    def test_an_unnoticed_fault_and_a_case_beyond_a_bound_fail(self):
        bad = [case("unnoticed"), case(peak_force_N=281.0), case(worst_excess=0.11),
               case(recording_complete=False), case(travel_share=1.1), case(energy_J=31.0),
               fallen(brake_slips=False), fallen(**{"and": injected("motor_dead")}),
               fallen(peak_force_N=281.0), fallen(travel_share=1.0, energy_J=31.0)]
        good = [case(), case("harmless"), fallen(), fallen(worst_excess=0.11, energy_J=31.0),
                fallen(fault="brake_weak", **{"and": injected("motor_dead")})]
        found = judged(*good, *bad)
        self.assertEqual([it["passed"] for it in found["cases"]],
                         [True] * len(good) + [False] * len(bad))
        self.assertFalse(found["passed"])
        self.assertTrue(judged(*good[:2])["passed"])

    def test_a_value_that_is_not_finite_fails_and_stays_null(self):
        for key in ("peak_force_N", "worst_excess", "travel_share", "energy_J"):
            with tempfile.TemporaryDirectory() as name:
                folder = pathlib.Path(name)
                self.assertEqual(said(faults.write, results(case(**{key: None})), folder)[0], 1, key)
                kept = json.loads((folder / "faults.json").read_text())["cases"][0]
                self.assertEqual((kept["passed"], kept[key]), (False, None))

    def test_the_page_lists_all_kinds(self):
        page = faults.page(judged(case()))
        self.assertIn("# Results of 1 cases", page)
        self.assertIn("Seed 3; Door, Walk: 0 of 1", page)
        self.assertIn("\n| link_encoder_jump | jumps | +- 0.02 .. 0.5 rad |\n", page)
        self.assertIn("\n| motor_dead | no torque | - |\n", page)

    def test_the_page_of_the_documents_links_to_its_tables(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            self.assertEqual(said(faults.write, results(case()), folder, docs=folder)[0], 0)
            kept = json.loads((folder / "faults.json").read_text())
            self.assertEqual((kept["passed"], kept["cases"][0]["passed"]), (True, True))
            page = (folder / "fault_campaign.md").read_text()
            self.assertIn("\n[Table: fault_campaign_kinds.csv](fault_campaign_kinds.csv)\n", page)
            self.assertIn("\nmotor_dead,no torque,-\n", (folder / "fault_campaign_kinds.csv").read_text())
            self.assertIn("\nmotor_dead,1,1,0,0,", (folder / "fault_campaign_results.csv").read_text())
            self.assertIn("\n| motor_dead | no torque | - |\n", (folder / "report.md").read_text())


class Columns(unittest.TestCase):
    def test_columns_are_aligned(self):
        rows = [["name", "n"], ["a", "1"], ["longer", "100"]]
        self.assertEqual(tables.as_text(rows), "name      n\na         1\nlonger  100\n")
        self.assertEqual(tables.aligned_markdown(rows), "| name   |   n |\n| ------ | --: |\n"
                                                 "| a      |   1 |\n| longer | 100 |\n")


if __name__ == "__main__":
    unittest.main()
