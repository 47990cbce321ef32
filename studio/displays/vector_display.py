"""VectorDisplay: what displays of a push and a turn have in common."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar, Final

from studio.displays.display import Status
from studio.displays.history import Entry, HistoryDisplay, frame_and_stamp
from studio.displays.pose_look import NOT_FINITE, switch
from studio.displays.vector_look import (
    Names,
    Vectors,
    scale_of,
    too_short,
    vector_properties,
    vector_shapes,
    vectors_of,
)

if TYPE_CHECKING:
    from studio.displays.display import Received
    from studio.displays.drawing import Shape

HIDE_SMALL: Final = "Hide Small Values"
SCREW: Final = Names("Linear", "Angular")
SCREW_PROPERTIES: Final = (
    *vector_properties(SCREW),
    switch(HIDE_SMALL, "Whether arrows that are shorter than wide are hidden.", on=True),
)


class VectorDisplay(HistoryDisplay[Vectors]):
    """Draws the last pairs of a push and a turn."""

    NAMES: ClassVar[Names]
    KEEPS = "History Length"

    @abstractmethod
    def parts(self, message: Any) -> tuple[Any, Any]:  # noqa: ANN401 - messages
        """The two geometry_msgs/Vector3 of a message."""

    def read(self, received: Received) -> Entry[Vectors] | None:
        """The vectors, unless their numbers cannot be drawn."""
        message = self.decode(received)
        vectors = vectors_of(*self.parts(message))
        if vectors is None:
            return self.refuse("not_finite", NOT_FINITE)
        return Entry(*frame_and_stamp(message.header), vectors)

    def shapes(self, content: Vectors) -> dict[str, Shape]:
        """An arrow each, and a circle about the one that turns."""
        return vector_shapes(content, self.NAMES, self.values, small_too=self._small_too)

    def sizes(self) -> tuple[str, ...]:
        """The scales of the newest vectors that are not zero."""
        if self.newest is None:
            return ()
        pairs = zip(self.NAMES, self.newest.content, strict=True)
        return tuple(scale_of(name) for name, vector in pairs if vector.any())

    def statuses(self) -> tuple[Status, ...]:
        """Also that the newest arrows are too short to be seen."""
        newest = self.newest
        if newest is None or self._small_too:
            return super().statuses()
        short = too_short(newest.content, self.NAMES, self.values)
        said = () if short is None else (Status("warn", "empty", *short),)
        return (*said, *super().statuses())

    @property
    def _small_too(self) -> bool:
        return self.values.get(HIDE_SMALL, True) is False
