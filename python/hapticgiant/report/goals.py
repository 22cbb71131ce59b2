"""Figures of `hapticgiant haptify --goals` from the results of all runs; see measured.py."""

from .measured import REAL_AND_SIMULATED, column, groups, has_failed, has_worked, not_possible, table
from .measures import GOALS, figure, goal_text, mean, within

CONDITION = ("seed", "height", "hand")


def each(key, factor=1.0):
    """A value per run."""
    return lambda runs: [factor * run[key] for run in runs if has_worked(run)]


def over(combine, key, factor=1.0):
    """A value per condition of several runs, for example axes; none where one has failed."""
    return lambda runs: [factor * combine(column(of_one, key))
                         for of_one in groups(runs, *CONDITION).values()
                         if all(map(has_worked, of_one))]


def is_calm(runs):
    return [float(run["verdict"] == "stable") for run in runs if has_worked(run)]


# figure: measurement, and the values of its runs
SOURCES = {
    "transparency_10N": ("transparency, 10 N", over(min, "transparency_Hz")),
    "transparency_40N": ("transparency, 40 N", over(min, "transparency_Hz")),
    "latency": ("latency", over(mean, "motion_s", 1e3)),
    "free_space_extra": ("free space", each("extra")),
    "vibration": ("free space", each("vibration_rms")),
    "centroid": ("free space", each("centroid_Hz")),
    "distance": ("free space", each("distance_rms", 1e3)),
    "kick_0.3kg": ("kick, 0.3 kg", each("last_speed", 1e3)),
    "kick_0.4kg": ("kick, 0.4 kg", each("last_speed", 1e3)),
    "wall_6kg": ("plane of 20 kN/m, 6 kg", is_calm),
    "wall_3kg": ("plane of 20 kN/m, 3 kg", is_calm),
    "stiffness_accuracy": ("stiffness", over(mean, "accuracy")),
    "free_space_force": ("free space, light body", each("force")),
    "vibration_light": ("free space, light body", each("vibration_rms")),
    "frictionless_surface": ("frictionless surface", each("force")),
}


def goals_table(figures):
    """A row per goal: median, least and largest of all runs, and how many are within."""
    rows = []
    for it in figures:
        values = sorted(it["values"])
        goal = it["goal_min"], it["goal_max"]
        shown = ("-", "-", "-")
        if values:
            shown = (f"{value:.{it['digits']}f}"
                     for value in (values[len(values) // 2], values[0], values[-1]))
        is_bounded = goal_text(goal) != "-"
        met = sum(within(value, goal) for value in values)
        rows.append([it["name"], it["unit"], it["goal"], *shown,
                     f"{met} of {len(values)}" if is_bounded else "-", it["note"]])
    return table("goals", "Goals over seeds, heights and hands", "",
                 ["figure", "unit", "goal", "median", "least", "largest", "within", "conditions"],
                 rows)


def figures(results):
    """The content of figures.json."""
    measurements = results["measurements"]
    failures = [f"{name}, seed {run['seed']}, {run['height']:g} m, {run['hand']} hand: "
                f"{run['failure']}"
                for name, it in measurements.items() for run in it["runs"] if has_failed(run)]
    impossible = [line for name, it in measurements.items() for line in not_possible(name, it["runs"])]
    measured = [figure(GOALS, key, values(measurements[name]["runs"]),
                       **measurements[name]["settings"]["body"])
                for key, (name, values) in SOURCES.items()]
    return {**{key: value for key, value in results.items() if key != "measurements"},
            "real_and_simulated": REAL_AND_SIMULATED, "failures": failures, "impossible": impossible, "table": [],
            "beyond": measured, "tables": [goals_table(measured)], "curves": [], "workspace": []}
