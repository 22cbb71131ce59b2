"""Checks that every header compiles alone, without the precompiled headers of the build.

    check_headers.py BUILD [--jobs N]

Takes compiler, language and include folders from BUILD/compile_commands.json. To be quick, headers
that bring Eigen get it precompiled; one that would find std headers only through it is one that
includes Eigen itself. Exits with 1 and the compiler's first words for each that does not compile.
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

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = ("apps", "bench", "hg", "tests")
ELSEWHERE = {"bench/cascade/cascade.h": "eiquadprog"}  # header: what only `make bench` installs
EIGEN = "#include <Eigen/Core>\n"


def flags_of(build):
    """The compiler, and what all files of the build are compiled with to find their headers."""
    commands = [shlex.split(entry["command"])
                for entry in json.loads((build / "compile_commands.json").read_text())]
    includes = {}  # in the order of their first use
    for words in commands:
        for word, following in zip(words, words[1:]):
            if word == "-isystem":
                includes[word, following] = None
            elif word.startswith("-I"):
                includes[(word,)] = None
    march = [word for word in commands[0] if word.startswith("-march")]
    flags = ["-std=c++20", "-D_FILE_OFFSET_BITS=64", "-w", *march]
    compiler = next(word for word in commands[0] if not word.endswith("ccache"))
    return compiler, flags + [word for pair in includes for word in pair]


def own_includes(header):
    return re.findall(r'^#include "(.*)"', (ROOT / header).read_text(), re.MULTILINE)


def brings_eigen(header, known):
    """Whether a header includes Eigen, itself or through others of ours."""
    if header not in known:
        known[header] = False  # while we look, so that a circle ends
        if (ROOT / header).exists():
            known[header] = "#include <Eigen/" in (ROOT / header).read_text() or any(
                [brings_eigen(other, known) for other in own_includes(header)])
    return known[header]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    compiler, flags = flags_of(arguments.build)
    work = arguments.build / "headers"
    work.mkdir(exist_ok=True)
    (work / "eigen.h").write_text(EIGEN)
    subprocess.run([compiler, *flags, "-x", "c++-header", work / "eigen.h", "-o",
                    work / "eigen.h.gch"], check=True)
    listed = subprocess.run(["git", "ls-files", "--", *(f"{folder}/*.h" for folder in FOLDERS)],
                            cwd=ROOT, check=True, capture_output=True, text=True).stdout.split()
    known = {}

    def compile_alone(header):
        """What the compiler says against it."""
        first = ["-include", work / "eigen.h"] if brings_eigen(header, known) else []
        return subprocess.run(
            [compiler, *flags, "-fsyntax-only", "-x", "c++", *first, "-include", ROOT / header,
             os.devnull], capture_output=True, text=True).stderr

    headers = [header for header in listed if header not in ELSEWHERE]
    faults = 0
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for header, words in zip(headers, pool.map(compile_alone, headers)):
            if words:
                faults += 1
                print(f"{header} does not compile alone:\n" + "\n".join(words.splitlines()[:4]))
    if faults:
        sys.exit(1)
    print(f"headers: {len(headers)} compile alone")


if __name__ == "__main__":
    main()
