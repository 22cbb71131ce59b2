"""A sweep: a YAML file that says which runs there are.

A sweep of another command of the program is written by that command (command, parts, files): its
runs are the shares of its work, `--part I/N`.

fixed and parameters have the same keys: an option of `hapticgiant run` (seed, hand, duration_s), or
a key of one of its files (twin.mass_scale). Values are kept as the words of the file: they go to
the program as they stand.
"""

from __future__ import annotations

import dataclasses
import hashlib
import itertools
import json
import math
import os
import pathlib

from hapticgiant.sweep.reader import (MOST, InputError, Placed, Reader, arguments_of, value_of)

METHODS = ("latin_hypercube", "sobol")


@dataclasses.dataclass(frozen=True)
class Run:
    """One run: its number from 1 on, and its parameters as words of YAML."""

    number: int
    parameters: dict[str, str]


@dataclasses.dataclass
class Sweep(Placed):
    """What load_sweep() returns."""

    file: pathlib.Path
    title: str
    fixed: dict[str, str]
    runs: list[Run]
    measures: list[str]
    places: dict[str, str]
    """Where a key stands: "sweep.yaml:7:3"."""
    command: list[str] = dataclasses.field(default_factory=list)
    """Words of a command that plays a share of its work per run; empty: `run`."""
    files: str = ""
    """Of such a sweep, what its files hold, as a hash."""

    def arguments(self, run: Run) -> list[str]:
        """The words after `hapticgiant run` that are this run's own."""
        if self.command:
            return ["--part", run.parameters["part"]]
        return arguments_of({**self.fixed, **run.parameters}, self.file.parent)

    def digest(self) -> str:
        """Differs where any run differs."""
        every = [[run.number, self.arguments(run)] for run in self.runs]
        if self.command:
            every = [self.command, self.files, every]
        return hashlib.sha256(json.dumps(every).encode()).hexdigest()[:16]


def load_sweep(file: str | os.PathLike) -> Sweep:
    """The sweep of a file. Raises InputError with place, rule and nearest name."""
    return _Reader(pathlib.Path(file)).sweep()


class _Reader(Reader):
    def sweep(self):
        root = self.root()
        parts = self.map(root, "", ("title", "fixed", "parameters", "samples", "rows", "measures",
                                    "command", "parts", "files"))
        if "command" in parts:
            return self.sweep_of_a_command(root, parts)
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
        if count > MOST:
            self.fault(root, "", f"{count} runs, at most {MOST} are possible")
        runs = []
        for row, sample in itertools.product(rows, samples):
            for combination in itertools.product(*grid.values()):
                given = {**row, **sample, **dict(zip(grid, combination))}
                runs.append(Run(len(runs) + 1, given))
        measures = parts.get("measures")
        if measures is not None and not isinstance(measures, self.nodes.SequenceNode):
            self.fault(measures, "measures", "expected a list of names, * stands for anything")
        title = parts.get("title")
        return Sweep(self.file, self.words(title) if title else self.file.stem, fixed, runs,
                     [self.words(node) for node in measures.value] if measures else [],
                     self.places)

    def sweep_of_a_command(self, root, parts):
        for needed in ("command", "parts"):
            if needed not in parts:
                self.fault(root, "", f"key '{needed}' is missing")
        if others := [key for key in parts if key not in ("title", "command", "parts", "files")]:
            self.fault(parts[others[0]], others[0], "not beside 'command'")
        if not isinstance(parts["command"], self.nodes.SequenceNode) or not parts["command"].value:
            self.fault(parts["command"], "command", "expected a list of words")
        command = [self.words(word) for word in parts["command"].value]
        count = self.count(parts["parts"], "parts")
        return Sweep(self.file, self.words(parts["title"]) if "title" in parts else command[0], {},
                     [Run(i, {"part": f"{i}/{count}"}) for i in range(1, count + 1)], [], {},
                     command, self.words(parts["files"]) if "files" in parts else "")

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
        if not first < last:
            self.fault(node, key, f"'from' must be below 'to', got {first:g} and {last:g}")
        spacing = self.words(parts["spacing"]) if "spacing" in parts else "linear"
        if spacing not in ("linear", "log"):
            self.fault(parts["spacing"], key, f"expected linear or log, got '{spacing}'")
        if spacing == "log" and not (first > 0 and last > 0):
            self.fault(node, key, "log spacing needs numbers above 0")
        if "count" not in parts:
            return "range", (first, last, spacing)
        count = self.count(parts["count"], f"{key}.count")
        if count == 1:
            self.fault(parts["count"], f"{key}.count", "must be at least 2, got 1: a single value is a list, "
                                                       "or belongs to 'fixed'")
        shares = [i / (count - 1) for i in range(count)]
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
            self.fault(node, "samples", "needs scipy: pip install 'hapticgiant[sweep]'")
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
