"""What the tests of the driver share: servers, runs of the program, patience."""

import contextlib
import functools
import json
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "packages"))
from environment import make_environment  # noqa: E402

FOLDER = ROOT / "tests" / "franka"
ARM = ROOT / "models" / "arms" / "fr3" / "fr3.urdf"
PATIENCE = 60  # s
TOLERANT = "--without-time-limits"  # of a computer that is busy with other tests
BUSY = ("remote device is silent", "cycles came too late too often")
PROGRAM = pathlib.Path()  # set by franka_test.py


class Environment:
    """An environment of Python that is made when it is wanted."""

    def __init__(self, name):
        self.folder = ROOT / "build" / f"{name}_venv"
        self.python = self.folder / "bin" / "python"
        self.requirements = ROOT / "tools" / f"requirements-{name}.txt"

    def make(self):
        """Why it cannot be made, or nothing."""
        why = make_environment(self.folder, self.requirements)
        return f"{self.folder} cannot be made: {why}" if why else ""


FRANKA_SIM = Environment("franka")
FRANKY_SIM = Environment("franky")


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def listens(port):
    """Whether a program listens; asks the system, since a connection would be taken for a client."""
    lines = pathlib.Path("/proc/net/tcp").read_text().splitlines()[1:]
    fields = (line.split() for line in lines)
    return any(f[1].endswith(f":{port:04X}") and f[3] == "0A" for f in fields)


@contextlib.contextmanager
def listening(port, *command):
    """A server in a process of its own, ready when its port answers."""
    process = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               text=True)
    try:
        until = time.monotonic() + PATIENCE
        while process.poll() is None and time.monotonic() < until and not listens(port):
            time.sleep(0.1)
        if process.poll() is not None:
            raise AssertionError("the server has ended: " + process.stdout.read())
        yield process
    finally:
        process.kill()  # it keeps nothing
        process.communicate()


@contextlib.contextmanager
def robot(*arguments):
    """The port of a robot of franka-sim at 127.0.0.1."""
    port = free_port()
    with listening(port, FRANKA_SIM.python, FOLDER / "franka_server.py", ARM, "--port", str(port),
                   *arguments):
        yield port


@contextlib.contextmanager
def server(*arguments):
    """The address of a robot of franka-sim."""
    with robot(*arguments) as port:
        yield f"franka://127.0.0.1:{port}"


class Run:
    """A run of a scenario in a process of its own."""

    def __init__(self, address, duration_s, folder, *arguments, scenario="open_drawer"):
        self.summary_file = pathlib.Path(folder, "summary.json")
        self.process = subprocess.Popen(
            [PROGRAM, "run", "fr3/" + scenario, "--device", "fr3/fci", "--despite", "lateness",
             "--device-address", address,
             "--no-recording", "--no-viewer", "--flight-recorder", "off", "--duration",
             str(duration_s), "--summary", self.summary_file, *arguments],
            cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.most_s = 2 * duration_s + PATIENCE

    def wait(self):
        """Exit code, what it said, its summary (None: there is none)."""
        said, _ = self.process.communicate(timeout=self.most_s)
        has_summary = self.summary_file.exists() and self.summary_file.stat().st_size > 0
        return (self.process.returncode, said,
                json.loads(self.summary_file.read_text()) if has_summary else None)

    def wait_for(self, text):
        while line := self.process.stdout.readline():
            if text in line:
                return
        raise AssertionError("never said: " + text)

    def be_silent(self, seconds):
        self.process.send_signal(signal.SIGSTOP)
        time.sleep(seconds)
        self.process.send_signal(signal.SIGCONT)


def run(address, duration_s, *arguments, scenario="open_drawer"):
    with tempfile.TemporaryDirectory() as folder:
        return Run(address, duration_s, folder, *arguments, scenario=scenario).wait()


def patiently(test):
    """Repeats a test in which this computer was so busy that server or recorder paused: for 50 ms, or
    so that the frames came in bunches."""
    @functools.wraps(test)
    def repeated(self):
        for attempt in range(1, 4):
            try:
                return test(self)
            except AssertionError as error:
                if attempt == 3 or not any(words in str(error) for words in BUSY):
                    raise
    return repeated
