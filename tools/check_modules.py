"""Checks that every module includes only what its line in CMakeLists.txt lists.

Tests of a module may include whatever can be reached from there.

Exits with 1 and one line per forbidden include: file:line: what it includes, what it may.
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def read_edges():
    """Module name -> names it may include, from the hg_module(...) calls."""
    text = (ROOT / "CMakeLists.txt").read_text()
    edges = {}
    for call in re.findall(r"^hg_module\(([^)]*)\)", text, re.MULTILINE):
        words = call.split()
        uses, is_use = [], False
        for word in words[1:]:
            if word.isupper():
                is_use = word == "USES"
            elif is_use:
                uses.append(word)
        edges[words[0]] = set(uses)
    return edges


def check_order(edges):
    """A module may only use modules listed above it: data flows one way."""
    seen, faults = set(), []
    for name, uses in edges.items():
        faults += [f"CMakeLists.txt: {name} uses {u}, which is not listed above it"
                   for u in sorted(uses - seen)]
        seen.add(name)
    return faults


def reachable(edges, module):
    """What a module uses, and what that uses in turn: a test may set all of it up."""
    found = set()
    waiting = list(edges[module])
    while waiting:
        name = waiting.pop()
        if name not in found:
            found.add(name)
            waiting += edges.get(name, ())
    return found


def check_includes(edges):
    faults = []
    for path in sorted((ROOT / "hg").rglob("*")):
        if path.suffix not in (".h", ".cpp"):
            continue
        file = path.relative_to(ROOT)
        module = file.parts[1]
        if module not in edges:
            faults.append(f"{file}: folder hg/{module} is not in CMakeLists.txt")
            continue
        allowed = reachable(edges, module) if "test" in file.parts else edges[module]
        for number, line in enumerate(path.read_text().splitlines(), 1):
            match = re.match(r'#include "([^"]+)"', line)
            if not match:
                continue
            target = match.group(1)
            if not (ROOT / target).is_file():
                faults.append(f"{file}:{number}: {target} is not a path from the repository root")
                continue
            other = pathlib.PurePath(target).parts[1]
            if other != module and other not in allowed:
                names = ", ".join(sorted(allowed)) or "nothing"
                faults.append(f"{file}:{number}: {module} may not include {other}; it may use {names}")
    return faults


def main():
    edges = read_edges()
    faults = check_order(edges) + check_includes(edges)
    for fault in faults:
        print(fault)
    print(f"check_modules: {len(edges)} modules, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
