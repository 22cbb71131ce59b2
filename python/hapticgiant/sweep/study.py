"""A study: a YAML file that says which runs there are.

A study of another command of the program is written by that command (command, parts, files): its
runs are the shares of its work, `--part I/N`.

fixed and parameters have the same keys: an option of `hapticgiant run` (seed, hand, duration_s), or
a key of one of its files (twin.mass_scale). Values are kept as the words of the file: they go to
the program as they stand.
"""

from __future__ import annotations

import dataclasses
import difflib
import functools
import hashlib
import itertools
import json
import math
import os
import pathlib

OPTIONS = {"scenario": "", "device": "--device", "twin": "--twin", "user": "--user",
           "simulation": "--simulation", "plant": "--plant", "sensors": "--sensors",
           "hand": "--hand", "seed": "--seed", "law": "--law", "bounds": "--bounds",
           "gantry": "--gantry", "braking": "--braking", "passivity": "--passivity",
           "rate_Hz": "--rate-hz", "step_s": "--step", "duration_s": "--duration"}
"""Options of `hapticgiant run` that a study may give, and how the command line calls them."""
FILES = ("scenario", "device", "twin", "user", "simulation")  # options that may name a file
PARTS = ("scenario", "device", "simulation", "twin", "script")  # before the dot of a key
MOST_RUNS = 1_000_000
METHODS = ("latin_hypercube", "sobol")


class StudyError(ValueError):
    """A fault of a study; the message has file, line and column."""


@dataclasses.dataclass(frozen=True)
class Run:
    """One run: its number from 1 on, and its parameters as words of YAML."""

    number: int
    parameters: dict[str, str]


@dataclasses.dataclass
class Study:
    """What load_study() returns."""

    file: pathlib.Path
    title: str
    fixed: dict[str, str]
    runs: list[Run]
    measures: list[str]
    places: dict[str, str]
    """Where a key stands: "study.yaml:7:3"."""
    command: list[str] = dataclasses.field(default_factory=list)
    """Words of a command that plays a share of its work per run; empty: `run`."""
    files: str = ""
    """Of such a study, what its files hold, as a hash."""

    def arguments(self, run: Run) -> list[str]:
        """The words after `hapticgiant run` that are this run's own."""
        if self.command:
            return ["--part", run.parameters["part"]]
        words, options = [], {**self.fixed, **run.parameters}
        words.append(self._file_or_name("scenario", options.get("scenario", "door")))
        for key, value in options.items():
            if key == "scenario":
                continue
            if key in OPTIONS:
                words += [OPTIONS[key], self._file_or_name(key, value)]
            else:
                words += ["--set", f"{key}={value}"]
        return words

    def digest(self) -> str:
        """Differs where any run differs."""
        every = [[run.number, self.arguments(run)] for run in self.runs]
        if self.command:
            every = [self.command, self.files, every]
        return hashlib.sha256(json.dumps(every).encode()).hexdigest()[:16]

    def place(self, key: str) -> str:
        """Where a key stands, or the one that is in it or around it."""
        for known, place in self.places.items():
            if known == key or known.startswith(key + ".") or key.startswith(known + "."):
                return place
        return str(self.file)

    def _file_or_name(self, key, value):
        return _file_beside(self.file, value) if key in FILES else value


@functools.cache
def _file_beside(study, name):
    beside = study.parent / name
    return str(beside.resolve()) if beside.is_file() else name


def value_of(words: str):
    """The number, truth value or text that these words of YAML stand for."""
    if words in ("true", "false"):
        return words == "true"
    for kind in (int, float):
        try:
            return kind(words)
        except ValueError:
            continue
    return words


def nearest(name: str, names) -> str:
    """Of these names the most similar one."""
    return max(names, key=lambda known: difflib.SequenceMatcher(None, name, known).ratio())


def load_study(file: str | os.PathLike) -> Study:
    """The study of a file. Raises StudyError with place, rule and nearest name."""
    return _Reader(pathlib.Path(file)).study()


class _Reader:
    def __init__(self, file):
        self.file = file
        self.places = {}

    def study(self):
        import yaml

        try:
            text = self.file.read_text(encoding="utf-8")
            root = yaml.compose(text, Loader=yaml.SafeLoader)
        except (OSError, UnicodeDecodeError) as error:
            raise StudyError(f"{self.file}: cannot be read: {error}") from None
        except yaml.YAMLError as error:
            mark = getattr(error, "problem_mark", None)
            place = f"{self.file}:{mark.line + 1}:{mark.column + 1}" if mark else str(self.file)
            raise StudyError(f"{place}: not valid YAML: {getattr(error, 'problem', error)}") from None
        if root is None:
            raise StudyError(f"{self.file}: expected a map of keys, got nothing")
        self.nodes = yaml.nodes
        parts = self.map(root, "", ("title", "fixed", "parameters", "samples", "rows", "measures",
                                    "command", "parts", "files"))
        if "command" in parts:
            return self.study_of_a_command(root, parts)
        for key in ("parts", "files"):
            if key in parts:
                self.fault(parts[key], key, "only beside 'command'")
        fixed = {key: self.words(node) for key, node in self.keys(parts.get("fixed")).items()}
        grid, ranges = {}, {}
        for key, node in self.keys(parts.get("parameters")).items():
            if key in fixed:
                self.fault(node, key, "is fixed, too")
            kind, values = self.parameter(key, node)
            (grid if kind == "grid" else ranges)[key] = values
        rows = self.rows(parts.get("rows"), {**fixed, **grid, **ranges})
        samples = self.samples(parts.get("samples"), ranges, root)
        count = len(rows) * len(samples) * math.prod(map(len, grid.values()))
        if count > MOST_RUNS:
            self.fault(root, "", f"{count} runs, at most {MOST_RUNS} are possible")
        runs = []
        for row, sample in itertools.product(rows, samples):
            for combination in itertools.product(*grid.values()):
                given = {**row, **sample, **dict(zip(grid, combination))}
                runs.append(Run(len(runs) + 1, given))
        measures = parts.get("measures")
        if measures is not None and not isinstance(measures, self.nodes.SequenceNode):
            self.fault(measures, "measures", "expected a list of names, * stands for anything")
        title = parts.get("title")
        return Study(self.file, self.words(title) if title else self.file.stem, fixed, runs,
                     [self.words(node) for node in measures.value] if measures else [],
                     self.places)

    def study_of_a_command(self, root, parts):
        for needed in ("command", "parts"):
            if needed not in parts:
                self.fault(root, "", f"key '{needed}' is missing")
        if others := [key for key in parts if key not in ("title", "command", "parts", "files")]:
            self.fault(parts[others[0]], others[0], "not beside 'command'")
        if not isinstance(parts["command"], self.nodes.SequenceNode) or not parts["command"].value:
            self.fault(parts["command"], "command", "expected a list of words")
        command = [self.words(word) for word in parts["command"].value]
        count = self.count(parts["parts"], "parts")
        return Study(self.file, self.words(parts["title"]) if "title" in parts else command[0], {},
                     [Run(i, {"part": f"{i}/{count}"}) for i in range(1, count + 1)], [], {},
                     command, self.words(parts["files"]) if "files" in parts else "")

    def fault(self, node, item, what):
        mark = node.start_mark
        place = f"{self.file}:{mark.line + 1}:{mark.column + 1}: "
        raise StudyError(place + (f"{item}: " if item else "") + what)

    def words(self, node):
        """A value in one line, as it can stand behind --set KEY=."""
        if isinstance(node, self.nodes.ScalarNode):
            return node.value
        if isinstance(node, self.nodes.SequenceNode):
            return f"[{', '.join(map(self.inner_words, node.value))}]"
        pairs = (f"{self.inner_words(k)}: {self.inner_words(v)}" for k, v in node.value)
        return "{" + ", ".join(pairs) + "}"

    def inner_words(self, node):
        is_quoted = isinstance(node, self.nodes.ScalarNode) and node.style is not None
        return json.dumps(node.value) if is_quoted else self.words(node)

    def map(self, node, item, known=None):
        if not isinstance(node, self.nodes.MappingNode):
            self.fault(node, item, "expected a map of keys")
        result = {}
        for key, value in node.value:
            name = self.words(key)
            if name in result:
                self.fault(key, name, "given twice")
            if known and name not in known:
                self.fault(key, name, f"unknown key, did you mean '{nearest(name, known)}'?")
            result[name] = value
        return result

    def keys(self, node):
        """A map whose keys are options or keys of files."""
        if node is None:
            return {}
        result = self.map(node, "")
        for key, _ in node.value:
            name = self.words(key)
            self.places[name] = f"{self.file}:{key.start_mark.line + 1}:{key.start_mark.column + 1}"
            part = name.partition(".")[0]
            if "." in name and part not in PARTS:
                self.fault(key, name, f"no such part, did you mean '{nearest(part, PARTS)}'? "
                                      f"They are {', '.join(PARTS)}")
            if "." not in name and name not in OPTIONS:
                self.fault(key, name, f"no such option, did you mean '{nearest(name, OPTIONS)}'? "
                                      f"They are {', '.join(OPTIONS)}")
        return result

    def number(self, node, item):
        value = value_of(self.words(node))
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
            self.fault(node, item, f"expected a number, got '{self.words(node)}'")
        return value

    def count(self, node, item):
        value = self.number(node, item)
        if not isinstance(value, int) or not 1 <= value <= MOST_RUNS:
            self.fault(node, item, f"expected a whole number from 1 to {MOST_RUNS}, got '{value}'")
        return value

    def parameter(self, key, node):
        if isinstance(node, self.nodes.SequenceNode):
            if not node.value:
                self.fault(node, key, "expected at least one value")
            return "grid", [self.words(value) for value in node.value]
        if not isinstance(node, self.nodes.MappingNode):
            self.fault(node, key, "expected a list, or a map with from and to; a value that does "
                                  "not vary belongs to 'fixed'")
        parts = self.map(node, key, ("from", "to", "count", "spacing"))
        for needed in ("from", "to"):
            if needed not in parts:
                self.fault(node, key, f"key '{needed}' is missing")
        first, last = (self.number(parts[end], f"{key}.{end}") for end in ("from", "to"))
        spacing = self.words(parts["spacing"]) if "spacing" in parts else "linear"
        if spacing not in ("linear", "log"):
            self.fault(parts["spacing"], key, f"expected linear or log, got '{spacing}'")
        if spacing == "log" and not (first > 0 and last > 0):
            self.fault(node, key, "log spacing needs numbers above 0")
        if "count" not in parts:
            return "range", (first, last, spacing)
        count = self.count(parts["count"], f"{key}.count")
        shares = [i / (count - 1) if count > 1 else 0.0 for i in range(count)]
        return "grid", [_number_words(key, first, last, spacing, share) for share in shares]

    def rows(self, node, others):
        if node is None:
            return [{}]
        if not isinstance(node, self.nodes.SequenceNode) or not node.value:
            self.fault(node, "rows", "expected a list of maps")
        rows = []
        for entry in node.value:
            row = {key: self.words(value) for key, value in self.keys(entry).items()}
            if twice := [key for key in row if key in others]:
                self.fault(entry, twice[0], "is fixed or a parameter, too")
            if rows and row.keys() != rows[0].keys():
                self.fault(entry, "rows", f"each needs the keys {', '.join(rows[0])}")
            rows.append(row)
        return rows

    def samples(self, node, ranges, root):
        if node is None:
            if ranges:
                self.fault(root, next(iter(ranges)), "a range without 'count' needs 'samples'")
            return [{}]
        if not ranges:
            self.fault(node, "samples", "no parameter is a range (from, to) without 'count'")
        parts = self.map(node, "samples", ("method", "count", "seed"))
        for needed in ("method", "count"):
            if needed not in parts:
                self.fault(node, "samples", f"key '{needed}' is missing")
        method = self.words(parts["method"])
        if method not in METHODS:
            self.fault(parts["method"], "samples.method", f"expected {' or '.join(METHODS)}, got "
                                                          f"'{method}'")
        count = self.count(parts["count"], "samples.count")
        seed = self.count(parts["seed"], "samples.seed") if "seed" in parts else 1
        if method == "sobol" and count & (count - 1):
            self.fault(parts["count"], "samples.count", "points of a Sobol sequence are balanced "
                                                        f"only for a power of 2, got {count}")
        try:
            from scipy.stats import qmc
        except ImportError:
            self.fault(node, "samples", "needs scipy: pip install scipy")
        engine = {"latin_hypercube": qmc.LatinHypercube, "sobol": qmc.Sobol}[method]
        points = engine(len(ranges), rng=seed).random(count)
        return [{key: _number_words(key, *ends, share) for (key, ends), share
                 in zip(ranges.items(), point.tolist())} for point in points]


def _number_words(key, first, last, spacing, share):
    """The number at this share of the way, whole where both ends and the step are, or for a seed."""
    if spacing == "log":
        value = first * (last / first) ** share
    else:
        value = first + (last - first) * share
    is_whole = isinstance(first, int) and isinstance(last, int) and abs(value - round(value)) < 1e-9
    return str(round(value)) if is_whole or key == "seed" else f"{value:.12g}"
