"""map.svg of `hapticgiant check --map`: the force over two sections of a device's workspace."""


import matplotlib
import numpy as np

from ..figures import SETTINGS
from . import pictures

CELLS = 40  # along the longest side of the workspace
WIDTH = 4.6  # inches of the widest section
AXES = "xyz"


def median_per_cell(points, right, up, cell):
    """Median force per cell of the section through the middle; NaN = not reached.

    Points up to one cell beside the section count. Returns it with the edges of the cells.
    """
    low, high = points[:, :3].min(axis=0), points[:, :3].max(axis=0)
    normal = 3 - right - up
    near = points[np.abs(points[:, normal] - 0.5 * (low + high)[normal]) <= cell]
    counts = [max(1, int(np.ceil((high - low)[axis] / cell - 1e-9))) for axis in (right, up)]
    columns, rows = (np.minimum(((near[:, axis] - low[axis]) / cell).astype(int), count - 1)
                     for axis, count in zip((right, up), counts))
    force = np.full(counts[::-1], np.nan)
    cells = rows * counts[0] + columns
    for index in np.unique(cells):
        force.flat[index] = np.median(near[cells == index, 3])
    edges = [low[axis] + cell * np.arange(count + 1)
             for axis, count in zip((right, up), counts)]
    return force, *edges


def round_number(value):
    """The next 1, 2 or 5 times a power of ten."""
    power = 10.0 ** np.floor(np.log10(value))
    return next(step * power for step in (1.0, 2.0, 5.0, 10.0) if value <= step * power)


def largest_shown(sections):
    """The upper end of the scale: nearly all cells are below it."""
    forces = np.concatenate([force[np.isfinite(force)] for force, *_ in sections])
    high = np.quantile(forces, 0.98) if forces.size else 0.0
    return round_number(high) if high > 0.0 else 1.0


def draw_box(panel, box):
    """Whether the handle has a box."""
    if any(side is None for side in np.ravel(box)):
        return False
    (x0, x1), (y0, y1) = box
    panel.plot([x0, x1, x1, x0, x0], [y0, y0, y1, y1, y0], color="#d62728", linestyle="--",
               linewidth=1.2, label="box of the handle")
    return True


def figure_of(results):
    points = np.array(results["points"], dtype=float).reshape(-1, 4)
    points[np.isnan(points)] = np.inf  # null: a force without limit
    if not len(points):
        figure = pictures.new_figure(1.0)
        figure.suptitle(f"{results['device']}: no posture was found within all limits")
        return figure
    sizes = np.ptp(points[:, :3], axis=0)
    cell = max(1e-3, sizes.max() / CELLS)
    views = ((0, 1), (0, 2))  # from above, from the side
    sections = [median_per_cell(points, right, up, cell) for right, up in views]
    heights = [max(sizes[up], cell) for _, up in views]
    figure = pictures.new_figure(2.0 + WIDTH * sum(heights) / max(sizes[0], cell), width=WIDTH + 2.0)
    panels = list(figure.subplots(2, 1, height_ratios=heights))
    for panel, (right, up), (force, x, y) in zip(panels, views, sections):
        mesh = panel.pcolormesh(x, y, np.ma.masked_invalid(force), cmap="viridis", vmin=0.0,
                                vmax=largest_shown(sections))
        has_box = draw_box(panel, [results["box_m"][axis] for axis in (right, up)])
        normal = 3 - right - up
        middle = 0.5 * (points[:, normal].min() + points[:, normal].max())
        panel.set_aspect("equal")
        panel.grid(False)
        panel.set(xlabel=f"{AXES[right]} in m", ylabel=f"{AXES[up]} in m")
        panel.set_title(f"section at {AXES[normal]} = {round(middle, 2) + 0.0:.2f} m")
    figure.colorbar(mesh, ax=panels, label="force in N", extend="max", shrink=0.7)
    figure.suptitle(f"{results['device']}: force that the handle bears in the worst direction\n"
                    "Median of the postures that bring it there; joint ratings less gravity. "
                    "White: not reached.", fontsize=8)
    if has_box:
        pictures.legend_of(figure, panels[-1])
    return figure


def write(results, folder, docs=None):
    """Writes map.svg."""
    del docs
    with matplotlib.rc_context({**SETTINGS, "svg.fonttype": "none"}):
        text = pictures.to_svg(figure_of(results), "map")
    (folder / "map.svg").write_text(text, encoding="utf-8")
