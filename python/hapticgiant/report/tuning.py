"""The report of `hapticgiant tune`: figures, proofs and values before and after, and the front."""

import sys

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from ..figures import COLOURS, SETTINGS, STYLES, WIDTH
from . import tables

# key, name, unit, digits, factor of the unit
FIGURES = (
    ("transparency_Hz", "transparency", "Hz", 1, 1.0), ("latency_s", "latency", "ms", 2, 1e3),
    ("distortion", "distortion, 1 to 20 Hz", "", 3, 1.0),
    ("friction_N", "unexpected friction", "N", 3, 1.0),
    ("vibration_m_per_s2", "vibration", "m/s^2", 4, 1.0), ("centroid_Hz", "its centroid", "Hz", 0, 1.0),
)


def decay(radius):
    """Factor by which errors shrink within 0.1 s."""
    return f"{radius ** 100:.3f}"


def rows_of(results, loops):
    """A row per figure and proof, with a cell for each of these loops."""
    rows = [[name + (f", {unit}" if unit else ""),
             *(f"{factor * loop[key]:.{digits}f}" for loop in loops)]
            for key, name, unit, digits, factor in FIGURES]
    radii = [("arm_radius", "errors left after 0.1 s"), ("hand_radius", "the same in a hand")]
    if results["before"]["friction_radius"] > 0.0:
        radii.append(("friction_radius", "while friction gives way"))
    rows += [[name, *(decay(loop[key]) for loop in loops)] for key, name in radii]
    return rows + [["proven", *("yes" if loop["is_proven"] else "NO" for loop in loops)]]


def worst_of(loop):
    worst = loop["worst"]
    text = f"nearest to its limit: {worst['arm']}; in a hand: {worst['hand']}"
    return text + (f"; while friction gives way: {worst['friction']}" if "friction" in worst else "")


def yaml_of(results):
    """Lines for device.yaml."""
    loop = results["front"][0]
    lines = [f"# {results['command']}",
             f"# transparency {loop['transparency_Hz']:.1f} Hz, latency {1e3 * loop['latency_s']:.1f} "
             f"ms, vibration {loop['vibration_m_per_s2']:.3f} m/s^2 in the worst of "
             f"{results['felt_postures']} postures; computed, not measured"]
    section = None
    for knob, value, before in zip(results["knobs"], loop["values"], results["before"]["values"]):
        if knob["section"] != section:
            lines.append(f"{knob['section']}:")
        section = knob["section"]
        lines.append(f"  {knob['key']}: {value:g}  # was {before:g}")
    return "\n".join(lines) + "\n"


def check_text(results):
    """For a terminal: only what the device has now."""
    before = results["before"]
    return (tables.as_text(rows_of(results, [before]))
            + f"\nproof       holds in {results['held_before']} of {results['postures']} postures; "
            f"{worst_of(before)}\n")


def text(results):
    """For a terminal: before and after, and the lines for device.yaml."""
    before, after = results["before"], results["front"][0]
    parts = [tables.as_text([["", "now", "tuned"], *rows_of(results, [before, after])]),
             f"\nproof       {results['cases']} cases in {results['postures']} postures; "
             f"{worst_of(after)}\n"]
    if not before["is_proven"]:
        parts.append(f"now         {worst_of(before)}\n")
    return "".join(parts) + f"\nfor device.yaml:\n{yaml_of(results)}"


def markdown(results):
    before, after = results["before"], results["front"][0]
    front = [["vibration at most", "vibration", "transparency Hz", "latency ms", "distortion",
              "unexpected friction N", "proven"]]
    for loop in results["front"]:
        front.append([
            f"{loop['limit_m_per_s2']:.4f}", f"{loop['vibration_m_per_s2']:.4f}",
            f"{loop['transparency_Hz']:.1f}", f"{1e3 * loop['latency_s']:.2f}",
            f"{loop['distortion']:.3f}", f"{loop['friction_N']:.3f}",
            "yes" if loop["is_proven"] else "no"])
    return (f"# Filters and poles of {results['device']}\n\n`{results['command']}`\n\n"
            "Computed from the linear loop around the handle (docs/concepts/control.md): without "
            "torque limits and with no friction but that of the row that says so. Play it before "
            "you trust it: `hapticgiant haptify`, `hapticgiant experiment stability-map`.\n\n"
            + tables.markdown([["", "now", "tuned"], *rows_of(results, [before, after])])
            + f"\nNow: {worst_of(before)}. Tuned: {worst_of(after)}.\n\n## Front\n\n"
            "![what is felt, front, proof](figure.svg)\n\n" + tables.markdown(front)
            + f"\n## For device.yaml\n\n```yaml\n{yaml_of(results)}```\n")


def as_csv(results):
    """A row per loop, the present one first: limit, figures, proof, values."""
    keys = ["limit_m_per_s2", "vibration_m_per_s2", "centroid_Hz", "transparency_Hz", "latency_s",
            "distortion", "friction_N"]
    rows = [[*keys, "arm_radius", "hand_radius", "is_proven",
             *(knob["key"] for knob in results["knobs"])]]
    for loop in [results["before"], *results["front"]]:
        rows.append([*(f"{loop[key]:g}" for key in keys), f"{loop['arm_radius']:.6f}",
                     f"{loop['hand_radius']:.6f}", str(int(loop["is_proven"])),
                     *(f"{value:g}" for value in loop["values"])])
    return tables.as_csv(rows)


def draw(figure, facts):
    """What is felt before and after, the front, and the margins of all postures."""
    figure.set_size_inches(WIDTH, 2.6)
    felt, front, margin = figure.subplots(1, 3, gridspec_kw={"wspace": 0.36})
    before, after = COLOURS[1], COLOURS[0]
    for name, colour, label in (("felt_before", before, "now"), ("felt", after, "tuned")):
        curve = facts[name]
        felt.fill_between(curve["frequency_Hz"], curve["least"], curve["largest"], color=colour,
                          alpha=0.35, linewidth=0.8, label=label)
    felt.axhspan(0.708, 1.413, color="black", alpha=0.07, linewidth=0, label="within 3 dB")
    felt.set(xscale="log", yscale="log", ylim=(0.1, 10.0), xlabel="frequency in Hz",
             ylabel="felt over rendered", xlim=(0.5, 60.0))
    felt.legend(loc="upper left")

    points = [(facts["before"], before)] + [(point, after) for point in facts["front"]]
    seen = []
    for point, colour in points:
        x, y = point["vibration_m_per_s2"], point["transparency_Hz"]
        front.plot(x, y, "o", color=colour, markersize=4,
                   fillstyle="full" if point["is_proven"] else "none")
        if (x, y) not in seen:
            front.annotate(f"{1e3 * point['latency_s']:.1f} ms", (x, y), (0, 5), fontsize=6.5,
                           textcoords="offset points", ha="center")
        seen.append((x, y))
    front.set(xlabel="vibration in m/s$^2$", ylabel="transparency in Hz",
              xlim=(0.0, 1.25 * max(x for x, _ in seen)),
              ylim=(0.0, 1.2 * max(y for _, y in seen)))

    for name, style in (("arm", STYLES[0]), ("hand", STYLES[1])):
        # in units of what is allowed: 1 = errors fall just as fast as they must
        for key, colour in (("radii_before", before), ("radii", after)):
            limit = np.log(facts[f"{name}_limit"])
            share = np.sort(limit / np.log(np.minimum(facts[key][name], 1.0 - 1e-9)))
            postures = 100.0 * (np.arange(len(share)) + 1) / len(share)
            margin.step(share, postures, where="post", color=colour, linestyle=style,
                        label={"arm": "alone", "hand": "in a hand"}[name]
                        if key == "radii" else None)
    margin.axvline(1.0, color="black", linewidth=0.8)
    margin.set(xscale="log", xlim=(0.03, 20.0), ylim=(0, 103), ylabel="postures in %",
               xlabel="decay time over allowed")
    margin.legend(loc="lower right")
    for panel, text in zip((felt, front, margin), "abc"):
        panel.set_title(f"({text})", loc="left", fontsize=8, fontweight="bold")


def lack_of(results):
    """What forbids to use the first loop of the front, in a sentence; empty: nothing does."""
    found, friction_N = results["front"][0], results["friction_most_N"]
    if not found["is_proven"]:
        return "not proven: do not use these lines; more vibration (--vibration) leaves more room"
    tolerated = 1.01  # of limits that the search approaches from both sides
    if (found["vibration_m_per_s2"] > tolerated * found["limit_m_per_s2"]
            or found["friction_N"] > tolerated * friction_N):
        return (f"missed: vibration {found['vibration_m_per_s2']:.4f} m/s^2, at most "
                f"{found['limit_m_per_s2']:.4f}; unexpected friction {found['friction_N']:.3f} N, at most "
                f"{friction_N:.3f}")
    return ""


def write(results, folder, docs=None):
    """Writes report.txt; with a front also report.md, front.csv and figures. Returns 1 unless what the
    device has, or the first loop of the front, is proven and within its limits."""
    del docs

    def save(name, content):
        (folder / name).write_text(content, encoding="utf-8")

    shown = text(results) if results["front"] else check_text(results)
    save("report.txt", shown)
    print(shown, end="")
    if not results["front"]:
        return 0 if results["before"]["is_proven"] else 1
    save("report.md", markdown(results))
    save("front.csv", as_csv(results))
    with matplotlib.rc_context(SETTINGS):
        figure = Figure()
        draw(figure, results)
        figure.savefig(folder / "figure.svg", metadata={"Date": None, "Creator": None},
                       bbox_inches="tight", pad_inches=0.04)
        figure.savefig(folder / "figure.png", dpi=200, metadata={"Software": None},
                       bbox_inches="tight", pad_inches=0.04)
    lack = lack_of(results)
    print(lack, end="\n" if lack else "", file=sys.stderr)
    return 1 if lack else 0
