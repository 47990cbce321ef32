"""PointCloud2: points of any layout, as depth cameras, lidars and maps send them."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from studio.displays.cloud import Cloud, kept, stamp_of
from studio.displays.cloud_display import CloudDisplay
from studio.displays.cloud_fields import CloudFields
from studio.displays.display import Status, TopicRole

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from studio.displays.display import Received
    from studio.displays.limits import Limits


class PointCloud2Display(CloudDisplay):
    """Draws every point that has a place, or as many as the limits let be shown."""

    KIND: ClassVar[str] = "PointCloud2"
    DOC: ClassVar[str] = "Points in space, in colours that are sent or made of their numbers."
    TOPICS: ClassVar[tuple[TopicRole, ...]] = (
        TopicRole("", ("sensor_msgs/msg/PointCloud2",), reliable=False),
    )

    def read(self, received: Received, limits: Limits) -> Cloud:
        """The cloud of a message.

        Raises:
            StudioError: It cannot be read, or its data is not what its fields say.
        """
        message = self.decode(received)
        fields = CloudFields(message)
        positions, looked_at = fields.positions()
        shown, chosen, available = kept(positions, limits.points)
        if looked_at is not None:
            chosen = looked_at if chosen is None else looked_at[chosen]
            available = available * fields.count // len(looked_at)
        return Cloud(
            message.header.frame_id, stamp_of(message.header), shown, chosen, available, fields,
            _nothing(fields.count, shown),
        )  # fmt: skip


def _nothing(count: int, shown: NDArray[np.float32]) -> Status | None:
    if len(shown):
        return None
    if not count:
        return Status("warn", "no_points", "The cloud has no points.")
    sentence = f"None of the {count:,} points has a place: all are NaN or infinite."
    return Status("warn", "not_finite", sentence)
