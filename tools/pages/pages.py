"""Writes what is generated from the code: reference pages, tables in pages, types of messages.

    pages.py PROGRAM [--check]     PROGRAM: hg_pages, which prints what the code says as JSON

With --check it writes nothing, prints what would change, and exits with 1 if anything would.
"""

import difflib
import json
import pathlib
import subprocess
import sys

import jinja2

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
MESSAGES_HEAD = """\
// Generated from the lists of fields in hg/viewer_server/ and hg/signals/; do not edit. Units
// stand in the names or in the comments; B is the base frame (z up), H the handle. A number
// that is not finite arrives as null.

export type Vec3 = [number, number, number];
export type Quaternion = [number, number, number, number]; // x y z w
"""


def line(cells):
    return "|" + "".join(f" {cell} |" for cell in cells) + "\n"


def table(head, rows, rule="---"):
    rules = [rule] + ["---"] * (len(head) - 1)
    return line(head).replace("|  |", "| |") + line(rules) + "".join(map(line, rows))


def replace_marked(page, name, text):
    """Replaces what stands between `<!-- NAME -->` and the next `<!-- end -->`."""
    before, mark, rest = page.partition(f"<!-- {name} -->\n")
    _, end, after = rest.partition("<!-- end -->")
    if not mark or not end:
        raise SystemExit(f"page: expected the marks <!-- {name} --> and <!-- end -->")
    return f"{before}{mark}\n{text}\n{end}{after}"


def configuration_page(facts):
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE),
                                     keep_trailing_newline=True)
    return environment.get_template("configuration.md.jinja").render(
        facts, table=lambda rows: table(["key", "default", "allowed", "meaning"], rows))


def datagram_tables(facts):
    sections = []
    for message in facts:
        size = f" (type {message['type']}, {message['bytes']} bytes)" if "type" in message else ""
        sections.append(f"### {message['title']}{size}\n\n"
                        + table(["offset", "type", "field", "unit", ""], message["rows"], rule="---:"))
    return "\n".join(sections)


def transitions_table(facts):
    def cell(text):
        return text if text in ("refused", "-") else f"**{text}**"
    return table(["event", *facts["states"]],
                 [[event, *map(cell, cells)] for event, *cells in facts["transitions"]])


def is_key(text):
    return "_" in text and "." in text and " " not in text


def threshold(text):
    """Keys of device.yaml as code."""
    return ", ".join(f"`{part}`" if is_key(part) else part for part in text.split(", "))


def check_thresholds(rules, device):
    """Ends the program where a rule names a key that device.yaml does not have."""
    known = {key for key, *_ in device}
    for rule in rules:
        for part in rule["threshold"].split(", "):
            if is_key(part) and not part.startswith("docs/") and f"`{part}`" not in known:
                raise SystemExit(f"rules.h: {rule['name']}: no key {part} of device.yaml")


def debounce(rule):
    if rule["seconds"] > 0.0:
        return f"{1e3 * rule['seconds']:g} ms"
    return "at once" if rule["samples"] == 1 else f"{rule['samples']} samples"


def rules_table(rules):
    return table(["number", "rule", "threshold", "warning from", "for", "reaction"],
                 [[rule["number"], rule["name"], threshold(rule["threshold"]),
                   f"{100.0 * rule['warn_from']:g} %" if rule["warn_from"] < 1.0 else "-",
                   debounce(rule), rule["reaction"]] for rule in rules])


def stops_list(rules):
    return "".join(f"- **{rule['number']} {rule['name']}.** {rule['meaning']} Released: "
                   f"{rule['release']}.\n" for rule in rules)


def safety_page(page, facts):
    page = replace_marked(page, "transitions", transitions_table(facts))
    page = replace_marked(page, "rules", rules_table(facts["rules"]))
    return replace_marked(page, "stops", stops_list(facts["rules"]))


def typescript(facts):
    text = MESSAGES_HEAD
    for message in facts:
        lines = [f"  {name}: {kind};" + (f" // {note}" if note else "")
                 for name, kind, note in message["fields"]]
        text += (f"\n// {message['note']}\nexport interface {message['name']} {{\n"
                 + "\n".join(lines) + "\n}\n")
    return text


# what a file should be, from its committed text and the facts
PAGES = {
    "docs/reference/configuration.md":
        lambda _, facts: configuration_page(facts["configuration"]),
    "docs/reference/device_protocol.md":
        lambda page, facts: replace_marked(page, "messages", datagram_tables(facts["datagrams"])),
    "docs/concepts/safety.md": lambda page, facts: safety_page(page, facts["safety"]),
    "viewer/src/messages.ts": lambda _, facts: typescript(facts["messages"]),
}


def main(program, is_check):
    facts = json.loads(subprocess.run([program], check=True, capture_output=True, text=True).stdout)
    check_thresholds(facts["safety"]["rules"], facts["configuration"]["device"])
    changed = 0
    for name, text_of in PAGES.items():
        file = ROOT / name
        committed = file.read_text(encoding="utf-8")
        text = text_of(committed, facts)
        if text == committed:
            continue
        changed += 1
        if is_check:
            sys.stdout.writelines(difflib.unified_diff(
                committed.splitlines(True), text.splitlines(True), name, "generated"))
        else:
            file.write_text(text, encoding="utf-8")
    print(f"pages: {changed} of {len(PAGES)} {'out of date' if is_check else 'written'}")
    return int(is_check and changed > 0)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], "--check" in sys.argv[2:]))
