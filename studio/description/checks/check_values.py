"""The question what the texts of a description have wrong, and its reply."""

from __future__ import annotations

from dataclasses import dataclass

from studio.description.values import Part  # noqa: TC001 - read at run time by msgspec
from studio.problems import Problem  # noqa: TC001 - as above


@dataclass(frozen=True, slots=True)
class CheckQuery:
    """What is wrong with the texts as they are now, beyond what a run tells?"""


@dataclass(frozen=True, slots=True)
class ReadRobot:
    """The robot that can be read of texts that are broken."""

    name: str
    parts: tuple[Part, ...]


@dataclass(frozen=True, slots=True)
class Checked:
    """What the checks found; where the texts are broken, over what can be read of them."""

    problems: tuple[Problem, ...]
    read: ReadRobot | None = None
    """Set while the texts are broken."""
