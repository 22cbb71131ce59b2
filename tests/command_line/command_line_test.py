"""The program as its user meets it: exit codes, messages, files.

Usage: command_line_test.py PROGRAM   (from the repository root)
"""

import contextlib
import fcntl
import json
import os
import pathlib
import pty
import re
import shutil
import signal
import socket
import struct
import subprocess
import termios
import threading
import time
import unittest

from mcap.reader import make_reader
from program import MODELS, PROGRAM, TemporaryFolder, install, run


def drain(terminal):
    """Reads what a terminal shows until it closes."""
    shown = b""
    with contextlib.suppress(OSError):  # how a terminal ends
        while part := os.read(terminal, 4096):
            shown += part
    os.close(terminal)
    return shown


def wait_until_tared(process):
    """What a run has said until half a second of it has been simulated."""
    head = ""
    while "tare " not in head:
        line = process.stdout.readline()
        assert line, head
        head += line
    return head


class MainJob(TemporaryFolder):
    def test_the_door_ends_with_0_and_a_complete_summary(self):
        summary = self.folder / "summary.json"
        code, out, err = run("run", "door", "--fast", "--recordings", self.folder / "r",
                             "--summary", summary)
        self.assertEqual((code, err), (0, ""), out)
        reported = json.loads(summary.read_text())
        for key in ("events", "limits", "sync_error", "force", "solver",
                    "acceleration_change_per_cycle", "cycle_time_us", "allocations_in_loop",
                    "version"):
            self.assertIn(key, reported)
        times = [event["time_s"] for event in reported["events"]]
        self.assertEqual(times, sorted(times))
        self.assertGreaterEqual(len(times), 6)
        self.assertEqual(set(reported["events"][0]), {"name", "time_s", "what"})
        self.assertEqual(reported["missing_events"], [])
        self.assertEqual(reported["allocations_in_loop"], 0)
        self.assertEqual(set(reported["cycle_time_us"]), {"median", "p99_9", "max", "histogram"})
        self.assertLess(reported["sync_error"]["max_m"], 1e-3)
        self.assertIn("worst_violation", reported["limits"]["hinge"])
        self.check_recording(pathlib.Path(reported["recording"]), reported["cycles"])

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
                                 "--plant", "ideal" if rate < 1000 else "elastic", "--summary",
                                 summary)
            self.assertEqual((code, err), (0, ""), f"{rate} Hz\n{out}")
            self.assertEqual(json.loads(summary.read_text())["rate_Hz"], rate)

    def test_shipped_arms_have_names(self):
        code, out, err = run("run", "--device", "fr3", "--twin", "fr3/drawer", "--user", "none", "--fast",
                             "--no-viewer", "--no-recording", "--duration", "0.1")
        self.assertEqual((code, err), (0, ""), out)
        for arguments, words in (
                (("--device", "fr4"), "fr4: no such device file, did you mean 'fr3'?"),
                (("--twin", "fr3/drawr"), "did you mean 'fr3/drawer'? Of fr3 there are cam_press, cupboard"),
                (("fr3/opendrawer",), "did you mean 'fr3/open_drawer'?")):
            code, _, err = run("run", *arguments, "--fast", "--no-viewer")
            self.assertEqual(code, 2)
            self.assertIn(words, err)

    def test_a_preset_sets_four_parts_of_the_law(self):
        summary = self.folder / "summary.json"
        for options, parts in ((("--law", "paper_bounds"), ("paper", "paper", "rule", "alone")),
                               (("--law", "together", "--set", "device.rendering.gantry=law"),
                                ("gauss", "recoverable", "law", "together"))):
            code, out, err = run("run", "door", "--user", "none", "--fast", "--no-recording", "--duration",
                                 "0.1", "--summary", summary, *options)
            self.assertEqual((code, err), (0, ""), out)
            facts = json.loads(summary.read_text())
            self.assertEqual(tuple(facts[key] for key in ("law", "bounds", "gantry", "braking")), parts)

    def test_options_for_single_parts_of_the_law_name_the_preset(self):
        for option, instead in (("--bounds", "--law paper_bounds"), ("--gantry", "--law gantry"),
                                ("--braking", "--law gauss"),
                                ("--passivity", "--set device.passivity.reaction=act")):
            code, _, err = run("run", "door", option, "law")
            self.assertEqual(code, 2)
            self.assertIn(f"{option}: is no option any more: use {instead}", err)

    def test_other_simulated_machines_lie_beside_the_shipped_one(self):
        peaks = {}
        for machine in (None, "as_published", "harder"):
            summary = self.folder / "summary.json"
            choice = ("--simulation", machine) if machine else ()
            code, out, err = run("run", "walk", "--fast", "--no-recording", "--summary", summary,
                                 *choice)
            # both shake the hand with a tenth of gravity, and the watch says so
            self.assertEqual((code, err), (1 if machine else 0, ""), out)
            self.assertEqual("SHAKING" in out, machine is not None, out)
            self.assertIn("3 of 3 in order", out)
            peaks[machine] = json.loads(summary.read_text())["force"]["max_N"]
        self.assertEqual(len(set(peaks.values())), 3, peaks)
        code, _, err = run("run", "walk", "--fast", "--no-recording", "--simulation", "harde")
        self.assertEqual(code, 2)
        self.assertIn("did you mean 'harder'", err)

    def test_an_expected_event_that_does_not_happen_is_1(self):
        code, out, _ = run("run", "door", "--fast", "--no-recording", "--duration", "2")
        self.assertEqual(code, 1)
        self.assertIn("missing: ", out)

    def test_another_twin_needs_no_scenario_and_gives_the_run_its_name(self):
        code, out, err = run("run", "--twin", MODELS / "twins/excavator/twin.yaml", "--fast",
                             "--duration", "1", "--recordings", self.folder)
        self.assertEqual((code, err), (0, ""), out)
        file, = (file for file in self.folder.glob("*.mcap") if not file.is_symlink())
        self.assertTrue(file.name.startswith("excavator_2"), file)
        self.assertRegex(out, r"events +\d+ seen, none was expected")

    def test_ctrl_c_ends_cleanly_with_a_complete_recording(self):
        process = subprocess.Popen(
            [PROGRAM, "run", "door", "--no-viewer", "--recordings", self.folder,
             "--summary", self.folder / "s.json"], stdout=subprocess.PIPE, text=True)
        head = wait_until_tared(process)
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0, head + out)
        reported = json.loads((self.folder / "s.json").read_text())
        with open(reported["recording"], "rb") as stream:
            statistics = make_reader(stream).get_summary().statistics
        self.assertGreater(statistics.message_count, 100)

    def test_a_recording_is_completed_when_terminal_or_pipe_close(self):
        for closes, number in (("terminal", signal.SIGHUP), ("pipe", None)):
            folder = self.folder / closes
            process = subprocess.Popen(
                [PROGRAM, "run", "door", "--no-viewer", "--duration", "3", "--recordings", folder],
                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            wait_until_tared(process)
            if number is None:
                process.stdout.close()
            else:
                process.send_signal(number)
            process.stderr.read()
            self.assertIn(process.wait(timeout=60), (0, 1), closes)  # 1: events are missing
            process.stderr.close()
            process.stdout.close()
            file, = (f for f in folder.glob("*.mcap") if not f.is_symlink())
            self.assertNotIn("partial", file.name)
            with file.open("rb") as stream:
                self.assertGreater(make_reader(stream).get_summary().statistics.message_count, 100)

    def test_a_terminal_that_stands_still_holds_nothing_up(self):
        for number in (signal.SIGTERM, signal.SIGINT):
            primary, secondary = pty.openpty()
            self.addCleanup(os.close, primary)
            self.addCleanup(os.close, secondary)
            summary = self.folder / "summary.json"
            process = subprocess.Popen(
                [PROGRAM, "run", "door", "--no-viewer", "--duration", "600", "--recordings",
                 self.folder / "recordings", "--summary", summary], stdout=secondary)
            self.addCleanup(process.kill)
            shown = b""
            while b"  tare  " not in shown:
                shown += os.read(primary, 4096)
            termios.tcflow(secondary, termios.TCOOFF)  # as Ctrl-S
            time.sleep(1.0)
            process.send_signal(number)
            self.assertEqual(process.wait(timeout=30), 4)  # the summary was not read
            reported = json.loads(summary.read_text())
            self.assertEqual(reported["dropped_samples"], 0)
            self.assertLess(reported["duration_s"], 60.0)

    def stopped_terminal(self):
        primary, secondary = pty.openpty()
        self.addCleanup(os.close, primary)
        self.addCleanup(os.close, secondary)
        termios.tcflow(secondary, termios.TCOOFF)  # as Ctrl-S
        return secondary

    def test_a_stopped_terminal_does_not_delay_a_simulated_device(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
            free.bind(("127.0.0.1", 0))
            address = "127.0.0.1:%d" % free.getsockname()[1]
        process = subprocess.Popen([PROGRAM, "simulate", "door", "--fast", "--listen", address],
                                   stdout=self.stopped_terminal())
        self.addCleanup(process.kill)
        for _ in range(2):  # the first one ends with lines that are not read
            code, out, err = run("run", "door", "--fast", "--duration", "1", "--no-recording",
                                 "--device-address", address)
            self.assertEqual((code, err), (1, ""), out)  # events are missing
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=30), 4)  # its output was not read

    def test_a_stopped_terminal_does_not_delay_a_replay_page(self):
        code, out, _ = run("run", "door", "--fast", "--duration", "1", "--recordings", self.folder)
        self.assertEqual(code, 1, out)
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        process = subprocess.Popen(
            [PROGRAM, "replay", self.folder / "latest.mcap", "--view", "--no-browser", "--port",
             str(port)], stdout=self.stopped_terminal())
        self.addCleanup(process.kill)
        for _ in range(600):
            with socket.socket() as page:
                if page.connect_ex(("127.0.0.1", port)) == 0:
                    break
            self.assertIsNone(process.poll())
            time.sleep(0.1)
        else:
            self.fail("no page")
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=30), 4)  # its output was not read

    def test_the_status_line_is_cut_to_the_terminal(self):
        primary, secondary = pty.openpty()
        fcntl.ioctl(secondary, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 40, 0, 0))
        process = subprocess.Popen([PROGRAM, "run", "door", "--no-viewer", "--no-recording",
                                    "--duration", "1"], stdout=secondary)
        os.close(secondary)
        shown = drain(primary)
        process.wait(timeout=20)
        lines = re.findall(rb"\r\x1b\[K([^\r\n\x1b]+)", shown)
        self.assertTrue(lines)
        self.assertEqual(max(map(len, lines)), 39)

    def test_a_terminal_without_page_ends_after_the_script(self):
        shutil.copytree(MODELS, self.folder / "models")
        program = install(self.folder / "prefix")
        shutil.rmtree(self.folder / "prefix/share/hapticgiant/viewer")
        scenario = self.folder / "models/scenarios/door.yaml"
        scenario.write_text(scenario.read_text().replace("duration_s: 14", "duration_s: 0.5"))
        script = self.folder / "models/scripts/door.yaml"
        script.write_text(re.sub(r"(?m)^duration_s: .*", "duration_s: 1", script.read_text()))
        primary, secondary = pty.openpty()
        process = subprocess.Popen([program, "run", "door", "--no-recording"], stdout=secondary,
                                   cwd=self.folder)
        os.close(secondary)
        self.addCleanup(os.close, primary)
        self.addCleanup(process.kill)
        threading.Thread(target=drain, args=[os.dup(primary)], daemon=True).start()
        self.assertEqual(process.wait(timeout=30), 1)  # events are missing

    def test_a_page_needs_no_box_around_the_handle(self):
        shutil.copytree(MODELS, self.folder / "models")
        device = self.folder / "models/haptic_giant/device.yaml"
        text = device.read_text()
        for without in (text.replace("x: {q_min_m: -1.65,", "x: {q_min_m: -.inf,"),
                        re.sub(r"cartesian_limits:\n(  .*\n)*", "", text)):
            self.assertNotEqual(without, text)
            device.write_text(without)
            code, out, err = run("run", "door", "--device", device, "--user", "none", "--duration",
                                 "0.2", "--no-recording")
            self.assertEqual((code, err), (0, ""), out)
            self.assertIn("http://127.0.0.1:", out)

    def test_the_summary_may_go_to_standard_output_and_to_nowhere(self):
        short = ("run", "door", "--user", "none", "--fast", "--duration", "0.5", "--no-recording")
        code, out, err = run(*short, "--summary", "/dev/stdout")
        self.assertEqual((code, err), (0, ""), out)
        reported = json.loads(out[out.index("{"):out.rindex("}") + 1])
        self.assertTrue(reported["fast"])
        self.assertEqual(reported["dropped_samples"], 0)
        self.assertEqual(run(*short, "--summary", "/dev/null")[0], 0)

    def test_a_recording_holds_what_the_command_line_changed(self):
        shutil.copytree(MODELS, self.folder / "models")
        scenario = self.folder / "models/scenarios/my door.yaml"
        shutil.copy(MODELS / "scenarios/door.yaml", scenario)
        recordings = self.folder / "recordings"
        code, out, err = run("run", scenario, "--user", "none", "--rate-hz", "2000", "--fast",
                             "--duration", "0.5", "--recordings", recordings)
        self.assertEqual((code, err), (0, ""), out)
        file, = recordings.glob("my_door_*.mcap")
        with file.open("rb") as stream:
            reported = {a.name: a.data.decode() for a in make_reader(stream).iter_attachments()}
        self.assertEqual(reported["arguments"], "--user none\n--rate-hz 2000\n")

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


class Drafts(TemporaryFolder):
    def setUp(self):
        super().setUp()
        for name in ("arm.urdf", "gate.urdf"):
            shutil.copy(MODELS / "examples" / name, self.folder)
        self.device, self.twin = self.folder / "device.yaml", self.folder / "twin.yaml"

    def test_a_drafted_device_holds_a_drafted_twin(self):
        code, out, _ = run("new", "device", self.folder / "arm.urdf", "-o", self.device)
        self.assertEqual(code, 0)
        self.assertIn("hapticgiant check", out)
        self.assertEqual(run("new", "twin", self.folder / "gate.urdf", "-o", self.twin,
                             "--device", self.device)[0], 0)
        code, out, err = run("run", "--device", self.device, "--twin", self.twin, "--user", "none",
                             "--fast", "--duration", "1", "--no-recording")
        self.assertEqual(code, 0, out + err)

    def test_a_file_that_exists_is_overwritten_only_on_request(self):
        self.device.write_text("mine")
        code, _, err = run("new", "device", self.folder / "arm.urdf", "-o", self.device)
        self.assertEqual(code, 2)
        self.assertIn("--force", err)
        self.assertEqual(self.device.read_text(), "mine")
        self.assertEqual(run("new", "device", self.folder / "arm.urdf", "-o", self.device,
                             "--force")[0], 0)
        self.assertIn("manipulator:", self.device.read_text())

    def test_a_urdf_that_cannot_be_a_device_leaves_no_file(self):
        code, _, err = run("new", "device", self.folder / "gate.urdf", "-o", self.device)
        self.assertEqual(code, 2)
        self.assertIn("six or seven manipulator joints", err)
        self.assertFalse(self.device.exists())


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
        self.refused("'none'", "Shipped are cam_press, chain, door", arguments=["door", "--user", "nome"])
        self.refused("'friction'", arguments=["door", "--user", "frictoin"])

    def test_names_that_are_too_long(self):
        name = 300 * "x"
        self.refused(arguments=[name])
        for option in ("--twin", "--device", "--user", "--summary"):
            code, _, err = run("run", "door", "--fast", "--no-recording", option, name)
            self.assertEqual(code, 2, f"{option} {err}")

    def test_start_outside_the_box_of_the_handle(self):
        text = self.device.read_text()
        self.device.write_text(re.sub(r"(- name: hand\n.*\n *x: ).*", r"\1{q_min_m: 1.60, q_max_m: 1.65}",
                                      text))
        self.refused("hand x", "placement")

    def test_a_twin_that_names_a_joint_as_the_device_does(self):
        for file in (self.twin, self.urdf):
            file.write_text(re.sub(r"\bhinge\b", "m4", file.read_text()))
        self.refused("twice", "'m4'", arguments=["excavator", "--twin", self.twin])

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
        (self.folder / "taken.json.partial").mkdir()
        for place in ("no/s.json", "models", "taken.json"):
            code, _, err = run("run", "door", "--fast", "--no-recording", "--summary",
                               self.folder / place)
            self.assertEqual(code, 2)
            self.assertIn(place, err)

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
        for arguments, message in ((["run", "--fst"], "--fst"),
                                   (["rum"], "rum: no such subcommand of hapticgiant, did you mean "
                                             "'run'?"),
                                   (["hqp", "slove", "x"], "did you mean 'solve'?"),
                                   (["experiment"], "experiment: expected a subcommand: cartesian"),
                                   (["experiment", "stability"], "did you mean 'stability-map'?"),
                                   (["experiment", "free-space", "--svg", "x"], "--svg"),
                                   (["experiment", "impedance", "--json", "/no/such/x"],
                                    "/no/such"),
                                   (["new"], "new: expected a subcommand: device, twin"),
                                   (["bridge"], "bridge: expected a subcommand: ros2")):
            code, _, err = run(*arguments)
            self.assertEqual(code, 2)
            self.assertIn(message, err)

    def test_numbers_out_of_range(self):
        for option, value, message in (("--slow-solve", 0, "must be at least 1, got 0"),
                                       ("--duration", 0, "must be more than 0, got 0"),
                                       ("--duration", "nan", "expected a number, got 'nan'"),
                                       ("--rate-hz", 99, "must be from 100 to 20000, got 99")):
            code, _, err = run("run", "door", option, value)
            self.assertEqual(code, 2)
            self.assertIn(f"{option}: {message}\n", err)


if __name__ == "__main__":
    unittest.main(verbosity=1)
