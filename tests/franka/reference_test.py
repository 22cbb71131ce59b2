"""The driver beside libfranka, the maker's client: the same jobs with the same server, through a recorder.

What both send must be the same byte for byte, apart from what each chooses: its UDP port, the numbers
of states, the torques. What the robot answers, and the errors that come of it, must be the same, too.
"""

import json
import re
import struct
import subprocess
import tempfile
import time
import unittest

from harness import FOLDER, FRANKA_SIM, PATIENCE, TOLERANT, Run, patiently, robot, run
from recorder import CONNECT, FINISHED, PORT, Recorder

MOVE, STOP_MOVE, COLLISION, LOAD, RECOVERY = 1, 2, 3, 9, 10
STARTED, PREEMPTED, REFLEX_ABORTED = 1, 2, 8  # answers to Move
TORQUES = struct.Struct("<7d")
TORQUES_AT = FINISHED - TORQUES.size
SPEEDS = struct.Struct("<7d")
SPEEDS_AT = 64  # behind number and positions
STATE_NUMBER = 8  # bytes, the first


def libfranka(host, what, **settings):
    """What reference_client.py says."""
    arguments = [f"--{name}={json.dumps(value)}" for name, value in settings.items()]
    done = subprocess.run([FRANKA_SIM.python, FOLDER / "reference_client.py", host, what, *arguments],
                          capture_output=True, text=True, timeout=PATIENCE)
    if done.returncode != 0:
        raise AssertionError(done.stdout + done.stderr)
    return json.loads(done.stdout)


def drive(recorder, duration_s, *, by=""):
    return run(f"franka://{recorder.host}:{PORT}{by}", duration_s)


def without_choices(command):
    """A command of a motion without the number of its state and without its torques."""
    return command[STATE_NUMBER:TORQUES_AT] + command[FINISHED:]


def without_speeds(command):
    """A command of a motion without the number of its state and without its speeds."""
    return command[STATE_NUMBER:SPEEDS_AT] + command[SPEEDS_AT + SPEEDS.size:]


def names(errors):
    return set(re.findall(r"[a-z]+(?:_[a-zA-Z]+)+", errors))


class Reference(unittest.TestCase):
    def same(self, ours, theirs, command):
        """Both sent this command, with the same body."""
        self.assertTrue(ours.of(command) and theirs.of(command), command)
        self.assertEqual(ours.of(command)[0], theirs.of(command)[0], command)

    def answers(self, recorder, command):
        return [status for kind, status in recorder.answers if kind == command]

    @patiently
    def test_sends_the_same_bytes(self):
        with robot(TOLERANT) as port:
            with Recorder(port) as ours:
                code, said, _ = drive(ours, 2)
                self.assertEqual(code, 0, said)
            limits = struct.unpack("<28d24d", ours.of(COLLISION)[0])
            torque, force = limits[7:14], limits[34:40]
            mass, *rest = struct.unpack("<13d", ours.of(LOAD)[0])
            with Recorder(port) as theirs:
                said = libfranka(theirs.host, "run", thresholds=[torque, torque, force, force],
                                 load=[mass, rest[:3], rest[3:]])
                self.assertEqual(said["error"], "")
        for command in (COLLISION, LOAD, MOVE):
            self.same(ours, theirs, command)
        self.assertEqual(len(ours.of(CONNECT)[0]), len(theirs.of(CONNECT)[0]))
        self.assertEqual(ours.of(CONNECT)[0][:2], theirs.of(CONNECT)[0][:2])  # version
        self.assertEqual(self.answers(ours, MOVE), self.answers(theirs, MOVE))
        # commands of the motion: on its way, and its end
        self.assertEqual({len(command) for command in ours.commands},
                         {len(command) for command in theirs.commands})
        forms = {without_choices(command) for command in ours.commands}
        self.assertEqual(len(forms), 2)
        self.assertEqual(forms, {without_choices(command) for command in theirs.commands})
        self.assertEqual([ours.commands[-1][FINISHED], theirs.commands[-1][FINISHED]], [1, 1])
        # the torques that libfranka was given are where ours are written
        self.assertEqual(TORQUES.unpack_from(theirs.commands[0], TORQUES_AT),
                         (0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07))
        moved = TORQUES.unpack_from(ours.commands[-1], TORQUES_AT)
        self.assertTrue(any(moved) and max(map(abs, moved)) < 87, moved)

    @patiently
    def test_sends_the_same_bytes_for_speeds(self):
        with robot(TOLERANT) as port:
            with Recorder(port) as ours:
                code, said, _ = drive(ours, 1, by="/speeds")
                self.assertEqual(code, 0, said)
            with Recorder(port) as theirs:
                self.assertEqual(libfranka(theirs.host, "speeds")["error"], "")
        self.same(ours, theirs, MOVE)
        self.assertEqual(self.answers(ours, MOVE), self.answers(theirs, MOVE))
        forms = {without_speeds(command) for command in ours.commands}
        self.assertEqual(len(forms), 2)  # on its way, and its end
        self.assertEqual(forms, {without_speeds(command) for command in theirs.commands})
        self.assertEqual(SPEEDS.unpack_from(theirs.commands[0], SPEEDS_AT),
                         (0.001, -0.001, 0.002, -0.002, 0.003, -0.003, 0.001))

    @patiently
    def test_a_step_of_torque_ends_in_the_same_error(self):
        with robot("--torque-rate", "100", TOLERANT) as port:
            with Recorder(port) as ours:
                code, our_words, summary = drive(ours, 4)
                self.assertEqual((code, summary["fault"]["code"]), (3, 113), our_words)
            with Recorder(port) as theirs:
                their_words = libfranka(theirs.host, "step")
        self.check_reflex(ours, theirs, our_words, their_words, "controller_torque_discontinuity")

    @patiently
    def test_silence_ends_in_the_same_error(self):
        with robot() as port, tempfile.TemporaryDirectory() as folder:
            with Recorder(port) as ours:
                stopped = Run(f"franka://{ours.host}:{PORT}", 5, folder)
                stopped.wait_for("no start test")
                time.sleep(1.5)
                stopped.be_silent(0.3)
                code, our_words, _ = stopped.wait()
                self.assertEqual(code, 3, our_words)
            with Recorder(port) as theirs:
                their_words = libfranka(theirs.host, "silence")
        self.check_reflex(ours, theirs, our_words, their_words,
                          "communication_constraints_violation")

    def check_reflex(self, ours, theirs, our_words, their_words, error):
        self.assertEqual(names(their_words["errors"]), {error})
        self.assertIn(error, their_words["error"])
        message = next(line for line in our_words.splitlines() if "robot in mode" in line)
        self.assertEqual(names(message), {error})
        self.assertEqual(their_words["mode"].lower(), re.search("mode '(.*)'", message)[1])
        for recorder in (ours, theirs):
            self.assertEqual(self.answers(recorder, MOVE), [STARTED, REFLEX_ABORTED])

    @patiently
    def test_recovers_with_the_same_bytes(self):
        with robot("--in-reflex", TOLERANT) as port:
            with Recorder(port) as ours:
                code, said, _ = drive(ours, 0.5)
                self.assertEqual(code, 0, said)
            with Recorder(port) as theirs:
                said = libfranka(theirs.host, "nothing")
                self.assertEqual((said["mode"], said["mode_after"]), ("Reflex", "Idle"))
        self.same(ours, theirs, RECOVERY)
        self.assertEqual(self.answers(ours, RECOVERY)[0], 0)

    @patiently
    def test_stops_a_motion_that_does_not_end_with_the_same_bytes(self):
        with robot(TOLERANT) as port:
            with Recorder(port, keeps_finished=True) as ours:
                drive(ours, 1)
            with Recorder(port) as theirs:
                libfranka(theirs.host, "stop")
        self.same(ours, theirs, STOP_MOVE)
        for recorder in (ours, theirs):
            self.assertEqual(self.answers(recorder, STOP_MOVE)[0], 0)
            self.assertEqual(self.answers(recorder, MOVE), [STARTED, PREEMPTED])
