"""Counts the instructions of solver and control cycle under callgrind: a measure without noise.

    count_instructions.py PROGRAM [FILE.csv]     PROGRAM: bench_instructions; from the repository root

Mean instructions per call over the first 500 problems or cycles of each set.
"""

import csv
import pathlib
import re
import subprocess
import sys
import tempfile

SCENARIOS = ["door", "free_space", "excavator"]
LARGE_TWINS = ["chain_20", "chain_30"]
REFERENCE = ["cart6_free", "cart6_sing_tc20", "door_full_unlock", "exc_two"]


def count(program, what, name):
    """(calls, instructions) of counted()."""
    with tempfile.TemporaryDirectory() as folder:
        profile = pathlib.Path(folder) / "callgrind.out"
        done = subprocess.run(
            ["valgrind", "--tool=callgrind", "--toggle-collect=counted",
             f"--callgrind-out-file={profile}", program, what, name],
            capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{program} {what} {name}: {done.stderr.strip()}")
        total = re.search(r"^(?:summary|totals): (\d+)", profile.read_text(), re.MULTILINE)
        return int(done.stdout), int(total.group(1))


def jobs():
    for name in SCENARIOS + LARGE_TWINS:
        yield "cycle", name
    sets = [f"{name}:{law}" for law in ("gauss", "paper") for name in SCENARIOS]
    for name in sets + [f"tests/reference/{name}.hqp.gz" for name in REFERENCE]:
        yield "warm", name
        yield "cold", name


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    rows = []
    print(f"{'what':<6} {'set':<40} {'calls':>6} {'instructions per call':>22}")
    for what, name in jobs():
        calls, instructions = count(sys.argv[1], what, name)
        rows.append({"what": what, "set": pathlib.Path(name).name.removesuffix(".hqp.gz"),
                     "calls": calls, "instructions_per_call": round(instructions / calls)})
        print(f"{what:<6} {rows[-1]['set']:<40} {calls:>6} {rows[-1]['instructions_per_call']:>22,}",
              flush=True)
    if len(sys.argv) == 3:
        with open(sys.argv[2], "w", newline="") as file:
            writer = csv.DictWriter(file, rows[0], lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)


if __name__ == "__main__":
    main()
