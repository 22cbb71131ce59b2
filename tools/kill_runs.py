#!/usr/bin/env python3
"""Kills runs with SIGKILL at random moments and looks at what their recordings still hold.

    tools/kill_runs.py build/release/hapticgiant --kills 20

Each run plays in real time. Its recording must be readable and end at most a second before it was
killed; a machine so busy that the run falls behind its clock shows up as missing time, too. Prints
its seed. Exit code 0: all recordings were read and were long enough.
"""
import argparse
import pathlib
import random
import re
import signal
import subprocess
import sys
import tempfile
import time


def kill_one(program, wait_s, folder):
    """Seconds between the start of the recording and the kill, and what explain says of it."""
    command = [program, "run", "door", "--no-viewer", "--recordings", folder, "--duration", "60"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.STDOUT)
    link = pathlib.Path(folder) / "latest.mcap"
    while not link.exists():
        if process.poll() is not None:
            raise SystemExit(f"{' '.join(command)}: ended with {process.returncode}")
        time.sleep(0.001)
    begin = time.monotonic()
    time.sleep(wait_s)
    process.send_signal(signal.SIGKILL)
    lived_s = time.monotonic() - begin
    process.wait()
    explained = subprocess.run(
        [program, "explain", str(link)], capture_output=True, text=True, check=False
    )
    return lived_s, explained


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=random.randrange(2**32))
    arguments = parser.parse_args()
    print(f"seed {arguments.seed}")
    source = random.Random(arguments.seed)
    failed, worst_s = 0, 0.0
    for _ in range(arguments.kills):
        with tempfile.TemporaryDirectory() as folder:
            lived_s, explained = kill_one(arguments.program, source.uniform(0.3, 4.0), folder)
        match = re.search(r"\.\. ([0-9.]+) s of the run.*CUT OFF", explained.stdout)
        if explained.returncode != 0 or not match:
            failed += 1
            print(f"killed after {lived_s:.3f} s: NOT READABLE: {explained.stderr.strip()}")
            continue
        missing_s = lived_s - float(match.group(1))
        worst_s = max(worst_s, missing_s)
        print(f"killed after {lived_s:.3f} s, recorded until {match.group(1)} s")
    print(f"{arguments.kills - failed} of {arguments.kills} readable; at most {worst_s:.3f} s missing")
    return 1 if failed or worst_s > 1.0 else 0


if __name__ == "__main__":
    sys.exit(main())
