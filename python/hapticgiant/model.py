"""Kinematics and dynamics of serial chains."""

from hapticgiant._core.model import *  # noqa: F403
