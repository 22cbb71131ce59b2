"""How far a sweep is, on standard error, once it has taken two seconds."""

from __future__ import annotations

import sys
import time

QUIET_S = 2.0
PERIOD_S = 0.2  # of a terminal
PERIOD_OF_A_FILE_S = 30.0


class Progress:
    """Counts runs."""

    def __init__(self, what: str, total: int):
        self._what, self._total, self._done = what, total, 0
        self._begin = time.monotonic()
        self._is_terminal = sys.stderr.isatty()
        self._next = self._begin + QUIET_S
        self._has_shown = False

    def step(self) -> None:
        self._done += 1
        now = time.monotonic()
        if now < self._next:
            return
        self._next = now + (PERIOD_S if self._is_terminal else PERIOD_OF_A_FILE_S)
        rate = self._done / (now - self._begin)
        left = _time((self._total - self._done) / rate)
        text = f"{self._what}: {self._done} of {self._total}, {rate:.2g} per second, {left} left"
        print(f"\r{text}\x1b[K" if self._is_terminal else text, end="" if self._is_terminal else "\n",
              file=sys.stderr, flush=True)
        self._has_shown = True

    def end(self) -> None:
        if self._has_shown and self._is_terminal:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)


def _time(seconds):
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"
