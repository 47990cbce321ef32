"""Messages about variants: their list, and how two states of the robot differ."""

from __future__ import annotations

from typing import Final, Literal

from pydantic import Field

from studio.description.values import SiteKind
from studio.protocol.message import Command, Event, Message

TEXT_SHOWN: Final = 200
"""Letters of a text that lists show."""


def shown(text: str) -> str:
    """Return a text as lists show it."""
    return text if len(text) <= TEXT_SHOWN else f"{text[:TEXT_SHOWN]}…"


class Side(Message):
    """A state to compare: the present robot, the one on disk, or a variant."""

    kind: Literal["present", "saved", "variant"]
    name: str = Field(default="", max_length=100)
    """The variant's name."""


class VariantText(Message):
    """One text that a variant sets; `name` is for display."""

    file: str
    name: str
    text: str


class VariantView(Message):
    """One variant as the list shows it."""

    name: str
    note: str
    arguments: dict[str, str | None]
    """By name; None: it is not passed, although the document was opened with it."""
    texts: tuple[VariantText, ...]


class Variants(Event):
    """All variants. `active` is empty for the robot as in its files."""

    type: Literal["variants"] = "variants"
    variants: tuple[VariantView, ...]
    active: str
    modified: bool
    """The robot was changed since the active one was applied or saved."""
    path: str
    """The file that they are kept in."""
    only_here: str
    """Why they are kept for this session only; empty: they are in the file."""
    trouble: str
    """What is wrong with the file, in a sentence."""


class VariantApplied(Event):
    """Answer to `apply_variant`; `left_out` lists what found no place."""

    type: Literal["variant_applied"] = "variant_applied"
    request: int
    left_out: tuple[str, ...]


class VariantSaved(Event):
    """Answer to `save_variant` and `update_variant`: what of the robot no variant can hold."""

    type: Literal["variant_saved"] = "variant_saved"
    request: int
    left_out: tuple[str, ...]


class InputDifference(Message):
    """An argument or text that two states do not have alike; None: it is not passed."""

    kind: SiteKind
    name: str
    file: str
    line: int
    one: str | None
    other: str | None


class DifferenceView(Message):
    """One difference between two robots; None where one of them has no such value."""

    part: str
    """`link:<name>`, `joint:<name>`, or `robot` for the whole."""
    what: str
    """As `Row.what`."""
    number: int
    """Which visual or collision of a link, from 1; 0: none."""
    one: float | str | None
    other: float | str | None
    unit: str
    delta: float | None
    """`other` minus `one`, of numbers."""
    percent: float | None
    """Relative to `one`; None where that is 0."""


class Comparison(Event):
    """The differences between two states. `sides` None: none are compared."""

    type: Literal["comparison"] = "comparison"
    sides: tuple[Side, Side] | None
    busy: bool
    """One of them is being evaluated; the rest of the event is older."""
    faults: tuple[str, ...]
    """Why a side could not be worked out, a sentence each."""
    inputs: tuple[InputDifference, ...]
    rows: tuple[DifferenceView, ...]
    count: int
    """Number of all differences; `rows` may hold the first ones only."""
    ghost: Side | None
    """What the ghost shows."""


class SaveVariant(Command):
    """Keep the present arguments and values as a new variant."""

    type: Literal["save_variant"] = "save_variant"
    name: str = Field(max_length=100)
    note: str = Field(default="", max_length=2000)


class ApplyVariant(Command):
    """Change the robot to a variant as one undo step; an empty name to its state on disk."""

    type: Literal["apply_variant"] = "apply_variant"
    name: str = Field(max_length=100)


class UpdateVariant(Command):
    """Keep the present arguments and values in a variant that there is."""

    type: Literal["update_variant"] = "update_variant"
    name: str = Field(max_length=100)


class RenameVariant(Command):
    """Give a variant another name and note."""

    type: Literal["rename_variant"] = "rename_variant"
    name: str = Field(max_length=100)
    new_name: str = Field(max_length=100)
    note: str = Field(default="", max_length=2000)


class DeleteVariant(Command):
    """Forget a variant; the robot stays as it is."""

    type: Literal["delete_variant"] = "delete_variant"
    name: str = Field(max_length=100)


class CompareVariants(Command):
    """Compare two states for everybody from now on, and follow them; None ends it."""

    type: Literal["compare_variants"] = "compare_variants"
    sides: tuple[Side, Side] | None = None
