"""One trial: played by `hapticgiant run`, measured from its recording."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import math
import pathlib
import shutil
import subprocess

import numpy as np

from hapticgiant import samples
from hapticgiant.study import expressions
from hapticgiant.study.description import Study
from hapticgiant.sweep.program import REPORTS, Outcome, Program
from hapticgiant.sweep.reader import InputError, nearest

RUNNING = 3  # of the column `mode`
ALWAYS = ("mode", "time_s")
LENGTHS = {"robot.w_h": 6, "truth.w_h": 6, "sensors.w_s": 6, "v_h": 3, "handle.p": 3, "truth.handle.p": 3, "handle.r": 9}
"""Of columns that are as long for every device."""


class TrialError(RuntimeError):
    """A trial that has no result."""


def command(study: Study, program: Program, condition: str, hand: dict[str, str], seed: int,
            folder: pathlib.Path) -> list[str]:
    """`hapticgiant run` with the simulated hand; the recording goes to the folder."""
    return [*REPORTS, *shown_command(study, program, condition, hand, seed), "--recordings",
            str(folder), "--flight-recorder", "off"]


def shown_command(study: Study, program: Program, condition: str, hand: dict[str, str], seed: int) -> list[str]:
    """The same as it can be typed."""
    return [program.file, "run", *study.arguments(condition, hand), "--seed", str(seed), "--fast",
            "--no-viewer"]


@dataclasses.dataclass
class Measured:
    """What came of a trial."""

    exit_code: int
    state_hash: str
    events: list[tuple[float, str]]
    measures: dict[str, float]
    recording: pathlib.Path
    digest: str
    """SHA-256 of the recording."""
    lab_clock: list[samples.LabClock]
    missing: list[str]
    """Names of the task's events that have not happened."""
    no_value: dict[str, str]
    """Measures without a number, and why."""

    def facts(self) -> dict:
        """What the file of a trial has of it."""
        return {"exit_code": self.exit_code, "measures": self.measures, "no_value": self.no_value,
                "events": [{"time_s": time, "name": name} for time, name in self.events],
                "missing_events": self.missing, "state_hash": self.state_hash, "recording_sha256": self.digest}


def columns_of(study: Study) -> list[str]:
    """The recorded columns that measures read, without their index."""
    names = {name.partition("[")[0] for measure in study.measures.values()
             for name in expressions.names_of(expressions.parse(measure.expression))}
    return sorted(names | set(ALWAYS))


def known_columns(program: Program) -> dict[str, bool]:
    """The columns that a recording has, and whether they have an index."""
    done = subprocess.run([program.file, "export", "--list-columns", "--json", "/dev/stdout"],
                          capture_output=True, text=True)
    if done.returncode:
        raise TrialError(done.stderr.strip() or f"{program.file} export --list-columns: exit code {done.returncode}")
    return {column["name"]: column["has_index"] for column in json.loads(done.stdout)["columns"]}


def require_columns(study: Study, known: dict[str, bool]) -> None:
    """Raises InputError for a measure of a column that no recording has. How long a column is depends on the device:
    an index beyond its end is found by a trial."""
    for name, measure in study.measures.items():
        for column in expressions.names_of(expressions.parse(measure.expression)):
            whole, bracket, index = column.partition("[")
            place = f"{study.place(f'measures.{name}')}: measures.{name}: "
            if whole not in known:
                raise InputError(f"{place}no column is called '{column}', did you mean '{nearest(whole, known)}'?")
            if known[whole] != bool(bracket):
                raise InputError(f"{place}'{column}': " + (f"take one of its values, as '{whole}[0]'" if known[whole]
                                                           else f"'{whole}' is one value, without an index"))
            if bracket and "." not in index and int(index.rstrip("]")) >= LENGTHS.get(whole, math.inf):
                raise InputError(f"{place}'{column}': '{whole}' has the indices 0 to {LENGTHS[whole] - 1}")


def measure(study: Study, outcome: Outcome) -> Measured:
    """The measures of a run that has ended by itself. Raises TrialError, ExpressionError."""
    summary = outcome.summary()
    if summary is None:
        raise TrialError(outcome.why())
    return measured(study, summary, outcome.code)


def measured(study: Study, summary: dict, exit_code: int) -> Measured:
    """The measures of a run by its summary and its recording. Raises TrialError, ExpressionError."""
    recording = pathlib.Path(summary["recording"])
    if not summary["recording"] or not recording.is_file():
        raise TrialError(f"no recording: {summary['recording_error'] or 'nothing was written'}")
    try:
        recorded = samples.read(recording, columns_of(study))
    except (ValueError, OSError) as error:
        raise TrialError(str(error)) from error
    if recorded.losses:
        raise TrialError(f"{recording}: {recorded.losses[0]}")
    columns = _numbered(recorded.columns)
    is_felt = columns["mode"] == RUNNING
    columns = {name: values[is_felt] for name, values in columns.items()}
    for values in columns.values():
        values.setflags(write=False)
    events = [(event["time_s"], event["name"]) for event in summary["events"]]
    missing = list(summary["missing_events"])
    measures, no_value = _values(study, expressions.Trial(columns, events, _numbers(summary), missing), is_felt.any())
    return Measured(exit_code, summary["state_hash"], events, measures, recording, digest_of(recording),
                    recorded.lab_clock, missing, no_value)


def _values(study, trial, was_held):
    """The measures of a trial, and why some have no number."""
    measures, no_value = {}, {}
    for name, each in study.measures.items():
        tree = expressions.parse(each.expression)
        try:
            measures[name] = expressions.evaluate(tree, trial)
        except expressions.ExpressionError as error:
            if was_held:
                raise expressions.ExpressionError(f"{study.place(f'measures.{name}')}: measures.{name}: {error}") from None
            measures[name] = math.nan
        if not math.isfinite(measures[name]):
            no_value[name] = expressions.why_no_number(tree, trial) if was_held else "the handle was not taken"
    return measures, no_value


def digest_of(file: pathlib.Path) -> str:
    """SHA-256 of a file."""
    digest = hashlib.sha256()
    with open(file, "rb") as data:
        while block := data.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()


def _numbered(columns):
    """Columns of one number, as "robot.w_h[0]", as floats."""
    found = {}
    for name, values in columns.items():
        if values.ndim == 1:
            found[name] = values.astype(float)
        else:
            found |= {f"{name}[{i}]": entry for i, entry in enumerate(values.T.astype(float))}
    return found


def _numbers(summary):
    found = {}

    def add(path, value):
        if isinstance(value, dict):
            for key, inner in value.items():
                add(f"{path}.{key}" if path else key, inner)
        elif isinstance(value, (int, float)):
            found[path] = float(value)

    add("", summary)
    return found | {"missing_events": float(len(summary["missing_events"]))}


def excluded(study: Study, measures: dict[str, float], exit_code: int) -> str:
    """Why a trial is left out; empty: it counts."""
    known = {**{name: np.nan if value is None else value for name, value in measures.items()}, "exit_code": exit_code}
    for each in study.exclusions:
        if each.kind == "trial" and expressions.is_true(each.expression, known):
            return each.why
    return ""


def missing_text(missing: list[str]) -> str:
    """Which events of a task have not happened, in words; empty: none is missing."""
    return f"missing: {', '.join(missing)}" if missing else ""


def discard(folder: pathlib.Path) -> None:
    """Deletes what a trial has left behind."""
    shutil.rmtree(folder, ignore_errors=True)


def dump(value) -> str:
    """JSON in which a measure without a number is null."""
    def plain(x):
        if isinstance(x, dict):
            return {key: plain(each) for key, each in x.items()}
        if isinstance(x, (list, tuple)):
            return [plain(each) for each in x]
        return None if isinstance(x, float) and not np.isfinite(x) else x

    return json.dumps(plain(value), indent=2, ensure_ascii=False, allow_nan=False) + "\n"
