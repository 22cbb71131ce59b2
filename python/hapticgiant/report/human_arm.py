"""picture.svg of `hapticgiant design arm --picture`: reach, speeds and joint ranges of a person's arm."""


import matplotlib
import numpy as np
from matplotlib.patches import Ellipse, Polygon

from ..figures import COLOURS, SETTINGS
from . import pictures

AXES = "xyz"
# joint ranges of the American Academy of Orthopaedic Surgeons, degrees; NaN = gives none
AAOS = {"shoulder flexion": (-60, 180), "shoulder abduction": (np.nan, 180),
        "upper arm rotation": (-90, 70), "elbow flexion": (0, 150), "pronation": (-80, 80),
        "wrist flexion": (-70, 80), "radial deviation": (-30, 20)}


def outline(capsule, right, up, points=24):
    """A capsule seen along the third axis: the hull of the circles at its ends."""
    ends = [np.array(capsule[key])[[right, up]] for key in ("from_m", "to_m")]
    angles = np.linspace(0.0, 2 * np.pi, points, endpoint=False)
    circle = capsule["radius_m"] * np.column_stack([np.cos(angles), np.sin(angles)])
    along = ends[1] - ends[0]
    if np.linalg.norm(along) < 1e-9:
        return circle + ends[0]
    return np.vstack([circle[circle @ along <= 0] + ends[0], circle[circle @ along > 0] + ends[1]])


def draw_body(panel, arm, right, up):
    for capsule in arm["body"]:
        corners = outline(capsule, right, up)
        middle = corners.mean(axis=0)
        order = np.argsort(np.arctan2(*(corners - middle).T[::-1]))
        panel.add_patch(Polygon(corners[order], color="#c8c8c8", linewidth=0, zorder=0))


def draw_view(panel, results, right, up):
    """Where the hand is, the ball of the stretched arm, and the body."""
    arm = results["arm"]
    points = np.array([pose["T_F_hand"]["p_m"] for pose in results["poses"]])
    draw_body(panel, arm, right, up)
    panel.plot(points[:, right], points[:, up], ".", markersize=1.4, color=COLOURS[0],
               label="hand", rasterized=True)
    length = arm["upper_arm_m"] + arm["forearm_m"] + arm["hand_m"]
    shoulder = np.array(arm["shoulder_m"])[[right, up]]
    panel.add_patch(matplotlib.patches.Circle(shoulder, length, fill=False, linestyle="--",
                                              color=COLOURS[1], label="stretched arm"))
    panel.plot(*shoulder, "+", color=COLOURS[1])
    panel.set_aspect("equal")
    panel.set(xlabel=f"{AXES[right]} in m", ylabel=f"{AXES[up]} in m")


def shadow(S, right, up):
    """Ellipse (width, height, angle in degrees) of the ellipsoid seen along the third axis."""
    values, vectors = np.linalg.eigh(S[np.ix_([right, up], [right, up])])
    return (*2 * np.sqrt(np.maximum(values, 0.0)),
            np.degrees(np.arctan2(vectors[1, 0], vectors[0, 0])))


def draw_speeds(panel, results, scale=0.025, count=14):
    """Ellipsoids of speed near the plane through the shoulder, seen from the side."""
    arm = results["arm"]
    draw_body(panel, arm, 0, 2)
    shoulder = np.array(arm["shoulder_m"])
    near = [pose for pose in results["poses"]
            if abs(pose["T_F_hand"]["p_m"][1] - shoulder[1]) < 0.12]
    shown = []
    for pose in near:  # apart from each other
        p = np.array(pose["T_F_hand"]["p_m"])[[0, 2]]
        if len(shown) < count and all(np.linalg.norm(p - other) > 0.3 for other in shown):
            shown.append(p)
            width, height, angle = shadow(np.array(pose["velocity"]).reshape(3, 3), 0, 2)
            panel.add_patch(Ellipse(p, scale * width, scale * height, angle=angle, fill=False,
                                    color=COLOURS[0]))
    panel.plot([-0.5, -0.5 + 4 * scale], [0.15, 0.15], color="black")
    panel.text(-0.5, 0.2, "half axis of 4 m/s", fontsize=7)
    panel.set_aspect("equal")
    panel.set(xlabel="x in m", ylabel="z in m", title="speeds, from the side", xlim=(-0.95, 0.95),
              ylim=(0.0, 2.3))


def draw_ranges(panel, arm):
    names = [joint["name"] for joint in arm["joints"]]
    for y, joint in enumerate(arm["joints"]):
        low, high = np.degrees([joint["q_min_rad"], joint["q_max_rad"]])
        panel.barh(y, high - low, left=low, height=0.55, color=COLOURS[0], alpha=0.6,
                   label="this arm" if y == 0 else None)
        panel.plot(AAOS[joint["name"]], [y, y], "|", color="black", markersize=9,
                   label="AAOS" if y == 0 else None)
    panel.set_yticks(range(len(names)), names)
    panel.invert_yaxis()
    panel.set(xlabel="degrees", title="ranges of the joints", xlim=(-115, 190))


def figure_of(results):
    figure = pictures.new_figure(7.6)
    panels = figure.subplots(2, 2)
    draw_view(panels[0, 0], results, 0, 2)
    panels[0, 0].set_title("reach, from the side")
    draw_view(panels[0, 1], results, 0, 1)
    panels[0, 1].set_title("reach, from above")
    draw_speeds(panels[1, 0], results)
    draw_ranges(panels[1, 1], results["arm"])
    handles, labels = panels[0, 0].get_legend_handles_labels()
    more = panels[1, 1].get_legend_handles_labels()
    pictures.legend_below(figure, handles + more[0], labels + more[1])
    arm = results["arm"]
    figure.suptitle(f"{arm['sex']}, {arm['stature_m']:.2f} m tall", fontsize=9)
    return figure


def write(results, folder, docs=None):
    """Writes picture.svg."""
    del docs
    with matplotlib.rc_context({**SETTINGS, "svg.fonttype": "none"}):
        text = pictures.to_svg(figure_of(results), "arm")
    (folder / "picture.svg").write_text(text, encoding="utf-8")
