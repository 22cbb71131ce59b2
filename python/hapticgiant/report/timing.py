"""The report of `hapticgiant experiment timing`: computing times of a cycle beside the paper's."""


from .. import figures
from . import bench, pages, tables

TITLE = "Computing time of a cycle"
# [HG] VII-A: Intel Core i5-8600, 1 kHz, QuadProg++ below a cascade of problems
PAPER_US = {"mean": 529.0, "99.9 %": 616.0, "maximum": 707.0}
PAPER_SOLVER_PERCENT = 92.6
HOW = ("Each cycle of the Cartesian experiment is played twice and its faster time counts, so that "
       "what the system does in between does not show; the paper's figures are of one run under "
       "Preempt-RT. Both are computing time alone. The paper's mean time between two iterations, "
       "1003 us, is a matter of the system: see hapticgiant doctor.")


def with_times(row):
    """A row of the results with its times in us and its histogram."""
    stages = {name: bench.mean(ns) for name, ns in row["stages"].items()}
    edges, counts = bench.histogram(row["total"])
    return row | bench.distribution(row["total"]) | {
        "cycles": len(row["total"]), "mean_us": bench.mean(row["total"]),
        "solver_percent": 100.0 * stages["solver"] / sum(stages.values()),
        "edges_us": edges.tolist(), "counts": counts.tolist()}


def rows_of(results):
    mean, tail, most = PAPER_US.values()
    return [["", "rate Hz", "mean us", "99.9 % us", "max us", "solver's share", "mean / period"],
            ["paper (Intel Core i5-8600)", "1000", f"{mean:.0f}", f"{tail:.0f}", f"{most:.0f}",
             f"{PAPER_SOLVER_PERCENT:.1f} %", f"{0.1 * mean:.1f} %"]] + [
        [f"ours, law {row['law']}", f"{row['rate_Hz']:.0f}", bench.number(row["mean_us"], 1),
         bench.number(row["p99_9_us"], 1), bench.number(row["max_us"], 1),
         f"{row['solver_percent']:.1f} %",
         f"{1e-4 * row['mean_us'] * row['rate_Hz']:.1f} %"] for row in results["rows"]]


def as_csv(results):
    keys = ("mean_us", "median_us", "p99_9_us", "max_us")
    return tables.as_csv([["law", "rate_Hz", "cycles", *keys, "solver_percent"]] + [
        [row["law"], f"{row['rate_Hz']:g}", str(row["cycles"]),
         *(bench.number(row[key], 3) for key in keys), f"{row['solver_percent']:.2f}"] for row in results["rows"]])


def histogram_csv(results):
    return tables.as_csv([["law", "rate_Hz", "from_us", "to_us", "cycles"]] + [
        [row["law"], f"{row['rate_Hz']:g}", f"{low:.4g}", f"{high:.4g}", str(count)]
        for row in results["rows"]
        for low, high, count in zip(row["edges_us"], row["edges_us"][1:], row["counts"])])


def figure_facts(results):
    series = []
    for row in results["rows"]:
        shares = [100.0 * count / row["cycles"] for count in row["counts"]] + [0.0]
        series.append({"name": f"law {row['law']}, {1e-3 * row['rate_Hz']:g} kHz",
                       "from_us": row["edges_us"], "share_percent": shares})
    return {"has_two_laws": results["has_two_laws"], "paper_us": PAPER_US, "series": series}


def write(results, folder, docs=None):
    results["rows"] = [with_times(row) for row in results["rows"]]
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
        page = docs / "timing.md"
        pages.refresh(page, f"`hapticgiant experiment timing{cut}`, {machine['cpu']}. {HOW}\n\n"
                      f"{pages.PageTables(page)(rows, 'times')}",
                      (folder / "figure.svg").read_text(encoding="utf-8"))
    return 0
