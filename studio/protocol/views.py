"""Views of the 3D view: their kinds as RViz has them, and those that are saved with a document."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import Field, StringConstraints

from studio.protocol.displays import PropertyValue, PropertyView, ShortName
from studio.protocol.message import Command, Event, Message

ViewId: TypeAlias = Annotated[str, StringConstraints(max_length=20)]
Values: TypeAlias = Annotated[dict[str, PropertyValue], Field(max_length=100)]
"""Of a view, by RViz's names of its properties; what is not there has its first value."""


class GetViewKinds(Command):
    """Ask for the kinds of views."""

    type: Literal["get_view_kinds"] = "get_view_kinds"


class SaveView(Command):
    """Save a view with the document, for all who look at it."""

    type: Literal["save_view"] = "save_view"
    kind: ShortName
    name: ShortName
    values: Values
    before: ViewId = ""
    """The saved view that it comes to stand before; empty: at the end."""


class RenameView(Command):
    """Give a saved view another name."""

    type: Literal["rename_view"] = "rename_view"
    view: ViewId
    name: ShortName


class MoveView(Command):
    """Put a saved view before another; empty: at the end."""

    type: Literal["move_view"] = "move_view"
    view: ViewId
    before: ViewId = ""


class DeleteView(Command):
    """Delete a saved view."""

    type: Literal["delete_view"] = "delete_view"
    view: ViewId


class ViewKindView(Message):
    """A kind of view."""

    kind: str
    """RViz's class without its package, as `Orbit`."""
    doc: str
    properties: tuple[PropertyView, ...]


class ViewKinds(Event):
    """Answer to `get_view_kinds`, in RViz's order."""

    type: Literal["view_kinds"] = "view_kinds"
    request: int
    kinds: tuple[ViewKindView, ...]


class SavedView(Message):
    """A view that is saved with the document."""

    id: str
    kind: str
    name: str
    values: dict[str, PropertyValue]


class SavedViews(Event):
    """All views that are saved with a document, in order."""

    type: Literal["saved_views"] = "saved_views"
    views: tuple[SavedView, ...]
