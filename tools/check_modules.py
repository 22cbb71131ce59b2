"""Checks that every module includes what its line in CMakeLists.txt lists, and nothing else.

A module is a folder of hg/ with its FOLDERS; a file belongs to the deepest module around it. Tests
of a module may include whatever can be reached from there. Nothing of hg/, bench/ or tests/ includes
apps/.

Exits with 1 and one line per forbidden include (file:line: what it includes, what it may) and per
listed module that no file includes.
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def read_modules():
    """Module path -> (paths it may include, its folders), from the hg_module(...) calls."""
    text = (ROOT / "CMakeLists.txt").read_text()
    modules = {}
    for call in re.findall(r"^hg_module\(([^)]*)\)", text, re.MULTILINE):
        words = call.split()
        lists = {"USES": [], "FOLDERS": []}
        current = None
        for word in words[1:]:
            if word.isupper():
                current = lists.get(word)
            elif current is not None:
                current.append(word)
        modules[words[0]] = (set(lists["USES"]), lists["FOLDERS"])
    return modules


def check_order(modules):
    """A module may only use modules listed above it: data flows one way."""
    seen, faults = set(), []
    for name, (uses, _) in modules.items():
        faults += [f"CMakeLists.txt: {name} uses {u}, which is not listed above it"
                   for u in sorted(uses - seen)]
        seen.add(name)
    return faults


def reachable(modules, module):
    """What a module uses, and what that uses in turn: a test may set all of it up."""
    found = set()
    waiting = list(modules[module][0])
    while waiting:
        name = waiting.pop()
        if name not in found:
            found.add(name)
            waiting += modules.get(name, ((), ()))[0]
    return found


def module_of(modules, parts):
    """The deepest module around hg/PARTS..., or None where the folder is none of its FOLDERS."""
    for length in range(len(parts) - 1, 0, -1):
        name = "/".join(parts[:length])
        if name in modules:
            rest = [part for part in parts[length:-1] if part != "test"]
            return name if not rest or rest[0] in modules[name][1] + KNOWN_FOLDERS else None
    return None


KNOWN_FOLDERS = ["mcap_sink", "bus_master", "counting_malloc"]  # with targets of their own


def check_includes(modules):
    faults = []
    included = {name: set() for name in modules}
    files = [path for folder in ("hg", "bench", "tests") for path in (ROOT / folder).rglob("*")]
    for path in sorted(files):
        if path.suffix not in (".h", ".cpp"):
            continue
        file = path.relative_to(ROOT)
        module = allowed = None
        if file.parts[0] == "hg":
            module = module_of(modules, file.parts[1:])
            if module is None:
                faults.append(f"{file}: its folder is not in CMakeLists.txt")
                continue
            is_test = "test" in file.parts
            allowed = reachable(modules, module) if is_test else modules[module][0]
        for number, line in enumerate(path.read_text().splitlines(), 1):
            match = re.match(r'#include "([^"]+)"', line)
            if not match:
                continue
            target = match.group(1)
            parts = pathlib.PurePath(target).parts
            if parts[0] == "apps":
                faults.append(f"{file}:{number}: only apps/ may include {target}")
            if module is None:
                continue
            if not (ROOT / target).is_file():
                faults.append(f"{file}:{number}: {target} is not a path from the repository root")
                continue
            other = module_of(modules, parts[1:]) if parts[0] == "hg" else parts[0]
            if not is_test:
                included[module].add(other)
            if other != module and other not in allowed:
                names = ", ".join(sorted(allowed)) or "nothing"
                faults.append(f"{file}:{number}: {module} may not include {other}; it may use {names}")
    return faults + [f"CMakeLists.txt: {name} lists {other}, and includes nothing of it"
                     for name, (uses, _) in modules.items()
                     for other in sorted(uses - included[name])]


def main():
    modules = read_modules()
    faults = check_order(modules) + check_includes(modules)
    for fault in faults:
        print(fault)
    print(f"check_modules: {len(modules)} modules, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
