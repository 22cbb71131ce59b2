"""Figures, tables and curves of `hapticgiant haptify` from what the program has played.

The program writes plays.json (hg/studies/haptify/benchmark.h): measurements by name, each with the
settings and the results of its runs, in SI units. results() makes results.json of it.
"""

import cmath
import math

from . import measures
from .measures import BEYOND, TABLE_III, figure, mean

AXES = "xyz"
REAL_AND_SIMULATED = (
    "The paper's HapticGiant, Touch and Touch X were real machines in real hands; ours is a "
    "simulated machine with assumed friction, noise and delays in a simulated hand.")
# what a failed run is called
RUNS = {
    "workspace": "workspace, seed {seed}",
    "free space": "free space, body of {body[mass]:g} kg, seed {seed}",
    "sources of vibration": "sources of vibration, {name}",
    "frictionless surface": "frictionless surface{comma}{variant}, seed {seed}",
    "stiffness": "stiffness {stiffness:g} N/m, seed {seed}",
    "peak force": "peak force, seed {seed}",
    "strokes": "strokes, {stroke}, seed {seed}",
    "transparency": "transparency along {letter}",
    "force response": "force response along {letter}",
    "latency": "latency, axis {axis}, seed {seed}",
    "Z-width": "Z-width, {body_name}, {stiffness:g} N/m, {damping:g} Ns/m",
    "impacts": "impact, {hand} hand, {mass:g} kg, {wanted_speed:g} m/s on {stiffness:g} N/m",
    "felt mass": "felt mass, {force:g} N along axis {axis}, seed {seed}",
    "light rotations": "rotation, {hand} hand, {inertia:g} kg m^2",
    "springs": "spring of {stiffness:g} Nm/rad from {mm:g} mm, seed {seed}",
}
STROKES = ("x", "y", "z", "azimuth", "pitch", "roll")


def name_of(body):
    return f"{body['mass']:g} kg, {body['damping']:g} Ns/m"


def name_of_run(measurement, run):
    more = {}
    if "axis" in run:
        more = {"letter": AXES[run["axis"] % 3], "stroke": STROKES[run["axis"]]}
    if "is_prompt" in run:
        more["body_name"] = map_body(run)
    if "variant" in run:
        more["comma"] = ", " if run["variant"] else ""
    if "deflection" in run:
        more["mm"] = 1e3 * run["deflection"]
    return RUNS[measurement].format(**run, **more)


def has_worked(run):
    return not run.get("failure")


def column(runs, key):
    return [run[key] for run in runs]


def groups(runs, *keys):
    """Runs by the values of `keys`, in the order in which they were played."""
    found = {}
    for run in runs:
        found.setdefault(tuple(run[key] for key in keys), []).append(run)
    return found


def table(identifier, title, note, columns, rows):
    return {"id": identifier, "title": title, "note": note, "columns": columns, "rows": rows}


def curve(identifier, name, x, y):
    return {"id": identifier, "name": name, "x_label": "frequency in Hz", "x": x, "y": y}


class Benchmark:
    """What is measured so far: parts of results.json."""

    def __init__(self, measurements):
        self.measurements = measurements
        self.table, self.beyond, self.tables, self.curves = [], [], [], []
        self.workspace, self.failures = [], []

    def settings(self, name):
        return self.measurements[name]["settings"]

    def runs(self, name):
        return self.measurements[name]["runs"]

    def working(self, name):
        """The runs that have worked; the others are listed as failures."""
        self.failures += [f"{name_of_run(name, run)}: {run['failure']}" for run in self.runs(name)
                          if not has_worked(run)]
        return [run for run in self.runs(name) if has_worked(run)]

    def main(self, key, values, **fields):
        self.table.append(figure(TABLE_III, key, values, **fields))

    def extra(self, key, values, identifier=None, **fields):
        self.beyond.append(figure(BEYOND, key, values, identifier, **fields))


def results(plays):
    """The content of results.json."""
    it = Benchmark(plays["measurements"])
    for add in (add_workspace, add_free_space, add_sliding, add_stiffness, add_peak, add_dynamics,
                add_transparency, add_force_response, add_latency, add_z_width, add_impacts,
                add_felt_mass, add_rotation, add_springs):
        add(it)
    return {**{key: value for key, value in plays.items() if key != "measurements"},
            "real_and_simulated": REAL_AND_SIMULATED, "failures": it.failures, "table": it.table,
            "beyond": it.beyond, "tables": it.tables, "curves": it.curves,
            "workspace": it.workspace}


# workspace and free space

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
    it.extra("workspace_nominal", column(runs, "nominal_volume"))
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

    def told(run):
        return f"{run['vibration_rms']:.4f} m/s^2 at {run['centroid_Hz']:.1f} Hz"

    centroids = column(without, "centroid_Hz")
    quietest = min(without, key=lambda run: run["vibration_rms"])
    text = (
        f"The way to the handle makes it, not a source. On one way of "
        f"{it.settings('sources of vibration')['duration_s']:.0f} s vibration is {told(shipped)}; "
        f"with one imperfection taken away at a time the centroid stays between "
        f"{min(centroids):.1f} and {max(centroids):.1f} Hz, though \"{quietest['name']}\" leaves "
        f"only {quietest['vibration_rms']:.4f} m/s^2. Above 100 Hz nearly nothing arrives "
        f"({math.hypot(*shipped['band_rms'][2:]):.4f} m/s^2 of {shipped['vibration_rms']:.4f}): "
        f"the springs of the joints isolate the handle above their resonances, and what noise of "
        f"the wrench asks for is low-passed before. ")
    for run in runs:
        if run["changes_way"]:
            text += f"With \"{run['name']}\" it is {told(run)}. "
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


# surfaces

def add_sliding(it):
    settings = it.settings("frictionless surface")
    by_variant = groups(it.working("frictionless surface"), "variant")
    shipped = by_variant.get(("",), [])
    means = {key: mean(column(shipped, key))
             for key in ("inertial", "viscous", "extra", "normal", "speed")}
    it.main("frictionless_surface", column(shipped, "force"), **settings, **means,
            own=mean(column(shipped, "own_share")),
            lighter=mean(column(by_variant.get(("lighter body",), []), "force")),
            slower=mean(column(by_variant.get(("slower strokes",), []), "force")))
    it.extra("frictionless_surface_extra", column(shipped, "extra"))


def add_stiffness(it):
    settings = it.settings("stiffness")
    runs = it.working("stiffness")
    values = [mean(column(of_seed, "accuracy")) for of_seed in groups(runs, "seed").values()
              if len(of_seed) == len(settings["stiffness"])]
    rows, twin = [], []
    for (stiffness,), presses in groups(runs, "stiffness").items():
        accuracy = column(presses, "accuracy")
        twin.append(mean(column(presses, "twin_accuracy")))
        rows.append([f"{stiffness:g}",
                     f"{mean(accuracy):.2f} +- {measures.half_width(accuracy):.2f}",
                     f"{twin[-1]:.2f}", f"{mean(column(presses, 'force')):.1f}"])
    it.main("stiffness_accuracy", values, force=settings["force"], twin=mean(twin),
            planes=", ".join(f"{value:g}" for value in settings["stiffness"]))
    it.tables.append(table(
        "stiffness", "Stiffness of virtual surfaces",
        "Depth of the handle, and of the rendered body alone: the difference is how far the device "
        "is behind its reference under load.",
        ["N/m", "accuracy %", "of the rendered body %", "largest force N"], rows))


def add_peak(it):
    settings = it.settings("peak force")
    runs = it.working("peak force")
    end = runs[0]["end"] if runs else ""
    it.main("stiffness_peak_force", column(runs, "force"), **settings,
            percent=100.0 * settings["tolerance"], end=end and f"; it ended: {end}",
            why=end and f"It ended: {end}.")


def map_body(run):
    return name_of(run["body"]) + (", prompt" if run["is_prompt"] else "")


def verdict(run):
    return run["verdict"] if has_worked(run) else "failed"


def stiffest_calm(undamped):
    """The largest of growing stiffnesses up to which all come to rest; 0 if the first does not."""
    most = 0.0
    for run in undamped:
        if run["verdict"] != "stable":
            break
        most = run["stiffness"]
    return most


def add_z_width(it):
    settings = it.settings("Z-width")
    it.working("Z-width")
    rows, bodies = [], {}
    for run in it.runs("Z-width"):
        bodies.setdefault(map_body(run), []).append(run)
    for number, (name, runs) in enumerate(bodies.items()):
        for (stiffness,), row in groups(runs, "stiffness").items():
            swing_Hz = math.sqrt(stiffness / row[0]["body"]["mass"]) / (2.0 * math.pi)
            rows.append([name, f"{stiffness:g}", f"{swing_Hz:.1f}", *map(verdict, row)])
        undamped = [run for run in runs if run["damping"] == settings["damping"][0]]
        if not runs[0]["is_prompt"] and all(map(has_worked, undamped)):
            it.extra("z_width", [stiffest_calm(undamped)], "z_width_light" if number else None,
                     body=name, largest_stiffness=settings["largest_stiffness"])
    it.tables.append(table(
        "z_width", "Z-width: which surfaces stay calm",
        "A normal hand presses with 10 N on a plane and is kicked (15 N for 10 ms); the rows are "
        "body and stiffness, with the frequency at which the body would swing on the spring alone, "
        "the columns damping of the plane. Prompt: the wrench without the delays of sensor and "
        "low-pass.",
        ["body", "N/m", "Hz", *(f"{value:g} Ns/m" for value in settings["damping"])], rows))


def rest_of(run):
    """Time to rest, s; infinite where it does not come."""
    return math.inf if math.isnan(run["rest_s"]) else run["rest_s"]


def ratios(run):
    """What has a bound, by the figure whose goal it is."""
    return {"impact_depth": run["depth"] / run["allowed"], "impact_rebound": run["rebound"],
            "impact_rest": rest_of(run), "impact_energy": run["energy_out"] / run["energy_in"]}


def missed(run):
    """Names of the bounds that an impact misses, after what ended it."""
    names = {"impact_depth": "depth", "impact_rebound": "rebound", "impact_rest": "rest",
             "impact_energy": "energy"}
    return [run["end"]] * bool(run["end"]) + [
        names[key] for key, value in ratios(run).items()
        if not measures.within(value, BEYOND[key].goal)]


def impact_row(run):
    def mm(key):
        return f"{1e3 * run[key]:.1f}"

    it = ratios(run)
    rest = f"{it['impact_rest']:.2f}" if math.isfinite(it["impact_rest"]) else "never"
    return [run["hand"], f"{run['mass']:g}", f"{run['stiffness']:g}", f"{run['speed']:.2f}",
            mm("depth"), f"{run['braking']:.1f}", mm("bound"), mm("onset"), mm("spring"),
            f"{run['depth'] / run['bound']:.2f}", f"{it['impact_depth']:.2f}",
            f"{run['rebound']:.2f}", rest, f"{100.0 * it['impact_energy']:.0f}",
            f"{run['peak_force']:.0f}", f"{run['felt_force']:.0f}", ", ".join(missed(run))]


def add_impacts(it):
    settings = it.settings("impacts")
    runs = it.working("impacts")
    rebound, rest = (BEYOND[key].goal[1] for key in ("impact_rebound", "impact_rest"))
    it.tables.append(table(
        "impacts", "Impacts on a wall",
        "A hand that aims behind an upright wall runs into it with a body; the wall says no "
        "damping. Speed just before it; deepest point of the handle in the first contact; a, with "
        "which the motors can brake it there against the mean force of the hand, and v^2 / (2 a); "
        "what the 20 ms of their torques cost, v 10 ms; what the wall gives by itself, the "
        "person's largest force over K and v sqrt(m / K) / e; depth over v^2 / (2 a), and over "
        f"what it may be, {settings['deepest']:g} v^2 / (2 a) and these two. Largest speed away "
        f"from the wall over that of the impact, at most {rebound:g}; when it is slower than "
        f"{1e3 * settings['rest_speed']:g} mm/s for good, at most {rest:g} s; what the wall gives "
        "back of the energy that the device took with it, at most 100 %; largest forces of wall "
        "and person.",
        ["hand", "kg", "N/m", "m/s", "deepest mm", "a m/s^2", "v^2/(2a) mm", "onset mm",
         "spring mm", "over v^2/(2a)", "over allowed", "rebound", "rest s", "energy back %",
         "wall N", "person N", "missed"], [impact_row(run) for run in runs]))
    has_all = len(runs) == len(it.runs("impacts"))
    for key in ("impact_depth", "impact_rebound", "impact_rest", "impact_energy"):
        worst = max([0.0] + [ratios(run)[key] for run in runs])
        it.extra(key, [worst] if has_all else [], **settings)
    it.extra("impact_misses", [float(sum(bool(missed(run)) for run in runs))] if has_all else [],
             count=len(it.runs("impacts")))


# responses

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
    ends = [run["end"] for run in pushes if run["end"]]
    return ends[0] if ends else f"{min(column(pushes, 'transparency_Hz')):.1f}"


def add_felt_mass(it):
    mass = it.settings("felt mass")["mass"]
    it.working("felt mass")
    pushes = groups(it.runs("transparency of hard pushes"), "force")
    rows = []
    for (force,), pulls in groups(it.runs("felt mass"), "force").items():
        has_all = all(map(has_worked, pulls))
        worst = [max(column(axes, "mass")) for axes in groups(pulls, "seed").values()] * has_all
        felt = [mean(column(axis, "mass")) for axis in groups(pulls, "axis").values()]
        cells = [f"{value:.2f}" for value in (*felt, mean(worst) / mass)]
        rows.append([f"{force:g}", *(cells if has_all else ["failed"] * 4),
                     transparent_to(pushes[force,])])
        it.extra("felt_mass", worst, f"felt_mass_{force:g}", force=force, mass=mass)
    it.tables.append(table(
        "felt_mass", "Felt mass",
        f"A steady force along one axis of the handle on the body of {mass:g} kg, without mass and "
        "spring of an arm: force over acceleration of the handle, mean of 0.05 to 0.25 s. And up "
        "to which frequency the impedance of pushes so hard to and fro stays within 3 dB of the "
        "body's, along the worst axis.",
        ["N", "x kg", "y kg", "z kg", "worst over the body's", "transparent to Hz"], rows))


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
    rows = []
    for (stiffness, deflection), swings in groups(runs, "stiffness", "deflection").items():
        frequency, ideal = mean(column(swings, "frequency_Hz")), swings[0]
        rows.append([f"{stiffness:g}", f"{1e3 * deflection:g}",
                     f"{1e3 * settings['radius'] * mean(column(swings, 'amplitude')):.1f}", f"{ideal['ideal_Hz']:.2f}",
                     f"{frequency:.2f}", f"{frequency / ideal['ideal_Hz']:.2f}",
                     f"{ideal['ideal_damping']:.3f}",
                     f"{mean(column(swings, 'damping_ratio')):.3f}"])
    has_all = len(runs) == len(it.runs("springs"))
    it.extra("spring_frequency", slowest if has_all else [])
    it.tables.append(table(
        "springs", "Springs of a hinge",
        f"A hinge of {settings['inertia']:g} kg m^2 and {settings['damping']:g} Nms/rad, "
        f"{settings['radius']:g} m from the handle, that nobody holds, is let go beside the rest "
        f"of its spring: the first {settings['swings']} swings of the true handle beside those of "
        "the hinge by itself. A damping ratio below 0 grows.",
        ["Nm/rad", "let go at mm", "first swing mm", "ideal Hz", "Hz", "ratio",
         "ideal damping ratio", "damping ratio"], rows))
