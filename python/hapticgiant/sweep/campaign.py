"""A sweep from its file to its table: checked, played, continued, merged, repeated."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import math
import os
import pathlib
import random
import shlex
import time

from hapticgiant.sweep import engines
from hapticgiant.sweep.description import Run, Sweep, load_sweep
from hapticgiant.sweep.manifest import HEADER, Folder, Manifest, SweepError
from hapticgiant.sweep.program import (BAD_INPUT, REPORTS, Outcome, Program, find_program,
                                       measures_of)
from hapticgiant.sweep.progress import Progress
from hapticgiant.sweep.reader import OPTIONS, InputError, nearest, value_of
from hapticgiant.sweep.table import rows_of, write_table

FORMAT = 1
TRIES = 3  # of a run that somebody has ended
FIRST_RUNS = 10  # that must not all be refused
LATER = {"events", "reality", "shaking", "link"}  # measures that a trial is too short for
TRIAL = ["--duration", "0.001"]  # enough to load, check and take the posture


@dataclasses.dataclass
class Result:
    """What a sweep has so far."""

    sweep: Sweep
    folder: pathlib.Path
    records: dict[int, dict]
    program: Program
    file: pathlib.Path | None = None
    """results.parquet or results.csv; None for a shard, which `merge` puts together with others."""
    repeated: int = 0
    """Runs that were not played again, since the folder had them."""
    shard: tuple[int, int] | None = None

    @property
    def runs(self) -> list[Run]:
        """Those that were asked for."""
        return _of_shard(self.sweep, self.shard)

    @property
    def rows(self) -> list[dict]:
        """One dict per run that has ended."""
        return rows_of(self.sweep, self.records)

    def with_code(self, *codes: int) -> list[Run]:
        """Runs with a result and this exit code: 0 as expected, 1 not, 3 stopped by a fault."""
        return [run for run in self.runs if (record := self.records.get(run.number)) is not None
                and record["state_hash"] is not None and record["exit_code"] in codes]

    def without_result(self) -> list[Run]:
        """Runs that have crashed, were refused, or were not played yet."""
        return [run for run in self.runs if (record := self.records.get(run.number)) is None
                or record["state_hash"] is None]

    def command(self, run: Run) -> str:
        """The command that repeats this run."""
        return shlex.join(self.program.command(self.sweep, run))


def run(sweep: Sweep | str | os.PathLike, out: str | os.PathLike | None = None, *,
        jobs: int | None = None, shard: tuple[int, int] | None = None, engine: str = "local",
        scheduler: str = "", again: bool = False, table: bool = True) -> Result:
    """Plays all runs of a sweep that its folder does not have, and writes the table.

    out: the folder; default NAME.sweep beside its file. jobs: processes at a time. shard: (i, n)
    plays each n-th run from the i-th on. engine: local or dask, there at `scheduler` or, without
    one, on this machine. again: forgets what the folder has. table: whether the table is written.
    Raises InputError, SweepError.
    """
    sweep, folder, program = _prepare(sweep, out)
    if again and shard is not None:
        raise SweepError("--again deletes the runs of other shards, too: give it to `submit` or to "
                         "a sweep without --shard")
    if again:
        forget(folder)
    _begin(sweep, folder, program, jobs)
    records = folder.records()
    has_before = {number for number, record in records.items() if record["state_hash"] is not None}
    wanted = [run for run in _of_shard(sweep, shard) if run.number not in has_before]
    try:
        manifest = Manifest(folder, shard)
    except BlockingIOError:
        raise _busy(folder) from None
    commands = {run.number: program.measured(sweep, run) for run in wanted}
    by_number = {run.number: run for run in wanted}
    refused = 0
    try:
        for number, outcome, seconds in _play(commands, engine, scheduler, jobs, "runs"):
            record = _record(sweep, by_number[number], program, outcome, seconds)
            manifest.append(record)
            records[number] = record
            refused = refused + 1 if outcome.code == BAD_INPUT and refused >= 0 else -1
            if refused >= FIRST_RUNS:
                raise SweepError(f"none of the first {refused} runs could begin:\n"
                                 + explained(outcome.why(), sweep))
    finally:
        manifest.close()
    result = Result(sweep, folder.path, records, program, shard=shard,
                    repeated=len(_of_shard(sweep, shard)) - len(wanted))
    if shard is None and table:
        result.file = write_table(folder.path, result.rows)
    return result


def forget(folder: Folder) -> None:
    """Deletes the runs of a folder. Raises SweepError while another sweep writes there."""
    try:
        folder.forget()
    except BlockingIOError:
        raise _busy(folder) from None


def begin(sweep: Sweep | str | os.PathLike, out: str | os.PathLike | None = None) -> None:
    """Checks a sweep and makes its folder, for shards to be played. Raises InputError, SweepError."""
    sweep, folder, program = _prepare(sweep, out)
    _begin(sweep, folder, program, None)


def merge(sweep: Sweep | str | os.PathLike, out: str | os.PathLike | None = None) -> Result:
    """The table of all shards that are there. Raises InputError, SweepError."""
    sweep, folder, program = _prepare(sweep, out)
    there = folder.header()
    if there is None:
        raise SweepError(f"{folder.path}: holds no sweep")
    if there["sweep"] != sweep.digest():
        raise SweepError(_other(folder, "runs of another sweep"))
    result = Result(sweep, folder.path, folder.records(), program)
    result.file = write_table(folder.path, result.rows)
    return result


@dataclasses.dataclass
class Check:
    """What check() has found."""

    played: list[Run]
    differing: list[tuple[Run, str]]
    """Runs that are not the same again, each with what differs."""
    result: Result


def check(sweep: Sweep | str | os.PathLike, out: str | os.PathLike | None = None, *,
          count: int | None = 10, jobs: int | None = None, engine: str = "local",
          scheduler: str = "") -> Check:
    """Plays runs of a finished sweep again, and compares exit codes, hashes and measures.

    count: how many, spread at random; None: all. Raises InputError, SweepError.
    """
    sweep, folder, program = _prepare(sweep, out)
    if folder.header() is None:
        raise SweepError(f"{folder.path}: holds no sweep")
    _refuse_other(folder, _header(sweep, program, jobs))
    records = folder.records()
    played = [run for run in sweep.runs
              if run.number in records and records[run.number]["state_hash"] is not None]
    if count is not None and count < len(played):
        played = sorted(random.Random(1).sample(played, count), key=lambda run: run.number)
    by_number = {run.number: run for run in played}
    commands = {run.number: program.measured(sweep, run) for run in played}
    differing = []
    for number, outcome, seconds in _play(commands, engine, scheduler, jobs, "repeated"):
        before = records[number]
        after = _record(sweep, by_number[number], program, outcome, seconds)
        what = [f"{key} {before[key]}, now {after[key]}"
                for key in ("exit_code", "state_hash", "fault") if before[key] != after[key]]
        if not what and before["measures"] != after["measures"]:
            what = ["measures"]
        if what:
            differing.append((by_number[number], "; ".join(what)))
    differing.sort(key=lambda item: item[0].number)
    return Check(played, differing, Result(sweep, folder.path, records, program))


def folder_of(sweep: Sweep, out: str | os.PathLike | None) -> pathlib.Path:
    """The folder of a sweep: `out`, or NAME.sweep beside its file."""
    return pathlib.Path(out) if out is not None else sweep.file.with_suffix(".sweep")


def explained(text: str, sweep: Sweep) -> str:
    """What the program says about --set KEY or an option, at the place of the file that gives it."""
    lines = []
    for line in text.splitlines():
        words = line.split()
        if line.startswith("--set "):
            item = line.removeprefix("--set ")
            key = item.partition(": ")[0].partition("=")[0]
            lines.append(f"{sweep.place(key)}: {item}")
            continue
        key = next((key for key, flag in OPTIONS.items() if flag and words and
                    flag in (words[0].rstrip(":"), words[0].partition("=")[0])), None)
        if line and line != "Run with --help for more information.":
            lines.append(f"{sweep.place(key) if key else sweep.file}: {line}")
    return "\n".join(lines)


def _prepare(sweep, out):
    if not isinstance(sweep, Sweep):
        sweep = load_sweep(sweep)
    try:
        program = find_program()
    except FileNotFoundError as error:
        raise SweepError(str(error)) from None
    return sweep, Folder(folder_of(sweep, out)), program


def _begin(sweep, folder, program, jobs):
    header = _header(sweep, program, jobs)
    _refuse_other(folder, header)
    folder.settle(header)
    _refuse_other(folder, header)


def _of_shard(sweep, shard):
    return sweep.runs if shard is None else sweep.runs[shard[0] - 1::shard[1]]


def _trials(sweep):
    """The first run, and the same with the ends of each parameter's values, or all its words."""
    first = sweep.runs[0]
    trials = [first]
    for key in first.parameters:
        values = list(dict.fromkeys(run.parameters[key] for run in sweep.runs))
        numbers = [value_of(value) for value in values]
        if all(isinstance(value, (int, float)) and math.isfinite(value) for value in numbers):
            values = [values[numbers.index(end(numbers))] for end in (min, max)]
        trials += [Run(0, {**first.parameters, key: value}) for value in values]
    return trials


def _header(sweep, program, jobs):
    """Who plays what with which files; tries whether the runs can begin."""
    header = {"format": FORMAT, "title": sweep.title, "runs": len(sweep.runs),
              "sweep": sweep.digest(), "version": program.version, "program": program.digest,
              "files": sweep.files}
    return header if sweep.command else {**header, "files": _files(sweep, program, jobs)}


def _files(sweep, program, jobs):
    """What the files of the runs hold, as a hash. Raises InputError where runs cannot begin."""
    for duration in {run.parameters.get("duration_s", sweep.fixed.get("duration_s"))
                     for run in sweep.runs} - {None}:
        if not isinstance(value_of(duration), (int, float)) or not 0 < value_of(duration) < math.inf:
            raise InputError(f"{sweep.place('duration_s')}: duration_s: expected a number above 0, "
                             f"got '{duration}'")
    commands = {}
    for trial in _trials(sweep):
        arguments = sweep.arguments(trial)
        if "--duration" in arguments:
            at = arguments.index("--duration")
            del arguments[at:at + 2]
        command = REPORTS + program.run(arguments + TRIAL)
        if command not in commands.values():
            commands[len(commands)] = command
    first = dict(engines.Local(1).play({0: commands.pop(0)}))
    outcomes = {**first, **(dict(engines.Local(jobs).play(commands))
                            if first[0].summary() else {})}
    faults = [explained(outcome.why(), sweep) for _, outcome in sorted(outcomes.items())
              if outcome.summary() is None]
    if faults:
        raise InputError("\n".join(dict.fromkeys("\n".join(faults).splitlines())))
    summaries = [outcome.summary() for _, outcome in sorted(outcomes.items())]
    known = sorted({name.split(".")[0].split("[")[0] for summary in summaries
                    for name in measures_of(summary)} | LATER)
    for wanted in sweep.measures:
        top = wanted.split(".")[0].split("[")[0]
        if "*" not in top and "?" not in top and top not in known:
            raise InputError(f"{sweep.file}: measures: no measure '{wanted}', did you mean "
                             f"'{nearest(top, known)}'?")
    files = "".join(summary["configuration"] for summary in summaries)
    return _digest(files)


def _digest(text):
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _busy(folder):
    return SweepError(f"{folder.path}: another sweep is writing there")


def _other(folder, what):
    return (f"{folder.path} holds {what}: take another --out, or --again to forget them and start "
            "anew")


def _refuse_other(folder, header):
    there = folder.header()
    if there is None:
        return
    if there["format"] != header["format"]:
        raise SweepError(_other(folder, f"a sweep of another kind ({HEADER})"))
    if there["sweep"] != header["sweep"]:
        raise SweepError(_other(folder, f"runs of another sweep ('{there['title']}', "
                                        f"{there['runs']} runs; this one has {header['runs']})"))
    if there["program"] != header["program"]:
        raise SweepError(_other(folder, f"runs of another program ({there['version']} "
                                        f"{there['program']}; this one is {header['version']} "
                                        f"{header['program']})"))
    if there["files"] != header["files"]:
        raise SweepError(_other(folder, "runs with other files: a scenario, device, twin, simulation "
                                        "or script has changed since"))


def _play(commands, name, scheduler, jobs, what):
    """Yields number, outcome and seconds since the begin; a run that was ended is tried again."""
    if not commands:
        return
    engine = _engine(name, scheduler, jobs)
    progress = Progress(what, len(commands))
    begin = time.monotonic()
    try:
        for last in [False] * (TRIES - 1) + [True]:
            ended = {}
            for number, outcome in engine.play(commands):
                if outcome.was_ended() and not last:
                    ended[number] = commands[number]
                    continue
                progress.step()
                yield number, outcome, time.monotonic() - begin
            commands = ended
            if not commands:
                return
    finally:
        progress.end()
        engine.close()


def _engine(name, scheduler, jobs):
    if name == "local":
        if scheduler:
            raise SweepError("--scheduler: only with --engine dask")
        return engines.Local(jobs)
    if name != "dask":
        raise SweepError(f"--engine: expected local or dask, got '{name}'")
    try:
        return engines.Dask(scheduler, jobs)
    except ImportError:
        raise SweepError("--engine dask: needs Dask: pip install 'dask[distributed]'") from None
    except (OSError, ValueError) as error:
        raise SweepError(f"--scheduler {scheduler}: {error}") from None


def _record(sweep: Sweep, run: Run, program: Program, outcome: Outcome, seconds: float) -> dict:
    summary = outcome.summary()
    seed = run.parameters.get("seed", sweep.fixed.get("seed"))
    record = {"run": run.number, "parameters": run.parameters,
              "seed": None if seed is None else value_of(seed), "version": program.version,
              "exit_code": outcome.code, "state_hash": None, "fault": None, "measures": None,
              "ended_s": round(seconds, 3)}
    if summary is None:
        record["error"] = outcome.why()
        if sweep.command:
            record["results"] = None
    elif sweep.command:
        results = summary["results"]
        record |= {"state_hash": _digest(json.dumps(results, sort_keys=True)), "results": results}
    else:
        record |= {"state_hash": summary["state_hash"], "fault": summary["fault"]["code"],
                   "measures": measures_of(summary)}
    return record
