"""Interactive markers: what of them can be moved and clicked in the 3D view, and doing so."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import Field

from studio.protocol.displays import DisplayId
from studio.protocol.message import Command, Event, Message

_Number: TypeAlias = Annotated[int, Field(ge=0, le=2**53)]
_Part: TypeAlias = Annotated[float, Field(ge=-1e9, le=1e9, allow_inf_nan=False)]
Place: TypeAlias = tuple[_Part, _Part, _Part]
"""m."""
Turn: TypeAlias = tuple[_Part, _Part, _Part, _Part]
"""w, x, y, z; of any length but 0."""


class InteractWithMarker(Command):
    """Do something to an interactive marker; its server gets the feedback that RViz would send.

    A drag is a press, moves and a release. Whoever pressed holds the marker: others are refused
    until the release, or until nothing came for two seconds.
    """

    type: Literal["interact_with_marker"] = "interact_with_marker"
    display: DisplayId
    marker: _Number
    control: _Number | None = None
    """None: the title of the marker."""
    action: Literal["press", "move", "hold", "release", "select"]
    """`hold`: the button is down, and the mouse rests; `select`: an entry of the menu."""
    position: Place | None = None
    """Of the marker in its reference frame; None: where it is."""
    orientation: Turn | None = None
    turn_rad: _Part = 0.0
    """How far a control with a fixed orientation was turned by hand, about its axis."""
    mouse_point: Place | None = None
    """What the mouse points at, in the reference frame; None: at nothing."""
    entry: Annotated[int, Field(ge=0, le=2**32 - 1)] = 0
    """Id of an entry of the menu."""
    clicked: bool = False
    """Of a release: the mouse is still over the control."""


class ControlView(Message):
    """A control of an interactive marker."""

    number: int
    mode: int
    """As `InteractiveMarkerControl.interaction_mode`."""
    facing: int
    """As `orientation_mode`: 0 inherit, 1 fixed, 2 view facing."""
    wxyz: tuple[float, float, float, float]
    """Its orientation; it acts along and about its x."""
    independent: bool
    """Whether the shapes of a control that faces the eye turn with the marker."""
    always_visible: bool
    description: str


class MenuItemView(Message):
    """An entry of the menu of a marker; its parent is 0 in the menu itself."""

    id: int
    parent: int
    title: str
    checked: bool | None
    """None: it has no box."""


class MarkerView(Message):
    """An interactive marker; where it is, the 3D view knows."""

    number: int
    name: str
    description: str
    scale: float
    controls: tuple[ControlView, ...]
    menu: tuple[MenuItemView, ...]


class MarkersOfDisplay(Message):
    """The interactive markers of one display."""

    display: str
    visual_aids: bool
    """Whether the axis of a movement is shown."""
    markers: tuple[MarkerView, ...]


class InteractiveMarkers(Event):
    """All interactive markers of a document; sent when what can be done with them changes."""

    type: Literal["interactive_markers"] = "interactive_markers"
    displays: tuple[MarkersOfDisplay, ...]
