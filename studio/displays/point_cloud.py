"""PointCloud: points with channels of numbers, the older message that some drivers still send."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Final

import numpy as np

from studio.displays.cloud import Cloud, kept, nothing_of, rgb_of_shares
from studio.displays.cloud_display import CloudDisplay
from studio.displays.display import TopicRole
from studio.ros.columns.clouds import POINT_CLOUD, read_point_cloud

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.displays.display import Limits, Received
    from studio.ros.columns.clouds import CloudColumns

_PACKED: Final = ("rgb", "rgba")
_PARTS: Final = ("r", "g", "b")
_PLACES: Final = ("x", "y", "z")


class ChannelFields:
    """The channels of one message; one with another count than the points has is as if not there.

    As RViz shows them: `rgb` holds a packed colour in the bits of a float, and `r`, `g` and `b`
    are fractions.
    """

    def __init__(self, columns: CloudColumns) -> None:
        self._points, count = columns.points, len(columns.points)
        self._channels = {
            name: values for name, values in columns.channels.items() if len(values) == count
        }
        self.names: tuple[str, ...] = (*_PLACES, *self._channels)

    @property
    def size_bytes(self) -> int:
        """Memory that the message takes."""
        return self._points.nbytes + sum(one.nbytes for one in self._channels.values())

    def numbers(self, name: str, raw: NDArray[np.intp] | None) -> NDArray[np.float32] | None:
        """Return the numbers of a channel for these points, all when None; None without it."""
        values = self._channels.get(name)
        if values is None and name in _PLACES:
            values = self._points[:, _PLACES.index(name)]
        return values if values is None or raw is None else values[raw]

    def colours(self, raw: NDArray[np.intp] | None) -> NDArray[np.uint8] | None:
        """Colours packed into the bits of a channel, shape (N, 3); None when there are none."""
        name = next((one for one in _PACKED if one in self._channels), None)
        packed = None if name is None else self.numbers(name, raw)
        if packed is None:
            return None
        bits = np.ascontiguousarray(packed).view(np.uint32)
        parts = [(bits >> np.uint32(shift)).astype(np.uint8) for shift in (16, 8, 0)]
        return np.stack(parts, axis=1)

    def float_colours(self, raw: NDArray[np.intp] | None) -> NDArray[np.uint8] | None:
        """Colours of channels r, g and b between 0 and 1, shape (N, 3); None without them."""
        parts = [self.numbers(one, raw) for one in _PARTS]
        there = [one for one in parts if one is not None]
        return rgb_of_shares(there) if len(there) == len(_PARTS) else None


class PointCloudDisplay(CloudDisplay):
    """Draws every point that has a position, or as many as the limits allow."""

    KIND: ClassVar[str] = "PointCloud"
    DOC: ClassVar[str] = "Points with channels of numbers, as older drivers send them."
    ICON: ClassVar[str] = "cloud"
    TOPICS: ClassVar[tuple[TopicRole, ...]] = (TopicRole("", (POINT_CLOUD,), reliable=False),)

    def read(self, received: Received, limits: Limits) -> Cloud:
        """Return the cloud of a message.

        Raises:
            CdrError: The bytes are none.
        """
        columns = read_point_cloud(received.cdr)
        shown, chosen, available = kept(columns.points, limits.points)
        fields = ChannelFields(columns)
        nothing = nothing_of(len(columns.points), shown)
        return Cloud(columns.frame, columns.stamp_ns, shown, chosen, available, fields, nothing)
