"""study.yaml: what a user study consists of. docs/start/user_studies_reference.md."""

from __future__ import annotations

import dataclasses
import hashlib
import math
import os
import pathlib
import re

from hapticgiant.study import expressions, order, questionnaires
from hapticgiant.sweep.reader import Placed, Reader, InputError, arguments_of, nearest, request_of, value_of

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
LABEL = re.compile(r"[A-Za-z][A-Za-z0-9]*")  # in names of files, where _ separates
LANGUAGES = ("en", "de", "fr", "es", "it", "nl", "pt", "ja", "zh", "ko")
TESTS = ("auto", "paired_t", "wilcoxon", "friedman", "mixed", "welch_t", "mann_whitney", "anova",
         "kruskal")
WITHIN_TESTS, BETWEEN_TESTS = TESTS[1:5], TESTS[5:]
TWO_CONDITIONS = ("paired_t", "wilcoxon", "welch_t", "mann_whitney")
TRIAL_COLUMNS = ("participant", "position", "condition", "repetition", "ended_by", "excluded", "events_missing",
                 "no_value", "exit_code", "state_hash", "recording_sha256", "recording")
"""Columns of trials.csv beside the measures."""
CORRECTIONS = ("holm", "bonferroni", "none")
OWN_STREAMS = ("HapticGiant", "HapticGiantEvents", "HapticGiantStudy")
"""Of the Lab Streaming Layer, which we send."""
ALL_STREAMS = "all"


@dataclasses.dataclass(frozen=True)
class Condition:
    """One condition: its name, what `hapticgiant run` is told, what the simulated hand is told."""

    name: str
    options: dict[str, str]
    hand: dict[str, tuple[float, float]]
    """KEY: mean and standard deviation between simulated people."""


@dataclasses.dataclass(frozen=True)
class Design:
    """Who plays what in which order."""

    kind: str
    order: str
    participants: int
    repetitions: int
    practice: int
    seed: int


@dataclasses.dataclass(frozen=True)
class Measure:
    """A number per trial."""

    name: str
    expression: str
    unit: str
    what: str


@dataclasses.dataclass(frozen=True)
class Exclusion:
    """A trial, or all of a participant, that is left out where the expression is true."""

    kind: str
    expression: str
    why: str


@dataclasses.dataclass(frozen=True)
class Test:
    """A planned test of an outcome between the conditions."""

    outcome: str
    test: str


@dataclasses.dataclass(frozen=True)
class Expected:
    """What simulated people are given: mean by condition, spread between and within people."""

    means: dict[str, float]
    between: float
    within: float


@dataclasses.dataclass(frozen=True)
class LabStreaming:
    """What goes to and comes from the Lab Streaming Layer."""

    outlets: bool = False
    """Whether the study and its runs send streams."""
    markers: tuple[str, ...] = ()
    """Names of streams whose markers are kept; ALL_STREAMS: every marker stream but our own."""


@dataclasses.dataclass
class Study(Placed):
    """What load_study() returns."""

    file: pathlib.Path
    title: str
    fixed: dict[str, str]
    conditions: dict[str, Condition]
    design: Design
    instructions: dict[str, dict[str, str]]
    forms: dict[str, questionnaires.Form]
    breaks: tuple[int, float]
    """After how many conditions, and how long, min; (0, 0): none."""
    longest_s: float
    """A trial of a real person ends after this time, s."""
    pause_s: float | None
    """It ends so long after the last event of its task, s; None: when the operator says so."""
    exclusions: list[Exclusion]
    measures: dict[str, Measure]
    alpha: float
    correction: str
    tests: list[Test]
    expected: dict[str, Expected]
    simulation_seed: int
    places: dict[str, str]
    lab_streaming: LabStreaming = LabStreaming()

    @property
    def outcomes(self) -> dict[str, str]:
        """Everything that can be tested, by name: what it is."""
        found = {name: measure.what for name, measure in self.measures.items()}
        for name, form in self.forms.items():
            found |= {f"{name}.{score}": what for score, what in form.scores.items()}
        return found

    @property
    def languages(self) -> list[str]:
        """Languages in which a participant can be spoken to: of the texts, and those of the shipped forms."""
        texts = [*self.instructions.values(), *(item.text for form in self.forms.values() for item in form.items.values()
                                                if form.kind == "own")]
        found = [language for language in LANGUAGES if any(language in text for text in texts)]
        return found or ["en", "de"]

    def arguments(self, condition: str, hand: dict[str, str] | None = None) -> list[str]:
        """The words after `hapticgiant run` for a trial."""
        options = {**self.fixed, **self.conditions[condition].options, **(hand or {})}
        return arguments_of(options, self.file.parent)

    def request(self, condition: str) -> dict:
        """The request of a trial with a person: docs/reference/run_protocol.md."""
        return request_of({**self.fixed, **self.conditions[condition].options}, self.file.parent)

    def digest(self) -> str:
        """Differs where anything of the study differs."""
        return hashlib.sha256(self.file.read_bytes()).hexdigest()[:16]


def load_study(file: str | os.PathLike) -> Study:
    """The study of a file. Raises InputError with place, rule and nearest name."""
    return _Reader(file).study()


class _Reader(Reader):
    def study(self):
        parts = self.map(root := self.root(), "", (
            "title", "fixed", "conditions", "design", "trial", "instructions", "questionnaires", "breaks",
            "exclusion", "measures", "analysis", "simulation", "lab_streaming"))
        for needed in ("conditions", "design"):
            if needed not in parts:
                self.fault(root, "", f"key '{needed}' is missing")
        fixed = {key: self.words(node) for key, node in self.keys(parts.get("fixed")).items()}
        simulation = self.optional_map(parts, "simulation", ("seed", "hand", "expected"))
        conditions = self.conditions(parts["conditions"], fixed, simulation.get("hand"))
        design = self.design(parts["design"], conditions)
        forms = {name: questionnaires.read_form(self, name, node) for name, node
                 in self.names(parts.get("questionnaires"), "questionnaires")}
        measures = self.measures(parts.get("measures"), forms)
        instructions = {name: self.texts(node, f"instructions.{name}") for name, node
                        in self.names(parts.get("instructions"), "instructions")}
        for name, node in self.names(parts.get("instructions"), "instructions"):
            if name not in (known := ["start", "end", "practice", "break", *conditions]):
                self.fault(node, f"instructions.{name}",
                           f"no such moment, did you mean '{nearest(name, known)}'?")
        pause = self.optional_map(parts, "breaks", ("after_conditions", "minutes"))
        analysis = self.optional_map(parts, "analysis", ("alpha", "correction", "tests"))
        alpha = self.within(analysis, "alpha", "analysis", 0.05, 0, 1)
        correction = self.choice(analysis, "correction", "analysis", CORRECTIONS, "holm")
        title = parts.get("title")
        study = Study(
            self.file, self.words(title) if title else self.file.stem, fixed, conditions, design,
            instructions, forms,
            (self.count(pause["after_conditions"], "breaks.after_conditions"),
             self.within(pause, "minutes", "breaks", 2, 0, 600)) if "after_conditions" in pause
            else (0, 0.0),
            *self.trial(parts), [], measures, alpha, correction, [], {},
            self.count(simulation["seed"], "simulation.seed") if "seed" in simulation else 1,
            self.places, self.lab_streaming(parts))
        study.exclusions = self.exclusions(parts.get("exclusion"), study)
        study.tests = self.tests(analysis.get("tests"), study)
        study.expected = self.expected(simulation.get("expected"), study)
        return study

    def lab_streaming(self, parts):
        known = self.optional_map(parts, "lab_streaming", ("outlets", "markers"))
        item, names = "lab_streaming.markers", []
        for node in self.sequence(known.get("markers"), item):
            name = self.words(node) if isinstance(node, self.nodes.ScalarNode) else ""
            if not name.strip():
                self.fault(node, item, "expected the name of a stream")
            if name in names:
                self.fault(node, item, f"'{name}' is given twice")
            if name in OWN_STREAMS:
                self.fault(node, item, f"'{name}' is sent by HapticGiant itself: outlets: true")
            names.append(name)
        return LabStreaming(self.choice(known, "outlets", "lab_streaming", ("true", "false"), "false") == "true",
                            tuple(names))

    def optional_map(self, parts, name, known):
        return self.map(parts[name], name, known) if name in parts else {}

    def names(self, node, item):
        if node is None:
            return []
        found = self.map(node, item)
        for key, _ in node.value:
            is_label = item in ("conditions", "questionnaires")
            if not (LABEL if is_label else NAME).fullmatch(self.words(key)):
                self.fault(key, self.words(key), f"expected a name of letters{'' if is_label else ', _'} "
                                                 "and digits, from a letter on")
        return list(found.items())

    def within(self, parts, key, item, default, low, high):
        if key not in parts:
            return default
        value = self.number(parts[key], f"{item}.{key}")
        if not low < value < high:
            self.fault(parts[key], f"{item}.{key}", f"expected a number between {low} and {high}, "
                                                    f"got {value}")
        return value

    def choice(self, parts, key, item, known, default=None):
        if key not in parts:
            return default
        value = self.words(parts[key])
        if value not in known:
            self.fault(parts[key], f"{item}.{key}", f"expected {' or '.join(known)}, got '{value}', "
                                                    f"did you mean '{nearest(value, known)}'?")
        return value

    def texts(self, node, item):
        """A text in one language, or a map of them by language."""
        if isinstance(node, self.nodes.ScalarNode):
            return {"en": node.value}
        return {language: self.words(text) for language, text
                in self.map(node, item, LANGUAGES).items()}

    def conditions(self, node, fixed, hand_node):
        hands = dict(self.names(hand_node, "simulation.hand"))
        found = {}
        for name, options in self.names(node, "conditions"):
            given = {key: self.words(value) for key, value in self.keys(options).items()}
            if twice := [key for key in given if key in fixed]:
                self.fault(options, twice[0], "is fixed, too")
            if "seed" in given or "seed" in fixed:
                self.fault(options, "seed", "is drawn for each trial: simulation.seed")
            hand = {}
            for key, value in self.keys(hands.pop(name, None)).items():
                spread = self.map(value, key, ("mean", "sd"))
                if "mean" not in spread or "sd" not in spread:
                    self.fault(value, key, "expected {mean: NUMBER, sd: NUMBER}")
                hand[key] = (self.number(spread["mean"], f"{key}.mean"),
                             self.number(spread["sd"], f"{key}.sd"))
            found[name] = Condition(name, given, hand)
        if len(found) < 2:
            self.fault(node, "conditions", "expected at least two")
        for name, other in hands.items():
            self.fault(other, name, f"no such condition, did you mean '{nearest(name, found)}'?")
        return found

    def design(self, node, conditions):
        parts = self.map(node, "design", ("kind", "order", "participants", "repetitions",
                                          "practice", "seed"))
        for needed in ("kind", "participants"):
            if needed not in parts:
                self.fault(node, "design", f"key '{needed}' is missing")
        kind = self.choice(parts, "kind", "design", ("within", "between"))
        chosen = self.choice(parts, "order", "design", tuple(order.ORDERS),
                             "williams" if kind == "within" else "block_random")
        if kind == "between" and chosen not in ("block_random", "random"):
            self.fault(parts["order"], "design.order", "between people conditions are given out by "
                                                       "block_random or random")
        if chosen == "full" and len(conditions) > order.MOST_OF_A_FULL_ORDER:
            self.fault(parts["order"], "design.order",
                       f"full has {math.factorial(len(conditions))} orders; at most "
                       f"{order.MOST_OF_A_FULL_ORDER} conditions")
        counts = {key: self.count(parts[key], f"design.{key}") if key in parts else 1
                  for key in ("participants", "repetitions", "seed")}
        practice = 0
        if "practice" in parts and self.words(parts["practice"]) != "0":
            practice = self.count(parts["practice"], "design.practice")
        return Design(kind, chosen, practice=practice, **counts)

    def trial(self, parts):
        """Longest time of a trial, and the pause between its last event and its end."""
        found = self.optional_map(parts, "trial", ("longest_s", "ends", "pause_s"))
        longest_s = self.within(found, "longest_s", "trial", 180.0, 0, 36000)
        ends = self.choice(found, "ends", "trial", ("events", "operator"), "events")
        if ends == "operator" and "pause_s" in found:
            self.fault(found["pause_s"], "trial.pause_s", "is after the last event, and the operator ends the trial")
        pause_s = float(self.within(found, "pause_s", "trial", 1.0, -1e-9, 600))
        return float(longest_s), pause_s if ends == "events" else None

    def measures(self, node, forms):
        found = {}
        for name, value in self.names(node, "measures"):
            if name in TRIAL_COLUMNS or name in forms:
                self.fault(value, f"measures.{name}", "is the name of a " + (
                    "questionnaire" if name in forms else "column of trials.csv") + ", take another")
            parts = self.map(value, name, ("expression", "unit", "what"))
            known = expressions.SHIPPED.get(name)
            if "expression" not in parts and known is None:
                self.fault(value, f"measures.{name}",
                           f"needs an expression; those without one are "
                           f"{', '.join(expressions.SHIPPED)}; did you mean "
                           f"'{nearest(name, expressions.SHIPPED)}'?")
            text = self.words(parts["expression"]) if "expression" in parts else known[0]
            try:
                expressions.parse(text)
            except expressions.ExpressionError as error:
                self.fault(parts.get("expression", value), f"measures.{name}", str(error))
            self.places[f"measures.{name}"] = self.place_of(value)
            found[name] = Measure(
                name, text, self.words(parts["unit"]) if "unit" in parts else known[1] if known
                else "", self.words(parts["what"]) if "what" in parts else known[2] if known else name)
        return found

    def place_of(self, node):
        return f"{self.file}:{node.start_mark.line + 1}:{node.start_mark.column + 1}"

    def sequence(self, node, item):
        if node is None:
            return []
        if not isinstance(node, self.nodes.SequenceNode):
            self.fault(node, item, "expected a list")
        return node.value

    def exclusions(self, node, study):
        found = []
        for entry in self.sequence(node, "exclusion"):
            parts = self.map(entry, "exclusion", ("trial", "participant", "why"))
            kinds = [kind for kind in ("trial", "participant") if kind in parts]
            if len(kinds) != 1 or "why" not in parts:
                self.fault(entry, "exclusion", "expected 'trial' or 'participant' with an expression, "
                                               "and 'why'")
            text = self.words(parts[kinds[0]])
            known = [*study.measures, "exit_code"] if kinds[0] == "trial" else ["trials", "excluded_trials"]
            try:
                tree = expressions.parse(text)
            except expressions.ExpressionError as error:
                self.fault(parts[kinds[0]], f"exclusion.{kinds[0]}", str(error))
            for name in expressions.functions_of(tree):
                if name in expressions.OF_A_TRIAL:
                    self.fault(parts[kinds[0]], f"exclusion.{kinds[0]}",
                               f"{name}() is of the samples of a trial: make it a measure")
            for name in expressions.names_of(tree):
                if name not in known:
                    self.fault(parts[kinds[0]], f"exclusion.{kinds[0]}",
                               f"no such measure as '{name}', did you mean '{nearest(name, known)}'?")
            try:
                expressions.is_true(text, dict.fromkeys(known, 1.0))
            except expressions.ExpressionError as error:
                self.fault(parts[kinds[0]], f"exclusion.{kinds[0]}", str(error))
            found.append(Exclusion(kinds[0], text, self.words(parts["why"])))
        return found

    def tests(self, node, study):
        found, outcomes = [], study.outcomes
        for entry in self.sequence(node, "analysis.tests"):
            parts = self.map(entry, "analysis.tests", ("outcome", "test"))
            if "outcome" not in parts:
                self.fault(entry, "analysis.tests", "key 'outcome' is missing")
            outcome = self.words(parts["outcome"])
            if outcome not in outcomes:
                near = f", did you mean '{nearest(outcome, outcomes)}'?" if outcomes else ""
                self.fault(parts["outcome"], "analysis.tests",
                           f"no measure or answer is called '{outcome}'{near}")
            form = study.forms.get(outcome.partition(".")[0])
            if form is not None and form.after != "condition" and study.design.kind == "within":
                self.fault(parts["outcome"], "analysis.tests", f"'{outcome}' is asked once, after all "
                           "conditions, so that they cannot be compared: 'after: condition'")
            test = self.choice(parts, "test", "analysis.tests", TESTS, "auto")
            fitting = WITHIN_TESTS if study.design.kind == "within" else BETWEEN_TESTS
            if test != "auto" and test not in fitting:
                self.fault(parts["test"], "analysis.tests", f"{test} is not for a design {study.design.kind} "
                                                            f"people; those are {', '.join(fitting)}")
            if test in TWO_CONDITIONS and len(study.conditions) != 2:
                self.fault(parts["test"], "analysis.tests",
                           f"{test} is for two conditions, the study has {len(study.conditions)}")
            if test == "friedman" and len(study.conditions) < 3:
                self.fault(parts["test"], "analysis.tests", "friedman is for three conditions and more; "
                                                            "for two it is wilcoxon")
            if test == "auto":
                test = automatic_test(study, form is not None)
            self.places[f"tests.{outcome}"] = self.place_of(entry)
            found.append(Test(outcome, test))
        return found

    def expected(self, node, study):
        found = {}
        items = {f"{name}.{item}": "" for name, form in study.forms.items() for item in form.items}
        known = {**study.outcomes, **items}
        for name, value in self.map(node, "simulation.expected").items() if node else ():
            if name not in known:
                self.fault(value, name, f"no such measure or item, did you mean '{nearest(name, known)}'?")
            parts = self.map(value, name, ("between", "within", *study.conditions))
            for needed in ("between", "within", *study.conditions):
                if needed not in parts:
                    self.fault(value, name, f"key '{needed}' is missing")
            numbers = {key: float(self.number(each, f"{name}.{key}")) for key, each in parts.items()}
            if numbers["between"] < 0 or numbers["within"] <= 0:
                self.fault(value, name, "expected 'between' from 0 on and 'within' above 0")
            found[name] = Expected({key: numbers[key] for key in study.conditions},
                                   numbers["between"], numbers["within"])
        return found


def automatic_test(study: Study, is_rating: bool) -> str:
    """The test for a design: by ranks for ratings, else by means; decided before there are data."""
    is_two = len(study.conditions) == 2
    if study.design.kind == "within":
        if is_rating:
            return "wilcoxon" if is_two else "friedman"
        return "paired_t" if is_two and study.design.repetitions == 1 else "mixed"
    if is_rating:
        return "mann_whitney" if is_two else "kruskal"
    return "welch_t" if is_two else "anova"
