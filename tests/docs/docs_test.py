"""Runs what the documents show: the files in them are written, the commands in them are executed.

In docs/**/*.md a block ```yaml NAME or ```hqp NAME is a file, ```yaml +NAME is more of it; a block
```sh holds commands. Both are taken in the order of the document, in a folder of its own that
starts as a copy of models/examples. Every command must end with exit code 0, or with N where its line ends with
`# exit N`. Lines that a ```text block shows after a command are not compared. Pages that belong together
are run in one folder, as by a reader of both, and write no file twice. The tests that
docs/concepts/threats_*.csv name must be there, and the pages must not be too long.

    docs_test.py PROGRAM
"""

import csv
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import docs_size  # noqa: E402

# the second has the mechanism of the first
TOGETHER = [ROOT / "docs" / "start" / name for name in ("own_device_own_twin.md", "cookbook.md")]
BLOCK = re.compile(r"^```(sh|yaml|hqp)(?: +(\S+))?\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def commands(text):
    """Logical lines of a shell block: (command, expected exit code)."""
    for line in text.replace("\\\n", " ").splitlines():
        command, _, comment = line.partition("#")
        if command.strip():
            expected = re.search(r"exit (\d+)", comment)
            yield command.strip(), int(expected.group(1)) if expected else 0


def run_document(document, program, folder):
    """Returns how many commands ran and a list of faults."""
    count, faults = 0, []
    for kind, name, body in BLOCK.findall(document.read_text()):
        if kind != "sh":
            if name:
                if name[0] != "+" and (folder / name).exists():
                    faults.append(f"{document.name}: {name} is there already, of this page or one before it")
                with open(folder / name.lstrip("+"), "a" if name[0] == "+" else "w") as file:
                    file.write(body)
            continue
        for command, expected in commands(body):
            words = command.split()
            if words[0] != "hapticgiant":
                continue
            done = subprocess.run([program, *words[1:]], cwd=folder, capture_output=True,
                                  text=True, timeout=120)
            count += 1
            if done.returncode != expected:
                faults.append(f"{document.name}: {command}\n  exit {done.returncode}, expected "
                              f"{expected}\n{done.stdout[-1500:]}{done.stderr[-1500:]}")
    return count, faults


def missing_tests(tables):
    """What the last column of these tables calls a test and is none: `Suite.Case` of GoogleTest, or a file."""
    sources = "".join(path.read_text() for folder in ("apps", "hg", "tests")
                      for path in (ROOT / folder).rglob("*_test.cpp"))
    for table in tables:
        with table.open(newline="") as file:
            cells = [row[-1] for row in csv.reader(file)][1:]
        for name in re.findall(r"`([^`]+)`", " ".join(cells)):
            suite, _, case = name.partition(".")
            is_there = (ROOT / name).is_file() if "/" in name else re.search(
                rf"TEST(_F|_P)?\({suite},\s+{case}\)", sources)
            if not is_there:
                yield f"{table.name}: there is no test {name}"


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    total, faults = 0, []
    alone = set((ROOT / "docs").rglob("*.md")) - set(TOGETHER)
    for documents in [TOGETHER, *([document] for document in sorted(alone))]:
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(ROOT / "models" / "examples", folder, dirs_exist_ok=True)
            for document in documents:
                count, found = run_document(document, program, pathlib.Path(folder))
                total += count
                faults += found
    threats = sorted((ROOT / "docs" / "concepts").glob("threats_*.csv"))
    faults += missing_tests(threats)
    if not threats:
        faults.append("docs/concepts: expected tables threats_*.csv, which name tests")
    faults += docs_size.faults()
    for fault in faults:
        print(fault, file=sys.stderr)
    print(f"{total} commands ran, {len(faults)} were wrong")
    return 1 if faults or total == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
