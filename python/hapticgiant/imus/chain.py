"""What inertial sensors on the links of a URDF measure, and its derivatives, over whole motions.

Read from the URDF itself, without the compiled model: all samples of a motion go through numpy at
once, and trees are allowed. SI units; g acts along -z of the root link. The state of n joints is
x = (q, dq, ddq), with 3 n entries.
"""

from __future__ import annotations

import dataclasses
import math
import pathlib
import xml.etree.ElementTree as ElementTree
from xml.parsers import expat

import numpy as np

GRAVITY = 9.81  # m/s^2
MOVING = ("revolute", "continuous", "prismatic")


class InputError(ValueError):
    """Bad input: what, where and what was expected."""


@dataclasses.dataclass
class Joint:
    """A joint of the URDF; `index` is its column in q, -1 for fixed ones."""

    name: str
    kind: str
    parent: str
    child: str
    rotation: np.ndarray  # (3, 3) of the joint's frame in its parent
    place: np.ndarray  # (3), m
    axis: np.ndarray  # (3), of length 1
    q_min: float  # rad or m
    q_max: float
    dq_max: float
    index: int = -1
    line: int = 0

    @property
    def unit(self):
        return "m" if self.kind == "prismatic" else "rad"


@dataclasses.dataclass
class Box:
    """A box that holds a shape: rotation and centre in the link's frame, half its edges (m)."""

    rotation: np.ndarray
    centre: np.ndarray
    half: np.ndarray


def rotation_of(rpy):
    (cr, cp, cy), (sr, sp, sy) = np.cos(rpy), np.sin(rpy)
    return np.array([[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                     [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
                     [-sp, cp * sr, cp * cr]])


def skew(v):
    """(..., 3, 3) with skew(v) @ w = v x w."""
    out = np.zeros((*v.shape, 3))
    out[..., 0, 1], out[..., 0, 2], out[..., 1, 2] = -v[..., 2], v[..., 1], -v[..., 0]
    return out - np.swapaxes(out, -1, -2)


def _elements(text):
    """The root element of an XML text; each element has its line as " line"."""
    builder, parser = ElementTree.TreeBuilder(), expat.ParserCreate()
    parser.StartElementHandler = lambda tag, attributes: builder.start(
        tag, {**attributes, " line": str(parser.CurrentLineNumber)})
    parser.EndElementHandler = builder.end
    parser.Parse(text, True)
    return builder.close()


class Chain:
    """The moving joints of a URDF, from the root on, and its links."""

    def __init__(self, file):
        self.file = pathlib.Path(file)
        try:
            root = _elements(self.file.read_bytes())
        except OSError as error:
            raise InputError(f"{file}: {error.strerror}") from None
        except expat.ExpatError as error:
            raise InputError(f"{file}:{error.lineno}: no XML: {error}") from None
        if root.tag != "robot":
            raise InputError(f"{file}:{root.get(' line')}: expected <robot>, got <{root.tag}>")
        self.name = root.get("name", self.file.stem)
        self.links = [link.get("name") for link in root.findall("link")]
        self._shapes = {link.get("name"): link for link in root.findall("link")}
        joints = [self._joint(element) for element in root.findall("joint")]
        self.joints = self._in_order(joints)
        self.moving = [joint for joint in self.joints if joint.kind in MOVING]
        if not self.moving:
            raise InputError(f"{file}: has no moving joint: nothing to estimate")
        for index, joint in enumerate(self.moving):
            joint.index = index

    @property
    def n(self):
        """Number of moving joints."""
        return len(self.moving)

    def _fault(self, element, what):
        return InputError(f"{self.file}:{element.get(' line')}: {what}")

    def _numbers(self, element, key, default, count=3):
        text = element.get(key) if element is not None else None
        if text is None:
            return np.array(default, float)
        try:
            numbers = np.array([float(word) for word in text.split()])
        except ValueError:
            numbers = np.array([math.nan])
        if len(numbers) != count or not np.isfinite(numbers).all():
            raise self._fault(element, f"{key}: expected {count} numbers, got '{text}'")
        return numbers

    def _origin(self, element):
        origin = element.find("origin")
        return (rotation_of(self._numbers(origin, "rpy", (0, 0, 0))),
                self._numbers(origin, "xyz", (0, 0, 0)))

    def _joint(self, element):
        name, kind = element.get("name"), element.get("type")
        if kind not in (*MOVING, "fixed"):
            raise self._fault(element, f"joint '{name}': type '{kind}'; "
                                       f"expected {', '.join(MOVING)} or fixed")
        if element.find("mimic") is not None:
            raise self._fault(element, f"joint '{name}': mimic joints are not supported")
        ends = []
        for end in ("parent", "child"):
            link = element.find(end)
            link = link.get("link") if link is not None else None
            if link not in self._shapes:
                raise self._fault(element, f"joint '{name}': {end} link '{link}' is not there")
            ends.append(link)
        axis = self._numbers(element.find("axis"), "xyz", (1, 0, 0))
        if kind != "fixed" and not np.linalg.norm(axis) > 0:
            raise self._fault(element, f"joint '{name}': axis: must not be zero")
        limit = element.find("limit")
        free = kind == "continuous"
        number = lambda key, default: float(self._numbers(limit, key, [default], 1)[0])  # noqa: E731
        q_min = -math.pi if free else number("lower", 0)
        q_max = math.pi if free else number("upper", 0)
        if kind != "fixed" and not q_min < q_max:
            raise self._fault(element, f"joint '{name}': expected lower < upper, "
                                       f"got {q_min:g} and {q_max:g}")
        length = np.linalg.norm(axis) or 1.0
        return Joint(name, kind, *ends, *self._origin(element), axis / length, q_min, q_max,
                     number("velocity", 1.0) or 1.0, line=int(element.get(" line")))

    def _in_order(self, joints):
        children = {joint.child for joint in joints}
        if len(children) < len(joints):
            raise InputError(f"{self.file}: a link is the child of two joints")
        roots = [link for link in self.links if link not in children]
        if len(roots) != 1:
            raise InputError(f"{self.file}: expected one root link, got {len(roots)}")
        self.root, ordered, at = roots[0], [], [roots[0]]
        while at:
            link = at.pop(0)
            below = [joint for joint in joints if joint.parent == link]
            ordered += below
            at += [joint.child for joint in below]
        if len(ordered) < len(joints):
            raise InputError(f"{self.file}: links form a loop")
        return ordered

    def moving_links(self):
        """Links that move, without those that are fixed to another one of them, from the root on."""
        return [joint.child for joint in self.moving]

    def poses(self, q):
        """{link: (rotation (3, 3), place (3))} in the root link for one posture."""
        at = {self.root: (np.eye(3), np.zeros(3))}
        for joint in self.joints:
            R, p = at[joint.parent]
            turn, shift = self._moved(joint, np.asarray(q)[None])
            at[joint.child] = R @ turn[0], p + R @ shift[0]
        return at

    def _moved(self, joint, q):
        """Rotation (T, 3, 3) and place (T, 3) of the child in the parent."""
        count = len(q)
        turn, shift = np.tile(joint.rotation, (count, 1, 1)), np.tile(joint.place, (count, 1))
        if joint.index < 0:
            return turn, shift
        angle = q[:, joint.index]
        if joint.kind == "prismatic":
            return turn, shift + angle[:, None] * (joint.rotation @ joint.axis)
        k = skew(joint.axis)
        sine, versine = np.sin(angle)[:, None, None], (1 - np.cos(angle))[:, None, None]
        return turn @ (np.eye(3) + sine * k + versine * (k @ k)), shift

    def motion(self, q, dq, ddq, gravity=True, links=None):
        """{link: LinkMotion} for samples q, dq, ddq, each (T, n); of all links, or of these."""
        q, dq, ddq = (np.asarray(each, float) for each in (q, dq, ddq))
        count, n = q.shape
        zero = np.zeros((count, 3, 3 * n))
        at = {self.root: LinkMotion(
            np.zeros((count, 3)), np.zeros((count, 3)),
            np.tile([0, 0, GRAVITY if gravity else 0.0], (count, 1)), zero, zero, zero)}
        for joint in self.joints:
            at[joint.child] = self._child(joint, at[joint.parent], q, dq, ddq)
        return at if links is None else {link: at[link] for link in links}

    def _child(self, joint, parent, q, dq, ddq):
        n, i, u = self.n, joint.index, joint.axis
        turn, shift = self._moved(joint, q)
        back = np.swapaxes(turn, 1, 2)
        rotate = lambda v: np.einsum("tij,tj->ti", back, v)  # noqa: E731
        w, al = rotate(parent.w), rotate(parent.al)
        a_there, da_there = parent.at(shift)
        a = rotate(a_there)
        dw, dal, da = back @ parent.dw, back @ parent.dal, back @ da_there
        if i < 0:
            return LinkMotion(w, al, a, dw, dal, da)
        speed, rate = dq[:, i, None], ddq[:, i, None]
        position, velocity, acceleration = i, n + i, 2 * n + i
        if joint.kind == "prismatic":
            # the place in the parent moves with q along the axis
            al_x, w_x = np.cross(al, u), np.cross(w, u)
            da[:, :, position] += al_x + np.cross(w, w_x)
            da += 2 * speed[:, :, None] * (-skew(u) @ dw)
            da[:, :, velocity] += 2 * w_x
            da[:, :, acceleration] += u
            return LinkMotion(w, al, a + u * rate + 2 * speed * w_x, dw, dal, da)
        u_w = np.cross(w, u)  # how w turns back when the child's frame turns on
        dw[:, :, position] += u_w
        dal[:, :, position] += np.cross(al, u)
        da[:, :, position] += np.cross(a, u)
        dal += speed[:, :, None] * (-skew(u) @ dw)
        dw[:, :, velocity] += u
        dal[:, :, velocity] += u_w
        dal[:, :, acceleration] += u
        return LinkMotion(w + u * speed, al + u_w * speed + u * rate, a, dw, dal, da)

    def boxes(self, link):
        """Boxes of the link's shapes, those of collision if it has any, with what is fixed to it."""
        found, at = [], [(link, np.eye(3), np.zeros(3))]
        while at:
            name, R, p = at.pop()
            element = self._shapes[name]
            for shape in element.findall("collision") or element.findall("visual"):
                box = self._box(shape)
                if box is not None:
                    found.append(Box(R @ box.rotation, p + R @ box.centre, box.half))
            at += [(joint.child, R @ joint.rotation, p + R @ joint.place) for joint in self.joints
                   if joint.parent == name and joint.index < 0]
        return found

    def _box(self, shape):
        R, p = self._origin(shape)
        geometry = shape.find("geometry")
        inner = list(geometry) if geometry is not None else []
        if not inner:
            raise self._fault(shape, f"<{shape.tag}> without a shape")
        one = inner[0]
        number = lambda key: float(self._numbers(one, key, [math.nan], 1)[0])  # noqa: E731
        if one.tag == "box":
            half = self._numbers(one, "size", [math.nan] * 3) / 2
        elif one.tag == "sphere":
            half = np.full(3, number("radius"))
        elif one.tag in ("cylinder", "capsule"):
            radius = number("radius")
            end = radius if one.tag == "capsule" else 0.0
            half = np.array([radius, radius, number("length") / 2 + end])
        elif one.tag == "mesh":
            return None  # see candidates(): the way to the next joint stands for it
        else:
            raise self._fault(one, f"unknown shape <{one.tag}>; "
                                   "expected box, cylinder, capsule, sphere or mesh")
        if not np.isfinite(half).all():
            raise self._fault(one, f"<{one.tag}>: measures are missing")
        return Box(R, p, half)

    def places_of_children(self, link):
        """Origins of the joints that the link carries, in its frame."""
        return [joint.place for joint in self.joints if joint.parent == link]


@dataclasses.dataclass
class LinkMotion:
    """Motion of a link, in its own frame, per sample: angular velocity w, angular acceleration al,
    specific force a of the origin (acceleration minus gravity), each (T, 3), and their derivatives
    by x, each (T, 3, 3 n)."""

    w: np.ndarray
    al: np.ndarray
    a: np.ndarray
    dw: np.ndarray
    dal: np.ndarray
    da: np.ndarray

    def at(self, r):
        """Specific force and its derivative at r, (3) or (T, 3) in the link's frame."""
        r = np.broadcast_to(r, self.w.shape)
        w_r = np.cross(self.w, r)
        value = self.a + np.cross(self.al, r) + np.cross(self.w, w_r)
        slope = self.da - skew(r) @ self.dal - (skew(w_r) + skew(self.w) @ skew(r)) @ self.dw
        return value, slope

    def measured(self, r):
        """Gyroscope, then accelerometer at r: (T, 6), and the derivative (T, 6, 3 n)."""
        force, slope = self.at(r)
        return np.concatenate([self.w, force], 1), np.concatenate([self.dw, slope], 1)
