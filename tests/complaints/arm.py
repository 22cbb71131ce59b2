"""An arm of models/arms for the situations of complaints_test.py: its files and where its handle is.

Everything stands on paths of its own: a changed device may be written anywhere.
"""

import copy
import pathlib
import re
import xml.etree.ElementTree as ET

import numpy as np
import yaml

ARMS = pathlib.Path(__file__).resolve().parents[2] / "models/arms"


def load(file):
    text = pathlib.Path(file).read_text(encoding="utf-8")
    return yaml.safe_load(re.sub(r"(?<![.\d])(\d+)e-", r"\1.0e-", text))  # PyYAML reads 1e-4 as a word


def rotation(axis, angle):
    x, y, z = axis
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def pose(xyz, rpy):
    T = np.eye(4)
    T[:3, :3] = rotation([0, 0, 1], rpy[2]) @ rotation([0, 1, 0], rpy[1]) @ rotation([1, 0, 0], rpy[0])
    T[:3, 3] = xyz
    return T


def numbers(element, key, default):
    text = default if element is None else element.get(key, default)
    return np.array([float(word) for word in text.split()])


class Arm:
    """The device file, and its chain from base to handle."""

    def __init__(self, name):
        self.name = name
        self.device = load(ARMS / name / "device.yaml")
        for key in ("urdf", "tool", "simulation"):
            self.device[key] = str((ARMS / name / self.device[key]).resolve())
        self.joints = list(self.device["manipulator"])
        self.q = np.array([self.device["posture"].get(joint, 0.0) for joint in self.joints])
        handle = load(self.device["tool"])["handle"]
        self.handle = pose([handle.get(f"{axis}_m", 0) for axis in "xyz"],
                           [handle.get(f"{angle}_rad", 0) for angle in ("roll", "pitch", "yaw")])
        of_link = {joint.find("child").get("link"): joint for joint in ET.parse(self.device["urdf"]).iter("joint")
                   if joint.find("child") is not None}
        self.chain, link = [], self.device["flange"]
        while link in of_link:
            self.chain.insert(0, of_link[link])
            link = of_link[link].find("parent").get("link")

    def limits(self, joint):
        """Lower and upper end, as in the device file or the URDF; infinite: it turns without end."""
        (element,) = [element for element in self.chain if element.get("name") == joint]
        given = self.device["joints"].get(joint, {})
        if element.get("type") == "continuous":
            lower, upper = -np.inf, np.inf
        else:
            lower, upper = (float(element.find("limit").get(key)) for key in ("lower", "upper"))
        return given.get("q_min_rad", lower), given.get("q_max_rad", upper)

    def at(self, q):
        """Pose of the handle in the base, and its Jacobian, axes of the base."""
        T, axes, places = np.eye(4), [], []
        angles = dict(zip(self.joints, q))
        for joint in self.chain:
            origin = joint.find("origin")
            T = T @ pose(numbers(origin, "xyz", "0 0 0"), numbers(origin, "rpy", "0 0 0"))
            if joint.get("name") in angles:
                axis = numbers(joint.find("axis"), "xyz", "1 0 0")
                axes.append(T[:3, :3] @ axis)
                places.append(T[:3, 3].copy())
                T[:3, :3] = T[:3, :3] @ rotation(axis, angles[joint.get("name")])
        T = T @ self.handle
        columns = [np.r_[np.cross(axis, T[:3, 3] - place), axis] for axis, place in zip(axes, places)]
        return T, np.array(columns).T

    def device_at(self, q):
        """A copy of the device file whose runs begin there."""
        device = copy.deepcopy(self.device)
        device["posture"] = dict(zip(self.joints, map(float, q)))
        return device


def start_of(T):
    """A handle's pose as the start of a free twin: R = Rz(azimuth) Ry(pi - pitch) Rz(pi + roll)."""
    R = T[:3, :3]
    tilt = np.arctan2(np.hypot(R[0, 2], R[1, 2]), R[2, 2])
    if np.sin(tilt) > 1e-9:
        azimuth, turn = np.arctan2(R[1, 2], R[0, 2]), np.arctan2(R[2, 1], -R[2, 0])
    else:
        azimuth, turn = 0.0, np.arctan2(R[1, 0], R[0, 0] if tilt < 1 else -R[0, 0])
    place = {f"{axis}_m": float(p) for axis, p in zip("xyz", T[:3, 3])}
    return place | {"azimuth_rad": float(azimuth), "pitch_rad": float(np.pi - tilt), "roll_rad": float(turn - np.pi)}
