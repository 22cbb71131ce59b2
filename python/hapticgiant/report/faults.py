"""Verdicts and tables of `hapticgiant faults`: what the machine did about injected faults."""

import collections
import json
import statistics

from . import pages, tables

HEAD = ["fault", "cases", "noticed", "harmless", "unnoticed", "noticed ms", "at rest ms", "stop",
        "N", "outside", "way %", "J", "most often"]
LEGEND = (
    "noticed and at rest: median / longest of faults alone, in ms after they began and after they "
    "were noticed;\nN: largest force of the person; outside: furthest true position outside a "
    "limit of the device, rad or m;\nway: longest motion of an axis without a command, of the "
    "stopping distance; J: largest energy\ngiven to the person in a stop\n")


def in_words(fault, units):
    return (f"{fault['fault']} of {fault['index']} by {fault['magnitude']:.4g} "
            f"{units[fault['fault']]} at {fault['at_s']:.3f} s")


def has_fallen(case):
    """Once the power is off, no software holds an axis whose brake fails: it has to be reported."""
    is_weak = any(it.get("fault") == "brake_weak" for it in (case, case.get("and", {})))
    return is_weak and case.get("brake_slips", False) and not case["travel_share"] <= 1.0


def has_passed(results, case):
    if (case["outcome"] == "unnoticed" or not case["recording_complete"]
            or not case["peak_force_N"] <= results["force_bound_N"]):  # NaN has not passed
        return False
    return case["has_fallen"] or (
        case["worst_excess"] <= results["excess_bound"] and case["travel_share"] <= 1.0
        and case["energy_J"] <= results["energy_bound_J"])


def judge(results):
    """Adds the verdicts."""
    units = {kind["name"]: kind["unit"] for kind in results["kinds"]}
    for case in results["cases"]:
        case["has_fallen"] = has_fallen(case)
        case["passed"] = has_passed(results, case)
        case["in_words"] = in_words(case, units)
        if "and" in case:
            case["and"] = in_words(case["and"], units)
    results["passed"] = all(case["passed"] for case in results["cases"])


def range_text(seconds):
    if not seconds:
        return "-"
    ms = [1e3 * value for value in seconds]
    return f"{statistics.median_high(ms):.0f} / {max(ms):.0f}"


def most_frequent(values):
    return collections.Counter(values).most_common(1)[0][0] if values else ""


def row_of(kind, cases):
    """Cells of the cases of one kind."""
    outcomes = collections.Counter(case["outcome"] for case in cases)
    noticed = [case for case in cases if case["outcome"] == "noticed"]
    alone = [case for case in noticed if "and" not in case]  # the other may have stopped the device
    codes = [f"{case['code']} {case['code_in_words']}" if case["code"] else "no fault"
             for case in noticed]

    def worst(key):
        return max(case[key] for case in cases)

    return [kind, str(len(cases)), *(str(outcomes[it]) for it in ("noticed", "harmless",
                                                                  "unnoticed")),
            range_text([case["noticed_s"] for case in alone]),
            range_text([case["at_rest_after_s"] for case in alone if "at_rest_after_s" in case]),
            most_frequent([case["stop"] for case in noticed]), f"{worst('peak_force_N'):.0f}",
            f"{worst('worst_excess'):.4f}", f"{100.0 * worst('travel_share'):.0f}",
            f"{worst('energy_J'):.1f}", most_frequent(codes)]


def table_of(results):
    rows = [HEAD]
    for kind in results["kinds"]:
        cases = [case for case in results["cases"] if case["fault"] == kind["name"]]
        if cases:
            rows.append(row_of(kind["name"], cases))
    return rows


def case_text(number, case):
    other = f" and {case['and']}" if "and" in case else ""
    lost = "" if case["recording_complete"] else ", its recording has lost cycles"
    return (f"case {number}: {case['in_words']}{other} in {case['scenario']}, {case['phase']}: "
            f"{case['outcome']} {case.get('code', 0)}, {case['peak_force_N']:.0f} N, "
            f"{case['worst_excess']:.3f} outside, {case['worst_distance_m']:.3f} m, way "
            f"{100.0 * case['travel_share']:.0f} %, {case['energy_J']:.1f} J{lost}\n")


def verdict(results):
    cases = results["cases"]
    bad = sum(not case["passed"] for case in cases)
    fallen = sum(case["has_fallen"] for case in cases)
    text = (f"{bad} of {len(cases)} cases went unnoticed, took the device farther than "
            f"{results['excess_bound']:g} rad or m outside a limit or an axis farther than its "
            f"stopping distance, pushed the person with more than {results['force_bound_N']:g} N, "
            f"gave more than {results['energy_bound_J']:g} J in a stop, or are missing from their "
            "recording")
    if fallen:
        text += (f"; {fallen} of {len(cases)} cases fell because a brake did not hold, which was "
                 "reported (323): no software holds such an axis")
    return text


def text(results):
    """For a terminal: the table, and the cases that failed."""
    failed = [case_text(number, case) for number, case in enumerate(results["cases"])
              if not case["passed"]]
    return "".join([tables.as_text(table_of(results), left=(0, 7, 12)), "\n", LEGEND, "\n",
                    *failed, *(f"{line}\n" for line in impossible(results)), verdict(results),
                    "\n"])


def impossible(results):
    """A sentence per reason why the device cannot have faults; they are not played."""
    reasons = {}
    for it in results.get("impossible", []):
        reasons.setdefault(it["why"], []).append(it["fault"])
    return [f"not possible, {why}: {', '.join(names)}" for why, names in reasons.items()]


def rows_of_kinds(results):
    rows = [["fault", "what goes wrong", "magnitude"]]
    for kind in results["kinds"]:
        sign = "+- " if kind["has_sign"] else ""
        rows.append([kind["name"], kind["what"],
                     f"{sign}{kind['least']:g} .. {kind['most']:g} {kind['unit']}"
                     if kind["unit"] else "-"])
    return rows


def outcomes_text(results):
    count = collections.Counter(case["outcome"] for case in results["cases"])
    return f"{count['noticed']} cases were noticed, {count['harmless']} were harmless."


def page(results, form=pages.in_text):
    """docs/reports/fault_campaign.md; `form` writes its tables."""
    return (f"# Results of {len(results['cases'])} cases with injected faults\n\n"
            "Written by `hapticgiant faults`; "
            "[safety.md](../concepts/safety.md#injected-faults) explains the columns.\n"
            f"Seed {results['seed']}; {', '.join(results['scenarios'])}: {verdict(results)}. "
            f"{outcomes_text(results)}\n\n{form(table_of(results), 'results', most=0)}\n"
            + "".join(f"{line}.\n\n" for line in impossible(results)) +
            "## The faults\n\nFor `faults` of a scenario "
            "and the drawn sizes of this campaign; a torque of the force sensor is in Nm and gets "
            f"a\ntenth.\n\n{form(rows_of_kinds(results), 'kinds', most=0)}")


def write(results, folder, docs=None):
    """Writes report.md and faults.json, and docs/reports/fault_campaign.md with its tables."""
    results = pages.with_numbers(results)
    judge(results)
    print(text(results), end="")
    as_nulls = json.loads(json.dumps(results | {"version": pages.version}), parse_constant=lambda _: None)
    pages.save(folder / "faults.json", json.dumps(as_nulls, indent=2) + "\n")
    (folder / "report.md").write_text(page(results), encoding="utf-8")
    if docs:
        file = docs / "fault_campaign.md"
        pages.save(file, f"{page(results, pages.PageTables(file)).rstrip()}\n\n{pages.stamp()}\n")
    return 0 if results["passed"] else 1
