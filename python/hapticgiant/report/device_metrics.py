"""picture.svg of `hapticgiant design measure --picture`: coverage over the space that the hand reaches."""


import matplotlib
import numpy as np

from ..figures import SETTINGS
from . import pictures
from .human_arm import AXES, draw_body

# what is drawn: key of a pose (None: whether it is reached), title
QUANTITIES = ((None, "poses"), ("velocity", "speed"), ("acceleration", "acceleration"))


def mean_per_cell(points, values, right, up, cell):
    """Mean of the values per cell of the view along the third axis; NaN where there is no point."""
    low = np.floor(points.min(axis=0) / cell) * cell
    counts = [int((points[:, axis].max() - low[axis]) / cell) + 1 for axis in (right, up)]
    columns, rows = (((points[:, axis] - low[axis]) / cell).astype(int) for axis in (right, up))
    total, number = np.zeros(counts[::-1]), np.zeros(counts[::-1])
    np.add.at(total, (rows, columns), values)
    np.add.at(number, (rows, columns), 1)
    with np.errstate(invalid="ignore"):
        mean = total / number
    return mean, *(low[axis] + cell * np.arange(count + 1)
                   for axis, count in zip((right, up), counts))


def figure_of(results):
    points = np.array([pose["hand"]["T_F_hand"]["p_m"] for pose in results["poses"]])
    devices = [pose["device"] for pose in results["poses"]]
    # each cell with about ten poses
    cell = max(results["capability"]["voxel_m"],
               np.sqrt(10 * np.prod(np.ptp(points[:, [0, 2]], axis=0)) / len(points)))
    figure = pictures.new_figure(5.6)
    panels = figure.subplots(2, len(QUANTITIES))
    for column, (key, title) in zip(panels.T, QUANTITIES):
        values = np.array([float(device["reached"]) if key is None else device.get(key, 0.0)
                           for device in devices])
        for panel, (right, up) in zip(column, ((0, 2), (0, 1))):
            mean, x, y = mean_per_cell(points, values, right, up, cell)
            mesh = panel.pcolormesh(x, y, np.ma.masked_invalid(mean), cmap="viridis", vmin=0.0,
                                    vmax=1.0)
            draw_body(panel, results["arm"], right, up)
            panel.set_aspect("equal")
            panel.grid(False)
            panel.set(xlabel=f"{AXES[right]} in m", ylabel=f"{AXES[up]} in m")
        column[0].set_title(f"{title}: {100 * values.mean():.0f} %")
    figure.colorbar(mesh, ax=list(panels.flat), label="coverage", shrink=0.7)
    arm = results["arm"]
    figure.suptitle(f"{results['device']}: coverage of the hand of a {arm['sex']}, "
                    f"{arm['stature_m']:.2f} m tall\nabove: from the side, below: from above; the "
                    "person stands at 0 and looks along x", fontsize=8)
    return figure


def write(results, folder, docs=None):
    """Writes picture.svg."""
    del docs
    with matplotlib.rc_context({**SETTINGS, "svg.fonttype": "none"}):
        text = pictures.to_svg(figure_of(results), "coverage")
    (folder / "picture.svg").write_text(text, encoding="utf-8")
