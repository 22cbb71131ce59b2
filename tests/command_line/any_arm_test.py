"""Haptify, experiments and faults with an arm that is not the reference device.

Usage: any_arm_test.py PROGRAM   (from the repository root)
"""

import csv
import json
import unittest

from program import TemporaryFolder, run

ARM = "models/examples/arm.yaml"
MOVED = "free space on example arm"


class AnyArm(TemporaryFolder):
    def ok(self, *arguments):
        code, out, err = run(*arguments)
        self.assertEqual(code, 0, out + err)
        return out

    def test_haptify_measures_it_and_says_what_it_cannot_do(self):
        folder = self.folder / "haptify"
        out = self.ok("haptify", "--quick", "--repetitions", 2, "--device", ARM, "--out", folder)
        with open(folder / "haptify.csv") as stream:
            rows = {row["id"]: row for row in csv.DictReader(stream)}
        for name in ("free_space_force", "stiffness_accuracy", "z_width", "spring_frequency"):
            self.assertTrue(float(rows[name]["mean"]) > 0.0, name)
        # the handle does not come so far, and there are no joints with friction
        self.assertEqual(rows["felt_mass_60"]["mean"], "")
        text = (folder / "report.md").read_text()
        self.assertTrue(text.startswith("# Haptify: example arm\n"))
        self.assertIn(f"--device {ARM}", text)
        for said in ("felt mass, 2 of 12 runs: the handle needs 0.31 m", "Measured around",
                     "sources of vibration, 1 of 4 runs: the device has drives that follow"):
            self.assertIn(said, text)
            self.assertIn(said, out)
        self.assertNotIn("nan", text.split())

    def test_impedance_has_the_cases_of_its_drives(self):
        file = self.folder / "impedance.json"
        out = self.ok("experiment", "impedance", "--device", ARM, "--json", file)
        self.assertIn("example arm. Measured around", out)
        names = {run_["name"] for run_ in json.loads(file.read_text())["runs"]}
        self.assertEqual(names, {"drives", "drives, blind"})

    def test_seeds_move_the_body_through_its_workspace(self):
        file = self.folder / "seeds.json"
        self.ok("experiment", "seeds", "--device", ARM, "--count", 1, "--json", file)
        (seed,) = json.loads(file.read_text())["runs"]
        self.assertEqual((seed["scenario"], seed["held"]), (MOVED, True))

    def test_a_twin_that_it_cannot_hold_is_refused(self):
        code, out, err = run("experiment", "seeds", "--device", ARM, "--twin", "door")
        self.assertEqual(code, 2, out)
        self.assertIn("move or turn the twin's placement", err)

    def test_faults_that_it_cannot_have_are_not_played(self):
        file = self.folder / "faults.json"
        self.ok("faults", "--device", ARM, "--cases", 6, "--json", file)
        results = json.loads(file.read_text())
        self.assertEqual(results["scenarios"], [MOVED])
        impossible = {it["fault"]: it["why"] for it in results["impossible"]}
        self.assertEqual(impossible["gantry_dead"], "the device has no gantry")
        self.assertIn("motor_dead", impossible)
        self.assertFalse(impossible.keys() & {case["fault"] for case in results["cases"]})

    def test_figures_of_the_reference_device_refuse_it(self):
        for name in ("cartesian", "contact"):
            code, out, err = run("experiment", name, "--device", ARM)
            self.assertEqual(code, 2, out)
            self.assertIn("HapticGiant", err)
            self.assertIn("--device FILE", err)


if __name__ == "__main__":
    unittest.main()
