"""Writes which sources CMake compiles as one: those of a folder that define no name twice.

    together.py FILE.cmake

What sources include is then parsed, and the templates that they share are made, once: that is most of
the time of a compiler. Sources that are compiled as one share their unnamed namespaces; where two of
them define the same name there, they are put into different groups. CMake calls this when it
configures; -DHG_TOGETHER=OFF compiles each source alone.
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = ["hg", "apps", "bench", "tests", "python/src", "tools/pages"]
MOST_TOGETHER, MOST_LINES = 8, 1600  # more need more memory than they save time
HEAVY = ("<pinocchio/", "chain_parts.h", "<boost/beast", "<CLI/")  # its source is compiled alone: 1 GB


def own_names(text):
    """Names that stand in an unnamed namespace of a source, or look like it."""
    names = set(re.findall(r"^(?:struct|class|enum class|enum) (\w+)", text, re.MULTILINE))
    names |= set(re.findall(r"^(?:constexpr|const|using|inline|static)\b.*?\b(\w+)(?:\[.*\])? ?(?:=|\{)",
                            text, re.MULTILINE))
    names |= set(re.findall(r"^(?:[\w:<>,*&\[\]]+ )+[*&]?(\w+)\([^;]*?\)[^;(]*\{", text, re.MULTILINE))
    return names | set(re.findall(r"^TEST(?:_F|_P)?\((\w+, \w+)\)", text, re.MULTILINE))


def grouped(sources, most=MOST_TOGETHER, most_lines=10**6):
    """Lists of sources that can be read as one, of at most so many sources and lines."""
    groups = []  # names, lines, sources
    for source in sources:
        text = source.read_text()
        names, lines = own_names(text), text.count("\n")
        for group in groups:
            if (not group[0] & names and len(group[2]) < most
                    and group[1] + lines <= most_lines):
                group[0].update(names)
                group[1] += lines
                group[2].append(source)
                break
        else:
            groups.append([set(names), lines, [source]])
    return [members for *_, members in groups]


def is_heavy(source):
    text = source.read_text()
    return any(f"#include {header}" in text or f"/{header}" in text for header in HEAVY)


def main():
    folders = sorted({path.parent for folder in FOLDERS for path in (ROOT / folder).rglob("*.cpp")})
    lines = []
    for folder in folders:
        light = [source for source in sorted(folder.glob("*.cpp")) if not is_heavy(source)]
        for number, members in enumerate(grouped(light, most_lines=MOST_LINES), 1):
            if len(members) > 1:
                lines.append("set_source_files_properties(\n  {}\n  PROPERTIES UNITY_GROUP {}_{})".format(
                    "\n  ".join(f"${{PROJECT_SOURCE_DIR}}/{m.relative_to(ROOT)}" for m in members),
                    "_".join(folder.relative_to(ROOT).parts), number))
    pathlib.Path(sys.argv[1]).write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
