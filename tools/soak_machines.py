#!/usr/bin/env python3
"""Drives each simulated machine in real time for long, and looks at what is lost, late or grows.

    tools/soak_machines.py build/release/hapticgiant --minutes 60 --machines udp ethercat franka

All machines at the same time, each with a run of its own: `udp` walks behind `hapticgiant simulate`,
`ethercat` walks behind a simulated segment with the plant of our simulator (needs root or user
namespaces), `franka` is franka-sim with a hand that pulls (an environment of Python of its own). Load
the computer meanwhile, if that is what is to be known; where its kernel is not real-time, --busy lets
late cycles, late frames and late answers pass, so that they are counted and end no run. Prints a table
and writes --out. Exit code 0: nothing is wrong, 1: something is, it is listed, 77: a machine was
skipped, with the reason.
"""
import argparse
import contextlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import time

import soak

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path[1:1] = [str(ROOT / "tests" / part) for part in ("ethercat", "franka", "packages", "remote")]
import bus  # noqa: E402
import harness  # noqa: E402
import machine_test  # noqa: E402
import remote_commands_test  # noqa: E402
from environment import that_lets_late_cycles_pass  # noqa: E402

SKIPPED = 77
RATE = 1000  # Hz, of each of these machines
SETTLED = 10  # s, after which memory must not grow
START = 5  # s, most that a run may take to begin and to end
CLOCKS_APART = 3e-4  # clocks of simulated slaves against ours
LAST_WINDOW = 100  # cycles, which a Franka has not reported yet at the end of a motion
FAREWELL = 8  # datagrams at both ends of a session that are no frames


@contextlib.contextmanager
def before_other_programs():
    """What this thread starts meanwhile runs before other programs, where that is allowed: a real
    machine has processors of its own."""
    with contextlib.suppress(OSError):
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(5))
    try:
        yield
    finally:
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))


def that_is_busy(file, folder):
    """Arguments for the device of this file, without rule 203."""
    return ["--device", that_lets_late_cycles_pass(ROOT / "models" / file, folder)]


class Udp:
    """`hapticgiant simulate` in real time."""

    scenario = "walk"
    waits_for_us = False

    def start(self, stack, folder, is_busy):
        self.server = stack.enter_context(remote_commands_test.Server("walk"))
        device = that_is_busy("haptic_giant/device.yaml", folder) if is_busy else []
        return ["--device-address", self.server.address, *device]

    def uncounted(self, summary):
        said = self.server.session()
        sent, received = map(int, re.search(r"link +(\d+) sent, (\d+) received", said).groups())
        lost = re.search(r"received;.*?(\d+) lost", said)
        here, lost_there = summary["link"], int(lost[1]) if lost else 0
        return {"frames": sent - here["received"] - here["lost"] - FAREWELL,
                "commands": here["sent"] - received - lost_there - FAREWELL}, said


class Ethercat:
    """The HapticGiant on a simulated segment, as a machine that keeps its own time; busy: as the
    simulation that it is, which waits."""

    scenario = "walk"
    waits_for_us = True

    def start(self, stack, folder, is_busy):
        address = stack.enter_context(machine_test.haptic_giant("walk"))
        stack.enter_context(machine_test.segment(plant=address))
        if is_busy:
            return ["--device-address", f"ethercat://{bus.MASTER_END}",
                    *that_is_busy("haptic_giant/device.yaml", folder)]
        file = folder / "machine.yaml"
        file.write_text(machine_test.that_keeps_time())
        return ["--device-address", f"ethercat://{bus.MASTER_END}", "--machine", file,
                "--without-start-test", "--despite", "lateness"]

    def uncounted(self, summary):
        link = summary["link"]
        return {"exchanges": link["sent"] - link["received"] - link["lost"]}, ""


class Franka:
    """franka-sim with our arm and a hand."""

    scenario = "fr3/open_drawer"
    waits_for_us = False

    def start(self, stack, folder, is_busy):
        self.counts = folder / "robot.json"
        port = stack.enter_context(harness.robot("--pull", "3", "--counts", self.counts,
                                                 *([harness.TOLERANT] if is_busy else [])))
        device = (that_is_busy("arms/fr3/fci.yaml", folder) if is_busy
                  else ["--device", "fr3/fci"])
        return [*device, "--device-address", f"franka://127.0.0.1:{port}", "--despite", "lateness"]

    def uncounted(self, summary):
        # each cycle of the motion has an answer, or it is counted
        link, of_robot = summary["link"], json.loads(self.counts.read_text())
        return {"cycles of the motion":
                of_robot["cycles"] - link["sent"] - link["lost"] - link["late"],
                "unanswered": of_robot["unanswered"] - link["late"] - LAST_WINDOW}, json.dumps(of_robot)


MACHINES = {"udp": Udp, "ethercat": Ethercat, "franka": Franka}


def play(program, machine, minutes, is_busy):
    """A run against this machine: exit code, what it said, summary, memory in kB by seconds since its
    begin, what is not counted, and what the machine says."""
    with tempfile.TemporaryDirectory() as name, contextlib.ExitStack() as stack:
        folder = pathlib.Path(name)
        with before_other_programs():
            arguments = machine.start(stack, folder, is_busy)
        file = folder / "summary.json"
        process = subprocess.Popen(
            [program, "run", machine.scenario, "--no-viewer", "--no-recording",
             "--flight-recorder", "off", "--recordings", folder, "--duration", str(60 * minutes),
             "--summary", file, *arguments],
            cwd=ROOT, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            text=True)
        begin, memory = time.monotonic(), {}
        while process.poll() is None:
            if kB := soak.memory_kb(process):
                memory[time.monotonic() - begin] = kB
            time.sleep(1)
        said = process.stdout.read()
        if not file.exists():
            return process.returncode, said, None, memory, {}, ""
        summary = json.loads(file.read_text())
        uncounted, of_machine = machine.uncounted(summary)
    # each period has a frame, and where this computer keeps the period, none is missing by the clock
    uncounted["periods"] = summary["cycles"] - summary["link"]["received"] - summary["link"]["held"]
    if machine.waits_for_us:
        took = (1 - CLOCKS_APART) * summary["wall_time_s"] - START
        uncounted["by the clock"] = int(RATE * took) - summary["cycles"] - summary["overruns"]
    return process.returncode, said, summary, memory, uncounted, of_machine


def result_of(program, name, minutes, is_busy):
    """One row of the table, and what is wrong."""
    code, said, summary, memory, uncounted, of_machine = play(program, MACHINES[name](), minutes,
                                                              is_busy)
    result = {"exit code": code, "wrong": [], "said": said, "machine": of_machine}
    if summary is None:
        result["wrong"].append("no summary")
        return result
    link, cycle, woken = summary["link"], summary["cycle_time_us"], summary.get("wake_up_us", {})
    settled = [kB for at, kB in memory.items() if at > SETTLED] or [0]
    result |= {
        "fault": summary["fault"], "cycles": summary["cycles"], "wall_time_s": summary["wall_time_s"],
        "late cycles": summary["overruns"], "most in a row": summary["most_overruns_in_a_row"],
        "frames": link, "cycle_time_us": {key: cycle[key] for key in ("median", "p99_9", "max")},
        "wake_up_us": {key: woken.get(key, 0.0) for key in ("median", "p99_9", "max")},
        "allocations": summary["allocations_in_loop"], "samples lost": summary["dropped_samples"],
        "memory_kB": {"after 10 s": settled[0], "end": settled[-1], "most": max(settled)},
        "uncounted": {what: max(0, count) for what, count in uncounted.items()}}
    if summary["fault"]["code"] != 0:
        result["wrong"].append(f"fault {summary['fault']['code']}: {summary['fault']['what']}")
    elif code != 0:
        result["wrong"].append(f"exit code {code}")
    for what in ("allocations", "samples lost"):
        if result[what] != 0:
            result["wrong"].append(f"{result[what]} {what}")
    if settled[-1] - settled[0] > soak.LARGEST_GROWTH_KB:
        result["wrong"].append(f"memory grew by {settled[-1] - settled[0]} kB")
    for what, count in result["uncounted"].items():
        if count > 0:
            result["wrong"].append(f"{count} {what} that are not counted")
    return result


def soak_one(results, program, name, options):
    """Keeps and says the result of this machine as soon as there is one."""
    results[name] = result = result_of(program, name, options.minutes, options.busy)
    print(f"--- {time.strftime('%T')} {name}\n{result['said']}{result['machine']}", flush=True)


def row(name, result):
    if "cycles" not in result:
        return [name, "-", str(result["exit code"])]
    frames, memory = result["frames"], result["memory_kB"]

    def times(what):
        return " / ".join(f"{result[what][key]:.0f}" for key in ("median", "p99_9", "max"))

    return [name, f"{result['wall_time_s'] / 60:.1f} min", str(result["exit code"]),
            str(result["cycles"]), f"{result['late cycles']} (at most {result['most in a row']} in a row)",
            f"{frames['lost']} / {frames['late']} / {frames['held']}",
            times("cycle_time_us"), times("wake_up_us"),
            str(result["allocations"]),
            " / ".join(f"{memory[key] / 1024:.2f}" for key in ("after 10 s", "end", "most")),
            str(sum(result["uncounted"].values()))]


def table(results):
    head = ["machine", "time", "exit code", "cycles", "late cycles", "frames lost / late / filled in",
            "cycle time, us: median / 99.9 % / most", "woken late, us: the same", "allocations",
            "memory, MB: 10 s / end / most", "not counted"]
    rows = [head, ["---"] * len(head)]
    rows += [cells + [""] * (len(head) - len(cells)) for cells in
             (row(name, result) for name, result in results.items())]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in rows)


def prepare(options):
    """What each machine needs; machines that cannot be had, with the reason."""
    skipped = {}
    if "franka" in options.machines and (why := harness.FRANKA_SIM.make()):
        skipped["franka"] = why
    if "ethercat" in options.machines:
        if not options.segment.exists():
            skipped["ethercat"] = f"{options.segment} is not built"
        elif bus.INSIDE not in os.environ:  # returns only where it fails
            skipped["ethercat"] = bus.enter_namespace()
        else:
            bus.make_interfaces()
    return skipped


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--minutes", type=float, default=60.0)
    parser.add_argument("--machines", nargs="+", choices=MACHINES, default=list(MACHINES))
    parser.add_argument("--busy", action="store_true", help="what is late is counted and ends no run")
    parser.add_argument("--segment", type=pathlib.Path,
                        default=ROOT / "build" / "ethercat" / "release" / "segment")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build" / "soak" / "machines.json")
    options = parser.parse_args()
    program = options.program.resolve()
    skipped = prepare(options)
    remote_commands_test.PROGRAM = machine_test.PROGRAM = program
    machine_test.SEGMENT = options.segment.resolve()

    results, loads, begin = {}, [], time.time()
    threads = [threading.Thread(target=soak_one, args=(results, program, name, options))
               for name in options.machines if name not in skipped]
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        loads.append(os.getloadavg()[0])
        time.sleep(1)
    load = {"mean": sum(loads) / len(loads), "most": max(loads)} if loads else {}

    options.out.parent.mkdir(parents=True, exist_ok=True)
    options.out.write_text(json.dumps(
        {"begin": time.strftime("%F %T", time.gmtime(begin)), "processors": os.cpu_count(),
         "busy": options.busy, "load": load, "machines": results, "skipped": skipped}, indent=2) + "\n")
    print(f"\n{table(results)}\n")
    if load:
        print(f"{os.cpu_count()} processors, load {load['mean']:.1f} on average, {load['most']:.1f} at "
              f"most; {options.out}")
    wrong = {name: results.get(name, {"wrong": ["no result"]})["wrong"]
             for name in options.machines if name not in skipped}
    for name, what in wrong.items():
        if what:
            print(f"{name}: " + "; ".join(what))
    for name, why in skipped.items():
        print(f"{name}: skipped, {why}")
    return 1 if any(wrong.values()) else SKIPPED if skipped else 0


if __name__ == "__main__":
    sys.exit(main())
