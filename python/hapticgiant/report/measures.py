"""The measures of `hapticgiant haptify`: names, units, goals, published values and texts.

One table for each part of a report, in the order of its rows. Texts may have fields, `{mass:g}`,
which figure() fills.
"""

import dataclasses
import math

from scipy.special import stdtrit


@dataclasses.dataclass(frozen=True)
class Measure:
    """What is known about a figure before it is measured."""
    name: str
    unit: str = ""
    digits: int = 2  # after the decimal point
    goal: tuple = (None, None)  # least and largest value of the mean; None = no bound
    published: tuple = (None, None, None)  # Table III of the paper: its machine, Touch, Touch X
    note: str = ""  # conditions of the measurement
    why: str = ""  # cause of the value, for a missed goal


TABLE_III = {
    "workspace_volume": Measure(
        "Workspace volume", "m^3", goal=(12.2, None), published=(12.2, 11.8e-3, 10.4e-3),
        note="of the handle in any orientation: joint limits, distance to the singularity, travel "
             "of the gantry and walls all hold",
        why="{why}"),
    "free_space_force": Measure(
        "Mean free-space force", "N", goal=(None, 0.7), published=(1.28, 0.98, 0.87),
        note="{body}; {duration_s:.0f} s, {path:.1f} m of random strokes through the workspace at "
             "{speed:.2f} m/s rms",
        why="{own:.2f} N of it is what {body} needs for this motion (mass times acceleration, "
            "damping times velocity); the device adds {extra:.2f} N to that (mean norm of the "
            "difference). Rendered as {light[mass]:g} kg, {light[damping]:g} Ns/m on the same "
            "strokes it is {lighter:.2f} N."),
    "free_space_vibration": Measure(
        "Free-space vibration, RMS", "m/s^2", 3, goal=(None, 0.1), published=(0.81, 0.07, 0.04),
        note="of the same strokes; above 20 Hz, DFT321"),
    "free_space_centroid": Measure(
        "Free-space vibration, spectral centroid", "Hz", 1, goal=(90.0, None),
        published=(77.3, 123.0, 162.8),
        note="of the same signal, 20 to 500 Hz, weighted with magnitude",
        why="{why}"),
    "frictionless_surface": Measure(
        "Frictionless surface rendering force", "N", goal=(None, 0.4), published=(1.96, 0.53, 0.38),
        note="tangential, on a plane of {stiffness:g} N/m; strokes of {stroke:g} m at {speed:.2f} "
             "m/s on average, pressed with {normal:.1f} N",
        why="{own:.2f} N of it is what the rendered body needs for the strokes (mass times "
            "acceleration {inertial:.2f} N, damping times velocity {viscous:.2f} N on average); "
            "device and surface add {extra:.2f} N to that (mean norm of the difference). Rendered "
            "as {light_body[mass]:g} kg, {light_body[damping]:g} Ns/m it is {lighter:.2f} N; with "
            "strokes of {slow_stroke_s:g} instead of {stroke_s:g} s it is {slower:.2f} N. The goal "
            "lies between Touch X and Touch, which render no body."),
    "stiffness_accuracy": Measure(
        "Stiffness rendering accuracy", "%", 1, goal=(99.0, 101.0), published=(109.0, 47.0, 80.0),
        note="slope of force over depth while a stiff hand presses slowly up to {force:g} N on a "
             "plane; mean of {planes} N/m",
        why="With the depth of the rendered body instead of the handle it is {twin:.1f} %, where "
            "mass and damping of body and surface add to the spring; the rest is how far the "
            "joints give way."),
    "stiffness_peak_force": Measure(
        "Stiffness peak force", "N", 1, goal=(80.0, None), published=(76.7, 2.7, 5.7),
        note="on a plane of {stiffness:g} N/m, within {percent:g} % of its line; the person stops "
             "at {force:g} N, the monitor would at {force_max:g} N{end}",
        why="{why}"),
}

BEYOND = {
    "workspace_nominal": Measure(
        "Workspace in the nominal orientation", "m^3",
        note="the handle as in the goal posture of prepositioning"),
    "free_space_extra": Measure(
        "Free-space force that the device adds", "N",
        note="mean norm of f - (m a + b v), below 20 Hz"),
    "free_space_force_light": Measure(
        "Mean free-space force, body of {light[mass]:g} kg, {light[damping]:g} Ns/m", "N",
        note="the same strokes"),
    "free_space_vibration_light": Measure(
        "Free-space vibration of that body, RMS", "m/s^2", 3, note="the same strokes"),
    "free_space_vibration_seen": Measure(
        "Free-space vibration as an accelerometer shows it, RMS", "m/s^2", 3,
        note="true vibration plus the noise of an accelerometer like the device's own, {noise:g} "
             "m/s^2/sqrt(Hz)"),
    "free_space_centroid_seen": Measure("Its spectral centroid", "Hz", 1, note="of that signal"),
    "frictionless_surface_extra": Measure(
        "Frictionless surface force that device and surface add", "N",
        note="tangential, mean norm of f - (m a + b v)"),
    "transparency_bandwidth": Measure(
        "Transparency bandwidth", "Hz", 1,
        note="up to here the felt impedance is within 3 dB of the body's, along the worst axis of "
             "the handle"),
    "position_bandwidth": Measure(
        "Position bandwidth", "Hz", 1,
        note="up to here the handle follows the rendered body within 3 dB, of {highest_Hz:g} Hz at "
             "most; along the worst axis"),
    "force_bandwidth": Measure(
        "Force bandwidth", "Hz", 1,
        note="up to here the force at a stiff hand is within 3 dB of what the same body without a "
             "device gives; along the worst axis of B"),
    "force_bandwidth_absolute": Measure(
        "Force bandwidth of body and hand", "Hz", 1,
        note="up to here the force at that hand is within 3 dB of the commanded one: the body's "
             "mass on the hand's spring swings"),
    "latency": Measure(
        "Latency from wrench to motion", "ms",
        note="by how much the handle's velocity after a step of 10 N is behind that of the body "
             "itself; mean of three axes per repetition"),
    "latency_rendering": Measure(
        "of it until the rendered body moves", "ms",
        note="sensor, its filter and the cycle; the rest is the torque loop"),
    "z_width": Measure(
        "Stiffest calm surface, body of {body}", "N/m", 0,
        note="of the map below, plane without damping; {largest_stiffness:g} N/m is the most that "
             "a surface may have"),
    "impact_depth": Measure(
        "Depth of an impact over what it may be, largest", goal=(None, 1.0),
        note="{deepest:g} v^2 / (2 a) with the a of the motors, and what their onset and the "
             "spring of the wall give"),
    "impact_rebound": Measure(
        "Speed after an impact over that before, largest", goal=(None, 0.1),
        note="at most 0.1 is asked for"),
    "impact_rest": Measure(
        "Rest after an impact, latest", "s", goal=(None, 0.5),
        note="at most 0.5 s is asked for"),
    "impact_energy": Measure(
        "Energy out of a wall over energy into it, largest", goal=(None, 1.0),
        note="at most 1 is asked for"),
    "impact_misses": Measure(
        "Impacts that miss one of these bounds", goal=(None, 0.0),
        note="of {count}, see the table"),
    "felt_mass": Measure(
        "Felt mass under {force:g} N", "kg",
        note="of a body of {mass:g} kg, along the worst axis of the handle"),
    "smallest_inertia": Measure(
        "Smallest moment of inertia that is calm", "kg m^2", 3,
        note="of the table below, with every hand"),
    "spring_frequency": Measure(
        "Swing on a spring over its own frequency, lowest", note="of the springs below"),
}

GOALS = {
    "transparency_10N": Measure(
        "Transparency bandwidth, 10 N", "Hz", 1, goal=(14.0, None),
        note="along the worst axis of the handle; an instrument pushes"),
    "transparency_40N": Measure(
        "Transparency bandwidth, 40 N", "Hz", 1, goal=(8.0, None),
        note="along the worst axis of the handle; an instrument pushes"),
    "latency": Measure(
        "Latency from wrench to motion", "ms", goal=(None, 4.5),
        note="after a step of 10 N; mean of three axes"),
    "free_space_extra": Measure(
        "Force that the device adds", "N", goal=(None, 0.10),
        note="random strokes: mean norm of f - (m a + b v), below 20 Hz"),
    "vibration": Measure(
        "Vibration", "m/s^2", 3, goal=(None, 0.04), note="the same strokes, rms above 20 Hz"),
    "centroid": Measure("Its spectral centroid", "Hz", 1, goal=(90.0, None), note="of that signal"),
    "distance": Measure("Hand to twin", "mm", goal=(None, 0.3), note="the same strokes, rms"),
    "kick_0.3kg": Measure(
        "Speed of 0.3 kg after a kick", "mm/s", 1, goal=(None, 6.0),
        note="largest in the fourth second"),
    "kick_0.4kg": Measure(
        "Speed of 0.4 kg after a kick", "mm/s", 1, goal=(None, 6.0),
        note="largest in the fourth second"),
    "wall_6kg": Measure(
        "Plane of 20 kN/m under 6 kg: calm", digits=0, goal=(1.0, None),
        note="1 calm, 0 not; pressed with 10 N and kicked, plane with 20 Ns/m, body with 4 Ns/m"),
    "wall_3kg": Measure(
        "Plane of 20 kN/m under 3 kg: calm", digits=0, goal=(1.0, None),
        note="1 calm, 0 not; pressed with 10 N and kicked, plane with 20 Ns/m, body with 4 Ns/m"),
    "stiffness_accuracy": Measure(
        "Stiffness accuracy", "%", 1, goal=(99.0, 101.0),
        note="mean of 1000, 2000 and 4000 N/m, pressed slowly up to 40 N"),
    "free_space_force": Measure(
        "Free-space force", "N", goal=(None, 0.87),
        note="random strokes of a body of {mass:g} kg, {damping:g} Ns/m, mean norm"),
    "vibration_light": Measure(
        "Vibration of that body", "m/s^2", 3,
        note="the same strokes, rms above 20 Hz: the price of a light body"),
    "frictionless_surface": Measure(
        "Frictionless surface force", "N", goal=(None, 0.4),
        note="tangential, strokes of 0.2 m in 2 s, body of {mass:g} kg, {damping:g} Ns/m"),
}


def mean(values):
    """Not a number without values."""
    return sum(values) / len(values) if values else math.nan


def half_width(values):
    """Of the two-sided 95 % confidence interval of the mean of independent, normally distributed
    values, by Student's t; not a number for less than two."""
    count = len(values)
    if count < 2:
        return math.nan
    squares = sum((value - mean(values)) ** 2 for value in values)
    return float(stdtrit(count - 1, 0.975)) * math.sqrt(squares / (count - 1) / count)


def within(value, goal):
    least, most = goal
    return (least is None or value >= least) and (most is None or value <= most)


def goal_text(goal):
    """">= 3", "<= 3", "3 .. 4" or "-"."""
    least, most = goal
    if least is None:
        return "-" if most is None else f"<= {most:g}"
    return f">= {least:g}" if most is None else f"{least:g} .. {most:g}"


def mean_text(values, digits):
    """Mean and half width, as far as there are any."""
    if not values:
        return "not measured"
    text = f"{mean(values):.{digits}f}"
    return text if len(values) < 2 else f"{text} +- {half_width(values):.{digits}f}"


def figure(measures, key, values, identifier=None, **fields):
    """A figure of figures.json: a measure with its values in the order of their repetitions."""
    it = measures[key]
    is_goal = bool(values) and it.goal != (None, None)
    paper, touch, touch_x = it.published
    return {"id": identifier or key, "name": it.name.format(**fields), "unit": it.unit,
            "digits": it.digits, "mean": finite(mean(values)),
            "half_width_95": finite(half_width(values)),
            "values": [finite(value) for value in values],
            "measured": mean_text(values, it.digits),
            "paper": paper, "touch": touch, "touch_x": touch_x,
            "goal": goal_text(it.goal), "goal_min": it.goal[0], "goal_max": it.goal[1],
            "met": ("yes" if within(mean(values), it.goal) else "no") if is_goal else "-",
            "note": it.note.format(**fields), "why": it.why.format(**fields)}


def finite(value):
    """None for what JSON has no number for."""
    return value if math.isfinite(value) else None
