"""Imported first by a folder of this package that is run as a program: makes the package importable without its own
__init__, which needs the compiled part.
"""

import pathlib
import sys
import types

_package = types.ModuleType("hapticgiant")
_package.__path__ = [str(pathlib.Path(__file__).resolve().parent)]
sys.modules["hapticgiant"] = _package
sys.path.remove(_package.__path__[0])
