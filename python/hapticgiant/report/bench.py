"""Tables, figures and README.md of `hapticgiant bench`, from its times."""

import json

import matplotlib
import numpy as np

from ..figures import COLOURS, SETTINGS
from . import pages, pictures, tables

ENOUGH_FOR_TAIL = 1000  # times: with fewer, the 99.9th percentile would be the largest
BINS_PER_DECADE = 20
SHORTEST_US = 1e-3  # a clock may say zero
# panels of cycle_histogram.svg: the cycle and its longest stages
SHOWN_STAGES = ("total", "solver", "rendering set-up", "reactions")


def distribution(ns):
    """Exact: median, 99.9th percentile (None of few) and largest of these times, in us."""
    if not ns:
        return {"median_us": 0.0, "p99_9_us": None, "max_us": 0.0}
    median, tail = np.quantile(ns, (0.5, 0.999), method="inverted_cdf") / 1e3
    return {"median_us": float(median),
            "p99_9_us": float(tail) if len(ns) >= ENOUGH_FOR_TAIL else None,
            "max_us": max(ns) / 1e3}


def mean(ns):
    return float(np.mean(ns)) / 1e3 if ns else 0.0


def histogram(ns):
    """Edges in us, equally far apart on a logarithmic axis, and how many times lie between them."""
    if not ns:
        return np.array([]), np.array([], dtype=int)
    us = np.maximum(np.asarray(ns) / 1e3, SHORTEST_US)
    bins = np.floor(BINS_PER_DECADE * np.log10(us)).astype(int)
    first = bins.min()
    counts = np.bincount(bins - first)
    return 10.0 ** (np.arange(first, first + len(counts) + 1) / BINS_PER_DECADE), counts


def exponent(sizes, us):
    """Least squares on logarithms: us ~ sizes^exponent."""
    return float(np.polyfit(np.log(sizes), np.log(np.maximum(us, SHORTEST_US)), 1)[0])


# tables: lists of dictionaries with equal keys

def solver_rows(results):
    rows = []
    for measured in results["solver"]:
        last = measured["runs"][-1]
        cascade = distribution(last["ns"])["median_us"] if last["solver"] == "cascade" else None
        for run in measured["runs"]:
            is_ours = run["solver"] != "cascade"
            times = distribution(run["ns"])
            has_factor = is_ours and cascade is not None and times["median_us"] > 0.0
            rows.append({
                **{key: measured[key] for key in ("set", "variables", "levels", "problems")},
                "solver": run["solver"], **times, "mean_us": mean(run["ns"]),
                "active_sets_tried":
                    run["active_sets_tried"] / max(1, measured["problems"]) if is_ours else None,
                "failed": run["failed"], "wrong": run["wrong"],
                "cascade_takes_times": cascade / times["median_us"] if has_factor else None})
    return rows


def parts_of(scenario):
    return {"total": scenario["total"], **scenario["stages"]}


def cycle_rows(results):
    return [{"scenario": it["scenario"], "stage": stage, "cycles": len(ns), **distribution(ns),
             "mean_us": mean(ns)}
            for it in results["cycles"] for stage, ns in parts_of(it).items()]


def growth_rows(results):
    rows = []
    for it in results["growth"]:
        row = {key: it[key] for key in ("variables", "levels", "rows")}
        for start in ("cold", "warm"):
            times = distribution(it[f"{start}_ns"])
            row |= {f"{start}_median_us": times["median_us"], f"{start}_max_us": times["max_us"],
                    f"{start}_active_sets_tried": it[f"{start}_active_sets_tried"]}
        rows.append({**row, "failed": it["failed"]})
    return rows


def exponent_rows(growth):
    """Over variables for each number of levels, and over levels for the most variables."""
    most = max((row["variables"] for row in growth), default=0)
    series = [("variables", f"{count} levels", [row for row in growth if row["levels"] == count])
              for count in sorted({row["levels"] for row in growth})]
    series.append(("levels", f"{most} variables",
                   [row for row in growth if row["variables"] == most]))
    return [{"with": size, "at": kept,
             **{start: exponent([row[size] for row in rows],
                                [row[f"{start}_median_us"] for row in rows])
                for start in ("cold", "warm")}}
            for size, kept, rows in series if len(rows) > 1]


def per_cycle(run, key):
    return run[key] / max(1, run["cycles"] - 1)


def law_rows(results):
    rows = []
    for run in results["laws"]:
        times = {f"{part}_us": {key.removesuffix("_us"): value for key, value
                                in distribution(run[f"{part}_ns"]).items()}
                 for part in ("solver", "cycle")}
        rows.append({
            **{key: run[key] for key in ("scenario", "law", "bounds", "events", "missing_events",
                                         "fault", "cycles", "unsolved")},
            "active_set_changes_per_second": run["changes"] / max(run["duration_s"], 1e-9),
            "share_of_cycles_with_a_change": per_cycle(run, "changed_cycles"),
            "acceleration_change_per_cycle": {
                "mean": per_cycle(run, "sum_acceleration_change"),
                "max": run["max_acceleration_change"], "unit": "m/s^2"},
            "worst_violation": run["worst_violation"], **times})
    return rows


def flat(row, prefix=""):
    """Parts of parts become columns of their own, lists one text."""
    result = {}
    for key, value in row.items():
        if isinstance(value, dict):
            result |= flat(value, f"{prefix}{key}_")
        else:
            result[prefix + key] = " ".join(value) if isinstance(value, list) else value
    return result


def as_csv(rows):
    return tables.as_csv([list(rows[0]), *(row.values() for row in rows)]) if rows else ""


def bins(named):
    """Rows of a histogram's table; `named`: pairs of columns and times."""
    return [{**columns, "low_us": float(low), "high_us": float(high), "count": int(count)}
            for columns, ns in named for edges, counts in [histogram(ns)]
            for low, high, count in zip(edges, edges[1:], counts)]


def solver_times(results):
    return [({"set": it["set"], "solver": run["solver"]}, run["ns"])
            for it in results["solver"] for run in it["runs"]]


def cycle_times(results):
    return [({"scenario": it["scenario"], "stage": stage}, ns)
            for it in results["cycles"] for stage, ns in parts_of(it).items()]


# figures

def panels_of(titles, x_label, y_label):
    """Two panels side by side that share their logarithmic axes, with these titles."""
    rows = max(1, -(-len(titles) // 2))
    figure = pictures.new_figure(0.4 + 1.7 * rows)
    panels = figure.subplots(rows, 2, sharex=True, sharey=True, squeeze=False).flat
    for panel in panels[len(titles):]:
        panel.set_axis_off()
    panels = list(panels)[:len(titles)]
    for number, (panel, title) in enumerate(zip(panels, titles)):
        panel.set(xscale="log", yscale="log")
        pictures.log_ticks(panel.xaxis, plain=False)
        pictures.log_ticks(panel.yaxis, plain=False)
        panel.set_title(title)
        if number % 2 == 0:
            panel.set_ylabel(y_label)
        if number >= len(titles) - 2:
            panel.set_xlabel(x_label)
            panel.tick_params(labelbottom=True)
    return figure, panels


def histograms(titles_and_series, x_label, y_label):
    """One panel per title; bins without any are at half a count."""
    figure, panels = panels_of([title for title, _ in titles_and_series], x_label, y_label)
    colours, handles = {}, {}
    for panel, (_, series) in zip(panels, titles_and_series):
        for name, ns in series.items():
            edges, counts = histogram(ns)
            if not len(counts):
                continue
            colour = colours.setdefault(name, COLOURS[len(colours) % len(COLOURS)])
            handles[name] = panel.stairs(np.maximum(counts, 0.5), edges, baseline=0.5,
                                         color=colour, linewidth=1.0)
    if handles:
        pictures.legend_below(figure, list(handles.values()), list(handles))
    return figure


def solver_figure(results):
    return histograms([(f"{it['set']} (n = {it['variables']}, {it['levels']} levels)",
                        {run["solver"]: run["ns"] for run in it["runs"]})
                       for it in results["solver"]], "us per problem", "problems")


def cycle_figure(results):
    return histograms([(it["scenario"],
                        {"Cycle::step" if stage == "total" else stage: parts_of(it)[stage]
                         for stage in SHOWN_STAGES}) for it in results["cycles"]], "us", "cycles")


def growth_figure(growth):
    figure, panels = panels_of(["cold", "warm, after a small change"], "variables", "us, median")
    sizes = sorted({row["variables"] for row in growth})
    for panel, start in zip(panels, ("cold", "warm")):
        for marker, colour, levels in zip("os^Dx+v", COLOURS, sorted({row["levels"]
                                                                      for row in growth})):
            rows = [row for row in growth if row["levels"] == levels]
            panel.plot([row["variables"] for row in rows],
                       [row[f"{start}_median_us"] for row in rows], marker=marker, markersize=4,
                       color=colour, fillstyle="none", label=f"{levels} level{'s' if levels > 1 else ''}")
        panel.set_xticks(sizes, map(str, sizes))
    pictures.legend_of(figure, panels[0])
    return figure


def figures_of(results):
    """By their names as files."""
    return {"solver_histogram": solver_figure(results), "cycle_histogram": cycle_figure(results),
            "growth": growth_figure(growth_rows(results))}


# text

def number(value, digits):
    return "-" if value is None else f"{value:.{digits}f}"


def solver_cells(rows):
    table = [["set", "n", "levels", "problems", "solver", "median", "99.9 %", "max", "tried",
              "failed", "wrong", "cascade"]]
    previous = None
    for row in rows:
        same = row["set"] == previous
        previous = row["set"]
        factor = row["cascade_takes_times"]
        table.append([
            *(("", "", "", "") if same else
              (row["set"], str(row["variables"]), str(row["levels"]), str(row["problems"]))),
            row["solver"], number(row["median_us"], 2), number(row["p99_9_us"], 2),
            number(row["max_us"], 2), number(row["active_sets_tried"], 2), str(row["failed"]),
            "-" if row["wrong"] is None else str(row["wrong"]),
            "" if factor is None else f"{factor:.{1 if factor < 10 else 0}f} x"])
    return table


def cycle_cells(rows):
    table = [["scenario", "stage", "median", "99.9 %", "max", "mean", "share"]]
    for row in rows:
        is_total = row["stage"] == "total"
        whole = row["mean_us"] if is_total else sum(
            it["mean_us"] for it in rows
            if it["scenario"] == row["scenario"] and it["stage"] != "total")
        table.append([row["scenario"] if is_total else "",
                      "Cycle::step" if is_total else row["stage"],
                      *(number(row[key], 2)
                        for key in ("median_us", "p99_9_us", "max_us", "mean_us")),
                      f"{100.0 * row['mean_us'] / whole if whole else 0.0:.0f} %"])
    return table


def growth_cells(rows):
    head = ["n", "levels", "rows"] + [f"{start} {what}" for start in ("cold", "warm")
                                      for what in ("median", "max", "tried")] + ["failed"]
    return [head] + [[value if isinstance(value, str) else
                      str(value) if isinstance(value, int) else number(value, 1)
                      for value in row.values()] for row in rows]


def exponent_lines(exponents):
    return "".join(
        f"\nmedian ~ {it['with']}^k at {it['at']}: k = {it['cold']:.2f} cold, {it['warm']:.2f} warm\n"
        for it in exponents)


def violation(worst):
    if worst["value"] == 0.0:
        return "none"
    return f"{1e3 * worst['value']:.2f} m{worst['unit']} {worst['limit']}"


def law_cells(rows, results):
    table = [["scenario", "law", "bounds", "events", "changes/s", "cycles changed", "mean m/s^2",
              "max m/s^2", "worst violation", "solver us", "cycle us"]]
    for row, run in zip(rows, results["laws"]):
        change = row["acceleration_change_per_cycle"]
        table.append([
            row["scenario"], row["law"], row["bounds"], f"{run['events']}/{run['expected_events']}",
            number(row["active_set_changes_per_second"], 1),
            f"{100.0 * row['share_of_cycles_with_a_change']:.2f} %", number(change["mean"], 4),
            number(change["max"], 1), violation(row["worst_violation"]),
            *(f"{it['median']:.1f} / {number(it['p99_9'], 1)} / {it['max']:.0f}"
              for it in (row["solver_us"], row["cycle_us"]))])
    return table


def law_problems(results):
    problems = []
    for run in results["laws"]:
        found = ["missing: " + ", ".join(run["missing_events"])] if run["missing_events"] else []
        found += [f"fault: {run['fault']}"] if run["fault"] != "no fault" else []
        found += [f"{run['unsolved']} cycles not solved"] if run["unsolved"] else []
        problems += [f"\n**{run['scenario']}, {run['law']}, {run['bounds']}: {it}**\n"
                     for it in found]
    return "".join(problems)


def only_first(most, what):
    return "" if most is None else f"\n--quick: only the first {most} {what}\n"


def sections(results, rows, solver, cycle, growth, laws):
    """What was measured and how, around four tables."""
    passes = results["passes"]
    return "".join([
        f"## Solver\n\nus per problem: the fastest of {passes} passes for each problem\n",
        only_first(results["most_problems"], "problems of each set; in those of a scenario "
                   "usually nothing touches yet"),
        "\n", solver,
        f"\n## Cycle\n\nus, law gauss, bounds recoverable: the fastest of {passes} plays for "
        f"each cycle; stages are\nmeasured in {passes} plays of their own and contain a look "
        "at the clock each\n",
        only_first(results["most_cycles"], "cycles that render; usually nothing touches yet"),
        "\n", cycle,
        "\n## Growth\n\nus, random well-posed problems (bench/growth.h, seeds 1 to 5): the "
        f"fastest of {passes} passes\n\n", growth, exponent_lines(rows["growth_exponents"]),
        "\n## Laws and bounds\n\nEach cycle measured once; us: median / 99.9 % / max; change "
        "of acceleration: of the hand per cycle\n\n", laws, law_problems(results),
        *(["\n## Not measured\n\n"] if results["remarks"] else []),
        *(f"- {remark}\n" for remark in results["remarks"])])


def readme(results, rows):
    """The page of the results; the program prints it, too."""
    aligned = tables.aligned_markdown
    parts = ["# Benchmark\n\n", *(f"- {key}: {value}\n" for key, value
                                  in results["machine"].items()),
             "\nFigures: solver_histogram.svg, cycle_histogram.svg, growth.svg\n\n",
             sections(results, rows, aligned(solver_cells(rows["solver"]), left=(0, 4)),
                      aligned(cycle_cells(rows["cycle"]), left=(0, 1)),
                      aligned(growth_cells(rows["growth"]), left=()),
                      aligned(law_cells(rows["runs"], results), left=(0, 1, 2, 8)))]
    return "".join(parts)


def refresh_docs(results, rows, page):
    """Writes tables and machine into the page of the documentation, the tables beside it."""
    def table(cells, name):
        return pages.PageTables(page)(cells, name, most=0)

    machine = results["machine"]
    text = sections(results, rows, table(solver_cells(rows["solver"]), "solver"),
                    table(cycle_cells(rows["cycle"]), "cycle"),
                    table(growth_cells(rows["growth"]), "growth"),
                    table(law_cells(rows["runs"], results), "laws"))
    pages.refresh(page, f"`make bench`, {machine['cpu']}, {machine['cores']} shared cores, "
                  f"{machine['compiler']}.\n\n{text}")


def write(results, folder, docs=None):
    """Writes the report into `folder`, and its figures into benchmarks.md of `docs`."""
    growth = growth_rows(results)
    rows = {"solver": solver_rows(results), "cycle": cycle_rows(results), "growth": growth,
            "growth_exponents": exponent_rows(growth), "runs": law_rows(results)}
    machine = results["machine"]
    texts = {
        "bench.json": json.dumps({"version": machine["version"], "machine": machine, **rows},
                                 indent=2) + "\n",
        "machine.txt": "".join(f"{key}: {value}\n" for key, value in machine.items()),
        "README.md": readme(results, rows),
        "solver_histogram.csv": as_csv(bins(solver_times(results))),
        "cycle_histogram.csv": as_csv(bins(cycle_times(results))),
        "laws.csv": as_csv([flat(row) for row in rows["runs"]]),
        **{f"{name}.csv": as_csv(rows[name])
           for name in ("solver", "cycle", "growth", "growth_exponents")}}
    print(texts["README.md"], end="")
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    with matplotlib.rc_context(SETTINGS):
        for name, figure in figures_of(results).items():
            figure.savefig(folder / f"{name}.svg", metadata={"Date": None, "Creator": None})
    if docs:
        refresh_docs(results, rows, docs / "benchmarks.md")
