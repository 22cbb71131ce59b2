"""`hapticgiant study report`: HTML, LaTeX, and the analysis that made them, beside the data."""

from __future__ import annotations

import dataclasses
import pathlib
import re

import matplotlib
import numpy as np
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from hapticgiant.figures import COLOURS, SETTINGS
from hapticgiant.report import pages, pictures
from hapticgiant.study import analysis, planning, trials
from hapticgiant.study.description import Study
from hapticgiant.study.folder import Folder, FolderError

HERE = pathlib.Path(__file__).resolve().parent
SIMULATED = "THE PEOPLE OF THIS STUDY ARE SIMULATED: nothing here says anything about people."
REAL = "The people of this study took part in person."
BOXES = ("Means of people: a dot is one person; median, quartiles, whiskers to the last value within 1.5 times their "
         "distance.")
MEANINGS = {"nasa_tlx": "NASA TLX: 0 is the lowest workload; of performance, 0 is perfect and 100 failure.",
            "sus": "SUS: 100 is the best."}
WIDE, NARROW = 7.2, 1.75  # inches
LONGEST_TICK = 18  # letters


def write(folder: Folder) -> list[pathlib.Path]:
    """Writes the report into the folder; its files. A study may run meanwhile: the report has what was done when it
    began. Raises FolderError, and writes nothing, where somebody has been forgotten since it began."""
    study, description = folder.study, folder.description()
    folder.require({**description, "Study": study.digest()})
    if not folder.participants():
        raise FolderError(f"{folder.path}: nobody has taken part yet")
    people = SIMULATED if description["Simulated"] else REAL
    with folder.writing_tables():
        withdrawn = folder.withdrawn()
        folder.tabulate()
        folder.replace(folder.path / "code" / "plan.json", trials.dump({
            "people": people, "title": study.title, "conditions": list(study.conditions), "alpha": study.alpha,
            "correction": study.correction, "outcomes": study.outcomes, "participants": study.design.participants,
            "tests": [{"outcome": test.outcome, "test": test.test} for test in study.tests]}))
        for name in ("analysis.py", "inference.py"):
            folder.replace(folder.path / "code" / name, (HERE / name).read_text(encoding="utf-8"))
        data = analysis.Data(folder.path)
    found = analysis.tests(data)
    kinds = sorted({test.test for test in study.tests})
    sections = [
        ("Participants", analysis.participant_rows(data), ""),
        ("Trials", analysis.trial_rows(data), "A trial without a value does not enter the tests of that measure: where one "
         "condition has more of them, its values are those of the trials that went well."),
        ("Planned tests", analysis.test_rows(data, found),
         "; ".join(f"{kind}: {planning.DESCRIBED[kind]}" for kind in kinds)
         + f". alpha = {study.alpha:g}. The last p is corrected for all planned tests."),
        ("Pairs of conditions", analysis.pair_rows(data, found),
         "Difference: of means, or for ranks the Hodges-Lehmann estimate. The interval is that of the row's test: without 0 "
         f"where its p is below {study.alpha:g}. Count: people; for signed ranks the pairs that differ, for two groups both. "
         f"The last p is corrected ({study.correction}) for the pairs of an outcome, the interval is not."),
        ("Assumptions and notes", analysis.assumption_rows(found), "They do not change the test."),
        ("Means of people", analysis.description_rows(data),
         "; ".join(f"{name}: {what}" for name, what in study.outcomes.items()) + "."),
        ("Left out", analysis.exclusion_rows(data), _exclusions(study, data))]
    sections = [each for each in sections if len(each[1]) > 1]
    counted = len(data.participants) - len(data.left_out)
    about = (f"{counted} of {len(data.participants) + data.withdrawn} participants count ({study.design.participants} were "
             f"planned, {data.withdrawn} withdrew); {len(study.conditions)} conditions {study.design.kind} people, order {study.design.order}, "
             f"{study.design.repetitions} trials of each. {description['Model']}")
    title = ("Simulated people: " if description["Simulated"] else "") + study.title
    page = pages.render(
        "page.html.jinja", title=title, source=people, about=about,
        verdicts=[(False, f"No test of {outcome}: {each}.") for outcome, each, _ in found if isinstance(each, str)],
        figures=figures_of(study, data), caption=BOXES,
        sections=[{"title": name, "rows": rows, "note": note} for name, rows, note in sections],
        version=description["GeneratedBy"][0]["Version"], command="python code/analysis.py",
        files="trials.csv, answers.csv, participants.csv, report.tex, code/")
    files = [folder.path / "report.html", folder.path / "report.tex", folder.path / "code" / "analysis.py"]
    text = latex(title, people, about, sections)
    with folder.writing_tables():
        if folder.withdrawn() != withdrawn:
            raise FolderError(f"{folder.path}: somebody has been forgotten meanwhile; nothing is written, the same "
                              "command makes the report without them")
        folder.replace(files[0], page)
        folder.replace(files[1], text)
        folder.hash()
    return files


def _exclusions(study, data):
    left = sum(1 for row in data.trials if row["excluded"])
    return (f"{len(data.left_out)} participants and {left} of {len(data.trials)} trials are left out. Planned: "
            + ("; ".join(f"{each.kind}, {each.expression}: {each.why}" for each in study.exclusions) or "nothing") + ".")


@dataclasses.dataclass(frozen=True)
class Scale:
    """Outcomes that are drawn in one figure, since they share a scale."""

    name: str
    outcomes: list[str]
    about: str
    ends: tuple[float, float] | None = None
    unit: str = ""


def scales_of(study: Study) -> list[Scale]:
    """The scales of a study: one of a published questionnaire, those of own items, one of each measure."""
    found = []
    for name, form in study.forms.items():
        if form.kind != "own":
            found.append(Scale(name, [f"{name}.{score}" for score in form.scores], MEANINGS[form.kind], (0, 100)))
            continue
        items: dict[tuple, list[str]] = {}
        for item in form.scores:
            each = form.items[item]
            ends = tuple(end.get("en") or next(iter(end.values()), "") for end in each.ends)
            items.setdefault((each.low, each.high, *ends), []).append(item)
        for (low, high, *ends), each in items.items():
            words = f"{low:g}{f' ({ends[0]})' if ends[0] else ''} to {high:g}{f' ({ends[1]})' if ends[1] else ''}"
            about = "; ".join((f"{item}: " if len(each) > 1 else "") + form.scores[item] for item in each)
            found.append(Scale(name, [f"{name}.{item}" for item in each], f"{about} {words}.", (low, high)))
    found += [Scale(name, [name], f"{measure.what[:1].upper()}{measure.what[1:]}.", unit=measure.unit)
              for name, measure in study.measures.items()]
    return found


def figures_of(study: Study, data: analysis.Data) -> list[dict]:
    """A figure for each scale that has values: its picture, what it shows, and whether it takes the whole width."""
    found = []
    for number, scale in enumerate(scales_of(study)):
        people = {outcome: values for outcome in scale.outcomes if (values := data.people(outcome))}
        if people:
            found.append({"picture": boxes(study, scale, people, f"boxes{number}"), "about": scale.about,
                          "is_wide": len(people) > 1})
    return found


def boxes(study: Study, scale: Scale, people: dict, identifier: str) -> str:
    """Box plots by condition of the outcomes of one scale, with a dot for each person."""
    conditions = list(study.conditions)
    colours = {name: COLOURS[i % len(COLOURS)] for i, name in enumerate(conditions)}
    with matplotlib.rc_context(SETTINGS):
        figure = pictures.new_figure(2.2, WIDE if len(people) > 1 else NARROW)
        panel = figure.add_subplot()
        for place, values in enumerate(people.values()):
            _place(panel, values, place, conditions, colours)
        if len(people) > 1:
            panel.set_xticks(range(len(people)), [outcome.partition(".")[2] for outcome in people])
            figure.legend(handles=[Patch(facecolor=colours[name], alpha=0.55, label=name) for name in conditions],
                          loc="outside lower center", ncols=len(conditions), frameon=False)
        else:
            (values,) = people.values()
            if "" in values:
                panel.set_xticks([0], ["all"])
            else:
                panel.set_xticks([_middle(i, conditions) for i in range(len(conditions))],
                                 [name[:LONGEST_TICK] for name in conditions], rotation=90 if len(conditions) > 3 else 0)
        panel.set_title(scale.name if len(people) > 1 else next(iter(people)))
        panel.set_ylabel(scale.unit)
        panel.grid(axis="x", visible=False)
        every = np.concatenate([each for values in people.values() for each in values.values()])
        if scale.ends or np.ptp(every) == 0:
            low, high = scale.ends or (every[0] - 1, every[0] + 1)
            panel.set_ylim(low - 0.04 * (high - low), high + 0.04 * (high - low))
        if np.array_equal(every, np.round(every)):
            panel.yaxis.set_major_locator(MaxNLocator(integer=True))
        panel.set_xlim(-0.45, len(people) - 0.55)
        return pictures.to_svg(figure, identifier)


def _middle(i, conditions):
    """Where the box of a condition stands, from the place of its outcome."""
    return (i - (len(conditions) - 1) / 2) * 0.7 / len(conditions)


def _place(panel, people, place, conditions, colours):
    width = 0.7 / len(conditions)
    for i, name in enumerate(conditions if "" not in people else [""]):
        values = people.get(name)
        at, colour = (place + _middle(i, conditions), colours[name]) if name else (place, "grey")
        if values is None:
            panel.annotate("no value", (at, 0.5), xycoords=("data", "axes fraction"), ha="center", va="center", rotation=90,
                           color="grey")
            continue
        drawn = panel.boxplot([values], positions=[at], widths=0.8 * width, patch_artist=True, manage_ticks=False,
                              showfliers=False, medianprops={"color": "black"})
        drawn["boxes"][0].set(facecolor=colour, alpha=0.55)
        spread = 0.25 * width * np.sin(2.4 * np.arange(len(values)))  # beside each other, the same every time
        panel.plot(at + spread, values, ".", color="black", markersize=2.5, alpha=0.6)


def _tex(text: str) -> str:
    special = {"\\": r"\textbackslash{}", "{": r"\{", "}": r"\}", "^": r"\^{}", "~": r"\~{}", "<": r"$<$", ">": r"$>$"}
    return re.sub(r"[\\{}^~<>#$%&_]", lambda found: special.get(found.group(), "\\" + found.group()), text)


def latex(title: str, people: str, about: str, sections) -> str:
    """The same as a document of LaTeX, with nothing but its standard classes."""
    lines = [f"% {people}", r"\documentclass{article}", r"\usepackage[utf8]{inputenc}",
             r"\usepackage[margin=15mm]{geometry}", r"\usepackage{longtable}", r"\begin{document}",
             rf"\noindent\textbf{{{_tex(people)}}}", rf"\section*{{{_tex(title)}}}", _tex(about)]
    for name, rows, note in sections:
        widths = [max(max(len(row[i]) for row in rows), 4) for i in range(len(rows[0]))]
        share = [0.92 * min(width, 60) / sum(min(w, 60) for w in widths) for width in widths]
        columns = "".join(rf"p{{{each:.3f}\linewidth}}" for each in share)
        lines += [rf"\subsection*{{{_tex(name)}}}", r"{\footnotesize\setlength{\tabcolsep}{2pt}\raggedright",
                  rf"\begin{{longtable}}{{{columns}}}", r"\hline"]
        for i, row in enumerate(rows):
            lines.append(" & ".join(map(_tex, row)) + r" \\" + (r" \hline" if i == 0 else ""))
        lines += [r"\hline", r"\end{longtable}}", _tex(note)]
    return "\n".join([*lines, r"\end{document}", ""])
