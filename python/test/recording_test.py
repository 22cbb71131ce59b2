"""Recordings as tables and data sets.

HG_RECORDING: a recording of the door by the program; without it what needs one is skipped.
"""

import importlib.util
import os
import pathlib
import re
import tempfile
import unittest

import numpy as np

import hapticgiant as hg

RECORDING = os.environ.get("HG_RECORDING")
needs_recording = unittest.skipUnless(RECORDING, "HG_RECORDING is not set")
needs_tables = unittest.skipUnless(
    importlib.util.find_spec("pandas") and importlib.util.find_spec("xarray"),
    "pandas or xarray is not installed")


@needs_tables
class Tables(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.door = hg.run("door", duration_s=0.2)

    def test_a_table_has_one_number_per_cell_and_units(self):
        table = self.door.to_pandas(["robot.*", "twin.q_a", "mode"])
        np.testing.assert_array_equal(table.index, self.door["time_s"])
        self.assertEqual(table.index.name, "time_s")
        np.testing.assert_array_equal(table["robot.w_h[3]"], self.door["robot.w_h"][:, 3])
        self.assertEqual(table["mode"].dtype, self.door["mode"].dtype)
        units = table.attrs["units"]
        self.assertEqual(set(units), set(table.columns))
        self.assertEqual([units[f"robot.w_h[{i}]"] for i in (0, 3)], ["N", "Nm"])
        self.assertEqual([units[name] for name in ("robot.q_p[0]", "robot.q_m[0]", "twin.q_a[0]",
                                                   "mode")], ["m", "rad", "rad", ""])

    def test_without_a_choice_all_columns_are_there(self):
        table = self.door.to_pandas()
        numbers = sum(values.shape[1] if values.ndim == 2 else 1 for values in self.door.values())
        self.assertEqual(len(table.columns), numbers - 1)  # the time is the index
        self.assertEqual(set(self.door.to_xarray().data_vars) | {"time_s"}, set(self.door))

    def test_a_data_set_names_joints_limits_and_directions(self):
        data = self.door.to_xarray()
        door = hg.load_scenario("door")
        self.assertEqual(list(data.limit.values), [limit.name for limit in door.limits])
        self.assertEqual(list(data.manipulator.values), ["m1", "m2", "m3", "m4", "m5", "m6"])
        self.assertEqual(len(data.gantry), 2)
        self.assertIn("hinge", data.twin_coordinate.values)
        hinge = data["twin.q_a"].sel(twin_coordinate="hinge")
        np.testing.assert_array_equal(hinge, self.door["twin.q_a"][:, 0])
        np.testing.assert_array_equal(data["handle.p"].sel(direction="z"),
                                      self.door["handle.p"][:, 2])
        self.assertEqual(data["robot.q_p"].attrs["units"], "m")
        self.assertEqual(data["robot.w_h"].attrs["units"], "N, Nm")
        self.assertEqual(data.time_s.attrs["units"], "s")
        self.assertIn("wrench of the user", data["robot.w_h"].attrs["long_name"])

    def test_a_wrong_name_raises_with_the_nearest(self):
        for convert in (self.door.to_pandas, self.door.to_xarray):
            with self.assertRaisesRegex(hg.SetupError, "did you mean 'robot.q_m'"):
                convert(["robot.qm"])

    def test_a_free_body_has_all_its_coordinates(self):
        data = hg.run("free_space", duration_s=0.05).to_xarray(["twin.*"])
        coordinates = list(data.twin_coordinate.values)
        self.assertEqual([name.rpartition(".")[2] for name in coordinates],
                         ["x", "y", "z", "qx", "qy", "qz", "qw"])
        self.assertEqual(data.sizes["twin_velocity"], 6)

    @needs_recording
    def test_a_recording_has_events_configuration_and_the_same_columns(self):
        recorded = hg.read_recording(RECORDING)
        events = recorded.events_to_pandas()
        self.assertEqual(list(events.columns), ["time_s", "name", "text"])
        self.assertTrue(any("t_b" in event.text or event.name == "t_b"
                            for event in recorded.events), recorded.events)
        self.assertTrue(events.time_s.is_monotonic_increasing)
        self.assertEqual(recorded.metadata["rate_Hz"], "1000")
        self.assertTrue(any(name.endswith("door.yaml") for name in recorded.configuration))
        self.assertEqual(recorded.facts, hg.run("door", duration_s=0.01).facts)
        first = recorded.to_xarray(["twin.q_a", "robot.w_h"]).isel(time_s=slice(0, 100))
        np.testing.assert_array_equal(
            first["robot.w_h"], self.door.to_xarray(["robot.w_h"])["robot.w_h"][:100])


@needs_recording
class Damage(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = pathlib.Path(folder.name) / "damaged.mcap"
        self.bytes = bytearray(pathlib.Path(RECORDING).read_bytes())

    def test_a_chunk_with_a_wrong_bit_is_left_out_and_reported(self):
        whole = hg.read_recording(RECORDING)
        self.assertEqual(whole.losses, [])
        self.bytes[len(self.bytes) // 2] ^= 1
        self.file.write_bytes(self.bytes)
        with self.assertWarnsRegex(UserWarning, "chunk at byte [0-9]+ is damaged: [0-9]+ samples"):
            read = hg.read_recording(self.file)
        lost = int(re.search(r"(\d+) samples", read.losses[0])[1])
        self.assertEqual(len(read["time_s"]) + lost, len(whole["time_s"]))
        same = np.isin(whole["time_s"], read["time_s"])
        np.testing.assert_array_equal(read["robot.w_h"], whole["robot.w_h"][same])

    def test_other_damage_is_one_error_that_names_the_file(self):
        place = self.bytes.index(b"rate_Hz")  # a name in the metadata
        length = self.bytes.index(b"\x06", 8) + 1  # of the first chunk
        for at in (place, length + 5):
            changed = bytearray(self.bytes)
            changed[at] ^= 1
            self.file.write_bytes(changed)
            with self.assertRaisesRegex(hg.SetupError, "damaged.mcap: cannot be read"):
                hg.read_recording(self.file)


class Facts(unittest.TestCase):
    def test_every_number_with_a_unit_has_one_that_is_known(self):
        facts = hg.run("door", duration_s=0.01).facts
        units = {known.unit for known in facts.values()}
        self.assertLessEqual(units, {
            "", "s", "us", "m", "m/s", "m/s^2", "rad", "rad/s", "rad/s^2", "N", "Nm", "J", "Ns/m",
            "N/cm^2", "degC", "rad or m", "rad/s or m/s", "rad/s^2 or m/s^2", "Nm or N",
            "N, Nm", "m, rad", "m/s, rad/s", "m/s^2, rad/s^2",
            "m/s^2, rad/s"})
        self.assertEqual(facts["tracking.latency_s"].unit, "s")
        self.assertEqual(facts["limits.reaction"].units[-2], "Nm")


if __name__ == "__main__":
    unittest.main()
