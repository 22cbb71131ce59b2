"""Responses to pushes by frequency and in time, and where the device cannot keep up."""

import cmath
import math

from .measured import AXES, column, curve, groups, has_failed, has_worked, table, verdict
from .measures import mean


def number(pair):
    return complex(*pair)


def degrees(value):
    return math.degrees(cmath.phase(value))


def lowest(runs, key, count=3):
    """The worst axis; unknown when one of `count` axes has failed."""
    return [min(column(runs, key))] if len(runs) == count else []


def add_transparency(it):
    runs = it.working("transparency")
    rows = []
    for run in runs:
        name, y = AXES[run["axis"]], {}
        for answer in run["answers"]:
            felt, body = number(answer["impedance"]), number(answer["twin"])
            ratio, following = felt / body, number(answer["following"])
            point = {"ratio": abs(ratio), "phase_deg": degrees(ratio), "felt_Ns_per_m": abs(felt),
                     "body_Ns_per_m": abs(body), "following": abs(following),
                     "following_phase_deg": degrees(following)}
            for key, value in point.items():
                y.setdefault(key, []).append(value)
            rows.append([name, f"{answer['frequency_Hz']:.3g}", f"{abs(felt):.3g}",
                         f"{abs(body):.3g}", f"{abs(ratio):.3f}", f"{degrees(ratio):.1f}",
                         f"{abs(following):.3f}", f"{degrees(following):.1f}"])
        it.curves.append(curve("transparency", name, column(run["answers"], "frequency_Hz"), y))
    it.extra("transparency_bandwidth", lowest(runs, "transparency_Hz"))
    it.extra("position_bandwidth", lowest(runs, "position_Hz"), **it.settings("transparency"))
    it.tables.append(table(
        "transparency", "Transparency: impedance at the handle over the rendered body's",
        "The person pushes to and fro along one axis of the handle with 10 N; true force over true "
        "velocity. 1 and 0 degrees: the body itself.",
        ["axis", "frequency Hz", "felt Ns/m", "body Ns/m", "ratio", "phase deg",
         "handle over twin", "phase deg"], rows))


def add_force_response(it):
    runs = it.working("force response")
    rows = []
    for run in runs:
        name, y = AXES[run["axis"]], {}
        for answer in run["answers"]:
            rendered, ideal = number(answer["rendered"]), number(answer["ideal"])
            point = {"rendered": abs(rendered), "rendered_phase_deg": degrees(rendered),
                     "ideal": abs(ideal), "ideal_phase_deg": degrees(ideal)}
            for key, value in point.items():
                y.setdefault(key, []).append(value)
            rows.append([name, f"{answer['frequency_Hz']:.3g}", f"{abs(rendered):.3f}",
                         f"{degrees(rendered):.1f}", f"{abs(ideal):.3f}", f"{degrees(ideal):.1f}"])
        it.curves.append(curve("force_response", name, column(run["answers"], "frequency_Hz"), y))
    it.extra("force_bandwidth", lowest(runs, "force_Hz"))
    it.extra("force_bandwidth_absolute", lowest(runs, "absolute_Hz"))
    it.tables.append(table(
        "force_response", "Force at a hand that holds still over the commanded force",
        "Reference wrench of the rendered body to and fro with 10 N along one axis of B, the stiff "
        "hand. Ideal: the same body in the same hand without a device between them.",
        ["axis", "frequency Hz", "rendered", "phase deg", "ideal", "phase deg"], rows))


def add_latency(it):
    complete = [axes for axes in groups(it.working("latency"), "seed").values() if len(axes) == 3]
    it.extra("latency", [1e3 * mean(column(axes, "motion_s")) for axes in complete])
    it.extra("latency_rendering", [1e3 * mean(column(axes, "sensed_s")) for axes in complete])


# hard pulls, light rotations, stiff springs

def transparent_to(pushes):
    """Along the worst axis; what ended a run that was pushed too hard is a result."""
    ends = [end for run in pushes if (end := run.get("end") or run.get("failure"))]
    return ends[0] if ends else f"{min(column(pushes, 'transparency_Hz')):.1f}"


def add_felt_mass(it):
    mass = it.settings("felt mass")["mass"]
    it.working("felt mass")
    pushes = groups(it.runs("transparency of hard pushes"), "force")
    rows, points = [], []
    for (force,), pulls in groups(it.runs("felt mass"), "force").items():
        has_all = all(map(has_worked, pulls))
        worst, felt = [], []
        cells = ["failed" if any(map(has_failed, pulls)) else "not possible"] * 4
        if has_all:
            worst = [max(column(axes, "mass")) for axes in groups(pulls, "seed").values()]
            felt = [mean(column(axis, "mass")) for axis in groups(pulls, "axis").values()]
            cells = [f"{value:.2f}" for value in (*felt, mean(worst) / mass)]
        rows.append([f"{force:g}", *cells, transparent_to(pushes[force,])])
        points.append({"force": force, **dict(zip(AXES, felt))})
        it.extra("felt_mass", worst, f"felt_mass_{force:g}", force=force, mass=mass)
    it.tables.append(table(
        "felt_mass", "Felt mass",
        f"A steady force along one axis of the handle on the body of {mass:g} kg, without mass and "
        "spring of an arm: force over acceleration of the handle, mean of 0.05 to 0.25 s. And up "
        "to which frequency the impedance of pushes so hard to and fro stays within 3 dB of the "
        "body's, along the worst axis.",
        ["N", "x kg", "y kg", "z kg", "worst over the body's", "transparent to Hz"], rows, points))


def calm_from(runs):
    """The smallest of growing inertias from which all come to rest; infinite when none does."""
    smallest = math.inf
    for run in reversed(runs):
        if run["verdict"] != "stable":
            break
        smallest = run["inertia"]
    return smallest


def add_rotation(it):
    settings = it.settings("light rotations")
    has_all = len(it.working("light rotations")) == len(it.runs("light rotations"))
    hands = groups(it.runs("light rotations"), "hand")
    smallest = max(calm_from(runs) for runs in hands.values())
    it.extra("smallest_inertia", [smallest] if has_all and math.isfinite(smallest) else [])
    it.tables.append(table(
        "rotation", "Light rotations: which stay calm",
        f"A hand holds the body, whose handle is twisted with {settings['torque']:g} Nm for "
        f"{1e3 * settings['duration_s']:g} ms; calm is slower than {settings['calm_speed']:g} "
        f"rad/s after {settings['calm_s']:g} s. Columns: moment of inertia about every axis, "
        "kg m^2.",
        ["hand", *(f"{value:g}" for value in settings["inertia"])],
        [[hand, *map(verdict, runs)] for (hand,), runs in hands.items()]))


def add_springs(it):
    settings = it.settings("springs")
    runs = [{**run, **run["true_handle"]} for run in it.working("springs")]
    slowest = [min(run["frequency_Hz"] / run["ideal_Hz"] for run in of_seed)
               for of_seed in groups(runs, "seed").values()]
    rows, points = [], []
    for (stiffness, deflection), swings in groups(runs, "stiffness", "deflection").items():
        point = {key: mean(column(swings, key))
                 for key in ("ideal_Hz", "frequency_Hz", "ideal_damping", "damping_ratio")}
        points.append(point)
        first_mm = 1e3 * settings["radius"] * mean(column(swings, "amplitude"))
        rows.append([f"{stiffness:g}", f"{1e3 * deflection:g}", f"{first_mm:.1f}",
                     f"{point['ideal_Hz']:.2f}", f"{point['frequency_Hz']:.2f}",
                     f"{point['frequency_Hz'] / point['ideal_Hz']:.2f}",
                     f"{point['ideal_damping']:.3f}", f"{point['damping_ratio']:.3f}"])
    has_all = len(runs) == len(it.runs("springs"))
    it.extra("spring_frequency", slowest if has_all else [])
    it.tables.append(table(
        "springs", "Springs of a hinge",
        f"A hinge of {settings['inertia']:g} kg m^2 and {settings['damping']:g} Nms/rad, "
        f"{settings['radius']:g} m from the handle, is released beside the rest of its spring "
        f"without a hand: the first {settings['swings']} swings of the true handle beside those of "
        "the ideal hinge. A damping ratio below 0 grows.",
        ["Nm/rad", "let go at mm", "first swing mm", "ideal Hz", "Hz", "ratio",
         "ideal damping ratio", "damping ratio"], rows, points))
