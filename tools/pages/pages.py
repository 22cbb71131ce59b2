"""Writes what is generated from the code: tables of pages as CSV beside them, types of messages.

    pages.py PROGRAM [--check]     PROGRAM: hg_pages, which prints what the code says as JSON

With --check it writes nothing, prints what would change, and exits with 1 if anything would.
"""

import csv
import difflib
import io
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
MESSAGES_HEAD = """\
// Generated from the lists of fields in hg/viewer_server/ and hg/signals/; do not edit. Units
// stand in the names or in the comments; B is the base frame (z up), H the handle. A number
// that is not finite arrives as null.

export type Vec3 = [number, number, number];
export type Quaternion = [number, number, number, number]; // x y z w
"""


def as_csv(rows):
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()


def replace_marked(page, name, text):
    """Replaces what stands between `<!-- NAME -->` and the next `<!-- end -->`."""
    before, mark, rest = page.partition(f"<!-- {name} -->\n")
    _, end, after = rest.partition("<!-- end -->")
    if not mark or not end:
        raise SystemExit(f"page: expected the marks <!-- {name} --> and <!-- end -->")
    return f"{before}{mark}\n{text}\n{end}{after}"


def configuration_rows(rows):
    return [["key", "default", "allowed", "meaning"], *rows]


def message_list(facts):
    """A sentence on the messages and their sizes."""
    return "".join(f"- {message['title']}: type {message['type']}, {message['bytes']} bytes\n"
                   for message in facts if "type" in message)


def datagram_rows(facts):
    """Head and rows of all messages, one under the other."""
    return [["message", "offset", "type", "field", "unit", ""]] + [
        [message["title"].lower(), *row] for message in facts for row in message["rows"]]


def transition_rows(facts):
    def cell(text):
        return text if text in ("refused", "-") else f"**{text}**"
    return [["event", *facts["states"]]] + [
        [event, *map(cell, cells)] for event, *cells in facts["transitions"]]


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


def rule_rows(rules):
    return [["number", "rule", "threshold", "warning from", "for", "reaction", "meaning", "released"]] + [
        [rule["number"], rule["name"], threshold(rule["threshold"]),
         f"{100.0 * rule['warn_from']:g} %" if rule["warn_from"] < 1.0 else "-",
         debounce(rule), rule["reaction"], rule['meaning'], rule["release"]] for rule in rules]


def typescript(facts):
    text = MESSAGES_HEAD
    for message in facts:
        lines = [f"  {name}: {kind};" + (f" // {note}" if note else "")
                 for name, kind, note in message["fields"]]
        text += (f"\n// {message['note']}\nexport interface {message['name']} {{\n"
                 + "\n".join(lines) + "\n}\n")
    return text


KINDS = ("device", "tool", "simulation", "twin", "script", "channels_base", "channels_cylindrical",
         "channels", "scenario", "machine")


def files_of(facts, read):
    """Name -> text of each generated file; `read` gives the text that a page has."""
    reference, concepts = "docs/reference", "docs/concepts"
    protocol = f"{reference}/device_protocol.md"
    files = {f"{reference}/configuration_{kind}.csv": as_csv(configuration_rows(facts["configuration"][kind]))
             for kind in KINDS}
    files[f"{reference}/device_protocol_messages.csv"] = as_csv(datagram_rows(facts["datagrams"]))
    files[protocol] = replace_marked(read(protocol), "messages", message_list(facts["datagrams"]))
    files[f"{concepts}/safety_transitions.csv"] = as_csv(transition_rows(facts["safety"]))
    files[f"{concepts}/safety_rules.csv"] = as_csv(rule_rows(facts["safety"]["rules"]))
    files["viewer/src/messages.ts"] = typescript(facts["messages"])
    return files


def read_file(name):
    file = ROOT / name
    return file.read_text(encoding="utf-8") if file.exists() else ""


def main(program, is_check):
    facts = json.loads(subprocess.run([program], check=True, capture_output=True, text=True).stdout)
    check_thresholds(facts["safety"]["rules"], facts["configuration"]["device"])
    files = files_of(facts, read_file)
    changed = [name for name, text in files.items() if read_file(name) != text]
    for name in changed:
        if is_check:
            sys.stdout.writelines(difflib.unified_diff(
                read_file(name).splitlines(True), files[name].splitlines(True), name, "generated"))
        else:
            (ROOT / name).write_text(files[name], encoding="utf-8")
    print(f"pages: {len(changed)} of {len(files)} {'out of date' if is_check else 'written'}")
    return int(is_check and bool(changed))


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], "--check" in sys.argv[2:]))
