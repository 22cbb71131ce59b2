"""A whole run as `hapticgiant run` plays it: device, recording, page, streams, summary."""

from __future__ import annotations

import dataclasses
import json
import os
import pathlib
from collections.abc import Callable


@dataclasses.dataclass(frozen=True)
class Outcome:
    """How a run has ended."""

    exit_code: int
    """0 fine, 1 an expected event is missing or a limit was exceeded, 3 a fault stopped the device, 4 the recording is
    incomplete."""
    summary: dict
    """What `hapticgiant run --summary` writes; empty where no run was played."""
    recording: pathlib.Path | None
    """None: nothing was recorded."""


class RunInterrupted(KeyboardInterrupt):
    """Ctrl-C has ended a run in order: the device has stopped, and its recording is complete."""

    def __init__(self, outcome: Outcome):
        super().__init__("the run was interrupted")
        self.outcome = outcome


def play(scenario: str | os.PathLike = "door", *, on_event: Callable[[dict], None] | None = None,
         **options) -> Outcome:
    """Plays a run to its end.

    options: those of `hapticgiant run` with _ for -, as fast=True, duration=3, set=["twin.mass_scale=2"],
    recording=False, viewer=False; docs/reference/run_protocol.md lists them. on_event: called with every report of the
    run as a dict: {"phase": "running", ...}, {"status": {...}}, {"event": ...}, {"summary": {...}}.

    Raises SetupError for bad input, RunInterrupted after Ctrl-C, and what on_event raises; a run that has begun is
    ended in order before. Other threads run meanwhile.
    """
    from hapticgiant import _run  # only with the program

    def report(line):
        on_event(json.loads(line))

    request = json.dumps({"scenario": os.fspath(scenario), **options})
    code, summary, recording, error = _run.play(request, None if on_event is None else report)
    outcome = Outcome(code, json.loads(summary) if summary else {}, pathlib.Path(recording) if recording else None)
    if isinstance(error, KeyboardInterrupt):
        raise RunInterrupted(outcome) from error
    if error is not None:
        raise error
    return outcome
