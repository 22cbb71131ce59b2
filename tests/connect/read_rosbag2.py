"""Reads a rosbag2 folder with rosbags, which knows nothing of us: read_rosbag2.py FOLDER OUT.json

Numbers of all standard topics by topic, in the order of the messages.
"""

import json
import pathlib
import sys

from rosbags.highlevel import AnyReader


def numbers(value):
    if hasattr(value, "__dataclass_fields__"):
        return [n for name in value.__dataclass_fields__ if not name.startswith("__")
                for n in numbers(getattr(value, name))]
    if isinstance(value, (str, bool)):
        return [str(value)]
    if hasattr(value, "__iter__"):
        return [n for item in value for n in numbers(item)]
    return [repr(value.item() if hasattr(value, "item") else value)]


def main():
    found = {}
    with AnyReader([pathlib.Path(sys.argv[1])]) as reader:
        for connection in reader.connections:
            found[connection.topic] = {"type": connection.msgtype, "times": [], "numbers": []}
        for connection, time_ns, raw in reader.messages():
            topic = found[connection.topic]
            topic["times"].append(time_ns)
            if not connection.msgtype.startswith("hapticgiant_msgs"):
                topic["numbers"].append(numbers(reader.deserialize(raw, connection.msgtype)))
        found["count"] = reader.message_count
        found["duration_ns"] = reader.duration
    pathlib.Path(sys.argv[2]).write_text(json.dumps(found))


if __name__ == "__main__":
    main()
