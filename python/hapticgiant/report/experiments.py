"""The report of `hapticgiant experiment cartesian|excavator|door|path`: a run beside the paper."""

import json
import math
import pathlib

import numpy as np

from .. import figures
from . import pages
from .runs import Run, condition_data, condition_text, label_of

PATH_REACHED_M = 0.05  # a checkpoint counts

# Time of the script, counted from the grasp, in which it provokes an event, and what the person
# does then: segments of models/scripts. The same event at another time does not count.
WINDOWS = {
    "cartesian": {
        "t_a": (1.0, 15.0, "the hand walks 1.15 turns of a circle of 0.9 m"),
        "t_b": (16.0, 19.5, "the hand walks back in +x with the elbow on that side"),
        "t_b'": (19.0, 21.5, "the hand turns and reaches on in +x"),
        "t_c": (24.3, 26.2, "the handle is pitched down"),
        "t_d": (27.5, 30.0, "the handle is rolled"),
        "t_e": (32.2, 35.4, "the handle is raised"),
        "t_f": (37.6, 45.6, "the hand walks in +y"),
        "t_g": (37.6, 46.0, "the hand walks on in +y")},
    "excavator": {
        "boom": (1.0, 2.7, "the bucket is pushed out and down"),
        "t_a": (2.5, 4.8, "the bucket is pulled in, down and curled"),
        "t_b": (5.6, 9.2, "the arm reaches out"),
        "t_c": (11.6, 15.0, "the arm is swung to the right"),
        "t_d": (15.0, 20.8, "the arm is swung to the left"),
        "t_e": (24.0, 27.7, "the bucket digs"),
        "unload": (29.8, 31.6, "the bucket is emptied")},
    "door": {
        "locked": (1.0, 4.0, "the hand pushes and pulls without pressing the lever"),
        "handle pressed": (4.5, 5.3, "the hand presses the lever"),
        "pulled": (5.0, 6.6, "the hand presses the lever and pulls"),
        "locked again": (6.6, 7.5, "the hand lets go of the lever"),
        "unlocked": (8.0, 8.9, "the hand leans against the door and presses the lever"),
        "open stop": (8.6, 11.2, "the hand walks through"),
        "velocity limit": (11.2, 12.5, "the hand has let go"),
        "closed and locked": (11.2, 14.0, "the door falls shut")},
    "walk_through": {
        "handle pressed": (0.8, 1.3, "the hand presses the lever"),
        "opened": (1.2, 2.2, "the body sets out, the hand pushes"),
        "wide enough": (1.4, 3.5, "the hand opens the leaf as far as the body needs"),
        "shut again": (3.0, 9.0, "the hand has let go, the door falls shut")},
    "path": {},
}
ABOUT = {
    "cartesian": "A rigid body of 6 kg floats freely in six degrees of freedom. A scripted hand "
    "walks it through the workspace until, one after the other, the limits of the device are felt.",
    "excavator": "The hand holds the bucket of an excavator with four joints (swing, boom, stick, "
    "bucket), whose limits are met one after the other.",
    "door": "A door with a lever, a bolt and a closer. It resists while it is locked, opens once "
    "the lever is pressed while it is pushed, and falls shut. Then, as in the user study of section "
    "VII-D, a person opens it and walks through.",
    "path": "A person walks a free body of 6 kg along six checkpoints that are spread over the "
    "workspace and force turns.",
}
COMMENT = {
    "cartesian": "The paper's run is one expert's, on the machine; ours is a scripted hand on a "
    "simulated one, so times and forces of the two cannot be compared, events and their order can. "
    "The paper sees raised forces wherever the gantry moves far, because its drives do not "
    "compensate its dynamics; our simulated gantry (40 ms lag, 2.5 m/s^2) does not push back at the "
    "handle, so this does not show here.",
    "excavator": "Geometry and masses of the paper's excavator are not published: ours are assumed, "
    "and so are its limits. What can be compared is what happens: at t_a the bucket ends while the "
    "boom is at its end, and the stick has to take over at once.",
    "door": "Inertias, springs and the closer of the paper's door are not published: ours are "
    "assumed. The paper lets it slam; ours closes at the speed of its closer as well.",
    "path": "The paper asks 20 people how they liked it (NASA TLX, Fig. 10); a simulated person "
    "cannot be asked. Its checkpoints are not published: ours are spread over our workspace. What "
    "is left is whether they can be reached, how fast, and what the limits do meanwhile.",
}
# keys of a summary that are the same whenever the same run is made again
REPRODUCIBLE = ("version", "scenario", "law", "bounds", "gantry", "braking", "rate_Hz", "duration_s",
                "cycles", "events", "missing_events", "limits", "limits_held", "reality",
                "sync_error", "force", "solver", "acceleration_change_per_cycle", "state_hash",
                "allocations_in_loop", "fault")


def text(value, digits):
    """A value, or "-" where an event is missing."""
    return "-" if math.isnan(value) else f"{value + 0.0:.{digits}f}"


def largest(values):
    """Of these values; not a number where one of them is none, which max() may pass over."""
    return float(np.max(list(values)))


class Stretch:
    """Statistics of a signal over a time interval; NaN for an empty one: an event is missing."""

    def __init__(self, values):
        self.mean, self.least, self.most = (
            (values.mean(), values.min(), values.max()) if len(values) else (math.nan,) * 3)
        self.magnitude = largest((abs(self.least), abs(self.most)))


class Measured(Run):
    """A run with what is measured of it: events, statements beside the paper, failures."""

    def __init__(self, folder):
        super().__init__(folder)
        summary = json.loads((folder / "timing.json").read_text(encoding="utf-8"))
        self.summary = {key: summary[key] for key in REPRODUCIBLE if key in summary}
        self.summary["seed"] = self["seed"]
        self.law = summary["law"]
        self.columns = self.signals()
        self.end = self.time[-1]
        self.times = {event["name"]: event["time_s"] for event in self["events"]}
        self.events = [self.judged(event) for event in self["events"]]
        self.failures = list(self["failures"]) + self.missed()
        self.statements = MEASURES[self["kind"]](self) + [
            ("hand and twin apart", "",
             f"at most {text(1e3 * self.over('hand_to_twin_m', 0.0, self.end).most, 3)} mm")]

    def judged(self, event):
        window = WINDOWS[self["kind"]].get(event["name"])
        judged = {"label": label_of(event), "name": event["name"], "what": event["what"],
                  "condition": " and ".join(map(condition_text, event["all_of"])),
                  "all_of": [condition_data(condition) for condition in event["all_of"]]}
        if window:
            begin, end, because = window
            judged["expected"] = {"from_s": self["grasp_s"] + begin, "to_s": self["grasp_s"] + end,
                                  "because": because}
        found, expected = event["time_s"], judged.get("expected")
        judged["found_s"] = found
        judged["is_as_expected"] = found is not None and (
            not expected or expected["from_s"] <= found <= expected["to_s"])
        return judged

    def missed(self):
        failures = []
        for event in self.events:
            if event["found_s"] is None:
                failures.append(f"{event['name']} did not happen: {event['what']}")
            elif not event["is_as_expected"]:
                expected = event["expected"]
                failures.append(
                    f"{event['name']} happened at {event['found_s']:.3f} s, expected "
                    f"{expected['from_s']:.1f} .. {expected['to_s']:.1f} s: {expected['because']}")
        if not self.summary["limits_held"]:
            failures.append("a limit was exceeded, see the table")
        if self.has_fault():
            failures.append(f"fault {self.summary['fault']['code']}: {self.summary['fault']['what']}")
        return failures

    def has_fault(self):
        return self.summary["fault"]["code"] != 0

    def t(self, event):
        """Time of an event; NaN where it is missing."""
        return math.nan if self.times.get(event) is None else self.times[event]

    def over(self, signal, from_s, to_s):
        rows = self.rows(from_s, to_s) if from_s < to_s else slice(0, 0)
        return Stretch(self.columns[signal][rows])

    def at(self, signal, time_s):
        row = math.nan if math.isnan(time_s) else self.rows(0.0, time_s).stop
        return self.columns[signal][row] if row < len(self.time) else math.nan

    def limit(self, name, side):
        """A limit of the model as text."""
        return f"{next(it[side] for it in self['limits'] if it['name'] == name):g}"

    def name(self):
        """How verdicts name the run."""
        return f"law {self.law}" + (", walking through" if self["kind"] == "walk_through" else "")

    def note(self, with_law=True):
        summary = self.summary
        law = f"law {self.law}, " if with_law else ""
        return (f"{law}{summary['bounds']} bounds, seed {summary['seed']}, {summary['rate_Hz']:g} Hz, "
                f"simulated {self['device']}")

    def figure(self):
        return figures.Run(self.figure_facts() | {"note": self.note()}, self.figure_signals())


def limit_forces(run):
    """Mean force while no limit is felt; mean and largest while one is, and its share of time."""
    is_running = run.columns["running"] > 0.0
    is_felt = is_running & (run.columns["felt_limit"] >= 0.0)
    force = run.columns["force_N"]
    free, felt = force[is_running & ~is_felt], force[is_felt]
    return (free.mean() if len(free) else 0.0, felt.mean() if len(felt) else 0.0,
            felt.max(initial=0.0), len(felt) / max(len(felt) + len(free), 1))


def measure_cartesian(run):
    over, at, t = run.over, run.at, run.t
    a, b, b2, c, d, e, f, g = map(t, ("t_a", "t_b", "t_b'", "t_c", "t_d", "t_e", "t_f", "t_g"))
    free, felt, _, _ = limit_forces(run)

    def force(from_s, to_s):
        return over("force_N", from_s, to_s)

    others = largest(over(f"m{joint}_rad_per_s", d, d + 0.5).magnitude for joint in range(1, 5))
    return [
        ("t_a: turn of joint 1", "a full turn is completed",
         f"at {text(a, 2)} s; force until then at most {text(force(1.0, a).most, 1)} N"),
        ("t_b: elbow at its limit in x", "its motion is inhibited, the hand moves on, force rises",
         f"elbow at most at {text(over('elbow_x_m', 0.0, run.end).most, 4)} m "
         f"(limit {run.limit('elbow x', 'upper')}), hand moves on by "
         f"{text(at('hand_x_m', b + 1.0) - at('hand_x_m', b), 2)} m in 1 s, force "
         f"{text(force(b - 0.5, b).mean, 1)} to {text(force(b, b + 1.0).most, 1)} N"),
        ("t_b': hand at its limit in x", "a peak of the resistance",
         f"peak {text(force(b2, b2 + 2.0).most, 1)} N"),
        ("t_c: singularity", "the measure does not exceed its limit, torque increases",
         f"q4+q5 at least {text(over('q4+q5_rad', 0.0, run.end).least, 4)} rad "
         f"(limit {run.limit('q4+q5', 'lower')}), torque "
         f"{text(over('torque_Nm', c - 0.5, c).mean, 2)} to "
         f"{text(over('torque_Nm', c, c + 1.0).most, 2)} Nm"),
        ("t_d: joint 6 at its lower limit", "maintained without affecting other parts",
         f"m6 at least {text(over('m6_rad', 0.0, run.end).least, 4)} rad "
         f"(limit {run.limit('m6', 'lower')}); fastest other joint in the next 0.5 s: "
         f"{text(others, 3)} rad/s"),
        ("t_e: joint 4 at its upper limit", "height cannot be increased, force jumps",
         f"m4 at most {text(over('m4_rad', 0.0, run.end).most, 4)} rad "
         f"(limit {run.limit('m4', 'upper')}), force {text(force(e - 0.5, e).mean, 1)} to "
         f"{text(force(e, e + 1.0).most, 1)} N; height {text(at('hand_z_m', e), 3)} m, then "
         f"{text(over('hand_z_m', e, e + 1.5).most, 3)} m by tilting the handle"),
        ("t_f: gantry ends in y", "full stop in y, x still possible, force and torque stay low",
         f"until t_g: force at most {text(force(f, g).most, 1)} N, torque at most "
         f"{text(over('torque_Nm', f, g).most, 2)} Nm; joint 2 goes from {text(at('m2_rad', f), 2)} "
         f"to {text(at('m2_rad', g), 2)} rad"),
        ("t_g: joint 2 at its upper limit", "force increases; then joint 1 rotates rapidly",
         f"force {text(force(g - 0.5, g).mean, 1)} to {text(force(g, g + 2.0).most, 1)} N; joint 1 "
         f"up to {text(over('m1_rad_per_s', g, run.end).magnitude, 2)} rad/s"),
        ("mean force free / while a limit is felt", "", f"{free:.1f} / {felt:.1f} N"),
    ]


def measure_excavator(run):
    over, at, t = run.over, run.at, run.t
    a, b, c, d, e = map(t, ("t_a", "t_b", "t_c", "t_d", "t_e"))

    def others(from_s, to_s):
        return largest(over(f"{name}_rad_per_s", from_s, to_s).magnitude
                       for name in ("boom", "stick", "bucket"))

    return [
        ("t_a: bucket at its upper limit, boom at its lower one",
         "a sudden increase in the velocity of the stick",
         f"stick {text(at('stick_rad_per_s', a - 0.05), 2)} rad/s before, "
         f"{text(over('stick_rad_per_s', a, a + 0.3).most, 2)} rad/s within 0.3 s; boom at "
         f"{text(at('boom_rad', a), 4)} rad"),
        ("t_b: arm fully extended", "the stick is at its lower limit",
         f"stick at least {text(over('stick_rad', b, b + 1.0).least, 5)} rad "
         f"(limit {run.limit('stick', 'lower')})"),
        ("t_c: swing at its lower limit", "other joints move freely",
         f"swing at least {text(over('swing_rad', c, d).least, 5)} rad "
         f"(limit {run.limit('swing', 'lower')}); other joints up to {text(others(c, c + 1.0), 2)} "
         "rad/s"),
        ("t_d: swing at its upper limit", "other joints move freely",
         f"swing at most {text(over('swing_rad', d, d + 2.0).most, 5)} rad "
         f"(limit {run.limit('swing', 'upper')}); other joints up to {text(others(d, d + 1.0), 2)} "
         "rad/s"),
        ("t_e: digging and unloading", "a typical motion of the bucket",
         f"bucket from {text(over('bucket_rad', e, run.end).most, 2)} to "
         f"{text(over('bucket_rad', e, run.end).least, 2)} rad, boom up to "
         f"{text(over('boom_rad', e, run.end).most, 2)} rad"),
        ("largest force of the hand", "", f"{text(over('force_N', 0.0, run.end).most, 1)} N"),
    ]


def measure_door(run):
    over, at, t = run.over, run.at, run.t
    a, b, c, d, e = map(t, ("locked", "handle pressed", "unlocked", "open stop", "velocity limit"))
    again = t("locked again")
    slowest = -next(dof["speed_max"] for dof in run["twin"] if dof["name"] == "hinge")
    phases = [f"{phase['from_s']:.2f} .. {phase['to_s']:.2f} s" for phase in run.locked()]

    def held(from_s, to_s):
        return (f"hinge moves by {text(1e3 * over('hinge_rad', from_s, to_s).magnitude, 3)} mrad "
                f"under up to {text(over('force_N', from_s, to_s).most, 1)} N")

    return [
        ("t_a: pushed and pulled, not pressed", "no movement", held(a, b)),
        ("t_b: pressed, but pulled", "the door does not open", held(b, again)),
        ("t_c: leaned against, pressed", "the door pops open",
         f"force {text(at('force_N', c - 0.1), 1)} N before, hinge at "
         f"{text(at('hinge_rad_per_s', c + 0.3), 2)} rad/s 0.3 s later"),
        ("t_d: fully open", "then released",
         f"hinge at most {text(over('hinge_rad', 0.0, run.end).most, 4)} rad "
         f"(limit {run.limit('hinge', 'upper')})"),
        ("t_e: slams shut", "at the configured velocity limit",
         f"fastest {text(over('hinge_rad_per_s', d, run.end).least, 4)} rad/s "
         f"(limit {slowest:g}), from {text(e, 2)} s on"),
        ("locked", "shaded in Fig. 9", ", ".join(phases) or "never"),
    ]


def measure_walk_through(run):
    """The task of section VII-D: whether the person passes, and how near to leaf and frame."""
    over, t = run.over, run.t
    person, breadth = run.person(), run["person"]["half_breadth_m"]
    if person is None:
        run.failures.append("the person has not begun")
        return []
    time, y = person["time_s"], person["y_m"]
    past, let_go = time[y > 0.0], time[person["hold"] < 1.0]
    near = {name: person[f"to_{name}_m"] for name in ("leaf", "frame")}
    if not len(past) or y[-1] < breadth or min(values[-1] for values in near.values()) < breadth:
        run.failures.append("the person has not walked through")
    for name, values in near.items():
        if values.min() < breadth:
            run.failures.append(f"the body came within {values.min():.2f} m of the {name}, expected "
                                f"at least {breadth:.2f} m")
    passed, left = (times[0] if len(times) else math.nan for times in (past, let_go))
    released = person["hold"] < 1.0
    beyond = np.hypot(person["x_m"], y)[released] - run["person"]["leaf_width_m"]
    return [
        ("opened", "as if it were a normal door handle",
         f"at {text(t('opened'), 2)} s, {text(t('opened') - t('handle pressed'), 2)} s after the lever "
         f"is down; at most {text(over('hinge_rad', 0.0, run.end).most, 2)} rad (limit "
         f"{run.limit('hinge', 'upper')})"),
        ("walked through", "20 people, three times each",
         f"the body passes the plane of the shut leaf at {text(passed, 2)} s and ends "
         f"{text(y[-1], 2)} m behind it"),
        ("middle of the body to leaf / frame", "",
         f"at least {near['leaf'].min():.2f} / {near['frame'].min():.2f} m (half a breadth: "
         f"{breadth:.2f} m)"),
        ("let go", "", f"at {text(left, 2)} s, "
         + (f"{beyond.min():.2f} m beyond the reach of the leaf" if len(beyond) else "-")),
        ("shut again", "", f"at {text(t('shut again'), 2)} s"),
        ("force, mean while held / largest", "",
         f"{text(over('force_N', run['grasp_s'] + 0.8, left).mean, 1)} / "
         f"{text(over('force_N', 0.0, run.end).most, 1)} N")]


def measure_path(run):
    """Closest approach to every checkpoint, and the way between the first and the last."""
    x, y, azimuth = (run.columns[f"hand_{name}"] for name in ("x_m", "y_m", "azimuth_rad"))
    statements, last_s = [], 0.0
    places = np.array([event["all_of"][0]["place"] for event in run["events"]])
    for number, (event, place) in enumerate(zip(run["events"], places)):
        following = run["events"][number + 1:number + 2]
        to_s = following[0]["time_s"] if following else None
        rows = run.rows(last_s, run.end if to_s is None else to_s)
        distance = angle = time_s = math.nan
        if event["time_s"] is not None and rows.start < rows.stop:
            away = np.hypot(x[rows] - place[0], y[rows] - place[1])
            row = rows.start + int(away.argmin())
            distance, time_s = away.min(), run.time[row]
            angle = abs(math.remainder(azimuth[row] - place[2], 2.0 * math.pi))
        last_s = last_s if event["time_s"] is None else event["time_s"]
        statements.append((event["name"], "reached (marked on the ground)",
                           f"within {text(100.0 * distance, 1)} cm and "
                           f"{text(math.degrees(angle), 1)} degrees at {text(time_s, 1)} s"))
        if distance > PATH_REACHED_M:
            run.failures.append(f"{event['name']} was passed at {100.0 * distance:.1f} cm, expected "
                                f"within {100.0 * PATH_REACHED_M:.0f} cm")
    from_s, to_s = run.t(run["events"][0]["name"]), run.t(run["events"][-1]["name"])
    length = math.nan
    if from_s < to_s:
        rows = run.rows(from_s, to_s)
        length = np.hypot(np.diff(x[rows]), np.diff(y[rows])).sum()
    straight = np.hypot(*np.diff(places[:, :2], axis=0).T).sum()
    free, felt, most, share = limit_forces(run)
    return statements + [
        ("from the first to the last", "",
         f"{text(to_s - from_s, 1)} s, {text(length, 2)} m, {text(length / straight, 3)} times the "
         "straight lines"),
        ("at limits", "participants have to adapt to the Cartesian limits",
         f"{100.0 * share:.0f} % of the time; mean force {felt:.1f} N, at most {most:.1f} N (free: "
         f"mean {free:.1f} N)")]


MEASURES = {"cartesian": measure_cartesian, "excavator": measure_excavator, "door": measure_door,
            "walk_through": measure_walk_through, "path": measure_path}


def event_rows(runs):
    def expected(event):
        window = event.get("expected")
        return f"{window['from_s']:.1f} .. {window['to_s']:.1f} s" if window else "in this order"

    def found(event):
        if event["found_s"] is None:
            return "MISSING"
        return f"{event['found_s']:.3f} s" + ("" if event["is_as_expected"] else ", NOT THERE")

    return [["event", "condition", "expected"] + [f"found, law {run.law}" for run in runs]] + [
        [event["label"], event["condition"], expected(event)]
        + [found(run.events[number]) for run in runs]
        for number, event in enumerate(runs[0].events)]


def statement_rows(runs):
    return [["", "paper (real machine)"] + [f"simulated, law {run.law}" for run in runs]] + [
        [what, paper or "-"] + [run.statements[number][2] for run in runs]
        for number, (what, paper, _) in enumerate(runs[0].statements)]


def worst_text(limits):
    """The limit that was exceeded most: "elbow x by 0.12 mm"."""
    name, limit = max(limits.items(), key=lambda item: item[1]["worst_violation"])
    if limit["worst_violation"] <= 0.0:
        return "none"
    return f"{name} by {1e3 * limit['worst_violation']:.3f} m{limit['unit']}"


def figure_rows(runs):
    def column(run):
        summary, force = run.summary, run.summary["force"]
        status = summary["solver"]["status"]
        unsolved = sum(count for name, count in status.items() if name not in ("solved", "not run"))
        return [f"law {run.law}", worst_text(summary["limits"]),
                worst_text(summary["reality"]["limits"]) if "reality" in summary else "-",
                f"{force['mean_N']:.1f} / {force['max_N']:.1f} N",
                f"{summary['solver']['active_set_changes_per_second']:.1f}",
                f"{status.get('solved', 0)} / {unsolved}"]

    heads = ["", "limits exceeded by the reference (allowed: 2 mm, 5 mrad)",
             "limits exceeded in truth (allowed: 1 mm, 2 mrad)", "user's force, mean / largest",
             "active-set changes per second", "problems solved / not"]
    return [list(row) for row in zip(heads, *map(column, runs))]


def verdicts(runs):
    for run in runs:
        if not run.failures:
            yield True, (f"{run.name().capitalize()}: all {len(run.events)} events as expected, limits "
                         "held.")
        yield from ((False, f"{run.name().capitalize()}: {failure}") for failure in run.failures)


def say(run):
    print(run.name())
    for event in run.events:
        if event["found_s"] is not None:
            print(f"{event['found_s']:9.3f} s  {event['name']:<18} {event['what']}")
    for failure in run.failures:
        print(f"  NOT AS EXPECTED: {failure}")
    if not run.failures:
        print(f"  as expected: {len(run.events)} events, limits held")


def write_data(run):
    """events.json, results.json and signals.csv of one run."""
    events = {key: run.summary[key] for key in ("scenario", "law", "bounds", "seed")}
    events = {"experiment": run["kind"]} | events | {"events": run.events}
    statements = [{"what": what, "paper_real_machine": paper, "ours_simulated": ours}
                  for what, paper, ours in run.statements]
    results = {"experiment": run["kind"], "source": run["source"],
               "is_as_expected": not run.failures, "failures": run.failures,
               "statements": statements, "summary": run.summary}
    for name, facts in (("events.json", events), ("results.json", results)):
        pages.save(run.folder / name, json.dumps(facts, indent=2) + "\n")
    run.save_csv()


def parts(runs):
    """What is shown of runs of one kind: titles, rows of tables and a note."""
    kind = runs[0]["kind"]
    before = "Walking through the door: " if kind == "walk_through" else ""
    titles = [f"{before}{title[0].lower()}{title[1:]}" if before else title
              for title in ("Events", "Beside the paper", "The run as a whole")]
    files = [f"{kind}_{file}" if before else file for file in ("events", "paper", "run")]
    rows = (event_rows(runs), statement_rows(runs), figure_rows(runs))
    return [{"title": title, "file": file, "rows": table, "note": note} for title, file, table, note
            in zip(titles, files, rows, ("", COMMENT.get(kind, ""), ""))]


def write(results, folder, docs=None):
    """Writes the report on runs of one experiment; returns 0, 1 not as expected, 3 a fault."""
    runs = [Measured(pathlib.Path(run_folder)) for run_folder in results["runs"]]
    for run in runs:
        write_data(run)
        say(run)
    first = runs[0]
    kind, command = first["kind"], first["command"]
    groups = [[run for run in runs if run["kind"] == kind], [run for run in runs if run["kind"] != kind]]
    sections = [part for group in groups if group for part in parts(group)]
    drawn = [run.figure() for run in runs]
    svg = pages.draw(folder, lambda figure: figures.draw_runs(figure, drawn))
    note = first.note(with_law=len(groups[0]) == 1)
    caption = (f"{first['title']}, as {first['source']} of the paper, from a simulated machine. Events "
               "are marked, limits are dotted"
               + (", shaded while the door is locked. (d) to (f): walking through, from above every "
                  "second." if kind == "door" else "."))
    pages.save(folder / "report.html", pages.render(
        "page.html.jinja", title=first["title"], source=f"{first['source']} of the paper; {note}",
        about=ABOUT[kind], verdicts=list(verdicts(runs)), figure=svg, caption=caption,
        sections=sections, version=first["version"], command=command,
        files="recording.mcap, events.json, results.json, signals.csv, figure.svg, figure.png; times "
        "of computation in timing.json"))
    if docs:
        page = docs / f"{kind}.md"
        table = pages.PageTables(page)
        shown = {"paper": {"most": 8}}  # all other tables are files
        text_of = {"paper": "The paper's column comes from a real machine, ours from a simulated one.\n\n"}
        pages.refresh(page, f"`{command}`; {note}.\n\n" + "\n".join(
            f"### {part['title']}\n\n" + text_of.get(part["file"], "")
            + table(part["rows"], part["file"], **shown.get(part["file"], {"most": 0}))
            for part in sections), (folder / "figure.svg").read_text(encoding="utf-8"))
    if any(run.has_fault() for run in runs):
        return 3
    return 1 if any(run.failures for run in runs) else 0
