"""Makes hapticgiant.study importable without the package's compiled part, as `hapticgiant study` does."""

import pathlib
import sys
import types

_package = types.ModuleType("hapticgiant")
_package.__path__ = [str(pathlib.Path("python/hapticgiant").resolve())]
sys.modules["hapticgiant"] = _package
