"""MarkersDisplay: what the displays of single markers and of arrays of them have in common."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Final

from studio.displays.display import Display, Received, Status
from studio.displays.drawing import NOTHING
from studio.displays.markers.batches import MarkerBatches
from studio.displays.markers.statuses import statuses_of
from studio.displays.markers.store import MarkerStore
from studio.displays.properties import Property
from studio.ros.columns.markers import MarkerCodec

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.displays.drawing import Drawing
    from studio.displays.properties import Value
    from studio.ros.types.library import TypeLibrary

MARKER: Final = "visualization_msgs/msg/Marker"
MARKER_ARRAY: Final = "visualization_msgs/msg/MarkerArray"
NAMESPACES: Final = "Namespaces"


class MarkersDisplay(Display):
    """Markers of all topics of the display in one store, with a check for each namespace.

    A namespace has a property from when it is first heard of. One that was switched off before,
    as a saved display has it, stays off when it comes. Switching all off and on again leaves each
    as it was, so that what is saved means the same in whatever order it was set.
    """

    PROPERTIES: ClassVar[tuple[Property, ...]] = (
        Property(
            NAMESPACES, "switch", default=True, doc="Shows the namespaces that are on, or none."
        ),
    )
    SETTINGS_MAX = 2000

    def __init__(self, types: TypeLibrary, values: Mapping[str, Value] | None = None) -> None:
        super().__init__(types, values)
        self._store = MarkerStore()
        self._batches = MarkerBatches()
        self._codec = MarkerCodec()
        self._has_heard = False

    def properties(self) -> tuple[Property, ...]:
        """The switch for all, and one for each namespace that was heard of."""
        return (*self.PROPERTIES, *(_switch(_name_of(one)) for one in self._store.heard))

    def take(self, received: Received, role: str = "") -> None:
        """Take in a message.

        Raises:
            CdrError: The bytes are no such message.
        """
        del role
        if received.type_name == MARKER:
            columns = self._codec.decode_single(received.cdr)
        else:
            columns = self._codec.decode(received.cdr)
        self._has_heard = True
        self._store.take(columns, received.received_ns)

    def reset(self) -> None:
        """Forget all markers and namespaces; what was set of them stays."""
        self._store = MarkerStore()
        self._has_heard = False

    def draw(self, now_ns: int) -> Drawing:
        """What is there now, ns since the epoch."""
        self._store.expire(now_ns)
        if not self.values[NAMESPACES]:
            return NOTHING
        return self._batches.draw(self._store, self._hidden())

    def statuses(self) -> tuple[Status, ...]:
        """Troubles of markers, and why nothing is seen of those that are there."""
        hidden = self._hidden()
        found = statuses_of(self._store, hidden)
        if self._has_heard and not len(self._store) and not self._store.refused:
            words = "There are no markers: all were deleted, or their lifetime is over."
            found.append(Status("warn", "empty", words))
        elif len(self._store) and self._store.namespaces() <= hidden:
            words = "Markers are there, and all of their namespaces are switched off."
            found.append(Status("warn", "empty", words, (self._first_off(), True)))
        if self._batches.left_out:
            words = f"{self._batches.left_out} texts, meshes or batches are too many to be shown."
            found.append(Status("warn", "unsupported", words))
        return tuple(found)

    def _hidden(self) -> frozenset[str]:
        if not self.values[NAMESPACES]:
            return frozenset(self._store.namespaces())
        if all(self.values.values()):
            return frozenset()
        begin = len(_name_of(""))
        return frozenset(name[begin:] for name, shown in self.values.items() if not shown)

    def _first_off(self) -> str:
        if not self.values[NAMESPACES]:
            return NAMESPACES
        return _name_of(min(self._store.namespaces()))

    def _property(self, name: str) -> Property:
        if name.startswith(_name_of("")):
            return _switch(name)
        return super()._property(name)


def _name_of(namespace: str) -> str:
    return f"{NAMESPACES}/{namespace}"


def _switch(name: str) -> Property:
    return Property(name, "switch", default=True, doc="Shows the markers of this namespace.")
