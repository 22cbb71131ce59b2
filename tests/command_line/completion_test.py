"""Shells complete command lines of the program: what it offers, and that bash takes it.

    completion_test.py PROGRAM
"""

import pathlib
import re
import shlex
import subprocess
import tempfile
import unittest

from program import PROGRAM, install_program


def offered(*words, program=PROGRAM):
    """What the last of these words can be completed to."""
    done = subprocess.run([program, "__complete", *words], capture_output=True, text=True, check=True)
    assert done.stderr == "", done
    return done.stdout.split()


def completed_by_bash(*words):
    """The same by the function that bash calls, in a bash that has read the script."""
    typed = " ".join(shlex.quote(word) for word in ("hapticgiant", *words))
    script = (f'hapticgiant() {{ {shlex.quote(str(PROGRAM))} "$@"; }}; eval "$(hapticgiant completion bash)"; '
              f"COMP_WORDS=({typed}); COMP_CWORD={len(words)}; _hapticgiant {shlex.quote(str(PROGRAM))}; "
              'printf "%s\\n" "${COMPREPLY[@]}"')
    done = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True)
    assert done.stderr == "", done
    return done.stdout.split()


class Completion(unittest.TestCase):
    def test_commands_are_those_of_the_help(self):
        text = subprocess.run([PROGRAM, "--help"], capture_output=True, text=True, check=True).stdout
        commands = re.findall(r"^  ([a-z][\w-]*)  ", text.split("Options:")[1], re.MULTILINE)
        self.assertEqual(sorted(offered("")), sorted(commands))
        self.assertEqual(offered("expl"), ["explain"])

    def test_options_and_their_values(self):
        self.assertEqual(offered("run", "--la"), ["--law"])
        self.assertIn("together", offered("run", "--law", ""))
        self.assertEqual(offered("run", "--law", "="), offered("run", "--law", ""))
        self.assertEqual(offered("run", "--law", "=", "pap"), ["paper", "paper_bounds"])
        self.assertEqual(offered("run", "--law=pap"), ["--law=paper", "--law=paper_bounds"])
        self.assertEqual(offered("run", "door", "--sensors", "i"), ["ideal"])
        self.assertEqual(offered("run", "--brak"), [])  # an option of earlier versions

    def test_scenarios_until_one_is_given(self):
        self.assertEqual(offered("run", "d"), ["door"])
        self.assertEqual(offered("run", "--seed", "3", "free"), ["free_space"])
        self.assertEqual(offered("run", "door", "d"), [])
        self.assertEqual(offered("run", "fr3/open_d"), ["fr3/open_drawer"])
        self.assertEqual(offered("run", "--device", "fr"), ["fr3"])
        self.assertEqual(offered("run", "--twin", "fr3/draw"), ["fr3/drawer"])
        self.assertEqual(offered("help", "expl"), ["explain"])

    def test_commands_of_other_programs_are_completed_by_them(self):
        self.assertIn("seeds", offered("experiment", ""))
        self.assertEqual(offered("experiment", "seeds", "--hand"), ["--hands"])
        with tempfile.TemporaryDirectory() as folder:
            alone = install_program(pathlib.Path(folder))
            self.assertEqual(offered("experiment", "", program=alone), [])

    def test_nonsense_offers_nothing(self):
        for words in ([], ["run", "\x01"], ["no_such_command", "x"], ["run", "--no-such"]):
            self.assertEqual(offered(*words), [])

    def test_bash_takes_what_is_offered(self):
        for words in (["run", "--la"], ["run", "--law", ""], ["expl"], ["experiment", "see"], ["run", "$(x"]):
            self.assertEqual(completed_by_bash(*words), offered(*words))


if __name__ == "__main__":
    unittest.main()
