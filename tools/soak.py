#!/usr/bin/env python3
"""Plays scenarios for hours of simulated time and looks at memory, faults and limits.

    tools/soak.py build/release/hapticgiant --hours 30
    tools/soak.py build/release/hapticgiant --hours 0.5 --scenarios walk door

Runs of the scenarios follow each other, each with another seed, as fast as the machine allows. What
has been played is kept in --state: a restart continues, and ends at once when the hours are full.
A run fails on a fault, an exceeded limit, a lost sample, an allocation in the loop, or memory that
grows while it plays. Exit code 0: no run has failed, 1: some have, they are listed.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

# simulated seconds of one run; those that walk in circles have no end of their own
DURATION_S = {"walk": 1800.0, "path": 600.0}
LARGEST_GROWTH_KB = 1024
FEWEST_SAMPLES = 40  # of the memory, for a run to be judged by its growth


def memory_kb(process):
    """Resident memory, None once the process has ended."""
    try:
        status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
    except OSError:
        return None
    for line in status.splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1])
    return None


def growth_kb(samples):
    """From the second quarter of a run, when everything has been touched, to its last."""
    if len(samples) < FEWEST_SAMPLES:
        return 0.0
    quarter = len(samples) // 4
    return statistics.median(samples[-quarter:]) - statistics.median(samples[quarter : 2 * quarter])


def play(program, scenario, seed, folder):
    """One run: its summary, exit code and memory."""
    summary = pathlib.Path(folder) / "summary.json"
    summary.unlink(missing_ok=True)
    command = [program, "run", scenario, "--fast", "--no-viewer", "--no-recording"]
    command += ["--recordings", folder, "--seed", str(seed), "--summary", str(summary)]
    if scenario in DURATION_S:
        command += ["--duration", str(DURATION_S[scenario])]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    samples = []
    while process.poll() is None:
        now = memory_kb(process)
        if now is not None:
            samples.append(now)
        time.sleep(0.2)
    output = process.stdout.read()
    result = json.loads(summary.read_text()) if summary.exists() else {}
    return command, process.returncode, result, samples, output


def complaints(code, result, samples):
    if not result:
        return [f"no summary, exit code {code}"]
    found = []
    if result["fault"]["code"] != 0:
        found.append(f"fault {result['fault']['code']}: {result['fault']['what']}")
    if not result["limits_held"]:
        found.append("a limit was exceeded")
    if result["dropped_samples"] != 0:
        found.append(f"{result['dropped_samples']} samples lost")
    if result["allocations_in_loop"] != 0:
        found.append(f"{result['allocations_in_loop']} allocations in the loop")
    if result["solver"]["status"].get("failed", 0) + result["solver"]["status"].get(
        "iteration limit", 0
    ):
        found.append("problems were not solved")
    if growth_kb(samples) > LARGEST_GROWTH_KB:
        found.append(f"memory grew by {growth_kb(samples):.0f} KiB")
    if code not in (0, 1, 3):
        found.append(f"exit code {code}")
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--hours", type=float, default=30.0, help="of simulated time")
    parser.add_argument(
        "--scenarios", nargs="+", default=["walk", "door", "excavator", "free_space", "path"]
    )
    parser.add_argument("--state", default="build/soak/state.json")
    arguments = parser.parse_args()

    file = pathlib.Path(arguments.state)
    file.parent.mkdir(parents=True, exist_ok=True)
    state = {"runs": 0, "simulated_s": 0.0, "wall_s": 0.0, "largest_growth_kB": 0.0, "failed": []}
    if file.exists():
        state = json.loads(file.read_text())
    while state["simulated_s"] < 3600.0 * arguments.hours:
        scenario = arguments.scenarios[state["runs"] % len(arguments.scenarios)]
        begin = time.monotonic()
        with tempfile.TemporaryDirectory() as folder:
            command, code, result, samples, output = play(
                arguments.program, scenario, 1 + state["runs"], folder
            )
        state["runs"] += 1
        state["wall_s"] += time.monotonic() - begin
        state["simulated_s"] += result.get("duration_s", 0.0)
        state["largest_growth_kB"] = max(state["largest_growth_kB"], growth_kb(samples))
        found = complaints(code, result, samples)
        if found:
            state["failed"].append({"command": " ".join(command), "what": found})
            print(f"\n{' '.join(command)}\n  {'; '.join(found)}\n{output[-2000:]}", flush=True)
        if not result:
            break
        file.write_text(json.dumps(state, indent=2) + "\n")
        print(
            f"\r{state['simulated_s'] / 3600:.2f} of {arguments.hours} h, {state['runs']} runs, "
            f"{state['simulated_s'] / state['wall_s']:.0f}x real time, {len(state['failed'])} failed",
            end="",
            flush=True,
        )
    print(
        f"\n{state['simulated_s'] / 3600:.2f} simulated hours in {state['runs']} runs and "
        f"{state['wall_s'] / 3600:.2f} h; memory grew by at most {state['largest_growth_kB']:.0f} KiB; "
        f"{len(state['failed'])} runs failed"
    )
    for run in state["failed"]:
        print(f"  {run['command']}: {'; '.join(run['what'])}")
    return 1 if state["failed"] else 0


if __name__ == "__main__":
    sys.exit(main())
