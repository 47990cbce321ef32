"""What is selected in the 3D view: what was pointed at, and what is known of it."""

from __future__ import annotations

from typing import Annotated, Final, Literal, TypeAlias

from pydantic import Field, StringConstraints

from studio.protocol.displays import DisplayId
from studio.protocol.message import Command, Event, Message

ITEMS_MAX: Final = 4000
"""Items that can be selected at once."""
ROWS_MAX: Final = 40_000
"""Parts of one node that can be pointed at: a marker may have thousands."""
DETAILS_MAX: Final = 40
"""Items that are described in full at once."""
_NODES_MAX: Final = 2000
PART_NAME_MAX: Final = 400
PartName: TypeAlias = Annotated[
    str, StringConstraints(max_length=PART_NAME_MAX, pattern=r"^[^\x00]*$")
]
"""Of a group, a shape or an item within one display; checked where it is used."""
Row: TypeAlias = Annotated[int, Field(ge=0, lt=1 << 31)]


class PickedNode(Message):
    """A node of a display in the 3D view, and which of its parts were pointed at."""

    display: DisplayId
    path: PartName
    """Of the group that the node is in."""
    shape: PartName
    node: PartName
    """Last part of the node's name, which tells the nodes of one shape apart."""
    rows: Annotated[tuple[Row, ...], Field(max_length=ROWS_MAX)] = ()
    """Indices of its points, lines, solids or triangles."""
    place: tuple[float, float, float] | None = None
    """Where it was clicked, m in the frame of its group; None: by a rectangle."""


class PickItems(Command):
    """Ask what the items are that were pointed at."""

    type: Literal["pick_items"] = "pick_items"
    nodes: Annotated[tuple[PickedNode, ...], Field(max_length=_NODES_MAX)]


class ItemRef(Message):
    """An item of a display by its key; without a display it is a link of the document's robot."""

    display: DisplayId
    key: PartName


class ItemsPicked(Event):
    """Answer to `pick_items`: each item once."""

    type: Literal["items_picked"] = "items_picked"
    request: int
    items: tuple[ItemRef, ...]
    left_out: int
    """Items that are too many to be selected at once."""


class ItemKeys(Message):
    """Items of one display."""

    display: DisplayId
    keys: Annotated[tuple[PartName, ...], Field(max_length=ITEMS_MAX)]


class DescribeItems(Command):
    """Ask where items are now, and for all that is known of a few of them."""

    type: Literal["describe_items"] = "describe_items"
    items: Annotated[tuple[ItemKeys, ...], Field(max_length=500)]
    detailed: Annotated[tuple[ItemRef, ...], Field(max_length=DETAILS_MAX)] = ()


class ItemView(Message):
    """An item as it is now."""

    display: DisplayId
    key: str
    kind: str
    name: str
    path: str
    """Of the group that it is drawn in."""
    frame: str
    """Of its message."""
    stamp: str
    """Of its message, s since the epoch with nine decimals; empty: it has none."""
    place: tuple[float, float, float] | None
    """m in the fixed frame; None: its frame is not connected with that."""
    box: tuple[float, ...] | None
    """Around it in the frame of its group: middle x, y, z and edges x, y, z, m, then the turn w, x,
    y, z unless there is none. None: as large as what is drawn of the shape."""
    shape: str
    """Name of the shape in the group that it is drawn as; empty: all of them."""


class FactView(Message):
    """One thing known of an item."""

    name: str
    value: str | bool | int | float | tuple[float, ...]
    unit: str
    kind: str
    """"position", "orientation" (x, y, z, w), "vector", "colour" (red, green, blue, alpha from 0 to
    1), "field" (its name is the sender's); empty: a text or a number."""


class ItemDetails(Message):
    """All that is known of an item."""

    display: DisplayId
    key: str
    facts: tuple[FactView, ...]
    in_fixed: tuple[FactView, ...]
    """Its pose in the fixed frame."""


class ItemsDescribed(Event):
    """Answer to `describe_items`; items that are not named are gone."""

    type: Literal["items_described"] = "items_described"
    request: int
    fixed: str
    """The fixed frame."""
    items: tuple[ItemView, ...]
    details: tuple[ItemDetails, ...]
