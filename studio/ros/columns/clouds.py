"""sensor_msgs/PointCloud as columns: the points as one array, and the numbers of each channel."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from studio.errors import CdrError
from studio.ros.columns.layout import BytesReader

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

POINT_CLOUD = "sensor_msgs/msg/PointCloud"
_POINT_BYTES: Final = 12
_CHANNEL_BYTES_LEAST: Final = 12
"""A name without a letter, and a list without a number."""
_CHANNELS_MAX: Final = 1000


class CloudColumns(NamedTuple):
    """The points of a message and their channels.

    Attributes:
        frame: `header.frame_id`.
        stamp_ns: Since the epoch.
        points: Shape (N, 3), float32, m.
        channels: By name, each of shape (M,), float32; of two with one name the first. M is N, if
            the publisher keeps to what the message promises.
    """

    frame: str
    stamp_ns: int
    points: NDArray[np.float32]
    channels: Mapping[str, NDArray[np.float32]]


def read_point_cloud(data: bytes | bytearray | memoryview) -> CloudColumns:
    """Read a sensor_msgs/PointCloud.

    Raises:
        CdrError: The bytes are none.
    """
    reader = BytesReader(bytes(data), POINT_CLOUD)
    stamp_ns, frame = reader.time_ns(), reader.text()
    points = _floats(reader, reader.count(_POINT_BYTES) * 3).reshape(-1, 3)
    count = reader.count(_CHANNEL_BYTES_LEAST)
    if count > _CHANNELS_MAX:
        raise CdrError(POINT_CLOUD, f"they have {count:,} channels, and {_CHANNELS_MAX:,} are read")
    channels: dict[str, NDArray[np.float32]] = {}
    for _ in range(count):
        name = reader.text()
        channels.setdefault(name, _floats(reader, reader.count(4)))
    return CloudColumns(frame, stamp_ns, points, channels)


def _floats(reader: BytesReader, count: int) -> NDArray[np.float32]:
    if not count:
        return np.empty(0, np.float32)
    at = reader.numbers(4, 4 * count)
    found = np.frombuffer(reader.raw, f"{reader.order}f4", count, at)
    return found.astype(np.float32, copy=False)
