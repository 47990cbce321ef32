"""Answers about where a part comes from, and about what a text affects: plain values."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from studio.problems import Place  # noqa: TC001 - msgspec and pydantic read it


class InputKind(StrEnum):
    """Kind of an input in its file."""

    PROPERTY = "property"
    ARG = "arg"
    PARAMETER = "parameter"
    """Passed to a parameter by a macro call."""
    PARAM_DEFAULT = "param_default"
    YAML = "yaml"


@dataclass(frozen=True, slots=True)
class OriginInput:
    """One value behind a number. `inputs` are those that it was made of itself, as indices."""

    kind: InputKind
    name: str
    text: str
    """As written, entities resolved; of an arg that was given from outside, the default."""
    value: str
    """Its value, as xacro prints it; `{...}` and `[...]` for mappings and lists."""
    place: Place
    """Place of the text; of an arg that no file declares, one with an empty file."""
    site: str
    """Id when it can be edited, else empty."""
    given: bool
    """An arg whose value was given from outside."""
    inputs: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class OriginAttribute:
    """One attribute of a part, or a text in it, as it came out and as it is written."""

    element: str
    """Tags from below the part, e.g. `visual[2]/origin`; empty for the part's own."""
    attribute: str
    """Empty for the text of an element."""
    value: str
    text: str
    """As written, where it is an expression with a `$` in it, or anything else."""
    unit: str
    place: Place
    site: str
    """Id when the text itself can be edited."""
    inputs: tuple[int, ...]
    """The inputs of the expression, as indices."""


@dataclass(frozen=True, slots=True)
class OriginCall:
    """One macro call on the way to a part."""

    macro: str
    called_at: Place
    defined_at: Place
    arguments: tuple[int, ...]
    """The inputs bound to its parameters, as indices."""


@dataclass(frozen=True, slots=True)
class OriginCause:
    """A condition, a computed include or the like that a part owes its being there to."""

    tag: str
    text: str
    """Of the condition, file name ..."""
    place: Place
    inputs: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class PartOrigin:
    """Where a part comes from. All indices are into `inputs`; each is there once."""

    part: str
    place: Place
    include_chain: tuple[Place, ...]
    """The includes that led from the opened file to `place`, the outermost first."""
    calls: tuple[OriginCall, ...]
    """The outermost first."""
    causes: tuple[OriginCause, ...]
    """The outermost first."""
    attributes: tuple[OriginAttribute, ...]
    inputs: tuple[OriginInput, ...]
    is_cut: bool
    """Whether some were left out."""


class Aspect(StrEnum):
    """What changes about a part."""

    SIZE = "size"
    """The visible geometry's dimensions or scale."""
    SHAPE = "shape"
    """Another mesh file."""
    COLOR = "color"
    POSE = "pose"
    """Of a link: where its visible geometry is in it. Of a joint: where its child is."""
    COLLISION = "collision"
    INERTIA = "inertia"
    MOTION = "motion"
    """A joint's axis, limits, dynamics, mimicry, type."""
    NAME = "name"
    """Its name, or the names by which it refers to others."""
    OTHER = "other"
    PRESENCE = "presence"
    """Whether it is there at all, or which of several files or macros it comes from."""


@dataclass(frozen=True, slots=True)
class Effect:
    """One attribute that a text affects; for `PRESENCE` the whole element."""

    part: str
    element: str
    attribute: str
    aspect: Aspect


@dataclass(frozen=True, slots=True)
class SiteEffects:
    """Effects of a text on the robot as it is; none: it has none in this configuration."""

    site: str
    effects: tuple[Effect, ...]
    decisions: int
    """Conditions and the like that it decides, also those of which nothing comes now."""
    readers: tuple[Place, ...]
    """Where it is read directly, each place once, in the order of the run."""
    is_cut: bool
    """Whether some were left out."""


@dataclass(frozen=True, slots=True)
class PartOriginQuery:
    """Asks where a part comes from; `part` is a `Part.key`."""

    part: str


@dataclass(frozen=True, slots=True)
class SiteEffectsQuery:
    """Asks for the effects of a text; `site` is a `Site.id`."""

    site: str
