"""Command line of the reports; see __init__.py. Exit codes: 0 written, 3 a library is missing."""

import argparse
import importlib.util
import pathlib
import sys
import types

MISSING = 3


def main():
    parser = argparse.ArgumentParser(prog="hapticgiant.report")
    parser.add_argument("folder", nargs="?", type=pathlib.Path)
    parser.add_argument("--docs", type=pathlib.Path, help="refresh the page of this folder")
    parser.add_argument("--check", action="store_true", help="only check whether it would work")
    arguments = parser.parse_args()
    if not all(importlib.util.find_spec(name) for name in ("numpy", "matplotlib", "jinja2")):
        return MISSING
    if arguments.check:
        return 0
    if not __package__:
        # Run as a folder: the package's own __init__ would need its compiled part.
        package = types.ModuleType("hapticgiant")
        package.__path__ = [str(pathlib.Path(__file__).resolve().parents[1])]
        sys.modules["hapticgiant"] = package
    from hapticgiant.report.haptify import write
    write(arguments.folder, arguments.docs)
    return 0


if __name__ == "__main__":
    sys.exit(main())
