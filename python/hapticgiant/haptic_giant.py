"""Kinematics of the HapticGiant in closed form."""

from hapticgiant._core.haptic_giant import *  # noqa: F403
