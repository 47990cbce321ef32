"""What a check of the robot finds, and how it can be mended, before it is known where it stands."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from studio.problems import Severity


@dataclass(frozen=True, slots=True)
class SwapAttributes:
    """Let two attributes of a child element change their texts, whatever these are."""

    label: str
    tag: str
    one: str
    other: str


@dataclass(frozen=True, slots=True)
class SetAttributes:
    """Give attributes of elements below the part these texts; what is missing is put in.

    `path` names the tags from the part's element down, `*` is any. Of several elements there,
    `where` picks those that have an attribute with that text as written.
    """

    label: str
    path: tuple[str, ...]
    texts: tuple[tuple[str, str], ...]
    where: tuple[str, str] | None = None
    is_for_one: bool = False
    """The texts hold for this part alone: not in a macro, which may write others."""


@dataclass(frozen=True, slots=True)
class AddChild:
    """Write one more element, `xml`, as the last inside the part's own."""

    label: str
    xml: str


@dataclass(frozen=True, slots=True)
class RemoveChild:
    """Take the only child with that tag away, with all that it holds."""

    label: str
    tag: str


Mend: TypeAlias = SwapAttributes | SetAttributes | AddChild | RemoveChild


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that is wrong with a part of the robot.

    `key` is the part (`link:<name>`, `joint:<name>`), empty for the robot as a whole; `others` are
    parts that it touches as well.
    """

    severity: Severity
    code: str
    sentence: str
    key: str
    mend: Mend | None = None
    others: tuple[str, ...] = ()
