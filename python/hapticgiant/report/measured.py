"""Runs of `hapticgiant haptify` by measurement, and the figures, tables and curves made of them.

The program writes results.json (hg/experiments/haptify/benchmark.h): measurements by name, each with
the settings and the results of its runs, in SI units.
"""

from .measures import BEYOND, TABLE_III, figure, finite

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


def map_body(run):
    return name_of(run["body"]) + (", prompt" if run["is_prompt"] else "")


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


NOT_POSSIBLE = "not possible: "  # begins the reason why a device cannot do a measurement


def has_worked(run):
    return not run.get("failure")


def has_failed(run):
    return not has_worked(run) and not run["failure"].startswith(NOT_POSSIBLE)


def verdict(run):
    if has_worked(run):
        return run["verdict"]
    return "failed" if has_failed(run) else "not possible"


def not_possible(name, runs):
    """A sentence per reason why the device cannot do some of the runs of a measurement."""
    reasons = {}
    for run in runs:
        if not has_worked(run) and not has_failed(run):
            reasons.setdefault(run["failure"].removeprefix(NOT_POSSIBLE), []).append(run)
    return [f"{name}, {len(found)} of {len(runs)} runs: {reason}"
            for reason, found in reasons.items()]


def column(runs, key):
    return [run[key] for run in runs]


def groups(runs, *keys):
    """Runs by the values of `keys`, in the order in which they were played."""
    found = {}
    for run in runs:
        found.setdefault(tuple(run[key] for key in keys), []).append(run)
    return found


def table(identifier, title, note, columns, rows, points=()):
    """points: numbers by name of each row, for a picture."""
    return {"id": identifier, "title": title, "note": note, "columns": columns, "rows": rows,
            "points": [{name: finite(value) for name, value in point.items()} for point in points]}


def curve(identifier, name, x, y):
    return {"id": identifier, "name": name, "x_label": "frequency in Hz", "x": x, "y": y}


class Measured:
    """What is made so far: parts of figures.json."""

    def __init__(self, measurements):
        self.measurements = measurements
        self.table, self.beyond, self.tables, self.curves = [], [], [], []
        self.workspace, self.failures, self.impossible = [], [], []

    def settings(self, name):
        return self.measurements[name]["settings"]

    def runs(self, name):
        return self.measurements[name]["runs"]

    def working(self, name):
        """The runs that have worked; the others are listed as failures."""
        self.failures += [f"{name_of_run(name, run)}: {run['failure']}" for run in self.runs(name)
                          if has_failed(run)]
        self.impossible += not_possible(name, self.runs(name))
        return [run for run in self.runs(name) if has_worked(run)]

    def main(self, key, values, **fields):
        self.table.append(figure(TABLE_III, key, values, **fields))

    def extra(self, key, values, identifier=None, **fields):
        self.beyond.append(figure(BEYOND, key, values, identifier, **fields))
