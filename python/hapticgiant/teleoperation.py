"""Benchmark of bilateral control for methods of your own; docs/concepts/teleoperation.md."""

from hapticgiant._core.teleoperation import *  # noqa: F403
