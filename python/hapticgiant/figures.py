"""Figures of runs, as the paper draws them.

draw() takes folders with run.json and signals.npy, which `hapticgiant experiment` and
`hapticgiant plot` write. Several runs are drawn over each other. The same data gives the same
files. Needs numpy and matplotlib, not the compiled part of this package.
"""

import pathlib
import re

import numpy as np

WIDTH = 7.2  # inches: both columns of a paper
LEGEND_ROW = 0.17  # inches, of the height that a row adds to a panel
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#8c564b")
STYLES = ("-", (0, (4, 1.5)), (0, (1, 1)), (0, (5, 1, 1, 1)))
SHADES = (-0.45, 0.5)  # of the curves of one run: towards black, towards white
SETTINGS = {
    "font.family": "sans-serif", "font.sans-serif": ["DejaVu Sans"], "font.size": 7.5,
    "axes.titlesize": 8, "axes.labelsize": 7.5, "legend.fontsize": 6.8, "xtick.labelsize": 7,
    "ytick.labelsize": 7, "lines.linewidth": 1.0, "axes.linewidth": 0.6, "grid.linewidth": 0.4,
    "grid.color": "#dddddd", "axes.grid": True, "axes.axisbelow": True, "legend.frameon": True,
    "legend.framealpha": 0.85, "legend.edgecolor": "none", "legend.fancybox": False,
    "legend.handlelength": 1.6, "legend.columnspacing": 1.2, "legend.borderaxespad": 0.2,
    "svg.hashsalt": "hapticgiant", "svg.fonttype": "path", "path.simplify_threshold": 0.3,
    "mathtext.default": "regular",
}


class Run:
    """One run: signals by the names of their columns, and what is known about them."""

    def __init__(self, facts, signals):
        self.facts, self.signals = facts, signals
        self.time = signals["time_s"]

    @classmethod
    def load(cls, folder):
        from .report import runs
        run = runs.Run(pathlib.Path(folder))
        return cls(run.figure_facts(), run.figure_signals())

    def __getitem__(self, column):
        return self.signals[column]

    def has(self, column):
        return column in self.signals and bool(np.isfinite(self.signals[column]).any())

    def events(self):
        return self.facts["events"]

    def at(self, time_s):
        """Index of the row at that time."""
        return min(int(np.searchsorted(self.time, time_s)), len(self.time) - 1)


def label_of(name):
    """t_b' as in the paper; "checkpoint 3" as 3; other events have no label."""
    if match := re.fullmatch(r"t_(\w)('?)", name):
        return f"$t_{{{match[1]}}}${match[2]}"
    if match := re.fullmatch(r"checkpoint (\d+)", name):
        return match[1]
    return ""


def mark_events(axes, run):
    """Lines through all panels; labels above the first one, a step higher where they are close."""
    span = run.time[-1] - run.time[0]
    last, height = -np.inf, 0
    for event in run.events():
        time, label = event["time_s"], label_of(event["label"])
        for panel in axes:
            panel.axvline(time, color="black" if label else "#999999", linewidth=0.7 if label else 0.5,
                          zorder=1.5)
        if not label:
            continue
        height = 1 - height if time - last < 0.035 * span else 0
        last = time
        axes[0].annotate(label, (time, 1.0), (0, 2 + 11 * height), ha="center", va="bottom",
                         xycoords=("data", "axes fraction"), textcoords="offset points",
                         fontsize=8, annotation_clip=False)


def shade_locks(axes, run):
    for phase in run.facts["locked"]:
        for panel in axes:
            panel.axvspan(phase["from_s"], phase["to_s"], color="#bbbbbb", alpha=0.45, linewidth=0,
                          zorder=0.5)


def make_room(panel, share):
    """For a legend above the curves."""
    low, high = panel.get_ylim()
    panel.set_ylim(low, high + share * (high - low))


def columns_that_fit(labels, width, most=6):
    """Columns of a legend with these labels that fit into a width in inches, at least one."""
    from matplotlib import rcParams
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import TextPath
    size = FontProperties(size=rcParams["legend.fontsize"]).get_size_in_points()
    font = FontProperties(family=rcParams["font.family"], size=size)
    text = max((TextPath((0, 0), label, prop=font).get_extents().width for label in labels if label),
               default=0.0)
    each = text + size * (rcParams["legend.handlelength"] + rcParams["legend.handletextpad"]
                          + rcParams["legend.columnspacing"])
    return int(np.clip(72.0 * width // each, 1, min(most, max(len(labels), 1))))


def legend(panel, columns, **options):
    """A legend above the curves, in a band that they do not reach, as wide as the panel at most."""
    handles, labels = panel.get_legend_handles_labels()
    if not handles:
        return
    figure = panel.figure
    width = panel.get_position().width * figure.get_figwidth()
    made = panel.legend(handles, labels, loc="upper left",
                        ncol=columns_that_fit(labels, width, columns), **options)
    height = made.get_window_extent(figure.canvas.get_renderer()).height
    height /= panel.get_window_extent().height
    share = min(height + 0.06, 0.8)
    make_room(panel, share / (1.0 - share))


def colours_of(runs, number, count):
    """Of so many curves of a run: of one run a colour each; of several each run has a colour, its curves are shades
    of it, from dark to light."""
    if len(runs) == 1:
        return [COLOURS[index % len(COLOURS)] for index in range(count)]
    from matplotlib.colors import to_hex, to_rgb
    base = np.array(to_rgb(COLOURS[number % len(COLOURS)]))
    return [to_hex(base * (1 + share) if share < 0 else base + share * (1 - base))
            for share in (np.linspace(*SHADES, count) if count > 1 else [0.0])]


def draw_signals(panel, runs, entries, label, legend_columns=6):
    """Signals of run.json with their limits, dotted in the same colour."""
    for number, style in enumerate(STYLES[:len(runs)]):
        for entry, colour in zip(entries, colours_of(runs, number, len(entries))):
            if runs[number].has(entry["column"]):
                panel.plot(runs[number].time, runs[number][entry["column"]], color=colour,
                           linestyle=style, label=entry["name"] if number == 0 else None)
    for entry, colour in zip(entries, colours_of(runs, 0, len(entries))):
        for side in ("lower", "upper"):
            if entry[side] is not None:
                panel.axhline(entry[side], color=colour, linestyle=":", linewidth=0.9)
    panel.set_ylabel(label)
    legend(panel, legend_columns)


def draw_wrench(panel, runs):
    """Norms of force (left) and torque (right) of the user."""
    right = panel.twinx()
    right.grid(False)
    for number, (run, style) in enumerate(zip(runs, STYLES)):
        force, torque = colours_of(runs, number, 2)
        panel.plot(run.time, run["force_N"], color=force, linestyle=style)
        right.plot(run.time, run["torque_Nm"], color=torque, linestyle=style)
    force, torque = colours_of(runs, 0, 2)
    panel.set_ylabel("force in N", color=force)
    right.set_ylabel("torque in Nm", color=torque)
    for each in (panel, right):
        each.set_ylim(bottom=0)


def draw_torques(panel, runs, entries):
    for number, run in enumerate(runs):
        for entry, colour in zip(entries, colours_of(runs, number, len(entries))):
            panel.plot(run.time, run[entry["torque_column"]], color=colour,
                       linestyle=STYLES[number], label=entry["name"] if number == 0 else None)
    units = "/".join(sorted({entry["torque_unit"] for entry in entries}, reverse=True))
    panel.set_ylabel(f"user in {units}")
    legend(panel, 6)


def draw_speeds(panel, runs, entry):
    for number, run in enumerate(runs):
        panel.plot(run.time, run[entry["speed_column"]], color=colours_of(runs, number, 1)[0], linestyle=STYLES[number],
                   label=entry["name"] if number == 0 else None)
    if entry["speed_max"] is not None:
        for sign in (-1, 1):
            panel.axhline(sign * entry["speed_max"], color=COLOURS[0], linestyle=":", linewidth=0.9)
    panel.set_ylabel(f"speed in {entry['unit']}/s")
    legend(panel, 1)


def box(panel, x, y, colour):
    """Limits of a plane; what is infinite is left out."""
    for value in x:
        if value is not None:
            panel.axvline(value, color=colour, linestyle=":", linewidth=0.9)
    for value in y:
        if value is not None:
            panel.axhline(value, color=colour, linestyle=":", linewidth=0.9)


def draw_top_view(panel, runs, from_s=-np.inf, to_s=np.inf):
    """Motion of hand, elbow and gantry in the plane, with their limits."""
    facts = runs[0].facts
    gantry = facts["gantry"] if [joint["unit"] for joint in facts["gantry"]] == ["m", "m"] else []
    curves = [("end effector", "hand_x_m", "hand_y_m")]
    if facts["has_elbow"]:
        curves.append(("elbow", "elbow_x_m", "elbow_y_m"))
    if gantry:
        curves.append(("gantry", gantry[0]["column"], gantry[1]["column"]))
    for number, run in enumerate(runs):
        rows = (run.time >= from_s) & (run.time <= to_s) & (run["running"] > 0)
        for (name, x, y), colour in zip(curves, colours_of(runs, number, len(curves))):
            panel.plot(run[x][rows], run[y][rows], color=colour, linestyle=STYLES[number],
                       label=name if number == 0 else None)
    colours = colours_of(runs, 0, len(curves))
    box(panel, facts["box"]["x"], facts["box"]["y"], colours[0])
    if gantry:
        box(panel, *([joint["lower"], joint["upper"]] for joint in gantry), colours[-1])
    panel.set_aspect("equal", adjustable="box", anchor="N")
    panel.set_xlabel("x in m")
    panel.set_ylabel("y in m")
    from matplotlib.transforms import ScaledTranslation
    below = ScaledTranslation(0.0, -0.36, panel.figure.dpi_scale_trans)  # label and ticks of x
    panel.legend(loc="upper center", bbox_to_anchor=(0.5, 0.0), ncol=3, columnspacing=0.9,
                 bbox_transform=panel.transAxes + below)


def mark_places(panel, run, places):
    """Events in the top view: label -> name of the curve, offset of the label in points."""
    for event in run.events():
        if event["label"] not in places:
            continue
        column, offset = places[event["label"]]
        row = run.at(event["time_s"])
        x, y = (run[f"{column}_{axis}_m"] if column != "gantry" else
                run[run.facts["gantry"]["xy".index(axis)]["column"]] for axis in "xy")
        panel.plot(x[row], y[row], "o", color="black", markersize=3, zorder=4)
        panel.annotate(label_of(event["label"]), (x[row], y[row]), offset,
                       textcoords="offset points", fontsize=8)


def draw_checkpoints(panel, run):
    """Circles of 5 cm with the heading that is asked of the handle."""
    from matplotlib.patches import Circle
    for point in run.facts["checkpoints"]:
        x, y, azimuth = point["x_m"], point["y_m"], point["azimuth_rad"]
        panel.add_patch(Circle((x, y), 0.05, fill=False, color="black", linewidth=0.9, zorder=4))
        panel.annotate("", (x + 0.35 * np.cos(azimuth), y + 0.35 * np.sin(azimuth)), (x, y),
                       arrowprops={"arrowstyle": "->", "linewidth": 0.9})
        panel.annotate(label_of(point["name"]), (x, y), (-10, 4), textcoords="offset points",
                       fontsize=9)


def side_view(pose):
    """Distance from the first joint's axis and height of every link, m."""
    points = np.array(pose["points"]) - pose["points"][0]
    return np.hypot(points[:, 0], points[:, 1]), points[:, 2]


def top_view(pose):
    points = np.array(pose["points"]) - pose["points"][0]
    return points[:, 0], points[:, 1]


def draw_poses(figure, grid, run):
    """The twin at the labelled events: from the side, and from above."""
    poses = [pose for pose in run.facts["poses"] if label_of(pose["label"])]
    if not poses:
        return
    rows = grid.subgridspec(2, len(poses), hspace=0.12, wspace=0.08)
    for row, (view, name) in enumerate(((side_view, "side"), (top_view, "above"))):
        spread = np.hstack([np.array(view(pose)) for pose in poses])
        low, high = spread.min(axis=1) - 0.2, spread.max(axis=1) + 0.2
        for column, pose in enumerate(poses):
            panel = figure.add_subplot(rows[row, column])
            x, y = view(pose)
            for part, colour in zip(range(1, len(x) - 1), COLOURS):
                panel.plot(x[part:part + 2], y[part:part + 2], color=colour, linewidth=2.2,
                           solid_capstyle="round")
            panel.plot(x[1:-1], y[1:-1], "o", color="black", markersize=2.5)
            panel.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), xticks=[], yticks=[])
            panel.set_aspect("equal")
            if row == 0:
                panel.set_title(f"{label_of(pose['label'])} = {pose['time_s']:.1f} s")
            if column == 0:
                panel.set_ylabel(name)


def letter(panel, text):
    panel.text(-0.075, 1.0, f"({text})", transform=panel.transAxes, ha="right", va="bottom",
               fontsize=8, fontweight="bold")


def finish_time_panels(figure, panels, runs):
    mark_events(panels, runs[0])
    for panel in panels:
        panel.set_xlim(runs[0].time[0], max(run.time[-1] for run in runs))
    for panel in panels[:-1]:
        panel.tick_params(labelbottom=False)
    panels[-1].set_xlabel("time in s")
    figure.align_ylabels(panels)


def beside_top_view(figure, heights):
    """Panels over each other at the left, one over their whole height at the right."""
    grid = figure.add_gridspec(len(heights), 2, width_ratios=(1.75, 1), height_ratios=heights,
                               hspace=0.12, wspace=0.42)
    left = [figure.add_subplot(grid[row, 0]) for row in range(len(heights))]
    return left, figure.add_subplot(grid[:, 1])


def cartesian(figure, runs):
    figure.set_size_inches(WIDTH, 5.4)
    facts = runs[0].facts
    (joints, singularity, wrench), top = beside_top_view(figure, (2.2, 1, 1.4))
    draw_signals(joints, runs, facts["manipulator"], "joints in rad")
    draw_signals(singularity, runs, facts["virtual"], "rad")
    draw_wrench(wrench, runs)
    draw_top_view(top, runs, 10.0, 45.0)
    mark_places(top, runs[0], {"t_b": ("elbow", (-12, 6)), "t_b'": ("hand", (-13, -12)),
                               "t_f": ("gantry", (5, -9)), "t_g": ("hand", (4, 3))})
    finish_time_panels(figure, [joints, singularity, wrench], runs)
    for panel, text in zip((joints, singularity, wrench, top), "abcd"):
        letter(panel, text)


def excavator(figure, runs):
    figure.set_size_inches(WIDTH, 6.4)
    grid = figure.add_gridspec(3, 1, height_ratios=(1.5, 1.3, 1.2), hspace=0.16)
    draw_poses(figure, grid[0], runs[0])
    angles, torques = figure.add_subplot(grid[1]), figure.add_subplot(grid[2])
    draw_signals(angles, runs, runs[0].facts["twin"], "joints in rad")
    draw_torques(torques, runs, runs[0].facts["twin"])
    finish_time_panels(figure, [angles, torques], runs)
    letter(angles, "b")
    letter(torques, "c")
    figure.text(0.06, 0.9, "(a)", fontsize=8, fontweight="bold")


def draw_doorway(panel, run):
    """A person who walks through, from above: body, handle and leaf; every second in full."""
    from matplotlib.patches import Ellipse
    doorway, person = run.facts["doorway"], run.facts["person"]
    width, shoulder = doorway["leaf_width_m"], doorway["half_breadth_m"]
    for x in (-0.01, doorway["clear_width_m"]):
        side = 0.07 if x > 0.0 else -0.07
        panel.fill_between([x, x + side], -0.07, 0.07, color="black", linewidth=0)
    time = person["time_s"]
    for second in np.arange(np.ceil(time[0]), time[-1]):
        row = int(np.searchsorted(time, second))
        x, y, angle = (person[name][row] for name in ("x_m", "y_m", "angle_rad"))
        shade = 0.25 + 0.75 * (second - time[0]) / (time[-1] - time[0])
        panel.plot([0.0, width * np.cos(angle)], [0.0, width * np.sin(angle)], color=COLOURS[4],
                   alpha=shade, linewidth=1.6)
        panel.add_patch(Ellipse((x, y), 2.0 * shoulder, 0.24, alpha=shade, fill=False,
                                angle=np.degrees(person["heading_rad"][row]) - 90.0,
                                edgecolor=COLOURS[0], linewidth=0.7))
        if row and np.hypot(x - person["x_m"][row - 1], y - person["y_m"][row - 1]) > 1e-3:
            panel.annotate(f"{second:.0f} s", (doorway["clear_width_m"] + 0.12, y), va="center",
                           fontsize=6)
    held = person["hold"] > 0.0
    panel.plot(person["x_m"], person["y_m"], color=COLOURS[0], label="body")
    panel.plot(person["handle_x_m"][held], person["handle_y_m"][held], color=COLOURS[1],
               label="handle, held")
    panel.plot(person["handle_x_m"][~held], person["handle_y_m"][~held], color=COLOURS[1],
               linestyle=":", label="let go")
    panel.plot([], [], color=COLOURS[4], linewidth=1.6, label="leaf")
    panel.set_aspect("equal", adjustable="box", anchor="N")
    panel.set(xlabel="along the shut leaf in m", ylabel="way it opens in m", xlim=(-0.3, 1.3))
    from matplotlib.transforms import ScaledTranslation
    below = ScaledTranslation(0.0, -0.36, panel.figure.dpi_scale_trans)  # label and ticks of x
    panel.legend(loc="upper center", bbox_to_anchor=(0.5, 0.0), ncol=2, columnspacing=0.9,
                 bbox_transform=panel.transAxes + below)


def draw_force(panel, runs):
    """Force of the user, and when the hand lets go."""
    for number, (run, style) in enumerate(zip(runs, STYLES)):
        panel.plot(run.time, run["force_N"], color=colours_of(runs, number, 1)[0], linestyle=style)
        person = run.facts["person"]
        let_go = person["time_s"][person["hold"] < 1.0]
        if len(let_go):
            panel.axvline(let_go[0], color=COLOURS[1], linewidth=0.8, linestyle=style,
                          label="lets go" if run is runs[0] else None)
    panel.set_ylabel("force in N")
    panel.set_ylim(bottom=0)
    legend(panel, 2)


def draw_walk_through(figure, grid, runs):
    grid = grid.subgridspec(2, 2, width_ratios=(1.35, 1), hspace=0.12, wspace=0.28)
    panels = [figure.add_subplot(grid[row, 0]) for row in (0, 1)]
    top = figure.add_subplot(grid[:, 1])
    draw_signals(panels[0], runs, runs[0].facts["twin"], "joints in rad")
    draw_force(panels[1], runs)
    shade_locks(panels, runs[0])
    finish_time_panels(figure, panels, runs)
    draw_doorway(top, runs[0])
    for panel, text in zip([*panels, top], "def"):
        letter(panel, text)


def door(figure, runs):
    """Fig. 9; below it, if there are such runs, a person who walks through."""
    walks = [run for run in runs if run.facts["person"]]
    runs = [run for run in runs if not run.facts["person"]]
    figure.set_size_inches(WIDTH, 9.0 if walks else 4.6)
    outer = figure.add_gridspec(2 if walks else 1, 1, hspace=0.17,
                                height_ratios=(1.2, 1.0) if walks else None)
    grid = outer[0].subgridspec(3, 1, height_ratios=(1.4, 1, 1.2), hspace=0.14)
    panels = [figure.add_subplot(cell) for cell in grid]
    if walks:
        draw_walk_through(figure, outer[1], walks)
    twin = runs[0].facts["twin"]
    draw_signals(panels[0], runs, twin, "joints in rad")
    draw_speeds(panels[1], runs, twin[0])
    draw_torques(panels[2], runs, twin)
    shade_locks(panels, runs[0])
    finish_time_panels(figure, panels, runs)
    for panel, text in zip(panels, "abc"):
        letter(panel, text)


def path(figure, runs):
    figure.set_size_inches(WIDTH, 4.6)
    (joints, wrench), top = beside_top_view(figure, (1.5, 1))
    draw_signals(joints, runs, runs[0].facts["manipulator"], "joints in rad")
    draw_wrench(wrench, runs)
    draw_top_view(top, runs)
    draw_checkpoints(top, runs[0])
    finish_time_panels(figure, [joints, wrench], runs)
    for panel, text in zip((joints, wrench, top), "abc"):
        letter(panel, text)


def any_run(figure, runs):
    """Whatever device and twin have."""
    facts = runs[0].facts
    names = ["wrench"] + [group for group in ("manipulator", "virtual", "gantry", "twin")
                          if any(run.has(entry["column"]) for entry in facts[group]
                                 for run in runs)]
    if "twin" in names:
        names.append("torques")
    width = 0.42 * WIDTH  # of the panels at the left
    heights = []
    for name in names:
        labels = [entry["name"] for entry in facts.get("twin" if name == "torques" else name, [])]
        rows = -(-len(labels) // columns_that_fit(labels, width))
        heights.append((2.0 if name == "manipulator" else 1.25) + LEGEND_ROW * max(rows - 1, 0))
    figure.set_size_inches(WIDTH, max(3.2, sum(heights) + 0.8))
    panels, top = beside_top_view(figure, heights)
    for name, panel in zip(names, panels):
        if name == "wrench":
            draw_wrench(panel, runs)
        elif name == "torques":
            draw_torques(panel, runs, facts["twin"])
        else:
            units = "/".join(sorted({entry["unit"] for entry in facts[name]}, reverse=True))
            draw_signals(panel, runs, facts[name], f"{name} in {units}")
        if name in ("twin", "torques"):
            shade_locks([panel], runs[0])
    draw_top_view(top, runs)
    finish_time_panels(figure, panels, runs)


def timing(figure, facts):
    """Shares of cycles by computing time, and the paper's figures."""
    labels = [series["name"] for series in facts["series"]]
    columns = columns_that_fit(labels, 0.75 * WIDTH, 4)
    figure.set_size_inches(WIDTH, 3.2)
    panel = figure.add_subplot()
    for number, series in enumerate(facts["series"]):
        panel.step(series["from_us"], series["share_percent"], where="post", label=series["name"],
                   color=COLOURS[number // 2 % len(COLOURS)] if facts["has_two_laws"] else
                   COLOURS[number % len(COLOURS)],
                   linestyle=STYLES[number % 2] if facts["has_two_laws"] else "-")
    for name, value in facts["paper_us"].items():
        panel.axvline(value, color="black", linewidth=0.7)
        panel.annotate(f"paper, {name}: {value:g} us", (value, 0.97), (-2, 0), rotation=90,
                       xycoords=("data", "axes fraction"), textcoords="offset points", ha="right",
                       va="top", fontsize=6.5)
    panel.set(xscale="log", yscale="log", ylim=(1e-3, 100.0),
              xlabel="computing time of a cycle in us", ylabel="cycles in %")
    panel.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=columns)


KINDS = {"cartesian": cartesian, "excavator": excavator, "door": door, "path": path,
         "any": any_run}


def captions(figure, runs):
    """With several runs: which line is whose, above the labels of the events."""
    runs = [run for run in runs if run.facts["kind"] == runs[0].facts["kind"]]
    if len(runs) < 2:
        return
    from matplotlib.lines import Line2D
    from matplotlib.transforms import ScaledTranslation
    handles = [Line2D([], [], color=colour, linestyle=style, label=run.facts["note"])
               for run, style, colour in zip(runs, STYLES, COLOURS)]
    top = max(panel.get_position().y1 for panel in figure.axes)
    above = ScaledTranslation(0.0, 0.36, figure.dpi_scale_trans)
    figure.legend(handles=handles, loc="lower left", ncol=1, bbox_to_anchor=(0.05, top),
                  bbox_transform=figure.transFigure + above)


def draw_runs(figure, runs):
    """Runs over each other, in the panels of the first one's kind."""
    KINDS[runs[0].facts["kind"]](figure, runs)
    captions(figure, runs)


def save(out, paint):
    """Saves what `paint` draws into a figure as `out`/figure.svg and figure.png."""
    import matplotlib
    matplotlib.use("svg")
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    out = pathlib.Path(out)
    out.mkdir(parents=True, exist_ok=True)
    with matplotlib.rc_context(SETTINGS):
        figure = Figure()
        FigureCanvasAgg(figure)
        paint(figure)
        for name in ("figure.svg", "figure.png"):  # a link there leads nowhere
            (out / name).unlink(missing_ok=True)
        figure.savefig(out / "figure.svg", metadata={"Date": None, "Creator": None},
                       bbox_inches="tight", pad_inches=0.04)
        figure.savefig(out / "figure.png", dpi=200, metadata={"Software": None},
                       bbox_inches="tight", pad_inches=0.04)


def draw(out, folders):
    """Draws the runs of `folders` over each other into `out`."""
    runs = [Run.load(folder) for folder in folders[:len(STYLES)]]
    save(out, lambda figure: draw_runs(figure, runs))
