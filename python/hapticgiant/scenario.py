"""Scenarios by file or by name, and whole runs."""

from __future__ import annotations

import os
import pathlib

from hapticgiant import _core
from hapticgiant.recording import Recording

MODELS = pathlib.Path(__file__).resolve().parent / "share" / "hapticgiant" / "models"
"""Folder of the shipped devices, twins, scripts and scenarios."""


def load_scenario(scenario: str | os.PathLike) -> _core.Scenario:
    """A scenario from a YAML file, or one that comes with the package: "door".

    Raises SetupError with all faults of the files, or with the nearest name.
    """
    if os.path.isfile(scenario):
        return _core.load_scenario_file(os.fspath(scenario))
    shipped = sorted((MODELS / "scenarios").glob("*.yaml"))
    for file in shipped:
        if file.stem == os.fspath(scenario):
            return _core.load_scenario_file(str(file))
    wanted = pathlib.PurePath(scenario).stem
    nearest = _core.nearest_name(wanted, [file.stem for file in shipped])
    raise _core.SetupError(
        f"{os.fspath(scenario)}: no such scenario file, did you mean '{nearest}'?")


def run(scenario: str | os.PathLike | _core.Scenario,
        duration_s: float | None = None) -> Recording:
    """Runs a scenario on its simulated device, as fast as it can; every cycle as arrays.

    duration_s: then it is stopped; default: when everything planned has happened.
    Keys are the paths of the fields of a recording, those of the record without "record.":
    "time_s" (n), "twin.q_a" (n, n_a), "robot.w_h" (n, 6), "limits.reaction" (n, limits).
    Where a cycle has no value, NaN or 0. It has no events and no configuration. Raises SetupError.
    Other threads run meanwhile.
    """
    if not isinstance(scenario, _core.Scenario):
        scenario = load_scenario(scenario)
    run_parts, limits = _core.part_metadata(scenario)
    return Recording(_core.run_scenario(scenario, duration_s), run=run_parts, limits=limits)
