"""`hapticgiant export`, compared with what the official MCAP reader finds in the recording; rosbag2
folders are read by rosbags.

Usage: export_test.py BUILD PROGRAM   (from the repository root). Without the network that rosbags is
installed from, its tests are skipped by name.
"""

import csv
import json
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
sys.path[:0] = ["tests/command_line", "tests/packages"]
import recorded  # noqa: E402
from mcap.reader import make_reader  # noqa: E402
from mcap.writer import CompressionType, Writer  # noqa: E402
from environment import make_environment  # noqa: E402
from program import PROGRAM, TemporaryFolder, run  # noqa: E402

RECORDINGS = BUILD / "export_test"
JUDGES = BUILD.parent / "connect_venv"


def setUpModule():
    global DOOR, SAMPLES
    code, out, err = run("run", "door", "--fast", "--no-viewer", "--duration", "2", "--seed", "7",
                         "--flight-recorder", "off", "--recordings", RECORDINGS)
    assert code in (0, 1), out + err  # later events are missing
    DOOR = (RECORDINGS / "latest.mcap").resolve()
    SAMPLES = recorded.samples(DOOR)


class Export(TemporaryFolder):
    def export(self, file, *options, code=0):
        """Standard output, or standard error where it is to fail."""
        found, out, err = run("export", file, "--out", self.folder / "door", *options)
        self.assertEqual(found, code, out + err)
        return out if code == 0 else err

    def rows(self):
        with open(self.folder / "door.csv", newline="") as stream:
            return list(csv.DictReader(stream))

    def is_empty(self):
        self.assertEqual([file.name for file in self.folder.iterdir()], [])


class Csv(Export):
    def test_numbers_are_those_of_the_recording(self):
        out = self.export(DOOR, "--columns", "robot.*", "twin.q_a", "mode", "state_hash",
                          "sensors.dead_man", "limits.reaction")
        self.assertIn(f"{len(SAMPLES)} rows", out)
        rows = self.rows()
        self.assertEqual(len(rows), len(SAMPLES))
        self.assertEqual(next(iter(rows[0])), "time_s")
        for row, sample in zip(rows, SAMPLES):
            record = sample.record
            self.assertEqual(float(row["time_s"]), record.time_s)
            self.assertEqual([float(row[f"robot.w_h[{i}]"]) for i in range(6)],
                             list(record.robot.w_h))
            self.assertEqual(float(row["twin.q_a[1]"]), record.twin.q_a[1])
            self.assertEqual(int(row["mode"]), record.mode)
            self.assertEqual(int(row["state_hash"]), record.state_hash)
            self.assertEqual(int(row["sensors.dead_man"]), sample.sensors.dead_man)
            reactions = [limit.reaction for limit in record.limits]
            cells = [row[f"limits.reaction[{i}]"] for i in range(len(reactions))]
            # without a law there is no reaction, and the cell is empty
            self.assertEqual([float(cell) for cell in cells if cell], reactions if any(cells) else [])

    def test_the_dictionary_says_what_columns_are_and_where_they_are_from(self):
        self.export(DOOR, "--columns", "robot.*", "limits.reaction", "time_s", "mode")
        facts = json.loads((self.folder / "door.json").read_text())
        columns = {column["name"]: column for column in facts["columns"]}
        head = (self.folder / "door.csv").read_text().splitlines()[0].split(",")
        names = [name for column in facts["columns"] for name in
                 ([f"{column['name']}[{i}]" for i in range(column["width"])] if "width" in column
                  else [column["name"]])]
        self.assertEqual(head, names)
        self.assertEqual(columns["time_s"]["unit"], "s")
        self.assertEqual(columns["robot.q_p"]["units"], ["m", "m"])
        self.assertEqual(columns["robot.q_m"]["labels"], ["m1", "m2", "m3", "m4", "m5", "m6"])
        self.assertEqual(columns["robot.w_h"]["units"], 3 * ["N"] + 3 * ["Nm"])
        reaction = columns["limits.reaction"]
        self.assertEqual(reaction["units"][reaction["labels"].index("hinge")], "Nm")
        self.assertRegex(columns["mode"]["description"], r"\d running")
        last = SAMPLES[-1].record.state_hash
        self.assertEqual(facts["run"]["last_state_hash"], f"{last:016x}")
        for name, value in (("scenario", "Door"), ("seed", "7"), ("rate_Hz", "1000"),
                            ("law", "gauss")):
            self.assertEqual(facts["run"][name], value)
        self.assertTrue(facts["run"]["version"])
        self.assertEqual((facts["rows"], facts["is_complete"], facts["losses"]),
                         (len(SAMPLES), True, ""))

    def test_events_are_a_table_of_their_own(self):
        self.export(DOOR, "--columns", "mode")
        with open(self.folder / "door.events.csv", newline="") as stream:
            rows = [(float(row["time_s"]), row["name"], row["text"])
                    for row in csv.DictReader(stream)]
        self.assertEqual(rows, recorded.events(DOOR))
        self.assertTrue(rows)

    def test_all_columns_are_exported_by_default(self):
        self.export(DOOR, "--to", "0.02")
        names = {name.split("[")[0] for name in self.rows()[0]}
        code, listed, _ = run("export", "--list-columns")
        self.assertEqual(code, 0)
        known = {line.split()[0].removesuffix("[]") for line in listed.splitlines()}
        self.assertLessEqual(names, known)
        code, out, _ = run("export", "--list-columns", "--json", "/dev/stdout")
        listed_json = {column["name"]: column for column in json.loads(out)["columns"]}
        self.assertEqual(listed_json.keys(), known)
        for line in listed.splitlines():
            name = line.split()[0]
            self.assertEqual(listed_json[name.removesuffix("[]")]["has_index"], name.endswith("[]"))
        self.assertEqual(listed_json["robot.w_h"]["unit"], "N, Nm")
        self.assertEqual(run("export", DOOR, "--json", "/dev/stdout")[0], 2)
        # what this run does not have is left out
        self.assertIn("sensors.inertial", known - names)

    def test_rate_and_part_choose_rows(self):
        self.export(DOOR, "--columns", "mode", "--from", "0.5", "--to", "2", "--rate", "100")
        times = [float(row["time_s"]) for row in self.rows()]
        self.assertEqual([round(1e6 * time) for time in times], list(range(500000, 2000000, 10000)))
        self.export(DOOR, "--columns", "mode", "--rate", "300")
        times = [float(row["time_s"]) for row in self.rows()]
        self.assertEqual(len(times), -(-len(SAMPLES) * 3 // 10))
        self.assertLess(max(abs(time - k / 300) for k, time in enumerate(times)), 1.001e-3)

    def test_an_older_export_is_replaced_and_nothing_else(self):
        self.export(DOOR, "--columns", "mode")
        self.export(DOOR, "--columns", "twin.q_a")
        self.assertIn("twin.q_a[0]", self.rows()[0])
        (self.folder / "door.csv").write_text("my own notes\n")
        self.assertIn("not replaced", self.export(DOOR, "--columns", "mode", code=2))
        self.assertEqual((self.folder / "door.csv").read_text(), "my own notes\n")
        self.assertFalse(list(self.folder.glob("*.partial")))

    def test_files_of_others_with_such_beginnings_are_kept(self):
        for name, text in (("door.json", '{"name": "door", "columns": 3}\n'),
                           ("door.csv", "time_s,mine\n0,1\n"),
                           ("door.events.csv", "time_s,mine\n0,1\n"),
                           ("door.csv.partial", "mine\n")):
            file = self.folder / name
            file.write_text(text)
            code = 0 if name.endswith(".partial") else 2
            said = self.export(DOOR, "--columns", "mode", "--to", "0.01", code=code)
            self.assertEqual(file.read_text(), text)
            if code:
                self.assertIn(f"{name}: exists already and is of no older export", said)
                self.assertEqual(list(self.folder.iterdir()), [file])
                file.unlink()


class BadInput(Export):
    def test_has_one_clear_error_and_leaves_nothing(self):
        nothing = self.folder.parent / "nothing.mcap"
        broken = RECORDINGS / "broken.txt"
        broken.write_text("no recording\n")
        for file, options, message in (
                (DOOR, ["--columns", "robot.qm"], "did you mean 'robot.q_m'"),
                (DOOR, ["--columns", "robot.*", "twn.*"], "no column is called twn.*"),
                (DOOR, ["--from", "2", "--to", "1"], "--to: must be later than --from"),
                (DOOR, ["--from", "100"], "has no sample in that time"),
                (DOOR, ["--rate", "0"], "more than 0"),
                (DOOR, ["--rate", "1e308"], "at most 1e9"),
                (DOOR, ["--format", "excel"], "excel"),
                (DOOR, ["--format", "rosbag2", "--rate", "10"], "not possible with rosbag2"),
                (DOOR, ["--format", "rosbag2", "--from", "100"], "no message in that time"),
                (broken, [], "must be a recording"),
                (nothing, [], "does not exist")):
            self.assertIn(message, self.export(file, *options, code=2))
            self.is_empty()
        for out, options, message in ((".", [], "expected a name of files"),
                                      (self.folder / "a\nb", ["--format", "rosbag2"],
                                       "without control characters")):
            code, _, err = run("export", DOOR, "--out", out, *options)
            self.assertEqual(code, 2)
            self.assertIn(message, err)
            self.is_empty()
        code, _, err = run("export")
        self.assertEqual(code, 2)
        self.assertIn("file", err)

    def test_a_file_name_that_is_not_utf8_is_one_of_files(self):
        file = self.folder / os.fsdecode(b"door\xff.mcap")
        shutil.copy(DOOR, file)
        self.export(file, "--columns", "mode", "--to", "0.01")
        facts = json.loads((self.folder / "door.json").read_text())
        self.assertEqual(facts["file"], "door\\xff.mcap")

    def test_a_missing_library_is_named_before_anything_is_read(self):
        python = self.folder / "python"
        python.write_text("#!/bin/sh\nprintf pyarrow\nexit 69\n")
        python.chmod(0o755)
        done = subprocess.run([PROGRAM, "export", DOOR, "--format", "parquet", "--out",
                               self.folder / "door"], capture_output=True, text=True, timeout=60,
                              env={**os.environ, "HAPTICGIANT_PYTHON": str(python)})
        self.assertEqual(done.returncode, 2)
        self.assertIn("lacks pyarrow; pip install 'hapticgiant[export]'", done.stderr)
        python.unlink()
        self.is_empty()

    def test_a_full_disk_leaves_no_half_of_a_file(self):
        done = subprocess.run([PROGRAM, "export", DOOR, "--out", self.folder / "door"],
                              capture_output=True, text=True, timeout=60,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE,
                                                                    (100000, 100000)))
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertIn("could not be written", done.stderr)
        self.is_empty()


class Interrupted(Export):
    def test_rosbag2_leaves_nothing_and_the_next_export_works(self):
        with subprocess.Popen([PROGRAM, "export", DOOR, "--format", "rosbag2", "--from", "0.001",
                               "--out", self.folder / "door"], stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as export:
            while export.poll() is None and not any(self.folder.iterdir()):
                time.sleep(0.001)
            export.send_signal(signal.SIGINT)
        self.assertIn(export.returncode, (0, 2))  # 0: it was faster
        self.assertEqual(list(self.folder.glob("*.partial*")), [])
        shutil.rmtree(self.folder / "door", ignore_errors=True)
        (self.folder / "door.partial").mkdir()  # of another
        self.export(DOOR, "--format", "rosbag2", "--to", "0.1")


class Damaged(Export):
    def test_what_can_be_read_is_exported_and_losses_are_reported(self):
        bytes_ = bytearray(DOOR.read_bytes())
        bytes_[len(bytes_) // 2] ^= 0xFF
        file = self.folder / "damaged.mcap"
        file.write_bytes(bytes_)
        out = self.export(file, "--columns", "mode")
        self.assertIn("DAMAGED     chunk at byte", out)
        lost = len(SAMPLES) - len(self.rows())
        self.assertIn(f" {lost} samples from", out)
        self.assertTrue(0 < lost <= 250)
        facts = json.loads((self.folder / "door.json").read_text())
        self.assertIn(f" {lost} samples from", facts["losses"])

    def test_one_that_is_cut_off_gives_what_it_has(self):
        file = self.folder / "cut.partial.mcap"
        file.write_bytes(DOOR.read_bytes()[: DOOR.stat().st_size // 2])
        self.assertIn("CUT OFF", self.export(file, "--columns", "mode"))
        rows = self.rows()
        self.assertTrue(500 < len(rows) < len(SAMPLES))
        self.assertEqual([float(row["time_s"]) for row in rows],
                         [sample.record.time_s for sample in SAMPLES[:len(rows)]])
        self.assertFalse(json.loads((self.folder / "door.json").read_text())["is_complete"])


class OfOtherTools(Export):
    """What other tools have rewritten, merged or sorted: read as it is, or refused."""

    def rewrite(self, change=lambda messages: messages, runs=1, **options):
        file = self.folder / "rewritten.mcap"
        with DOOR.open("rb") as stream, file.open("wb") as out:
            reader = make_reader(stream)
            messages = list(reader.iter_messages(log_time_order=False))
            writer = Writer(out, **options)
            writer.start()
            for _ in range(runs):
                for record in reader.iter_metadata():
                    writer.add_metadata(record.name, record.metadata)
            topics = {}
            for schema, channel, _ in messages:
                if channel.id not in topics:
                    number = writer.register_schema(schema.name, schema.encoding, schema.data)
                    topics[channel.id] = writer.register_channel(
                        channel.topic, channel.message_encoding, number)
            for _, channel, message in change(messages):
                writer.add_message(topics[channel.id], message.log_time, message.data,
                                   message.publish_time, message.sequence)
            writer.finish()
        return file

    def test_other_chunks_and_none_change_no_number(self):
        self.export(DOOR, "--columns", "robot.*")
        expected = (self.folder / "door.csv").read_bytes()
        for options in ({"use_chunking": False}, {"compression": CompressionType.NONE},
                        {"chunk_size": 3000}):
            with self.subTest(options):
                for written in self.folder.iterdir():
                    written.unlink()
                out = self.export(self.rewrite(**options), "--columns", "robot.*")
                self.assertNotIn("DAMAGED", out)
                self.assertEqual((self.folder / "door.csv").read_bytes(), expected)

    def refused(self, file, why):
        for options in (("--columns", "mode"), ("--format", "rosbag2")):
            self.assertIn(why, self.export(file, *options, code=2))
        code, out, err = run("explain", file)
        self.assertEqual(code, 2, out)
        self.assertIn(why, err)

    def test_samples_out_of_order_are_refused(self):
        half = len(SAMPLES)
        for change in (lambda m: m[::-1], lambda m: m[half:] + m[:half], lambda m: m + m):
            self.refused(self.rewrite(change), "is not later than the one before")

    def test_two_runs_are_refused(self):
        self.refused(self.rewrite(runs=2), "more than one run")

    def test_a_compression_that_is_not_read_is_named(self):
        self.refused(self.rewrite(compression=CompressionType.LZ4), "zstd or none, got lz4")

    def test_a_start_that_was_cut_off_is_no_recording(self):
        file = self.folder / "begin.mcap"
        file.write_bytes(DOOR.read_bytes()[:400])
        self.refused(file, "cut off before its first sample")


class Rosbag2(Export):
    @classmethod
    def setUpClass(cls):
        why = make_environment(JUDGES, pathlib.Path("tools/requirements-connect.txt").resolve())
        if why:
            raise unittest.SkipTest(f"rosbags cannot be installed: {why}")

    def setUp(self):
        # beside the recording: links do not reach other file systems
        self.folder = pathlib.Path(tempfile.mkdtemp(dir=RECORDINGS))
        self.addCleanup(shutil.rmtree, self.folder)

    def read(self):
        out = self.folder / "read.json"
        subprocess.run([JUDGES / "bin" / "python", "tests/connect/read_rosbag2.py",
                        self.folder / "door", out], check=True)
        return json.loads(out.read_text())

    def is_the_recording(self, found, first_ns=0, end_ns=2**63, without=()):
        total = 0
        for topic in [name for name in found if name.startswith("/")]:
            expected = [(time, message) for time, message in recorded.messages(DOOR, topic)
                        if first_ns <= time < end_ns]
            total += len(found[topic]["times"])
            if topic in without:
                continue
            self.assertEqual(sorted(found[topic]["times"]), [time for time, _ in expected], topic)
            if found[topic]["numbers"]:
                self.assertEqual(found[topic]["numbers"],
                                 [numbers(message) for _, message in expected], topic)
        self.assertEqual(found["count"], total)

    def test_a_whole_recording_is_read_by_rosbags_with_all_standard_topics(self):
        self.assertIn("hard link", self.export(DOOR, "--format", "rosbag2"))
        (bag,) = (self.folder / "door").glob("*.mcap")
        self.assertEqual(bag.stat().st_ino, DOOR.stat().st_ino)
        found = self.read()
        for topic in ("/joint_states", "/twin/joint_states", "/user_wrench", "/tf"):
            self.assertGreater(len(found[topic]["numbers"]), 150, topic)
        self.assertEqual(found["/tf"]["type"], "tf2_msgs/msg/TFMessage")
        self.is_the_recording(found)

    def test_one_that_is_cut_off_becomes_whole(self):
        file = self.folder / "cut.partial.mcap"
        file.write_bytes(DOOR.read_bytes()[: DOOR.stat().st_size // 2])
        self.assertIn("CUT OFF", self.export(file, "--format", "rosbag2"))
        found = self.read()
        last = max(found["/hapticgiant/sample"]["times"])
        # events stand behind the samples in the recording of a run as fast as it can
        self.is_the_recording(found, end_ns=last + 1, without=["/hapticgiant/events"])
        (bag,) = (self.folder / "door").glob("*.mcap")
        code, out, _ = run("explain", bag)
        self.assertEqual(code, 0)
        self.assertNotIn("CUT OFF", out)

    def test_a_part_has_the_messages_of_its_time(self):
        self.export(DOOR, "--format", "rosbag2", "--from", "1", "--to", "2")
        start = recorded.messages(DOOR, "/hapticgiant/sample")[0][0]
        found = self.read()
        self.assertEqual(len(found["/hapticgiant/sample"]["times"]), 1000)
        self.is_the_recording(found, start + 10**9, start + 2 * 10**9)

    def test_a_folder_that_exists_is_kept(self):
        (self.folder / "door").mkdir()
        self.assertIn("exists already", self.export(DOOR, "--format", "rosbag2", code=2))


def numbers(value):
    """As in read_rosbag2.py, of a message of the MCAP reader."""
    if hasattr(value, "__slots__"):
        return [n for name in value.__slots__ for n in numbers(getattr(value, name))]
    if isinstance(value, (str, bool)):
        return [str(value)]
    if isinstance(value, (list, tuple)):
        return [n for item in value for n in numbers(item)]
    return [repr(value)]


if __name__ == "__main__":
    unittest.main()
