"""Command line of the reports; see __init__.py.

Exit codes: 0 written, 101 written, but not all is as expected, 103 written, but a fault came in
between, 69 a library is missing.
"""

import argparse
import importlib
import importlib.util
import json
import pathlib
import sys
import types

MISSING = 69
VERDICT = 100
# the module that reports on results.json or, with folders of runs, on run.json of this kind; others
# have the name of their kind
MODULES = {"goals": "haptify", "contact": "series", "free-space": "series", "impedance": "series",
           "inertial": "series", "seeds": "series", "stability-map": "series", "cartesian": "experiments", "excavator": "experiments",
           "door": "experiments", "path": "experiments", "any": "recordings",
           "compare": "recordings"}


def main():
    parser = argparse.ArgumentParser(prog="hapticgiant.report")
    parser.add_argument("folder", nargs="?", type=pathlib.Path)
    parser.add_argument("runs", nargs="*", type=pathlib.Path, help="folders with run.json")
    parser.add_argument("--docs", type=pathlib.Path, help="refresh the page of this folder")
    parser.add_argument("--check", action="store_true", help="only check whether it would work")
    parser.add_argument("--export", choices=("parquet", "hdf5"),
                        help="write the table that standard input has; see export.py")
    arguments = parser.parse_args()
    if not __package__:
        # Run as a folder: the package's own __init__ would need its compiled part.
        package = types.ModuleType("hapticgiant")
        package.__path__ = [str(pathlib.Path(__file__).resolve().parents[1])]
        sys.modules["hapticgiant"] = package
    if arguments.export:
        if importlib.util.find_spec("numpy") is None:
            print("numpy", end="")
            return MISSING
        export = importlib.import_module("hapticgiant.report.export")
        return export.main(arguments.export, arguments.check)
    needed = ("numpy", "scipy", "matplotlib", "jinja2")
    if not all(importlib.util.find_spec(name) for name in needed):
        return MISSING
    if arguments.check:
        return 0
    runs = [arguments.runs] if arguments.runs else []
    file = arguments.runs[0] / "run.json" if runs else arguments.folder / "results.json"
    kind = json.loads(file.read_text(encoding="utf-8"))["kind"]
    module = importlib.import_module(f"hapticgiant.report.{MODULES.get(kind, kind)}")
    verdict = module.write(arguments.folder, *runs, docs=arguments.docs)
    return VERDICT + verdict if verdict else 0


if __name__ == "__main__":
    sys.exit(main())
