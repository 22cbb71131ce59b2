"""Times DAQP, a dual active-set QP solver with priorities, on problem files: to compare with `bench`.

    daqp_times.py FILE.hqp.gz ...     in a Python with numpy and daqp (pip install daqp==0.11.0)

CSV. Per file: microseconds as DAQP measures itself (set-up and solution, cold, the fastest of five), how
often it failed, and how often it was wrong: the slack norm of a level differs from that in FILE.sol.gz
by more than 1e-6 of 1 + norm, the tolerance of our tests.
"""

import gzip
import pathlib
import sys

import daqp
import numpy as np

PASSES = 5
TOLERANCE = 1e-6


def problems(file):
    """Levels of each problem: a list of (c, lb, ub), multiplied by their weights."""
    with gzip.open(file, "rt") as lines:
        for words in map(str.split, lines):
            if words[0] == "hqp":
                variables, levels = int(words[1]), []
            elif words[0] == "level":
                equalities = int(words[1])
                levels.append([])
            elif words[0] == "end":
                yield variables, levels
            elif words[0] not in ("name", "options", "guess"):
                weight = float(words[words.index("weight") + 1]) if "weight" in words else 1.0
                is_equality = len(levels[-1]) < equalities
                bounds = words[variables:variables + (1 if is_equality else 2)]
                c = weight * np.array(words[:variables], dtype=float)
                levels[-1].append((c, weight * float(bounds[0]), weight * float(bounds[-1])))


def slack_norms(levels, x):
    return [np.sqrt(sum(max(0.0, lb - c @ x, c @ x - ub) ** 2 for c, lb, ub in level))
            for level in levels]


def solve(variables, levels):
    """x, whether it was solved, and microseconds."""
    rows = [row for level in levels for row in level]
    firsts = np.cumsum([0] + [len(level) for level in levels]).astype(np.intc)
    x, _, flag, info = daqp.solve(
        np.eye(variables), np.zeros(variables), np.array([c for c, _, _ in rows]),
        np.array([min(ub, 1e30) for _, _, ub in rows]),
        np.array([max(lb, -1e30) for _, lb, _ in rows]), np.zeros(len(rows), np.intc), firsts)
    return np.array(x), flag > 0, 1e6 * (info["setup_time"] + info["solve_time"])


def norms_of(file):
    """Optimal slack norms by problem and level, where they are known; None: not to be compared."""
    stem = str(file).removesuffix(".hqp.gz")
    if not pathlib.Path(stem + ".sol.gz").exists():
        return None
    skip = pathlib.Path(stem + ".skip")
    skipped = {int(line.split()[0]) for line in skip.read_text().splitlines() if line.strip()} \
        if skip.exists() else set()
    with gzip.open(stem + ".sol.gz", "rt") as lines:
        return [None if i in skipped else np.array(line.split(), dtype=float)
                for i, line in enumerate(lines)]


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    print("set,problems,median_us,max_us,failed,wrong")
    for file in map(pathlib.Path, sys.argv[1:]):
        norms = norms_of(file)
        times, failed, wrong = [], 0, 0
        for i, (variables, levels) in enumerate(problems(file)):
            runs = [solve(variables, levels) for _ in range(PASSES)]
            times.append(min(us for _, _, us in runs))
            failed += not runs[0][1]
            if norms is None or norms[i] is None:
                continue
            expected = np.sqrt(norms[i][variables:])
            differences = np.abs(slack_norms(levels, runs[0][0]) - expected)
            wrong += bool((differences > TOLERANCE * (1.0 + expected)).any())
        name = file.name.removesuffix(".hqp.gz")
        print(f"{name},{len(times)},{np.median(times):.1f},{max(times):.1f},{failed},"
              f"{'' if norms is None else wrong}", flush=True)


if __name__ == "__main__":
    main()
