#!/usr/bin/env python3
"""What a bridge costs the control loop: cycle times beside a bridge and beside none, in one run.

Usage, in the source folder, with the page built:
       bridge_timing.py [--seconds S] [--rounds N] PROGRAM COMMAND...

One run of the door at rest, so that all cycles have the same work; every S seconds (default 10) the
bridge, started as COMMAND, comes or goes. `{link}` in a word of COMMAND is the link of the run. Cycle
times are those of the recording, every cycle counts.
"""

import argparse
import pathlib
import signal
import subprocess
import sys

from page_timing import measure, processor_s

PHASES = (0, 1, 1, 0)
SETTLE_S = 3.0  # after the bridge has come or gone


def memory_MB(process):
    return int(pathlib.Path(f"/proc/{process.pid}/statm").read_text().split()[1]) * 4096 / 1e6


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("program")
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("command", nargs=argparse.REMAINDER)
    given = parser.parse_args()
    own, memory, bridges = [], [], []

    def end():
        for bridge in bridges:
            bridge.send_signal(signal.SIGINT)
            bridge.wait()
        bridges.clear()

    def visit(link, count):
        if count == 0:
            end()
        elif not bridges:
            bridges.append(subprocess.Popen([word.replace("{link}", link) for word in given.command],
                                            stdout=subprocess.DEVNULL))
        yield
        tasks = [pathlib.Path(f"/proc/{bridge.pid}") for bridge in bridges]
        spent = [processor_s(task) for task in tasks]
        length_s = yield
        own.extend((processor_s(task) - before) / length_s for task, before in zip(tasks, spent))
        memory.extend(map(memory_MB, bridges))
        yield

    try:
        timing = measure(given.program, PHASES * given.rounds, given.seconds, SETTLE_S, visit)
    finally:
        end()
    timing.print_table("bridges")
    print(f"bridge: {100 * sum(own) / len(own):.1f} % of a core, {memory[0]:.1f} MB at first, "
          f"{memory[-1]:.1f} MB at last")
    for name, share in (("median", .5), ("99 %", .99), ("99.9 %", .999)):
        single = [timing.single(count, share) for count in (0, 1)]
        print(f"bridge / none, {name}: {timing.ratio(1, share):.3f}; single phases without {min(single[0]):.2f} .. "
              f"{max(single[0]):.2f}, with {min(single[1]):.2f} .. {max(single[1]):.2f} us")


if __name__ == "__main__":
    sys.exit(main())
