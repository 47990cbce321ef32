"""The closed union of commands: what a browser may ask of the studio."""

from __future__ import annotations

from typing import Annotated, Final, Literal, TypeAlias

from pydantic import AfterValidator, Field, StringConstraints, TypeAdapter

from studio.engine.message import Message
from studio.engine.variant_events import Side

_OFFSET_LIMIT: Final = 1 << 32
"""More than any file that is opened is long."""


def _without_nul(name: str) -> str:
    if "\0" in name:
        raise ValueError("No name has a NUL in it.")
    return name


ArgumentName: TypeAlias = Annotated[
    str, StringConstraints(min_length=1, max_length=200), AfterValidator(_without_nul)
]
"""Of an `xacro:arg`: what can be passed as `name:=value`, and written down in a file."""


class CommandMessage(Message, allow_inf_nan=False):
    """What every command carries."""

    request: int = 0
    """Chosen by the browser; the answer repeats it."""
    document: str = ""
    """Id of the open document; empty for commands that need none."""


class Watch(CommandMessage):
    """Show me this document: its whole state now, then every change."""

    type: Literal["watch"] = "watch"


class OpenPath(CommandMessage):
    """Open a file, package folder, workspace folder or zip below the served roots."""

    type: Literal["open_path"] = "open_path"
    path: str
    arguments: dict[ArgumentName, str] = Field(default_factory=dict)


class CloseDocument(CommandMessage):
    """Close a document; refused while it has unsaved edits unless `discard`."""

    type: Literal["close_document"] = "close_document"
    discard: bool = False


class ListFolder(CommandMessage):
    """What a served folder holds; an empty path lists the served roots."""

    type: Literal["list_folder"] = "list_folder"
    path: str = ""


class EditSite(CommandMessage):
    """Write a new text at a site. All edits of one `gesture` are one undo step."""

    type: Literal["edit_site"] = "edit_site"
    site: str
    text: str = Field(max_length=100_000)
    gesture: str = ""


class ResetSite(CommandMessage):
    """Put a site back to what the file on disk says."""

    type: Literal["reset_site"] = "reset_site"
    site: str


class SetArgument(CommandMessage):
    """Pass an argument as `name:=value` on the command line would; None takes it back."""

    type: Literal["set_argument"] = "set_argument"
    name: ArgumentName
    value: str | None


class Undo(CommandMessage):
    """Take back the last step."""

    type: Literal["undo"] = "undo"


class Redo(CommandMessage):
    """Do again what was taken back."""

    type: Literal["redo"] = "redo"


class Save(CommandMessage):
    """Write the edited bytes of all changed files of the document."""

    type: Literal["save"] = "save"


class Reload(CommandMessage):
    """Read all files of the document from disk again; unsaved edits are given up."""

    type: Literal["reload"] = "reload"


class GetCollisions(CommandMessage):
    """Where a file's unsaved edits collide with what another program wrote."""

    type: Literal["get_collisions"] = "get_collisions"
    file: str = Field(max_length=4096)


class ResolveCollisions(CommandMessage):
    """Take a file's changes on disk; where they collide with unsaved edits, one side's."""

    type: Literal["resolve_collisions"] = "resolve_collisions"
    file: str = Field(max_length=4096)
    keep: Literal["mine", "theirs"]


class GetArguments(CommandMessage):
    """What a robot can be launched with: the open document's, or that of a file not yet open."""

    type: Literal["get_arguments"] = "get_arguments"
    path: str = Field(default="", max_length=4096)


class SetArguments(CommandMessage):
    """Pass several arguments at once, as one run and one undo step; None takes one back."""

    type: Literal["set_arguments"] = "set_arguments"
    values: dict[ArgumentName, str | None] = Field(min_length=1, max_length=1000)


class GetLink(CommandMessage):
    """A link that opens this robot with its arguments and unsaved edits."""

    type: Literal["get_link"] = "get_link"


class OpenLink(CommandMessage):
    """Open what a link holds as a document of its own; its edits are unsaved there."""

    type: Literal["open_link"] = "open_link"
    link: str = Field(max_length=400_000)


class SetJoints(CommandMessage):
    """Move joints: positions by name, rad or m; clamped to the limits, mimics follow."""

    type: Literal["set_joints"] = "set_joints"
    positions: dict[str, float]


class ZeroJoints(CommandMessage):
    """All joints to zero, or to the nearest position within their limits."""

    type: Literal["zero_joints"] = "zero_joints"


class RandomizeJoints(CommandMessage):
    """All joints to random positions within their limits."""

    type: Literal["randomize_joints"] = "randomize_joints"


class AnimateJoints(CommandMessage):
    """Swing the joints through their limits, or stop."""

    type: Literal["animate_joints"] = "animate_joints"
    running: bool


class SetDisplay(CommandMessage):
    """Change one setting of a shared display, e.g. `robot`, `collision`, True."""

    type: Literal["set_display"] = "set_display"
    display: Literal["grid", "robot", "ghost"]
    name: str
    value: bool | float | str


class ChoosePackage(CommandMessage):
    """Use this folder for a package that was not found; remembered for the workspace."""

    type: Literal["choose_package"] = "choose_package"
    name: str
    folder: str


class GetUrdf(CommandMessage):
    """The expanded URDF of the last good run."""

    type: Literal["get_urdf"] = "get_urdf"


class GetOrigin(CommandMessage):
    """Where a part of the last good run comes from; `part` is `link:<name>`, `joint:<name>` ..."""

    type: Literal["get_origin"] = "get_origin"
    part: str = Field(max_length=4096)


class GetEffects(CommandMessage):
    """What a site shapes in the robot of the last good run."""

    type: Literal["get_effects"] = "get_effects"
    site: str = Field(max_length=8192)


class GetText(CommandMessage):
    """The text of a file as it is edited; `texts_changed` tells from then on what happens to it."""

    type: Literal["get_text"] = "get_text"
    file: str = Field(max_length=4096)


class GetOutline(CommandMessage):
    """What the files of the robot hold: includes, macros, properties, args."""

    type: Literal["get_outline"] = "get_outline"


class PlaceCommand(CommandMessage):
    """A question about a place of a file's text, as `get_text` and `texts_changed` tell it.

    `offset` counts UTF-16 code units from 0: no byte order mark, every line break one LF.
    """

    file: str = Field(max_length=4096)
    offset: int = Field(ge=0, le=_OFFSET_LIMIT)


class LookUp(PlaceCommand):
    """What stands there, what it came to in the run, and where it is defined."""

    type: Literal["look_up"] = "look_up"


class GetReferences(PlaceCommand):
    """All places that name what stands there."""

    type: Literal["get_references"] = "get_references"


class Complete(PlaceCommand):
    """What may be typed there."""

    type: Literal["complete"] = "complete"


class TextChange(Message):
    """In the text before, [start, end) gives way to `text`.

    The text is as an editor holds it: no byte order mark, every line break one LF. Offsets are
    UTF-16 code units from 0.
    """

    start: int = Field(ge=0, le=_OFFSET_LIMIT)
    end: int = Field(ge=0, le=_OFFSET_LIMIT)
    text: str = Field(max_length=4_194_304)


class EditText(CommandMessage):
    """Type into a file's text; refused when its version is no longer this one.

    The changes are in order, none overlapping, each with offsets in the text before all of them.
    All edits of one `gesture` are one undo step. `origin`, chosen by the browser, comes back in
    the `texts_changed` that tells them, so that it knows its own.
    """

    type: Literal["edit_text"] = "edit_text"
    file: str = Field(max_length=4096)
    version: int = Field(ge=0, le=_OFFSET_LIMIT)
    changes: tuple[TextChange, ...] = Field(min_length=1, max_length=5000)
    gesture: str = Field(default="", max_length=100)
    origin: str = Field(default="", max_length=100)


class SaveVariant(CommandMessage):
    """Keep the present arguments and values as a new variant."""

    type: Literal["save_variant"] = "save_variant"
    name: str = Field(max_length=100)
    note: str = Field(default="", max_length=2000)


class ApplyVariant(CommandMessage):
    """Make the robot a variant, in one undo step; an empty name makes it as its files say."""

    type: Literal["apply_variant"] = "apply_variant"
    name: str = Field(max_length=100)


class UpdateVariant(CommandMessage):
    """Keep the present arguments and values in a variant that there is."""

    type: Literal["update_variant"] = "update_variant"
    name: str = Field(max_length=100)


class RenameVariant(CommandMessage):
    """Give a variant another name and note."""

    type: Literal["rename_variant"] = "rename_variant"
    name: str = Field(max_length=100)
    new_name: str = Field(max_length=100)
    note: str = Field(default="", max_length=2000)


class DeleteVariant(CommandMessage):
    """Forget a variant; the robot stays as it is."""

    type: Literal["delete_variant"] = "delete_variant"
    name: str = Field(max_length=100)


class CompareVariants(CommandMessage):
    """Compare two states for everybody from now on, and follow them; None ends it."""

    type: Literal["compare_variants"] = "compare_variants"
    sides: tuple[Side, Side] | None = None


Command: TypeAlias = Annotated[
    Watch
    | OpenPath
    | CloseDocument
    | ListFolder
    | EditSite
    | ResetSite
    | SetArgument
    | Undo
    | Redo
    | Save
    | Reload
    | GetCollisions
    | ResolveCollisions
    | GetArguments
    | SetArguments
    | GetLink
    | OpenLink
    | SetJoints
    | ZeroJoints
    | RandomizeJoints
    | AnimateJoints
    | SetDisplay
    | ChoosePackage
    | GetUrdf
    | GetText
    | GetOrigin
    | GetEffects
    | EditText
    | GetOutline
    | LookUp
    | GetReferences
    | Complete
    | SaveVariant
    | ApplyVariant
    | UpdateVariant
    | RenameVariant
    | DeleteVariant
    | CompareVariants,
    Field(discriminator="type"),
]
COMMANDS: TypeAdapter[Command] = TypeAdapter(Command)
