"""SpreadDisplay: what displays of poses that say how sure they are have in common."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar

from studio.displays.covariance_look import (
    NOT_POSITIVE,
    Spread,
    covariance_shapes,
    is_covariance,
    spread_of,
)
from studio.displays.history import Entry, HistoryDisplay, frame_and_stamp
from studio.displays.pose_look import NOT_FINITE, pose_of, pose_shapes, pose_sizes

if TYPE_CHECKING:
    from studio.displays.display import Received
    from studio.displays.drawing import Shape


class SpreadDisplay(HistoryDisplay[Spread]):
    """Draws poses that have a covariance; derived classes say which turns they take."""

    UNDER: ClassVar[str] = ""
    """What stands before the names of the properties of a pose."""

    def read(self, received: Received) -> Entry[Spread] | None:
        """The pose and its covariance, unless their numbers cannot be drawn."""
        message = self.decode(received)
        pose = pose_of(message.pose.pose)
        spread = None if pose is None else spread_of(pose, message.pose.covariance)
        if spread is None:
            return self.refuse("not_finite", NOT_FINITE)
        if not self.takes_turn(message.pose.pose.orientation):
            return None
        if not is_covariance(spread):
            self.warn(None, NOT_POSITIVE)
        return Entry(*frame_and_stamp(message.header), spread)

    @abstractmethod
    def takes_turn(self, turn: Any) -> bool:  # noqa: ANN401 - a message
        """Whether a pose of this orientation is drawn; what is wrong with it is said."""

    def shapes(self, content: Spread) -> dict[str, Shape]:
        """The pose, an ellipsoid, and the spread of its axes."""
        pose = pose_shapes(content.pose, self.values, self.UNDER)
        return pose | covariance_shapes(content, self.values)

    def sizes(self) -> tuple[str, ...]:
        """How long the pose is: without, how sure it is may still be seen."""
        return pose_sizes(self.values, self.UNDER)
