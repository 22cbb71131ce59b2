"""Parts of `hapticgiant study` that need no program: orders, expressions, scores, faults of study.yaml."""

import collections
import contextlib
import fnmatch
import importlib.util
import io
import itertools
import json
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import unittest
import warnings
from unittest import mock

import numpy as np
import without_compiled_part  # noqa: F401
from hapticgiant.study import __main__ as study_command
from hapticgiant.study import (analysis, description, expressions, folder, inference, markers, order, people, planning,
                               questionnaires, trials)
from hapticgiant.sweep.reader import InputError

STUDY = """\
conditions:
  light: {twin.mass_scale: 1}
  heavy: {twin.mass_scale: 2}
fixed: {scenario: door}
design: {kind: within, order: williams, participants: 16}
questionnaires:
  tlx: {kind: nasa_tlx, weighted: true}
  sus: {kind: sus, after: end}
measures:
  peak_force_N: {}
  half: {expression: "max(robot.w_h[0]) / 2", unit: N}
exclusion:
  - {trial: peak_force_N > 1000, why: too strong}
analysis:
  tests: [{outcome: peak_force_N}]
simulation:
  hand:
    light: {"script.segments[0].fz_N": {mean: -30, sd: 2}}
  expected:
    peak_force_N: {light: 10, heavy: 11, between: 3, within: 1}
"""


def load(text):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "study.yaml"
        file.write_text(text)
        return description.load_study(file)


class Orders(unittest.TestCase):
    def test_latin_squares_have_each_condition_once_at_each_place(self):
        for count in range(2, 9):
            for rows in (order.latin_square(count), order.williams(count)):
                for line in rows:
                    self.assertEqual(sorted(line), list(range(count)))
                for column in zip(*rows):
                    self.assertEqual(len(set(collections.Counter(column).values())), 1)

    def test_in_a_williams_design_each_follows_each_equally_often(self):
        for count in range(2, 9):
            follows = collections.Counter(pair for row in order.williams(count) for pair in itertools.pairwise(row))
            self.assertEqual(len(follows), count * (count - 1))
            self.assertEqual(set(follows.values()), {1 + count % 2})

    def test_every_order_is_balanced_after_its_block(self):
        for kind, name in (("within", "latin_square"), ("within", "williams"), ("within", "full"),
                           ("within", "block_random"), ("between", "block_random")):
            for count in (2, 3, 4):
                design = description.Design(kind, name, 0, 1, 0, 5)
                design = description.Design(kind, name, 2 * order.rows_of(design, count), 1, 0, 5)
                rows = order.orders(design, count)
                if (kind, name) == ("within", "block_random"):  # of its places only the first is balanced
                    rows = [row[:1] for row in rows]
                self.assertEqual(order.imbalance(rows, count)[0], 0, name)

    def test_another_seed_gives_another_order(self):
        found = {str(order.orders(description.Design("within", "full", 24, 1, 0, seed), 4)) for seed in range(5)}
        self.assertEqual(len(found), 5)


class Expressions(unittest.TestCase):
    def value(self, text, **columns):
        columns = {name: np.array(values, float) for name, values in columns.items()}
        events = [(1.0, "checkpoint 1"), (3.5, "checkpoint 2")]
        return expressions.evaluate(expressions.parse(text), expressions.Trial(columns, events, {"a.b": 7}))

    def test_values(self):
        time = {"time_s": [0, 0.5, 1, 1.5, 2]}
        for text, wanted in (
                ("1 + 2 * 3 ** 2 - 8 / 4", 17), ("max(x) - min(x)", 4), ("rms(x - mean(x))", np.sqrt(2)),
                ("path_length(x, x * 0)", 4), ("integral(x)", 4), ("integral(x >= 2)", 1.25), ("max(derivative(x))", 2), ("duration()", 2),
                ("event('checkpoint 2') - first_event()", 2.5), ("events('checkpoint *')", 2), ("summary('a.b')", 7),
                ("count(x >= 2 and x < 4)", 2), ("norm(3, 4)", 5), ("spells(x > 3.5 or x < 0.5, 0.6)", 2),
                ("spells(x != 2, 1.1)", 1), ("last(x) % 3", 1)):
            self.assertAlmostEqual(self.value(text, x=[0, 1, 2, 3, 4], **time), wanted, 12, text)
        self.assertTrue(np.isnan(self.value("event('none')")))

    def test_the_time_of_a_task_that_was_not_completed_is_none(self):
        """The last event that came is not the end of the task: who fails early would look fast."""
        events, time = [(1.0, "opened"), (3.0, "passed")], expressions.parse(expressions.SHIPPED["time_s"][0])
        for missing, wanted, why in (([], 2, None), (["closed"], math.nan, "event 'closed' is missing"),
                                     (["locked", "closed"], math.nan, "event 'locked' is missing")):
            trial = expressions.Trial({}, events, {}, missing)
            np.testing.assert_equal(expressions.evaluate(time, trial), wanted)
            if why:
                self.assertEqual(expressions.why_no_number(time, trial), why)
        begun = expressions.Trial({}, [], {}, ["opened", "closed"])
        for text, why in (("first_event()", "event 'opened' is missing"), ("2 * event('closed')", "event 'closed' is missing"),
                          ("sqrt(0 - 1)", "its expression gives no number")):
            self.assertTrue(math.isnan(expressions.evaluate(expressions.parse(text), begun)), text)
            self.assertEqual(expressions.why_no_number(expressions.parse(text), begun), why)

    def test_nothing_else_of_python_can_be_written(self):
        for text in ("__import__('os')", "().__class__", "(lambda: 1)()", "[1][0]", "x if 1 else 2", "'a'", "f(x=1)",
                     "max(x, key=1)", "{1}", "x := 1", "max.__class__(1)", "open('a')", "1 if", "x[0:1]", "x['a']",
                     "event(x)", "True",
                     "max(x, x)", "sqrt(x, x)", "sum(abs(x, x))", "rms(x, x)", "+".join(["1"] * 900), "-" * 200 + "1", "(" * 400, "1j"):
            with self.assertRaises(expressions.ExpressionError, msg=text):
                self.value(text, x=[1])

    def test_huge_numbers_end_at_once(self):
        self.assertEqual(self.value("9 ** 9 ** 9"), np.inf)

    def test_columns_stay_as_they_were_recorded(self):
        columns = {name: np.array(values) for name, values in (("x", [-1.0, 2]), ("y", [0.0, 0]))}
        with self.assertRaisesRegex(expressions.ExpressionError, "abs: expected 1 argument, got 2"):
            expressions.evaluate(expressions.parse("max(abs(x, y))"), expressions.Trial(columns))
        np.testing.assert_array_equal(columns["y"], [0, 0])

    def test_a_sample_without_a_value_is_in_no_measure(self):
        """A comparison with it is not false, and it is not counted."""
        time = np.arange(6) / 10
        x = np.array([1.0, 2, np.nan, 4, 5, 6])
        trial = expressions.Trial({"time_s": time, "x": x, "inf": np.where(np.isnan(x), np.inf, x), "huge": np.full(6, 1e308)})
        for text in ("max(x)", "mean(x)", "sum(x)", "median(x)", "std(x)", "rms(x)", "count(x > 3)", "spells(x > 3, 0.1)",
                     "integral(x > 3)", "mean(not (x > 3))", "count(x > 3 and x < 5)", "count(x > 9 or x < 2)", "mean(x ** 0)",
                     "mean(x != 3)", "path_length(x)", "max(derivative(x))", "count(x)", "max(norm(x, x))"):
            self.assertTrue(math.isnan(expressions.evaluate(expressions.parse(text), trial)), text)
        for text in ("max(inf)", "mean(inf)", "sum(huge)", "mean(huge)", "rms(huge)", "std(huge)", "max(norm(huge))"):
            value = expressions.evaluate(expressions.parse(text), trial)
            self.assertFalse(math.isfinite(value), text)
            self.assertIsNone(json.loads(trials.dump({"a": value}))["a"])
        for text, value in (("count(inf > 3)", 4), ("first(x)", 1), ("count(time_s > 0.1 or x > 9)", 4),
                            ("count(time_s < 0.1 and x > 9)", 0), ("(3 > 1) + (3 > 2)", 2)):
            self.assertEqual(expressions.evaluate(expressions.parse(text), trial), value, text)
        for text in ("not (x > 3)", "x != 3", "x > 3 or not x"):
            self.assertFalse(expressions.is_true(text, {"x": math.nan, "code": 1}), text)
        self.assertTrue(expressions.is_true("x > 3 or code == 1", {"x": math.nan, "code": 1}))

    def test_a_value_per_sample_is_no_measure(self):
        with self.assertRaisesRegex(expressions.ExpressionError, "value per sample"):
            self.value("x + 1", x=[1, 2])
        with self.assertRaisesRegex(expressions.ExpressionError, "did you mean 'x'"):
            self.value("max(y)", x=[1, 2])


class Scores(unittest.TestCase):
    def test_sus(self):
        """Odd items count from 1, even ones to 5, times 2.5 (Brooke 1996)."""
        form = questionnaires.Form("sus", "end", questionnaires.sus_items(), {})
        self.assertEqual(questionnaires.scores_of(form, dict.fromkeys(form.items, 3)), {"score": 50})
        best = {name: 5 if i % 2 == 0 else 1 for i, name in enumerate(form.items)}
        self.assertEqual(questionnaires.scores_of(form, best), {"score": 100})

    def test_weighted_tlx(self):
        """Each scale wins over those behind it: weights 5 4 3 2 1 0 (Hart and Staveland 1988: sum / 15)."""
        form = load(STUDY).forms["tlx"]
        answers = dict(zip(form.items, (30, 15, 60, 40, 30, 45)))
        pairs = {f"{first}/{second}": first for first, second in form.pairs}
        self.assertEqual(len(pairs), 15)
        found = questionnaires.scores_of(form, answers, pairs)
        self.assertAlmostEqual(found["weighted"], (5 * 30 + 4 * 15 + 3 * 60 + 2 * 40 + 1 * 30) / 15)
        self.assertAlmostEqual(found["raw"], 220 / 6)


    def test_a_laboratory_has_its_own_words(self):
        own = "{item_02: {text: {de: Zu komplex.}}, item_03: {ends: [{de: nein}, {de: ja}]}}"
        changed = load(STUDY.replace("sus, after", f"sus, wording: {own}, after")).forms["sus"].items
        usual = load(STUDY).forms["sus"].items
        self.assertEqual(changed["item_02"].text, {"en": usual["item_02"].text["en"], "de": "Zu komplex."})
        self.assertEqual(changed["item_02"].ends, usual["item_02"].ends)
        self.assertEqual(changed["item_03"].ends, ({"en": "strongly disagree", "de": "nein"}, {"en": "strongly agree", "de": "ja"}))
        self.assertEqual({**changed, "item_02": 0, "item_03": 0}, {**usual, "item_02": 0, "item_03": 0})
        for old, new, message in (
                ("kind: sus", "kind: sus, wording: {item_2: {text: a}}", "did you mean 'item_02'"),
                ("kind: sus", "kind: sus, wording: {item_02: {texts: a}}", "did you mean 'text'"),
                ("kind: sus", "kind: sus, wording: {item_02: {ends: [a]}}", "expected two ends"),
                ("kind: sus", "kind: sus, items: {a: {kind: text, text: a}}", "'wording' changes their texts"),
                ("nasa_tlx, weighted: true", "nasa_tlx, wording: {mentale: {text: a}}", "did you mean 'mental'"),
                ("kind: nasa_tlx, weighted: true", "wording: {a: {text: a}}, items: {a: {kind: text, text: a}}",
                 "'wording' is for nasa_tlx and sus")):
            with self.assertRaisesRegex(InputError, f"study.yaml:[78]:.*{message}"):
                load(STUDY.replace(old, new))


class Power(unittest.TestCase):
    def test_is_that_of_the_formula(self):
        """R: power.t.test(n = 16, delta = 1, sd = sqrt(2), type = "paired")$power. Differences of two
        answers that deviate by 1 deviate by sqrt(2)."""
        found, = planning.power(load(STUDY), [16], 2000)
        share, low, high = found.by_count[16]
        self.assertEqual(found.test, "paired_t")
        self.assertLess(abs(share - 0.7529793), 0.03)
        self.assertLess(low, share)
        self.assertLess(abs(found.false_alarms[0] - 0.05), 0.016)

    def test_simulated_answers_stay_on_their_scale(self):
        study = load(STUDY)
        for code in ("P01", "P02", "P03"):
            answers, pairs = people.answers_of(study, code, "tlx", "light")
            self.assertEqual(answers, people.answers_of(study, code, "tlx", "light")[0])
            self.assertTrue(all(0 <= each <= 100 and each % 5 == 0 for each in answers.values()))
            self.assertEqual(len(pairs), 15)
            self.assertTrue(all(winner in pair.split("/") for pair, winner in pairs.items()))


class Faults(unittest.TestCase):
    def test_have_place_rule_and_nearest_name(self):
        for old, new, *messages in (
                ("max(robot", "open(robot", ":11:", "no such function as 'open'"),
                ("/ 2\"", "/ ().__class__\"", ":11:", "cannot be used here"),
                ("outcome: peak", "outcome: peek", ":15:", "did you mean 'peak_force_N'"),
                ("peak_force_N}]", "sus.score}]", ":15:", "asked once"),
                ("peak_force_N}]", "peak_force_N, test: kruskal}]", ":15:", "not for a design within"),
                ("williams", "wiliams", ":5:", "did you mean 'williams'"),
                ("participants: 16", "participants: 0", ":5:", "expected a whole number from 1"),
                ("participants: 16", f"participants: 1{'0' * 400}", ":5:", "expected a number"),
                ("between: 3", "between: 1e308", ":20:", "expected a number"),
                ("participants: 16", "participants: " + "[" * 10_000, "not valid YAML: nested too deeply"),
                ("trial: peak_force_N", "trial: peak", ":13:", "no such measure"),
                ("scenario: door", "scenari: door", ":4:", "did you mean 'scenario'"),
                ("scenario: door", "seed: 1", ":2:", "is drawn for each trial"),
                ("light: {\"script", "ligt: {\"script", ":18:", "did you mean 'light'"),
                ("peak_force_N: {light", "peak_force: {light", ":20:", "did you mean 'peak_force_N'"),
                ("nasa_tlx", "nasa_tls", ":7:", "did you mean 'nasa_tlx'"),
                ("peak_force_N: {}", "peak_force: {}", ":10:", "did you mean 'peak_force_N'"),
                ("trial: peak_force_N > 1000", "trial: duration() > 1", ":13:",
                 "duration() is of the samples of a trial: make it"),
                ("trial: peak_force_N > 1000", "trial: half - event('locked') > 1", ":13:", "event() is of the samples"),
                ("trial: peak_force_N > 1000", "trial: path_length(half)", ":13:", "exclusion.trial: path_length"),
                ("  half:", "  excluded:", ":11:", "is the name of a column of trials.csv"),
                ("  half:", "  recording_sha256:", ":11:", "is the name of a column of trials.csv"),
                ("  half:", "  tlx:", ":11:", "is the name of a questionnaire"),
                ("measures:", "measure:", ":9:", "did you mean 'measures'")):
            self.assertIn(old, STUDY)
            with self.assertRaises(InputError) as caught:
                load(STUDY.replace(old, new, 1))
            for message in ("study.yaml", *messages):
                self.assertIn(message, str(caught.exception))
            self.assertEqual(len(str(caught.exception).splitlines()), 1)

    def test_lab_streaming(self):
        def study(text):
            return load(STUDY + f"lab_streaming: {text}\n")

        self.assertEqual(load(STUDY).lab_streaming, description.LabStreaming(False, ()))
        self.assertEqual(study("{outlets: true, markers: [Eye Tracker, 'all', \"42\"]}").lab_streaming,
                         description.LabStreaming(True, ("Eye Tracker", "all", "42")))
        for text, message in (("{outlet: true}", "did you mean 'outlets'"), ("{outlets: tru}", "did you mean 'true'"),
                              ("{markers: Eye}", "lab_streaming.markers: expected a list"),
                              ("{markers: ['']}", "expected the name of a stream"),
                              ("{markers: [[a]]}", "expected the name of a stream"),
                              ("{markers: [a, a]}", "'a' is given twice"),
                              ("{markers: [HapticGiantEvents]}", "is sent by HapticGiant itself: outlets: true"),
                              ("[all]", "lab_streaming: expected a map")):
            with self.assertRaisesRegex(InputError, rf"study.yaml:21:\d+: .*{message}"):
                study(text)

    def test_markers_are_named_where_they_are_kept(self):
        for names, is_listed in (("[Eyes]", True), ("[]", False)):
            study = load(STUDY + f"lab_streaming: {{markers: {names}}}\n")
            with tempfile.TemporaryDirectory() as path:
                (there := folder.Folder(study, path)).tabulate()
                self.assertEqual("streams of other instruments, with their times: Eyes."
                                 in (there.path / "WHAT_IS_STORED.md").read_text(), is_listed)
                for column in markers.COLUMNS:
                    self.assertEqual(f"sub-*/*_markers,{column}," in (there.path / "data_dictionary.csv").read_text(), is_listed)

    def test_markers_become_files_of_their_trial_and_none_is_written_twice(self):
        study = load(STUDY)
        rows = [markers.Marker("Eyes", 12.5, "blink", -2.0, 1e-4), markers.Marker("Eyes", math.nan, "3 markers dropped")]
        with tempfile.TemporaryDirectory() as path:
            there, step = folder.Folder(study, path), planning.Step("trial", "light", 2)
            file = markers.write(there, "P01", step, rows, [(0.1, 10.0)])
            self.assertEqual(file.relative_to(path), pathlib.Path("sub-P01/sub-P01_task-light_run-2_markers.csv"))
            self.assertEqual(file.read_text(), "stream,lsl_time_s,clock_offset_s,offset_error_s,run_time_s,value\n"
                                               "Eyes,12.500000,-2.000000,0.000100,0.500000,blink\n"
                                               "Eyes,,,,,3 markers dropped\n")
            with self.assertRaisesRegex(folder.FolderError, "is there already"):
                markers.write(there, "P01", step, rows)
            between = [markers.write(there, "P01", None, rows[:1]) for _ in range(2)]
            self.assertEqual([each.name for each in between], ["sub-P01_run-1_markers.csv", "sub-P01_run-2_markers.csv"])
            self.assertIn(",0.000100,,blink\n", between[0].read_text())

    def test_a_measure_without_a_value_leaves_no_trial_out(self):
        study = load(STUDY.replace("trial: peak_force_N > 1000", "trial: peak_force_N - half"))
        self.assertEqual(trials.excluded(study, {"peak_force_N": 2.0, "half": 1.0}, 0), "too strong")
        self.assertEqual(trials.excluded(study, {"peak_force_N": None, "half": 1.0}, 0), "")
        self.assertEqual(trials.excluded(study, {"peak_force_N": 1.0, "half": 1.0}, 0), "")

    def test_the_columns_of_trials_are_those_that_no_measure_may_have(self):
        study = load(STUDY)
        with tempfile.TemporaryDirectory() as path:
            there = folder.Folder(study, path)
            (pathlib.Path(path) / "sub-P01").mkdir()
            (pathlib.Path(path) / "sub-P01" / "a_trial.json").write_text(trials.dump({
                "position": 1, "condition": "light", "repetition": 1, "measures": dict.fromkeys(study.measures, 1.0),
                "exit_code": 0, "state_hash": "", "recording_sha256": "", "recording": None}))
            self.assertEqual(set(there.rows()["trials"][0]), {*description.TRIAL_COLUMNS, *study.measures})

    def answered(self, path):
        """The file of a study, whose folder beside it has the forms of two people."""
        file = pathlib.Path(path) / "study.yaml"
        file.write_text(STUDY)
        there = folder.Folder(study := description.load_study(file))
        there.begin("1", True)
        for code in ("P01", "P02"):
            for step in planning.steps(study, planning.Participant(code, ("light", "heavy"))):
                if step.kind == "form":
                    answers, pairs = people.answers_of(study, code, step.form, step.condition)
                    there.write(there.file_of(code, step), trials.dump({
                        "condition": step.condition, "form": step.form, "answers": answers, "pairs": pairs}))
        there.tabulate()
        there._lock.close()
        return file

    def test_bids_ignores_every_file_that_it_does_not_know(self):
        with tempfile.TemporaryDirectory() as path:
            out = self.answered(path).with_suffix(".study")
            for name in ("sub-P01/sub-P01_task-light_run-1_recording.mcap", "sub-P01/sub-P01_task-light_run-1_trial.json",
                         "sub-P01/sub-P01_run-1_markers.csv", "withdrawn.json", "report.tex", "report.html"):
                (out / name).write_text("")
            ignored = (out / ".bidsignore").read_text().splitlines()
            for file in out.rglob("*"):
                if file.is_file() and not file.name.startswith("."):
                    self.assertNotEqual(any(fnmatch.fnmatch(file.name, each) for each in ignored),
                                        file.name in ("README.md", "dataset_description.json"), file)
            described = json.loads((out / "dataset_description.json").read_text())
            self.assertTrue({"Name", "BIDSVersion", "DatasetType", "GeneratedBy"} <= set(described))

    def test_one_is_forgotten_although_the_study_has_changed(self):
        with tempfile.TemporaryDirectory() as path:
            file = self.answered(path)
            out = file.with_suffix(".study")
            partial, running = out / "sub-P02" / ".sub-P01_trial.json.77", out / ".running" / "3" / "P01"
            running.mkdir(parents=True)
            partial.write_text("")
            for old, new in (("  tlx: {kind: nasa_tlx, weighted: true}\n", ""), ("kind: within", "kind: wthin")):
                file.write_text(STUDY.replace(old, new))
                there = folder.Folder.as_it_was(file, None)
                self.assertEqual(there.forget("P01"), 3 if new == "" else 0)  # the second time it finishes
                self.assertEqual(there.notes, [])
                self.assertNotIn("P01,", (out / "answers.csv").read_text())
                self.assertIn("P02,light,tlx", (out / "answers.csv").read_text())
                self.assertFalse(partial.exists() or running.exists() or (out / "sub-P01").exists())
                (out / "answers.csv").write_text("P01,")

    def test_one_is_forgotten_although_the_folder_is_damaged(self):
        def refused(out):
            (out / "study.yaml").write_text(STUDY.replace("kind: within", "kind: wthin"))

        def no_text(out):
            (out / "study.yaml").write_bytes(b"\xff\x00")

        def edited(out):
            (out / "study.yaml").write_text(STUDY.replace("participants: 16", "participants: 8"))

        def no_description(out):
            (out / "dataset_description.json").write_text("{")

        def answer(out):
            next((out / "sub-P02").glob("*.json")).write_text("{}")

        def trial(out):
            (out / "sub-P02" / "sub-P02_task-light_run-1_trial.json").write_text("[1]")

        def table(out):
            refused(out)
            (out / "answers.csv").write_bytes(b"participant\nP01\n\xff")

        for damage, note in ((refused, "did you mean 'within'"), (no_text, "cannot be read"), (edited, "holds another study"),
                             (no_description, "dataset_description.json: is damaged"), (answer, "'condition' is missing"), (trial, "_trial.json: is damaged"), (table, "answers.csv is deleted")):
            with tempfile.TemporaryDirectory() as path, self.subTest(damage.__name__):
                file = self.answered(path)
                out = file.with_suffix(".study")
                for name in ("report.html", "trials.parquet"):
                    (out / name).write_text("P01")
                damage(out)
                there = folder.Folder.as_it_was(file, None)
                with self.assertRaisesRegex(folder.FolderError, "did you mean 'P02'"):
                    there.forget("P22")
                there = folder.Folder.as_it_was(file, None)
                self.assertEqual(there.forget("P01"), 3)
                self.assertIn(note, " ".join(there.notes))
                self.assertIn("tables are not made anew", there.notes[-1])
                for each in out.rglob("*"):
                    self.assertFalse("sub-P01" in str(each) or each.suffix == ".parquet" or each.name == "report.html", each)
                    if each.is_file() and each.name != "withdrawn.json":
                        self.assertNotIn(b"P01", each.read_bytes().replace(b"(P01 ...)", b""), each)
                self.assertIn("P02,", (out / "participants.csv").read_text())
                self.assertEqual(there.withdrawn(), ["P01"])
                lines = (out / "hashes.sha256").read_text().splitlines()
                self.assertEqual({line.split("  ")[1] for line in lines},
                                 {str(each.relative_to(out)) for each in out.rglob("*")
                                  if each.is_file() and not each.name.startswith(".") and each.name != "hashes.sha256"})

    def said(self, *words):
        """The exit code of `hapticgiant study`, and what it says on its standard error."""
        said, mask, handler = io.StringIO(), os.umask(0o077), signal.getsignal(signal.SIGTERM)
        try:
            with contextlib.redirect_stderr(said), contextlib.redirect_stdout(io.StringIO()):
                return study_command.main([str(word) for word in words]), said.getvalue()
        finally:
            os.umask(mask)
            signal.signal(signal.SIGTERM, handler)

    def test_a_damaged_file_is_named_in_one_sentence(self):
        damages = (b"", b'{"condition": "li', b"[]", b"null", b"NaN", b"3", b"[" * 100_000, b'{"a":' * 100_000, b"\xff\xfe{}",
                   b"[1, {}, null]")
        with tempfile.TemporaryDirectory() as path:
            file = self.answered(path)
            out = file.with_suffix(".study")
            self.trial(out / "sub-P01" / "sub-P01_task-light_run-1_trial.json")
            (out / "sub-P01" / "sub-P01_note-1.json").write_text('{"step": 1, "text": "a remark"}')
            there = folder.Folder(description.load_study(file))
            for name in ("dataset_description.json", "withdrawn.json", "sub-P01/sub-P01_task-light_run-1_trial.json",
                         "sub-P01/sub-P01_task-light_form-tlx_answers.json"):
                before = (out / name).read_bytes() if (out / name).exists() else None
                for damage in damages:
                    if name == "withdrawn.json" and damage == b"[]":
                        continue
                    (out / name).write_bytes(damage)
                    code, said = self.said("report", file)
                    self.assertEqual((code, said.count("\n")), (2, 1), (name, damage[:20], said[-300:]))
                    self.assertIn(f"{pathlib.Path(name).name}: is damaged", said)
                (out / name).unlink() if before is None else (out / name).write_bytes(before)
            for damage in damages:
                (out / "sub-P01" / "sub-P01_note-1.json").write_bytes(damage)
                self.assertRaisesRegex(folder.FolderError, "note-1.json: is damaged", there.remarks, "P01")
            self.assertEqual(self.said("report", file)[0], 0)

    def trial(self, file, **other):
        """Writes the file of a trial, with these keys instead."""
        file.write_text(json.dumps({
            "position": 1, "condition": "light", "repetition": 1, "measures": {"peak_force_N": 1.0, "half": 2.0},
            "exit_code": 0, "state_hash": "", "recording_sha256": "", "recording": None} | other))

    def test_a_value_that_no_file_of_ours_has_is_damage(self):
        with tempfile.TemporaryDirectory() as path:
            file = self.answered(path)
            out = file.with_suffix(".study")
            there = folder.Folder(description.load_study(file))
            own = out / "sub-P01" / "sub-P01_task-light_run-1_trial.json"
            for other in ({"position": None}, {"position": 10**400}, {"exit_code": "0"}, {"condition": "none"}, {"measures": []},
                          {"measures": {"peak_force_N": 1.0}}, {"measures": {"peak_force_N": math.inf, "half": 1.0}},
                          {"measures": {"peak_force_N": "1", "half": 1.0}}, {"measures": {"peak_force_N": 10**400, "half": 1}},
                          {"recording": 3}, {"state_hash": {}}, {"missing_events": {}}, {"missing_events": [1]},
                          {"no_value": []}, {"no_value": {"half": 1}}):
                self.trial(own, **other)
                with self.assertRaisesRegex(folder.FolderError, "run-1_trial.json: is damaged", msg=other):
                    there.rows()
            self.trial(own, measures={"peak_force_N": None, "half": 1.0})
            self.assertIsNone(there.rows()["trials"][0]["peak_force_N"])
            form = out / "sub-P01" / "sub-P01_task-light_form-tlx_answers.json"
            filled = json.loads(form.read_text())
            for other in ({"form": "none"}, {"condition": "none"}, {"answers": {}}, {"pairs": {}},
                          {"answers": {**filled["answers"], "mental": 1e999}}):
                form.write_text(json.dumps(filled | other))
                self.assertRaisesRegex(folder.FolderError, "tlx_answers.json: is damaged", there.rows)
            form.write_text(json.dumps(filled))
            said = json.loads((out / "dataset_description.json").read_text())
            for other in ({"Simulated": {}}, {"Study": None}, {"Model": 3}, {"GeneratedBy": []}, {"GeneratedBy": [{}]}):
                (out / "dataset_description.json").write_text(json.dumps(said | other))
                self.assertRaisesRegex(folder.FolderError, "description.json: is damaged", there.description)

    def test_the_analysis_alone_names_what_is_damaged_and_what_is_missing(self):
        with tempfile.TemporaryDirectory() as path:
            file = self.answered(path)
            out = file.with_suffix(".study")
            for person in ("P01", "P02"):
                for condition in ("light", "heavy"):
                    self.trial(out / f"sub-{person}" / f"sub-{person}_task-{condition}_run-1_trial.json", condition=condition)
            self.assertEqual(self.said("report", file)[0], 0)
            trials_csv, plan = (out / name for name in ("trials.csv", "code/plan.json"))
            table, planned = trials_csv.read_text(), plan.read_text()
            first = "P01,1,heavy,1,time,,,,1.0,2.0"
            self.assertIn(first, table)

            for cell in ("nan", "inf", "-inf", "1e308", "1e999", ""):
                trials_csv.write_text(table.replace(first, f"P01,1,heavy,1,time,,,,{cell},2.0"))
                data = analysis.Data(out)
                self.assertIn(["P01", "heavy 1", "peak_force_N has no value" + (f": {cell}" if cell else "")],
                              analysis.exclusion_rows(data))
                self.assertIn(["peak_force_N", "heavy", "1", "1"], [row[:4] for row in analysis.description_rows(data)])
            word = table.replace(first, f"{first[:-7]}one,2.0")
            for file, damages in ((trials_csv, ("participant\nP01\n", word, table[:-20], "\0")),
                                  (plan, ("", "[]", "{}", "[" * 100_000, planned.replace('"paired_t"', "3"), planned[:99]))):
                for damage in damages:
                    self.assertNotIn(damage, (table, planned))
                    file.write_text(damage)
                    with self.assertRaisesRegex(analysis.UnreadableError, file.name, msg=damage[:40]):
                        analysis.tests(analysis.Data(out))
                trials_csv.write_text(table)
            done = subprocess.run([sys.executable, out / "code" / "analysis.py"], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (1, "", 1), done.stderr)

    def failing(self, path):
        """A study of two people who did both conditions; P01 did not complete heavy."""
        file = self.answered(path)
        for person in ("P01", "P02"):
            for condition in ("light", "heavy"):
                fails = (person, condition) == ("P01", "heavy")
                self.trial(file.with_suffix(".study") / f"sub-{person}" / f"sub-{person}_task-{condition}_run-1_trial.json",
                           condition=condition, measures={"peak_force_N": 1.0, "half": None if fails else 2.0},
                           missing_events=["opened", "closed"] if fails else [],
                           no_value={"half": "event 'opened' is missing"} if fails else {})
        return file, file.with_suffix(".study")

    def test_trials_without_a_value_are_counted_with_their_reason(self):
        with tempfile.TemporaryDirectory() as path:
            file, out = self.failing(path)
            file.write_text(file.read_text().replace("[{outcome: peak_force_N}]", "[{outcome: peak_force_N}, {outcome: half}]"))
            shutil.copy(file, out / "study.yaml")
            there = json.loads((out / "dataset_description.json").read_text())
            study = description.load_study(file)
            (out / "dataset_description.json").write_text(json.dumps(there | {"Study": study.digest()}))
            self.assertEqual(self.said("report", file)[0], 0)
            data = analysis.Data(out)
            row, = (row for row in data.trials if row["events_missing"])
            self.assertEqual((row["half"], row["events_missing"], row["no_value"]),
                             ("", "opened; closed", "half: event 'opened' is missing"))
            self.assertIn(["P01", "heavy 1", "half has no value: event 'opened' is missing"], analysis.exclusion_rows(data))
            self.assertEqual(analysis.trial_rows(data)[1:], [["light", "2", "0", "2", "0", "0"],
                                                             ["heavy", "2", "0", "2", "1", "half 1"]])
            self.assertEqual(analysis.missing_words(data, "half"), "without a value: 0 of 2 trials of light, 1 of 2 trials of "
                                                                   "heavy; the others are compared")
            self.assertEqual(analysis.missing_words(data, "peak_force_N"), "")
            self.assertIn("half 1", (out / "report.html").read_text())

    def test_who_has_withdrawn_is_counted_and_not_named(self):
        with tempfile.TemporaryDirectory() as path:
            file, out = self.failing(path)
            self.assertEqual(self.said("forget", "P02", file)[0], 0)
            self.assertEqual(self.said("report", file)[0], 0)
            rows = dict(analysis.participant_rows(analysis.Data(out))[1:])
            self.assertEqual([rows[name] for name in ("planned", "have begun", "have withdrawn; their data are deleted", "count")],
                             ["16", "2", "1", "1"])
            self.assertIn("1 of 2 participants count (16 were planned, 1 withdrew)", (out / "report.html").read_text())
            self.assertNotIn("P02", (out / "report.html").read_text())

    def test_a_report_has_a_figure_of_each_scale_and_words_about_no_other(self):
        from hapticgiant.study import report

        items = ("  own: {items: {real: {kind: likert, points: 7, text: Real}, safe: {kind: likert, points: 7, text: Safe}, "
                 "far: {kind: slider, from: 0, to: 50, text: How far}, said: {kind: text, text: What}}}\n")
        study = load(STUDY.replace("measures:\n", items + "measures:\n"))
        scales = report.scales_of(study)
        self.assertEqual([each.outcomes[-1] for each in scales],
                         ["tlx.frustration", "sus.score", "own.safe", "own.far", "peak_force_N", "half"])
        self.assertEqual([each.ends for each in scales[:4]], [(0, 100), (0, 100), (1, 7), (0, 50)])
        with tempfile.TemporaryDirectory() as path:
            for words, has_tlx, has_sus in ((STUDY, True, True), (STUDY.replace("  sus: {kind: sus, after: end}\n", ""), True, False),
                                            (STUDY.replace("  tlx: {kind: nasa_tlx, weighted: true}\n", ""), False, True)):
                about = " ".join(each.about for each in report.scales_of(load(words)))
                self.assertEqual(("TLX" in about, "SUS" in about), (has_tlx, has_sus))
            file, out = self.failing(path)
            self.assertEqual(self.said("report", file)[0], 0)
            page = (out / "report.html").read_text()
            self.assertEqual(page.count("<svg"), 4)  # TLX, SUS, two measures
            ids = re.findall(r'\bid="([^"]+)"', page)
            self.assertEqual(len(ids), len(set(ids)))

    def test_links_and_pipes_of_a_folder_from_elsewhere_lead_nowhere(self):
        def link(out, name, target):
            folder_there = out / name
            if folder_there.is_dir():
                shutil.rmtree(folder_there)
            folder_there.unlink(missing_ok=True)
            folder_there.symlink_to(target)

        def pipe(out, name, _):
            (out / name).unlink(missing_ok=True)
            os.mkfifo(out / name)

        with tempfile.TemporaryDirectory() as path:
            file = self.answered(path)
            out, victim, elsewhere = file.with_suffix(".study"), pathlib.Path(path) / "victim", pathlib.Path(path) / "else"
            elsewhere.mkdir()
            (elsewhere / "kept").write_text("kept")
            for name, damage, use in ((".lock", link, "forget"), (".lock", pipe, "forget"), (".tables", link, "tabulate"),
                                      (".tables", pipe, "tabulate"), ("code", link, "write"), (".running", link, "forget"),
                                      ("sub-P01", link, "forget")):
                with self.subTest(name=name, damage=damage.__name__):
                    victim.write_text("kept")
                    damage(out, name, victim if name.startswith((".lock", ".tables")) else elsewhere)
                    there = folder.Folder.as_it_was(file, None)
                    uses = {"forget": lambda: there.forget("P01"), "tabulate": there.tabulate,
                            "write": lambda: there.replace(out / "code" / "analysis.py", "")}
                    if name in (".running", "sub-P01"):  # the link goes, and all else stays
                        uses[use]()
                        self.assertFalse((out / name).is_symlink())
                    else:
                        with self.assertRaisesRegex(folder.FolderError, f"{name}: "):
                            uses[use]()
                        (out / name).unlink()
                    self.assertEqual(victim.read_text(), "kept")
                    self.assertEqual([each.name for each in elsewhere.iterdir()], ["kept"])

    def test_what_people_did_is_for_one_user(self):
        with tempfile.TemporaryDirectory() as path:
            out = self.answered(path).with_suffix(".study")
            for each in [out, *out.rglob("*")]:
                self.assertEqual(each.stat().st_mode & 0o077, 0, each)

    def test_a_folder_that_is_none_is_left_alone(self):
        with tempfile.TemporaryDirectory() as path:
            file = pathlib.Path(path) / "study.yaml"
            file.write_text("a: b")
            (pathlib.Path(path) / "study.study").mkdir()
            with self.assertRaises(InputError):
                folder.Folder.as_it_was(file, None)
            file.write_text(STUDY)
            with self.assertRaisesRegex(folder.FolderError, "holds no study"):
                folder.Folder.as_it_was(file, None).forget("P01")
            self.assertEqual(list((pathlib.Path(path) / "study.study").iterdir()), [])

    @unittest.skipUnless(importlib.util.find_spec("jinja2") and importlib.util.find_spec("matplotlib"), "needs jinja2")
    def test_a_report_has_no_person_who_was_forgotten_while_it_was_made(self):
        from hapticgiant.study import report

        with tempfile.TemporaryDirectory() as path:
            file = self.answered(path)
            out = file.with_suffix(".study")
            there = folder.Folder(description.load_study(file))
            playing = folder.Folder(there.study)
            playing._take()  # a study that runs
            report.write(there)
            with self.assertRaisesRegex(folder.FolderError, "another program is writing"):
                folder.Folder.as_it_was(file, None).forget("P01")
            playing._lock.close()
            drawn = report.boxes

            def forget(*words):
                folder.Folder.as_it_was(file, None).forget("P01")
                return drawn(*words)

            with mock.patch.object(report, "boxes", forget):
                with self.assertRaisesRegex(folder.FolderError, "somebody has been forgotten meanwhile"):
                    report.write(there)
            self.assertFalse((out / "report.html").exists() or (out / "report.tex").exists())
            self.assertNotIn("P01,", (out / "answers.csv").read_text())
            report.write(there)
            self.assertNotIn("P01,", (out / "answers.csv").read_text())

    def test_tables_are_written_by_one_at_a_time(self):
        with tempfile.TemporaryDirectory() as path:
            file = self.answered(path)
            first, second = (folder.Folder(description.load_study(file)) for _ in range(2))
            done = []
            with first.writing_tables():
                first.tabulate()  # its own thread may
                thread = threading.Thread(target=lambda: done.append(second.tabulate()))
                thread.start()
                thread.join(0.3)
                self.assertEqual(done, [])
            thread.join(20)
            self.assertEqual(len(done), 1)

    def test_who_has_withdrawn_is_in_no_table_whatever_a_crash_has_left(self):
        with tempfile.TemporaryDirectory() as path:
            there = folder.Folder(description.load_study(self.answered(path)))
            there.replace(there.path / folder.WITHDRAWN, '["P01"]')
            there.tabulate()
            self.assertNotIn("P01,", (there.path / "answers.csv").read_text())

    def test_carry_over_is_reported_as_a_count(self):
        text = STUDY.replace("  heavy:", "  middle: {twin.mass_scale: 1.5}\n  heavy:").replace("order: williams", "order: latin_square")
        text = text.replace("{light: 10,", "{light: 10, middle: 10,").replace("participants: 16", "participants: 3")
        self.assertRegex(planning.notes_of(load(text))[0], "^one condition follows another 2 times more often than it follows a third")

    def test_an_index_beyond_the_end_of_a_column(self):
        known = {"robot.w_h": True, "joint.q": True, "cycle": False}
        trials.require_columns(load(STUDY.replace("  peak_force_N: {}\n", "  peak_force_N: {}\n  q: {expression: 'max(joint.q[6])'}\n"
                                                  )), known)
        for column, message in (("robot.w_h[6]", "the indices 0 to 5"), ("robot.w_h", "as 'robot.w_h[0]'"),
                                ("cycle[0]", "without an index"), ("robot.w_j[0]", "did you mean 'robot.w_h'")):
            with self.assertRaisesRegex(InputError, f":11:.*measures.half: .*{re.escape(message)}"):
                trials.require_columns(load(STUDY.replace("robot.w_h[0]", column)), known)

    def test_too_few_people_for_ranks(self):
        ranks = STUDY.replace("outcome: peak_force_N}", "outcome: peak_force_N, test: wilcoxon}")
        fewest = ranks.replace("participants: 16", "participants: 6")
        self.assertEqual(planning.problems_of(load(fewest)), [])  # 2 / 2^6 < 0.05
        self.assertIn("peak_force_N: signed ranks of 6 people cannot give p below 0.03125", planning.problems_of(
            load(fewest.replace("analysis:", "analysis:\n  alpha: 0.01"))))
        groups = ranks.replace("within, order: williams, participants: 16", "between, participants: 6")
        groups = groups.replace("wilcoxon", "mann_whitney").replace("sus, after: end", "sus")
        self.assertIn("peak_force_N: ranks of 6 people cannot give p below 0.1", planning.problems_of(load(groups)))

    def test_power_of_too_few_people_warns_of_nothing(self):
        groups = STUDY.replace("within, order: williams, participants: 16", "between, participants: 2")
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertEqual(planning.power(load(groups), [2], 10)[0].by_count[2][0], 0)

    def test_conditions_that_are_the_same(self):
        self.assertIn("conditions light and heavy are the same",
                      planning.problems_of(load(STUDY.replace("scale: 2", "scale: 1"))))


class Run(unittest.TestCase):
    """Parts of `study run` that need no run."""

    def test_a_run_that_was_ended_has_the_exit_code_of_one_that_was_not(self):
        from hapticgiant.study.conductor import exit_code_of

        good = {"missing_events": [], "limits_held": True, "shaking": {"duration_s": 0.0}}
        self.assertEqual(exit_code_of(good, 0), 0)
        self.assertEqual(exit_code_of(good, 3), 3)
        for bad in ({"missing_events": ["opened"]}, {"limits_held": False}, {"shaking": {"duration_s": 0.4}}):
            self.assertEqual(exit_code_of(good | bad, 0), 1, bad)

    def test_the_request_of_a_trial_has_the_options_of_the_study(self):
        study = load(STUDY.replace("{scenario: door}", "{scenario: door, duration_s: 3, rate_Hz: 500, hand: stiff}"))
        self.assertEqual(study.request("heavy"), {"scenario": "door", "duration": 3, "rate_hz": 500, "hand": "stiff",
                                                  "set": ["twin.mass_scale=2"]})

    def test_a_form_that_is_not_whole_has_a_problem(self):
        from hapticgiant.study import questionnaires

        form = questionnaires.Form("nasa_tlx", "condition", questionnaires.tlx_items(), {}, (("mental", "physical"),))
        whole = dict.fromkeys(form.items, 50)
        self.assertIsNone(questionnaires.problem_of(form, whole, {"mental/physical": "mental"}))
        for answers, pairs in ((whole, {}), (whole, {"mental/physical": "effort"}), (whole | {"mental": 51}, {"mental/physical": "mental"}),
                               (whole | {"mental": True}, {"mental/physical": "mental"}),
                               (whole | {"mental": float("nan")}, {"mental/physical": "mental"}),
                               (whole | {"else": 1}, {"mental/physical": "mental"})):
            self.assertIsNotNone(questionnaires.problem_of(form, answers, pairs), (answers, pairs))


if __name__ == "__main__":
    unittest.main()
