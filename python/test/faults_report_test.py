"""Tables of injected faults: what is counted, and which cases are named.

Usage: faults_report_test.py   (from anywhere; no compiled part)
"""

import pathlib
import tempfile
import unittest

from report_test import said

from hapticgiant.report import faults, tables


def case(outcome="noticed", **more):
    found = {"scenario": "Walk", "fault": "motor_dead", "in_words": "motor_dead of 1 by 0  at 2 s",
             "phase": "running", "outcome": outcome, "peak_force_N": 60.0, "worst_excess": 0.0,
             "worst_distance_m": 0.001, "travel_share": 0.1, "energy_J": 0.5,
             "recording_complete": True, "has_fallen": False, "passed": True}
    if outcome == "noticed":
        found |= {"code": 106, "code_in_words": "sensors contradict", "stop": "STO",
                  "noticed_s": 0.002, "at_rest_after_s": 0.1}
    return {**found, **more}


def results(*cases):
    kinds = [{"name": "motor_dead", "what": "no torque", "unit": "", "has_sign": False, "least": 0,
              "most": 0},
             {"name": "link_encoder_jump", "what": "jumps", "unit": "rad", "has_sign": True,
              "least": 0.02, "most": 0.5}]
    return {"seed": 3, "scenarios": ["Door", "Walk"], "excess_bound": 0.1, "force_bound_N": 280.0,
            "energy_bound_J": 30.0, "kinds": kinds, "cases": list(cases)}


def cells(table, row=1):
    return dict(zip(table[0], table[row]))


class Faults(unittest.TestCase):
    def test_a_row_has_counts_of_all_and_times_of_faults_alone(self):
        row = cells(faults.table_of(results(
            case(), case(noticed_s=0.004, at_rest_after_s=0.3), case(noticed_s=0.01, code=0),
            case(**{"and": "another", "noticed_s": 5.0, "peak_force_N": 90.0}),
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
        text = faults.text(results(case(), case("unnoticed", passed=False,
                                                recording_complete=False)))
        self.assertIn("case 1: motor_dead of 1", text)
        self.assertIn("its recording has lost cycles", text)
        self.assertNotIn("case 0", text)
        self.assertIn("\n1 of 2 cases went unnoticed", text)
        self.assertNotIn("fell because", text)

    def test_an_arm_that_no_software_holds_is_counted_separately(self):
        text = faults.text(results(case(has_fallen=True), case()))
        self.assertIn("0 of 2 cases went unnoticed", text)
        self.assertIn("1 of 2 cases fell because a brake did not hold", text)

    def test_the_page_lists_all_kinds(self):
        page = faults.page(results(case()))
        self.assertIn("# Results of 1 cases", page)
        self.assertIn("Seed 3; Door, Walk: 0 of 1", page)
        self.assertIn("\n| link_encoder_jump | jumps | +- 0.02 .. 0.5 rad |\n", page)
        self.assertIn("\n| motor_dead | no torque | - |\n", page)

    def test_the_page_of_the_documents_links_to_its_tables(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            said(faults.write, results(case()), folder, docs=folder)
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
