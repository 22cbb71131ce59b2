"""What drawn_commands_test.py says of commands that end uninterrupted, after SIGINT, and not at all.

Usage: drawn_commands_play_test.py   (from anywhere)
"""

import contextlib
import io
import pathlib
import signal
import sys
import tempfile
import unittest
from unittest import mock

import drawn_commands_test as drawn

PLAYED = f"""#!{sys.executable}
import signal, sys
if sys.argv[1] == "end":
    sys.exit(int(sys.argv[2]))
if sys.argv[1] == "commission":
    sys.argv[1:] = ["wait", "1"]
while sys.argv[1] == "ignore":
    signal.sigwait([signal.SIGINT])
signal.sigwait([signal.SIGINT])  # blocked since before it began: none is lost
if sys.argv[1] == "die":
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])
    signal.raise_signal(signal.SIGINT)
sys.exit(int(sys.argv[2]))
"""


class Play(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.program = self.folder / "program"
        self.program.write_text(PLAYED)
        self.program.chmod(0o755)
        before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
        self.addCleanup(signal.pthread_sigmask, signal.SIG_SETMASK, before)

    def play(self, words, exit_code=0, longest_s=0.1, ending_s=60):
        command = drawn.Documented("page.md", f"hapticgiant {words}", exit_code)
        with mock.patch.multiple(drawn, LONGEST_S=longest_s, ENDING_S=ending_s):
            return drawn.play(str(self.program), command, self.folder)

    def test_a_command_that_ends_uninterrupted_has_its_exit_code(self):
        self.assertEqual(self.play("end 0", longest_s=60), "")
        self.assertEqual(self.play("end 2", exit_code=2, longest_s=60), "")
        self.assertIn("exit 2, expected 0\n", self.play("end 2", longest_s=60))
        self.assertIn("exit 130, expected 0\n", self.play("end 130", longest_s=60))

    def test_a_command_that_is_interrupted_ends_well(self):
        for words, exit_code in (("wait 0", 0), ("wait 0", 1), ("wait 1", 1), ("wait 130", 0), ("die 0", 0),
                                 ("commission --simulate", 0)):
            self.assertEqual(self.play(words, exit_code), "", words)
        self.assertIn("exit 1, expected 0 or 130 or -2\n", self.play("wait 1"))
        self.assertIn("exit 5, expected 0 or 3 or 130 or -2\n", self.play("wait 5", exit_code=3))

    def test_a_command_that_ignores_the_interruption_is_wrong(self):
        self.assertIn("still ran 0.5 s after SIGINT", self.play("ignore 0", ending_s=0.5))

    def test_the_same_commands_are_drawn_every_day(self):
        def seed_of(*options):
            shown = io.StringIO()
            with mock.patch.object(sys, "argv", ["test", "program", *options]), contextlib.redirect_stdout(shown), \
                    mock.patch.multiple(drawn, prepare=mock.DEFAULT, play=lambda *_: "",
                                        every_command=lambda _: [drawn.Documented("page.md", "hapticgiant doctor", 0)]):
                self.assertEqual(drawn.main(), 0)
            return int(shown.getvalue().split()[1].rstrip(":"))

        with mock.patch.object(drawn, "datetime") as day:
            day.date.today.return_value.strftime.return_value = "20261130"
            self.assertEqual(seed_of(), drawn.SEED)
            self.assertEqual(seed_of("--seed", "7"), 7)
            self.assertEqual(seed_of("--today"), 20261130)


if __name__ == "__main__":
    unittest.main()
