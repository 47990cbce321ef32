"""MessageContext: a message that waits until its transforms are known."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from studio.errors import ExtrapolationError
from studio.tf.rotations import compose

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from studio.ros.types.classes import MessageValue
    from studio.tf.buffer import FramePose

Lookup: TypeAlias = "Callable[[str, str, int], FramePose]"
"""As `TransformBuffer.fixed_from`: target frame, source frame, stamp in ns; raises a FrameError."""


@dataclass(slots=True)
class _Placed:
    """Something with a header and a pose."""

    header: MessageValue
    pose: MessageValue


class MessageContext:
    """An update or an answer, and those of its poses whose transforms are still to come.

    Poses with a stamp are brought into the target frame once, at that stamp; of those without,
    the frame must be known. Without a lookup nothing is waited for.

    Args:
        message: Is changed in place.
        lookup: Where frames are.
        target_frame: The frame that everything is shown in.
    """

    def __init__(self, message: MessageValue, lookup: Lookup | None, target_frame: str) -> None:
        self.message = message
        self._lookup, self._target = lookup, target_frame
        self._open = list(_poses_of(message)) if lookup is not None and target_frame else []

    @property
    def is_ready(self) -> bool:
        """Whether all transforms are known."""
        return not self._open

    def get_transforms(self) -> None:
        """Look up what is still open.

        Raises:
            FrameError: A frame is not known, or the stamp is older than its transforms.
        """
        self._open = [one for one in self._open if not self._place(one)]

    def _place(self, placed: _Placed) -> bool:
        """Bring a pose into the target frame; False: its transform is still to come."""
        header, lookup = placed.header, self._lookup
        if lookup is None or header.frame_id == self._target:
            return True
        stamp_ns = header.stamp.sec * 1_000_000_000 + header.stamp.nanosec
        try:
            found = lookup(self._target, header.frame_id, stamp_ns)
        except ExtrapolationError as error:
            if error.may_come:
                return False
            raise
        if stamp_ns:
            _move((*found.wxyz, *found.xyz), placed.pose)
            header.frame_id = self._target
        return True


def _poses_of(message: MessageValue) -> Iterator[_Placed]:
    """Yield all that has a frame; the answer of the service has markers alone."""
    for marker in message.markers:
        yield _Placed(marker.header, marker.pose)
        for control in marker.controls:
            for one in control.markers:
                if one.header.frame_id:
                    yield _Placed(one.header, one.pose)
    for one in getattr(message, "poses", ()):
        yield _Placed(one.header, one.pose)


def _move(target_from_source: tuple[float, ...], pose: MessageValue) -> None:
    """Express a pose in another frame, in place."""
    position, turn = pose.position, pose.orientation
    w, x, y, z, *xyz = target_from_source
    source_from_object = (
        turn.w, turn.x, turn.y, turn.z, position.x, position.y, position.z,
    )  # fmt: skip
    moved = compose((w, x, y, z, xyz[0], xyz[1], xyz[2]), source_from_object)
    turn.w, turn.x, turn.y, turn.z = moved[:4]
    position.x, position.y, position.z = moved[4:]
