"""The paper's experiments, figures and comparisons as their user meets them.

Usage: experiments_test.py PROGRAM   (from the repository root)
"""

import filecmp
import json
import os
import pathlib
import re
import shutil
import subprocess
import unittest

from program import PROGRAM, TemporaryFolder, run

NO_PYTHON = {**os.environ, "HAPTICGIANT_PYTHON": "/bin/false-no-such-python"}
PAGES = pathlib.Path("docs/experiments").resolve()


def run_without_python(*arguments):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          timeout=300, stdin=subprocess.DEVNULL, env=NO_PYTHON)
    return done.returncode, done.stdout, done.stderr


def read(file):
    return json.loads(file.read_text())


class Experiments(TemporaryFolder):
    def events(self, name):
        code, out, err = run("experiment", name, "--out", self.folder, timeout=300)
        self.assertEqual((code, err), (0, ""), out)
        reported = read(self.folder / name / "events.json")
        self.assertEqual(reported["experiment"], name)
        for event in reported["events"]:
            self.assertTrue(event["is_as_expected"], event)
            self.assertTrue(event["condition"] and event["all_of"], event)
            if "expected" in event:
                self.assertLessEqual(event["expected"]["from_s"], event["found_s"])
                self.assertGreaterEqual(event["expected"]["to_s"], event["found_s"])
        times = [event["found_s"] for event in reported["events"]]
        self.assertEqual(times, sorted(times))
        return reported["events"]

    def results(self, name):
        return read(self.folder / name / "results.json")

    def test_cartesian_has_the_events_of_the_paper(self):
        events = self.events("cartesian")
        self.assertEqual([event["label"] for event in events],
                         ["t_a", "t_b", "t_b'", "t_c", "t_d", "t_e", "t_f", "t_g"])
        self.assertEqual(events[1]["all_of"], [{"kind": "limit", "of": "elbow x", "side": "upper"}])
        self.assertTrue(all("expected" in event for event in events))

    def test_excavator_has_the_events_of_the_paper(self):
        labels = [event["label"] for event in self.events("excavator")]
        self.assertEqual([label for label in labels if label.startswith("t_")],
                         ["t_a", "t_b", "t_c", "t_d", "t_e"])

    def test_path_reaches_six_checkpoints_within_5_cm(self):
        self.assertEqual(len(self.events("path")), 6)
        reported = {entry["what"]: entry["ours_simulated"] for entry in
                self.results("path")["statements"]}
        for number in range(1, 7):
            distance = float(re.match(r"within ([\d.]+) cm", reported[f"checkpoint {number}"])[1])
            self.assertLessEqual(distance, 5.0)
        self.assertRegex(reported["from the first to the last"], r"[\d.]+ s, [\d.]+ m")

    def test_two_runs_write_the_same_files(self):
        for name in ("one", "two"):
            code, out, _ = run("experiment", "door", "--seed", 3, "--out", self.folder / name)
            self.assertEqual(code, 0, out)
        one, two = (self.folder / name / "door" for name in ("one", "two"))
        names = {file.name for file in one.iterdir()}
        self.assertLessEqual({"recording.mcap", "events.json", "results.json", "timing.json",
                              "signals.csv", "signals.npy", "run.json", "report.html",
                              "figure.svg", "figure.png"}, names)
        self.assertNotIn("latest.mcap", names)
        same, different, missing = filecmp.cmpfiles(one, two, names, shallow=False)
        self.assertEqual((set(different) - {"timing.json"}, missing), (set(), []), same)
        labels = [event["label"] for event in read(one / "events.json")["events"]]
        self.assertEqual([label for label in labels if label.startswith("t_")],
                         ["t_a", "t_b", "t_c", "t_d", "t_e"])
        page = (one / "report.html").read_text()
        self.assertEqual(page.count("<svg"), 1)
        self.assertNotRegex(page, r'(src|href)="(?![#])')  # self-contained
        reported = {entry["what"]: entry["ours_simulated"] for entry in
                read(one / "results.json")["statements"]}
        self.assertRegex(reported["locked"], r"^0.00 \.\. [\d.]+ s, ")
        self.assertIn("(limit 1.75)", reported["t_d: fully open"])

        code, out, _ = run("compare", one / "recording.mcap", two / "recording.mcap")
        self.assertEqual(code, 0, out)
        self.assertIn("the same in every cycle", out)

    def test_the_person_walks_through_the_door(self):
        self.assertEqual(len(self.events("door")), 8)
        reported = {entry["what"]: entry["ours_simulated"] for entry in
                self.results("walk_through")["statements"]}
        leaf, frame, breadth = map(float, re.match(
            r"at least ([\d.]+) / ([\d.]+) m \(half a breadth: ([\d.]+) m\)",
            reported["middle of the body to leaf / frame"]).groups())
        self.assertGreater(min(leaf, frame), breadth)
        self.assertRegex(reported["walked through"], r"ends [\d.]+ m behind it")
        self.assertIn("Walking through the door: beside the paper",
                      (self.folder / "door" / "report.html").read_text())

    def test_a_missing_event_is_1(self):
        code, out, _ = run("experiment", "door", "--duration", 2, "--law", "paper", "--out",
                           self.folder)
        self.assertEqual(code, 1, out)
        self.assertIn("NOT AS EXPECTED: handle pressed did not happen", out)
        events = read(self.folder / "door" / "events.json")["events"]
        self.assertIsNotNone(events[0]["found_s"])
        self.assertIsNone(events[1]["found_s"])
        self.assertIn("MISSING", (self.folder / "door" / "report.html").read_text())

    def test_without_python_the_data_is_left(self):
        code, out, err = run_without_python("experiment", "door", "--duration", 2, "--out",
                                            self.folder)
        self.assertEqual(code, 4, out)
        self.assertRegex(err, r"python3-jinja2, then the same command again\n.* has the "
                              "data\n$")
        names = {file.name for file in (self.folder / "door").iterdir()}
        self.assertEqual(names, {"recording.mcap", "run.json", "signals.npy", "timing.json"})
        self.assertEqual(read(self.folder / "door" / "run.json")["events"][0]["name"], "locked")

    def test_without_python_a_study_keeps_its_results_or_is_refused(self):
        walk = ("experiment", "seeds", "walk", "--count", 1)
        code, out, err = run_without_python(*walk)
        self.assertEqual((code, out), (2, ""))
        self.assertIn("pip install 'hapticgiant[report]'", err)
        code, _, err = run_without_python(*walk, "--json", self.folder / "seeds.json")
        self.assertEqual(code, 4)
        self.assertIn("has the results", err)
        self.assertEqual(len(read(self.folder / "seeds.json")["runs"]), 1)

    def test_seeds_have_a_table(self):
        table = self.folder / "seeds.md"
        code, out, err = run("experiment", "seeds", "walk", "--count", 2, "--markdown", table,
                             "--json", self.folder / "seeds.json")
        self.assertEqual((code, err), (0, ""), out)
        self.assertRegex(out, r"walk +its own +2 of 2 +2 of 2 ")
        self.assertIn("| walk | its own | 2 of 2 | 2 of 2 |", table.read_text())

    def test_both_laws_stand_side_by_side(self):
        code, out, _ = run("experiment", "door", "--law", "both", "--duration", 2.5, "--out",
                           self.folder)
        self.assertEqual(code, 1, out)
        for law in ("gauss", "paper"):
            self.assertEqual(read(self.folder / "door" / law / "events.json")["law"], law)
        page = (self.folder / "door" / "report.html").read_text()
        self.assertIn("simulated, law gauss</th><th>simulated, law paper", page)

    def test_wrong_names_are_answered(self):
        code, _, err = run("experiment", "dor")
        self.assertEqual(code, 2)
        self.assertIn("'door'", err)
        self.assertEqual(run("experiment", "door", "--duration", "-1")[0], 2)
        self.assertEqual(run("experiment", "timing", "--rates", "50")[0], 2)

    def test_link_units_improve_on_encoders_and_one_may_fail(self):
        file = self.folder / "inertial.json"
        code, out, err = run("experiment", "inertial", "walk", "--seeds", 1, "--json", file,
                             timeout=300)
        self.assertEqual(code, 0, err)
        self.assertIn("encoders and units", out)
        runs = {one["units"]: one for one in read(file)["runs"]}
        for name in ("all", "all, one dies", "arm", "last link"):
            reported = runs[name]
            for what in ("joint_speed", "joint_acceleration"):
                self.assertLess(reported["inertial"][what], 0.8 * reported["reference"][what], name)
            self.assertEqual(reported["least_trust"], 0.0 if "dies" in name else 1.0)
        self.assertLess(runs["all, one dies"]["largest_change"],
                        1.2 * runs["all"]["largest_change"])
        self.assertEqual(run("experiment", "inertial", "walkk")[0], 2)

    def test_timing_stands_beside_the_paper(self):
        code, out, err = run("experiment", "timing", "--rates", "1000,2000", "--duration", "2",
                             "--law", "gauss", "--out", self.folder)
        self.assertEqual((code, err), (0, ""), out)
        self.assertRegex(out, r"paper .*\| 1000 \| 529 \| 616 \| 707 \| 92.6 %")
        rows = (self.folder / "timing" / "timing.csv").read_text().splitlines()
        self.assertEqual([row.split(",")[1] for row in rows[1:]], ["1000", "2000"])
        self.assertTrue((self.folder / "timing" / "figure.svg").exists())


class Pages(TemporaryFolder):
    """docs/experiments/ as `make experiments` writes it."""

    def test_a_run_refreshes_its_page(self):
        shutil.copy(PAGES / "door.md", self.folder)
        code, out, _ = run("experiment", "door", "--law", "both", "--out", self.folder / "out",
                           "--docs", self.folder, timeout=300)
        self.assertEqual(code, 0, out)
        names = sorted(path.name for path in PAGES.glob("door_*.csv"))
        self.assertEqual(sorted(path.name for path in self.folder.glob("door_*.csv")), names)
        self.assertEqual(len(names), 5)
        for name in ("door.md", *names):  # the same tables; their figures may differ
            rows = [re.findall(r"(?m)^(?:\| )?([^|,]*)(?: \||,)", (folder / name).read_text())
                    for folder in (self.folder, PAGES)]
            self.assertEqual(*rows)
            self.assertGreater(len(rows[0]), 4)

    def test_pages_have_figures(self):
        for page in ("cartesian", "excavator", "door", "path", "timing"):
            text = (PAGES / f"{page}.md").read_text()
            self.assertRegex(text, r"simulated|ours", page)
            self.assertTrue((PAGES / f"{page}.svg").exists(), page)


class Recordings(TemporaryFolder):
    def record(self, name, *options):
        code, out, err = run("run", *options, "--fast", "--recordings", self.folder / name)
        self.assertIn(code, (0, 1), out + err)
        return (self.folder / name / "latest.mcap").resolve()

    def test_compare_lists_what_changed(self):
        one = self.record("one", "door", "--duration", 6)
        two = self.record("two", "door", "--duration", 6, "--law", "paper", "--seed", 2)
        code, out, err = run("compare", one, two)
        self.assertEqual((code, err), (1, ""), out)
        self.assertRegex(out, r"options: none -> --seed 2 --law paper")
        self.assertRegex(out, r"different from cycle \d+ \([\d.]+ s\) on")
        self.assertRegex(out, r"t_[ab] \d+ ms (later|earlier)")
        self.assertRegex(out, r"(?m)^vibration +above 5 Hz [\d.]+ -> [\d.]+ m/s\^2 rms$")
        three = self.record("three", "door", "--duration", 4)
        code, out, _ = run("compare", one, three)
        self.assertEqual(code, 1)
        self.assertRegex(out, r"t_b \([\d.]+ s\) is missing in the second")

    def test_replay_runs_again_bit_for_bit(self):
        for options in (("door", "--duration", 3, "--law", "paper_bounds"),
                        ("door", "--duration", 2, "--plant", "ideal", "--rate-hz", 500)):
            code, out, err = run("replay", self.record(str(len(options)), *options))
            self.assertEqual((code, err), (0, ""), out)
            self.assertRegex(out, r"run again   \d+ cycles, the same bit for bit")

    def test_a_recording_of_any_scenario_is_complete(self):
        for scenario in sorted(pathlib.Path("models/scenarios").glob("*.yaml")):
            file = self.record(scenario.stem, scenario, "--duration", 0.8)
            code, out, err = run("replay", file)
            self.assertEqual((code, err), (0, ""), out)
            code, out, err = run("explain", file)
            self.assertEqual((code, err), (0, ""), out)
            self.assertNotIn("not understood", out)

    def test_replay_names_the_first_difference(self):
        file = self.record("one", "door", "--duration", 2)
        forged = self.folder / "forged.mcap"
        self.forge(file, forged)
        code, out, _ = run("replay", forged)
        self.assertEqual(code, 1, out)
        self.assertRegex(out, r"different from cycle \d+ \([\d.]+ s\) on: (command|record)\.[\w.]+.* "
                              r"was .* and is ")

    @staticmethod
    def forge(source, target):
        """The same recording with another spring of the door's lever in its configuration."""
        from mcap.reader import make_reader
        from mcap.writer import CompressionType, Writer
        with source.open("rb") as stream, target.open("wb") as out:
            reader = make_reader(stream)
            writer = Writer(out, compression=CompressionType.ZSTD)
            writer.start(profile="ros2", library="test")
            for attachment in reader.iter_attachments():
                data = attachment.data
                if attachment.name.endswith("twins/door/twin.yaml"):
                    data = data.replace(b"preload_Nm: 0.6", b"preload_Nm: 0.7")
                    assert data != attachment.data
                writer.add_attachment(attachment.create_time, attachment.log_time, attachment.name,
                                      attachment.media_type, data)
            channels = {}
            for schema, channel, message in reader.iter_messages(log_time_order=False):
                if channel.id not in channels:
                    schema_id = writer.register_schema(schema.name, schema.encoding, schema.data)
                    channels[channel.id] = writer.register_channel(
                        channel.topic, channel.message_encoding, schema_id)
                writer.add_message(channels[channel.id], message.log_time, message.data,
                                   message.publish_time, message.sequence)
            writer.finish()

    def test_plot_takes_any_device_and_several_recordings(self):
        devices = self.folder / "devices"
        shutil.copytree("tests/devices", devices)
        ur5 = next(pathlib.Path(".venv").glob("lib/python3*/site-packages/cmeel.prefix/share/"
                   "example-robot-data/robots/ur_description/urdf/ur5_robot.urdf")).read_text()
        (devices / "ur5/ur5_robot.urdf").write_text(ur5)
        fixed = '<joint name="world_joint" type="fixed">'
        self.assertIn(fixed, ur5)
        (devices / "ur5_rail/ur5_rail.urdf").write_text(ur5.replace(
            fixed, '<joint name="world_joint" type="prismatic"><axis xyz="0 1 0"/>'
            '<limit lower="-0.3" upper="0.3" velocity="1" effort="1"/>'))
        files = []
        for name in ("ur5", "ur5_rail"):
            files.append(self.record(name, devices / name / "scenario.yaml", "--duration", 1.5))
            code, out, err = run("plot", files[-1], "--out", self.folder / f"{name}_figures")
            self.assertEqual((code, err), (0, ""), out)
            for file in ("figure.svg", "figure.png", "signals.csv", "signals.npy", "run.json"):
                self.assertTrue((self.folder / f"{name}_figures" / file).exists(), file)
        code, out, err = run("plot", *files, "--out", self.folder / "both")
        self.assertEqual((code, err), (0, ""), out)
        self.assertTrue((self.folder / "both" / "figure.svg").exists())

    def test_what_is_no_recording_is_bad_input(self):
        file = self.folder / "x.mcap"
        file.write_text("no")
        for command in (("plot", file), ("compare", file, file), ("replay", file)):
            code, _, err = run(*command)
            self.assertEqual(code, 2, command)
            self.assertIn("must be a recording", err)


if __name__ == "__main__":
    unittest.main()
