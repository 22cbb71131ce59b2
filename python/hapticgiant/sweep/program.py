"""The program that plays the runs, its commands, and what it says."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys

from hapticgiant.sweep.description import Run, Sweep

QUIET = ["--fast", "--no-viewer", "--no-recording", "--flight-recorder", "off"]
# before a command of `run`: prints its reports (docs/reference/run_protocol.md) and nothing else
REPORTS = ["/bin/sh", "-c", 'exec "$@" --report-to 3 3>&1 >/dev/null', "sh"]
# of a summary: what depends on the computer, what a run is told, and what has a column of its own
LEFT_OUT = {"version", "scenario", "law", "bounds", "gantry", "braking", "plant", "sensors",
            "rate_Hz", "fast", "wall_time_s", "cycle_time_us", "latency", "overruns",
            "most_overruns_in_a_row", "overruns_stop", "real_time", "priority", "cpu",
            "memory_locked", "page_faults_in_loop", "unrecorded_samples", "recording",
            "recording_error", "state_hash", "fault", "configuration", "interrupted"}
BAD_INPUT = 2
RETURN_CODE_OF_A_SIGNAL = 0  # below it


@dataclasses.dataclass(frozen=True)
class Program:
    """The file of the program, and who it is."""

    file: str
    version: str
    digest: str

    def command(self, sweep: Sweep, run: Run) -> list[str]:
        """The command of a run, as it can be typed."""
        if sweep.command:
            return [self.file, *sweep.command, *sweep.arguments(run)]
        return self.run(sweep.arguments(run))

    def run(self, arguments: list[str]) -> list[str]:
        """`hapticgiant run` with these arguments, as it can be typed."""
        return [self.file, "run", *arguments, *QUIET]

    def measured(self, sweep: Sweep, run: Run) -> list[str]:
        """The same, so that it prints what Outcome.summary() reads."""
        return ([] if sweep.command else REPORTS) + self.command(sweep, run)


@dataclasses.dataclass(frozen=True)
class Outcome:
    """How a process has ended: exit code, or minus the signal; what it has printed: the reports of
    a run, or the results of a part."""

    code: int
    out: str
    err: str

    def summary(self) -> dict | None:
        """What the run has measured, by its last report, or the results of a part; None for one
        that has not been played to its end."""
        said = _object_in(self.out) or _object_in(self.out.rstrip("\n").rpartition("\n")[2])
        summary = said if "results" in said else said.get("summary")
        return None if summary is None or summary.get("interrupted") else summary

    def was_ended(self) -> bool:
        """Whether a signal has ended it, or it could not be started (126, 127: of the shell), so that
        it is worth another try."""
        return (self.code < RETURN_CODE_OF_A_SIGNAL or self.code in (126, 127)
                or self.code == 0 and self.summary() is None)

    def why(self) -> str:
        """Why there is no summary."""
        said = self.err.strip()
        if said:
            return said
        return f"ended by signal {-self.code}" if self.code < 0 else f"exit code {self.code}"


def _object_in(text):
    """The JSON object of a text; empty where there is none, or a kill has cut it."""
    try:
        found = json.loads(text)
    except ValueError:
        return {}
    return found if isinstance(found, dict) else {}


def find_program() -> Program:
    """The program that has started this, or the one on the path. Raises FileNotFoundError."""
    name = os.environ.get("HAPTICGIANT_PROGRAM", "hapticgiant")
    beside = pathlib.Path(sys.executable).parent / "hapticgiant"
    file = shutil.which(name) or (str(beside) if beside.is_file() else None)
    if file is None:
        raise FileNotFoundError(f"{name}: no such program; set HAPTICGIANT_PROGRAM to its file")
    file = str(pathlib.Path(file).resolve())
    version = subprocess.run([file, "--version"], capture_output=True, text=True, check=True)
    programs = [pathlib.Path(file), pathlib.Path(file).with_name("hapticgiant-offline")]  # of all commands
    content = b"".join(each.read_bytes() for each in programs if each.is_file())
    return Program(file, version.stdout.strip(), hashlib.sha256(content).hexdigest()[:12])


def measures_of(summary: dict) -> dict:
    """The measures of a summary that are the same on every computer, by their path: force.mean_N,
    rms_torque_over_rated[0], events.NAME.time_s."""
    measures = {}

    def add(path, value):
        if isinstance(value, dict):
            for key, inner in value.items():
                if key != "unit":
                    add(f"{path}.{key}", inner)
        elif isinstance(value, list):
            for i, inner in enumerate(value):
                add(f"{path}[{i}]", inner)
        else:
            measures[path] = value

    for key, value in summary.items():
        if key == "events":
            value = {event["name"]: {"time_s": event["time_s"]} for event in value}
        if key == "missing_events":
            value = ", ".join(map(str, value))
        if key not in LEFT_OUT:
            add(key, value)
    return measures
