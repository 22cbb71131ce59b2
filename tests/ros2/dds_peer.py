"""A program on DDS that is none of ours and no ROS (Cyclone DDS): reads topics of the bridge and
publishes to it, on this computer only; prints what it saw as JSON.

    dds_peer.py watch COUNT     until COUNT messages of each stream have come
    dds_peer.py pull            publishes a hand target until the handle has followed it

ROS_DOMAIN_ID is the domain.
"""

import json
import os
import sys
import time
from dataclasses import dataclass

DOMAIN = int(os.environ["ROS_DOMAIN_ID"])
os.environ["CYCLONEDDS_URI"] = """<CycloneDDS><Domain><General><AllowMulticast>false</AllowMulticast>
  <Interfaces><NetworkInterface address="127.0.0.1"/></Interfaces></General>
  <Discovery><ParticipantIndex>auto</ParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers></Discovery>
</Domain></CycloneDDS>"""

from cyclonedds.core import Policy, Qos  # noqa: E402
from cyclonedds.domain import DomainParticipant  # noqa: E402
from cyclonedds.idl import IdlStruct  # noqa: E402
from cyclonedds.idl.annotations import final  # noqa: E402
from cyclonedds.idl.types import float64, int32, sequence, uint32  # noqa: E402
from cyclonedds.pub import DataWriter  # noqa: E402
from cyclonedds.sub import DataReader  # noqa: E402
from cyclonedds.topic import Topic  # noqa: E402
from cyclonedds.util import duration  # noqa: E402

PATIENCE = 60.0  # s


@final
@dataclass
class Time(IdlStruct, typename="builtin_interfaces.msg.dds_.Time_"):
    sec: int32
    nanosec: uint32


@final
@dataclass
class Header(IdlStruct, typename="std_msgs.msg.dds_.Header_"):
    stamp: Time
    frame_id: str


@final
@dataclass
class JointState(IdlStruct, typename="sensor_msgs.msg.dds_.JointState_"):
    header: Header
    name: sequence[str]
    position: sequence[float64]
    velocity: sequence[float64]
    effort: sequence[float64]


@final
@dataclass
class Vector3(IdlStruct, typename="geometry_msgs.msg.dds_.Vector3_"):
    x: float64
    y: float64
    z: float64


@final
@dataclass
class Quaternion(IdlStruct, typename="geometry_msgs.msg.dds_.Quaternion_"):
    x: float64
    y: float64
    z: float64
    w: float64


@final
@dataclass
class Transform(IdlStruct, typename="geometry_msgs.msg.dds_.Transform_"):
    translation: Vector3
    rotation: Quaternion


@final
@dataclass
class TransformStamped(IdlStruct, typename="geometry_msgs.msg.dds_.TransformStamped_"):
    header: Header
    child_frame_id: str
    transform: Transform


@final
@dataclass
class TFMessage(IdlStruct, typename="tf2_msgs.msg.dds_.TFMessage_"):
    transforms: sequence[TransformStamped]


@final
@dataclass
class Pose(IdlStruct, typename="geometry_msgs.msg.dds_.Pose_"):
    position: Vector3
    orientation: Quaternion


@final
@dataclass
class PoseStamped(IdlStruct, typename="geometry_msgs.msg.dds_.PoseStamped_"):
    header: Header
    pose: Pose


@final
@dataclass
class String(IdlStruct, typename="std_msgs.msg.dds_.String_"):
    data: str


STREAM = Qos(Policy.Reliability.Reliable(duration(seconds=1)), Policy.History.KeepLast(100),
             Policy.DataRepresentation(use_cdrv0_representation=True))
LATCHED = Qos(Policy.Reliability.Reliable(duration(seconds=1)), Policy.Durability.TransientLocal,
              Policy.DataRepresentation(use_cdrv0_representation=True))


def reader(participant, kind, name, qos=STREAM):
    return DataReader(participant, Topic(participant, "rt" + name, kind, qos=qos), qos=qos)


def samples(source):
    return [one for one in source.take(100) if getattr(one, "sample_info", None) is None
            or one.sample_info.valid_data]


def watch(participant, count):
    seen = {name: [] for name in ("/joint_states", "/twin/joint_states", "/limits", "/tf")}
    readers = {name: reader(participant, TFMessage if name == "/tf" else JointState, name) for name in seen}
    description = reader(participant, String, "/robot_description", LATCHED)
    urdf = []
    until = time.monotonic() + PATIENCE
    while time.monotonic() < until and not (urdf and all(len(got) >= count for got in seen.values())):
        for name, one in readers.items():
            seen[name] += samples(one)
        urdf += samples(description)
        time.sleep(0.02)
    return {
        "joints": {name: [[m.header.stamp.sec * 10**9 + m.header.stamp.nanosec, list(m.name), list(m.position)]
                          for m in got] for name, got in seen.items() if name != "/tf"},
        "frames": [sorted(one.child_frame_id for one in m.transforms) for m in seen["/tf"]],
        "urdf": [one.data for one in urdf]}


def handle_of(frames):
    """Positions of the handle, m."""
    return [(t.x, t.y, t.z) for m in samples(frames) for one in m.transforms
            if one.child_frame_id == "handle" for t in (one.transform.translation,)]


def pull(participant):
    frames = reader(participant, TFMessage, "/tf")
    writer = DataWriter(participant, Topic(participant, "rt/hand_target", PoseStamped, qos=STREAM), qos=STREAM)
    start = at = None
    until = time.monotonic() + PATIENCE
    while time.monotonic() < until:
        for at in handle_of(frames):
            start = start or at
        if start:
            target = Vector3(start[0] + 0.05, start[1] + 0.05, start[2])
            writer.write(PoseStamped(Header(Time(0, 0), "base"), Pose(target, Quaternion(0.0, 0.0, 0.0, 0.0))))
            if sum((a - b)**2 for a, b in zip(at, start))**0.5 > 0.005:
                break
        time.sleep(0.02)
    return {"start": start, "end": at}


def main():
    participant = DomainParticipant(DOMAIN)
    result = watch(participant, int(sys.argv[2])) if sys.argv[1] == "watch" else pull(participant)
    print(json.dumps(result), flush=True)


main()
