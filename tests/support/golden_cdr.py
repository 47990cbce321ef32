"""Messages as bytes, for the reader of the page: `python -m tests.support.golden_cdr` writes them.

Each with what its type is made of, in both orders of bytes, and as the codec here reads it.
"""

from __future__ import annotations

import asyncio
import json
import random
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from studio.live.connection.ros_connection import RosConnection
from studio.live.panels.interfaces import InterfaceTypes
from studio.protocol.interfaces import GetInterface
from studio.ros.cdr import Codec
from studio.ros.messages import message
from studio.ros.types.classes import class_of_field, definition_of
from studio.ros.types.convert import from_dict, to_dict
from studio.ros.types.definitions import INTEGERS, Shape
from studio.settings import WireChoice

if TYPE_CHECKING:
    from studio.ros.types.classes import MessageValue
    from studio.ros.types.definitions import Field

FILE: Final = Path(__file__).parents[1] / "golden" / "cdr" / "messages.json"
TYPES: Final = (
    "std_msgs/msg/Empty",
    "std_msgs/msg/String",
    "std_msgs/msg/Bool",
    "std_msgs/msg/Char",
    "std_msgs/msg/Byte",
    "std_msgs/msg/Int64",
    "std_msgs/msg/UInt64",
    "std_msgs/msg/Float32MultiArray",
    "geometry_msgs/msg/TwistStamped",
    "nav_msgs/msg/Odometry",
    "sensor_msgs/msg/JointState",
    "sensor_msgs/msg/LaserScan",
    "sensor_msgs/msg/CameraInfo",
    "sensor_msgs/msg/PointCloud2",
    "sensor_msgs/msg/BatteryState",
    "tf2_msgs/msg/TFMessage",
    "visualization_msgs/msg/MarkerArray",
    "action_msgs/msg/GoalStatusArray",
    "diagnostic_msgs/msg/DiagnosticArray",
    "rcl_interfaces/msg/ParameterEvent",
)
_TEXTS: Final = ("", "x", "base_link", "Grüße", "a text of more than thirty-two letters, all told")
_EACH: Final = 2


def golden() -> list[dict[str, Any]]:
    """Every case, the same at every call."""
    chance = random.Random(7)
    return [_case(name, chance) for name in TYPES for _ in range(_EACH)]


def _case(name: str, chance: random.Random) -> dict[str, Any]:
    kind = message(name)
    value = from_dict(kind, _fields(kind, chance))
    codec = Codec(kind)
    little = bytes(codec.encode(value))
    return {
        "type": name,
        "little": little.hex(),
        "big": bytes(codec.encode(value, little_endian=False)).hex(),
        "value": to_dict(codec.decode(little)),
    }


def schemas() -> dict[str, Any]:
    """What each type is made of, as the page is told."""
    interfaces = InterfaceTypes(RosConnection(WireChoice()))
    return {
        name: [
            one.model_dump()
            for one in asyncio.run(interfaces.interface(GetInterface(name=name))).messages
        ]
        for name in TYPES
    }


def _fields(kind: type[MessageValue], chance: random.Random) -> dict[str, Any]:
    return {field.name: _value(kind, field, chance) for field in definition_of(kind).fields}


def _value(kind: type[MessageValue], field: Field, chance: random.Random) -> Any:  # noqa: ANN401
    if field.type.shape is Shape.SINGLE:
        return _single(kind, field, chance)
    count = field.type.count if field.type.shape is Shape.ARRAY else chance.randrange(4)
    return [_single(kind, field, chance) for _ in range(count)]


def _single(kind: type[MessageValue], field: Field, chance: random.Random) -> Any:  # noqa: ANN401
    base = field.type.base
    if field.type.nested:
        return _fields(class_of_field(kind, field), chance)
    if base in INTEGERS:
        return chance.randint(*INTEGERS[base])
    if base == "bool":
        return chance.random() < 0.5
    return chance.randrange(-64, 64) / 8 if base.startswith("float") else chance.choice(_TEXTS)


def golden_text() -> str:
    """The file as it is to be."""
    return json.dumps({"schemas": schemas(), "cases": golden()}, indent=None, ensure_ascii=False)


if __name__ == "__main__":
    FILE.parent.mkdir(exist_ok=True)
    FILE.write_text(golden_text() + "\n", encoding="utf-8")
