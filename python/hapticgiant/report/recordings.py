"""`hapticgiant plot` and `hapticgiant compare`: figures of recordings, and what differs in two."""

import math
import pathlib

import numpy as np

from .. import figures
from . import pages
from .runs import Run, label_of

# smallest reported differences: half a cycle, a force that is not felt, a fraction of the allowed
# excess, an acceleration that is not felt, a share of a computing time
TIME_S, FORCE_N, EXCESS, VIBRATION, SHARE = 5e-4, 0.05, 5e-5, 5e-3, 0.02


class Recorded(dict):
    """One recording of a comparison: its facts, and the columns "cycle" and "state_hash" of all cycles."""

    def __init__(self, recorded):
        super().__init__(recorded["facts"])
        self.table = {name: np.array(column, dtype=np.uint64) for name, column in recorded["columns"].items()}


def plot(folder, runs):
    for run in runs:
        run.save_csv()
        cut = "" if run["is_complete"] else ", cut off"
        print(f"{run['file']}: {run['title']}, {run.time[-1]:.1f} s{cut}\n{run['losses']}", end="")
    drawn = [figures.Run(run.figure_facts(), run.figure_signals()) for run in runs]
    pages.draw(folder, lambda figure: figures.draw_runs(figure, drawn))
    return 0


def configuration(first, second):
    before, after = first["configuration"], second["configuration"]
    options = [" ".join(texts.get("arguments", "").split("\n")).strip() or "none"
               for texts in (before, after)]
    if options[0] != options[1]:
        yield f"options: {options[0]} -> {options[1]}"
    for name in [*before, *(name for name in after if name not in before)]:
        if name == "arguments" or before.get(name) == after.get(name):
            continue
        yield name + (": only in the first" if name not in after else
                      ": only in the second" if name not in before else ": changed")


def state(first, second):
    """Cycle by cycle, of those that both have."""
    (cycles, hashes), (other_cycles, other_hashes) = (
        (run.table["cycle"], run.table["state_hash"]) for run in (first, second))
    if cycles[0] != other_cycles[0]:
        yield f"begins with cycle {cycles[0]} / {other_cycles[0]}"
    common, rows, other_rows = np.intersect1d(cycles, other_cycles, return_indices=True)
    different = np.flatnonzero(hashes[rows] != other_hashes[other_rows])
    if len(different):
        cycle = common[different[0]]
        yield f"different from cycle {cycle} ({cycle / first['rate_Hz']:.3f} s) on"
    # beyond the end of the shorter recording there is nothing to miss
    end = min(cycles[-1], other_cycles[-1])
    only = [int((each <= end).sum()) - len(common) for each in (cycles, other_cycles)]
    if sum(only) > 0:
        yield f"{only[0]} cycles are in the first only, {only[1]} in the second only"
    if len(cycles) != len(other_cycles):
        yield f"{len(cycles)} -> {len(other_cycles)} cycles"


def events(first, second):
    """Events of the same name are compared in their order."""
    others = [(label_of(event), event["time_s"]) for event in second["events"]]
    for event in first["events"]:
        label, time_s = label_of(event), event["time_s"]
        partner = next((other for other in others if other[0] == label), None)
        if partner is None:
            yield f"{label} ({time_s:.3f} s) is missing in the second"
            continue
        others.remove(partner)
        later = partner[1] - time_s
        if abs(later) >= TIME_S:
            yield (f"{label} {1e3 * abs(later):.0f} ms {'later' if later > 0 else 'earlier'} "
                   f"({time_s:.3f} -> {partner[1]:.3f} s)")
    for label, time_s in others:
        yield f"{label} ({time_s:.3f} s) is new in the second"


def change(what, values, least, unit, digits, scale=1.0):
    """ "mean 10.5 -> 11.2 N"; nothing where the difference is at most `least`, or both have no value."""
    before, after = values
    missing = [value is None or not math.isfinite(value) for value in values]
    if any(missing):
        if not all(missing):
            yield f"{what} has no value in the {'first' if missing[0] else 'second'}"
    elif abs(after - before) > least:
        yield f"{what} {scale * before:.{digits}f} -> {scale * after:.{digits}f} {unit}"


def forces(first, second):
    before, after = first["force"], second["force"]
    for what, key, unit, digits in (("mean", "mean_N", "N", 2), ("largest", "max_N", "N", 1),
                                    ("largest torque", "max_torque_Nm", "Nm", 2)):
        yield from change(what, (before[key], after[key]), FORCE_N, unit, digits)


def limits(first, second):
    for where, before, after in (("", first, second),
                                 ("in truth ", first.get("reality"), second.get("reality"))):
        for name, limit in before["limits"].items() if before and after else ():
            if name in after["limits"]:
                values = [each["limits"][name]["worst_violation"] for each in (before, after)]
                yield from change(f"{where}{name} exceeded by", values, EXCESS, f"m{limit['unit']}", 2,
                                  1e3)


def motion(first, second):
    for what, group, key, least, unit, digits, scale in (
            ("hand and twin apart by at most", "sync_error", "max_m", EXCESS, "mm", 2, 1e3),
            ("active-set changes", "solver", "active_set_changes_per_second", 0.1, "per second", 1, 1),
            ("acceleration changes per cycle", "acceleration_change_per_cycle", "mean", 1e-3, "m/s^2",
             4, 1)):
        yield from change(what, (first[group][key], second[group][key]), least, unit, digits, scale)


def vibration(first, second):
    """Of the handle, where the device is simulated, and of hand and device."""
    before, after = first.get("reality"), second.get("reality")
    for hertz in (5, 20) if before and after else ():
        key = f"vibration_above_{hertz}_Hz_m_per_s2"
        yield from change(f"above {hertz} Hz", (before.get(key), after.get(key)), VIBRATION, "m/s^2 rms", 3)
    if "shaking" in first and "shaking" in second:  # earlier programs did not look for it
        shaken = [each["shaking"]["duration_s"] for each in (first, second)]
        yield from change("hand and device oscillate for", shaken, TIME_S, "s", 2)


def timing(first, second):
    before, after = first["cycle_time_us"], second["cycle_time_us"]
    for key, what in (("median", "median"), ("p99_9", "99.9 %"), ("max", "largest")):
        if before[key] and after[key]:  # 0: not recorded
            yield from change(what, (before[key], after[key]), SHARE * before[key], "us", 1)


def head(run):
    summary = run["summary"]
    return (f"{summary['scenario']}, law {summary['law']}, {summary['bounds']} bounds, "
            f"{run['rate_Hz']:g} Hz, {summary['duration_s']:.1f} s"
            + ("" if run["is_complete"] else ", cut off"))


def say(heading, findings, otherwise):
    for number, finding in enumerate(findings or [otherwise]):
        print(f"{'' if number else heading:<14} {finding}")


def compare(first, second):
    for name, run in (("first", first), ("second", second)):
        print(f"{name:<14} {run['file']}: {head(run)}\n{run['losses']}", end="")
    print()
    a, b = first["summary"], second["summary"]
    findings = {"configuration": list(configuration(first, second)),
                "state": list(state(first, second)), "events": list(events(first, second)),
                "forces": list(forces(a, b)), "limits": list(limits(a, b)),
                "motion": list(motion(a, b)), "vibration": list(vibration(a, b))}
    for heading, found in findings.items():
        say(heading, found, "the same in every cycle" if heading == "state" else "nothing changed")
    say("timing", list(timing(a, b)), "nothing changed, or not recorded")
    return 1 if any(findings.values()) else 0


def write(results, folder, docs=None):
    """Compares recordings, whose facts and columns are in the results, or plots those in folders."""
    del docs
    if results["kind"] == "compare":
        return compare(*map(Recorded, results["runs"]))
    return plot(folder, [Run(pathlib.Path(run)) for run in results["runs"]])
