"""Ten mechanisms that people have, as URDFs: none of them ships with the project, and no generator was made for one.

write(FOLDER) writes them all; each has a frame 'handle'.
"""

import pathlib


def link(name, mass, com="0 0 0", inertia=0.05):
    tensor = " ".join(f'{key}="{inertia if key in ("ixx", "iyy", "izz") else 0}"'
                      for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"))
    return (f'<link name="{name}"><inertial><origin xyz="{com}"/><mass value="{mass}"/><inertia {tensor}/>'
            "</inertial></link>\n")


def joint(name, kind, parent, child, axis, lower, upper, speed, at="0 0 0"):
    return (f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/><origin xyz="{at}"/>'
            f'<axis xyz="{axis}"/><limit lower="{lower}" upper="{upper}" velocity="{speed}" effort="100"/></joint>\n')


def handle(parent, at, turned="1.5708 0 1.5708"):
    return (f'<joint name="grip" type="fixed"><parent link="{parent}"/><child link="handle"/>'
            f'<origin xyz="{at}" rpy="{turned}"/></joint>\n<link name="handle"/>\n')


MECHANISMS = {
    "cupboard": link("leaf", 3, "0.15 0 0") + joint("hinge", "revolute", "frame", "leaf", "0 0 1", 0, 1.4, 1.5)
    + handle("leaf", "0.3 0.03 0"),
    "drawer": link("box", 4) + joint("slide", "prismatic", "frame", "box", "1 0 0", 0, 0.3, 0.8) + handle("box", "0 0 0"),
    "lid": link("flap", 2, "0.1 0 0") + joint("hinge", "revolute", "frame", "flap", "0 -1 0", 0, 1.2, 1.5)
    + handle("flap", "0.2 0 0"),
    "knob": link("knob", 0.3, inertia=0.002) + joint("turn", "revolute", "frame", "knob", "0 0 1", -0.8, 0.8, 3)
    + handle("knob", "0 0 0.02"),
    "crank": link("arm", 1, "0.06 0 0", 0.01) + joint("shaft", "revolute", "frame", "arm", "0 1 0", -1.5, 1.5, 2)
    + handle("arm", "0.12 0 0"),
    "window": link("sash", 6) + joint("slide", "prismatic", "frame", "sash", "0 0 1", 0, 0.25, 0.6)
    + handle("sash", "0 0 0"),
    "lever": link("bar", 1.5, "0 0 0.2", 0.03) + joint("pivot", "revolute", "frame", "bar", "1 0 0", -0.5, 0.5, 2)
    + handle("bar", "0 0 0.35"),
    "table": link("x", 3) + link("y", 2) + joint("slide_x", "prismatic", "frame", "x", "1 0 0", -0.12, 0.12, 0.5)
    + joint("slide_y", "prismatic", "x", "y", "0 1 0", -0.12, 0.12, 0.5) + handle("y", "0 0 0"),
    "gate": link("panel", 10, "0.35 0 0", 0.5) + joint("hinge", "revolute", "frame", "panel", "0 0 1", 0, 1.0, 1)
    + handle("panel", "0.6 0.05 0"),
    "elbow": link("upper", 2, "0.12 0 0") + link("lower", 1.5, "0.12 0 0")
    + joint("first", "revolute", "frame", "upper", "0 0 1", -0.4, 0.6, 1.5)
    + joint("second", "revolute", "upper", "lower", "0 0 1", 0.3, 1.3, 2, "0.25 0 0") + handle("lower", "0.25 0 0"),
}


def write(folder):
    """Writes NAME.urdf for every mechanism into `folder`."""
    for name, body in MECHANISMS.items():
        text = f'<robot name="{name}">\n<link name="frame"/>\n{body}</robot>\n'
        (pathlib.Path(folder) / f"{name}.urdf").write_text(text)
