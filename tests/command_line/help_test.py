"""Help of the program, and what it says of words, options and files that it does not take.

Usage: help_test.py PROGRAM   (from the repository root)
"""

import re
import unittest

from program import MODELS, TemporaryFolder, run

EXAMPLES = MODELS / "examples"


class Help(unittest.TestCase):
    def test_commands_stand_in_groups_below_first_steps(self):
        code, out, err = run("--help")
        self.assertEqual((code, err), (0, ""))
        headings = re.findall(r"^(\w.*):$", out, re.MULTILINE)
        self.assertEqual(headings, ["First steps", "Options", "Runs", "Your own device and twin", "The machine",
                                    "Studies and experiments", "Other programs", "This program"])
        self.assertLess(out.index("  hapticgiant run "), out.index("Usage:"))

    def test_without_a_word_it_is_the_help(self):
        code, out, err = run()
        self.assertEqual((code, err), (2, ""))
        self.assertEqual(out, run("--help")[1])

    def test_help_is_a_command(self):
        for words, option in ((("help",), ("--help",)), (("help", "run"), ("run", "--help")),
                              (("help", "new", "twin"), ("new", "twin", "--help")),
                              (("help", "plot"), ("plot", "--help")), (("help", "study"), ("study", "--help"))):
            code, out, err = run(*words)
            self.assertEqual((code, out, err), run(*option), words)
            self.assertEqual(code, 0, words)
        code, _, err = run("help", "rum")
        self.assertEqual(code, 2)
        self.assertIn("did you mean 'run'?", err)

    def test_what_is_ready_to_run_is_listed(self):
        code, out, err = run("run", "--list")
        self.assertEqual((code, err), (0, ""))
        scenarios, devices, twins = out.split("\n\n")
        self.assertRegex(scenarios, r"(?m)^  door +Door$")
        self.assertRegex(scenarios, r"(?m)^  fr3/open_drawer +Drawer, Franka FR3$")
        self.assertRegex(devices, r"(?m)^  fr3 +Franka FR3$")
        self.assertRegex(twins, r"(?m)^  fr3/drawer +drawer$")
        self.assertNotRegex(scenarios, r"(?m)^  fr3/(drawer|tool|device|simulation) ")
        for name in re.findall(r"(?m)^  (\S+) ", scenarios):
            code, out, err = run("run", name, "--fast", "--no-recording", "--duration", "0.01", "--user", "none")
            self.assertEqual((code, err), (0, ""), name)


class Refused(TemporaryFolder):
    def refused(self, *words):
        code, out, err = run(*words)
        self.assertEqual((code, out), (2, ""), words)
        return err

    def test_words_are_understood_by_their_meaning(self):
        for word, command in (("list", "run --list"), ("start", "run"), ("play", "run"), ("view", "replay RECORDING --view"),
                              ("open", "replay RECORDING --view"), ("door", "run door"), ("excavator", "run excavator"),
                              ("ur5/open_cupboard", "run ur5e/open_cupboard"), ("diff", "compare RECORDING RECORDING"),
                              (EXAMPLES / "arm.urdf", f"new device {EXAMPLES / 'arm.urdf'}"),
                              (EXAMPLES / "arm.yaml", f"run --device {EXAMPLES / 'arm.yaml'}"),
                              (MODELS / "scenarios/door.yaml", f"run {MODELS / 'scenarios/door.yaml'}")):
            self.assertIn(f"'hapticgiant {command}'", self.refused(word))

    def test_words_without_a_meaning_name_the_commands(self):
        self.assertIn("rum: no such subcommand of hapticgiant, did you mean 'run'?", self.refused("rum"))
        self.assertIn("experim: no such subcommand of hapticgiant, did you mean 'experiment'?", self.refused("experim"))
        for words in (("gnarl",), ("experiment", "gnarl")):
            err = self.refused(*words)
            self.assertNotIn("did you mean", err)
            self.assertIn("; there are ", err)

    def test_what_is_missing_is_explained(self):
        self.assertIn("hapticgiant simulate: --listen is required: HOST:PORT", self.refused("simulate"))
        self.assertIn("hapticgiant plot: files is required: recordings", self.refused("plot"))

    def test_unknown_options_name_the_nearest(self):
        for words, name, near in ((("run", "--duratin", "2"), "--duratin", "--duration"),
                                  (("new", "device", EXAMPLES / "arm.urdf", "--tip_link", "x"), "--tip_link", "--tip-link"),
                                  (("new", "device", EXAMPLES / "arm.urdf", "--tip", "x"), "--tip", "--tip-link"),
                                  (("experiment", "seeds", "--cont=3"), "--cont", "--count"),
                                  (("--versoin",), "--versoin", "--version")):
            self.assertRegex(self.refused(*words), rf"{name}: no such option of hapticgiant.*, did you mean '{near}'\?")
        self.assertNotIn("did you mean", self.refused("run", "--colour"))
        self.assertIn("excavator: one word too many, hapticgiant run takes only scenario",
                      self.refused("run", "door", "excavator"))
        self.assertIn("expected one of together, gauss", self.refused("run", "--law", "gaus"))
        self.assertIn("got 'gaus', did you mean 'gauss'?", self.refused("run", "--law", "gaus"))

    def test_files_of_arms_name_the_nearest_of_their_kind(self):
        for words, near in ((("ur5/open_cupboard",), "scenario file, did you mean 'ur5e/open_cupboard'"),
                            (("ur10/turn_cam",), "scenario file, did you mean 'ur5e/turn_cam'"),
                            (("ur5/open_cupbord",), "scenario file, did you mean 'ur5e/open_cupboard'"),
                            (("--twin", "ur5/drawer"), "twin file, did you mean 'ur5e/drawer'"),
                            (("gen3/turn_cam",), "scenario file, did you mean 'gen3/move_tool'? Of gen3 there are move_tool, open_"),
                            (("--device", "fr3/fcu"), "device file, did you mean 'fr3/fci'"),
                            (("--device", "fr/fci"), "device file, did you mean 'fr3/fci'"),
                            (("--device", "ur5"), "device file, did you mean 'ur5e'"),
                            (("mine/dor.yaml",), "scenario file, did you mean 'door'")):
            err = self.refused("run", *words, "--fast", "--no-recording")
            self.assertIn(f"{words[-1]}: no such {near}", err)
            self.assertEqual(len(err.splitlines()), 1, err)

    def test_files_of_another_kind_are_named_as_such(self):
        arm, gate, twin = EXAMPLES / "arm.yaml", EXAMPLES / "gate.urdf", MODELS / "twins/door/twin.yaml"
        for words, said in (
                (("--device", EXAMPLES / "arm.urdf"), "is a URDF, expected a device file; 'hapticgiant new device "),
                (("--twin", gate), "is a URDF, expected a twin file; 'hapticgiant new twin "),
                (("--device", twin), "is a twin file, expected a device file"),
                (("--twin", arm), "is a device file, expected a twin file"),
                (("--user", arm), "is a device file, expected a script file"),
                (("--simulation", arm), "is a device file, expected a simulation file"),
                ((arm,), "is a device file, expected a scenario file"),
                ((gate,), "is a URDF, expected a scenario file"),
                ((self.folder,), "is a folder, expected a scenario file"),
                (("--twin", self.folder), "is a folder, expected a twin file"),
                (("--device", self.folder), "is a folder, expected a device file")):
            err = self.refused("run", *words, "--fast", "--no-recording")
            self.assertIn(said, err)
            self.assertEqual(len(err.splitlines()), 1, err)
        self.assertIn("is a folder", run("check", self.folder)[1])
        self.assertIn("expected a URDF", self.refused("new", "device", arm))

    def test_a_file_with_faults_of_its_own_kind_has_them_named(self):
        device = self.folder / "device.yaml"
        device.write_text((EXAMPLES / "arm.yaml").read_text().replace("handle:", "handel:")
                          .replace("arm.urdf", str(EXAMPLES / "arm.urdf")))
        err = self.refused("run", "--device", device, "--fast", "--no-recording")
        self.assertIn("handel: unknown key, did you mean 'handle'?", err)


if __name__ == "__main__":
    unittest.main()
