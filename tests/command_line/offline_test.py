"""Commands of programs beside hapticgiant: the same name and help, and one sentence where one is not built.

    offline_test.py PROGRAM
"""

import json
import os
import pathlib
import re
import subprocess
import tempfile
import unittest
import unittest.mock

from program import PROGRAM, install_program

OFFLINE = PROGRAM.with_name("hapticgiant-offline")


def run(*words, code=0):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False)
    assert done.returncode == code, done
    return done.stdout, done.stderr


def commands(program):
    """Name -> description of the subcommands in the help of a program."""
    out, _ = run(program, "--help")
    return dict(re.findall(r"^  ([a-z][\w-]*)  +(\S.*)$", out.split("\nOptions:")[1], re.MULTILINE))


class Offline(unittest.TestCase):
    def test_every_command_has_the_description_that_hapticgiant_shows(self):
        shown, offline = commands(PROGRAM), commands(OFFLINE)
        self.assertIn("export", offline)
        for name, description in offline.items():
            self.assertEqual(shown.get(name), description)

    def test_help_and_errors_are_those_of_the_command(self):
        out, _ = run(PROGRAM, "export", "--help")
        self.assertEqual(out, run(OFFLINE, "export", "--help")[0])
        self.assertIn("--list-columns", out)
        _, err = run(PROGRAM, "hqp", "solv", code=2)
        self.assertIn("did you mean 'solve'?", err)

    def test_where_results_go_is_one_option_everywhere(self):
        for words in (["haptify"], ["export"], ["plot"], ["tune"], ["bench"], ["design"], ["sweep", "run"], ["study", "run"],
                      ["experiment", "all"], ["experiment", "hands"], ["new", "device"], ["new", "twin"]):
            out, _ = run(PROGRAM, *words, "--help")
            self.assertRegex(out, r"-o[ ,][^\n]*--out\b", words)

    def test_a_program_that_is_not_built_is_named_in_one_line(self):
        with tempfile.TemporaryDirectory() as folder:
            alone = install_program(pathlib.Path(folder))
            for words in (["export", "x.mcap"], ["bridge", "ros2"]):
                out, err = run(alone, *words, code=2)
                self.assertEqual((out, err.count("\n")), ("", 1))
                self.assertIn("make build", err)

    def test_what_was_identified_is_printed_and_without_python_kept(self):
        with tempfile.TemporaryDirectory() as folder:
            run(PROGRAM, "run", "free_space", "--fast", "--no-viewer", "--duration", "2", "--recordings", folder,
                code=1)  # too short for its events
            words = (PROGRAM, "identify", "friction", f"{folder}/latest.mcap")
            out, err = run(*words, code=2)
            self.assertRegex(out, r"latest\.mcap: 6 joints, drives on for 1\.\d s\n\nm1  slid 0 s forward")
            self.assertEqual(err, "not usable: no joint moved enough for its friction\n")
            kept = pathlib.Path(folder, "friction.json")
            with unittest.mock.patch.dict(os.environ, HAPTICGIANT_PYTHON="/bin/false-no-such-python"):
                for needing in (words, (PROGRAM, "identify", "payload")):
                    out, err = run(*needing, code=2)
                    self.assertEqual(out, "")
                    self.assertIn("needs scipy, matplotlib and jinja2; tools/setup.sh build", err)
                _, err = run(*words, "--json", kept, code=4)
            self.assertTrue(err.endswith(f"{kept} has the results\n"), err)
            self.assertEqual([joint["name"] for joint in json.loads(kept.read_text())["joints"]],
                             ["m1", "m2", "m3", "m4", "m5", "m6"])

    def test_options_of_earlier_versions_name_what_to_use(self):
        for option, instead in (("--bounds", "--law paper_bounds"), ("--braking", "--law gauss")):
            _, err = run(PROGRAM, "run", "door", option, "paper", code=2)
            self.assertIn(f"{option}: is no option any more: use {instead}", err)


if __name__ == "__main__":
    unittest.main()
