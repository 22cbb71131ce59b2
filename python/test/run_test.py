"""Scenarios, cycles, sessions and recordings as arrays.

HG_RECORDING: a recording of the door by the program; without it what needs one is skipped.
"""

import copy
import math
import os
import pathlib
import sys
import tempfile
import threading
import time
import unittest

import numpy as np

import hapticgiant as hg

RECORDING = os.environ.get("HG_RECORDING")
needs_recording = unittest.skipUnless(RECORDING, "HG_RECORDING is not set")


class Package(unittest.TestCase):
    def test_type_checkers_find_stubs(self):
        package = pathlib.Path(hg.__file__).parent
        self.assertTrue((package / "py.typed").is_file())
        stub = (package / "_core" / "limits.pyi").read_text()
        self.assertIn("def recoverable_bounds(limits: JointLimits", stub)

    def test_memory_is_allocated_by_whoever_did_before(self):
        extension = pathlib.Path(hg._core.__file__).read_bytes()
        self.assertNotIn(b"__libc_malloc", extension)


class Scenario(unittest.TestCase):
    def test_a_shipped_one_is_found_by_name_and_others_by_file(self):
        door = hg.load_scenario("door")
        by_file = hg.load_scenario(hg.MODELS / "scenarios" / "door.yaml")
        self.assertEqual(door.title, by_file.title)
        self.assertEqual(door.twin.nv, 2)
        self.assertEqual(door.device.nv, 8)
        self.assertEqual(door.limits[-2].name, "hinge")

    def test_a_wrong_name_raises_with_the_nearest(self):
        with self.assertRaisesRegex(hg.SetupError, "did you mean 'excavator'"):
            hg.load_scenario("excavtor")

    def test_a_faulty_file_raises_with_its_place(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "mine.yaml")
            file.write_text("title: Mine\ndevise: x\n")
            with self.assertRaisesRegex(hg.SetupError, r"mine\.yaml:1:1: key .device. is missing"):
                hg.load_scenario(file)


class Run(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.door = hg.run("door")

    def test_the_door_opens(self):
        self.assertTrue(1.3 < self.door["twin.q_a"][:, 0].max() < 1.8)
        self.assertEqual(self.door["mode"][-1], hg.Mode.ARMED)
        self.assertFalse(self.door["fault.code"].any())
        self.assertLess(self.door["sync_error"].max(), 1e-3)

    @needs_recording
    def test_it_is_what_the_program_records(self):
        recorded = hg.read_recording(RECORDING)
        self.assertEqual(list(recorded), list(self.door))
        for name, values in self.door.items():
            if name == "cycle_time_us":  # measured
                continue
            self.assertEqual(recorded[name].dtype, values.dtype, name)
            # the program stops at the same cycle
            np.testing.assert_array_equal(recorded[name], values, name)

    def test_a_session_goes_through_the_same_states(self):
        session = hg.Session(hg.load_scenario("door"))
        hashes = [session.step().state_hash for _ in range(3000)]
        np.testing.assert_array_equal(hashes, self.door["state_hash"][:3000])

    def test_a_capped_solver_differs_from_its_time_on(self):
        def run(cap):
            scenario = hg.load_scenario(hg.MODELS / "stress" / "light_fast.yaml")
            scenario.law = hg.Law.PAPER  # needs more than one active set where limits act
            if cap:
                scenario.cap_solver(1, from_s=1.0)
            return hg.run(scenario, duration_s=1.5)["state_hash"]

        whole, capped = run(False), run(True)
        np.testing.assert_array_equal(whole[:1000], capped[:1000])
        self.assertTrue((whole[1000:1500] != capped[1000:1500]).any())
        door = hg.load_scenario("door")
        for bad in ((0, 0.0, 0.0), (1, math.nan, 0.0), (1, 0.0, -1.0)):
            with self.assertRaises(hg.SetupError):
                door.cap_solver(*bad)

    def test_duration_ends_it_and_bad_ones_are_refused(self):
        times = hg.run("door", duration_s=0.5)["time_s"]
        self.assertTrue(0.5 <= times[-1] < 1.6)
        for bad in (0.0, -1.0, math.nan, math.inf):
            with self.assertRaises(hg.SetupError):
                hg.run("door", duration_s=bad)

    def test_other_threads_run_meanwhile(self):
        count = 0
        is_over = threading.Event()

        def work():
            nonlocal count
            while not is_over.is_set():
                count += 1
                time.sleep(0)  # hands the interpreter back

        scenario = hg.load_scenario("door")
        thread = threading.Thread(target=work)
        interval = sys.getswitchinterval()
        sys.setswitchinterval(1000.0)  # s: no thread has to hand the interpreter over
        try:
            thread.start()
            before = count
            hg.run(scenario)
            after = count
        finally:
            sys.setswitchinterval(interval)
            is_over.set()
            thread.join()
        self.assertGreater(after, before)

    def test_law_and_bounds_of_the_paper_open_the_door_as_well(self):
        door = hg.load_scenario("door")
        door.law = hg.Law.PAPER
        door.bounds = hg.Bounds.PAPER
        run = hg.run(door)
        self.assertGreater(run["twin.q_a"][:, 0].max(), 1.3)
        different = len(run["time_s"]) != len(self.door["time_s"]) or not np.array_equal(
            run["state_hash"], self.door["state_hash"])
        self.assertTrue(different)

    def test_who_leads_the_gantry_can_be_chosen(self):
        door = hg.load_scenario("door")
        self.assertEqual(door.gantry, hg.Gantry.RULE)
        door.gantry = hg.Gantry.LAW
        self.assertEqual(door.gantry, hg.Gantry.LAW)


class OwnLoop(unittest.TestCase):
    def setUp(self):
        self.door = hg.load_scenario("door")
        self.cycle = hg.Cycle(self.door)
        self.device = hg.SimulatedDevice(self.door)
        self.operator = hg.OperatorFrame()

    def step(self):
        self.sensors = self.device.read()
        self.command, self.record = self.cycle.step(self.sensors, self.operator)
        self.device.write(self.command)
        self.operator.request = hg.next_request(
            self.record, self.cycle.is_held(self.sensors))

    def test_every_field_can_be_read(self):
        self.step()

        def visit(thing):
            for name in (name for name in dir(type(thing)) if not name.startswith("_")):
                value = getattr(thing, name)
                if type(value).__module__ == "hapticgiant._core" and not hasattr(value, "value"):
                    visit(value)

        for frame in (self.sensors, self.operator, self.command, self.record):
            visit(frame)
        self.assertEqual(len(self.record.limits), len(self.door.limits))

    def test_attributes_and_columns_have_the_same_names(self):
        self.step()
        record = self.record
        frames = {"sensors": self.sensors, "operator_input": self.operator,
                  "command": self.command, "truth": hg._core.Truth(),
                  "teleoperation": hg._core.TeleoperationReport()}
        seen = set()
        for column in hg.run("door", duration_s=0.01):
            if column == "cycle_time_us":  # of the sample, no attribute of a frame
                continue
            first, *rest = column.split(".")
            thing, path = (frames[first], rest) if first in frames else (record, [first, *rest])
            for name in path:
                self.assertIn(name, dir(thing), column)
                seen.add((type(thing).__name__, name))
                value = getattr(thing, name)
                thing = value[0] if name == "limits" else value
        everything = [*frames.values(), record]
        while everything:
            thing = everything.pop()
            for name in (name for name in dir(thing) if not name.startswith("_")):
                if callable(getattr(thing, name)):
                    continue
                self.assertIn((type(thing).__name__, name), seen)

    def test_frames_are_set_from_numpy(self):
        sensors = hg.SensorFrame()
        sensors.q_m = np.arange(6)
        sensors.w_s = [1, 2, 3, 4, 5, 6]
        np.testing.assert_array_equal(sensors.q_m, [0, 1, 2, 3, 4, 5])
        np.testing.assert_array_equal(copy.copy(sensors).w_s, sensors.w_s)
        with self.assertRaisesRegex(ValueError, "w_s: expected 6 numbers, got 2"):
            sensors.w_s = [1, 2]
        with self.assertRaisesRegex(ValueError, "q_m: expected at most"):
            sensors.q_m = np.zeros(100)
        self.operator.hand_target.active = True
        self.assertTrue(self.operator.hand_target.active)

    def test_own_sensors_are_felt(self):
        for _ in range(200):
            self.step()
        before = self.record.robot.w_h[:3].copy()
        sensors = self.device.read()
        sensors.w_s = sensors.w_s + [5.0, 0, 0, 0, 0, 0]
        _, record = self.cycle.step(sensors, self.operator)
        # what a low-pass of 160 Hz lets through in a millisecond, beside the sensor's noise
        share = 1.0 - np.exp(-2.0 * np.pi * 160.0 * 1e-3)
        self.assertAlmostEqual(np.linalg.norm(record.robot.w_h[:3] - before), 5.0 * share,
                               delta=0.3)

    def test_frames_of_the_wrong_size_are_refused(self):
        with self.assertRaisesRegex(ValueError, "sensors.q_m: expected 6 numbers, got 0"):
            self.cycle.step(hg.SensorFrame())
        self.step()
        command = copy.copy(self.command)
        command.enable = True
        command.q_m = [1.0]
        with self.assertRaisesRegex(ValueError, "command.q_m"):
            self.device.write(command)
        with self.assertRaisesRegex(ValueError, "state"):
            self.cycle.state = hg.Cycle(hg.load_scenario("excavator")).state

    def test_a_snapshot_brings_the_same_bits_again(self):
        for _ in range(1500):
            self.step()
        snapshot = self.cycle.state
        sensors = [self.device.read()]
        first = self.cycle.step(sensors[0], self.operator)[1].state_hash
        self.cycle.state = snapshot
        self.assertEqual(self.cycle.step(sensors[0], self.operator)[1].state_hash, first)

    def test_a_change_of_the_twin_is_taken_once(self):
        session = hg.Session(hg.load_scenario("door"))
        change = session.operator_input.change
        change.parameter, change.index, change.value = hg.Parameter.DAMPING, 0, 5.0
        self.assertEqual(session.step().change, hg.ChangeStatus.TAKEN)
        self.assertEqual(session.step().change, hg.ChangeStatus.NONE)
        change.parameter, change.index = hg.Parameter.DAMPING, 29
        self.assertEqual(session.step().change, hg.ChangeStatus.REFUSED)

    def test_a_hand_moves_the_handle_of_a_session(self):
        session = hg.Session(hg.load_scenario("free_space"))
        for _ in range(100):
            start = session.step().handle.p
        target = session.operator_input.hand_target
        target.active = True
        target.p_b = start + [0.0, 0.1, 0.0]
        for _ in range(3000):
            end = session.step().handle.p
        np.testing.assert_allclose(end - start, [0.0, 0.1, 0.0], atol=0.02)
        session.stop()
        for _ in range(1000):
            session.step()
        self.assertTrue(session.is_over)


class Recording(unittest.TestCase):
    def test_what_is_no_recording_is_refused(self):
        with self.assertRaisesRegex(hg.SetupError, "nowhere.mcap"):
            hg.read_recording("nowhere.mcap")
        with self.assertRaisesRegex(hg.SetupError, "cannot be read as a recording"):
            hg.read_recording(__file__)

    @needs_recording
    def test_one_that_was_cut_short_gives_what_it_has(self):
        whole = pathlib.Path(RECORDING).read_bytes()
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "cut.mcap")
            file.write_bytes(whole[: len(whole) // 2])
            times = hg.read_recording(file)["time_s"]
        self.assertTrue(1000 < len(times) < 14000)
        np.testing.assert_allclose(np.diff(times), 1e-3, atol=1e-9)


if __name__ == "__main__":
    unittest.main()
