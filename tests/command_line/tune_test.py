"""`hapticgiant tune` as its user meets it, in one posture.

Usage: tune_test.py PROGRAM   (from the repository root)
"""

import csv
import json
import os
import re
import shutil
import unittest
import unittest.mock

from program import MODELS, TemporaryFolder, run


class Tune(TemporaryFolder):
    def test_its_lines_are_a_device_that_check_takes(self):
        device = self.folder / "haptic_giant"
        shutil.copytree(MODELS / "haptic_giant", device)
        out = self.folder / "out"
        code, reported, err = run("tune", device / "device.yaml", "--postures", 1, "--out", out,
                              timeout=900)
        self.assertEqual((code, err), (0, ""), reported)
        self.assertRegex(reported, r"proven +(yes|NO) +yes\n")
        lines = reported[reported.index("for device.yaml:\n") + 17:reported.index("\nreport ")]
        self.assertEqual(re.findall(r"^(\w+):$", lines, re.M), ["estimation", "control"])
        found = {key: float(value) for key, value in re.findall(r"^  (\w+): (\S+)", lines, re.M)}

        text = (device / "device.yaml").read_text()
        for key, value in found.items():
            if not re.search(rf"^  {key}: ", text, re.M):
                text = text.replace("\ncontrol:\n", f"\ncontrol:\n  {key}: {value}\n")
            text = re.sub(rf"^(  {key}:) [^ \n]+", rf"\1 {value}", text, flags=re.M)
        (device / "device.yaml").write_text(text)
        code, reported, err = run("check", device / "device.yaml")
        self.assertEqual(code, 0, reported + err)
        code, reported, err = run("tune", device / "device.yaml", "--postures", 1, "--check")
        self.assertEqual((code, err), (0, ""), reported)
        self.assertIn("holds in 1 of 1 postures", reported)

        with open(out / "front.csv", newline="") as file:
            rows = list(csv.DictReader(file, strict=True))
        self.assertEqual(len(rows), 2)  # now, and tuned
        self.assertEqual(rows[1]["is_proven"], "1")
        self.assertLess(float(rows[1]["distortion"]), float(rows[0]["distortion"]))
        for key, value in found.items():
            self.assertAlmostEqual(float(rows[1][key]), value, places=9)
        report = (out / "report.md").read_text()
        self.assertIn(lines, report)
        self.assertIn("figure.svg", report)
        self.assertIn("<svg", (out / "figure.svg").read_text())
        facts = json.loads((out / "results.json").read_text())
        for name in ("radii_before", "radii"):  # one posture
            self.assertEqual([len(facts[name][loop]) for loop in ("arm", "hand")], [1, 1])
        self.assertLess(facts["radii"]["arm"][0], facts["arm_limit"])
        self.assertLess(facts["radii"]["hand"][0], facts["hand_limit"])
        for felt in (facts["felt_before"], facts["felt"]):
            slow = [k for k, f in enumerate(felt["frequency_Hz"]) if f < 1.0]
            for k in slow:  # a slow hand feels the body
                self.assertAlmostEqual(felt["least"][k], 1.0, delta=0.1)
                self.assertAlmostEqual(felt["largest"][k], 1.0, delta=0.1)

    def test_without_python_nothing_is_searched(self):
        with unittest.mock.patch.dict(os.environ, HAPTICGIANT_PYTHON="/bin/false-no-such-python"):
            code, out, err = run("tune", "--out", self.folder / "none")
        self.assertEqual((code, out), (2, ""))
        self.assertIn("needs scipy, matplotlib and jinja2; tools/setup.sh build", err)
        self.assertFalse((self.folder / "none").exists())

    def test_what_cannot_be_tuned_is_refused_in_one_line(self):
        device = self.folder / "haptic_giant"
        shutil.copytree(MODELS / "haptic_giant", device)
        text = (device / "device.yaml").read_text()
        for section in ("actuators", "control"):
            text = re.sub(rf"^{section}:\n(?:[ ].*\n|\n)*", "", text, flags=re.M)
        (device / "device.yaml").write_text(text)
        cases = [
            ((device / "device.yaml",), "its drives follow positions on their own"),
            (("devcie.yaml",), "devcie.yaml: no such file"),
            (("--vibration", "-1"), "--vibration"),
            (("--mass", "nan"), "--mass"),
            (("--postures", "0"), "--postures"),
        ]
        for arguments, message in cases:
            code, reported, err = run("tune", *arguments, "--out", self.folder / "none")
            self.assertEqual(code, 2, (arguments, reported, err))
            self.assertIn(message, err, arguments)
            self.assertFalse((self.folder / "none").exists(), arguments)


if __name__ == "__main__":
    unittest.main()
