"""The remote machine of a teleoperation, served from Python; docs/concepts/teleoperation.md."""

from hapticgiant import _core  # noqa: F401  (SetupError)
from hapticgiant._run import RemoteServer

__all__ = ["RemoteServer"]
