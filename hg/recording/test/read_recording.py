"""Reads what recording_example wrote with the official reader and the schemas in the file.

Usage: read_recording.py RECORDING_EXAMPLE (the program). Prints what it checked; any wrong value
is an AssertionError.
"""

import pathlib
import struct
import subprocess
import sys
import tempfile

from mcap.exceptions import EndOfFile
from mcap.reader import NonSeekingReader, make_reader
from mcap_ros2.decoder import DecoderFactory

START_NS = 1_800_000_000 * 10**9
SECONDS = 2
RATE_HZ = 1000
MASK = 2**64 - 1
LIMIT_COUNT = 11


def scrambled(key):
    """The double of example_run.h that belongs to a key."""
    z = (key + 0x9E3779B97F4A7C15) & MASK
    z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
    z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
    z ^= z >> 31
    return struct.unpack("<d", struct.pack("<Q", z & 0x801FFFFFFFFFFFFF | 0x3FE0000000000000))[0]


def check_sample(sample, cycle):
    """Every double of both input frames, in the order in which example_sample() makes them."""
    sensors, hand = sample.sensors, sample.operator_input.hand_target
    values = [sensors.time_s, *sensors.q_m, *sensors.dq_m, *sensors.tau_m, *sensors.q_p]
    values += [*sensors.w_s, *hand.p_b, hand.press]
    assert len(values) == 1 + 3 * 6 + 2 + 6 + 4
    assert values == [scrambled(100 * cycle + i) for i in range(len(values))]
    assert sensors.sequence == sample.record.cycle == cycle
    assert sensors.dead_man is True and sensors.safety.emergency_stop is False
    assert sample.operator_input.request == (2 if cycle == 0 else 0)
    assert sample.record.time_s == cycle / RATE_HZ
    assert len(sample.record.limits) == LIMIT_COUNT
    assert sample.record.limits[3].state == 2 and sample.record.felt_limit == 3
    assert sample.record.reference.q_m == sample.command.q_m == sample.record.robot.q_m


def check_joint_states(device, twin, sample):
    assert device.name == ["p1", "p2", "m1", "m2", "m3", "m4", "m5", "m6"]
    assert device.position == sample.record.robot.q_p + sample.record.robot.q_m
    assert device.velocity == sample.record.robot.dq_p + sample.record.robot.dq_m
    assert device.effort[2:] == sample.sensors.tau_m
    assert twin.name == ["hinge"]
    assert twin.position == sample.record.twin.q_a
    assert twin.effort == sample.record.tau_a


def check_frames(transforms, wrench, sample):
    handle, elbow, twin_end = transforms.transforms
    assert (handle.header.frame_id, handle.child_frame_id) == ("base", "handle")
    assert (elbow.header.frame_id, elbow.child_frame_id) == ("base", "elbow")
    assert (twin_end.header.frame_id, twin_end.child_frame_id) == ("base", "twin_end")
    assert twin_end.transform.translation.x == sample.record.twin_end.p[0]
    translation, q = handle.transform.translation, handle.transform.rotation
    assert [translation.x, translation.y, translation.z] == sample.record.handle.p
    assert abs(1 - 2 * (q.y**2 + q.z**2) - sample.record.handle.r[0]) < 1e-14
    assert abs(2 * (q.x * q.y - q.w * q.z) - sample.record.handle.r[1]) < 1e-14

    # the wrench is resolved in the handle's frame: turned back it is the recorded one
    f, r = wrench.wrench.force, sample.record.handle.r
    assert wrench.header.frame_id == "handle"
    for row in range(3):
        force = r[3 * row] * f.x + r[3 * row + 1] * f.y + r[3 * row + 2] * f.z
        assert abs(force - sample.record.robot.w_h[row]) < 1e-14


def check_complete(path):
    by_topic = {}
    with open(path, "rb") as stream:
        reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
        assert reader.get_header().profile == "ros2"
        for _, channel, message, decoded in reader.iter_decoded_messages():
            assert message.publish_time == message.log_time
            by_topic.setdefault(channel.topic, []).append((message.log_time, decoded))
        attachments = {a.name: a.data.decode() for a in reader.iter_attachments()}
        metadata = {m.name: m.metadata for m in reader.iter_metadata()}

    samples = by_topic.pop("/hapticgiant/sample")
    assert [t for t, _ in samples] == [START_NS + k * 10**6 for k in range(SECONDS * RATE_HZ)]
    for cycle, (_, sample) in enumerate(samples):
        check_sample(sample, cycle)

    events = by_topic.pop("/hapticgiant/events")
    assert [(t, e.name, e.text) for t, e in events] == [
        (START_NS, "start", "the door is closed"),
        (START_NS + SECONDS * 10**9, "end", ""),
    ]

    clocks = by_topic.pop("/hapticgiant/lab_clock")
    assert [(t, c.time_s, c.offset_s) for t, c in clocks] == [
        (START_NS + SECONDS * 10**9 // 2, SECONDS / 2, 12345.678901234567)
    ]

    topics = ["/joint_states", "/twin/joint_states", "/tf", "/user_wrench", "/handle_twist"]
    assert sorted(by_topic) == sorted(topics)
    for topic in topics:
        assert [t for t, _ in by_topic[topic]] == [
            START_NS + k * 10**7 for k in range(SECONDS * 100)
        ]
    for k, rows in enumerate(zip(*(by_topic[topic] for topic in topics))):
        device, twin, transforms, wrench, twist = (decoded for _, decoded in rows)
        stamp = device.header.stamp
        assert stamp.sec * 10**9 + stamp.nanosec == START_NS + k * 10**7
        check_joint_states(device, twin, samples[10 * k][1])
        check_frames(transforms, wrench, samples[10 * k][1])
        assert twist.header.frame_id == "handle"
        assert (twist.header.stamp.sec, twist.header.stamp.nanosec) == (stamp.sec, stamp.nanosec)

    assert attachments == {"device.yaml": "urdf: device.urdf\n", "twin.yaml": "urdf: door.urdf\n"}
    assert metadata["run"]["version"] == "0.1.0"
    assert metadata["run"]["rate_Hz"] == "1000"
    assert metadata["run"]["start_ns"] == str(START_NS)
    assert metadata["run"]["manipulator_joints"] == "m1,m2,m3,m4,m5,m6"
    limits = metadata["limits"]
    assert len(limits) == 5 * LIMIT_COUNT
    assert (limits["10.name"], limits["10.kind"]) == ("hinge", "twin")
    assert (limits["10.unit"], limits["07.unit"]) == ("rad", "m")
    assert float(limits["10.upper"]) == 1.57 and float(limits["07.lower"]) == float("-inf")
    return len(samples)


def check_crashed(path):
    """A file without its end: everything up to the last flush is there."""
    count = 0
    with open(path, "rb") as stream:
        reader = NonSeekingReader(stream, decoder_factories=[DecoderFactory()])
        try:
            for _, channel, _, decoded in reader.iter_decoded_messages(log_time_order=False):
                if channel.topic == "/hapticgiant/sample":
                    check_sample(decoded, count)
                    count += 1
        except EndOfFile:
            pass
    # 2500 pushed; at most 1000 may wait in the ring and 250 in the chunk under way
    assert 1250 <= count <= 2500, count
    return count


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, folder, str(SECONDS), str(RATE_HZ)], check=True)
        (path,) = (p for p in pathlib.Path(folder).glob("door_*.mcap"))
        assert path.name == "door_20270115_080000.mcap"
        assert pathlib.Path(folder, "latest.mcap").resolve() == path.resolve()
        print("complete:", check_complete(path), "samples")
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, folder, "crash"], check=True)
        (path,) = (p for p in pathlib.Path(folder).glob("door_*.partial.mcap"))
        print("after a crash:", check_crashed(path), "of 2500 samples")


if __name__ == "__main__":
    main(sys.argv[1])
