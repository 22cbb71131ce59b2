"""A node of ROS 2 (rclpy) that looks at the bridge from the other side; prints what it saw as JSON.

    peer.py watch FILE [--brief]    subscribes to all topics, until FILE exists
    peer.py call                    services, parameters and topics into the run
    peer.py robot FILE              a robot: states at 250 Hz, does what velocities say, until FILE exists

Run by the Python of an environment of ROS 2 wheels.
"""

import json
import pathlib
import sys
import time

import rclpy
import rclpy.executors
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, TwistStamped, WrenchStamped
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float64MultiArray, String
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage

from flat import DESCRIPTIONS, STREAMS, stamp_ns, values, xyz

PATIENCE = 20.0  # s
DEPTH = 1000  # messages: this program is slow
LATCHED = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE,
                     durability=DurabilityPolicy.TRANSIENT_LOCAL)
KINDS = {"sensor_msgs/msg/JointState": JointState, "geometry_msgs/msg/WrenchStamped": WrenchStamped,
         "geometry_msgs/msg/TwistStamped": TwistStamped, "tf2_msgs/msg/TFMessage": TFMessage,
         "diagnostic_msgs/msg/DiagnosticArray": DiagnosticArray, "std_msgs/msg/String": String}


class Spinner:
    """One executor for all turns: rclpy.spin_once() makes one each time."""

    def __init__(self, node):
        self.executor = rclpy.executors.SingleThreadedExecutor()
        self.executor.add_node(node)

    def once(self, seconds):
        self.executor.spin_once(timeout_sec=seconds)


def watch(node, spinner, end, is_brief):
    """`is_brief`: numbers only, for runs of many minutes."""
    seen = {topic: [] for topic in (*STREAMS, *DESCRIPTIONS)}
    brief = {topic: {"count": 0, "gaps": 0, "longest_gap_ms": 0.0, "last": None, "worst_age_ms": 0.0}
             for topic in seen}

    def keep(topic, message):
        now = time.time_ns()
        stamp = stamp_ns(message)
        if not is_brief:
            seen[topic].append([stamp, values(STREAMS.get(topic, "String"), message), now])
            return
        facts = brief[topic]
        facts["count"] += 1
        if stamp is not None:
            if facts["last"] is not None:
                gap = (stamp - facts["last"]) * 1e-6
                facts["longest_gap_ms"] = max(facts["longest_gap_ms"], gap)
                facts["gaps"] += gap > 15.0
            facts["last"] = stamp
            facts["worst_age_ms"] = max(facts["worst_age_ms"], (now - stamp) * 1e-6)

    for topic, kind in STREAMS.items():
        node.create_subscription(KINDS[kind], topic, lambda message, topic=topic: keep(topic, message), DEPTH)
    for topic in DESCRIPTIONS:
        node.create_subscription(String, topic, lambda message, topic=topic: keep(topic, message), LATCHED)
    best_effort = []
    node.create_subscription(JointState, "/joint_states", best_effort.append if not is_brief else lambda _: None,
                             qos_profile_sensor_data)
    print("ready", flush=True)
    while not end.exists():
        for _ in range(100):
            spinner.once(0.01)
    hashes = {}
    for topic in seen:
        for info in node.get_publishers_info_by_topic(topic):
            hashes[topic] = [info.node_name, info.topic_type, str(info.topic_type_hash)]
    own = {}
    for topic, kind in STREAMS.items():
        node.create_publisher(KINDS[kind], "/own" + topic, 1)
        own[topic] = str(node.get_publishers_info_by_topic("/own" + topic)[0].topic_type_hash)
    return {"seen": seen, "brief": brief, "best_effort": len(best_effort), "publishers": hashes,
            "own_hashes": own, "nodes": node.get_node_names(),
            "services": dict(node.get_service_names_and_types_by_node("hapticgiant", "/"))
            if "hapticgiant" in node.get_node_names() else {}}


class Caller:
    def __init__(self, node, spinner):
        self.node, self.spinner = node, spinner

    def call(self, kind, name, **fields):
        client = self.node.create_client(kind, name)
        if not client.wait_for_service(PATIENCE):
            raise SystemExit(f"no service {name}")
        began = time.monotonic()
        future = client.call_async(kind.Request(**fields))
        self.spinner.executor.spin_until_future_complete(future, timeout_sec=PATIENCE)
        if future.result() is None:
            raise SystemExit(f"{name} did not answer")
        return future.result(), time.monotonic() - began

    def trigger(self, name):
        answer, took_s = self.call(Trigger, f"/hapticgiant/{name}")
        return [answer.success, answer.message, took_s]

    def get(self, names):
        answer, _ = self.call(GetParameters, "/hapticgiant/get_parameters", names=names)
        return [[one.type, one.double_value] for one in answer.values]

    def set(self, name, value):
        answer, _ = self.call(SetParameters, "/hapticgiant/set_parameters",
                              parameters=[Parameter(name, value=value).to_parameter_msg()])
        return [answer.results[0].successful, answer.results[0].reason]


def call(node, spinner):
    caller = Caller(node, spinner)
    saw = {"services": {name: caller.trigger(name) for name in ("mark", "tare")}}
    answer, _ = caller.call(ListParameters, "/hapticgiant/list_parameters")
    saw["parameters"] = list(answer.result.names)
    saw["before"] = caller.get(saw["parameters"])
    answer, _ = caller.call(DescribeParameters, "/hapticgiant/describe_parameters", names=saw["parameters"])
    saw["described"] = [[one.name, one.type] for one in answer.descriptors]
    saw["ranges"] = [[[part.from_value, part.to_value, part.step] for part in one.floating_point_range]
                     for one in answer.descriptors]
    finite = [[name, value] for name, (_, value) in zip(saw["parameters"], saw["before"])
              if 0 < abs(value) < 1e6]
    name, value = finite[0]
    saw["changed"], saw["old"] = name, value
    saw["set"] = caller.set(name, value * 1.25)
    until = time.monotonic() + PATIENCE
    while (after := caller.get([name]))[0][1] == value and time.monotonic() < until:
        pass  # the run takes it in its next cycles
    saw["after"] = after
    saw["too_large"] = caller.set(name, -1e30)
    saw["unknown"] = caller.set("no_such_parameter", 1.0)
    saw["after_refusal"] = caller.get([name])

    wrenches = []
    node.create_subscription(WrenchStamped, "/user_wrench", lambda m: wrenches.append(m.wrench.force.x), 10)
    handles = []
    node.create_subscription(TFMessage, "/tf", lambda m: handles.extend(
        xyz(one.transform.translation) for one in m.transforms if one.child_frame_id == "handle"), 10)

    def spin(seconds, publish=lambda: None, is_enough=lambda: False):
        until = time.monotonic() + seconds
        while time.monotonic() < until and not is_enough():
            publish()
            spinner.once(0.01)

    spin(1.0)
    saw["handle_before"] = handles[-1] if handles else None
    target = node.create_publisher(PoseStamped, "/hand_target", 10)
    pose = PoseStamped()
    pose.header.frame_id = "base"
    x, y, z = handles[-1] if handles else (0.0, 0.0, 0.0)
    pose.pose.position.x, pose.pose.position.y, pose.pose.position.z = x + 0.1, y, z
    pose.pose.orientation.w = 0.0  # free to turn
    spin(PATIENCE, lambda: target.publish(pose),
         lambda: handles[-1] != [x, y, z] and max(map(abs, wrenches), default=0.0) > 1.0)
    saw["handle_pulled"] = handles[-1] if handles else None
    saw["force_pulled"] = max((abs(x) for x in wrenches), default=0.0)
    node.destroy_publisher(target)
    spin(1.5)
    saw["handle_after"] = handles[-1] if handles else None

    wrench = node.create_publisher(WrenchStamped, "/reference_wrench", 10)
    message = WrenchStamped()
    message.header.frame_id = "base"
    message.wrench.force.y = 5.0
    spin(1.0, lambda: wrench.publish(message))
    saw["handle_with_wrench"] = handles[-1] if handles else None
    node.destroy_publisher(wrench)
    saw["stop"] = caller.trigger("stop")
    return saw


def robot(node, spinner, end):
    """Six joints that move with the commanded speeds, and a hand that pushes."""
    joints = [f"joint_{i}" for i in range(6)]
    q, dq, heard = [0.0, 0.6, 1.2, 0.0, 0.8, 0.0], [0.0] * 6, []

    def take(message):
        heard.append(time.monotonic())
        dq[:] = message.data

    node.create_subscription(Float64MultiArray, "/forward_velocity_controller/commands", take, 10)
    states = node.create_publisher(JointState, "/joint_states", 10)
    hand = node.create_publisher(Bool, "/dead_man", 10)
    wrench = node.create_publisher(WrenchStamped, "/wrench", 10)
    period = 1 / 250
    begin = last = time.monotonic()
    print("ready", flush=True)
    moved = 0.0
    while not end.exists():
        spinner.once(0.0)
        now = time.monotonic()
        q = [a + (now - last) * v for a, v in zip(q, dq)]
        moved = max(moved, max(abs(v) for v in dq))
        last = now
        stamp = node.get_clock().now().to_msg()
        state = JointState(name=joints[::-1], position=q[::-1], velocity=dq[::-1])
        state.header.stamp = stamp
        states.publish(state)
        push = WrenchStamped()
        push.header.stamp = stamp
        push.wrench.force.x = 10.0 if int(now - begin) % 2 == 0 else -10.0
        wrench.publish(push)
        hand.publish(Bool(data=True))
        time.sleep(max(0.0, period - (time.monotonic() - now)))
    return {"commands": len(heard), "fastest": moved, "last": dq, "position": q,
            "silent_for_s": time.monotonic() - heard[-1] if heard else None}


def main():
    rclpy.init()
    node = rclpy.create_node("peer")
    spinner = Spinner(node)
    what = sys.argv[1]
    if what == "watch":
        result = watch(node, spinner, pathlib.Path(sys.argv[2]), "--brief" in sys.argv)
    elif what == "call":
        result = call(node, spinner)
    else:
        result = robot(node, spinner, pathlib.Path(sys.argv[2]))
    print(json.dumps(result), flush=True)
    node.destroy_node()
    rclpy.shutdown()


main()
