"""Where the sensors go, and what they bring, as a picture."""

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from ..figures import COLOURS, SETTINGS, STYLES

EDGES = [(i, i ^ bit) for i in range(8) for bit in (1, 2, 4) if i < i ^ bit]


def _device(panel, chain, q, places, choice):
    poses = chain.poses(q)
    shown = []
    for joint in chain.joints:
        ends = np.array([poses[joint.parent][1], poses[joint.child][1]])
        panel.plot(*ends.T, color="#444444", linewidth=1.5)
        shown.append(ends)
    for number, index in enumerate(choice, 1):
        R, p = poses[places[index].link]
        at = p + R @ np.array(places[index].r)
        panel.scatter(*at, color=COLOURS[1], s=28, depthshade=False, zorder=9)
        panel.text(*at, f"  {number}", color=COLOURS[1], fontsize=9, fontweight="bold", zorder=10)
        shown.append(at[None])
    shown = np.concatenate(shown)
    middle, half = (shown.max(0) + shown.min(0)) / 2, max(np.ptp(shown, 0).max() / 2, 0.05) * 1.05
    signs = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)]) * 2 - 1
    for link in chain.moving_links():
        R, p = poses[link]
        for box in chain.boxes(link):
            corners = p + (box.centre + (signs * box.half) @ box.rotation.T) @ R.T
            if np.abs(corners - middle).max() > 1.2 * half:
                continue  # a gantry is larger than what it carries
            for edge in EDGES:
                panel.plot(*corners[list(edge)].T, color="#bbbbbb", linewidth=0.5)
    for axis, centre in zip("xyz", middle, strict=True):
        getattr(panel, f"set_{axis}lim")(centre - half, centre + half)
        getattr(panel, f"set_{axis}label")(f"{axis} / m")
    panel.set_box_aspect((1, 1, 1))
    panel.set_title("placement, in the middle of the motion")


def _errors(panel, chain, errors, first, title):
    count = len(errors)
    for k, joint in enumerate(chain.moving):
        panel.semilogy(range(count), errors[:, first + k], marker="o", markersize=3,
                       color=COLOURS[k % len(COLOURS)], linestyle=STYLES[k // len(COLOURS) % 4],
                       label=joint.name)
    panel.set_xticks(range(count))
    panel.set_xlabel("sensors")
    panel.set_title(title)


def draw(file, chain, motion, places, choice, errors, encoders):
    """errors: (number of sensors from `0` or 1 on, 3 n); the suffix of the file is the format."""
    n = chain.n
    with rc_context(SETTINGS):
        figure = Figure(figsize=(10.5, 4.0), layout="constrained")
        grid = figure.add_gridspec(1, 3, width_ratios=(1.5, 1, 1))
        _device(figure.add_subplot(grid[0], projection="3d"), chain, motion.q.mean(0), places, choice)
        units = {joint.unit for joint in chain.moving}
        unit = " or ".join(sorted(units, reverse=True))
        with_encoders = ", with encoders" if encoders else ", without encoders"
        speeds = figure.add_subplot(grid[1])
        _errors(speeds, chain, errors, n, f"rms error of speed / ({unit})/s{with_encoders}")
        rates = figure.add_subplot(grid[2])
        _errors(rates, chain, errors, 2 * n, f"rms error of acceleration / ({unit})/s²")
        speeds.legend()
        figure.savefig(file, dpi=150, metadata={"Date": None} if str(file).endswith("svg") else None)
