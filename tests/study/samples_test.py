"""Recordings are read without the compiled part: the same values as by the decoder of others.

    samples_test.py   (from the repository root)
"""

import pathlib
import tempfile
import unittest

import numpy as np
import without_compiled_part  # noqa: F401
from mcap.writer import CompressionType, Writer
from mcap_ros2.decoder import DecoderFactory
from mcap_ros2.writer import Writer as RosWriter

from hapticgiant import samples

SCHEMA = f"""\
uint64 sequence  # of the sample
hg/Sensors sensors
hg/Record record
{"=" * 80}
MSG: hg/Sensors
bool is_on
float64[] q_m  # rad
float64[3] a_s
uint8 mode
{"=" * 80}
MSG: hg/Record
float64 time_s
uint8 mode
hg/Limit[] limits
int32[] causes
float32 ratio
{"=" * 80}
MSG: hg/Limit
float64 reaction
bool is_near
"""
EVENT = "float64 time_s\nstring name\nstring text\n"
CLOCK = "float64 time_s\nfloat64 offset_s\n"


def sample(i, joints=7, limits=2):
    return {"sequence": i, "sensors": {"is_on": i % 2 == 0, "q_m": [i + 0.1 * k for k in range(joints)],
                                       "a_s": [i, -i, 0.5], "mode": i % 5},
            "record": {"time_s": 0.001 * i, "mode": 3, "causes": [i] * (i % 3), "ratio": 0.5 * i,
                       "limits": [{"reaction": i + k, "is_near": k == 1} for k in range(limits)]}}


def write(file, messages, chunk_size=4000, finish=True, events=(), clocks=()):
    stream = open(file, "wb")
    writer = RosWriter(stream, chunk_size=chunk_size)
    schema = writer.register_msgdef("hg/msg/Sample", SCHEMA)
    event = writer.register_msgdef("hg/msg/Event", EVENT)
    for i, message in enumerate(messages):
        writer.write_message(samples.SAMPLES, schema, message, i, i)
    for each in events:
        writer.write_message(samples.EVENTS, event, each, 0, 0)
    if clocks:
        clock = writer.register_msgdef("hg/msg/LabClock", CLOCK)
    for each in clocks:
        writer.write_message(samples.LAB_CLOCK, clock, each, 0, 0)
    if finish:
        writer.finish()
    stream.close()


class Read(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = pathlib.Path(folder.name) / "run.mcap"

    def test_values_are_those_that_were_written(self):
        rows = [sample(i) for i in range(500)]
        write(self.file, rows, events=[{"time_s": 1.5, "name": "open", "text": "the door ü"}])
        found = samples.read(self.file)
        self.assertEqual(found.count, 500)
        self.assertEqual(found.events, [(1.5, "open", "the door ü")])
        columns = found.columns
        np.testing.assert_array_equal(columns["time_s"], [row["record"]["time_s"] for row in rows])
        np.testing.assert_array_equal(columns["sensors.q_m"], [row["sensors"]["q_m"] for row in rows])
        np.testing.assert_array_equal(columns["sensors.is_on"], [row["sensors"]["is_on"] for row in rows])
        np.testing.assert_array_equal(columns["limits.reaction"], [[i, i + 1] for i in range(500)])
        np.testing.assert_array_equal(columns["ratio"], 0.5 * np.arange(500))
        self.assertEqual({name: columns[name].dtype.str for name in ("mode", "sensors.mode", "causes", "ratio")},
                         {"mode": "|u1", "sensors.mode": "|u1", "causes": "<i4", "ratio": "<f4"})
        self.assertEqual([list(row[:i % 3]) for i, row in enumerate(columns["causes"])], [[i] * (i % 3) for i in range(500)])

    def test_the_lab_clock_is_a_number_and_not_the_words_of_an_event(self):
        event = {"time_s": 0.1, "name": "lab clock", "text": "local clock of LSL = run time + 7.5 s"}
        write(self.file, [sample(0)], events=[event])
        self.assertEqual(samples.read(self.file).lab_clock, [])
        write(self.file, [sample(0)], events=[event], clocks=[{"time_s": 0.1, "offset_s": -1234.0000001},
                                                             {"time_s": 5.5, "offset_s": 1e9}])
        self.assertEqual(samples.read(self.file).lab_clock, [(0.1, -1234.0000001), (5.5, 1e9)])

    def test_sequences_that_change_their_length_end_with_nothing(self):
        rows = [sample(i, joints=i % 4, limits=i % 3) for i in range(40)]
        write(self.file, rows)
        columns = samples.read(self.file).columns
        for i, row in enumerate(rows):
            np.testing.assert_array_equal(columns["sensors.q_m"][i, :i % 4], row["sensors"]["q_m"])
            self.assertTrue(np.isnan(columns["sensors.q_m"][i, i % 4:]).all())
            np.testing.assert_array_equal(columns["limits.is_near"][i], [False, i % 3 == 2])
        np.testing.assert_array_equal(columns["ratio"], 0.5 * np.arange(40))
        write(self.file, [sample(i, joints=0) for i in range(3)])
        self.assertNotIn("sensors.q_m", samples.read(self.file).columns)

    def test_random_bytes_are_as_another_decoder_reads_them(self):
        dice = np.random.default_rng(1)
        schema = samples._Schema(SCHEMA)
        for _ in range(20):
            row = sample(int(dice.integers(1000)), int(dice.integers(8)), int(dice.integers(5)))
            write(self.file, [row])
            data, theirs = self.first_message()
            layout = schema.layout(data)
            for name, values in (("sensors.q_m", theirs.sensors.q_m), ("causes", theirs.record.causes),
                                 ("limits.reaction", [each.reaction for each in theirs.record.limits]),
                                 ("ratio", [theirs.record.ratio])):
                ours = [x for dtype, at, count in layout.parts[name] for x in np.frombuffer(data, dtype, count, at)]
                self.assertEqual(ours, list(values), name)

    def first_message(self):
        from mcap.reader import make_reader

        with open(self.file, "rb") as stream:
            schema, channel, message = next(iter(make_reader(stream).iter_messages(topics=[samples.SAMPLES])))
            return message.data, DecoderFactory().decoder_for(channel.message_encoding, schema)(message.data)

    def chunks(self):
        """Places of the chunks in the file."""
        from mcap.reader import make_reader

        with open(self.file, "rb") as stream:
            return [each.chunk_start_offset for each in make_reader(stream).get_summary().chunk_indexes]

    def test_only_wanted_columns(self):
        write(self.file, [sample(i) for i in range(10)])
        self.assertEqual(set(samples.read(self.file, ["time_s", "sensors.a_s"]).columns), {"time_s", "sensors.a_s"})

    def test_a_damaged_chunk_is_left_out_and_named(self):
        write(self.file, [sample(i) for i in range(500)])
        whole = samples.read(self.file)
        self.assertEqual(whole.losses, [])
        data = bytearray(self.file.read_bytes())
        data[self.chunks()[3] + 200] ^= 1
        self.file.write_bytes(data)
        found = samples.read(self.file)
        self.assertRegex(found.losses[0], "chunk at byte [0-9]+ is damaged: [0-9]+ samples from")
        same = np.isin(whole.columns["time_s"], found.columns["time_s"])
        self.assertTrue(0 < found.count < 500)
        np.testing.assert_array_equal(found.columns["sensors.q_m"], whole.columns["sensors.q_m"][same])

    def test_a_file_that_a_crash_cut_is_read_to_its_last_chunk(self):
        write(self.file, [sample(i) for i in range(500)])
        data = self.file.read_bytes()
        self.file.write_bytes(data[:len(data) // 2])
        self.assertTrue(100 < samples.read(self.file).count < 500)

    def test_what_is_no_recording(self):
        for data, message in ((b"", "no messages"), (b"not mcap" * 9, "cannot be read as a recording")):
            self.file.write_bytes(data)
            with self.assertRaisesRegex(ValueError, f"run.mcap: {message}"):
                samples.read(self.file)
        with open(self.file, "wb") as stream:
            writer = Writer(stream, compression=CompressionType.NONE)
            writer.start()
            writer.finish()
        with self.assertRaisesRegex(ValueError, "no messages on /hapticgiant/sample"):
            samples.read(self.file)
        with self.assertRaises(FileNotFoundError):
            samples.read(self.file.with_name("none.mcap"))


if __name__ == "__main__":
    unittest.main()
