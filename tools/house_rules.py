"""Checks the rules of the house that need no compiler.

    house_rules.py [--update]

A function has at most 60 lines, a header 150, CHANGELOG.md 250. No file is empty. Numbers of C++ come from
hg/core/random.h, not from <random>, whose distributions differ between standard libraries. Household
words (WORDS) stand in no comment, message, name or page. cmake/public_headers.txt names at most 80
headers, which include no others.

Exceptions are lines of tools/house_exceptions.txt: rule, size, where, reason. A size that is not that
of today is a fault: more is forbidden, less has to be written down, which --update does.
Exits with 1 and one line per fault.
"""

import argparse
import collections
import dataclasses
import re
import sys

import function_lengths
from tracked_files import ROOT, read_texts

EXCEPTIONS = "tools/house_exceptions.txt"
PUBLIC_HEADERS = "cmake/public_headers.txt"
LONGEST_FUNCTION = 60  # lines
LONGEST_HEADER = 150
CHANGELOG = "CHANGELOG.md"
LONGEST_CHANGELOG = 250
MOST_PUBLIC_HEADERS = 80
WORDS = ("told", "tell", "tells", "telling", "nobody", "somebody", "someone", "anybody", "everybody",
         "anew", "trouble", "troubles", "goes on", "by itself")
SKIPPED = ("tests/fuzz/", "viewer/package-lock.json", "LICENSE", "THIRD_PARTY.md", "models/arms/LICENSES.md",
           "tools/house_rules", EXCEPTIONS)

FUNCTIONS = {".h": function_lengths.cpp_functions, ".cpp": function_lengths.cpp_functions,
             ".py": function_lengths.python_functions, ".ts": function_lengths.typescript_functions,
             ".mjs": function_lengths.typescript_functions, ".rs": function_lengths.rust_functions}
RANDOM_HEADER = "hg/core/random.h"
MAY_BE_EMPTY = ("__init__.py", "py.typed", ".skip")
RANDOM = re.compile(r"\bstd::(?:mt19937(?:_64)?|default_random_engine|\w+_distribution|shuffle)\b")
SPACE = r"(?:_|\s+|[ \t]*\n[ \t]*(?://[/!]?|#|\*)?[ \t]*)"  # or a new line of a comment


def _word_pattern():
    small = [word.replace(" ", SPACE) for word in WORDS]
    begins = "|".join(f"[{word[0]}{word[0].upper()}]{word[1:]}" for word in small)
    inside = "|".join(word[0].upper() + word[1:] for word in small)  # of isTold
    # without tell() of Python's files, and nobody@ of addresses
    return re.compile(rf"(?<![A-Za-z])(?<!\.(?=tell\(\)))(?:{begins})(?![a-z@])|(?<=[a-z])(?:{inside})(?![a-z])")


WORD = _word_pattern()
STEMS = sorted({word.split()[-1] if word.endswith("itself") else word.split()[0] for word in WORDS})


@dataclasses.dataclass
class Finding:
    """Something beyond its limit; `where` is a file, or a file and a function."""

    rule: str
    where: str
    size: int
    lines: list  # "file:line: what, what is expected"


def is_test(name):
    return "test" in name.split("/") or name.startswith("tests/")


def line_of(text, at):
    return text.count("\n", 0, at) + 1


def long_functions(name, text):
    functions = FUNCTIONS.get(name[name.rfind("."):])
    if functions is None or text.count("\n") <= LONGEST_FUNCTION:
        return
    longest = {}
    for function, line, lines in functions(text):
        if lines > max(LONGEST_FUNCTION, longest.get(function, (0, 0))[0]):
            longest[function] = lines, line
    for function, (lines, line) in longest.items():
        yield Finding("function", f"{name}:{function}", lines, [
            f"{name}:{line}: function {function} has {lines} lines, expected at most {LONGEST_FUNCTION}"])


def long_header(name, text):
    lines = text.count("\n")
    if name.endswith(".h") and lines > LONGEST_HEADER:
        yield Finding("header", name, lines, [
            f"{name}: has {lines} lines, expected at most {LONGEST_HEADER} in a header"])


def long_changelog(name, text):
    lines = text.count("\n")
    if name == CHANGELOG and lines > LONGEST_CHANGELOG:
        yield Finding("changelog", name, lines, [
            f"{name}: has {lines} lines, expected at most {LONGEST_CHANGELOG}: shorten old releases"])


def empty_file(name, text):
    if not text.strip() and not name.endswith(MAY_BE_EMPTY):
        yield Finding("empty", name, 1, [f"{name}: is empty, expected some content or no file"])


def random_numbers(name, text):
    if not name.endswith((".h", ".cpp")) or is_test(name) or name == RANDOM_HEADER:
        return
    lines = [f"{name}:{line_of(text, match.start())}: {match[0]}, expected hg::Random of {RANDOM_HEADER}"
             for match in RANDOM.finditer(text)]
    if lines:
        yield Finding("random", name, len(lines), lines)


def household_words(name, text):
    small = text.lower()
    if not any(stem in small for stem in STEMS):  # much quicker than the pattern
        return
    lines = [f"{name}:{line_of(text, match.start())}: \"{re.sub(SPACE, ' ', match[0])}\" is a household "
             "word, expected one of the field" for match in WORD.finditer(text)]
    if lines:
        yield Finding("words", name, len(lines), lines)


FILE_RULES = (long_functions, long_header, long_changelog, empty_file, random_numbers, household_words)


def listed_headers(text):
    return [line for line in text.splitlines() if line and not line.startswith("#")]


def public_headers(texts):
    """Findings about the list of public headers."""
    headers = listed_headers(texts[PUBLIC_HEADERS])
    if len(headers) > MOST_PUBLIC_HEADERS:
        yield Finding("public", PUBLIC_HEADERS, len(headers), [
            f"{PUBLIC_HEADERS}: has {len(headers)} headers, expected at most {MOST_PUBLIC_HEADERS}"])
    for header in headers:
        if header not in texts:
            yield Finding("public", header, 1, [f"{PUBLIC_HEADERS}: {header}, expected a header"])
            continue
        lines = [f"{header}:{line_of(texts[header], match.start())}: a public header includes {match[1]}, "
                 f"expected one of {PUBLIC_HEADERS}"
                 for match in re.finditer(r'^#include "([^"]+)"', texts[header], re.MULTILINE)
                 if match[1] not in headers]
        if lines:
            yield Finding("public", header, len(lines), lines)
    for header, times in collections.Counter(headers).items():
        if times > 1:
            yield Finding("public", header, times, [f"{PUBLIC_HEADERS}: {header} stands there twice"])


def findings_of(texts):
    found = [finding for name, text in texts.items() for rule in FILE_RULES for finding in rule(name, text)]
    return found + list(public_headers(texts))


def read_exceptions(text):
    """(rule, where) -> (size, reason)."""
    exceptions = {}
    for line in text.splitlines():
        if line and not line.startswith("#"):
            rule, size, where, reason = line.split(None, 3)
            exceptions[rule, where] = int(size), reason
    return exceptions


def judge(findings, exceptions):
    """Lines about what no exception allows, and about exceptions that are not as of today."""
    faults = []
    for finding in findings:
        size, _ = exceptions.get((finding.rule, finding.where), (0, ""))
        if finding.size > size:
            faults += finding.lines
            if size > 0:
                faults.append(f"{EXCEPTIONS}: {finding.rule} {finding.where} has grown from {size} to "
                              f"{finding.size}")
        elif finding.size < size:
            faults.append(f"{EXCEPTIONS}: {finding.rule} {finding.where} is down from {size} to "
                          f"{finding.size}: house_rules.py --update")
    present = {(finding.rule, finding.where) for finding in findings}
    faults += [f"{EXCEPTIONS}: {rule} {where} is no longer needed: house_rules.py --update"
               for rule, where in exceptions if (rule, where) not in present]
    return faults


def updated(text, findings):
    """The exceptions with smaller sizes where they are smaller today, and without those not needed."""
    sizes = {(finding.rule, finding.where): finding.size for finding in findings}
    lines = []
    for line in text.splitlines():
        if line and not line.startswith("#"):
            rule, size, where, _ = line.split(None, 3)
            if (rule, where) not in sizes:
                continue
            line = line.replace(size, str(min(int(size), sizes[rule, where])), 1)
        lines.append(line)
    return "\n".join(lines) + "\n"


def check_tree():
    """(faults, number of exceptions) of the repository."""
    exceptions = read_exceptions((ROOT / EXCEPTIONS).read_text())
    return judge(findings_of(read_texts(SKIPPED)), exceptions), len(exceptions)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--update", action="store_true", help="writes smaller sizes into the exceptions")
    if parser.parse_args().update:
        path = ROOT / EXCEPTIONS
        path.write_text(updated(path.read_text(), findings_of(read_texts(SKIPPED))))
    faults, exceptions = check_tree()
    for fault in faults:
        print(fault)
    print(f"house_rules: {exceptions} exceptions, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
