"""What a page does to a run, and a recording in the page, without a browser.

Usage: page_test.py PROGRAM
"""

import contextlib
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

from program import MODELS, PROGRAM, TemporaryFolder, install, run
from web_socket import Live, Page


def drain(terminal):
    with contextlib.suppress(OSError):  # at its end
        while os.read(terminal, 4096):
            pass


class PageTest(TemporaryFolder):
    def setUp(self):
        super().setUp()
        shutil.copytree(MODELS, self.folder / "models")
        self.installed = install(self.folder / "prefix")

    @contextlib.contextmanager
    def program(self, *arguments):
        """The running program and its link."""
        process = subprocess.Popen([self.installed, *map(str, arguments)], cwd=self.folder,
                                   text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE)
        try:
            while not (link := re.search(r"http://\S+", process.stdout.readline())):
                self.assertIsNone(process.poll())
            yield process, link[0]
        finally:
            process.kill()
            process.communicate()

    @contextlib.contextmanager
    def run_of(self, *arguments):
        with self.program("run", *arguments, "--duration", "600") as (process, link):
            page = Page(link)
            self.addCleanup(page.close)
            page.next("frame", lambda frame: frame["mode"] == "running")
            yield process, page

    def end(self, process):
        """Everything the program prints to its end."""
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0, out)
        return out

    def recordings(self):
        return sorted(path for path in (self.folder / "recordings").glob("*.mcap")
                      if not path.is_symlink())

    def samples(self, path, topic="/hapticgiant/sample"):
        from mcap_ros2.reader import read_ros2_messages
        return [message.ros_msg for message in read_ros2_messages(path, topics=[topic])]

    def accept(self, page, *command):
        answer = page.command(*command)
        self.assertTrue(answer["is_accepted"], answer)

    def refuse(self, page, *command):
        answer = page.command(*command)
        self.assertFalse(answer["is_accepted"], command)
        self.assertNotEqual(answer["reason"], "")
        return answer["reason"]

    def resting_time(self, page):
        """Of a paused run whose last cycle, started before the pause, has been seen."""
        times, speed = [], 0.5
        while len(times) < 5 or len(set(times[-5:])) > 1:
            speed = 1.25 - speed  # a change is reported with the newest cycle
            self.accept(page, "speed", "", speed)
            frame = page.next("frame", lambda frame: frame["run_state"]["speed"] == speed)
            self.assertTrue(frame["run_state"]["is_paused"])
            times.append(frame["time_s"])
        return times[-1]

    def test_pause_stops_simulated_time_and_a_step_is_one_cycle(self):
        with self.run_of("door", "--user", "mouse", "--no-recording") as (process, page):
            self.accept(page, "pause")
            self.accept(page, "step", "", 1)
            before = self.resting_time(page)
            self.accept(page, "step", "", 7)
            after = page.next("frame", lambda frame: frame["time_s"] >= before + 0.00699)
            self.assertAlmostEqual(after["time_s"], before + 0.007, places=5)
            self.refuse(page, "step", "", 0.5)
            self.refuse(page, "speed", "", 0.01)
            self.accept(page, "speed", "", 0.5)
            self.accept(page, "resume")
            page.next("frame", lambda frame: frame["run_state"]["speed"] == 0.5 and
                      not frame["run_state"]["is_paused"] and frame["time_s"] > after["time_s"])
            self.refuse(page, "seek", "", 1)
            self.end(process)

    def test_a_value_that_is_set_is_felt_and_in_the_recording(self):
        name = "hinge.damping_Nms_per_rad"
        with self.run_of("door", "--user", "none") as (process, page):
            settings = page.scene()["settings"]
            index = [setting["name"] for setting in settings].index(name)
            self.accept(page, "set", name, 3.25)
            values = page.next("values", lambda values: values["values"][index] == 3.25)
            self.assertEqual(len(values["values"]), len(settings))
            self.assertIn("must be", self.refuse(page, "set", name, -1))
            self.assertIn("no such setting", self.refuse(page, "set", "hinge.colour", 1))
            self.assertIn("cross", self.refuse(page, "set", "hinge.q_max_rad", -2))
            page.send("not JSON")
            self.assertEqual(page.next("answer")["id"], -1)
            page.next("event", lambda event: event["name"] == "set")
            self.end(process)
        [recording] = self.recordings()
        changes = [sample.operator_input.change for sample in self.samples(recording)
                   if sample.operator_input.change.parameter != 0]
        self.assertEqual([(change.parameter, change.index, change.value) for change in changes],
                         [(4, 0, 3.25)])
        events = {event.name: event.text for event in
                  self.samples(recording, "/hapticgiant/events")}
        self.assertEqual(events["set"], f"{name} = 3.25 Nms/rad")

    def test_places_that_events_ask_for_are_in_the_scene(self):
        with self.run_of("path", "--set", "scenario.person=mouse") as (_, page):
            places = page.scene()["checkpoints"]
            self.assertEqual([place["name"] for place in places], [f"checkpoint {i}" for i in range(1, 7)])
            self.assertEqual(places[1], {"name": "checkpoint 2", "x_m": 1.2, "y_m": -1.5, "azimuth_rad": 0})

    def test_another_scenario_begins_and_the_page_stays(self):
        with self.run_of("door", "--user", "mouse") as (process, page):
            self.assertEqual(page.scene()["environment"], "door")
            self.assertIn("no such choice", self.refuse(page, "scenario", "/etc/passwd"))
            self.refuse(page, "twin", "../../secret.yaml")
            self.accept(page, "scenario", "excavator")
            page.next("frame", lambda frame: frame["run"] == 2 and frame["mode"] == "running")
            scene = page.scene()
            self.assertEqual((scene["run"], scene["environment"]), (2, "excavator"))
            self.assertEqual(scene["choices"]["scenario"], "excavator")
            self.accept(page, "law", "paper")
            page.next("frame", lambda frame: frame["run"] == 3)
            self.assertEqual(page.scene()["choices"]["law"], "paper")
            self.accept(page, "restart")
            page.next("frame", lambda frame: frame["run"] == 4 and frame["time_s"] < 5)
            self.end(process)
        self.assertEqual(len(self.recordings()), 4)

    def test_another_device_begins_and_one_that_does_not_fit_changes_nothing(self):
        own = (self.folder / "models/arms/fr3/device.yaml").read_text().replace("name: Franka FR3", "name: My arm")
        for key, folder in (("urdf", "models/arms/fr3"), ("tool", "models/arms"), ("simulation", "models/arms/fr3")):
            own = re.sub(rf"^{key}: (\.\./)?", f"{key}: {folder}/", own, flags=re.MULTILINE)
        (self.folder / "my_device.yaml").write_text(own)
        with self.run_of("fr3/open_drawer", "--user", "mouse", "--no-recording") as (process, page):
            choices = page.scene()["choices"]
            self.assertEqual((choices["device"], choices["devices"][0]["name"]), ("", ""))
            self.assertIn({"name": "ur10e", "title": "Universal Robots UR10e", "group": ""}, choices["devices"])
            self.assertIn({"name": "fr3/tool", "title": "Tool", "group": "Franka FR3"}, choices["twins"])
            self.assertIn("no such choice", self.refuse(page, "device", "../device.yaml"))
            self.assertEqual(self.refuse(page, "device", "haptic_giant"),
                             "the HapticGiant cannot hold the handle of the drawer where it starts (height out of reach)")
            time_s = page.next("frame")["time_s"]
            page.next("frame", lambda frame: frame["run"] == 1 and frame["mode"] == "running" and
                      frame["time_s"] > time_s + 0.2)
            for run, (name, title) in enumerate((("ur10e", "Universal Robots UR10e"), ("my_device.yaml", "My arm")), 2):
                self.accept(page, "device", name)
                page.next("frame", lambda frame, run=run: frame["run"] == run and frame["mode"] == "running")
                scene = page.scene()
                self.assertEqual((scene["title"], scene["device"]["name"], scene["choices"]["device"]),
                                 ("Drawer", title, name))
            self.accept(page, "scenario", "free_space")
            page.next("frame", lambda frame: frame["run"] == 4)
            self.assertEqual(page.scene()["device"]["name"], "HapticGiant")
            self.end(process)

    def test_surfaces_are_chosen_and_left_out(self):
        with self.run_of("free_space", "--user", "mouse") as (process, page):
            sets = [choice["name"] for choice in page.scene()["choices"]["surface_sets"]]
            self.assertEqual(sets, ["", "none", "surfaces"])
            self.accept(page, "surfaces", "surfaces")
            page.next("frame", lambda frame: frame["run"] == 2 and frame["mode"] == "running")
            scene = page.scene()
            self.assertEqual((len(scene["surfaces"]), scene["choices"]["surfaces"]), (6, "surfaces"))
            self.accept(page, "surfaces", "none")
            page.next("frame", lambda frame: frame["run"] == 3)
            self.assertEqual(page.scene()["surfaces"], [])
            self.end(process)
        for recording in self.recordings():
            code, out, err = run("replay", recording)
            self.assertEqual(code, 0, out + err)

    def test_after_a_stop_the_run_can_begin_again(self):
        with self.run_of("door", "--user", "mouse", "--no-recording") as (process, page):
            self.accept(page, "stop")
            page.next("frame", lambda frame: frame["run_state"]["is_over"])
            self.assertIn("over", self.refuse(page, "pause"))
            self.accept(page, "restart")
            page.next("frame", lambda frame: frame["run"] == 2 and frame["mode"] == "running")
            self.end(process)

    def test_a_mode_is_accepted_only_when_the_cycle_has_followed_it(self):
        with self.run_of("door", "--user", "mouse", "--no-recording") as (process, page):
            self.assertIn("no fault", self.refuse(page, "mode", "reset"))
            self.assertIn("not ready", self.refuse(page, "mode", "arm"))  # it runs
            self.accept(page, "mode", "hold")
            page.next("frame", lambda frame: frame["mode"] == "armed")
            self.assertIn("override", self.refuse(page, "mode", "run_alone"))
            self.accept(page, "mode", "run")
            page.next("frame", lambda frame: frame["mode"] == "running")
            self.assertIn("no such mode", self.refuse(page, "mode", "fly"))
            self.accept(page, "pause")
            page.send({"type": "command", "id": 77, "command": "mode", "name": "hold", "value": 0})
            self.accept(page, "resume")
            self.assertTrue(page.next("answer", lambda answer: answer["id"] == 77)["is_accepted"])
            self.end(process)

    def test_the_parts_of_the_force_add_up_and_frames_are_small(self):
        with self.run_of("door", "--no-recording") as (process, page):
            def is_pushed(frame):
                return sum(x * x for x in frame["force_N"]) > 25 and frame["mode"] == "running"
            frame = page.next("frame", is_pushed)
            budget = dict(frame["budget"])
            user, rest = budget.pop("user"), budget.pop("rest")
            for kind in ("force_N", "torque_Nm"):
                for axis in range(3):
                    parts = sum(part[kind][axis] for part in budget.values())
                    self.assertAlmostEqual(user[kind][axis], parts + rest[kind][axis], delta=1e-3)
                    self.assertLess(abs(rest[kind][axis]), 1e-3)
            self.assertLess(len(json.dumps(frame, separators=(",", ":"))), 4096)
            self.assertGreater(frame["singularity"]["measure"], 0)
            self.assertEqual(len(frame["limit_position"]), len(page.scene()["limits"]))
            self.end(process)

    def test_a_remote_device_keeps_its_own_time(self):
        server = subprocess.Popen([PROGRAM, "simulate", "door", "--user", "mouse", "--listen",
                                   "127.0.0.1:0"], stdout=subprocess.PIPE, text=True)
        self.addCleanup(server.communicate)
        self.addCleanup(server.kill)
        while not (address := re.search(r"127\.0\.0\.1:\d+", server.stdout.readline())):
            self.assertIsNone(server.poll())
        # at a terminal the page stays also when a busy machine loses the session
        process, link = self.at_terminal("--device-address", address[0])
        page = Page(link)
        self.addCleanup(page.close)
        for command in ("pause", "restart"):
            self.assertIn("keeps its own time", self.refuse(page, command))
        self.assertEqual(set(page.scene()["commands"]),
                         {"stop", "set", "mode", "mark", "emergency_stop", "release_stop"})
        self.assertIn("keeps its own time", self.refuse(page, "panel", "override_key", 1))
        self.accept(page, "emergency_stop")
        page.next("frame", lambda frame: frame["mode"] == "fault")
        process.send_signal(signal.SIGINT)
        process.wait(timeout=30)

    def trial(self, *options):
        """A run of a study, and its page once the device moves."""
        self.summary = self.folder / "trial.json"
        return self.run_of("door", "--user", "mouse", "--embedded-in", "http://127.0.0.1:8123",
                           "--embedded-in", "http://[::1]:8123", "--summary", self.summary, *options)

    def test_a_trial_is_changed_by_no_page(self):
        with self.trial() as (process, page):
            scene = page.scene()
            self.assertEqual(scene["refusal"], "this run is a trial of a study")
            self.assertEqual(set(scene["commands"]), {"stop", "mode", "mark", "emergency_stop",
                                                      "release_stop", "panel"})
            setting = scene["settings"][0]
            for command in (("pause",), ("resume",), ("step", "", 1), ("speed", "", 0.5),
                            ("restart",), ("scenario", "path"), ("twin", "light"),
                            ("device", "fr3"), ("surfaces", "none"), ("law", "paper"), ("person", "none"),
                            ("set", setting["name"], setting["value"])):
                self.assertEqual(self.refuse(page, *command), scene["refusal"], command)
            self.accept(page, "mark", "the lamp")
            self.accept(page, "panel", "person_in_field", 1)
            self.accept(page, "mode", "hold")
            page.next("frame", lambda frame: frame["mode"] == "armed")
            answer = page.answer_to("/")
            self.assertIn("frame-ancestors http://127.0.0.1:8123 http://[::1]:8123\r\n", answer)
            self.assertNotIn("X-Frame-Options", answer)
            self.assertTrue(self.summary_of_end(process)["interrupted"])

    def test_a_reference_wrench_is_refused_in_a_trial(self):
        with self.trial("--no-recording") as (process, page):
            live = Live(page)
            self.addCleanup(live.close)
            live.send({"op": "advertise", "channels": [
                {"id": 7, "topic": "/reference_wrench", "encoding": "cdr"}]})
            wrench = struct.pack("<BI4s8xI5s7x6d", 1, 7, b"\0\1\0\0", 5, b"base", 20, 0, 0, 0, 0, 0)
            live.send_data(wrench, opcode=2)
            self.assertIn("/reference_wrench: this run is a trial", live.warning())
            self.end(process)

    def test_a_trial_ends_when_its_page_asks_for_it(self):
        with self.trial() as (process, page):
            self.accept(page, "stop")
            process.communicate(timeout=60)  # with its page still connected
            self.assertEqual(process.returncode, 0)
            self.assertFalse(json.loads(self.summary.read_text())["interrupted"])
            self.assertEqual(len(self.recordings()), 1)

    def test_a_signal_ends_a_trial_with_all_its_files(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(number), self.trial() as (process, page):
                summary = self.summary_of_end(process, number)
                self.assertTrue(summary["interrupted"])
                recording = pathlib.Path(summary["recording"])
                self.assertEqual(len(self.samples(self.folder / recording)), summary["cycles"])

    def summary_of_end(self, process, number=signal.SIGTERM):
        process.send_signal(number)
        out, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0, out)
        return json.loads(self.summary.read_text())

    def test_what_is_no_origin_is_refused(self):
        for text in ("*", "127.0.0.1:8123", "http://127.0.0.1:8123/", "http://a;script-src *"):
            code, _, error = run("run", "door", "--embedded-in", text)
            self.assertEqual(code, 2, error)
            self.assertIn("--embedded-in: expected the origin of a page, as http://127.0.0.1:8123",
                          error)

    def test_a_stop_overtakes_what_is_being_prepared(self):
        with self.run_of("door", "--user", "mouse", "--no-recording") as (process, page):
            for identifier, command, name in ((100, "scenario", "excavator"),
                                              (101, "emergency_stop", "")):
                page.send({"type": "command", "id": identifier, "command": command,
                           "name": name, "value": 0})
            answers = [page.next("answer") for _ in range(2)]
            self.assertEqual([answer["id"] for answer in answers], [101, 100])
            self.assertEqual([answer["is_accepted"] for answer in answers], [True, False])
            self.assertEqual(answers[1]["reason"], "a stop came after it")
            self.assertEqual(self.fault_of_stop(page), 102)
            self.assertEqual(page.next("frame")["run"], 1)
            self.end_after_fault(process)

    def fault_of_stop(self, page):
        return page.next("frame", lambda frame: frame["mode"] == "fault")["safety"]["fault"]

    def test_another_page_releases_a_stop_by_name_only(self):
        with self.run_of("door", "--user", "mouse", "--no-recording") as (process, first):
            second = Page(f"http://{first.host}/#token={first.token}")
            self.addCleanup(second.close)
            self.accept(first, "emergency_stop")
            self.assertEqual(self.fault_of_stop(first), 102)
            self.refuse(second, "release_stop", "", second.number)
            self.refuse(second, "release_stop", "", 0)
            self.refuse(second, "panel", "emergency_stop", 0)
            self.accept(first, "speed", "", 0.1)  # the newest sample is old
            for i in range(40):
                page = (first, second)[i % 2]
                self.accept(page, "panel", "person_in_field", i // 2 % 2)
                safety = page.next("frame")["safety"]
                self.assertTrue(safety["emergency_stop"])
                self.assertEqual(safety["stop_pressed_by"], [first.number])
            self.accept(first, "speed", "", 1)
            first.close()  # leaves it pressed
            self.accept(second, "panel", "person_in_field", 0)
            self.assertIn("not reset", self.refuse(second, "mode", "reset"))
            self.accept(second, "release_stop", "", first.number)
            self.wait_and_reset(second)
            self.end_after_fault(process)

    def wait_and_reset(self, page):
        """The safety controller sees that the button is out after its time of response."""
        begin = page.next("frame", lambda frame: not frame["safety"]["emergency_stop"])["time_s"]
        page.next("frame", lambda frame: frame["time_s"] > begin + 0.2)
        self.accept(page, "mode", "reset")
        page.next("frame", lambda frame: frame["mode"] == "ready")

    def end_after_fault(self, process):
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 3)

    def test_a_stop_stays_pressed_in_the_next_run(self):
        with self.run_of("door", "--user", "mouse", "--no-recording") as (process, page):
            self.accept(page, "emergency_stop")
            self.accept(page, "restart")
            page.next("frame", lambda frame: frame["run"] == 2 and frame["mode"] == "fault")
            self.accept(page, "release_stop", "", page.number)
            self.wait_and_reset(page)
            self.end_after_fault(process)

    @contextlib.contextmanager
    def running_alone(self):
        """A door without a user that runs alone, the page that has turned the key, and what
        makes that page silent."""
        models = self.folder / "models"
        script = (models / "scripts/door.yaml").read_text()
        (models / "scripts/late.yaml").write_text(script + "\ngrasp_s: 500\n")
        scenario = (models / "scenarios/door.yaml").read_text()
        alone = models / "scenarios/alone.yaml"
        alone.write_text(scenario.replace("scripts/door.yaml", "scripts/late.yaml"))
        with self.program("run", alone, "--duration", "600", "--no-recording") as (process, link):
            page = Page(link)
            self.addCleanup(page.close)
            silence = threading.Event()
            self.addCleanup(silence.set)
            beating = threading.Thread(target=page.hold, args=[silence], daemon=True)
            beating.start()
            page.next("frame", lambda frame: frame["mode"] == "armed")
            self.assertTrue(any(self.runs_alone(page) for _ in range(20)))
            yield page, lambda: (silence.set(), beating.join())
            process.send_signal(signal.SIGINT)
            self.assertIn("override_key", process.communicate(timeout=60)[0])

    def runs_alone(self, page):
        """Asks for it. A busy machine may keep the page from being heard for 100 ms: no."""
        self.accept(page, "panel", "override_key", 1)
        while not page.command("mode", "run_alone")["is_accepted"]:  # until the key is known
            if not page.next("frame")["safety"]["override_key"]:
                return False
        begin = page.next("frame")["time_s"]
        frame = page.next("frame", lambda frame: frame["time_s"] > begin + 1.0)
        return frame["mode"] == "running" and frame["safety"]["is_autonomous"]

    def is_held(self, page):
        frame = page.next("frame", lambda frame: frame["mode"] == "armed")
        self.assertFalse(frame["safety"]["override_key"])
        begin = frame["time_s"]
        frame = page.next("frame", lambda frame: frame["time_s"] > begin + 0.5)
        self.assertEqual((frame["mode"], frame["safety"]["override_key"]), ("armed", False))

    def test_a_silent_page_holds_nothing(self):
        with self.running_alone() as (page, be_silent):
            be_silent()
            self.is_held(page)

    def test_old_sequence_numbers_hold_nothing(self):
        with self.running_alone() as (page, be_silent):
            be_silent()
            ends = time.monotonic() + 1.0
            old = 0
            while time.monotonic() < ends:
                old = old % page.sequence + 1
                page.send({"type": "hold", "sequence": old})
                time.sleep(0.02)
            self.is_held(page)

    def test_a_closed_page_holds_nothing(self):
        with self.running_alone() as (page, be_silent):
            other = Page(f"http://{page.host}/#token={page.token}")
            self.addCleanup(other.close)
            be_silent()
            page.close()
            self.is_held(other)

    def record(self, *arguments):
        code, out, err = run("run", "door", "--fast", "--duration", "4", "--recordings",
                             self.folder / "recordings", *arguments)
        self.assertEqual(err, "", out)
        return max(self.recordings(), key=lambda path: path.stat().st_mtime_ns)

    def test_a_recording_is_played_scrubbed_and_compared(self):
        first, second = self.record(), self.record("--law", "paper")
        shutil.rmtree(self.folder / "models/twins")  # all that it needs is in it
        (self.folder / "models/scenarios/door.yaml").unlink()
        with self.program("replay", first, "--compare", second, "--view", "--speed",
                          "2") as (process, link):
            page = Page(link)
            self.addCleanup(page.close)
            scene = page.scene()
            self.assertEqual((scene["source"], scene["title"]), ("recording", "Door"))
            self.assertAlmostEqual(scene["duration_s"], 4.2, delta=0.2)  # with the stop
            self.assertIn("<robot", page.get("/models/twin.urdf"))
            self.accept(page, "pause")
            self.accept(page, "seek", "", 2.5)
            frame = page.next("frame", lambda frame: frame["run_state"]["position_s"] == 2.5)
            self.assertAlmostEqual(frame["time_s"], 2.5, delta=0.03)
            self.assertAlmostEqual(frame["ghost"]["time_s"], 2.5, delta=0.03)
            self.assertIn("0.000 .. 4.", self.refuse(page, "seek", "", 99))
            self.assertIn("recording", self.refuse(page, "set", "mass_scale", 2))
            self.accept(page, "restart")
            self.accept(page, "resume")
            page.next("frame", lambda frame: frame["run_state"]["is_over"])
            self.end(process)

    def test_another_mechanism_is_not_drawn_as_a_ghost(self):
        first, second = self.record(), self.record("--twin", "excavator")
        code, out, err = run("replay", first, "--compare", second, "--view")
        self.assertEqual((code, out), (2, ""))
        self.assertIn("--compare: both recordings need the same twin at the same place, got "
                      "models/twins/door/twin.yaml and models/twins/excavator/twin.yaml", err)

    def test_a_flight_recording_is_played_in_the_time_of_its_run(self):
        code, out, err = run("run", "door", "--fast", "--duration", "12", "--flight-recorder",
                             "always", "--recordings", self.folder / "recordings")
        self.assertEqual(err, "", out)
        (file,) = (self.folder / "recordings").glob("*_stop_*.mcap")
        with self.program("replay", file, "--view") as (process, link):
            page = Page(link)
            self.addCleanup(page.close)
            scene = page.scene()
            self.assertAlmostEqual(scene["begin_s"] + scene["duration_s"], 12.2, delta=0.3)
            self.assertGreater(scene["begin_s"], 1.0)
            self.accept(page, "pause")
            self.accept(page, "seek", "", 5.0)
            frame = page.next("frame", lambda frame: frame["run_state"]["position_s"] == 5.0)
            self.assertAlmostEqual(frame["time_s"], 5.0, delta=0.03)
            self.assertIn("12.", self.refuse(page, "seek", "", 0.5))
            self.end(process)

    def test_a_file_that_is_no_recording_is_refused(self):
        file = self.folder / "no.mcap"
        file.write_text("nothing")
        code, out, err = run("replay", file, "--view")
        self.assertEqual(code, 2)
        self.assertIn("must be a recording", err)

    def at_terminal(self, *options, is_read=True, **environment):
        """A run of the door there, and the link that it prints. Not read: Ctrl-S stands after it."""
        primary, secondary = pty.openpty()
        process = subprocess.Popen(
            [self.installed, "run", "door", "--user", "mouse", "--no-recording", *options],
            stdout=secondary, cwd=self.folder, env={"PATH": os.environ["PATH"], **environment})
        self.addCleanup(os.close, primary)
        self.addCleanup(process.kill)
        shown = b""
        while not (link := re.search(rb"(http://\S+)\s", shown)):
            shown += os.read(primary, 4096)
        if is_read:
            threading.Thread(target=drain, args=[os.dup(primary)], daemon=True).start()
        else:
            termios.tcflow(secondary, termios.TCOOFF)
        os.close(secondary)
        return process, link[1].decode()

    def test_a_stopped_terminal_does_not_block_stops_of_the_page(self):
        process, link = self.at_terminal("--no-browser", is_read=False)
        page = Page(link)
        self.addCleanup(page.close)
        page.next("frame", lambda frame: frame["mode"] == "running")
        time.sleep(1.0)  # of status lines
        self.accept(page, "emergency_stop")
        page.next("frame", lambda frame: frame["mode"] != "running")
        self.accept(page, "stop")
        page.next("frame", lambda frame: frame["run_state"]["is_over"])
        process.send_signal(signal.SIGTERM)
        process.wait(timeout=30)

    def open_at_terminal(self, *options, **environment):
        """The link that the program prints there, and the one that a browser is made to open."""
        opened = self.folder / "opened"
        browser = self.folder / "bin/xdg-open"
        browser.parent.mkdir(exist_ok=True)
        browser.write_text(f'#!/bin/sh\necho "$1" > {opened}.new && mv {opened}.new {opened}\n')
        browser.chmod(0o755)
        process, link = self.at_terminal(
            *options, **environment, PATH=f"{browser.parent}:{os.environ['PATH']}")
        page = Page(link)
        page.next("frame", lambda frame: frame["mode"] == "running")
        for _ in range(200 if environment and not options else 1):
            if opened.exists():
                break
            time.sleep(0.05)
        page.command("stop")
        page.next("frame", lambda frame: frame["run_state"]["is_over"])
        page.command("restart")
        page.next("frame", lambda frame: frame["run"] == 2)
        page.close()
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=30), 0)
        result = opened.read_text().strip() if opened.exists() else None
        opened.unlink(missing_ok=True)
        return link, result

    def test_a_browser_opens_where_there_is_a_display_and_a_terminal(self):
        link, opened = self.open_at_terminal(DISPLAY=":0")
        self.assertEqual(opened, link)
        self.assertIsNone(self.open_at_terminal()[1])
        self.assertIsNone(self.open_at_terminal("--no-browser", DISPLAY=":0")[1])

    def test_without_the_built_page_it_says_how_to_get_it(self):
        shutil.rmtree(self.folder / "prefix/share/hapticgiant/viewer")
        done = subprocess.run([self.installed, "run", "door", "--user", "none", "--duration", "0.3",
                               "--no-recording"], cwd=self.folder, capture_output=True, text=True,
                              timeout=60)
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        self.assertIn("npm run build", done.stdout)

    def test_another_address_is_warned_of(self):
        with self.program("run", "door", "--user", "mouse", "--no-recording", "--bind",
                          "0.0.0.0") as (process, link):
            self.assertIn("WARNING: listening at 0.0.0.0", process.stdout.readline())
            page = Page(link)
            self.addCleanup(page.close)
            page.next("frame")
        try:
            with socket.socket(socket.AF_INET6) as any_port:
                any_port.bind(("::1", 0))
        except OSError:
            return  # no IPv6 here
        for address in ("::1", "[::1]", "0:0:0:0:0:0:0:1"):
            with self.program("run", "door", "--user", "mouse", "--no-recording", "--bind",
                              address) as (_, link):
                self.assertRegex(link, r"^http://\[::1\]:\d+/#token=")

    def test_an_address_without_a_page_is_refused(self):
        for arguments in (("run", "door", "--fast", "--bind", "0.0.0.0"),
                          ("run", "door", "--no-viewer", "--port", "8080"),
                          ("run", "door", "--fast", "--port", "8080"),
                          ("replay", MODELS / "scenarios/door.yaml", "--port", "8080")):
            code, out, err = run(*arguments)
            self.assertEqual((code, out), (2, ""), arguments)
            self.assertIn(arguments[-2], err)

    def test_a_name_is_no_address(self):
        code, out, err = run("run", "door", "--bind", "nowhere", "--duration", "1",
                             "--no-recording")
        self.assertEqual(code, 2, out)
        self.assertIn("nowhere", err)


if __name__ == "__main__":
    unittest.main()
