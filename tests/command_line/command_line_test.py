"""The program as its user meets it: exit codes, messages, files.

Usage: command_line_test.py PROGRAM   (from the repository root)
"""

import json
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

from mcap.reader import make_reader

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
MODELS = pathlib.Path("models").resolve()


def run(*arguments, timeout=120):
    """(exit code, standard output, standard error) of the program."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          timeout=timeout, stdin=subprocess.DEVNULL)
    return done.returncode, done.stdout, done.stderr


class TemporaryFolder(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)


class MainJob(TemporaryFolder):
    def test_the_door_ends_with_0_and_a_complete_summary(self):
        summary = self.folder / "summary.json"
        code, out, err = run("run", "door", "--fast", "--recordings", self.folder / "r",
                             "--summary", summary)
        self.assertEqual((code, err), (0, ""), out)
        told = json.loads(summary.read_text())
        for key in ("events", "limits", "sync_error", "force", "solver",
                    "acceleration_change_per_cycle", "cycle_time_us", "allocations_in_loop",
                    "version"):
            self.assertIn(key, told)
        times = [event["time_s"] for event in told["events"]]
        self.assertEqual(times, sorted(times))
        self.assertGreaterEqual(len(times), 6)
        self.assertEqual(set(told["events"][0]), {"name", "time_s", "what"})
        self.assertEqual(told["missing_events"], [])
        self.assertEqual(told["allocations_in_loop"], 0)
        self.assertEqual(set(told["cycle_time_us"]), {"median", "p99_9", "max"})
        self.assertLess(told["sync_error"]["max_m"], 1e-3)
        self.assertIn("worst_violation", told["limits"]["hinge"])
        self.check_recording(pathlib.Path(told["recording"]), told["cycles"])

    def check_recording(self, file, samples):
        with file.open("rb") as stream:
            reader = make_reader(stream)
            counts = reader.get_summary().statistics.channel_message_counts
            topics = {c.topic: counts.get(c.id, 0) for c in reader.get_summary().channels.values()}
            self.assertEqual(topics["/hapticgiant/sample"], samples)
            self.assertGreaterEqual(topics["/hapticgiant/events"], 6)
            attached = [a.name for a in reader.iter_attachments()]
        self.assertTrue(any(name.endswith("device.yaml") for name in attached), attached)

    def test_it_runs_at_other_rates(self):
        for rate in (500, 2000, 5000, 10000):
            summary = self.folder / "s.json"
            code, out, err = run("run", "door", "--fast", "--no-recording", "--rate-hz", rate,
                                 "--summary", summary)
            self.assertEqual((code, err), (0, ""), f"{rate} Hz\n{out}")
            self.assertEqual(json.loads(summary.read_text())["rate_Hz"], rate)

    def test_an_expected_event_that_does_not_happen_is_1(self):
        code, out, _ = run("run", "door", "--fast", "--no-recording", "--duration", "2")
        self.assertEqual(code, 1)
        self.assertIn("missing: ", out)

    def test_another_twin_needs_no_scenario(self):
        code, out, err = run("run", "--twin", MODELS / "twins/excavator/twin.yaml", "--fast",
                             "--duration", "1", "--no-recording")
        self.assertEqual((code, err), (0, ""), out)

    def test_ctrl_c_ends_cleanly_with_a_complete_recording(self):
        process = subprocess.Popen(
            [PROGRAM, "run", "door", "--no-viewer", "--recordings", self.folder,
             "--summary", self.folder / "s.json"], stdout=subprocess.PIPE, text=True)
        time.sleep(2.0)
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=20)
        self.assertEqual(process.returncode, 0, out)
        told = json.loads((self.folder / "s.json").read_text())
        with open(told["recording"], "rb") as stream:
            statistics = make_reader(stream).get_summary().statistics
        self.assertGreater(statistics.message_count, 500)

    def test_real_time_without_terminal_ends_when_the_duration_is_over(self):
        begin = time.monotonic()
        code, out, err = run("run", "door", "--user", "none", "--duration", "1.5",
                             "--recordings", self.folder)
        self.assertEqual((code, err), (0, ""), out)
        self.assertIn("http://127.0.0.1:", out)
        self.assertGreater(time.monotonic() - begin, 1.4)

    def test_help_and_version(self):
        for arguments in (["--help"], ["run", "--help"], ["hqp", "solve", "--help"], ["--version"]):
            code, out, err = run(*arguments)
            self.assertEqual((code, err), (0, ""))
            self.assertTrue(out)


class BadInput(TemporaryFolder):
    """Every case: exit code 2, one clear message on standard error, nothing written."""

    def setUp(self):
        super().setUp()
        shutil.copytree(MODELS, self.folder / "models")
        self.twin = self.folder / "models/twins/door/twin.yaml"
        self.urdf = self.folder / "models/twins/door/door.urdf"
        self.device = self.folder / "models/haptic_giant/device.yaml"

    def refused(self, *words, arguments=None):
        recordings, summary = self.folder / "recordings", self.folder / "summary.json"
        if arguments is None:
            arguments = [self.folder / "models/scenarios/door.yaml"]
        code, out, err = run("run", *arguments, "--fast", "--recordings", recordings, "--summary",
                             summary)
        self.assertEqual(code, 2, f"{out}\n{err}")
        for word in words:
            self.assertIn(str(word), err)
        self.assertFalse(summary.exists())
        self.assertEqual(list(recordings.glob("*")) if recordings.exists() else [], [])
        return err

    def edit(self, file, old, new):
        text = file.read_text()
        self.assertIn(old, text)
        file.write_text(text.replace(old, new, 1))

    def line_of(self, file, text):
        return next(i for i, l in enumerate(file.read_text().splitlines(), 1) if text in l)

    def test_missing_files(self):
        self.refused("dor", "door", arguments=["dor"])
        self.refused("nothing.yaml", arguments=["door", "--twin", "nothing.yaml"])
        self.refused("nothing.yaml", arguments=["door", "--device", "nothing.yaml"])
        self.refused("nothing.yaml", arguments=["door", "--user", "nothing.yaml"])

    def test_missing_urdf(self):
        self.edit(self.twin, "urdf: door.urdf", "urdf: dor.urdf")
        self.refused("twin.yaml:", "dor.urdf")

    def test_broken_yaml(self):
        self.edit(self.twin, "joints:", "joints: [")
        self.refused("twin.yaml:")

    def test_broken_urdf(self):
        self.edit(self.urdf, "</robot>", "")
        self.refused("door.urdf:")

    def test_unknown_key(self):
        self.edit(self.twin, "preload_Nm:", "prelod_Nm:")
        line = self.line_of(self.twin, "prelod_Nm")
        self.refused(f"twin.yaml:{line}:5", "prelod_Nm", "preload_Nm")

    def test_wrong_type(self):
        self.edit(self.twin, "preload_Nm: 3", "preload_Nm: strong")
        self.refused(f"twin.yaml:{self.line_of(self.twin, 'strong')}:", "strong")

    def test_wrong_unit(self):
        self.edit(self.twin, "preload_Nm: 3", "preload_N: 3")
        self.refused(f"twin.yaml:{self.line_of(self.twin, 'preload_N: 3')}:", "preload_Nm")
        self.edit(self.twin, "preload_N: 3", "preload_Nm: 3 Nm")
        self.refused("3 Nm")

    def test_nan_and_infinity(self):
        for value in (".nan", ".inf"):
            self.edit(self.twin, "preload_Nm: 3", f"preload_Nm: {value}")
            self.refused(f"twin.yaml:{self.line_of(self.twin, value)}:")
            self.edit(self.twin, f"preload_Nm: {value}", "preload_Nm: 3")

    def test_zero_and_negative_mass(self):
        for value in ("0", "-7"):
            shutil.copy(MODELS / "twins/door/door.urdf", self.urdf)
            self.edit(self.urdf, '<mass value="7"/>', f'<mass value="{value}"/>')
            self.refused(f"door.urdf:{self.line_of(self.urdf, '<inertial>')}", "mass", value)

    def test_massless_link(self):
        text = self.urdf.read_text()
        begin = text.index("<inertial>")
        end = text.index("</inertial>") + len("</inertial>")
        self.urdf.write_text(text[:begin] + text[end:])
        self.refused("door.urdf:", "leaf")

    def test_reversed_limits(self):
        self.edit(self.urdf, 'lower="0" upper="1.75"', 'lower="1.75" upper="0"')
        self.refused("door.urdf:", "hinge")

    def test_frame_that_does_not_exist(self):
        self.edit(self.twin, "end_effector: handle", "end_effector: handel")
        self.refused("twin.yaml:", "handel", "handle")

    def test_out_of_reach(self):
        self.edit(self.twin, "z_m: -0.80", "z_m: 3.0")
        self.refused("reach", "placement")

    def test_rates(self):
        for rate in ("0", "-1", "1e9", "nan", "fast"):
            code, _, err = run("run", "door", "--fast", "--rate-hz", rate)
            self.assertEqual(code, 2)
            self.assertIn("--rate-hz", err)
        self.edit(self.device, "rate_Hz: 1000", "rate_Hz: 0")
        self.refused("device.yaml:", "rate_Hz")

    def test_folder_of_recordings_that_cannot_be_written(self):
        (self.folder / "file").write_text("")
        code, _, err = run("run", "door", "--fast", "--recordings", self.folder / "file" / "x")
        self.assertEqual(code, 2)
        self.assertIn("file/x", err)

    def test_summary_that_cannot_be_written(self):
        code, _, err = run("run", "door", "--fast", "--no-recording", "--summary",
                           self.folder / "no" / "s.json")
        self.assertEqual(code, 2)
        self.assertIn("s.json", err)

    def test_port_that_is_taken(self):
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            port = taken.getsockname()[1]
            code, _, err = run("run", "door", "--duration", "1", "--port", port, "--recordings",
                               self.folder / "r")
        self.assertEqual(code, 2)
        self.assertIn(str(port), err)
        self.assertEqual(list((self.folder / "r").glob("*")) if (self.folder / "r").exists() else [],
                         [])

    def test_fast_without_an_end(self):
        self.refused("--duration", arguments=["door", "--user", "mouse"])

    def test_unknown_flag_and_subcommand(self):
        for arguments in (["run", "--fst"], ["rum"], []):
            code, _, err = run(*arguments)
            self.assertEqual(code, 2)
            self.assertTrue(err)

    def test_problem_files(self):
        broken = self.folder / "broken.hqp"
        broken.write_text("hqp 2 1\nlevel 1 0\n1 nonsense 3\nend\n")
        code, _, err = run("hqp", "solve", broken)
        self.assertEqual(code, 2)
        self.assertIn("broken.hqp:3", err)
        code, _, err = run("hqp", "solve", self.folder / "none.hqp")
        self.assertEqual(code, 2)
        self.assertIn("none.hqp", err)


if __name__ == "__main__":
    unittest.main(verbosity=1)
