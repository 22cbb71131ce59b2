"""Python has the table of the parameters of a twin that may change while it runs."""

import csv
import math
import pathlib
import unittest

import hapticgiant as hg

REFERENCE = pathlib.Path(__file__).parents[2] / "docs" / "reference"
TABLES = [REFERENCE / f"configuration_{kind}.csv" for kind in ("twin", "scenario")]  # scales are the scenario's


class TwinParameters(unittest.TestCase):
    def setUp(self):
        self.table = {facts.parameter: facts for facts in hg.twin_parameters()}

    def test_there_is_one_for_each_that_can_be_changed(self):
        self.assertEqual(set(self.table), set(hg.Parameter) - {hg.Parameter.NONE})

    def test_keys_and_texts_are_those_of_the_reference_table(self):
        rows = [row for table in TABLES for row in csv.reader(table.read_text().splitlines())]
        text = "\n".join(" ".join(row) for row in rows)
        for facts in self.table.values():
            with self.subTest(facts.parameter.name):
                self.assertIn(facts.key, text)
                self.assertIn(facts.help, text)
                self.assertIn(facts.length_key, text)
                self.assertTrue(facts.label)

    def test_units_are_those_of_the_keys(self):
        damping = self.table[hg.Parameter.DAMPING]
        self.assertEqual((damping.key, damping.unit), ("damping_Nms_per_rad", "Nms/rad"))
        self.assertEqual((damping.length_key, damping.length_unit), ("damping_Ns_per_m", "Ns/m"))
        self.assertEqual(self.table[hg.Parameter.MASS_SCALE].unit, "")

    def test_ranges_are_those_of_the_control_cycle(self):
        scale = self.table[hg.Parameter.MASS_SCALE]
        self.assertEqual((scale.lower, scale.upper), (0.1, 10.0))
        self.assertFalse(scale.allows(10.1))
        self.assertTrue(self.table[hg.Parameter.UPPER_LIMIT].allows(math.inf))
        self.assertFalse(self.table[hg.Parameter.UPPER_LIMIT].allows(-math.inf))
        self.assertFalse(self.table[hg.Parameter.SPEED_LIMIT].allows(0.0))
        self.assertFalse(self.table[hg.Parameter.STIFFNESS].allows(math.nan))
        self.assertFalse(self.table[hg.Parameter.STIFFNESS].allows(1.1e9))


if __name__ == "__main__":
    unittest.main()
