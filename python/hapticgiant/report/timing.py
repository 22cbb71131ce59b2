"""The report of `hapticgiant experiment timing`: computing times of a cycle beside the paper's."""

import json

from .. import figures
from . import pages, tables

TITLE = "Computing time of a cycle"
# [HG] VII-A: Intel Core i5-8600, 1 kHz, QuadProg++ below a cascade of problems
PAPER_US = {"mean": 529.0, "99.9 %": 616.0, "maximum": 707.0}
PAPER_SOLVER_PERCENT = 92.6
HOW = ("Each cycle of the Cartesian experiment is played twice and its faster time counts, so that "
       "what the system does in between does not show; the paper's figures are of one run under "
       "Preempt-RT. Both are computing time alone. The paper's mean time between two iterations, "
       "1003 us, is a matter of the system: see hapticgiant doctor.")


def us(value, digits):
    return "-" if value is None else f"{value:.{digits}f}"


def solver_percent(row):
    return 100.0 * row["solver_us"] / sum(row["stage_means_us"])


def rows_of(results):
    mean, tail, most = PAPER_US.values()
    return [["", "rate Hz", "mean us", "99.9 % us", "max us", "solver's share", "mean / period"],
            ["paper (Intel Core i5-8600)", "1000", us(mean, 0), us(tail, 0), us(most, 0),
             f"{PAPER_SOLVER_PERCENT:.1f} %", f"{0.1 * mean:.1f} %"]] + [
        [f"ours, law {row['law']}", f"{row['rate_Hz']:.0f}", us(row["mean_us"], 1),
         us(row["p99_9_us"], 1), us(row["max_us"], 1), f"{solver_percent(row):.1f} %",
         f"{1e-4 * row['mean_us'] * row['rate_Hz']:.1f} %"] for row in results["rows"]]


def as_csv(results):
    keys = ("mean_us", "median_us", "p99_9_us", "max_us")
    return tables.as_csv([["law", "rate_Hz", "cycles", *keys, "solver_percent"]] + [
        [row["law"], f"{row['rate_Hz']:g}", str(row["cycles"]), *(us(row[key], 3) for key in keys),
         f"{solver_percent(row):.2f}"] for row in results["rows"]])


def histogram_csv(results):
    return tables.as_csv([["law", "rate_Hz", "from_us", "to_us", "cycles"]] + [
        [row["law"], f"{row['rate_Hz']:g}", f"{low:.4g}", f"{high:.4g}", str(count)]
        for row in results["rows"] for low, high, count in row["bins"]])


def figure_facts(results):
    series = []
    for row in results["rows"]:
        edges = [low for low, _, _ in row["bins"]] + [row["bins"][-1][1]]
        shares = [100.0 * count / row["cycles"] for _, _, count in row["bins"]] + [0.0]
        series.append({"name": f"law {row['law']}, {1e-3 * row['rate_Hz']:g} kHz",
                       "from_us": edges, "share_percent": shares})
    return {"has_two_laws": results["has_two_laws"], "paper_us": PAPER_US, "series": series}


def write(folder, docs=None):
    results = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    rows, machine = rows_of(results), results["machine"]
    print(tables.markdown(rows))
    pages.save(folder / "timing.csv", as_csv(results))
    pages.save(folder / "histogram.csv", histogram_csv(results))
    facts = figure_facts(results)
    svg = pages.draw(folder, lambda figure: figures.timing(figure, facts))
    pages.save(folder / "report.html", pages.render(
        "page.html.jinja", title=TITLE, source="Section VII-A of the paper", about=HOW, figure=svg,
        caption="How long cycles compute, by law and rate.", sections=[
            {"title": "Times", "rows": rows},
            {"title": "Machine", "rows": [["", ""]] + [[name, str(value)]
                                                       for name, value in machine.items()]}]))
    if docs:
        cut = "" if results["duration_s"] is None else f" --duration {results['duration_s']:g}"
        pages.refresh(docs / "timing.md", f"`hapticgiant experiment timing{cut}`, {machine['date']}, "
                      f"{machine['cpu']}. {HOW}\n\n{tables.markdown(rows)}",
                      (folder / "figure.svg").read_text(encoding="utf-8"))
    return 0
