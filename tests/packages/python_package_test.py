"""The Python package as pip installs it: its tests, then the examples.

Arguments: the build folder, and the program, to make a recording; the package is installed
first. Or --installed: the package that this Python has, without a recording, and of the tests
those that an installation can break.
"""

import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = {
    "joint_bounds.py": r"    2\.00 +-?[0-9. -]+",
    "solve_problem.py": r"SOLVED \[1\. 2\.\]\nSOLVED \[1\. 3\.\] after 1 active set",
    "hqp_priorities.py": r"slow tip: .* misses by \[0\. 0\.\]\nfast tip: (.*\n)+.*blocked by row 1\n",
    "whole_body.py": r"right hand +misses by 0\.000\nleft hand +misses by 0\.[1-9]\d\d\n(.*\n)+SOLVED with 16 ",
    "open_door.py": r"opens at 9\.\d\d s, force .* N, felt: ",
    "bilateral_method.py": r"(\n +0 ms +\w+ +yes .*){3}(\n +50 ms +\w+ +yes .*){3}\n +400 ms ",
    "read_run.py": r"1\d{4} cycles, 14\.\d s.*\nhinge at most 1\.\d{3} rad, open from 9\.\d\d s on",
}
# libraries that notebooks need without importing them
NEEDS = {"1_first_run.py": "import pandas", "2_forces_at_a_limit.py": "import xarray"}
# the extension with its stubs and models, and figures, pages and their templates by the extra packages
TESTS_OF_AN_INSTALLATION = ["enums_test", "hqp_test", "limits_test", "model_test", "play_test",
                            "parameters_test", "run_test", "series_test"]


def run(*command, **options):
    """Output of a command; exits with all of it where the command fails."""
    result = subprocess.run([str(word) for word in command], text=True, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, **options)
    if result.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{result.stdout}")
    return result.stdout


def install(tree, site):
    """The package with the libraries that a wheel has."""
    shutil.rmtree(site, ignore_errors=True)
    for component, prefix in (("python", site), ("libraries", site / "hapticgiant")):
        run("cmake", "--install", tree, "--prefix", prefix, "--component", component)


def prepare(tree, program):
    """Environment in which the package and a recording of the door are found."""
    work = tree / "package_python"
    install(tree, work / "site")
    recordings = work / "recordings"
    shutil.rmtree(recordings, ignore_errors=True)
    run(program, "run", "door", "--fast", "--recordings", recordings)
    environment = {**os.environ, "PYTHONPATH": str(work / "site"),
                   "HAPTICGIANT_PROGRAM": str(program.resolve()),
                   "HG_RECORDING": str(recordings / "latest.mcap")}
    environment.pop("LD_LIBRARY_PATH", None)
    return environment


def main():
    is_installed = sys.argv[1:] == ["--installed"]
    environment = dict(os.environ) if is_installed else prepare(*map(pathlib.Path, sys.argv[1:]))
    tests = TESTS_OF_AN_INSTALLATION if is_installed else ["discover", "-p", "*_test.py"]
    print(run(sys.executable, "-m", "unittest", *tests, cwd=ROOT / "python" / "test",
              env=environment))
    text = (ROOT / "docs" / "start" / "packages.md").read_text()
    for name, expected in EXAMPLES.items():
        example = ROOT / "examples" / "python" / name
        shown = example.relative_to(ROOT)
        if f"\n[{shown}](../../{shown})\n" not in text:
            sys.exit(f"docs/start/packages.md does not show {shown}")
        output = run(sys.executable, example, env=environment)
        if not re.search(expected, output):
            sys.exit(f"{name} printed\n{output}\nexpected {expected}")
        print(f"{name}: fine")
    # each notebook says what is true of it in assertions
    for notebook in sorted((ROOT / "examples" / "notebooks").glob("*.py")):
        missing = [name for name in ("pandas", "xarray", "matplotlib")
                   if f"import {name}" in notebook.read_text() + NEEDS.get(notebook.name, "")
                   and importlib.util.find_spec(name) is None]
        if missing:
            print(f"{notebook.name}: skipped, {', '.join(missing)} is not installed")
            continue
        run(sys.executable, notebook, env={**environment, "MPLBACKEND": "Agg"}, cwd=ROOT)
        print(f"{notebook.name}: fine")


if __name__ == "__main__":
    main()
