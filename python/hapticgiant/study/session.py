"""The session of one participant: which step is next, which trials are put aside.

What is done is what has a file. Instructions, breaks and practice have none: they are passed for as long as the program
runs, so that a session that was interrupted goes on at the first step without a file, and with what leads to it.
"""

from __future__ import annotations

from hapticgiant.study.description import Study
from hapticgiant.study.folder import WITH_FILES, Folder
from hapticgiant.study.planning import Participant, Step, steps

PLAYED = ("trial", "practice")


class Session:
    """The steps of one participant, and how far they are."""

    def __init__(self, study: Study, folder: Folder, participant: Participant):
        self.participant, self.code = participant, participant.code
        self.steps = steps(study, participant)
        self._folder = folder
        folder.tidy(participant)
        self._passed: set[int] = set()
        first = next((i for i, step in enumerate(self.steps) if step.kind in WITH_FILES and not self.is_done(i)),
                     len(self.steps))
        if first < len(self.steps):
            while first and self.steps[first - 1].kind not in WITH_FILES:
                first -= 1
        self._passed = {i for i in range(first) if self.steps[i].kind not in WITH_FILES}

    def is_done(self, position: int) -> bool:
        """Whether a step has its file, or was passed."""
        step = self.steps[position]
        if step.kind in WITH_FILES:
            return self._folder.file_of(self.code, step).exists()
        return position in self._passed

    @property
    def position(self) -> int | None:
        """The present step; None: all are done."""
        return next((i for i in range(len(self.steps)) if not self.is_done(i)), None)

    @property
    def step(self) -> Step | None:
        position = self.position
        return None if position is None else self.steps[position]

    def pass_by(self, position: int) -> None:
        """A step without a file is over."""
        self._passed.add(position)

    def place(self, position: int) -> int:
        """Which trial of the participant this is, from 1."""
        return sum(1 for step in self.steps[:position + 1] if step.kind == "trial")

    def last_played(self) -> int | None:
        """The trial or practice that can be played again: the last one, while nothing after it has been answered."""
        position = self.position
        found = None
        for i, step in enumerate(self.steps[:position]):
            if step.kind in PLAYED:
                found = i if self.is_done(i) else None
            elif step.kind == "form":
                found = None
        return found

    def put_aside(self, position: int, why: str) -> None:
        """The trial at this position does not count, and is played again; its files are kept aside, with the reason."""
        step = self.steps[position]
        if step.kind == "practice":
            self._passed.discard(position)
        else:
            self._folder.put_aside(self.code, step, why)
