#!/usr/bin/env python3
"""The command hapticgiant of the Python package: runs its program, which lies in the package.

Figures and reports are drawn by this Python, unless HAPTICGIANT_PYTHON names another one.
"""

import importlib.util
import os
import sys

# the package itself is not imported, which takes longer than all of this, and needs numpy
package = importlib.util.find_spec("hapticgiant")
folder = os.path.dirname(package.origin) if package and package.origin else ""
program = os.path.join(folder, "bin", "hapticgiant")
if not folder or not os.path.exists(program):
    sys.exit("hapticgiant: this Python package was built without the program: "
             "libsodium or CLI11 was missing (docs/start/install.md)")
os.environ.setdefault("HAPTICGIANT_PYTHON", sys.executable)
os.execv(program, [program, *sys.argv[1:]])
