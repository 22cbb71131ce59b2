"""An arm in MuJoCo, behind the wire and with a key, is led through tasks by a scripted hand.

    mujoco_remote_test.py BUILD PROGRAM [DELAY_S ...]

Each task with one method; with delays each with every method over links of these delays. What was done
is judged by what MuJoCo knows. The package hapticgiant is put into a folder first. Exits with 77, which CTest takes for skipped,
where MuJoCo is missing (pip install -r tools/requirements-test.txt).
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

from mujoco_device_test import ROOT, free_port, take_turns_on_one_processor
from python_package_test import install

METHODS = ["position_force", "four_channel", "wave_variables", "passivity_control", "model_mediated"]
ONE = {"wall": "model_mediated", "drawer": "position_force", "peg": "model_mediated"}


def led(program, folder, task, method, delay_s):
    """What the arm has done, its last news, and the exit code of the run."""
    address, key = f"127.0.0.1:{free_port()}", folder / "key"
    if not key.exists():
        key.touch(0o600)
        key.write_bytes(os.urandom(32))
    server = subprocess.Popen(
        [sys.executable, ROOT / "examples" / "python" / "mujoco_remote.py", task, "--listen", address,
         "--fast", "--once", "--key-file", key], stdout=subprocess.PIPE, text=True, cwd=folder,
        env={**os.environ, "PYTHONPATH": str(folder / "package")})
    try:
        assert server.stdout.readline().startswith(task), "the server does not begin"
        code = subprocess.run(
            [program, "run", "remote_arm", "--user", f"remote_{task}", "--fast", "--no-recording",
             "--set", f"scenario.teleoperation.remote.udp={address}",
             "--set", f"scenario.teleoperation.remote.key_file={key}",
             "--set", f"scenario.teleoperation.method={method}",
             "--set", f"scenario.teleoperation.link.delay_s={delay_s}",
             "--set", "scenario.teleoperation.link.jitter_s=0",
             "--set", "scenario.teleoperation.link.loss=0"],
            cwd=ROOT, stdout=subprocess.DEVNULL).returncode
        *news, result = server.communicate(timeout=60)[0].splitlines()
    finally:
        server.kill()
        server.wait()
    return json.loads(result), news, code


def main(build, program, *delays_s):
    take_turns_on_one_processor()
    cases = [(task, method, delay_s) for delay_s in delays_s for task in ONE for method in METHODS]
    cases = cases or [(task, method, "0") for task, method in ONE.items()]
    failed = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        install(pathlib.Path(build), folder / "package")
        print(f"{'task':8} {'method':20} {'delay s':>8} {'done':5} {'most N':>8} {'way m':>8}")
        for task, method, delay_s in cases:
            result, news, code = led(pathlib.Path(program).resolve(), folder, task, method,
                                     delay_s)
            print(f"{task:8} {method:20} {delay_s:>8} {'yes' if result['success'] else 'NO':5} "
                  f"{result['force_max_N']:8.1f} {result['distance_m']:8.3f}", flush=True)
            if code != 0 or not result["success"] or "follows" not in news:
                failed.append((task, method, delay_s, code, result, news))
    assert not failed, failed


if __name__ == "__main__":
    main(*sys.argv[1:])
