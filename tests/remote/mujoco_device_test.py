"""The door on a device in MuJoCo, behind the wire: the same events as with our own plant.

    mujoco_device_test.py BUILD PROGRAM

The package hapticgiant is put into the build folder first. Exits with 77, which CTest takes for
skipped, where MuJoCo is missing (pip install -r tools/requirements-test.txt).
"""

import json
import os
import pathlib
import socket
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SKIPPED = 77
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


def main(build, program):
    with tempfile.TemporaryDirectory() as folder:
        install(pathlib.Path(build), pathlib.Path(folder))
        address = f"127.0.0.1:{free_port()}"
        server = subprocess.Popen(
            [sys.executable, ROOT / "examples" / "python" / "mujoco_device.py", "door", "--listen",
             address, "--fast"], env={**os.environ, "PYTHONPATH": folder}, cwd=folder)
        try:
            summary = pathlib.Path(folder, "summary.json")
            for _ in range(20):  # the server needs its time to begin
                done = subprocess.run([program, "run", "door", "--fast", "--no-recording",
                                       "--device-address", address, "--summary", summary], cwd=ROOT)
                if done.returncode != 2:
                    break
        finally:
            server.terminate()
            server.wait()
        assert done.returncode == 0, f"exit code {done.returncode}"
        events = json.loads(summary.read_text())["events"]
        assert len(events) == 8, events


if __name__ == "__main__":
    main(*sys.argv[1:])
