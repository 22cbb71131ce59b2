"""Processor time of the phases of .ci/run against a fixed loop that runs beside them.

    ci_bar.py measure            prints the processor seconds of the loop: a compiler at a fixed source
    ci_bar.py check TIMES        TIMES: lines `PHASE SECONDS LOOP_SECONDS`, as .ci/run writes them
    ci_bar.py record TIMES       makes them the recorded ones, .ci/times.csv

A phase's size is its processor seconds in loops, so that the speed of the machine does not count. check
prints each phase that is more than a fifth larger than recorded, and exits with 1 where one is twice as
large. After a change that is meant to cost time: record, and say why in the commit.
"""

import csv
import pathlib
import resource
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
RECORDED = ROOT / ".ci" / "times.csv"
GROWN, TOO_LARGE = 1.2, 2.0
SOURCE = """
#include <algorithm>
#include <functional>
#include <iostream>
#include <map>
#include <regex>
#include <string>
#include <vector>
int main() {
  std::map<std::string, std::vector<int>> all;
  for (int i = 0; i < 100; ++i) all[std::to_string(i % 7)].push_back(i);
  for (auto& [name, values] : all) std::sort(values.begin(), values.end(), std::greater<>());
  std::cout << std::regex_match("abc", std::regex("[a-c]+")) << all.size();
}
"""


def measure():
    """Processor seconds of three compilations of SOURCE."""
    with tempfile.TemporaryDirectory() as folder:
        source = pathlib.Path(folder, "loop.cpp")
        source.write_text(SOURCE)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        for _ in range(3):
            subprocess.run(["g++", "-std=c++20", "-O2", "-c", source, "-o", source.with_suffix(".o")],
                           check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def read_times(file):
    """Size of each phase in loops, rounded to a tenth."""
    sizes = {}
    for line in pathlib.Path(file).read_text().splitlines():
        phase, seconds, loop = line.rsplit(maxsplit=2)
        sizes[phase] = round(float(seconds) / float(loop), 1)
    return sizes


def check(sizes):
    recorded = {}
    if RECORDED.exists():
        with RECORDED.open(newline="") as file:
            recorded = {row["phase"]: float(row["loops"]) for row in csv.DictReader(file)}
    worst = 0.0
    for phase, size in sizes.items():
        if phase not in recorded:
            print(f"ci: {phase}: {size} loops, not recorded in .ci/times.csv")
            continue
        # phases of a few seconds are mostly the noise of starting
        ratio = size / max(recorded[phase], 1.0)
        worst = max(worst, ratio)
        if ratio > GROWN:
            print(f"ci: {phase} takes {ratio:.2f} times its recorded processor time "
                  f"({size} loops, recorded {recorded[phase]}): tools/ci_bar.py")
    return 1 if worst > TOO_LARGE else 0


def main():
    if sys.argv[1:] == ["measure"]:
        print(f"{measure():.2f}")
        return 0
    if len(sys.argv) != 3 or sys.argv[1] not in ("check", "record"):
        print(__doc__, file=sys.stderr)
        return 2
    sizes = read_times(sys.argv[2])
    if sys.argv[1] == "check":
        return check(sizes)
    with RECORDED.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["phase", "loops"])
        writer.writerows(sizes.items())
    return 0


if __name__ == "__main__":
    sys.exit(main())
