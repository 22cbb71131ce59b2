"""`hapticgiant study report`: HTML, LaTeX, and the analysis that made them, beside the data."""

from __future__ import annotations

import pathlib
import re

import matplotlib
from matplotlib.patches import Patch

from hapticgiant.figures import COLOURS, SETTINGS
from hapticgiant.report import pages, pictures
from hapticgiant.study import analysis, planning, trials
from hapticgiant.study.description import Study
from hapticgiant.study.folder import Folder, FolderError

HERE = pathlib.Path(__file__).resolve().parent
SIMULATED = "THE PEOPLE OF THIS STUDY ARE SIMULATED: nothing here says anything about people."
REAL = "The people of this study took part in person."
PANELS = 4  # measures in a row


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
            "correction": study.correction, "outcomes": study.outcomes,
            "tests": [{"outcome": test.outcome, "test": test.test} for test in study.tests]}))
        for name in ("analysis.py", "inference.py"):
            folder.replace(folder.path / "code" / name, (HERE / name).read_text(encoding="utf-8"))
        data = analysis.Data(folder.path)
    found = analysis.tests(data)
    kinds = sorted({test.test for test in study.tests})
    sections = [
        ("Planned tests", analysis.test_rows(data, found),
         "; ".join(f"{kind}: {planning.DESCRIBED[kind]}" for kind in kinds)
         + f". alpha = {study.alpha:g}. The last p is corrected for all planned tests."),
        ("Pairs of conditions", analysis.pair_rows(data, found),
         f"Difference: of means, or for ranks the Hodges-Lehmann estimate. p is corrected ({study.correction}) for the "
         "pairs of an outcome."),
        ("Assumptions and notes", analysis.assumption_rows(found), "They are told and do not change the test."),
        ("Means of people", analysis.description_rows(data),
         "; ".join(f"{name}: {what}" for name, what in study.outcomes.items()) + "."),
        ("Left out", analysis.exclusion_rows(data), _exclusions(study, data))]
    sections = [each for each in sections if len(each[1]) > 1 or each[0] == "Left out"]
    counted = len(data.participants) - len(data.left_out)
    about = (f"{counted} of {len(data.participants)} participants count ({study.design.participants} were planned); "
             f"{len(study.conditions)} conditions {study.design.kind} people, order {study.design.order}, "
             f"{study.design.repetitions} trials of each. {description['Model']}")
    title = ("Simulated people: " if description["Simulated"] else "") + study.title
    page = pages.render(
        "page.html.jinja", title=title, source=people, about=about,
        verdicts=[(False, f"No test of {outcome}: {each}.") for outcome, each, _ in found if isinstance(each, str)],
        figure=boxes(study, data), caption="Means of people: median, quartiles, whiskers to the last value within 1.5 "
        "times their distance, dots beyond. Lower TLX scores are better.",
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


def boxes(study: Study, data: analysis.Data) -> str:
    """Box plots by condition: questionnaires in a row each, measures in small panels."""
    conditions = list(study.conditions)
    colours = {name: COLOURS[i % len(COLOURS)] for i, name in enumerate(conditions)}
    forms = [(name, [f"{name}.{score}" for score in form.scores]) for name, form in study.forms.items() if form.scores]
    measures = list(study.measures)
    rows = len(forms) + -(-len(measures) // PANELS)
    with matplotlib.rc_context(SETTINGS):
        figure = pictures.new_figure(2.1 * rows + 0.3)
        grid = figure.add_gridspec(max(1, rows), PANELS)
        for row, (name, outcomes) in enumerate(forms):
            panel = figure.add_subplot(grid[row, :])
            for place, outcome in enumerate(outcomes):
                _place(panel, data.people(outcome), place, conditions, colours)
            panel.set_xticks(range(len(outcomes)), [outcome.partition(".")[2] for outcome in outcomes])
            panel.set_title(name)
            panel.grid(axis="x", visible=False)
            if study.forms[name].kind in ("nasa_tlx", "sus"):
                panel.set_ylim(-2, 102)
        for i, name in enumerate(measures):
            panel = figure.add_subplot(grid[len(forms) + i // PANELS, i % PANELS])
            _place(panel, data.people(name), 0, conditions, colours)
            panel.set_xticks([])
            panel.set_title(f"{name.removesuffix('_' + study.measures[name].unit)}"
                            + (f", {study.measures[name].unit}" if study.measures[name].unit else ""))
        figure.legend(handles=[Patch(facecolor=colours[name], alpha=0.55, label=name) for name in conditions],
                      loc="outside lower center", ncols=len(conditions), frameon=False)
        return pictures.to_svg(figure, "boxes")


def _place(panel, people, place, conditions, colours):
    width = 0.7 / len(conditions)
    for i, name in enumerate(conditions):
        values = people.get(name, people.get("") if i == 0 else None)
        if values is None or len(values) == 0:
            continue
        at = place + (i - (len(conditions) - 1) / 2) * width
        drawn = panel.boxplot([values], positions=[at], widths=0.8 * width, patch_artist=True, manage_ticks=False,
                              flierprops={"marker": ".", "markersize": 3}, medianprops={"color": "black"})
        drawn["boxes"][0].set(facecolor=colours[name], alpha=0.55)


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
