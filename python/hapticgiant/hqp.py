"""Strictly lexicographic least squares with bounds."""

from hapticgiant._core.hqp import *  # noqa: F403
