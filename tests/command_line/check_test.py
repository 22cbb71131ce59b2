"""`hapticgiant check` as its user meets it: exit codes, places, datasheet, JSON, picture.

Usage: check_test.py PROGRAM   (from the repository root)
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
import xml.etree.ElementTree

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
MODELS = pathlib.Path("models")
DEVICE = MODELS / "haptic_giant" / "device.yaml"
DOOR = MODELS / "twins" / "door" / "twin.yaml"


def check(*arguments):
    """(exit code, standard output, standard error) of `hapticgiant check`."""
    done = subprocess.run([PROGRAM, "check", *map(str, arguments)], capture_output=True, text=True,
                          timeout=120, stdin=subprocess.DEVNULL)
    return done.returncode, done.stdout, done.stderr


class Check(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def changed(self, folder, file, *changes):
        """A copy of a shipped folder in which one file has other text."""
        copy = self.folder / folder.name
        shutil.copytree(folder, copy)
        text = (copy / file).read_text()
        for old, new in changes:
            self.assertIn(old, text)
            text = text.replace(old, new)
        (copy / file).write_text(text)
        return copy / file

    def test_shipped_files_are_fine(self):
        files = [DEVICE, *sorted(MODELS.glob("twins/*/twin.yaml")),
                 *sorted(MODELS.glob("scenarios/*.yaml")), *sorted(MODELS.glob("scripts/*.yaml"))]
        code, out, err = check(*files)
        self.assertEqual((code, err), (0, ""), out)
        self.assertIn(f"{len(files)} files: 0 faults", out)

    def test_datasheet_is_the_same_every_time(self):
        first, second = check(DEVICE), check(DEVICE)
        self.assertEqual(first, second)
        self.assertEqual(first[0], 0)
        self.assertIn("HapticGiant: datasheet", first[1])
        volume = float(re.search(r"workspace +([\d.]+) m\^3", first[1])[1])
        self.assertAlmostEqual(volume, 12.2, delta=0.1)
        self.assertIn("12.23 m^3", first[1])

    def test_json_has_the_same_content(self):
        file = self.folder / "check.json"
        self.assertEqual(check(DEVICE, "--json", file)[0], 0)
        reported = json.loads(file.read_text())
        self.assertEqual(reported["files"], [{"file": str(DEVICE), "kind": "device"}])
        self.assertEqual(reported["faults"], 0)
        self.assertEqual(reported["warnings"],
                         sum(f["severity"] == "warning" for f in reported["findings"]))
        for finding in reported["findings"]:
            self.assertEqual(set(finding), {"severity", "file", "line", "column", "item", "what",
                                            "fix"})
        sheet = reported["datasheets"][0]
        self.assertEqual([joint["name"] for joint in sheet["joints"]][2:],
                         ["m1", "m2", "m3", "m4", "m5", "m6"])
        self.assertIsNone(sheet["joints"][2]["q_min_rad"])
        # 110 Nm less 30.7 Nm of gravity by a lever of at most 0.54 m
        self.assertGreater(sheet["force_N"]["least"], 50)
        self.assertLess(sheet["force_N"]["median"], 110 / 0.42)
        self.assertEqual([wall["wall"] for wall in sheet["walls"]],
                         ["x-", "x+", "y-", "y+", "z-", "z+"])
        self.assertAlmostEqual(sheet["walls"][0]["least_N"], 154, delta=5)

    def test_all_faults_of_all_files_at_once_with_their_places(self):
        device = self.changed(DEVICE.parent, "device.yaml", ("kD_rot_1_per_s: 40", "kD_rot: 40"),
                              ("lag_s: 0.040", "lag_s: -1"))
        twin = self.changed(DOOR.parent, "twin.yaml", ("preload_Nm: 3", "preload: 3"),
                            ("joint: hinge", "joint: hing"))
        code, out, _ = check(device, twin)
        self.assertEqual(code, 2)
        for line in (r"device\.yaml:\d+:\d+: fault: drive\.lag_s: must be 1e-06 \.\. 1e\+05, got -1",
                     r"device\.yaml:\d+:\d+: fault: synchronisation\.kD_rot: unknown key, did you "
                     r"mean 'kD_rot_1_per_s'\?",
                     r"twin\.yaml:\d+:\d+: fault: joints\.hinge\.preload: unknown key, did you mean "
                     r"'preload_Nm'\?",
                     r"twin\.yaml:\d+:\d+: fault: locks\[0\]\.joint: must be a joint of the twin, "
                     r"got 'hing', did you mean 'hinge'\?"):
            self.assertRegex(out, line)
        self.assertIn("2 files: 4 faults", out)
        self.assertIn("docs/reference/configuration.md", out)

    def test_physics_fault_ends_with_2_and_advises_a_fix(self):
        device = self.changed(DEVICE.parent, "device.yaml", ("kD_rot_1_per_s: 40",
                                                             "kD_rot_1_per_s: 2500"))
        line = 1 + device.read_text().split("kD_rot_1_per_s: 2500")[0].count("\n")
        code, out, _ = check(device)
        self.assertEqual(code, 2)
        self.assertIn(f"device.yaml:{line}:19: fault: synchronisation.kD_rot_1_per_s: kD dt = 2.5", out)
        self.assertIn("to fix: lower it below 2000", out)

    def test_device_and_twin_are_checked_together(self):
        twin = self.changed(DOOR.parent, "twin.yaml", ("x_m: -0.30", "x_m: 4"))
        self.assertEqual(check(twin)[0], 0)
        code, out, _ = check(DEVICE, twin)
        self.assertEqual(code, 2)
        self.assertRegex(out, r"twin\.yaml:8:\d+: fault: placement: ")

    def test_a_urdf_alone_is_checked_as_a_whole(self):
        sound = DOOR.parent / "door.urdf"
        self.assertEqual(check(sound)[0], 0)
        wrong = self.folder / "arm.urdf"
        wrong.write_text(sound.read_text().replace('type="revolute"', 'type="spherical"', 1))
        code, out, _ = check(wrong)
        self.assertEqual(code, 2)
        self.assertRegex(out, r"arm\.urdf:\d+:\d+: fault: .*type is unknown, got 'spherical'")
        wrong.write_text("version https://git-lfs.github.com/spec/v1\n")
        self.assertIn("it is a pointer of Git LFS", check(wrong)[1])

    def test_drives_of_a_machine_fit_the_ratings_of_its_device(self):
        machine = DEVICE.with_name("machine.yaml")
        self.assertNotIn("0x6072", check(DEVICE, machine)[1])
        wrong = self.folder / "machine.yaml"
        wrong.write_text(machine.read_text().replace("scale: 0.09}", "scale: 90}"))
        _, out, _ = check(DEVICE, wrong)
        self.assertRegex(out, r"machine\.yaml:\d+:\d+: warning: slaves\[\d\]\.outputs\[1\]\.scale: "
                              r"object 0x6072, 1956, times this scale is 1\.76e\+05 Nm; the joint's rating is 176 Nm; "
                              r"suspected scale 0\.09")

    def test_a_machine_of_another_device_is_not_held_against_it(self):
        code, out, _ = check(MODELS / "arms/ur5e/device.yaml", DEVICE.with_name("machine.yaml"))
        self.assertEqual((code, "must be a joint of the device" in out), (0, False), out)

    def test_numbers_in_another_unit_are_doubted_at_their_places(self):
        posture = self.changed(MODELS / "examples", "arm.yaml", (
            "handle: handle\n", "handle: handle\nposture: {turn: 0, shoulder: -45, elbow: 90}\n"))
        code, out, _ = check(posture)
        self.assertEqual(code, 2)
        for joint, degrees, radians in (("shoulder", "-45", "-0.7854"), ("elbow", "90", "1.571")):
            self.assertIn(f"posture: {joint} must be within the limits of the joint, got {degrees}; "
                          f"suspected degrees: {radians} rad", out)
        urdf = self.folder / "arm.urdf"
        urdf.write_text((MODELS / "examples" / "arm.urdf").read_text().replace(
            'lower="-1.9" upper="1.9"', 'lower="-110" upper="110"'))
        code, out, _ = check(urdf)
        self.assertEqual(code, 0)
        self.assertIn("arm.urdf:14:1: warning: joint shoulder: <limit> -110 .. 110: 110 rad are 17.51 turns; "
                      "suspected degrees: 1.92 rad", out)

    def test_new_doubts_what_check_doubts_of_a_urdf(self):
        urdf = self.folder / "arm.urdf"
        text = (MODELS / "examples" / "arm.urdf").read_text().replace('lower="-1.9" upper="1.9"',
                                                                      'lower="-110" upper="110"')
        text = re.sub(r'mass value="[^"]*"', 'mass value="0.01"', text)
        urdf.write_text(re.sub(r'(ixx|iyy|izz)="[^"]*"', r'\1="0.001"', text))
        made = subprocess.run([PROGRAM, "new", "device", urdf, "-o", self.folder / "d.yaml"],
                              capture_output=True, text=True, timeout=120)
        self.assertEqual(made.returncode, 0, made.stderr)
        self.assertIn("arm.urdf:14: joint shoulder: <limit> -110 .. 110: 110 rad are 17.51 turns", made.stderr)
        self.assertIn("all 6 moving links have its inertia, 0.06 kg in all", made.stderr)

    def test_a_scale_that_is_no_scale_is_refused_where_it_matters(self):
        urdf = self.folder / "arm.urdf"
        text = (MODELS / "examples" / "arm.urdf").read_text()
        shape = '<collision><geometry><mesh filename="m.stl" scale="0.001 0.001"/></geometry></collision>'
        urdf.write_text(text.replace('<link name="upper_arm">', '<link name="upper_arm">' + shape))
        what = "<mesh> scale must be three numbers"
        self.assertRegex(check(urdf)[1], rf"arm\.urdf:19:1: warning: link upper_arm: {what}")
        made = subprocess.run([PROGRAM, "new", "device", urdf, "-o", self.folder / "d.yaml"],
                              capture_output=True, text=True, timeout=120)
        self.assertNotEqual(made.returncode, 0)
        self.assertIn(f"arm.urdf:19: link upper_arm: {what}, got '0.001 0.001'", made.stderr)

    def test_a_folder_of_another_encoding_is_no_internal_error(self):
        folder = pathlib.Path(os.fsdecode(os.fsencode(self.folder) + b"/T\xfcr"))
        shutil.copytree(DOOR.parent, folder)
        code, out, err = check(folder / "twin.yaml", "--json", self.folder / "out.json")
        self.assertEqual((code, "internal error" in out + err), (0, False))
        json.loads((self.folder / "out.json").read_text())
        subprocess.run([PROGRAM, "run", "door", "--fast", "--duration", "0.2", "--recordings", folder,
                        "--summary", self.folder / "run.json"], capture_output=True, check=False)
        self.assertIn("recording", json.loads((self.folder / "run.json").read_text()))

    def test_names_that_look_like_places_do_not_move_findings(self):
        folder = self.folder / "a:12: b"
        shutil.copytree(DOOR.parent, folder)
        with open(folder / "twin.yaml", "a") as twin:
            twin.write('"gra: vty": 3\n')
        urdf = folder / "door.urdf"
        urdf.write_text(urdf.read_text().replace('type="revolute"', 'type="spherical"', 1))
        last = (folder / "twin.yaml").read_text().count("\n")
        self.assertEqual(check(folder / "twin.yaml", "--json", self.folder / "out.json")[0], 2)
        faults = {each["item"]: each for each in json.loads((self.folder / "out.json").read_text())["findings"]}
        self.assertEqual((faults["gra: vty"]["file"], faults["gra: vty"]["line"], faults["gra: vty"]["column"],
                          faults["gra: vty"]["what"]),
                         (str(folder / "twin.yaml"), last, 1, "unknown key, did you mean 'gravity'?"))
        of_joint = faults["joint hinge"]
        self.assertEqual((of_joint["file"], of_joint["column"]), (str(urdf), 1))
        self.assertGreater(of_joint["line"], 1)
        self.assertTrue(of_joint["what"].startswith("type is unknown, got 'spherical'"), of_joint)

    def test_files_that_are_no_kind_of_ours(self):
        odd = self.folder / "odd.yaml"
        odd.write_text("colour: red\n")
        empty = self.folder / "empty.yaml"
        empty.write_text("")
        code, out, _ = check(odd, empty, self.folder / "none.yaml", DOOR)
        self.assertEqual(code, 2)
        self.assertRegex(out, r"odd\.yaml:1:1: fault: is no kind of file that is known")
        self.assertRegex(out, r"empty\.yaml:\d+:\d+: fault: ")
        self.assertRegex(out, r"none\.yaml:1:1: fault: .*no such file")
        self.assertIn("twin.yaml: twin", out)

    def test_map_is_a_picture_with_legend_and_units(self):
        file = self.folder / "map.svg"
        self.assertEqual(check(DEVICE, "--map", file)[0], 0)
        root = xml.etree.ElementTree.parse(file).getroot()
        texts = " ".join(element.text or "" for element in root.iter())
        for word in ("HapticGiant", "force in N", "x in m", "z in m", "box of the handle"):
            self.assertIn(word, texts)
        cells = [e for e in root.iter() if e.tag.endswith("path")]
        self.assertGreater(len(cells), 1000)

    def test_without_python_only_the_map_is_missing(self):
        file = self.folder / "map.svg"
        with unittest.mock.patch.dict(os.environ, HAPTICGIANT_PYTHON="/bin/false-no-such-python"):
            code, out, err = check(DEVICE, "--map", file)
        self.assertEqual(code, 2)
        self.assertIn("HapticGiant: datasheet", out)
        self.assertIn("needs scipy, matplotlib and jinja2; tools/setup.sh build", err)
        self.assertFalse(file.exists())

    def test_bad_arguments(self):
        self.assertEqual(check()[0], 2)
        code, _, err = check(DOOR, "--map", self.folder / "map.svg")
        self.assertEqual(code, 2)
        self.assertIn("--map", err)
        odd = self.changed(DEVICE.parent, "device.yaml", ("lag_s: 0.040", "lag_s: -1"))
        code, out, _ = check(odd, "--map", self.folder / "map.svg")
        self.assertEqual(code, 2)
        self.assertIn("drive.lag_s: must be 1e-06 .. 1e+05", out)  # reported although there is no map
        code, _, err = check(DEVICE, "--json", self.folder / "none" / "x.json")
        self.assertEqual(code, 2)
        self.assertIn("cannot be written", err)


if __name__ == "__main__":
    unittest.main(verbosity=1)
