"""A scenario on a device in MuJoCo, behind the wire and with a key: the same events as with our own plant.

    mujoco_device_test.py BUILD PROGRAM SCENARIO [RATE_HZ ...]

At 1 and 2 kHz by default. The package hapticgiant is put into the build folder first.
Exits with 77, which CTest takes for skipped, where MuJoCo is missing
(pip install -r tools/requirements-test.txt).
"""

import json
import os
import pathlib
import random
import socket
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
SKIPPED = 77
# between two plants with different friction, steps and errors of sensors; measured: at most 0.04 s
TOLERANCE_S = 0.1
sys.path.insert(0, str(ROOT / "tests" / "packages"))
from python_package_test import install  # noqa: E402

try:
    import mujoco  # noqa: F401
except ImportError as error:
    print(f"{error}: pip install -r tools/requirements-test.txt")
    sys.exit(SKIPPED)


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as found:
        found.bind(("127.0.0.1", 0))
        return found.getsockname()[1]


def events_of(summary):
    return {event["name"]: event["time_s"] for event in json.loads(summary.read_text())["events"]}


def run(program, summary, *arguments):
    """Its exit code."""
    return subprocess.run([program, "run", *arguments, "--fast", "--no-recording", "--summary",
                           summary], cwd=ROOT).returncode


def events_in_mujoco(program, scenario, rate_Hz, folder):
    address, summary = f"127.0.0.1:{free_port()}", folder / "there.json"
    key = folder / "key"
    key.touch(0o600)
    key.write_bytes(os.urandom(32))
    server = subprocess.Popen(
        [sys.executable, ROOT / "examples" / "python" / "mujoco_device.py", scenario, "--listen",
         address, "--fast", "--rate-hz", rate_Hz, "--key-file", key],
        env={**os.environ, "PYTHONPATH": str(folder / "package")}, cwd=folder)
    try:
        for _ in range(20):  # the server needs its time to begin
            code = run(program, summary, scenario, "--rate-hz", rate_Hz, "--device-address", address,
                       "--key-file", key)
            if code != 2:
                break
    finally:
        server.terminate()
        server.wait()
    assert code == 0, f"exit code {code}"
    return events_of(summary)


def take_turns_on_one_processor():
    """Server and client never run at the same time, and wake each other in half the time there."""
    os.sched_setaffinity(0, [random.choice(list(os.sched_getaffinity(0)))])


def main(build, program, scenario, *rates_Hz):
    take_turns_on_one_processor()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        install(pathlib.Path(build), folder / "package")
        for rate_Hz in rates_Hz or ("1000", "2000"):
            begin = time.monotonic()
            there = events_in_mujoco(program, scenario, rate_Hz, folder)
            seconds = time.monotonic() - begin
            code = run(program, folder / "here.json", scenario, "--rate-hz", rate_Hz)
            assert code == 0, f"exit code {code} with our own plant"
            here = events_of(folder / "here.json")
            assert list(there) == list(here), f"{list(there)}, with our own plant {list(here)}"
            assert here
            differences_s = {event: there[event] - here[event] for event in here}
            worst = max(differences_s, key=lambda event: abs(differences_s[event]))
            print(f"{scenario} at {rate_Hz} Hz in MuJoCo: {len(there)} events in {seconds:.0f} s, at "
                  f"most {differences_s[worst]:+.3f} s ({worst}) from our own plant", flush=True)
            assert abs(differences_s[worst]) < TOLERANCE_S, differences_s


if __name__ == "__main__":
    main(*sys.argv[1:])
