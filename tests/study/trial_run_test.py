"""A trial as a child process, with a program in place of `hapticgiant` that reports what the test says."""

import asyncio
import json
import pathlib
import signal
import sys
import tempfile
import time
import unittest
import unittest.mock

import without_compiled_part  # noqa: F401

from hapticgiant.study import trial_run

PROGRAM = f"""#!{sys.executable}
import json, os, signal, sys, time
assert sys.argv[1:5] == ["run", "--request", "-", "--report-to"], sys.argv
reports = int(sys.argv[5])
request = json.load(sys.stdin)
ended = False
def end(*_):
    global ended
    ended = True
signal.signal(signal.SIGINT, end)
print("http://127.0.0.1:9/#token=00 what is printed is for people")
def say(**report):
    os.write(reports, (json.dumps(report) + "\\n").encode())
def until_ended(most_s=20):
    end_s = time.monotonic() + most_s
    while not ended and time.monotonic() < end_s:
        time.sleep(0.005)
SUMMARY = {{"recording": "", "events": []}}
"""


class Play(unittest.IsolatedAsyncioTestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.seen = []

    def run_of(self, code, expected=(), pause_s=None, request=None):
        program = self.folder / "hapticgiant"
        program.write_text(PROGRAM + code)
        program.chmod(0o755)
        self.run_ = trial_run.TrialRun(str(program), request or {"scenario": "door"}, list(expected), pause_s, self.note)
        return self.run_

    def note(self):
        shown = self.run_.shown
        self.seen.append((shown.mode, shown.is_on_its_way, shown.is_held, shown.wanted, shown.fault, len(shown.events)))

    async def test_the_request_goes_in_and_the_summary_comes_out(self):
        run = self.run_of("say(link='http://127.0.0.1:1/#token=ab')\nsay(summary={**SUMMARY, 'said': request}, exit_code=1)\n"
                          "print('a warning', file=sys.stderr)\nsys.exit(1)", request={"scenario": "door", "set": ["a=1"]})
        code, summary, said = await run.play()
        self.assertEqual((code, said), (1, "a warning"))
        self.assertEqual(summary["said"], {"scenario": "door", "set": ["a=1"]})
        self.assertEqual(run.shown.link, "http://127.0.0.1:1/#token=ab")
        self.assertEqual(run.ended_by, "time")

    async def test_phases_of_the_way_and_of_the_run(self):
        run = self.run_of("""
say(phase='moving', time_s=0, wanted='hold the key')
say(phase='moving', time_s=1, wanted='')
say(event='start', time_s=1.5, text='')
say(status={'time_s': 1.7, 'mode': 'running', 'force_N': 1.5, 'fault': ''})
say(phase='off', time_s=0, wanted='')
say(phase='running', time_s=1, wanted='')
say(status={'time_s': 2.0, 'mode': 'running', 'force_N': None, 'fault': ''})
say(event='start', time_s=2.5, text='')
say(unknown=1)
say(fault='emergency stop', code=101, time_s=3, figures='')
say(phase='fault', time_s=3, wanted='')
say(summary=SUMMARY, exit_code=3)
say(phase='over', time_s=4, wanted='')
sys.exit(3)""", expected=["start"])
        code, summary, _ = await run.play()
        self.assertEqual((code, summary["recording"]), (3, ""))
        self.assertEqual(self.seen, [("off", True, False, "hold the key", "", 0), ("off", True, False, "", "", 0),
                                     ("running", True, False, "", "", 0), ("off", False, False, "", "", 0),
                                     ("running", False, True, "", "", 0), ("running", False, True, "", "", 1),
                                     ("running", False, True, "", "emergency stop", 1),
                                     ("fault", False, False, "", "emergency stop", 1)])
        self.assertEqual((run.shown.events, run.shown.time_s, run.shown.force_N),
                         ([{"time_s": 2.5, "name": "start"}], 2.0, 0.0))

    async def test_it_ends_after_the_last_expected_event(self):
        run = self.run_of("say(phase='running', time_s=0, wanted='')\nsay(event='b', time_s=1, text='')\ntime.sleep(0.3)\n"
                          "assert not ended\nsay(event='c', time_s=1, text='')\nsay(event='a', time_s=2, text='')\n"
                          "until_ended()\nsay(summary=SUMMARY, exit_code=0)", expected=["a", "b"], pause_s=0.1)
        code, summary, _ = await run.play()
        self.assertEqual((code, summary, run.ended_by), (0, {"recording": "", "events": []}, "events"))
        self.assertEqual([each["name"] for each in run.shown.events], ["b", "a"])

    async def test_bad_input_says_why_and_has_no_summary(self):
        run = self.run_of("say(refused='--set twin.mas: no such key')\nsys.exit(2)")
        self.assertEqual(await run.play(), (2, None, "--set twin.mas: no such key"))
        found = trial_run.played_at_once(str(self.folder / "hapticgiant"), {})
        self.assertEqual(found, (2, None, "--set twin.mas: no such key"))

    async def test_a_program_that_reads_and_says_nothing(self):
        run = self.run_of("os.close(0)\nsys.exit(7)", request={"scenario": "x" * 1_000_000})
        self.assertEqual(await run.play(), (7, None, ""))
        self.assertEqual(trial_run.played_at_once(str(self.folder / "hapticgiant"), {}),
                         (7, None, "the run ended with 7 and no summary"))

    async def test_one_that_was_ended_before_it_began(self):
        run = self.run_of("until_ended()\nsay(summary=SUMMARY, exit_code=0)")
        run.end()
        begin = time.monotonic()
        await run.play()
        self.assertLess(time.monotonic() - begin, 15)
        self.assertEqual(run.ended_by, "operator")

    async def test_one_that_does_not_end_is_killed(self):
        run = self.run_of("say(phase='running', time_s=0, wanted='')\nwhile True: time.sleep(1)")
        with unittest.mock.patch.object(trial_run, "PATIENCE_S", 0.3):
            play = asyncio.create_task(run.play())
            while run.shown.mode != "running":
                await asyncio.sleep(0.01)
            self.assertFalse(await run.emergency_stop())  # it has no page
            run.end()
            code, summary, _ = await play
        self.assertEqual((code, summary), (-signal.SIGKILL, None))

    async def test_a_summary_of_a_long_run_is_one_line(self):
        run = self.run_of("say(summary={'events': [{'name': 'x' * 40}] * 20000}, exit_code=0)")
        _, summary, _ = await run.play()
        self.assertEqual(len(summary["events"]), 20000)
        self.assertEqual(trial_run.played_at_once(str(self.folder / "hapticgiant"), {})[1], json.loads(json.dumps(summary)))


if __name__ == "__main__":
    unittest.main()
