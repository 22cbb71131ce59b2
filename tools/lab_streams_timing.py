#!/usr/bin/env python3
"""What the Lab Streaming Layer costs: cycle times of runs with --lsl and a reader, and without.

Usage, in the source folder: lab_streams_timing.py PROGRAM PYTHON [SECONDS] [ROUNDS]

PYTHON has pylsl. Runs of the door at rest, all cycles with the same work, alternate: without streams,
with them, with them and a reader; SECONDS (default 10) each, ROUNDS (default 4) times. Cycle times
are those of the recordings, every cycle after the first second counts.
"""

import os
import pathlib
import subprocess
import sys
import tempfile

from page_timing import quantile

KINDS = ("without", "--lsl", "--lsl, a reader")


def play(program, python, kind, seconds, folder, environment):
    """Cycle times of a run, us, and the processor time of program and reader, s."""
    reader = None
    if kind == KINDS[2]:
        reader = subprocess.Popen([python, "tests/connect/lab_streams_reader.py", folder / "read.npz"],
                                  env=environment, stdout=subprocess.PIPE, text=True)
        reader.stdout.readline()
    options = [] if kind == KINDS[0] else ["--lsl"]
    subprocess.run([program, "run", "door", "--user", "mouse", "--no-viewer", "--duration",
                    str(seconds), "--recordings", folder, *options], env=environment,
                   stdout=subprocess.DEVNULL)
    if reader:
        reader.communicate()

    from mcap_ros2.reader import read_ros2_messages
    file = (folder / "latest.mcap").resolve()
    times = [message.ros_msg.cycle_time_us
             for message in read_ros2_messages(file, topics=["/hapticgiant/sample"])
             if message.ros_msg.record.time_s >= 1.0]
    file.unlink()
    return times


def main():
    program, python, *rest = sys.argv[1:]
    seconds, rounds = float((rest + ["10"])[0]), int((rest + ["10", "4"])[1] if len(rest) > 1 else 4)
    (library,) = pathlib.Path(python).parents[1].glob("lib/python3*/site-packages/pylsl/lib/liblsl.so")
    environment = {**os.environ, "PYLSL_LIB": str(library)}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        sys.path.insert(0, "tests/connect")
        from lab_network import CONFIGURATION
        (folder / "lsl.cfg").write_text(CONFIGURATION.format(session=os.getpid()))
        environment["LSLAPICFG"] = str(folder / "lsl.cfg")
        times = {kind: [] for kind in KINDS}
        medians = {kind: [] for kind in KINDS}
        for _ in range(rounds):
            for kind in KINDS:
                values = sorted(play(program, python, kind, seconds, folder, environment))
                times[kind] += values
                medians[kind].append(quantile(values, 0.5))
    print("| run | cycles | median us | 99 % us | 99.9 % us | medians of single runs, us |")
    print("| --- | --- | --- | --- | --- | --- |")
    for kind, values in times.items():
        values.sort()
        print(f"| {kind} | {len(values)} | {quantile(values, .5):.2f} | {quantile(values, .99):.1f} | "
              f"{quantile(values, .999):.1f} | {min(medians[kind]):.2f} .. {max(medians[kind]):.2f} |")


if __name__ == "__main__":
    main()
