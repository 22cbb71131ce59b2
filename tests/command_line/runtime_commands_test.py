"""`hapticgiant doctor`, `explain` and the flight recorder, as their user meets them.

Usage: runtime_commands_test.py PROGRAM   (from the repository root)
"""

import json
import os
import resource
import shutil
import signal
import subprocess
import time
import unittest

from mcap.reader import make_reader
from program import MODELS, PROGRAM, TemporaryFolder, run


class Doctor(TemporaryFolder):
    def test_prints_line_by_line_and_writes_the_same_as_json(self):
        file = self.folder / "doctor.json"
        code, out, err = run("doctor", "--seconds", "0.1", "--json", file)
        reported = json.loads(file.read_text())
        self.assertEqual((code, err), (reported["exit_code"], ""))
        self.assertIn(code, (0, 1))
        items = [line["item"] for line in reported["lines"]]
        for item in ("kernel", "priority", "memory", "processors", "clock", "1 kHz", "10 kHz"):
            self.assertIn(item, items)
            self.assertIn(f" {item} ", out)
        is_bad = any(line["level"] == "bad" for line in reported["lines"])
        self.assertEqual(code, 1 if is_bad else 0)
        for line in reported["lines"]:
            self.assertEqual(bool(line["fix"]), line["level"] != "ok", line)
        self.assertEqual(len(reported["jitter"]), 4)
        for jitter in reported["jitter"]:
            counted = sum(bin["count"] for bin in jitter["late_us"]["histogram"])
            self.assertEqual(counted, round(0.1 * jitter["rate_Hz"]))

    def test_refuses_what_is_out_of_range(self):
        for option in (("--seconds", "0"), ("--priority", "0"), ("--priority", "100")):
            code, out, err = run("doctor", *option)
            self.assertEqual(code, 2, option)
            self.assertIn("must be from", err)


class FlightRecorder(TemporaryFolder):
    def faulty(self, what, scenario="door"):
        """A scenario in which something happens at 3 s."""
        text = (MODELS / "scenarios" / f"{scenario}.yaml").read_text()
        text = text.replace("../", f"{MODELS}/")
        head = text[: text.index("events:")]
        file = self.folder / "faulty.yaml"
        file.write_text(head + what)
        return file

    def play(self, *options, what="faults:\n  - {at_s: 3.0, fault: emergency_stop}\n",
             scenario="door"):
        code, out, err = run("run", self.faulty(what, scenario), "--fast", "--no-viewer", "--recordings",
                             self.folder / "new", *options)
        self.assertEqual(err, "")
        return code, out, sorted(self.folder.glob("new/faulty_*.mcap"))

    def test_a_fault_is_kept_and_explained_although_nothing_is_recorded(self):
        code, out, files = self.play("--no-recording")
        self.assertEqual(code, 3)
        self.assertEqual(len(files), 1)
        self.assertTrue(files[0].name.startswith("faulty_fault102_"))
        self.assertIn(f"explain {files[0]}", out)

        code, out, err = run("explain", files[0])
        self.assertEqual((code, err), (0, ""))
        for part in ("ready -> armed", "armed -> running", "FAULT    102 emergency stop",
                     "meaning", "released by", "reaction", "at rest", "peak force"):
            self.assertIn(part, out)
        self.assertNotIn("CUT OFF", out)
        code, out, _ = run("replay", files[0])
        self.assertEqual(code, 0)
        for option in (("--compare", files[0]), ("--speed", "2")):
            code, _, err = run("replay", files[0], *option)
            self.assertEqual(code, 2)
            self.assertIn("--view", err)

    def test_faults_of_machine_and_computer_replay_bit_for_bit(self):
        _, _, files = self.play("--duration", 10, scenario="free_space", what="faults:\n"
                                "  - {at_s: 0, fault: solver_hurried, magnitude: 1}\n"
                                "  - {at_s: 6.0, fault: cycles_late, magnitude: 1}\n"
                                "  - {at_s: 7.0, for_s: 0.1, fault: gantry_encoder_drift, of: ppu1, "
                                "magnitude: 0.01}\n"
                                "  - {at_s: 9.0, fault: clock_wrong, magnitude: 1.1}\n")
        code, out, _ = run("explain", files[0])
        self.assertIn("cycles that were missed at once", out)
        self.assertIn("injected fault: solver_hurried, the solver is ended before it has finished, "
                      "1 active sets", out)
        self.assertIn("7.000 s  event    injected fault: gantry_encoder_drift", out)
        code, out, err = run("replay", files[0])
        self.assertEqual((code, err), (0, ""), out)
        self.assertRegex(out, r"run again   \d+ cycles, the same bit for bit")

    def test_a_replay_hurries_the_solver_as_the_run_did(self):
        stress = MODELS / "stress"
        text = (stress / "light_fast.yaml").read_text().replace("../", f"{MODELS}/")
        text = text.replace("twins/light", f"{stress}/twins/light").replace(
            "scripts/", f"{stress}/scripts/")
        hashes = []
        for name, faults in (("hurried", "faults:\n  - {at_s: 0, fault: solver_hurried, "
                              "magnitude: 1}\n"), ("whole", "")):
            file = self.folder / f"{name}.yaml"
            file.write_text(text + faults)
            summary = self.folder / f"{name}.json"
            run("run", file, "--fast", "--law", "paper", "--duration", 7, "--no-viewer",
                "--flight-recorder", "off", "--summary", summary, "--recordings",
                self.folder / name)
            shown = json.loads(summary.read_text())
            hashes.append(shown["state_hash"])
            recording, = (f for f in (self.folder / name).glob("*.mcap") if not f.is_symlink())
            code, out, err = run("replay", recording)
            self.assertEqual((code, err), (0, ""), out)
            self.assertRegex(out, r"run again   \d+ cycles, the same bit for bit")
        self.assertNotEqual(hashes[0], hashes[1], "the fault did not change a single solve")

    def test_an_operator_who_lets_go_is_no_fault(self):
        code, out, files = self.play(what="panel:\n  - {at_s: 10.5, operator_enable: false}\n")
        self.assertEqual(code, 0, out)
        self.assertIn("stopped            130 ", out)
        self.assertNotIn("FAULT", out)
        self.assertEqual(len(files), 1)  # the recording: no last seconds of a fault
        code, out, _ = run("explain", files[0])
        self.assertEqual(code, 0)
        self.assertIn("running -> stopping: the operator let go of the enabling switch", out)
        self.assertIn("no fault", out)

    def test_stands_beside_the_recording_or_is_off(self):
        _, _, files = self.play()
        self.assertEqual(len(files), 2)
        for file in files:
            file.unlink()
        _, _, files = self.play("--no-recording", "--flight-recorder", "off")
        self.assertEqual(files, [])

    def test_a_file_that_is_cut_off_is_explained_up_to_there(self):
        _, _, files = self.play("--no-recording")
        whole = files[0].read_bytes()
        part = self.folder / "part.mcap"
        part.write_bytes(whole[: len(whole) // 2])
        code, out, err = run("explain", part)
        self.assertEqual((code, err), (0, ""))
        self.assertIn("CUT OFF", out)
        self.assertIn("armed -> running", out)
        part.write_bytes(b"no recording")
        code, _, err = run("explain", part)
        self.assertEqual(code, 2)
        self.assertIn("must be a recording of this program", err)


class Damaged(TemporaryFolder):
    def setUp(self):
        super().setUp()
        code, out, _ = run("run", "door", "--fast", "--duration", "3", "--recordings", self.folder)
        self.assertEqual(code, 1, out)  # events are missing
        self.file, = (f for f in self.folder.glob("*.mcap") if not f.is_symlink())

    def flipped(self, at, length=1):
        """A copy of the recording with a bit flipped in each of some bytes."""
        whole = bytearray(self.file.read_bytes())
        for place in range(at, at + length):
            whole[place] ^= 4
        file = self.folder / "damaged.mcap"
        file.write_bytes(whole)
        return file

    def chunks(self):
        """(start, samples) of each chunk that has any."""
        with self.file.open("rb") as stream:
            summary = make_reader(stream).get_summary()
        topic, = (c.id for c in summary.channels.values() if c.topic == "/hapticgiant/sample")
        return [(c.chunk_start_offset, c.chunk_length) for c in summary.chunk_indexes
                if topic in c.message_index_offsets]

    def test_a_damaged_chunk_is_left_out_and_named_by_every_reader(self):
        chunks = self.chunks()
        self.assertEqual(len(chunks), 13)  # of 250 samples, 3 s and the cycles of the stop
        for number in (0, 5):
            start, length = chunks[number]
            # A changed bit may make the decompressor copy the same bytes from elsewhere: no damage.
            file = self.flipped(start + length // 2, 32)
            reported = (f"DAMAGED     chunk at byte {start}: 250 samples from {number * 0.25:.3f} to "
                    f"{number * 0.25 + 0.249:.3f} s are lost")
            for command, expected in ((("explain", file), 0), (("compare", self.file, file), 1),
                                      (("replay", file), 1),
                                      (("plot", file, "--out", self.folder / "figures"), 0)):
                code, out, err = run(*command)
                self.assertEqual((code, err), (expected, ""), (command, out))
                self.assertIn(reported, out)
                if command[0] == "replay" and number > 0:
                    self.assertIn("1250 cycles are the same", out)

    def test_a_damaged_description_is_named(self):
        at = self.file.read_bytes().index(b"title: Door")
        file = self.flipped(at)
        code, out, err = run("explain", file)
        self.assertEqual((code, err), (0, ""))
        self.assertRegex(out, r"DAMAGED     attachment \S+door.yaml: no sample is lost")
        self.assertIn("parts are numbered", out)
        for command in (("replay", file), ("compare", file, file), ("plot", file)):
            code, out, err = run(*command)
            self.assertEqual((code, out), (2, ""), command)
            self.assertRegex(err, r"^DAMAGED     attachment \S+door.yaml")


class Contact(TemporaryFolder):
    def test_a_new_contact_of_the_arm_is_reported_once(self):
        models = self.folder / "models"
        shutil.copytree(MODELS, models)
        with open(models / "haptic_giant" / "device.yaml", "a") as device:
            device.write("\ncompliance: {is_on: true}\n")
        walk = models / "scenarios" / "walk.yaml"
        text = walk.read_text().replace("duration_s: 16", "duration_s: 4")
        walk.write_text(text.split("events:")[0] + "faults:\n  - {at_s: 3, for_s: 0.02, "
                        "fault: torque_sensor_offset, of: m2, magnitude: 25}\n")
        code, out, err = run("run", walk, "--fast", "--no-viewer", "--no-recording")
        self.assertEqual((code, err), (0, ""), out)
        reported = [line for line in out.splitlines() if "something touches the arm" in line]
        self.assertEqual(len(reported), 1, out)
        self.assertRegex(reported[0], r"3\.00\d s  contact +something touches the arm beyond joint m2: "
                                  "it gives way")


class Signals(TemporaryFolder):
    def test_signals_of_a_terminal_end_a_run_and_user_signals_do_not(self):
        for number in (signal.SIGQUIT, signal.SIGHUP, signal.SIGTERM):
            folder = self.folder / number.name
            process = subprocess.Popen(
                [PROGRAM, "run", "door", "--user", "none", "--duration", "600", "--no-viewer",
                 "--recordings", folder], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT, text=True)
            self.addCleanup(process.kill)
            process.stdout.readline()
            process.send_signal(signal.SIGUSR1)
            process.send_signal(signal.SIGUSR2)
            time.sleep(0.3)
            self.assertIsNone(process.poll(), number)
            process.send_signal(number)
            out = process.communicate(timeout=60)[0]
            self.assertEqual(process.returncode, 0, out)
            self.assertIn("  state ", out)
            file, = (f for f in folder.glob("*.mcap") if not f.is_symlink())
            self.assertNotIn("partial", file.name)


class Stack(TemporaryFolder):
    def play(self, soft, hard):
        kilobytes = [each if each < 0 else 1024 * each for each in (soft, hard)]
        done = subprocess.run(
            [PROGRAM, "run", "door", "--user", "none", "--duration", "0.3", "--no-recording"],
            stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_STACK, kilobytes))
        return done.returncode, done.stdout, done.stderr

    def test_a_small_limit_is_raised_or_reported(self):
        for soft, hard in ((64, -1), (64, 2048), (2048, 2048), (512, 8192)):
            code, out, err = self.play(soft, hard)
            self.assertEqual((code, err), (0, ""), (soft, hard, out))
        for hard in (64, 1024):
            self.assertEqual(self.play(64, hard),
                             (2, "", f"stack: needs 2048 kB, allowed are {hard} kB; ulimit -s 8192 "
                              "allows more\n"))


class Priority(TemporaryFolder):
    def summary(self, *options):
        file = self.folder / "summary.json"
        code, out, err = run("run", "door", "--duration", "0.3", "--no-viewer", "--no-recording",
                             "--summary", file, *options)
        self.assertEqual(err, "")
        return json.loads(file.read_text()), out

    def test_an_ordinary_thread_is_requested_and_reported(self):
        cpu = min(os.sched_getaffinity(0))
        reported, out = self.summary("--priority", "0", "--cpu", str(cpu))
        self.assertEqual((reported["real_time"], reported["cpu"]), (False, cpu))
        self.assertIn("priority     normal", out)
        self.assertIn("wake-up", out)
        self.assertIn("stages", out)
        bins = reported["wake_up_us"]["histogram"]
        self.assertEqual(sum(bin["count"] for bin in bins), reported["cycles"] - 1)
        self.assertIn("solver", reported["stage_time_us"])


if __name__ == "__main__":
    unittest.main()
