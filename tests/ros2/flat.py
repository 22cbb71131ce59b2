"""Messages as lists of numbers and texts, from whoever has decoded them: rclpy, a reader of recordings."""

STREAMS = {"/joint_states": "sensor_msgs/msg/JointState",
           "/twin/joint_states": "sensor_msgs/msg/JointState",
           "/limits": "sensor_msgs/msg/JointState",
           "/user_wrench": "geometry_msgs/msg/WrenchStamped",
           "/handle_twist": "geometry_msgs/msg/TwistStamped",
           "/tf": "tf2_msgs/msg/TFMessage",
           "/diagnostics": "diagnostic_msgs/msg/DiagnosticArray",
           "/hapticgiant/events": "std_msgs/msg/String"}
DESCRIPTIONS = ("/robot_description", "/twin/robot_description")


def xyz(vector):
    return [vector.x, vector.y, vector.z]


def values(kind, message):
    """All that a message says but its time."""
    name = kind.split("/")[-1]
    if name == "JointState":
        return [list(message.name), list(message.position), list(message.velocity), list(message.effort)]
    if name == "WrenchStamped":
        return [message.header.frame_id, xyz(message.wrench.force) + xyz(message.wrench.torque)]
    if name == "TwistStamped":
        return [message.header.frame_id, xyz(message.twist.linear) + xyz(message.twist.angular)]
    if name == "TFMessage":
        return [[one.header.frame_id, one.child_frame_id, xyz(one.transform.translation),
                 xyz(one.transform.rotation) + [one.transform.rotation.w]] for one in message.transforms]
    if name == "DiagnosticArray":
        return [[one.name, one.message, [[item.key, item.value] for item in one.values]]
                for one in message.status]
    return message.data


def stamp_ns(message):
    """Time stamp, ns; None for a message without."""
    transforms = getattr(message, "transforms", None)
    header = transforms[0].header if transforms else getattr(message, "header", None)
    if header is None:
        return None
    nanoseconds = getattr(header.stamp, "nanosec", None)
    return header.stamp.sec * 10**9 + (header.stamp.nsec if nanoseconds is None else nanoseconds)
