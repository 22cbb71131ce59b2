"""The report of `hapticgiant haptify` and of `hapticgiant haptify --goals`."""

import json

from . import benchmark, goals, pictures, tables
from .pages import PageTables, in_text, refresh, render, save, stamp, with_numbers

METHOD = (
    "Instruments: Haptify has a force plate, motion capture and an instrumented handle; here the "
    "true motion of the handle and the true wrench of the hand are read from the simulation, "
    "without an error of their own. What the device's own sensors get wrong is in the figures: it "
    "is controlled with them.",
    "Person: Haptify's user holds and leads the handle by hand; here a scripted hand of "
    "docs/concepts/person.md (arm, grip, tremor) does.",
    "Corner frequencies, speeds and durations of Haptify's protocol are not in the paper: vibration "
    "counts above 20 Hz, and speeds are ours. Forces of free motion depend on them, because a "
    "rendered body is led.",
    "Haptify takes an alpha shape of the positions that a user's hand explored; here postures are "
    "drawn at random with the real kinematics, and the volume is that of the voxels with a position "
    "in them (those at the edge count half). The control loop does not run.",
    "Free motion is that of a rendered free body, which a device under admittance control cannot do "
    "without; Touch and Touch X under impedance control are only switched off.",
)
# the most important figures, for the first page: identifier and a short name
KEY_FIGURES = (
    ("workspace_volume", "workspace"), ("free_space_force", "force in free space"),
    ("free_space_extra", "of it, added by the device"), ("free_space_vibration", "vibration"),
    ("frictionless_surface", "force on a smooth surface"),
    ("stiffness_accuracy", "stiffness accuracy"), ("stiffness_peak_force", "peak force"),
    ("transparency_bandwidth", "transparent up to"), ("latency", "latency"),
    ("z_width", "stiffest calm surface"), ("felt_mass_20", "felt mass under 20 N"),
    ("impact_depth", "impact depth over allowed"),
)


class Results:
    """The content of figures.json, with what all forms of the report say."""

    def __init__(self, facts):
        self.facts = facts
        self.figures = {figure["id"]: figure for figure in facts["table"] + facts["beyond"]}

    def __getitem__(self, name):
        return self.facts[name]

    def command_line(self):
        line = f"`{self['command']}`, simulated {self['device']}."
        return f"{line} {self.place()}".rstrip()

    def place(self):
        """Where another device than the reference device was measured; otherwise empty."""
        return self.facts.get("place", "")

    def main_rows(self):
        head = ["", "unit", "ours, simulated", "HapticGiant, paper, real", "Touch, real",
                "Touch X, real", "goal", "met"]
        return [head] + [[it["name"], it["unit"], it["measured"], *map(given, others(it)), it["goal"],
                          it["met"]] for it in self["table"]]

    def beyond_rows(self):
        return [["", "unit", "ours, simulated", "conditions"]] + [
            [it["name"], it["unit"], it["measured"], it["note"]] for it in self["beyond"]]

    def missed(self):
        """A sentence or more per figure of Table III that was measured and misses its goal."""
        return [f"{it['name']}: {it['measured']} instead of {it['goal']} {it['unit']}. "
                + (it["why"] or "The reason is not known.")
                for it in self["table"] if it["values"] and it["met"] == "no"]

    def method_rows(self):
        return [[it["name"], it["note"]] for it in self["table"] if it["note"]] + [["", line] for line in METHOD]

    def method(self):
        return [f"{about}: {how}." if about else how for about, how in self.method_rows()]

    def key_figures(self):
        return [(name, self.figures[key]) for key, name in KEY_FIGURES
                if key in self.figures and self.figures[key]["mean"] is not None]


def others(figure):
    return figure["paper"], figure["touch"], figure["touch_x"]


def given(value):
    return "-" if value is None else f"{value:g}"


def rows_of(table):
    return [table["columns"], *table["rows"]]


def failures(results, form):
    failed = [failure.partition(": ")[::2] for failure in results["failures"]]
    table = form([["failed", "why"], *failed], "failures", most=0) + "\n" if failed else ""
    return table + "".join(f"Not possible: {what}.\n\n" for what in results["impossible"])


def markdown(results, form=in_text):
    """Without a title; `form` writes tables."""
    parts = [f"{results.command_line()}\n\n**{results['real_and_simulated']}**\n\n",
             failures(results, form), tables.markdown(results.main_rows()),
             "\nMean and half width of the 95 % confidence interval.\n",
             "\n## Goals that are missed\n\n",
             "".join(f"- {sentence}\n" for sentence in results.missed()) or "None.\n",
             "\n## Beyond the paper\n\n", form(results.beyond_rows(), "beyond", most=0)]
    for table in results["tables"]:
        parts.append(f"\n## {table['title']}\n\n{table['note']}\n\n"
                     + form(rows_of(table), table["id"], most=0))
    parts.append("\n## How it is measured, and what differs from the real protocol\n\n")
    if form is in_text:
        parts += [f"- {sentence}\n" for sentence in results.method()]
    else:
        parts.append(form([["about", "how"], *results.method_rows()], "method", most=0))
    return "".join(parts)


def goals_markdown(results, form=in_text):
    return (f"{results.command_line()}\n\n{failures(results, form)}"
            + form(rows_of(results["tables"][0]), "figures"))


def latex(results):
    """Table III with our column: a tabular for the package booktabs."""
    units = {"m^3": "m$^3$", "m/s^2": "m\\,s$^{-2}$", "%": "\\%"}

    def value(text):
        return text if text in ("-", "not measured") else f"${text.replace('+-', chr(92) + 'pm')}$"

    rows = [" & ".join([it["name"], units.get(it["unit"], it["unit"]), value(it["measured"]),
                        *(value(given(other)) for other in others(it))]) + " \\\\\n"
            for it in results["table"]]
    return (f"% {results['real_and_simulated']}\n% needs the package booktabs\n"
            "\\begin{tabular}{llrrrr}\n\\toprule\n"
            "Metric & Unit & Ours (simulated) & HapticGiant (real) & Touch (real) & Touch X (real) "
            "\\\\\n\\midrule\n" + "".join(rows) + "\\bottomrule\n\\end{tabular}\n")


def figures_csv(results):
    rows = [["id", "name", "unit", "mean", "half_width_95", "repetitions", "paper", "touch",
             "touch_x", "goal_min", "goal_max"]]
    for it in results["table"] + results["beyond"]:
        rows.append([it["id"], it["name"], it["unit"], tables.number(it["mean"]),
                     tables.number(it["half_width_95"]), str(len(it["values"])),
                     *map(tables.number, others(it)), tables.number(it["goal_min"]),
                     tables.number(it["goal_max"])])
    return tables.as_csv(rows)


def repetitions_csv(results):
    rows = [["id", "unit", "repetition", "value"]]
    for it in results["table"] + results["beyond"]:
        rows += [[it["id"], it["unit"], str(number), tables.number(value)]
                 for number, value in enumerate(it["values"], 1)]
    return tables.as_csv(rows)


def html(results):
    """One self-contained page, at a glance first."""
    drawn = pictures.draw_all(results)
    sections = []
    for table in results["tables"]:
        sections.append({"title": table["title"], "note": table["note"], "rows": rows_of(table),
                         "picture": drawn.pop(table["id"], "")})
    return render("haptify.html.jinja", results=results, glance=drawn.pop("glance", ""),
                  spectra=drawn.pop("free_space", ""), sections=sections)


def failures_text(results):
    return ("".join(f"\nFAILED  {failure}\n" for failure in results["failures"])
            + "".join(f"\nNot possible: {what}\n" for what in results["impossible"])
            + (f"\n{results.place()}\n" if results.place() else ""))


def goals_text(results):
    """For a terminal."""
    lines = [f"{name:<38}{unit:<7}{goal:>10}{median:>9}{least:>9}{largest:>9}{met:>14}\n"
             for name, unit, goal, median, least, largest, met, _ in rows_of(results["tables"][0])]
    return "".join(lines) + f"\n{results['real_and_simulated']}\n" + failures_text(results)


def haptify_text(results):
    """For a terminal: both tables of figures, missed goals, failures."""
    head, *rows = results.main_rows()
    head[1:6] = "", head[2], "paper", "Touch", "Touch X"
    lines = [f"{name:<40}{unit:<7}{ours:>18}{paper:>9}{touch:>9}{touch_x:>9}{goal:>12}{met:>5}\n"
             for name, unit, ours, paper, touch, touch_x, goal, met in [head, *rows]]
    lines.append("\n")
    lines += [f"{it['name']:<60}{it['measured']:>18} {it['unit']}\n" for it in results["beyond"]]
    lines.append(f"\n{results['real_and_simulated']}\n")
    lines += [f"\n{sentence}\n" for sentence in results.missed()]
    return "".join(lines) + failures_text(results)


def write(results, folder, docs=None):
    """Writes the report into `folder` and into the pages of `docs`; returns 1 where a run has failed."""
    measured = with_numbers(results)
    name = measured["kind"]
    results = Results((goals if name == "goals" else benchmark).figures(measured))
    save(folder / "figures.json", json.dumps(results.facts, allow_nan=False) + "\n")
    if name == "goals":
        text = goals_markdown(results)
        shown = goals_text(results)
        save(folder / "goals.md", f"# Goals: {results['device']}\n\n{text}\n{stamp()}\n")
        save(folder / "goals_runs.csv", repetitions_csv(results))
    else:
        text = markdown(results)
        shown = haptify_text(results)
        save(folder / "report.html", html(results))
        save(folder / "report.md", f"# Haptify: {results['device']}\n\n{text}\n{stamp()}\n")
        save(folder / "table.tex", latex(results))
        save(folder / "haptify.csv", figures_csv(results))
        save(folder / "repetitions.csv", repetitions_csv(results))
    save(folder / "report.txt", shown)
    print(shown, end="")
    for table in results["tables"]:
        save(folder / f"{table['id']}.csv", tables.as_csv(rows_of(table)))
    if docs:
        page = docs / f"{name}.md"
        write_text = goals_markdown if name == "goals" else markdown
        refresh(page, write_text(results, PageTables(page)))
    return 1 if results["failures"] else 0
