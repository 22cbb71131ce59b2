"""What the tests of the ROS 1 bridge share: a master, runs of the program, the bridge, rviz."""

import contextlib
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "bridges/ros1"
BRIDGE = ROOT / "build/ros1/devel/lib/hapticgiant_bridge/hapticgiant_bridge"
PATIENCE_S = 60.0
PROGRAM = pathlib.Path()  # set by ros1_test.py


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def until(condition, what, patience_s=PATIENCE_S):
    """The first value of `condition` that is not false."""
    end = time.monotonic() + patience_s
    while time.monotonic() < end:
        if value := condition():
            return value
        time.sleep(0.05)
    raise AssertionError(f"not within {patience_s:.0f} s: {what}")


def stop(process, with_signal=signal.SIGINT):
    if process.poll() is None:
        process.send_signal(with_signal)
    try:
        process.wait(20)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


class World:
    """Folders and environment of one test: nothing of this user's ROS is seen or changed."""

    def __init__(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="hapticgiant_ros1_"))
        (self.folder / "runtime").mkdir(mode=0o700)
        self.port = free_port()
        os.environ.update({
            "ROS_MASTER_URI": f"http://127.0.0.1:{self.port}", "ROS_IP": "127.0.0.1",
            "ROS_HOME": str(self.folder / "ros"), "ROS_LOG_DIR": str(self.folder / "ros/log"),
            "ROS_PACKAGE_PATH": f"{PACKAGE}:/usr/share", "QT_X11_NO_MITSHM": "1",
            "XDG_RUNTIME_DIR": str(self.folder / "runtime"), "LIBGL_ALWAYS_SOFTWARE": "1"})
        self.processes = []

    def start(self, *command, log=None, **options):
        with open(self.folder / (log or f"{pathlib.Path(command[0]).name}.log"), "a") as out:
            process = subprocess.Popen([str(word) for word in command], stdout=out,
                                       stderr=subprocess.STDOUT, cwd=ROOT, **options)
        self.processes.append(process)
        return process

    def said(self, log):
        return (self.folder / log).read_text()

    def start_master(self):
        master = self.start("/usr/bin/rosmaster", "--core", "-p", self.port)
        until(lambda: is_open(self.port), "the master listens")
        return master

    def start_bridge(self, *arguments):
        return self.start(BRIDGE, *arguments, log="bridge.log")

    def run(self, *arguments):
        """A run of the door in real time, ready when it is seen by bridges."""
        recordings = tempfile.mkdtemp(dir=self.folder)
        log = f"run_{len(self.processes)}.log"
        process = self.start(PROGRAM, "run", "--no-browser", "--recordings", recordings, *arguments,
                             log=log)
        until(lambda: process.poll() is not None or "page  " in self.said(log), "the page is there")
        if process.poll() is not None:
            raise AssertionError(self.said(log))
        link = re.search(r"http://\S+", self.said(log))[0]
        return Run(process, link, pathlib.Path(recordings))

    def close(self):
        for process in reversed(self.processes):
            stop(process)
        shutil.rmtree(self.folder, ignore_errors=True)


class Run:
    def __init__(self, process, link, recordings):
        self.process, self.link, self.recordings = process, link, recordings

    def recorded(self, *topics):
        """Messages of the recording, once the run has ended: {topic: [message, ...]}."""
        text = subprocess.run([ROOT / ".venv/bin/python", ROOT / "tests/ros1/recorded.py",
                               self.recordings / "latest.mcap", *topics],
                              check=True, capture_output=True, text=True).stdout
        found = {topic: [] for topic in topics}
        for line in text.splitlines():
            message = json.loads(line)
            found[message["topic"]].append(message)
        return found


def is_open(port):
    with contextlib.closing(socket.socket()) as one:
        return one.connect_ex(("127.0.0.1", port)) == 0


class Screen:
    """An X server without a screen, and pictures of it."""

    SIZE = (1400, 900)

    def __init__(self, world):
        read, write = os.pipe()
        self.process = world.start(
            "/usr/bin/Xvfb", "-displayfd", write, "-screen", "0", "{}x{}x24".format(*self.SIZE),
            "-nolisten", "tcp", pass_fds=[write])
        os.close(write)
        with os.fdopen(read) as pipe:
            os.environ["DISPLAY"] = ":" + pipe.readline().strip()

    def picture(self, file=None):
        """What is on the screen: rows of pixels as bytes RGB; also written to `file` (PNG)."""
        ppm = subprocess.run(["import", "-window", "root", "-depth", "8", "ppm:-"], check=True,
                             capture_output=True).stdout
        if file is not None:  # few colours: a small file
            subprocess.run(["convert", "ppm:-", "+dither", "-colors", "200", f"png8:{file}"], input=ppm,
                           check=True)
        return ppm.split(b"\n", 3)[3]


def plain(message):
    """A message of ROS as dictionaries, lists and numbers, without what ROS 2 does not have."""
    if hasattr(message, "to_nsec"):
        return message.to_nsec()
    if hasattr(message, "__slots__"):
        return {name: plain(getattr(message, name)) for name in message.__slots__
                if name != "seq"}
    if isinstance(message, (list, tuple)):
        return [plain(item) for item in message]
    return message
