"""What a moving device does when the process that controls it fails: terminal, disk, memory, processors, or the process.

    process_faults_test.py BUILD PROGRAM [--repetitions N] [--seed N] [--fault NAME]

The device is served here in real time, and the controller is
a `hapticgiant run`. The stop is a SIGTERM 0.3 s after the fault; for a controller that is frozen, suspended or killed
the fault itself. The true motion of the axes is measured from the stop on. A case is bad where an axis moves farther than
its stopping distance, does not come to rest, or gives the person more than 30 J; where the controller does not end in
time, does not report what its exit code has to report, or loses more than the last second of its recording. A run that
ends before its fault is played again, but for a crash: device or controller were held up, which says nothing of the fault.
Exit codes: 0 all cases are good, 1 some are not.
"""

import argparse
import dataclasses
import math
import multiprocessing
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "packages"))
from python_package_test import install  # noqa: E402

SCENARIO = pathlib.Path("models/scenarios/walk.yaml")
DEVICE = pathlib.Path("models/haptic_giant/device.yaml")
FAULT_TIMES_S = (2.0, 6.0)  # 1 to 5 s after the hand has grasped the handle
UNTIL_RUNNING_S, UNTIL_ENDED_S, FAULT_TO_STOP_S, FROZEN_S = 60.0, 30.0, 0.3, 1.0
WATCHED_AFTER_S = 1.0  # the session
ENERGY_BOUND_J = 30.0
UNWRITTEN = 1000  # samples that a recording may lack at its end
FAULTED = 3  # exit code of a run that a fault of the device has ended
TRIES = 10  # of a run that ends before its fault: a busy computer holds it up, for whatever limit is the first to see it


@dataclasses.dataclass(frozen=True)
class Fault:
    name: str
    what: str
    may_die: bool = False  # the controller may end by a signal
    is_recorded: bool = True  # but for the end
    is_reported: bool = False  # by an exit code other than 0
    is_stop: bool = False  # no more commands arrive: the device has to stop on its own


FAULTS = (
    Fault("none", "only the stop"),
    Fault("terminal_stalled", "its output is not read"),
    Fault("terminal_closed", "what it prints has no reader"),
    Fault("disk_full", "no file may grow", is_recorded=False, is_reported=True),
    Fault("folder_gone", "its recording is deleted", is_recorded=False, is_reported=True),
    Fault("no_descriptors", "it may open nothing more"),
    Fault("no_memory", "it gets no more memory", may_die=True, is_recorded=False),
    Fault("processors_busy", "others take all processors", is_recorded=False),
    Fault("frozen", "it is suspended for a second", is_reported=True, is_stop=True),
    Fault("suspended", "it is suspended for good", may_die=True, is_stop=True),
    Fault("killed", "kill -9", may_die=True, is_stop=True))
LIMITS = {"disk_full": resource.RLIMIT_FSIZE, "no_descriptors": resource.RLIMIT_NOFILE, "no_memory": resource.RLIMIT_AS}


class Controller:
    """A run that controls a device at an address; its output is a pipe."""

    def __init__(self, program, address, folder):
        self.terminal, self.program_end = os.pipe()
        self.process = subprocess.Popen(
            [program, "run", SCENARIO, "--device-address", address, "--recordings", folder, "--port", "0", "--no-browser",
             "--priority", "0"], stdin=subprocess.DEVNULL, stdout=self.program_end, stderr=self.program_end)
        os.set_blocking(self.terminal, False)
        self.is_read = True
        self.said = b""

    def has_ended(self):
        return self.process.poll() is not None

    def read(self):
        """Takes what it has printed, as a terminal does."""
        try:
            while self.is_read and (text := os.read(self.terminal, 4096)):
                self.said += text
        except BlockingIOError:
            pass

    def stall(self):
        self.is_read = False
        other = os.open(f"/proc/self/fd/{self.program_end}", os.O_WRONLY | os.O_NONBLOCK)
        for size in (4096, 1):
            try:
                while os.write(other, bytes(size)):
                    pass
            except BlockingIOError:
                pass
        os.close(other)

    def hang_up(self):
        self.is_read = False
        os.close(self.program_end)
        os.close(self.terminal)
        self.terminal = self.program_end = None

    def close(self):
        if not self.has_ended():
            self.process.kill()
        self.process.wait()
        for end in (self.terminal, self.program_end):
            if end is not None:
                os.close(end)


def occupy():
    while True:
        pass


def apply(fault, controller, folder, load):
    """Begins a fault; `load` takes processes that have to be ended."""
    if fault.name == "terminal_stalled":
        controller.stall()
    elif fault.name == "terminal_closed":
        controller.hang_up()
    elif fault.name in LIMITS:
        resource.prlimit(controller.process.pid, LIMITS[fault.name], (0, 0))
    elif fault.name == "folder_gone":
        for _ in range(3):  # something may be written there just now
            shutil.rmtree(folder, ignore_errors=True)
    elif fault.name == "processors_busy":
        for _ in range(4 * os.cpu_count()):
            load.append(multiprocessing.get_context("fork").Process(target=occupy, daemon=True))
            load[-1].start()
    elif fault.name in ("frozen", "suspended"):
        controller.process.send_signal(signal.SIGSTOP)
    elif fault.name == "killed":
        controller.process.kill()


@dataclasses.dataclass
class Case:
    fault: Fault
    has_run: bool = False
    has_crashed: bool = False  # before its fault, or ended otherwise than by a fault or its stop
    has_ended: bool = False
    exit_code: int = -1  # -1: ended by a signal
    periods: int = 0  # of the device with this controller, until the stop
    recorded: int = 0  # samples
    motion: object = None

    def is_good(self):
        expected, motion = self.fault, self.motion
        return (self.has_run and not math.isnan(motion.rest_s) and motion.travel_share <= 1.0
                and motion.most_energy_J <= ENERGY_BOUND_J
                and (expected.may_die or self.has_ended and self.exit_code >= 0)
                and (not expected.is_reported or self.exit_code != 0)
                and (not expected.is_recorded or self.recorded + UNWRITTEN >= self.periods))

    def line(self):
        rest = "never" if math.isnan(self.motion.rest_s) else f"{1e3 * self.motion.rest_s:.0f}"
        verdict = "" if self.is_good() else "  BAD" if self.has_run else "  BAD: it did not run"
        return (f"{self.fault.name:17}{rest:>11}{100 * self.motion.travel_share:7.0f}{self.motion.most_energy_J:6.1f}"
                f"{self.exit_code if self.exit_code >= 0 else '-':>6}{self.periods:9}{self.recorded:10}  "
                f"{self.fault.what}{verdict}")


def samples_in(folder):
    """Samples of the longest recording in a folder, as far as it can be read."""
    from mcap.records import Channel, Message
    from mcap.stream_reader import StreamReader

    most = 0
    for file in folder.glob("*.mcap") if folder.is_dir() else ():
        if file.is_symlink():
            continue
        count, channel = 0, None
        try:
            with open(file, "rb") as stream:
                for record in StreamReader(stream).records:
                    if isinstance(record, Channel) and record.topic == "/hapticgiant/sample":
                        channel = record.id
                    count += isinstance(record, Message) and record.channel_id == channel
        except Exception as error:  # what a crash has cut
            print(f"    {file.name}: {type(error).__name__} {error}")
        most = max(most, count)
    return most


def play(program, fault, at_s):
    """One fault in one run."""
    import yaml
    from served_device import Motion, ServedDevice

    monitor = yaml.safe_load(DEVICE.read_text())["monitor"]
    case = Case(fault, motion=Motion(monitor["stop_distance_rad"], monitor["gantry_stop_distance_m"]))
    load = []
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch) / "recordings"
        device = ServedDevice(SCENARIO, case.motion)
        controller = Controller(program, device.address, folder)

        def advance(until_s, has_happened=lambda: False):
            """Lets the device live until a time, or until something has happened: whether it has."""
            while time.monotonic() < until_s:
                if has_happened():
                    return True
                device.advance()
                controller.read()
            return has_happened()

        def is_due():
            return has_failed() or device.is_on and device.periods * device.dt > at_s

        def has_failed():
            return controller.has_ended() or device.was_on and not device.is_on

        try:
            case.has_run = advance(time.monotonic() + UNTIL_RUNNING_S, is_due) and not has_failed()
            if not case.has_run:
                controller.process.send_signal(signal.SIGTERM)
                advance(time.monotonic() + UNTIL_ENDED_S, controller.has_ended)
                controller.read()
                case.has_crashed = controller.process.poll() not in (0, FAULTED)  # 0: the stop found it while it ended
                print(f"{controller.said.decode(errors='replace')}\nended before {fault.name}: {controller.process.poll()}")
                return case
            device.is_watched = fault.is_stop
            apply(fault, controller, folder, load)
            advance(time.monotonic() + (FROZEN_S if fault.name == "frozen" else 0.0 if fault.is_stop else FAULT_TO_STOP_S))
            if fault.name == "frozen":
                controller.process.send_signal(signal.SIGCONT)
            device.is_watched = True
            case.periods = device.periods
            controller.process.send_signal(signal.SIGTERM)

            def has_ended():
                return device.state == "alone" and (fault.name == "suspended" or controller.has_ended())

            case.has_ended = advance(time.monotonic() + UNTIL_ENDED_S, has_ended)
            advance(time.monotonic() + WATCHED_AFTER_S)
            case.exit_code = controller.process.poll() if controller.has_ended() else -1
        finally:
            for each in load:
                each.kill()
            controller.close()
            device.close()
        case.recorded = samples_in(folder)
    return case


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path, help="folder that the Python package was built in")
    parser.add_argument("program")
    parser.add_argument("--repetitions", type=int, default=1)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--fault", choices=[fault.name for fault in FAULTS], action="append")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as site:
        install(arguments.build, pathlib.Path(site) / "site")
        sys.path.insert(0, str(pathlib.Path(site) / "site"))
        return play_all(arguments)


def keep_time():
    """The device is a machine of its own: where it is permitted, it runs before the processes of this computer."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(1))
    except PermissionError:
        print("no permission for real time: on a busy computer the device is late")


def play_all(arguments):
    """Plays the faults and prints a line for each; the exit code."""
    keep_time()
    dice = random.Random(arguments.seed)
    cases = []
    print("fault            at rest ms  way %     J  exit  periods  recorded  what goes wrong", flush=True)
    for _ in range(arguments.repetitions):
        for fault in FAULTS:
            at_s = dice.uniform(*FAULT_TIMES_S)
            if arguments.fault and fault.name not in arguments.fault:
                continue
            for _ in range(TRIES):
                case = play(arguments.program, fault, at_s)
                if case.has_run or case.has_crashed:
                    break
            cases.append(case)
            print(case.line(), flush=True)
    bad = sum(not case.is_good() for case in cases)
    print(f"\nat rest: from the stop until all axes of the device stood still; way: from there on, of the stopping distance;\n"
          f"J: given to the person.\n{bad} of {len(cases)} cases are bad")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
