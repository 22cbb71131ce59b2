"""Runs as the program leaves them: run.json and signals.npy of a folder.

run.json says what the scenario, its device and its twin are, and which events there were;
signals.npy holds columns of a recording, a row per cycle or per period. Positions of the
manipulator are those of the reference, as in the paper; of the gantry as estimated; the wrench is
the user's as estimated.
"""

import csv
import json
import math

import numpy as np

FIGURE_PERIOD_S = 0.01  # of the rows in signals.csv
TICK_S = 1e-7  # times are whole cycles up to rounding


class Run:
    """One run: what run.json says, and its signals by the names of signals.csv."""

    def __init__(self, folder):
        self.folder = folder
        self.facts = json.loads((folder / "run.json").read_text(encoding="utf-8"))
        self.table = np.load(folder / "signals.npy")
        self.time = self.table["time_s"]

    def __getitem__(self, name):
        return self.facts[name]

    def rows(self, from_s, to_s):
        """Rows from the first at or after `from_s` to before the first at or after `to_s`."""
        return slice(*np.searchsorted(self.time, (from_s - TICK_S, to_s - TICK_S)))

    def locked(self):
        """Phases in which a lock held a joint of the twin, in the order of their beginnings."""
        phases = []
        causes = self.table["limits.cause"]
        for number, limit in enumerate(self["limits"][:causes.shape[1]]):
            held = np.concatenate([[False], causes[:, number] == self["lock_cause"], [False]])
            edges = np.flatnonzero(held[1:] != held[:-1])
            phases += [{"joint": limit["name"], "from_s": self.time[first],
                        "to_s": self.time[end - 1]} for first, end in zip(edges[::2], edges[1::2])]
        return sorted(phases, key=lambda phase: phase["from_s"])

    def person(self):
        """A person who walks through a doorway: columns by name, in the frame of the doorway (x along
        the shut leaf, y the way it opens); None: no person does."""
        person = self.facts.get("person")
        if not person or not person["film"]:
            return None
        columns = dict(zip(person["columns"], np.array(person["film"]).T))
        axes = np.array([person["along"], person["away"]]).T

        def local(x, y):
            return (np.stack([x, y], axis=1) - person["hinge_m"]) @ axes

        time = columns["time_s"]
        x, y = local(columns["x_m"], columns["y_m"]).T
        handle = local(*(np.interp(time, self.time, self.table["handle.p"][:, axis])
                         for axis in (0, 1)))
        dof = next(dof for dof in self["twin"] if dof["name"] == person["joint"])
        angle = np.interp(time, self.time, entry(self.table["twin.q_a"], dof["q"]))
        leaf = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        along = np.clip(x * leaf[:, 0] + y * leaf[:, 1], 0.0, person["leaf_width_m"])
        heading = columns["heading_rad"] - math.atan2(person["along"][1], person["along"][0])
        return {"time_s": time, "x_m": x, "y_m": y, "hold": columns["hold"], "angle_rad": angle,
                "heading_rad": heading, "handle_x_m": handle[:, 0], "handle_y_m": handle[:, 1],
                "to_leaf_m": np.hypot(x - along * leaf[:, 0], y - along * leaf[:, 1]),
                "to_frame_m": np.hypot(
                    np.maximum(np.minimum(x, person["clear_width_m"] - x), 0.0), y)}

    def signals(self):
        """Columns by name, as in signals.csv."""
        table, azimuth = self.table, self.table["handle.r"]
        wrench = table["robot.w_h"]
        columns = {"time_s": self.time, "running": 1.0 * (table["mode"] == self["running_mode"]),
                   "force_N": np.linalg.norm(wrench[:, :3], axis=1),
                   "torque_Nm": np.linalg.norm(wrench[:, 3:], axis=1),
                   "felt_limit": table["felt_limit"], "hand_to_twin_m": table["sync_error"]}

        def add(name, unit, positions, speeds, place, speed_place=None):
            columns[f"{name}_{unit}"] = entry(positions, place)
            columns[f"{name}_{unit}_per_s"] = entry(speeds, place if speed_place is None
                                                    else speed_place)

        for place, joint in enumerate(self["manipulator"]):
            add(joint["name"], joint["unit"], table["reference.q_m"], table["reference.dq_m"], place)
        for joint in self["virtual"]:
            weights = np.array(joint["weights"])
            q = table["reference.q_m"]
            columns[f"{joint['name']}_rad"] = q @ weights if q.shape[1] == len(weights) else \
                np.full(len(q), np.nan)
        for place, joint in enumerate(self["gantry"]):
            add(joint["name"], joint["unit"], table["robot.q_p"], table["robot.dq_p"], place)
        for place, axis in enumerate("xyz"):
            columns[f"hand_{axis}_m"] = table["handle.p"][:, place]
        columns["hand_azimuth_rad"] = np.arctan2(azimuth[:, 5], azimuth[:, 2])
        for place, axis in enumerate("xy" if self["has_elbow"] else ""):
            columns[f"elbow_{axis}_m"] = table["p_b_elbow"][:, place]
        for dof in self["twin"]:
            add(dof["name"], dof["unit"], table["twin.q_a"], table["twin.dq_a"], dof["q"], dof["v"])
            columns[f"{dof['name']}_{torque_unit(dof)}"] = entry(table["tau_a"], dof["v"])
        return columns

    def figure_signals(self):
        """Columns with one row per period of a figure."""
        rows, due_s = [], 0.0
        for row, time_s in enumerate(self.time):
            if time_s >= due_s - TICK_S:
                rows.append(row)
                due_s = time_s + FIGURE_PERIOD_S
        return {name: column[rows] for name, column in self.signals().items()}

    def save_csv(self):
        """signals.csv: the signals of a figure, six digits."""
        signals = self.figure_signals()
        values = np.column_stack(list(signals.values())) + 0.0
        with open(self.folder / "signals.csv", "w", encoding="utf-8", newline="") as stream:
            csv.writer(stream, lineterminator="\n").writerow(signals)
            np.savetxt(stream, values, fmt="%.6g", delimiter=",")

    def figure_facts(self):
        """What a figure shows besides signals."""
        facts = {name: self[name] for name in ("title", "kind", "box", "has_elbow")}
        facts["doorway"] = self.facts.get("person")
        facts["person"] = self.person()
        for group in ("manipulator", "virtual", "gantry", "twin"):
            facts[group] = [joint | {"column": f"{joint['name']}_{joint['unit']}"}
                            for joint in self[group]]
        for dof in facts["twin"]:
            dof |= {"speed_column": dof["column"] + "_per_s", "torque_unit": torque_unit(dof),
                    "torque_column": f"{dof['name']}_{torque_unit(dof)}"}
        found = [{"label": label_of(event), "time_s": event["time_s"], "what": event["what"],
                  "points": event.get("points")}
                 for event in self["events"] if event["time_s"] is not None]
        places = [(event["name"], condition["place"])
                  for event in self.facts.get("expected", self["events"])
                  for condition in event.get("all_of", ()) if "place" in condition]
        return facts | {
            "note": self.facts.get("note", ""), "events": found, "locked": self.locked(),
            "poses": [event for event in found if event["points"]],
            "checkpoints": [{"name": name, "x_m": x, "y_m": y, "azimuth_rad": azimuth}
                            for name, (x, y, azimuth) in places]}


def entry(values, place):
    """One number of each row; NaN where the rows are shorter."""
    return values[:, place] if place < values.shape[1] else np.full(len(values), np.nan)


def torque_unit(dof):
    return "Nm" if dof["unit"] == "rad" else "N"


def label_of(event):
    """Name of the event in the paper: "t_b", or what its sentence begins with ("t_a: ...")."""
    if not event["name"].startswith("t_") and event["what"].startswith("t_"):
        return event["what"].split(":")[0]
    return event["name"]


def condition_text(condition):
    """A condition in words, for example "elbow x within 2 mm of its upper limit, which acts"."""
    kind, name, value = condition["kind"], condition.get("of", ""), condition["value"]
    side = condition["side"] + " " if "side" in condition else ""
    unit = condition.get("unit")
    if kind == "limit":
        near = "5 mrad" if unit == "rad" else "2 mm"
        return f"{name} within {near} of its {side}limit, which acts"
    if kind == "speed limit":
        return f"the {side}speed limit of {name} acts"
    if kind == "turns":
        return f"{name} has turned by {value:g} turn{'' if abs(value) == 1 else 's'} since the start"
    if kind == "handle at":
        x, y, azimuth = condition["place"]
        return (f"handle within 0.10 m and 15 degrees of x {x:g} m, y {y:g} m, azimuth "
                f"{math.degrees(azimuth):.0f} degrees")
    sign = ">" if kind.endswith("above") else "<"
    return {"locked": f"a lock holds {name}",
            "surface": f"of all surfaces {name} pushes the twin most",
            "elapsed": f"at least {value:g} s after the hand has taken the handle",
            "force": f"force of the user {sign} {value:g} N",
            "twin": f"{name} {sign} {value:g} {unit}",
            "gantry": f"gantry {name} {sign} {value:g} m"}[kind.split()[0]]


def condition_data(condition):
    """A condition as data, with the names of its kind and units in a scenario file."""
    kind = condition["kind"].replace(" ", "_")
    data = {"kind": kind + {"force": "_N", "gantry": "_m", "elapsed": "_s"}.get(kind.split("_")[0],
                                                                             "")}
    if "of" in condition:
        data["of"] = condition["of"]
    if kind in ("limit", "speed_limit"):
        data["side"] = condition.get("side", "either")
    elif "place" in condition:
        data["place"] = dict(zip(("x_m", "y_m", "azimuth_rad"), condition["place"]))
    elif kind not in ("locked", "surface"):
        data["value"] = condition["value"]
    return data
