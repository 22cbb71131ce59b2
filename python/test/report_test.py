"""Pictures whose legends and labels lie over nothing, whatever the names.

Usage: report_test.py   (from anywhere; needs scipy, matplotlib and jinja2, no compiled part)
"""

import colorsys
import contextlib
import io
import pathlib
import unittest

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from hapticgiant import figures
from hapticgiant.report import haptify, pictures

JOINTS = [f"left_shoulder_elevation_{number}" for number in range(8)]  # 25 characters


def tick_labels_outside(figure):
    """Labels of ticks that matplotlib keeps but does not draw."""
    hidden = set()
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            low, high = sorted(axis.get_view_interval())
            drawn = {label for tick in axis._update_ticks() for label in (tick.label1, tick.label2)
                     if axis.get_visible()}
            for tick in [*axis.majorTicks, *axis.minorTicks]:
                for label in (tick.label1, tick.label2):
                    if label not in drawn or not low <= tick.get_loc() <= high:
                        hidden.add(label)
    return hidden


def said(write, *arguments, **options):
    """What a writer of reports returns, and what it prints."""
    with contextlib.redirect_stdout(io.StringIO()) as text:
        result = write(*arguments, **options)
    return result, text.getvalue()


def overlapping(figure):
    """Pairs of texts that lie over each other, and legends that lie over curves."""
    FigureCanvasAgg(figure)
    figure.canvas.draw()
    renderer = figure.canvas.get_renderer()
    hidden = tick_labels_outside(figure)
    boxes = [(text.get_text(), text.get_window_extent(renderer))
             for text in figure.findobj(matplotlib.text.Text)
             if text not in hidden and text.get_visible() and text.get_text().strip()]
    boxes = [(name, box) for name, box in boxes if min(box.width, box.height) > 1]
    found = []
    for number, (name, box) in enumerate(boxes):
        for other, other_box in boxes[:number]:
            width = min(box.x1, other_box.x1) - max(box.x0, other_box.x0)
            height = min(box.y1, other_box.y1) - max(box.y0, other_box.y0)
            if min(width, height) > 1.0:
                found.append((other, name))
    for axes in figure.axes:
        legend = axes.get_legend()
        if legend is None:
            continue
        box = legend.get_window_extent(renderer)
        for line in axes.get_lines():
            if line.get_transform() != axes.transData:
                continue
            points = axes.transData.transform(line.get_xydata())
            if any(box.contains(*point) for point in points):
                found.append(("legend", line.get_label()))
        inside = axes.get_window_extent(renderer)
        if box.width > inside.width + 2 and box.y0 < inside.y1:
            found.append(("legend", "wider than its panel"))
    return found


def run_of(names, kind="any", note=""):
    """A run of a device with these joints, with events close to each other."""
    time = np.linspace(0.0, 10.0, 200)
    columns = {"time_s": time, "force_N": 5 + np.sin(time), "torque_Nm": 1 + np.cos(time),
               "running": np.ones_like(time), "hand_x_m": np.sin(time), "hand_y_m": np.cos(time),
               "elbow_x_m": 0.5 * np.sin(time), "elbow_y_m": 0.5 * np.cos(time)}
    joints = []
    for number, name in enumerate(names):
        column = f"{name}_rad"
        columns[column] = (1 + number) * np.sin(time + number)
        columns[f"{name}_Nm"] = np.cos(time + number)
        columns[f"{name}_rad_per_s"] = np.cos(time)
        joints.append({"name": name, "column": column, "unit": "rad", "lower": -3.0, "upper": 9.0,
                       "torque_column": f"{name}_Nm", "torque_unit": "Nm",
                       "speed_column": f"{name}_rad_per_s", "speed_max": 2.0})
    events = [{"label": f"t_{letter}", "time_s": time_s, "what": "", "points": None}
              for letter, time_s in (("a", 2.0), ("b", 2.1), ("c", 6.0))]
    facts = {"kind": kind, "note": note, "events": events, "locked": [], "manipulator": joints,
             "virtual": joints[:1], "gantry": [], "twin": joints, "has_elbow": True, "poses": [],
             "checkpoints": [], "person": None, "box": {"x": [-2, 2], "y": [-2, 2]}}
    return figures.Run(facts, columns)


class Figures(unittest.TestCase):
    def check_runs(self, runs):
        with matplotlib.rc_context(figures.SETTINGS):
            figure = Figure(dpi=100)
            FigureCanvasAgg(figure)
            figures.draw_runs(figure, runs)
            self.assertEqual(overlapping(figure), [])

    def test_short_names(self):
        self.check_runs([run_of([f"m{number}" for number in range(1, 8)])])

    def test_eight_joints_with_long_names(self):
        self.assertEqual(len(JOINTS[0]), 25)
        self.check_runs([run_of(JOINTS)])

    def test_several_runs_of_every_kind(self):
        for kind in figures.KINDS:
            for names in (JOINTS[:4], [f"m{number}" for number in range(1, 8)]):
                with self.subTest(kind=kind, names=names):
                    self.check_runs([run_of(names, kind, f"run {number} of a long name")
                                     for number in range(4 if kind == "any" else 2)])

    def test_runs_differ_by_colour_and_their_curves_by_shade(self):
        names, runs = ["m1", "m2", "m3"], [run_of(["m1", "m2", "m3"], note=note) for note in ("one", "two")]
        panel, alone = (FigureCanvasAgg(Figure()).figure.add_subplot() for _ in range(2))
        figures.draw_signals(panel, runs, runs[0].facts["manipulator"], "rad")
        hls = [colorsys.rgb_to_hls(*matplotlib.colors.to_rgb(line.get_color())) for line in panel.get_lines()[:6]]
        for run in (hls[:3], hls[3:]):
            self.assertLess(np.ptp([hue for hue, _, _ in run]), 0.03)
            self.assertGreater(np.diff([lightness for _, lightness, _ in run]).min(), 0.05)
        self.assertGreater(abs(hls[0][0] - hls[3][0]), 0.2)
        figures.draw_signals(alone, runs[:1], runs[0].facts["manipulator"], "rad")
        self.assertEqual([line.get_color() for line in alone.get_lines()[:3]], list(figures.COLOURS[:len(names)]))

    def test_computing_times(self):
        edges = list(np.geomspace(5.0, 500.0, 30))
        series = [{"name": f"law {law}, {rate} kHz", "from_us": edges,
                   "share_percent": list(np.geomspace(50.0, 1e-3, 30))}
                  for rate in (1, 2, 5, 10) for law in ("gauss", "paper")]
        with matplotlib.rc_context(figures.SETTINGS):
            figure = Figure(dpi=100)
            FigureCanvasAgg(figure)
            figures.timing(figure, {"has_two_laws": True, "series": series,
                                    "paper_us": {"mean": 529.0, "99.9 %": 616.0, "maximum": 707.0}})
            self.assertEqual(overlapping(figure), [])

    def test_an_overlap_is_found(self):
        figure = Figure(dpi=100)
        panel = figure.subplots()
        panel.plot([0, 1], [0, 1], label="a")
        panel.text(0.5, 0.5, "one text")
        panel.text(0.51, 0.5, "another")
        panel.legend(loc="upper right")
        self.assertEqual(overlapping(figure), [("one text", "another"), ("legend", "a")])


def figure_of(name, value, **more):
    return {"id": name, "name": name, "unit": "N", "digits": 2, "mean": value, "half_width_95": 0.1,
            "values": [value, value], "measured": f"{value} +- 0.1", "paper": 1.0, "touch": None,
            "touch_x": None, "goal": "<= 1", "goal_min": None, "goal_max": 1.0, "met": "no",
            "note": "a note", "why": "a reason", **more}


def curve(name, label, columns):
    x = np.geomspace(0.1, 50.0, 12) if name != "free_space" else np.arange(20.0, 500.0, 2.0)
    return {"id": name, "name": label, "x_label": "", "x": list(x),
            "y": {column: list(1.0 + 0.5 * np.sin(x / 9.0 + number))
                  for number, column in enumerate(columns)}}


def results():
    """A benchmark with everything, and long names."""
    verdicts = ["stable", "hunts", "sustained", "diverges"]
    tables = {
        "workspace_shape": (["axis", "reached", "edge m"], [["x", "-1 .. 1 m", "2"]]),
        "z_width": (["body", "N/m", "Hz", "0 Ns/m", "20 Ns/m", "100 Ns/m", "400 Ns/m"],
                    [[body, str(k), "1.0", *verdicts]
                     for body in ("6 kg, 4 Ns/m", "3 kg, 2 Ns/m", "3 kg, 2 Ns/m, prompt")
                     for k in (1000, 4000, 8000, 16000, 32000, 50000)]),
        "rotation": (["hand", *(f"{0.001 * 3 ** n:.3f}" for n in range(10))],
                     [[hand, *(verdicts * 3)[:10]] for hand in ("relaxed", "normal", "stiff")]),
        "impacts": (["hand", "kg"], [["normal", kg] for kg in ("0.5", "3", "6", "20")]),
        "felt_mass": (["N"], [[str(n)] for n in (10, 20, 40, 60)]),
        "springs": (["Nm/rad", "let go at mm"],
                    [[k, mm] for k in ("50", "500", "2000") for mm in ("2", "20")]),
        "transparency": (["axis"], []), "force_response": (["axis"], []),
        "vibration_sources": ([""], []),
    }
    points = {
        "impacts": [{"mass": kg, "speed": 0.5, "impact_depth": 0.9, "impact_rebound": 0.05,
                     "impact_rest": None} for kg in (0.5, 3.0, 6.0, 20.0)],
        "felt_mass": [{"force": n, "x": 6.0, "y": 6.5, "z": 7.0} for n in (10, 20, 40)]
        + [{"force": 60}],
        "springs": [{"ideal_Hz": 1.0, "frequency_Hz": 0.9, "ideal_damping": 0.1,
                     "damping_ratio": -0.05}] * 6}
    transparency = ["ratio", "phase_deg", "following", "following_phase_deg"]
    force = ["rendered", "rendered_phase_deg", "ideal", "ideal_phase_deg"]
    return haptify.Results({
        "kind": "haptify", "version": "1", "command": "hapticgiant haptify --seed 1",
        "device": "Device & <more>", "seed": 1, "repetitions": 2, "is_quick": False,
        "real_and_simulated": "ours is simulated", "failures": ["one thing"],
        "table": [figure_of("free_space_force", 1.25)],
        "beyond": [figure_of("latency", 3.5, met="-", goal="-")],
        "tables": [{"id": name, "title": name, "note": "a note", "columns": columns, "rows": rows,
                    "points": points.get(name, [])}
                   for name, (columns, rows) in tables.items()],
        "curves": [curve("transparency", axis, transparency) for axis in "xyz"]
        + [curve("force_response", axis, force) for axis in "xyz"]
        + [curve("free_space", name, ["m"]) for name in ("body of 6 kg", "body of 3 kg")]
        + [curve("vibration_sources", f"without {name}", ["m"]) for name in JOINTS + ["friction"]],
        "workspace": [{"across": a, "up": b, "left": -1.6, "bottom": -1.0, "cell": 0.05,
                       "rows": [[1] * 60] * (40 if b == 1 else 15), "box": [-1.6, 1.4, -1, 1]}
                      for a, b in ((0, 1), (0, 2), (1, 2))]})


class Report(unittest.TestCase):
    def test_pictures_have_no_overlaps(self):
        with matplotlib.rc_context(figures.SETTINGS):
            drawn = pictures.figures_of(results())
            self.assertEqual(len(drawn), 11)
            for name, figure in drawn.items():
                self.assertEqual(overlapping(figure), [], name)

    def test_pictures_show_the_numbers_of_their_tables(self):
        with matplotlib.rc_context(figures.SETTINGS):
            drawn = pictures.figures_of(results())
        lines = {name: drawn[name].axes[0].get_lines()
                 for name in ("felt_mass", "impacts", "springs")}
        np.testing.assert_equal(lines["felt_mass"][1].get_xydata(),
                                [[10, 6.5], [20, 6.5], [40, 6.5], [60, np.nan]])
        np.testing.assert_allclose(lines["impacts"][1].get_xydata(), [[0.5 * 0.99, 0.9]])
        self.assertEqual(lines["impacts"][1].get_label(), "3 kg")
        self.assertEqual(list(lines["springs"][1].get_xdata()), [0.9] * 6)

    def test_the_page_is_whole_and_repeats(self):
        page = haptify.html(results())
        self.assertEqual(page, haptify.html(results()))
        self.assertEqual(page.count("<svg"), 11)
        self.assertIn("Device &amp; &lt;more&gt;", page)
        self.assertIn("at a glance", page)
        for outside in ("<script", "<link", "src="):
            self.assertNotIn(outside, page)

    def test_what_was_not_measured_leaves_no_picture(self):
        empty = results()
        empty.facts.update(tables=[], curves=[], workspace=[])
        self.assertEqual(haptify.html(empty).count("<svg"), 1)  # the first page's, empty


if __name__ == "__main__":
    unittest.main()
