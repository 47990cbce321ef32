"""Answers to `get_origin` and `get_effects`: where a part comes from, and what a text shapes."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from studio.description.origins.origin_values import Aspect, PartOrigin
from studio.problems import Place
from studio.protocol.message import Command, Event, Message


class Origin(Event):
    """Answer to `get_origin`, true of the last good run: ask again when something was built."""

    type: Literal["origin"] = "origin"
    request: int
    origin: PartOrigin


class PartEffect(Message):
    """The effect of a text on one part."""

    part: str
    """`link:<name>`, `joint:<name>`, `material:<name>` or `other:<n>`."""
    aspects: tuple[Aspect, ...]


class Effects(Event):
    """Answer to `get_effects`, true of the last good run; without parts the text shapes nothing."""

    type: Literal["effects"] = "effects"
    request: int
    site: str
    parts: tuple[PartEffect, ...]
    """Parts that an attribute of changes, the first 1000."""
    changed_links: tuple[str, ...]
    """Links with another size, mesh or colour, or that exist only because of the text."""
    moved_links: tuple[str, ...]
    """Links that only sit elsewhere, those below a moved joint too."""
    links_there: int
    """Links that are there as a whole because of the text."""
    joints_there: int
    counts: dict[Aspect, int]
    """Number of all other parts by aspect; `pose` and `color` count links."""
    decisions: int
    """Conditions and the like that the text decides, also where nothing comes of it now."""
    readers: tuple[Place, ...]
    """Places that read the text directly."""
    is_cut: bool
    """Whether some were left out."""


class GetOrigin(Command):
    """Ask where a part of the last good run comes from: `link:<name>`, `joint:<name>` ..."""

    type: Literal["get_origin"] = "get_origin"
    part: str = Field(max_length=4096)


class GetEffects(Command):
    """Ask for the effects of a site on the robot of the last good run."""

    type: Literal["get_effects"] = "get_effects"
    site: str = Field(max_length=8192)
