"""Microseconds to encode and decode a message, beside rosbags and mcap-ros2-support."""

from __future__ import annotations

import importlib
import timeit
from typing import TYPE_CHECKING, Any

import numpy as np
from rosbags.typesys import Stores, get_typestore

from studio.ros.cdr import Codec
from studio.ros.columns.markers import MarkerCodec
from studio.ros.columns.transforms import TransformCodec
from studio.ros.messages import message
from tests.benchmarks.report import judge_ratio, say

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.types.classes import MessageValue

FAST = {
    "tf2_msgs/msg/TFMessage": TransformCodec,
    "visualization_msgs/msg/MarkerArray": MarkerCodec,
}
_RUN_S = 0.05
_RUNS = 7


def run() -> None:
    """Measure each type in turn."""
    names = ("ours", "fast", "rosbags", "mcap-ros2")
    say("microseconds   " + "".join(f"{name:>20}" for name in names))
    say(" " * 15 + f"{'dec':>10}{'enc':>10}" * len(names))
    for title, value in messages().items():
        _measure(title, value)


def messages() -> dict[str, Any]:
    """What is measured, in sizes that robots send."""
    return {
        "String": message("std_msgs/msg/String")(data="Hello World of 40 letters, more or less."),
        "JointState 12": _joints(12),
        "Imu": message("sensor_msgs/msg/Imu")(),
        "TF 30": _transforms(30),
        "LaserScan 1080": _scan(1080),
        "Markers 200": _markers(200),
        "Cloud 4.8 MB": _cloud(300_000),
        "Image 6.2 MB": _image(1920, 1080),
    }


def _measure(title: str, value: MessageValue) -> None:
    kind = type(value)
    codec, peers = Codec(kind), Peers(kind)
    raw = bytes(codec.encode(value))
    peers.adopt(raw)
    ours = _us(lambda: codec.decode(raw)), _us(lambda: codec.encode(value))
    rosbags = _us(peers.decode_rosbags), _us(peers.encode_rosbags)
    mcap = _us(peers.decode_mcap), _us(peers.encode_mcap)
    fast = _fast(peers.name, raw)
    cells = "".join(" " * 19 + "-" if one is None else f"{one[0]:10.1f}{one[1]:10.1f}"
                    for one in (ours, fast, rosbags, mcap))  # fmt: skip
    say(f"{title:<15}{cells}")
    if fast is not None:
        judge_ratio(f"{title}: fast decode against rosbags", rosbags[0] / fast[0], at_least=5)
        judge_ratio(f"{title}: fast encode against rosbags", rosbags[1] / fast[1], at_least=5)


def _fast(name: str, raw: bytes) -> tuple[float, float] | None:
    """Measure columns under names that come again, and say what new names cost."""
    make: Any = FAST.get(name)
    if make is None:
        return None
    fast = make()
    columns = fast.decode(raw)
    new = _us(lambda: make().decode(raw)), _us(lambda: make().encode(columns))
    say(f"  names never seen before: decode {new[0]:.1f}, encode {new[1]:.1f} microseconds")
    return _us(lambda: fast.decode(raw)), _us(lambda: fast.encode(columns))


class Peers:
    """The two others, for one type."""

    def __init__(self, kind: type[MessageValue]) -> None:
        self.name = f"{kind.__module__.replace('.', '/')}/{kind.__name__}"
        self._store = get_typestore(Stores.ROS2_JAZZY)
        text: str = self._store.generate_msgdef(self.name, ros_version=2)[0]
        dynamic: Any = importlib.import_module("mcap_ros2._dynamic")  # it has no types
        self._read_mcap: Any = dynamic.generate_dynamic(self.name, text)[self.name]
        self._write_mcap: Any = dynamic.serialize_dynamic(self.name, text)[self.name]
        self._raw = b""
        self._of_rosbags: Any = None
        self._of_mcap: Any = None

    def adopt(self, raw: bytes) -> None:
        """Take a message up."""
        self._raw = raw
        self._of_rosbags, self._of_mcap = self.decode_rosbags(), self.decode_mcap()

    def decode_rosbags(self) -> object:
        """As fast as it can: of a memoryview it copies no arrays."""
        return self._store.deserialize_cdr(memoryview(self._raw), self.name)

    def encode_rosbags(self) -> object:
        """Write it."""
        return self._store.serialize_cdr(self._of_rosbags, self.name)

    def decode_mcap(self) -> object:
        """Read it."""
        return self._read_mcap(self._raw)

    def encode_mcap(self) -> object:
        """Write it."""
        return self._write_mcap(self._of_mcap)


def _us(run: Callable[[], object]) -> float:
    """Give the microseconds of the best of several runs: what others take is no part of it."""
    run()
    once_s = max(timeit.timeit(run, number=1), 1e-7)
    number = max(1, int(_RUN_S / once_s))
    return min(timeit.repeat(run, number=number, repeat=_RUNS)) / number * 1e6


def _header() -> Any:  # noqa: ANN401
    time = message("builtin_interfaces/msg/Time")(sec=1_763_733_600, nanosec=5)
    return message("std_msgs/msg/Header")(frame_id="base_link", stamp=time)


def _joints(count: int) -> Any:  # noqa: ANN401
    numbers = np.linspace(0, 1, count)
    names = [f"joint_{number}" for number in range(count)]
    return message("sensor_msgs/msg/JointState")(
        header=_header(), name=names, position=numbers, velocity=numbers, effort=numbers
    )


def _transforms(count: int) -> Any:  # noqa: ANN401
    stamped = message("geometry_msgs/msg/TransformStamped")
    return message("tf2_msgs/msg/TFMessage")(
        transforms=[
            stamped(header=_header(), child_frame_id=f"link_{number}") for number in range(count)
        ]
    )


def _scan(count: int) -> Any:  # noqa: ANN401
    ranges = np.full(count, 2.5, dtype=np.float32)
    return message("sensor_msgs/msg/LaserScan")(
        header=_header(), ranges=ranges, intensities=ranges, range_max=10.0
    )


def _markers(count: int) -> Any:  # noqa: ANN401
    marker = message("visualization_msgs/msg/Marker")
    return message("visualization_msgs/msg/MarkerArray")(
        markers=[marker(header=_header(), ns="lane", id=number, type=1) for number in range(count)]
    )


def _cloud(count: int) -> Any:  # noqa: ANN401
    return message("sensor_msgs/msg/PointCloud2")(
        header=_header(), height=1, width=count, point_step=16, row_step=16 * count,
        data=np.zeros(16 * count, dtype=np.uint8), is_dense=True,
    )  # fmt: skip


def _image(width: int, height: int) -> Any:  # noqa: ANN401
    return message("sensor_msgs/msg/Image")(
        header=_header(), width=width, height=height, encoding="rgb8", step=3 * width,
        data=np.zeros(3 * width * height, dtype=np.uint8),
    )  # fmt: skip
