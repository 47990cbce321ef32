"""Topics for every kind of display that the demo rover does not tell of, at 10 Hz."""

from __future__ import annotations

import math
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from studio.displays.catalogue import DISPLAYS
from studio.ros.messages import message
from studio.ros.types.convert import from_dict
from tests.support.demos import node_at
from tests.support.display_messages import point, pose
from tests.support.display_samples import SAMPLES

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Mapping

    from studio.displays.display import Display
    from studio.ros.client import Node

    Fields = Mapping[str, Any]

ROVER: Final = {
    "Effort": "/joint_states",
    "Image": "/camera/image_raw",
    "Imu": "/imu",
    "LaserScan": "/scan",
    "Map": "/map",
    "MarkerArray": "/markers",
    "Odometry": "/odom",
    "Path": "/plan",
    "RobotModel": "/robot_description",
}
"""What the demo rover tells of, by the kind of display."""
_PERIOD_S: Final = 0.1
_POINTS: Final = 20_000
_FLOAT: Final = 7
_RNG: Final = np.random.default_rng(1)


@contextmanager
def told_topics(endpoint: str) -> Generator[dict[str, str]]:
    """A node tells of all other kinds; gives the topic of each kind that has one."""
    topics = {one.KIND: _topic(one) for one in DISPLAYS if one.TOPICS}
    with node_at(endpoint, "teller") as node:
        for kind in (one for one in DISPLAYS if one.KIND in topics and one.KIND not in ROVER):
            _tell(node, kind, topics[kind.KIND])
        yield topics


def _topic(kind: type[Display]) -> str:
    return ROVER.get(kind.KIND, f"/told/{kind.KIND.lower()}")


def _tell(node: Node, kind: type[Display], topic: str) -> None:
    """Publish messages of a kind, each another one, in the frame that the rover drives in."""
    type_name = kind.TOPICS[0].types[0]
    make = _MAKERS.get(kind.KIND) or _sample_of(kind.KIND, type_name)
    made = message(type_name)
    publisher = node.create_publisher(made, topic, 5)
    count = 0

    def tell() -> None:
        nonlocal count
        count += 1
        stamp = node.get_clock().now().to_msg()
        header = {"frame_id": "odom", "stamp": {"sec": stamp.sec, "nanosec": stamp.nanosec}}
        publisher.publish(from_dict(made, {"header": header, **make(count)}))

    node.create_timer(_PERIOD_S, tell)


def _sample_of(kind: str, type_name: str) -> Callable[[int], Fields]:
    """The same message each time, for a display of which nothing is made here."""
    known = (one for one in SAMPLES if (one.kind, one.type_name) == (kind, type_name))
    fields = next(known).fields
    return lambda _: fields


def _around(count: int) -> tuple[float, float, float]:
    return math.cos(count / 20), math.sin(count / 20), 0.5


def _vectors(first: str, second: str) -> Callable[[int], Fields]:
    def make(count: int) -> Fields:
        return {first: point(*_around(count)), second: point(*_around(-count))}

    return make


def _measured(field: str, middle: float, reach: float) -> Callable[[int], Fields]:
    return lambda count: {field: middle + reach * math.sin(count / 20)}


def _cloud(count: int) -> Fields:
    """Another number of points each time, so that no buffer fits the next one."""
    points = _POINTS + 100 * (count % 50)
    data = np.zeros((points, 4), np.float32)
    data[:, :3] = _RNG.uniform(-2, 2, (points, 3))
    data[:, 3] = data[:, 2]
    fields = [
        {"name": name, "offset": 4 * at, "datatype": _FLOAT, "count": 1}
        for at, name in enumerate(("x", "y", "z", "intensity"))
    ]
    return {
        "height": 1, "width": points, "fields": fields, "point_step": 16, "row_step": 16 * points,
        "data": data.view(np.uint8).ravel(),
    }  # fmt: skip


def _marker(count: int) -> Fields:
    """Markers come under new names, and end by themselves."""
    return {
        "ns": f"group {count % 5}", "id": count % 1000, "type": 1 + count % 3, "action": 0,
        "pose": pose(_around(count)), "scale": point(0.1, 0.1, 0.1),
        "color": {"r": 1.0, "g": 0.5, "b": 0.0, "a": 0.3 + 0.1 * (count % 8)},
        "lifetime": {"sec": 2, "nanosec": 0},
    }  # fmt: skip


def _range(count: int) -> Fields:
    reach = {"min_range": 0.1, "max_range": 4.0, "field_of_view": 0.4}
    return {**reach, "range": 1.0 + math.sin(count / 20) / 2}


_MAKERS: Final[dict[str, Callable[[int], Fields]]] = {
    "AccelStamped": lambda count: {"accel": _vectors("linear", "angular")(count)},
    "FluidPressure": _measured("fluid_pressure", 100_000.0, 5000.0),
    "GridCells": lambda count: {
        "cell_width": 0.1, "cell_height": 0.1,
        "cells": [point(0.1 * cell, 0.1 * (count % 20), 0.0) for cell in range(50 + count % 20)],
    },
    "Illuminance": _measured("illuminance", 500.0, 300.0),
    "Marker": _marker,
    "PointCloud2": _cloud,
    "PointStamped": lambda count: {"point": point(*_around(count))},
    "Polygon": lambda count: {
        "polygon": {"points": [point(*_around(count + 20 * at)) for at in range(6)]}
    },
    "Pose": lambda count: {"pose": pose(_around(count))},
    "PoseArray": lambda count: {"poses": [pose(_around(count + at)) for at in range(100)]},
    "PoseWithCovariance": lambda count: {
        "pose": {"pose": pose(_around(count)), "covariance": (0.1 * np.eye(6)).ravel().tolist()}
    },
    "Range": _range,
    "RelativeHumidity": _measured("relative_humidity", 0.5, 0.4),
    "Temperature": _measured("temperature", 40.0, 30.0),
    "TwistStamped": lambda count: {"twist": _vectors("linear", "angular")(count)},
    "Wrench": lambda count: {"wrench": _vectors("force", "torque")(count)},
}  # fmt: skip
