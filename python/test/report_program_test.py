"""The program that makes the reports, as the commands that have measured become it.

Usage: report_program_test.py   (from anywhere; needs scipy, matplotlib and jinja2, no compiled part)
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(__file__).resolve().parents[1] / "hapticgiant" / "report"
POINTS = {"kind": "capability", "device": "Arm", "box_m": [[-1.0, 1.0]] * 3, "force_N": 50.0,
          "points": [[0.0, 0.0, 1.0, 40.0], [0.1, 0.0, 1.0, 60.0]]}


def report(results, **more):
    return {"results": results, "folder": None, "docs": None, "files": {}, "last_line": "", "kept": "",
            "exit_code": 0} | more


def compared(name, hashes):
    summary = {"scenario": "door", "law": "gauss", "bounds": "recoverable", "duration_s": 1.0, "limits": {},
               "force": {"mean_N": 1.0, "max_N": 2.0, "max_torque_Nm": 1.0}, "sync_error": {"max_m": 0.0},
               "solver": {"active_set_changes_per_second": 1.0},
               "acceleration_change_per_cycle": {"mean": 0.1},
               "cycle_time_us": {"median": 0.0, "p99_9": 0.0, "max": 0.0}}
    facts = {"file": name, "is_complete": True, "losses": "", "rate_Hz": 1000.0, "configuration": {},
             "events": [], "summary": summary}
    return {"facts": facts, "columns": {"cycle": list(range(len(hashes))), "state_hash": hashes}}


class Program(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def make(self, *reports, stdout=subprocess.PIPE, stderr=subprocess.PIPE):
        document = json.dumps({"version": "1.2.3", "reports": reports})
        buffered = {key: value for key, value in os.environ.items() if key != "PYTHONUNBUFFERED"}
        done = subprocess.run([sys.executable, "-B", PROGRAM], input=document, stdout=stdout,
                              stderr=stderr, text=True, check=False, cwd="/", env=buffered)
        return done.returncode, done.stdout, done.stderr

    def compare(self, *hashes, **more):
        runs = [compared(name, values) for name, values in zip(("a", "b"), hashes)]
        return report({"kind": "compare", "runs": runs}, **more)

    def test_files_are_written_where_they_are_wanted_and_nothing_else_is(self):
        map_ = self.folder / "map.svg"
        map_.write_text("old")
        code, out, err = self.make(report(POINTS, files={"map.svg": str(map_)}, last_line="done\n"))
        self.assertEqual((code, out, err), (0, "done\n", ""))
        self.assertTrue(map_.read_text().startswith("<svg"))
        self.assertEqual([file.name for file in self.folder.iterdir()], ["map.svg"])

    def test_the_exit_code_is_the_worst_of_all(self):
        big = 2**64 - 1  # hashes have all bits
        same, changed = self.compare([1, big], [1, big]), self.compare([1, big], [1, big - 1])
        self.assertEqual(self.make(same)[0], 0)
        code, out, _ = self.make(changed, same)
        self.assertEqual(code, 1)
        self.assertIn("different from cycle 1 (0.001 s) on", out)
        self.assertIn("the same in every cycle", out)
        self.assertEqual(self.make(self.compare([1], [1], exit_code=3))[0], 3)

    def test_what_is_wrong_is_an_exit_code_and_comes_after_the_tables(self):
        recorded = {"kind": "identify", "identified": "friction", "file": "a\x1b.mcap", "losses": "", "used_s": 4.0,
                    "joints": []}
        self.assertEqual(self.make(report(recorded), stderr=subprocess.STDOUT), (2, (
            "a\\x1b.mcap: 0 joints, drives on for 4.0 s\nnot usable: no joint moved enough for its friction\n"), None))
        recorded |= {"identified": "inertia", "missing": "link\x1b"}
        self.assertEqual(self.make(report(recorded))[2], "not usable: link\\x1b\n")
        with open(os.devnull) as unwritable:
            self.assertEqual(self.make(report(recorded), stderr=unwritable)[0], 2)

    def test_a_terminal_obeys_no_text_of_a_recording(self):
        name = "a\x1b[2J\u202e"
        runs = [compared(name, [1]), compared("b", [1])]
        _, out, _ = self.make(report({"kind": "compare", "runs": runs}))
        self.assertIn(r"first          a\x1b[2J\xe2\x80\xae: door", out)

    def test_what_cannot_be_written_is_named_and_what_is_kept(self):
        place = self.folder / "missing" / "map.svg"
        code, _, err = self.make(report(POINTS, files={"map.svg": str(place)}, kept="x has the results\n"))
        self.assertEqual(code, 4)
        self.assertEqual(err, f"{place}.partial: No such file or directory\nx has the results\n")

    def test_output_that_cannot_be_printed_is_an_exit_code(self):
        with open("/dev/full", "w") as full:
            code, _, err = self.make(self.compare([1], [1]), stdout=full)
        self.assertEqual((code, err), (4, "standard output could not be written: No space left on device\n"))


if __name__ == "__main__":
    unittest.main()
