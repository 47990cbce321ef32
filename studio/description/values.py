"""Results of the description room: parts with their origins, sites, and findings.

All values are plain and frozen, so that they cross the worker's pipe as msgpack.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Final

from studio.description.elements import Element  # noqa: TC001 - msgspec reads it
from studio.problems import MacroCall, Place, Problem  # noqa: TC001 - msgspec reads them

PATCH_DIFFERED: Final = "patch-differed"


class SiteKind(StrEnum):
    """Kind of an editable text in its file."""

    ARG = "arg"
    PROPERTY = "property"
    YAML = "yaml"
    PARAM_DEFAULT = "param_default"
    LITERAL = "literal"


class WidgetKind(StrEnum):
    """How a site is edited: `VECTOR` is two or more numbers separated by blanks."""

    SLIDER = "slider"
    SWITCH = "switch"
    CHOICE = "choice"
    VECTOR = "vector"
    TEXT = "text"


@dataclass(frozen=True, slots=True)
class Widget:
    """Editing control of a site; `minimum`, `maximum` and `step` are in `unit`, the file's unit."""

    kind: WidgetKind
    minimum: float | None = None
    maximum: float | None = None
    step: float | None = None
    unit: str = ""
    """m, rad, kg, N m, rad/s ... ; empty when not known. Angles are in rad here, as in the file."""
    choices: tuple[str, ...] = ()
    help: str = ""
    annotated: bool = False
    """A comment in the file gives the range or choices; else they are inferred."""


@dataclass(frozen=True, slots=True)
class Span:
    """A site's raw bytes: `start` and `end` are byte offsets in the present file.

    `syntax` is how text is written there: `"` or `'` (an XML attribute in those quotes),
    `yaml` (a scalar, its quotes if any inside the span), `param` (one default inside the
    `params` attribute of a macro, whose quote is `"`), `param'` (the same in `'`).
    """

    start: int
    end: int
    syntax: str


@dataclass(frozen=True, slots=True)
class Site:
    """One text in a source file that can be edited, and its value in the last run."""

    id: str
    """Stable over edits of its own and other texts, e.g. `/p/urdf/a.xacro#12@value`."""
    kind: SiteKind
    name: str
    """Property or arg name; dotted key path; or `<element path> @attribute` for a literal."""
    place: Place
    span: Span
    text: str
    """The text as written, entities resolved."""
    value: str
    """Its value, as xacro prints it; empty when it was not read in this configuration."""
    number: float | None
    """`value` as a number, when it is one."""
    reads: int
    """How many texts read it in this run; 0: no effect in this configuration."""
    widget: Widget
    group: str
    """Heading it is listed under: a section comment of the file, or a link or joint name."""
    owner: str = ""
    """For a literal: the one `link:<name>` or `joint:<name>` that it affects, if it is one."""
    values: tuple[str, ...] = ()
    """All distinct values, when there was more than one."""


@dataclass(frozen=True, slots=True)
class Edit:
    """Replace the bytes [start, end) of a file by `new`: the one edit primitive."""

    file: str
    start: int
    end: int
    new: bytes


@dataclass(frozen=True, slots=True)
class Part:
    """One top-level element of the expanded robot: a link, joint, material, or anything else."""

    key: str
    """`link:base_link`, `joint:wheel`, `material:red`, else `other:<n>`; a repeat ends in `#2`."""
    element: Element
    """The element of URDF, no xacro left in it."""
    place: Place
    calls: tuple[MacroCall, ...] = ()

    @property
    def xml(self) -> str:
        """The element as URDF text."""
        return self.element.xml


@dataclass(frozen=True, slots=True)
class Expansion:
    """What a run changed against the run before it (everything, for the first one).

    `part_order` and `site_order` are None when they stayed as they were.
    """

    robot_name: str
    root_attributes: tuple[tuple[str, str], ...]
    part_order: tuple[str, ...] | None
    changed_parts: tuple[Part, ...]
    site_order: tuple[str, ...] | None
    changed_sites: tuple[Site, ...]
    files: tuple[str, ...]
    """Every file that was read, the entry point first: what must be watched."""
    include_tree: tuple[tuple[str, str], ...]
    """(includer, included) pairs."""
    warnings: tuple[Problem, ...]
    evaluator: str
    """`studio`, or `xacro` when a construct needed the stock library."""
    fallback_reason: str = ""
    is_patch: bool = False
    """Whether only what depends on the edits was evaluated. Sites that merely moved with an edit
    before them in their file are then not among `changed_sites`."""
    is_recovered: bool = False
    """The texts are broken, and never gave a robot before: this is what could be read. Nothing can
    be edited but texts; `warnings` has what is wrong, as errors."""


@dataclass(frozen=True, slots=True)
class Failure:
    """A run that gave no robot; the run before it still stands. Sites stay as they were."""

    problem: Problem
    files: tuple[str, ...]
    """Files read before it failed, so that a change on disk of any of them tries again."""
    problems: tuple[Problem, ...] = ()
    """All faults, where more than `problem` is known; else empty."""


@dataclass(frozen=True, slots=True)
class ReadPolicy:
    """What a description may read: given to the worker once, checked whenever a file is opened.

    `packages` maps a name to its folders, the wanted one for `entry` first; `duplicates` are
    resolved per asking file by the longest shared path. `environment` is what `$(env)` sees.
    """

    roots: tuple[str, ...]
    packages: dict[str, tuple[str, ...]]
    environment: dict[str, str]
    trusted: bool = False


@dataclass(frozen=True, slots=True)
class OpenRequest:
    """Start a session on `entry` and run it. `overlay` holds unsaved texts by absolute path."""

    entry: str
    arguments: dict[str, str]
    policy: ReadPolicy
    overlay: dict[str, bytes]
    known: tuple[str, ...] = ()
    """Ids of attributes that were sites before: they are sites again, whatever they are now."""


@dataclass(frozen=True, slots=True)
class EditRequest:
    """Apply edits to the in-memory texts, in order, then run."""

    edits: tuple[Edit, ...]


@dataclass(frozen=True, slots=True)
class ArgumentsRequest:
    """Run again with these arguments."""

    arguments: dict[str, str]


@dataclass(frozen=True, slots=True)
class ReloadRequest:
    """Forget the in-memory texts of these files, take the overlay or the disk, then run."""

    files: tuple[str, ...]
    overlay: dict[str, bytes]


@dataclass(frozen=True, slots=True)
class VerifyRequest:
    """Run in full, and correct what patches made differently.

    The answer has a warning with the code PATCH_DIFFERED, or it `is_patch` without changes. A
    failure means that only patches could make the robot.
    """


@dataclass(frozen=True, slots=True)
class NoReply:
    """The question cannot be answered; `sentence` has the reason and advice."""

    sentence: str


@dataclass(frozen=True, slots=True)
class CheckQuery:
    """Asks what is wrong with the present texts, besides the problems of a run."""


@dataclass(frozen=True, slots=True)
class ReadRobot:
    """The robot that can be read of texts that are broken."""

    name: str
    parts: tuple[Part, ...]


@dataclass(frozen=True, slots=True)
class Checked:
    """Findings of the checks; where the texts are broken, of what can be read of them."""

    problems: tuple[Problem, ...]
    read: ReadRobot | None = None
    """Set while the texts are broken."""
