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
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from page_timing import Page, quantile, server_ticks

PHASES = (0, 1, 1, 0)
SETTLE_S = 3.0  # after the bridge has come or gone


def processor_s(process):
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / 100


def memory_MB(process):
    return int(pathlib.Path(f"/proc/{process.pid}/statm").read_text().split()[1]) * 4096 / 1e6


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("program")
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("command", nargs=argparse.REMAINDER)
    given = parser.parse_args()
    folder = pathlib.Path(tempfile.mkdtemp())
    run = subprocess.Popen([given.program, "run", "door", "--user", "mouse", "--no-browser",
                            "--recordings", folder, "--duration", "100000"],
                           stdout=subprocess.PIPE, text=True)
    spans, server, own, memory = [], {0: [], 1: []}, [], []
    bridge = None
    try:
        while not (link := re.search(r"http://\S+", run.stdout.readline())):
            pass
        clock = Page(link[0])
        clock.next("frame", lambda frame: frame["mode"] == "running")
        offset = time.monotonic() - clock.next("frame")["time_s"]
        clock.close()
        for count in PHASES * given.rounds:
            if count == 0 and bridge is not None:
                bridge.send_signal(signal.SIGINT)
                bridge.wait()
                bridge = None
            if count == 1 and bridge is None:
                bridge = subprocess.Popen([word.replace("{link}", link[0])
                                           for word in given.command], stdout=subprocess.DEVNULL)
            time.sleep(SETTLE_S)
            begin, ticks = time.monotonic(), server_ticks(run)
            spent = processor_s(bridge) if bridge else 0.0
            time.sleep(given.seconds)
            end = time.monotonic()
            spans.append((count, begin - offset, end - offset))
            server[count].append((server_ticks(run) - ticks) / (end - begin))
            if bridge:
                own.append((processor_s(bridge) - spent) / (end - begin))
                memory.append(memory_MB(bridge))
    finally:
        for process in (bridge, run):
            if process is not None and process.poll() is None:
                process.send_signal(signal.SIGINT)
        run.communicate()

    from mcap_ros2.reader import read_ros2_messages
    phases = [[] for _ in spans]
    for message in read_ros2_messages(folder / "latest.mcap", topics=["/hapticgiant/sample"]):
        for phase, (_, begin, end) in zip(phases, spans):
            if begin <= message.ros_msg.record.time_s < end:
                phase.append(message.ros_msg.cycle_time_us)
    shutil.rmtree(folder)
    times = {0: [], 1: []}
    for phase, (count, _, _) in zip(phases, spans):
        phase.sort()
        times[count] += phase
    print("bridges  cycles  median us  99 % us  99.9 % us  server thread, % of a core")
    for count, values in times.items():
        values.sort()
        print(f"{count:7}  {len(values):6}  {quantile(values, .5):9.2f}  {quantile(values, .99):7.1f}"
              f"  {quantile(values, .999):9.1f}"
              f"  {100 * sum(server[count]) / len(server[count]):8.2f}")
    print(f"bridge: {100 * sum(own) / len(own):.1f} % of a core, {memory[0]:.1f} MB at first, "
          f"{memory[-1]:.1f} MB at last")
    for name, share in (("median", .5), ("99 %", .99), ("99.9 %", .999)):
        single = [[quantile(phase, share) for phase, span in zip(phases, spans) if span[0] == count]
                  for count in (0, 1)]
        ratio = quantile(times[1], share) / quantile(times[0], share)
        print(f"bridge / none, {name}: {ratio:.3f}; single phases without {min(single[0]):.2f} .. "
              f"{max(single[0]):.2f}, with {min(single[1]):.2f} .. {max(single[1]):.2f} us")


if __name__ == "__main__":
    sys.exit(main())
