"""A bag of the arm: it drives in a circle and swings, logs, is diagnosed, and sees a point."""

from __future__ import annotations

import math
from functools import cache
from typing import TYPE_CHECKING, Any, Final

from studio.bags.recording import RecordedTopic
from studio.bags.writer import BagWriter, Storing
from studio.ros.attachment import Attachment
from studio.ros.cdr import codec_of
from studio.ros.node.samples import RawSample
from studio.ros.qos import DurabilityPolicy, QoSProfile
from studio.ros.types.convert import from_dict
from tests.support.display_messages import TYPES, encoded
from tests.support.wired_studio import ARM

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

BEGIN_NS: Final = 1_700_000_000_000_000_000
LENGTH_S: Final = 20.0
URDF: Final = ARM.replace("${reach}", "0.5")
LATCHED: Final = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
KINDS: Final = {
    "/clock": "rosgraph_msgs/msg/Clock",
    "/robot_description": "std_msgs/msg/String",
    "/tf": "tf2_msgs/msg/TFMessage",
    "/tf_static": "tf2_msgs/msg/TFMessage",
    "/joint_states": "sensor_msgs/msg/JointState",
    "/rosout": "rcl_interfaces/msg/Log",
    "/diagnostics": "diagnostic_msgs/msg/DiagnosticArray",
    "/goal": "geometry_msgs/msg/PointStamped",
    "/map": "nav_msgs/msg/OccupancyGrid",
    "/silent": "std_msgs/msg/String",
}
_Told = tuple[str, float, dict[str, Any]]


def angle_rad(at_s: float) -> float:
    """How far the shoulder is turned."""
    return 0.9 * math.sin(at_s)


def base_pose(at_s: float) -> tuple[float, float, float]:
    """Where the base is in the map, x, y and yaw."""
    return math.cos(0.3 * at_s), math.sin(0.3 * at_s), 0.3 * at_s


def stamp(at_s: float) -> dict[str, int]:
    """As a message has it."""
    at_ns = BEGIN_NS + round(at_s * 1e9)
    return {"sec": at_ns // 10**9, "nanosec": at_ns % 10**9}


def transform(
    parent: str, child: str, at_s: float, x: float = 0.0, y: float = 0.0, yaw: float = 0.0
) -> dict[str, Any]:
    """A geometry_msgs TransformStamped."""
    turn = {"x": 0.0, "y": 0.0, "z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}
    return {
        "header": {"frame_id": parent, "stamp": stamp(at_s)},
        "child_frame_id": child,
        "transform": {"translation": {"x": x, "y": y, "z": 0.0}, "rotation": turn},
    }


def told(*, with_robot: bool = True) -> Iterator[_Told]:
    """Every message, by topic and time in s, in the order of their times."""
    yield "/tf_static", 0.0, {"transforms": [transform("upper", "tip", 0.0, 0.5)]}
    if with_robot:
        yield "/robot_description", 0.01, {"data": URDF}
    yield "/map", 0.02, _map()
    for number in range(round(LENGTH_S * 100)):
        at_s = 0.05 + number / 100
        if number % 5 == 0:
            x, y, yaw = base_pose(at_s)
            yield "/tf", at_s, {"transforms": [transform("map", "base", at_s, x, y, yaw)]}
            moved = [transform("base", "upper", at_s, yaw=angle_rad(at_s))]
            yield "/tf", at_s + 0.001, {"transforms": moved}
        if number % 2 == 0:
            header = {"stamp": stamp(at_s), "frame_id": ""}
            position = [angle_rad(at_s)]
            states = {"header": header, "name": ["shoulder"], "position": position}
            yield "/joint_states", at_s + 0.002, states
        if number % 10 == 0:
            header = {"frame_id": "base", "stamp": stamp(at_s)}
            yield "/goal", at_s + 0.003, {"header": header, "point": {"x": at_s}}
        if number % 100 == 0:
            second = round(at_s)
            line = {"stamp": stamp(at_s), "level": 20, "name": "arm", "msg": f"second {second}"}
            yield "/rosout", at_s + 0.004, line
            status = {"name": "motor", "message": f"{second}", "level": b"\0"}
            yield "/diagnostics", at_s + 0.005, {"status": [status]}


def _map() -> dict[str, Any]:
    about = {"resolution": 0.5, "width": 4, "height": 4}
    return {"header": {"frame_id": "map"}, "info": about, "data": [0] * 16}


def write_arm_bag(folder: Path, *, with_robot: bool = True, storing: Storing | None = None) -> Path:
    """Write the bag into a folder that is not there yet, and return it."""
    with BagWriter(folder, TYPES, storing) as writer:
        numbers: dict[str, int] = {}
        for name, kind in KINDS.items():
            if name == "/clock" or (name == "/robot_description" and not with_robot):
                continue
            latched = name in {"/robot_description", "/tf_static", "/map"}
            qos = LATCHED if latched else QoSProfile(depth=10)
            topic = RecordedTopic(name, kind, TYPES.hash_of(kind), (qos,))
            numbers[name] = writer.add_topic(topic)
        for name, sample in _samples(with_robot=with_robot):
            writer.write(numbers[name], sample)
    return folder


@cache  # two seconds of work, which dozens of tests begin with
def _samples(*, with_robot: bool) -> list[tuple[str, RawSample]]:
    """Every message as it is written, with its topic."""
    samples: list[tuple[str, RawSample]] = []
    for name, at_s, fields in told(with_robot=with_robot):
        at_ns = BEGIN_NS + round(at_s * 1e9)
        payload = encoded(KINDS[name], fields) if "header" in fields else _plain(name, fields)
        samples.append((name, RawSample(payload, Attachment(0, at_ns, bytes(16)), at_ns)))
    return samples


def _plain(name: str, fields: dict[str, Any]) -> bytes:
    kind = TYPES.message(KINDS[name])
    return bytes(codec_of(kind).encode(from_dict(kind, fields)))
