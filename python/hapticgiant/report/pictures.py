"""Pictures of the Haptify report, as SVG text for a page. The same results give the same text."""

import io
import re

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from ..figures import COLOURS, SETTINGS, STYLES, columns_that_fit

WIDTH = 7.2  # inches
THREE_DB = (1 / 1.4125, 1.4125)
AXES = "xyz"
# colour and letter of a verdict, from stable to bad
VERDICTS = {"stable": ("#009e73", "."), "slow decay": ("#8fd3bd", "r"), "hunts": ("#e69f00", "h"),
            "sustained": ("#d55e00", "U"), "diverges": ("#8b1a1a", "X"), "failed": ("#bbbbbb", "-")}


def new_figure(height, width=WIDTH):
    return Figure(figsize=(width, height), layout="constrained")


def to_svg(figure, name):
    """The figure as an element of a page, with identifiers that no other figure has."""
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    svg = text.getvalue()
    svg = svg[svg.index("<svg"):]
    svg = re.sub(r'\bid="', f'id="{name}-', svg)
    svg = re.sub(r'href="#', f'href="#{name}-', svg)
    return re.sub(r"url\(#", f"url(#{name}-", svg)


def legend_below(figure, handles, labels):
    """One legend under all panels, with as many columns as fit, in a figure that grows for it."""
    columns = columns_that_fit(labels, figure.get_figwidth())
    rows = -(-len(labels) // columns)
    figure.set_figheight(figure.get_figheight() + 0.14 * rows)
    figure.legend(handles, labels, loc="outside lower center", ncols=columns, frameon=False)


def legend_of(figure, panel):
    legend_below(figure, *panel.get_legend_handles_labels())


def log_ticks(axis, plain=True):
    """1, 2 and 5 of each decade, as plain numbers."""
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if plain else (1.0,), numticks=12))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def log_frequency(panel):
    panel.set_xscale("log")
    log_ticks(panel.xaxis, plain=False)


def curves_of(results, name):
    return [curve for curve in results["curves"] if curve["id"] == name]


def table_of(results, name):
    return next((table for table in results["tables"] if table["id"] == name), None)


def column(table, name):
    index = table["columns"].index(name)
    return [row[index] for row in table["rows"]]


def numbers_of(table, name):
    """One per row; NaN where there is none."""
    return np.array([point.get(name) for point in table["points"]], dtype=float)


# single panels: also used on the first page

def draw_view(panel, view):
    """Positions of the handle seen along one axis, and the limits of the handle."""
    rows = np.array(view["rows"], dtype=float)
    height, width = rows.shape
    left, bottom, cell = view["left"], view["bottom"], view["cell"]
    extent = (left, left + width * cell, bottom, bottom + height * cell)
    shown = np.ma.masked_equal(rows, 0.0)
    top = np.percentile(shown.compressed(), 95) if shown.count() else 1.0
    panel.imshow(shown, origin="lower", extent=extent, cmap="Blues", vmin=-0.4 * top, vmax=top,
                 interpolation="nearest", rasterized=True)
    if view["box"] and all(side is not None for side in view["box"]):
        x0, x1, y0, y1 = view["box"]
        panel.plot([x0, x1, x1, x0, x0], [y0, y0, y1, y1, y0], color=COLOURS[1], linestyle="--",
                   linewidth=0.9, label="limits of the handle")
    panel.set_aspect("equal")
    panel.margins(0.03)
    panel.autoscale()
    panel.grid(False)
    panel.set(xlabel=f"{AXES[view['across']]} in m", ylabel=f"{AXES[view['up']]} in m")


def draw_ratio(panel, curves, key, label, band=True):
    """Magnitude over frequency, with what is within 3 dB."""
    if band:
        panel.axhspan(*THREE_DB, color="black", alpha=0.07, linewidth=0, label="within 3 dB")
    for curve, colour in zip(curves, COLOURS):
        panel.plot(curve["x"], curve["y"][key], "o-", markersize=2.2, color=colour,
                   label=f"along {curve['name']}")
    panel.set_yscale("log")
    low = min([0.5] + [min(curve["y"][key]) for curve in curves])
    high = max([2.0] + [max(curve["y"][key]) for curve in curves])
    panel.set_ylim(low / 1.15, high * 1.15)
    log_ticks(panel.yaxis)
    log_frequency(panel)
    panel.set_ylabel(label)


def draw_phase(panel, curves, key, label="phase in degrees"):
    for curve, colour in zip(curves, COLOURS):
        unwrapped = np.rad2deg(np.unwrap(np.deg2rad(curve["y"][key])))
        panel.plot(curve["x"], unwrapped, "o-", markersize=2.2, color=colour)
    log_frequency(panel)
    panel.set(xlabel="frequency in Hz", ylabel=label)


def draw_spectra(panel, curves):
    for number, curve in enumerate(curves):
        (magnitude,) = curve["y"].values()
        panel.plot(curve["x"], magnitude, color=COLOURS[number % len(COLOURS)],
                   linestyle=STYLES[number // len(COLOURS) % len(STYLES)], label=curve["name"])
    panel.set_yscale("log")
    log_frequency(panel)
    panel.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    panel.set(xlabel="frequency in Hz", ylabel=r"m/s$^2$/$\sqrt{Hz}$")


def draw_map(panel, rows, columns, verdicts, row_label, column_label):
    """A cell per row and column, in the colour of its verdict and with its letter."""
    names = list(VERDICTS)
    cells = [[names.index(name) if name in VERDICTS else names.index("failed") for name in row]
             for row in verdicts]
    colours = matplotlib.colors.ListedColormap([colour for colour, _ in VERDICTS.values()])
    panel.imshow(cells, cmap=colours, vmin=-0.5, vmax=len(names) - 0.5, origin="lower",
                 aspect="auto", interpolation="nearest")
    for y, row in enumerate(cells):
        for x, cell in enumerate(row):
            panel.text(x, y, VERDICTS[names[cell]][1], ha="center", va="center", color="white",
                       fontsize=7.5, fontweight="bold")
    panel.set_xticks(range(len(columns)), columns)
    panel.set_yticks(range(len(rows)), rows)
    panel.set_xticks(np.arange(len(columns) - 1) + 0.5, minor=True)
    panel.set_yticks(np.arange(len(rows) - 1) + 0.5, minor=True)
    panel.grid(False)
    panel.grid(True, which="minor", color="white", linewidth=1.2)
    panel.tick_params(which="both", length=0)
    panel.set(xlabel=column_label, ylabel=row_label)


def verdict_legend(figure, verdicts):
    present = [name for name in VERDICTS if any(name in row for row in verdicts)]
    handles = [matplotlib.patches.Patch(color=VERDICTS[name][0]) for name in present]
    legend_below(figure, handles, [f"{VERDICTS[name][1]}  {name}" for name in present])


def z_width_maps(table):
    """Per body: stiffnesses, dampings and verdicts."""
    dampings = [name.removesuffix(" Ns/m") for name in table["columns"][3:]]
    maps = {}
    for body, stiffness, _, *verdicts in table["rows"]:
        maps.setdefault(body, ([], []))
        maps[body][0].append(stiffness)
        maps[body][1].append(verdicts)
    return {body: (rows, dampings, verdicts) for body, (rows, verdicts) in maps.items()}


def draw_felt_mass(panel, table):
    for axis, colour in zip(AXES, COLOURS):
        panel.plot(numbers_of(table, "force"), numbers_of(table, axis), "o-", markersize=3,
                   color=colour, label=f"along {axis}")
    panel.set(xlabel="steady force in N", ylabel="felt mass in kg", ylim=(0.0, None))


# pictures of sections

def workspace(results):
    views = results["workspace"]
    if not views:
        return None
    widths = [len(view["rows"][0]) for view in views]
    figure = new_figure(WIDTH * max(len(view["rows"]) for view in views) / sum(widths) + 0.6)
    panels = figure.subplots(1, len(views), width_ratios=widths, squeeze=False)[0]
    names = {(0, 1): "from above", (0, 2): "from the side", (1, 2): "along x"}
    for panel, view in zip(panels, views):
        draw_view(panel, view)
        panel.set_title(names.get((view["across"], view["up"]), ""))
    if panels[0].get_legend_handles_labels()[0]:
        legend_of(figure, panels[0])
    return figure


def transparency(results):
    curves = curves_of(results, "transparency")
    if not curves:
        return None
    figure = new_figure(3.9)
    (ratio, follow), (phase, follow_phase) = figure.subplots(2, 2, sharex=True,
                                                             height_ratios=(1.3, 1))
    draw_ratio(ratio, curves, "ratio", "felt over rendered")
    ratio.set_title("impedance")
    draw_phase(phase, curves, "phase_deg")
    draw_ratio(follow, curves, "following", "handle over twin")
    follow.set_title("position")
    draw_phase(follow_phase, curves, "following_phase_deg")
    legend_of(figure, ratio)
    return figure


def force_response(results):
    curves = curves_of(results, "force_response")
    if not curves:
        return None
    figure = new_figure(2.4 + 1.2)
    magnitude, phase = figure.subplots(2, 1, sharex=True, height_ratios=(1.4, 1))
    draw_ratio(magnitude, curves, "rendered", "felt over commanded")
    for panel, key in ((magnitude, "ideal"), (phase, "ideal_phase_deg")):
        for curve, colour in zip(curves, COLOURS):
            values = curve["y"][key]
            if key.endswith("deg"):
                values = np.rad2deg(np.unwrap(np.deg2rad(values)))
            panel.plot(curve["x"], values, linestyle="--", linewidth=0.8, color=colour,
                       label=f"along {curve['name']}, ideal")
    draw_phase(phase, curves, "rendered_phase_deg")
    legend_of(figure, magnitude)
    return figure


def spectra(results, name):
    curves = curves_of(results, name)
    if not curves:
        return None
    figure = new_figure(2.6)
    panel = figure.subplots()
    draw_spectra(panel, curves)
    legend_of(figure, panel)
    return figure


def z_width(results):
    table = table_of(results, "z_width")
    if not table or not table["rows"]:
        return None
    maps = z_width_maps(table)
    figure = new_figure(0.9 + 0.24 * max(len(rows) for rows, _, _ in maps.values()))
    panels = figure.subplots(1, len(maps), squeeze=False)[0]
    for panel, (body, (rows, columns, verdicts)) in zip(panels, maps.items()):
        draw_map(panel, rows, columns, verdicts, "", "damping in Ns/m")
        panel.set_title(body.replace(", prompt", ",\nprompt"))
    panels[0].set_ylabel("stiffness in N/m")
    verdict_legend(figure, [row for _, _, verdicts in maps.values() for row in verdicts])
    return figure


def rotation(results):
    table = table_of(results, "rotation")
    if not table or not table["rows"]:
        return None
    hands, verdicts = [row[0] for row in table["rows"]], [row[1:] for row in table["rows"]]
    figure = new_figure(0.8 + 0.26 * len(hands))
    draw_map(figure.subplots(), hands, table["columns"][1:], verdicts, "hand",
             "moment of inertia in kg m$^2$")
    verdict_legend(figure, verdicts)
    return figure


def impacts(results):
    table = table_of(results, "impacts")
    if not table or not table["rows"]:
        return None
    mass, speed = numbers_of(table, "mass"), numbers_of(table, "speed")
    panels_of = (("impact_depth", "depth over allowed", 1.0),
                 ("impact_rebound", "rebound over speed", 0.1),
                 ("impact_rest", "at rest after s", 0.5))
    figure = new_figure(2.5)
    panels = figure.subplots(1, 3)
    for panel, (name, label, most) in zip(panels, panels_of):
        values = numbers_of(table, name)
        for number, each in enumerate(np.unique(mass)):
            chosen = mass == each
            panel.plot(speed[chosen] * (0.97 + 0.02 * number), values[chosen], "o", markersize=2.6,
                       alpha=0.75, color=COLOURS[number % len(COLOURS)], label=f"{each:g} kg")
        panel.axhline(most, color="black", linestyle=":", linewidth=0.9, label="bound")
        panel.set(xlabel="speed in m/s", ylabel=label, ylim=(0.0, None), xlim=(0.0, None))
    legend_of(figure, panels[0])
    return figure


def felt_mass(results):
    table = table_of(results, "felt_mass")
    if not table or not table["rows"]:
        return None
    figure = new_figure(2.3, 4.2)
    panel = figure.subplots()
    draw_felt_mass(panel, table)
    legend_of(figure, panel)
    return figure


def springs(results):
    table = table_of(results, "springs")
    if not table or not table["rows"]:
        return None
    names = [f"{k} Nm/rad, {mm} mm" for k, mm in
             zip(column(table, "Nm/rad"), column(table, "let go at mm"))]
    places = np.arange(len(names))
    figure = new_figure(0.9 + 0.24 * len(names))
    frequency, damping = figure.subplots(1, 2, sharey=True)
    for panel, ideal, measured, label in (
            (frequency, "ideal_Hz", "frequency_Hz", "frequency in Hz"),
            (damping, "ideal_damping", "damping_ratio", "damping ratio")):
        panel.plot(numbers_of(table, ideal), places, "o", markersize=5, fillstyle="none",
                   color="black", label="the hinge alone")
        panel.plot(numbers_of(table, measured), places, "o", markersize=3, color=COLOURS[1],
                   label="handle")
        panel.set(xlabel=label, ylim=(-0.6, len(names) - 0.4))
    damping.axvline(0.0, color="black", linewidth=0.6)
    frequency.set_yticks(places, names)
    legend_of(figure, frequency)
    return figure


def glance(results):
    """Six small pictures for the first page."""
    figure = new_figure(5.0)
    panels = iter(figure.subplots(2, 3).flat)
    curves = curves_of(results, "transparency")
    if results["workspace"]:
        panel = next(panels)
        draw_view(panel, results["workspace"][0])
        panel.set_title("workspace from above")
    shared = None
    if curves:
        shared = next(panels)
        draw_ratio(shared, curves, "ratio", "")
        shared.set(title="felt over rendered impedance", xlabel="frequency in Hz")
    force = curves_of(results, "force_response")
    if force:
        panel = next(panels)
        draw_ratio(panel, force, "rendered", "")
        panel.set(title="force at a stiff hand over wanted", xlabel="frequency in Hz")
    vibration = curves_of(results, "free_space")
    if vibration:
        panel = next(panels)
        draw_spectra(panel, vibration[:1])
        panel.set_title("vibration in free space")
    table = table_of(results, "z_width")
    if table and table["rows"]:
        panel = next(panels)
        body, (rows, columns, verdicts) = next(iter(z_width_maps(table).items()))
        draw_map(panel, rows, columns, verdicts, "stiffness in N/m", "damping in Ns/m")
        panel.set_title(f"calm surfaces (.), {body.split(',')[0]}")
    table = table_of(results, "felt_mass")
    if table and table["rows"]:
        panel = next(panels)
        draw_felt_mass(panel, table)
        panel.set_title("felt mass")
    for panel in panels:
        panel.set_axis_off()
    if shared is not None:
        legend_of(figure, shared)
    return figure


def figures_of(results):
    """Pictures by the table that they show; `glance` and `free_space` have none."""
    drawn = {"glance": glance(results), "free_space": spectra(results, "free_space"),
             "workspace_shape": workspace(results), "transparency": transparency(results),
             "force_response": force_response(results), "z_width": z_width(results),
             "vibration_sources": spectra(results, "vibration_sources"),
             "impacts": impacts(results), "felt_mass": felt_mass(results),
             "rotation": rotation(results), "springs": springs(results)}
    return {name: figure for name, figure in drawn.items() if figure is not None}


def draw_all(results):
    """SVG texts by name."""
    with matplotlib.rc_context(SETTINGS):
        return {name: to_svg(figure, name) for name, figure in figures_of(results).items()}
