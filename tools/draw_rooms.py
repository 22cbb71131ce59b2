"""Draws the rooms of hg/ and the programs around them, with what each may include.

    draw_rooms.py FILE.svg [--check]

Rows, rooms and arrows come from the hg_module(...) calls of CMakeLists.txt and the comment above each
group of them, arrows of the programs from what their files include. An arrow goes from a room to one
that it uses; arrows that follow from others are left out. --check exits with 1 where FILE.svg is not
what would be written.
"""

import argparse
import html
import pathlib
import re
import sys
import textwrap

import check_modules

WIDTH, LEFT, MARGIN, ROW, BOX = 1040, 210, 24, 92, 34
LETTER = 7.6  # width of a letter, more or less
PROGRAMS = (("Measurements, the Python package, options", ("bench", "python", "apps/command_line")),
            ("Programs", ("apps/ros2", "apps/hapticgiant", "apps/offline", "apps/design")))


def uses_of_programs(modules):
    """Program -> rooms and programs that its files include."""
    names = [name for _, row in PROGRAMS for name in row]
    uses = {name: set() for name in names}
    for name in names:
        for path in (check_modules.ROOT / name).rglob("*"):
            if path.suffix not in (".h", ".cpp") or "test" in path.parts:
                continue
            for target in re.findall(r'^#include "([^"]+)"', path.read_text(), re.MULTILINE):
                parts = pathlib.PurePath(target).parts
                uses[name].add(check_modules.module_of(modules, parts[1:]) if parts[0] == "hg" else
                               next((other for other in names if target.startswith(other + "/")), None))
    return {name: sorted(found - {name, None}) for name, found in uses.items()}


def read_rows():
    """(title, rooms) per group of calls, in the order of CMakeLists.txt."""
    text = (check_modules.ROOT / "CMakeLists.txt").read_text()
    rows, title = [], ""
    for line in text[text.index("# The rooms of hg/"):].splitlines():
        if match := re.match(r"hg_module\((\S+?)[ )]", line):
            if not rows or rows[-1][0] != title:
                rows.append((title, []))
            rows[-1][1].append(match.group(1))
        elif match := re.match(r"# ([A-Z].*)", line):
            title = match.group(1)
    return rows


def direct(uses, name):
    """What `name` uses and does not get through another room that it uses."""
    def reachable(start):
        found, waiting = set(), list(uses[start])
        while waiting:
            room = waiting.pop()
            if room not in found:
                found.add(room)
                waiting += uses[room]
        return found
    return [room for room in sorted(uses[name])
            if not any(room in reachable(other) for other in uses[name] if other != room)]


def draw():
    modules = check_modules.read_modules()
    uses = {name: sorted(found) for name, (found, _) in modules.items()} | uses_of_programs(modules)
    rows = read_rows() + list(PROGRAMS)
    place, names, shapes = {}, {}, []
    for index, (title, rooms) in enumerate(rows):
        top = MARGIN + index * ROW
        shapes.append(f'<rect x="8" y="{top - 14}" width="{WIDTH - 16}" height="{ROW - 14}" '
                      f'fill="{"#eef3f8" if index % 2 else "#f7f5ef"}"/>')
        for line, words in enumerate(textwrap.wrap(title, 26)):
            shapes.append(f'<text x="18" y="{top + 10 + 17 * line}" class="title">'
                          f"{html.escape(words)}</text>")
        labels = [room.removeprefix("controller/") for room in rooms]
        widths = [max(64, LETTER * len(label) + 18) for label in labels]
        gap = min(60, (WIDTH - LEFT - 20 - sum(widths)) / len(rooms))
        x = LEFT + (WIDTH - LEFT - 20 - sum(widths) - gap * (len(rooms) - 1)) / 2
        for room, label, width in zip(rooms, labels, widths):
            place[room] = (x, top + 8, width)
            names[room] = label
            x += width + gap
    arrows = []
    for name in place:
        x, y, width = place[name]
        for other in direct(uses, name):
            to_x, to_y, to_width = place[other]
            start, end = x + width / 2, to_x + to_width / 2
            if to_y == y:  # neighbours of one row: an arc below them
                low = y + BOX
                path = f"M{start:.0f} {low} C{start:.0f} {low + 26} {end:.0f} {low + 26} {end:.0f} {low + 3}"
            else:
                low = to_y + BOX
                bend = (y - low) / 2
                path = (f"M{start:.0f} {y} C{start:.0f} {y - bend:.0f} {end:.0f} {low + bend:.0f} "
                        f"{end:.0f} {low + 3}")
            arrows.append(f'<path d="{path}" class="uses" marker-end="url(#head)"/>')
    boxes = []  # above the arrows
    for name, (x, y, width) in place.items():
        boxes.append(f'<rect x="{x:.0f}" y="{y}" width="{width:.0f}" height="{BOX}" rx="5" class="room"/>')
        boxes.append(f'<text x="{x + width / 2:.0f}" y="{y + 22}" class="name">{names[name]}</text>')
    height = 2 * MARGIN + ROW * len(rows) - 20
    return "\n".join([
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}">',
        "<style>text{font-family:sans-serif;fill:#223}.title{font-size:13px;fill:#667}"
        ".name{font-size:14px;text-anchor:middle}"
        ".room{fill:#fff;stroke:#456;stroke-width:1.2}"
        ".uses{fill:none;stroke:#369;stroke-opacity:.55;stroke-width:1.3}</style>",
        '<marker id="head" viewBox="0 0 8 8" refX="6" refY="4" markerWidth="6" markerHeight="6" '
        'orient="auto"><path d="M0 0L8 4L0 8z" fill="#369"/></marker>',
        f'<rect width="{WIDTH}" height="{height}" fill="#fff"/>',
        *shapes, *arrows, *boxes, "</svg>", ""])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("file", type=pathlib.Path)
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    drawing = draw()
    if not arguments.check:
        arguments.file.write_text(drawing)
    elif not arguments.file.exists() or arguments.file.read_text() != drawing:
        print(f"{arguments.file}: not the rooms of CMakeLists.txt and what programs include; make docs draws it")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
