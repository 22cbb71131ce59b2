"""Virtual surfaces: sliding, pressing, calm surfaces and impacts."""

import math

from . import measures
from .measured import column, groups, has_worked, map_body, table, verdict
from .measures import BEYOND, mean


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


def over(value, other):
    return value / other if other > 0.0 else math.nan


def ratios(run):
    """What has a bound, by the figure whose goal it is."""
    known = {"impact_rebound": run["rebound"], "impact_rest": rest_of(run),
             "impact_energy": over(run["energy_out"], run["energy_in"])}
    if run["bound"] > 0.0:
        known = {"impact_depth": run["depth"] / run["allowed"], **known}
    return known


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
    motors = depths = ["-", "-"]  # the torques of the motors are not known
    if "impact_depth" in it:
        motors = [f"{run['braking']:.1f}", mm("bound")]
        depths = [f"{run['depth'] / run['bound']:.2f}", f"{it['impact_depth']:.2f}"]
    rest = f"{it['impact_rest']:.2f}" if math.isfinite(it["impact_rest"]) else "never"
    return [run["hand"], f"{run['mass']:g}", f"{run['stiffness']:g}", f"{run['speed']:.2f}",
            mm("depth"), *motors, mm("onset"), mm("spring"), *depths,
            f"{run['rebound']:.2f}", rest, f"{100.0 * it['impact_energy']:.0f}",
            f"{run['peak_force']:.0f}", f"{run['felt_force']:.0f}", ", ".join(missed(run))]


def add_impacts(it):
    settings = it.settings("impacts")
    runs = it.working("impacts")
    rebound, rest = (BEYOND[key].goal[1] for key in ("impact_rebound", "impact_rest"))
    it.tables.append(table(
        "impacts", "Impacts on a wall",
        "A hand that aims behind an upright wall without given damping runs into it with a body. "
        "The columns are the speed before the impact; the deepest point of the handle in the first "
        "contact; the deceleration a that the motors can give there against the mean force of the "
        "hand, and v^2 / (2 a); the onset, v 10 ms, of their torques in 20 ms; the deflection of the "
        "wall's spring, from the person's largest force over K and v sqrt(m / K) / e; the depth over "
        f"v^2 / (2 a), and over its bound, {settings['deepest']:g} v^2 / (2 a) and these two; the "
        f"rebound, at most {rebound:g} of the speed; the time until it stays below "
        f"{1e3 * settings['rest_speed']:g} mm/s, at most {rest:g} s; the share of its energy that "
        "the wall gives back, at most 100 %; and the largest forces of wall and person.",
        ["hand", "kg", "N/m", "m/s", "deepest mm", "a m/s^2", "v^2/(2a) mm", "onset mm",
         "spring mm", "over v^2/(2a)", "over allowed", "rebound", "rest s", "energy back %",
         "wall N", "person N", "missed"], [impact_row(run) for run in runs],
        [{"mass": run["mass"], "speed": run["speed"], **ratios(run)} for run in runs]))
    has_all = len(runs) == len(it.runs("impacts"))
    for key in ("impact_depth", "impact_rebound", "impact_rest", "impact_energy"):
        values = [ratios(run)[key] for run in runs if key in ratios(run)]
        it.extra(key, [max([0.0] + values)] if has_all and values else [], **settings)
    it.extra("impact_misses", [float(sum(bool(missed(run)) for run in runs))] if has_all else [],
             count=len(it.runs("impacts")))
