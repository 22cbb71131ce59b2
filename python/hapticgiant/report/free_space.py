"""Workspace, free space and strokes: what needs no virtual surface and no frequency."""

import math

from . import measures
from .measured import AXES, STROKES, column, curve, groups, has_worked, name_of, table
from .measures import mean


def why_workspace(first, volume):
    """How much of the handle's box is reached, and what keeps the handle from its sides."""
    if not first["has_box"]:
        return ""
    text = (f"The limits of the handle are a box of {first['box_volume']:.2f} m^3, and "
            f"{100.0 * volume / first['box_volume']:.1f} % of it is reached.")
    for side in first["unreached"]:
        text += (f" The side {AXES[side['axis']]} = {side['limit']:.2f} m is missed by "
                 f"{1e3 * side['short_by']:.0f} mm, {side['volume']:.2f} m^3 of the box")
        limits = " and ".join(f"{name} at {limit:.2f} rad" for name, limit in side["at_limit"])
        text += (f": where the handle comes nearest, {limits}" if limits else "") + "."
    return text


def add_workspace(it):
    runs = it.runs("workspace")
    first = runs[0]
    it.main("workspace_volume", column(runs, "volume"),
            why=why_workspace(first, mean(column(runs, "volume"))))
    it.extra("workspace_nominal", column(runs, "nominal_volume") if first["has_box"] else [])
    rows = [[axis, f"{low:.2f} .. {high:.2f} m", f"{high - low:.2f}"]
            for axis, low, high in zip(AXES, first["lower"], first["upper"])]
    rows.append(["mean edge", "cube of the same volume", f"{math.cbrt(first['volume']):.2f}"])
    it.tables.append(table("workspace_shape", "Workspace shape",
                           "bounds of all points that the handle reached",
                           ["axis", "reached", "edge m"], rows))
    it.workspace = first["views"]


def vibration_curve(identifier, name, run, lowest_Hz, highest_Hz):
    step = run["spectrum"]["step_Hz"]
    points = [(number * step, value) for number, value in enumerate(run["spectrum"]["magnitude"])
              if lowest_Hz <= number * step <= highest_Hz]
    return curve(identifier, name, [x for x, _ in points],
                 {"m/s^2/sqrt(Hz)": [value for _, value in points]})


def add_free_space(it):
    settings = it.settings("free space")
    body, light = settings["body"], settings["light_body"]
    runs = it.working("free space")
    shipped = [run for run in runs if run["body"] == body]
    lighter = [run for run in runs if run["body"] == light]
    it.main("free_space_force", column(shipped, "force"), body="a free body of " + name_of(body),
            duration_s=settings["duration_s"], path=mean(column(shipped, "path")),
            speed=mean(column(shipped, "speed_rms")), own=mean(column(shipped, "own_share")),
            extra=mean(column(shipped, "extra")), light=light,
            lighter=mean(column(lighter, "force")))
    it.main("free_space_vibration", column(shipped, "vibration_rms"))
    it.main("free_space_centroid", column(shipped, "centroid_Hz"), why=why_centroid(it))
    it.extra("free_space_extra", column(shipped, "extra"))
    it.extra("free_space_force_light", column(lighter, "force"), light=light)
    it.extra("free_space_vibration_light", column(lighter, "vibration_rms"))
    it.extra("free_space_vibration_seen", column(shipped, "seen_rms"),
             noise=settings["accelerometer_noise"])
    it.extra("free_space_centroid_seen", column(shipped, "seen_centroid_Hz"))
    edges = it.settings("sources of vibration")["band_edges"]
    for mass, of_body in ((body["mass"], shipped), (light["mass"], lighter)):
        if of_body:
            it.curves.append(vibration_curve("free_space", f"body of {mass:g} kg", of_body[0],
                                             edges[0], edges[-1]))
    add_sources(it, edges)


def add_sources(it, edges):
    rows = []
    for run in it.working("sources of vibration"):
        rows.append([run["name"], f"{run['vibration_rms']:.4f}", f"{run['centroid_Hz']:.1f}",
                     f"{run['force']:.3f}", f"{run['extra']:.3f}",
                     *(f"{1e3 * rms:.2f}" for rms in run["band_rms"])])
        it.curves.append(vibration_curve("vibration_sources", run["name"], run, edges[0],
                                         edges[-1]))
    it.tables.append(table(
        "vibration_sources", "What vibration comes from",
        "Free space with one imperfection of the simulated machine or person taken away at a time, "
        "one way each; the last rows change what lies between a source and the handle. Bands in "
        "Hz, rms in mm/s^2.",
        ["", "vibration m/s^2", "centroid Hz", "force N", "added force N",
         *(f"{low:g} .. {high:g}" for low, high in zip(edges, edges[1:]))], rows))


def why_centroid(it):
    """Why the spectrum ends where it does; a quick run measures too few sources to say it."""
    runs = it.runs("sources of vibration")
    shipped, *without = [run for run in runs if not run["changes_way"]]
    if len(without) < 2 or not all(map(has_worked, runs)):
        return ""

    def vibration_of(run):
        return f"{run['vibration_rms']:.4f} m/s^2 at {run['centroid_Hz']:.1f} Hz"

    centroids = column(without, "centroid_Hz")
    seconds = it.settings("sources of vibration")["duration_s"]
    quietest = min(without, key=lambda run: run["vibration_rms"])
    text = (
        f"The way to the handle makes it, not a source. On one way of {seconds:.0f} s vibration is "
        f"{vibration_of(shipped)}; with one imperfection taken away at a time the centroid stays "
        f"between {min(centroids):.1f} and {max(centroids):.1f} Hz, though "
        f"\"{quietest['name']}\" leaves only {quietest['vibration_rms']:.4f} m/s^2. Above 100 Hz "
        f"nearly nothing arrives "
        f"({math.hypot(*shipped['band_rms'][2:]):.4f} m/s^2 of {shipped['vibration_rms']:.4f}): "
        f"the springs of the joints isolate the handle above their resonances, and what noise of "
        f"the wrench asks for is low-passed before. ")
    for run in runs:
        if run["changes_way"]:
            text += f"With \"{run['name']}\" it is {vibration_of(run)}. "
    return text + (
        "What shakes a real handle there (teeth, drives, bending links) is not simulated; a higher "
        "figure means another machine or more vibration, not a better feel.")


def add_dynamics(it):
    rows = []
    quantities = ("inertia", "damping", "friction", "r2", "mean", "largest")
    fitted = [{**run, **run["fit"]} for run in it.working("strokes")]
    for (axis,), runs in groups(fitted, "axis").items():
        units = ("kg", "Ns/m", "N", "", "N", "N") if axis < 3 else (
            "kg m^2", "Nms/rad", "Nm", "", "Nm", "Nm")
        cells = [STROKES[axis]]
        for quantity, unit in zip(quantities, units):
            values, digits = column(runs, quantity), 4 if quantity == "r2" else 3
            cells.append(f"{mean(values):.{digits}f} +- "
                         f"{measures.half_width(values):.{digits}f} {unit}")
        rows.append(cells)
    it.tables.append(table(
        "local_dynamics", "Local dynamic forces and torques",
        "Fit f = inertia a + damping v + friction sign v along (about) each axis, mean and half "
        "width of the 95 % confidence interval; R^2 is how predictable the force is.",
        ["axis", "inertia", "damping", "friction", "R^2", "mean", "largest"], rows))
