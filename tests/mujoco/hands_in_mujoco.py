"""Hands that `hapticgiant experiment hands` has kept, played again by a simulation of others: the HapticGiant in MuJoCo.

    hands_in_mujoco.py BUILD PROGRAM FOLDER [--jobs N]

FOLDER: where `experiment hands ... -o FOLDER` has put its scenarios. For each of them, the fault that ended it (0: none)
and the largest excess over a limit of joints, sums, walls and gantry, from the states of MuJoCo, beside those of our own
plant. The package hapticgiant is put into the build folder first. Exit codes: 0 no fault and no excess above 2 mrad or
1 mm in MuJoCo, 1 some, 77 no MuJoCo (pip install -r tools/requirements-test.txt).
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import socket
import subprocess
import sys
import tempfile
import threading

ROOT = pathlib.Path(__file__).resolve().parents[2]
DEVICE = ROOT / "models" / "haptic_giant" / "device.yaml"
SKIPPED, MOST_RAD, MOST_M = 77, 2e-3, 1e-3
ELBOW_IN_M3 = (0.0, 0.0, -0.75)  # m; haptic_giant.urdf
sys.path[:0] = [str(ROOT / "tests" / "packages"), str(ROOT / "examples" / "python")]


class Excess:
    """The largest excess over each limit, from MuJoCo's state."""

    def __init__(self, world):
        import yaml

        self.world, self.most = world, {}
        device = yaml.safe_load(DEVICE.read_text())
        self.boxes = {box["name"]: box for box in device["cartesian_limits"]}
        self.sums = device["virtual_joints"]
        self.ranges = {name: world.model.joint(name).range.copy()
                       for name in device["gantry"] + device["manipulator"] if world.model.joint(name).limited}

    def take(self, name, value, least, most):
        self.most[name] = max(self.most.get(name, 0.0), least - value, value - most)

    def look(self):
        data = self.world.data
        q = {name: float(data.joint(name).qpos[0]) for name in ["ppu1", "ppu2"] + [f"m{i}" for i in range(1, 7)]}
        for name, (least, most) in self.ranges.items():
            self.take(name, q[name], least, most)
        for each in self.sums:
            value = sum(weight * q[joint] for joint, weight in each["weights"].items())
            self.take(each["name"], value, each["q_min_rad"], each["q_max_rad"])
        arm = data.body("m3")
        points = {"hand": self.world.handle, "elbow": arm.xpos + arm.xmat.reshape(3, 3) @ ELBOW_IN_M3}
        for name, point in points.items():
            for axis, value in zip("xyz", point):
                if axis in self.boxes[name]:
                    box = self.boxes[name][axis]
                    self.take(f"{name} {axis}", float(value), box["q_min_m"], box["q_max_m"])


def is_length(name):
    return " " in name or name.startswith("ppu")


def worst(excess):
    """Name and text of the largest excess in units of what is tolerated."""
    def share(name):
        return excess[name] / (MOST_M if is_length(name) else MOST_RAD)

    name = max(excess, key=share)
    unit = "mm" if is_length(name) else "mrad"
    return share(name), f"{1e3 * excess[name]:.2f} {unit} {name}" if excess[name] > 0.0 else "none"


def play(program, scenario, *arguments):
    """Rule that ended the run (0: none), and its summary; None where it did not begin."""
    with tempfile.NamedTemporaryFile(suffix=".json") as summary:
        done = subprocess.run([program, "run", scenario, *arguments, "--fast", "--no-recording", "--summary", summary.name],
                              cwd=ROOT, capture_output=True, text=True)
        if done.returncode == 2:
            raise RuntimeError(done.stderr)
        fault = re.search(r"^ +FAULT +(\d+)", done.stdout + done.stderr, re.MULTILINE)
        return int(fault[1]) if fault else 0, json.loads(pathlib.Path(summary.name).read_text())


def compare(program, site, scenario):
    """The fault and the excess of one scenario in MuJoCo and with our own plant."""
    sys.path.insert(0, site)
    import hapticgiant
    import mujoco_device

    class Watched(mujoco_device.Server):
        excess = None

        def lock_step(self, world):
            self.excess, live = Excess(world), world.live

            def live_and_look(command):
                live(command)
                self.excess.look()

            world.live = live_and_look
            super().lock_step(world)

    os.sched_setaffinity(0, [os.getpid() % os.cpu_count()])  # server and client take turns
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        address = f"127.0.0.1:{free.getsockname()[1]}"
    server = Watched(address, hapticgiant.load_scenario(scenario), is_lock_step=True)
    threading.Thread(target=server.serve, daemon=True).start()
    there, _ = play(program, scenario, "--device-address", address)
    here, summary = play(program, scenario)
    ours = {name: limit["worst_violation"] for name, limit in summary["reality"]["limits"].items()
            if name in server.excess.most}
    return scenario.stem, there, worst(server.excess.most), here, worst(ours)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    try:
        import mujoco  # noqa: F401
    except ImportError as error:
        print(f"{error}: pip install -r tools/requirements-test.txt")
        return SKIPPED
    from python_package_test import install

    scenarios = sorted(each for each in arguments.folder.glob("*.yaml") if not each.stem.endswith("_person"))
    bad = 0
    with tempfile.TemporaryDirectory() as site, concurrent.futures.ProcessPoolExecutor(arguments.jobs) as pool:
        install(arguments.build, pathlib.Path(site) / "site")
        print("hand,fault in MuJoCo,largest excess there,fault,largest excess with our plant", flush=True)
        runs = [pool.submit(compare, arguments.program, f"{site}/site", each.resolve()) for each in scenarios]
        for run in concurrent.futures.as_completed(runs):
            name, there, (share, text), here, (_, own) = run.result()
            bad += there != 0 or share > 1.0
            print(f"{name},{there},{text},{here},{own}", flush=True)
    print(f"{len(scenarios) - bad} of {len(scenarios)} hands end without a fault and leave no limit in MuJoCo")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
