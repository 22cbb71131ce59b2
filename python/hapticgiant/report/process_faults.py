"""The table of `hapticgiant faults --processes`."""

import json

from . import tables

LEGEND = (
    "at rest: from the stop (SIGTERM 0.3 s after the fault; the fault itself where the controller "
    "is frozen, suspended or killed)\nuntil all axes of the device stood still; way: from there "
    "on, of the stopping distance; J: given to the person\n")


def row_of(case):
    verdict = "" if case["passed"] else "  BAD" if case["has_run"] else "  BAD: it did not run"
    rest = case["at_rest_after_s"]
    return [case["fault"], case["scenario"], "never" if rest is None else f"{1e3 * rest:.0f}",
            f"{100.0 * case['travel_share']:.0f}", f"{case['energy_J']:.1f}",
            "-" if case["exit_code"] < 0 else str(case["exit_code"]), str(case["periods"]),
            str(case["recorded"]), case["what"] + verdict]


def text(results):
    cases = results["cases"]
    head = ["fault", "scenario", "at rest ms", "way %", "J", "exit", "lived", "recorded",
            "what goes wrong"]
    bad = sum(not case["passed"] for case in cases)
    return (tables.as_text([head, *map(row_of, cases)], left=(0, 1, 8)) + f"\n{LEGEND}\n"
            f"{bad} of {len(cases)} cases moved an axis farther than its stopping distance, did "
            "not come to rest, did not end, or lost more of\ntheir recording than its last "
            "second\n")


def write(folder, docs=None):
    """Writes report.txt beside results.json."""
    del docs
    results = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    (folder / "report.txt").write_text(text(results), encoding="utf-8")
