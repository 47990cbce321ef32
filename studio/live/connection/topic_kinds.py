"""What a topic carries: the types of its publishers, and the display that shows them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence


class OfType(Protocol):
    """An end of a topic."""

    @property
    def type_name(self) -> str:
        """As it publishes or subscribes."""
        ...


def carried_types(publishers: Iterable[OfType], subscribers: Iterable[OfType]) -> tuple[str, ...]:
    """Return the types published, sorted; the types subscribed when nobody publishes.

    A subscription with the wrong type receives nothing, so its type does not count.
    """
    types = {one.type_name for one in publishers} or {one.type_name for one in subscribers}
    return tuple(sorted(types))


def kinds_for(topic: str, types: Sequence[str]) -> tuple[str, ...]:
    """Return the displays that show one of these types, each once, the best first."""
    from studio.displays.catalogue import displays_of_type  # noqa: PLC0415 - only when it is used

    kinds = (kind.KIND for one in types for kind in displays_of_type(one, topic))
    return tuple(dict.fromkeys(kinds))


def kind_for(topic: str, types: Sequence[str]) -> str:
    """Return the display that shows the first of these types that any shows; empty: none does."""
    return next(iter(kinds_for(topic, types)), "")
