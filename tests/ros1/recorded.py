"""Messages of a recording as lines of JSON, for tests that run in another Python.

    recorded.py FILE TOPIC...

Read by mcap-ros2-support. Times are integers, ns.
"""

import json
import sys

from mcap_ros2.reader import read_ros2_messages


def plain(message):
    if hasattr(message, "nanosec"):
        return message.sec * 1_000_000_000 + message.nanosec
    if hasattr(message, "__slots__"):
        return {name: plain(getattr(message, name)) for name in message.__slots__}
    if isinstance(message, (list, tuple)):
        return [plain(item) for item in message]
    return message


for message in read_ros2_messages(sys.argv[1], topics=sys.argv[2:]):
    print(json.dumps({"topic": message.channel.topic, "message": plain(message.ros_msg)}))
