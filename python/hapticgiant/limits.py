"""Bounds on acceleration and velocity that keep a coordinate inside its limits."""

from hapticgiant._core.limits import *  # noqa: F403
