"""Hands that `hapticgiant experiment hands` has kept, played again by a simulation of others: the HapticGiant in MuJoCo.

    hands_in_mujoco.py BUILD PROGRAM FOLDER [--law LAW] [--jobs N]

FOLDER: where `experiment hands ... -o FOLDER` has put its scenarios; those of other devices are left out. For each hand, the
fault that ended its run (0: none) and the largest excess over a limit of joints, sums, walls and gantry, from the states of
MuJoCo, beside those of our own plant (without the gantry's ends). Exit codes: 0 no fault and no excess above 2 mrad or 1 mm
in MuJoCo, 1 some, 2 a hand could not be played, 77 no MuJoCo (pip install -r tools/requirements-test.txt).
"""

import argparse
import concurrent.futures
import contextlib
import io
import json
import os
import pathlib
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
    """Rule that ended the run (0: none), and its summary. Raises RuntimeError where there is none."""
    with tempfile.NamedTemporaryFile(suffix=".json") as summary:
        done = subprocess.run([program, "run", scenario, *arguments, "--fast", "--no-recording", "--summary", summary.name],
                              cwd=ROOT, capture_output=True, text=True)
        text = pathlib.Path(summary.name).read_text()
        if not text:
            raise RuntimeError(f"{scenario.name}: exit code {done.returncode}: {done.stderr.strip()}")
        result = json.loads(text)
        return result["fault"]["code"] if result.get("fault") else 0, result


def compare(program, site, scenario, law):
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

    processors = sorted(os.sched_getaffinity(0))
    os.sched_setaffinity(0, [processors[os.getpid() % len(processors)]])  # server and client take turns
    try:
        with contextlib.redirect_stdout(io.StringIO()):  # of the server
            server = Watched("127.0.0.1:0", hapticgiant.load_scenario(str(scenario)), is_lock_step=True)
            threading.Thread(target=server.serve, daemon=True).start()
            port = server.socket.getsockname()[1]
            there, _ = play(program, scenario, *law, "--device-address", f"127.0.0.1:{port}")
            here, summary = play(program, scenario, *law)
    finally:
        os.sched_setaffinity(0, processors)
    ours = {name: limit["worst_violation"] for name, limit in summary["reality"]["limits"].items()
            if name in server.excess.most}
    return scenario.stem, there, worst(server.excess.most), here, worst(ours)


def scenarios_in(folder):
    """Kept hands of the HapticGiant."""
    import yaml

    files = [each.resolve() for each in sorted(folder.glob("*.yaml")) if not each.stem.endswith("_person")]
    return [each for each in files
            if (each.parent / yaml.safe_load(each.read_text())["device"]).resolve() == DEVICE]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--law", help="as that of experiment hands; default: the device's")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    arguments = parser.parse_args()
    try:
        import mujoco  # noqa: F401
    except ImportError as error:
        print(f"{error}: pip install -r tools/requirements-test.txt")
        return SKIPPED
    from python_package_test import install

    scenarios = scenarios_in(arguments.folder)
    if not scenarios:
        print(f"{arguments.folder}: no scenario of {DEVICE}, expected what experiment hands -o FOLDER keeps", file=sys.stderr)
        return 2
    law = ["--law", arguments.law] if arguments.law else []
    good = failed = 0
    with tempfile.TemporaryDirectory() as site, concurrent.futures.ProcessPoolExecutor(arguments.jobs) as pool:
        install(arguments.build, pathlib.Path(site) / "site")
        print("hand,fault in MuJoCo,largest excess there,fault,largest excess with our plant", flush=True)
        runs = [pool.submit(compare, arguments.program.resolve(), f"{site}/site", each, law) for each in scenarios]
        for run in concurrent.futures.as_completed(runs):
            try:
                name, there, (share, text), here, (_, own) = run.result()
            except Exception as error:  # of this hand only
                failed += 1
                print(f"not played: {error}", file=sys.stderr, flush=True)
                continue
            good += there == 0 and share <= 1.0
            print(f"{name},{there},{text},{here},{own}", flush=True)
    print(f"{good} of {len(scenarios)} hands end without a fault and leave no limit in MuJoCo; {failed} were not played")
    return 2 if failed else 0 if good == len(scenarios) else 1


if __name__ == "__main__":
    sys.exit(main())
