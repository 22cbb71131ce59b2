"""The ROS 1 bridge, judged by Debian's ROS 1: rospy, dynamic_reconfigure, rviz.

    ros1_test.py PROGRAM [NAME...] [--picture FILE]

Real time: for a computer that is left alone (`make ros1`), none of `make test`. The package must be
built (bridges/ros1/build.sh). With --picture the picture of rviz is written to FILE, a PNG.
"""

import math
import pathlib
import subprocess
import sys
import time
import unittest

import dynamic_reconfigure.client
import harness
import numpy
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, TwistStamped, WrenchStamped
from harness import PATIENCE_S, Screen, World, plain, stop, until
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

RECORDED = {"/joint_states": JointState, "/twin/joint_states": JointState,
            "/user_wrench": WrenchStamped, "/handle_twist": TwistStamped, "/tf": TFMessage}
TOPICS = {**RECORDED, "/limits": JointState, "/diagnostics": DiagnosticArray,
          "/hapticgiant/events": String, "/hapticgiant/markers": MarkerArray}
FORCE, TORQUE, FIELD = (0xf0, 0x64, 0x3c), (0xa8, 0x55, 0xd8), (0x2f, 0xa3, 0x6b)
BACKGROUND = (232, 236, 240)  # of hapticgiant.rviz
RVIZ_PATIENCE_S = 240.0  # software draws
PICTURE = None  # file


class Ear:
    """Keeps all messages of a topic."""

    def __init__(self, topic, kind):
        self.messages = []
        self.subscriber = rospy.Subscriber(topic, kind, self.messages.append, queue_size=1000)
        until(lambda: self.subscriber.get_num_connections() > 0, topic + " is published")

    def next(self, when=lambda message: True, what="a message"):
        """The first new message for which `when` holds."""
        begin = len(self.messages)
        found = until(lambda: next(([m] for m in self.messages[begin:] if when(m)), None),
                      f"{what} on {self.subscriber.name}")
        return found[0]


def stamp_of(message):
    """ns; `message` as plain()."""
    return (message if "header" in message else message["transforms"][0])["header"]["stamp"]


def newest(ear):
    return ear.messages[-1] if ear.messages else None


def near(pixels, color, tolerance):
    """Number of pixels of this colour."""
    distances = numpy.abs(numpy.frombuffer(pixels, numpy.uint8).reshape(-1, 3).astype(int) - color)
    return int((distances.max(axis=1) <= tolerance).sum())


def value_of(diagnostics, key):
    for status in diagnostics.status:
        for entry in status.values:
            if entry.key == key:
                return entry.value
    return None


class Ros1(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.world = World()
        cls.addClassCleanup(cls.world.close)
        cls.world.start_master()
        rospy.init_node("judge", disable_signals=True)
        cls.bridge = cls.world.start_bridge()

    def setUp(self):
        self.assertIsNone(self.bridge.poll(), self.world.said("bridge.log"))

    def run_door(self, *arguments):
        run = self.world.run("door", *arguments)
        self.addCleanup(stop, run.process)
        return run

    def test_values_are_those_of_the_record(self):
        ears = {topic: Ear(topic, kind) for topic, kind in TOPICS.items()}
        run = self.run_door()
        run.process.wait(PATIENCE_S)
        time.sleep(1.0)
        for ear in ears.values():
            ear.subscriber.unregister()
        recorded = run.recorded(*RECORDED)
        for topic in RECORDED:
            with self.subTest(topic):
                heard = [plain(message) for message in ears[topic].messages]
                kept = {stamp_of(entry["message"]): entry["message"] for entry in recorded[topic]}
                stamps = [stamp_of(message) for message in heard]
                self.assertEqual(stamps, sorted(set(stamps)), "in order, each once")
                common = [message for message in heard if stamp_of(message) in kept]
                self.assertGreater(len(common), 1000)
                for message in common:
                    self.assertEqual(repr(message), repr(kept[stamp_of(message)]))
                steps = sorted(b - a for a, b in zip(stamps, stamps[1:]))
                self.assertAlmostEqual(steps[len(steps) // 2] / 1e6, 10.0, delta=0.001)  # ms
                self.assertGreater(len(stamps), 0.98 * (stamps[-1] - stamps[0]) / 1e7)
        events = [message.data for message in ears["/hapticgiant/events"].messages]
        self.assertTrue(any(event.startswith("locked: ") for event in events), events)
        limits = newest(ears["/limits"])
        self.assertEqual(len(limits.name), len(limits.position))
        self.assertIn("hinge", limits.name)
        parents = {}
        for message in ears["/tf"].messages[100:200]:
            for transform in message.transforms:
                parents.setdefault(transform.child_frame_id, set()).add(transform.header.frame_id)
        self.assertTrue(all(len(of) == 1 for of in parents.values()), parents)
        for frame in ("handle", "elbow", "twin_end", "m6", "twin/leaf"):
            self.assertIn(frame, parents)

    def test_services_answer_with_the_reason(self):
        self.run_door("--user", "mouse", "--duration", "1000")
        ear = Ear("/diagnostics", DiagnosticArray)
        mode = lambda name: ear.next(lambda m: value_of(m, "mode") == name, "mode " + name)
        mode("running")
        services = {name: rospy.ServiceProxy("/hapticgiant/" + name, Trigger)
                    for name in ("tare", "arm", "run", "stop", "reset", "mark")}
        events = Ear("/hapticgiant/events", String)
        answer = services["mark"]()
        self.assertTrue(answer.success, answer.message)
        until(lambda: any("mark" in event.data for event in events.messages), "the mark")
        answer = services["arm"]()
        self.assertFalse(answer.success)  # it is running already
        self.assertTrue(answer.message)
        answer = services["stop"]()
        self.assertTrue(answer.success, answer.message)
        ear.next(lambda m: value_of(m, "mode") not in (None, "running"), "another mode")
        answers = {}

        def runs_again():  # once it stands still, with its drives on or off
            for name in ("arm", "run"):
                answers[name] = services[name]().message
            return value_of(ear.messages[-1], "mode") == "running"

        try:
            until(runs_again, "it runs again")
        except AssertionError as error:
            self.fail(f"{error}: {answers}, {value_of(ear.messages[-1], 'mode')}")

    def pull(self, x, y, z):
        """A function that pulls the hand to a place beside the handle, m, for the next 0.5 s."""
        handle = next(t.transform.translation for t in Ear("/tf", TFMessage).next().transforms
                      if t.child_frame_id == "handle")
        target = rospy.Publisher("/hand_target", PoseStamped, queue_size=1)
        message = PoseStamped()
        message.header.frame_id = "base"  # a quaternion of zeros: free to turn
        place = message.pose.position
        place.x, place.y, place.z = handle.x + x, handle.y + y, handle.z + z
        return lambda frame="base": (setattr(message.header, "frame_id", frame),
                                     target.publish(message))

    def test_a_hand_target_pulls_the_handle(self):
        self.run_door("--user", "mouse", "--duration", "1000")
        wrench = Ear("/user_wrench", WrenchStamped)
        wrench.next()
        pull = self.pull(0.0, 0.05, 0.0)

        def is_pulled():
            pull()
            force = wrench.messages[-1].wrench.force
            return math.hypot(force.x, force.y, force.z) > 3.0

        until(is_pulled, "the hand pulls")
        # in another frame it is not taken
        until(lambda: pull("map") and "frame_id" in self.world.said("bridge.log"), "a warning")

    def test_a_reference_wrench_moves_the_twin(self):
        self.run_door("--user", "none", "--duration", "1000")
        twin = Ear("/twin/joint_states", JointState)
        twin.next()
        wrench = rospy.Publisher("/reference_wrench", WrenchStamped, queue_size=1)
        message = WrenchStamped()
        message.header.frame_id = "base"
        message.wrench.torque.x = message.wrench.torque.y = 0.0
        message.wrench.force.z = 10.0  # w_ref acts on the hand: the lever goes down

        def lever():
            state = twin.messages[-1]
            return state.position[state.name.index("lever")]

        begin = lever()
        until(lambda: wrench.publish(message) or abs(lever() - begin) > 0.05, "the lever moves")

    def test_settings_are_those_of_dynamic_reconfigure(self):
        self.run_door("--user", "mouse", "--duration", "1000")
        Ear("/joint_states", JointState).next()  # of this run
        client = dynamic_reconfigure.client.Client("/hapticgiant_bridge", timeout=PATIENCE_S)
        self.addCleanup(client.close)
        name = "hinge.damping_Nms_per_rad"
        until(lambda: name in (client.get_configuration(timeout=1.0) or {}), "the setting")
        entry = next(e for e in client.get_parameter_descriptions(5.0) if e["name"] == name)
        self.assertLess(entry["min"], entry["max"])
        wanted = client.get_configuration(timeout=5.0)[name] + 1.25
        self.assertEqual(client.update_configuration({name: wanted})[name], wanted)
        refused = client.update_configuration({name: 10.0 * entry["max"] + 1.0})
        self.assertEqual(refused[name], wanted)

    def test_either_side_may_begin_again(self):
        joints = Ear("/joint_states", JointState)
        diagnostics = Ear("/diagnostics", DiagnosticArray)
        for _ in range(2):  # the program
            run = self.run_door("--user", "mouse", "--duration", "1000")
            joints.next()
            stop(run.process)
            lost = diagnostics.next(lambda m: m.status[0].level == 3, "the loss")
            self.assertIn("not connected", lost.status[0].message)
        run = self.run_door("--user", "mouse", "--duration", "1000")
        joints.next()
        stop(self.bridge)  # the bridge
        type(self).bridge = self.world.start_bridge()
        joints.next()
        stop(self.bridge, harness.signal.SIGKILL)
        type(self).bridge = self.world.start_bridge(run.link)
        joints.next()
        stop(self.bridge)
        type(self).bridge = self.world.start_bridge()
        joints.next()

    def test_meshes_of_a_twin_are_files(self):
        folder = self.world.folder / "meshes"
        folder.mkdir()
        twin = harness.ROOT / "models/twins/door"
        text = (twin / "door.urdf").read_text()
        mesh = '<visual><geometry><mesh filename="ramp.stl"/></geometry></visual>'
        (folder / "door.urdf").write_text(text.replace('<link name="leaf">',
                                                       '<link name="leaf">' + mesh))
        (folder / "twin.yaml").write_text((twin / "twin.yaml").read_text())
        shape = (harness.ROOT / "models/surfaces/ramp.stl").read_bytes()
        (folder / "ramp.stl").write_bytes(shape)
        self.run_door("--twin", folder / "twin.yaml", "--user", "mouse", "--duration", "1000")
        urdf = until(lambda: next(
            (urdf for urdf in [rospy.get_param("/twin/robot_description", "")]
             if "file://" in urdf), None), "the URDF")
        file = urdf.split('mesh filename="file://')[1].split('"')[0]
        self.assertEqual(pathlib.Path(file).read_bytes(), shape)
        self.assertIn("ppu1", rospy.get_param("/robot_description"))

    def test_rviz_shows_it(self):
        screen = Screen(self.world)
        rviz = self.world.start("/usr/bin/rviz", "-d", harness.PACKAGE / "rviz/hapticgiant.rviz")
        self.addCleanup(stop, rviz)
        background = lambda: near(screen.picture(), BACKGROUND, 1) > 100_000
        until(background, "rviz has a window", RVIZ_PATIENCE_S)
        time.sleep(1.0)
        empty = screen.picture()
        for color in (FORCE, TORQUE, FIELD):
            self.assertLess(near(empty, color, 12), 20)
        stop(rviz)
        markers = Ear("/hapticgiant/markers", MarkerArray)
        self.run_door("--user", "mouse", "--duration", "1000")
        until(lambda: "ppu1" in rospy.get_param("/robot_description", ""), "the URDF")
        rviz = self.world.start("/usr/bin/rviz", "-d", harness.PACKAGE / "rviz/hapticgiant.rviz")
        self.addCleanup(stop, rviz)

        pull = self.pull(0.5, 0.1, 0.05)
        timer = rospy.Timer(rospy.Duration(0.05), lambda _: pull())
        self.addCleanup(timer.shutdown)
        self.counts = {}

        def is_seen():
            pixels = screen.picture(PICTURE)
            self.counts = {name: near(pixels, color, tolerance) for name, color, tolerance in (
                ("force", FORCE, 30), ("torque", TORQUE, 12), ("field", FIELD, 12),
                ("door", (124, 86, 54), 40), ("ring", (0, 90, 110), 40))}
            return all(count > 60 for count in self.counts.values())

        try:
            until(is_seen, "all is in the picture", RVIZ_PATIENCE_S)
        finally:
            print("pixels:", self.counts)
        names = {marker.ns for message in markers.messages for marker in message.markers}
        self.assertLessEqual({"wrench", "torques", "scanner", "box"}, names)


class Ros1Restart(unittest.TestCase):
    """Without rospy in this process, which would keep to the master that it knew."""

    def test_a_new_master_is_noticed(self):
        world = World()
        self.addCleanup(world.close)
        master = world.start_master()
        bridge = world.start_bridge()
        run = world.run("door", "--user", "mouse", "--duration", "1000")
        for _ in range(2):
            shown = subprocess.run(["/usr/bin/rostopic", "echo", "-n", "1", "/user_wrench"],
                                  capture_output=True, text=True, timeout=PATIENCE_S)
            self.assertIn("force", shown.stdout, shown.stderr)
            stop(master)
            master = world.start_master()
            until(lambda: "new master" in world.said("bridge.log"), "it is noticed")
        self.assertIsNone(bridge.poll())
        self.assertIsNone(run.process.poll())


def main():
    global PICTURE
    arguments = sys.argv[1:]
    if "--picture" in arguments:
        at = arguments.index("--picture")
        PICTURE = arguments[at + 1]
        del arguments[at:at + 2]
    harness.PROGRAM = pathlib.Path(arguments.pop(0)).resolve()
    unittest.main(argv=["ros1_test", *arguments], verbosity=2,
                  warnings="ignore")  # rospy leaves sockets open


if __name__ == "__main__":
    main()
