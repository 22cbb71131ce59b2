"""Checks the rules of the house (house_rules.py), then runs clang-tidy with the checks of .clang-tidy
on all sources but tests, and on their headers.

    lint.py BUILD [--jobs N] [FOLDER...]

To be quick, sources that do not define the same names are read as one, so that what they include is
parsed once: clang-tidy needs seconds for Eigen and the standard library, and milliseconds for a file
of ours. Defines and include folders come from BUILD/compile_commands.json.
Exits with 1 and a line per finding.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

import house_rules
import together

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = ["hg", "apps", "bench", "python/src"]
MOST_TOGETHER = 16  # sources read as one
CLANG_TIDY = pathlib.Path(sys.executable).with_name("clang-tidy")  # of the .venv
FINDING = re.compile(r"(\S+?):(\d+):(\d+): (?:warning|error): (.*)")


def flags_of(command):
    """What clang needs of the build's compile command."""
    words = shlex.split(command)
    flags = ["-std=c++20", "-w", *(word for word in words if word.startswith("-march"))]
    for word, following in zip(words, words[1:]):
        if word == "-isystem":
            flags += [word, following]
        elif word.startswith("-I") or (word.startswith("-D") and "FORTIFY" not in word):
            flags.append(word)
    return tuple(flags)


def sources_of(entry):
    """The sources of ours that a command compiles: itself, or those that it compiles as one."""
    source = pathlib.Path(entry["file"])
    if source.is_relative_to(ROOT) and "Unity" not in source.parts:
        return [source]
    listed = re.findall(r'#include "(.*[.]cpp)"', source.read_text()) if source.suffix == ".cxx" else []
    return [pathlib.Path(name) for name in listed]


def grouped(sources):
    """Lists of sources that can be read as one, with their flags."""
    return [(flags, members) for flags in sorted(set(sources.values()))
            for members in together.grouped(
                sorted(source for source in sources if sources[source] == flags), MOST_TOGETHER)]


def tidy(flags, sources, work):
    """Findings as (file, line, column, words)."""
    unit = work / (str(sources[0].relative_to(ROOT)).replace("/", "_"))
    unit.write_text("".join(f'#include "{source}"\n' for source in sources))
    result = subprocess.run(
        [CLANG_TIDY, "--quiet", f"--config-file={ROOT}/.clang-tidy", unit, "--", *flags],
        capture_output=True, text=True, cwd=ROOT)
    findings = {(match[1], int(match[2]), int(match[3]), match[4])
                for match in map(FINDING.match, result.stdout.splitlines()) if match}
    # a finding without a place is about a parameter that the compiler has invented
    if result.returncode != 0 and not findings and "error: " not in result.stdout:
        sys.exit(f"{unit}: clang-tidy has failed:\n{result.stdout}{result.stderr}")
    return findings


def findings_of(flags, sources, work):
    """Findings of the sources read as one, or, where that does not compile, of each."""
    findings = tidy(flags, sources, work)
    if len(sources) == 1 or not any("clang-diagnostic" in words for *_, words in findings):
        return findings
    return set().union(*(tidy(flags, [source], work) for source in sources))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("folders", nargs="*", default=FOLDERS)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    work = arguments.build.resolve() / "lint"
    work.mkdir(exist_ok=True)
    sources = {}
    for entry in json.loads((arguments.build / "compile_commands.json").read_text()):
        for source in sources_of(entry):
            name = source.relative_to(ROOT)
            if "test" not in name.parts and any(name.is_relative_to(f) for f in arguments.folders):
                sources.setdefault(source, flags_of(entry["command"]))

    groups = sorted(grouped(sources), key=lambda group: -len(group[1]))
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        findings = set().union(*pool.map(lambda group: findings_of(*group, work), groups))
    faults, _ = house_rules.check_tree()
    for fault in faults:
        print(fault)
    for file, line, column, words in sorted(findings):
        print(f"{os.path.relpath(file, ROOT)}:{line}:{column}: {words}")
    if findings or faults:
        sys.exit(1)
    print(f"lint: {len(sources)} sources in {len(groups)} readings without findings")


if __name__ == "__main__":
    main()
