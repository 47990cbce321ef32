"""The closed unions of commands (browser to studio) and events (studio to browser).

One set of models for the websocket parser, OpenAPI and `types/wire.d.ts`. A command carries
`request`, which its `done` or `refused` repeats, and `document`, the id of the open document it
is for. Unknown fields are refused.
"""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter

from studio.description.values import SiteKind, Widget
from studio.problems import Problem


class _Message(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class _Command(_Message, allow_inf_nan=False):
    request: int = 0
    """Chosen by the browser; the answer repeats it."""
    document: str = ""
    """Id of the open document; empty for commands that need none."""


# Commands


class Watch(_Command):
    """Show me this document: its whole state now, then every change."""

    type: Literal["watch"] = "watch"


class OpenPath(_Command):
    """Open a file, package folder, workspace folder or zip below the served roots."""

    type: Literal["open_path"] = "open_path"
    path: str
    arguments: dict[str, str] = Field(default_factory=dict)


class CloseDocument(_Command):
    """Close a document; refused while it has unsaved edits unless `discard`."""

    type: Literal["close_document"] = "close_document"
    discard: bool = False


class ListFolder(_Command):
    """What a served folder holds; an empty path lists the served roots."""

    type: Literal["list_folder"] = "list_folder"
    path: str = ""


class EditSite(_Command):
    """Write a new text at a site. All edits of one `gesture` are one undo step."""

    type: Literal["edit_site"] = "edit_site"
    site: str
    text: str = Field(max_length=100_000)
    gesture: str = ""


class ResetSite(_Command):
    """Put a site back to what the file on disk says."""

    type: Literal["reset_site"] = "reset_site"
    site: str


class SetArgument(_Command):
    """Pass an argument as `name:=value` on the command line would; None takes it back."""

    type: Literal["set_argument"] = "set_argument"
    name: str
    value: str | None


class Undo(_Command):
    """Take back the last step."""

    type: Literal["undo"] = "undo"


class Redo(_Command):
    """Do again what was taken back."""

    type: Literal["redo"] = "redo"


class Save(_Command):
    """Write the edited bytes of all changed files of the document."""

    type: Literal["save"] = "save"


class Reload(_Command):
    """Read all files of the document from disk again; unsaved edits are given up."""

    type: Literal["reload"] = "reload"


class SetJoints(_Command):
    """Move joints: positions by name, rad or m; clamped to the limits, mimics follow."""

    type: Literal["set_joints"] = "set_joints"
    positions: dict[str, float]


class ZeroJoints(_Command):
    """All joints to zero, or to the nearest position within their limits."""

    type: Literal["zero_joints"] = "zero_joints"


class RandomizeJoints(_Command):
    """All joints to random positions within their limits."""

    type: Literal["randomize_joints"] = "randomize_joints"


class AnimateJoints(_Command):
    """Swing the joints through their limits, or stop."""

    type: Literal["animate_joints"] = "animate_joints"
    running: bool


class SetDisplay(_Command):
    """Change one setting of a shared display, e.g. `robot`, `collision`, True."""

    type: Literal["set_display"] = "set_display"
    display: Literal["grid", "robot"]
    name: str
    value: bool | float | str


class ChoosePackage(_Command):
    """Use this folder for a package that was not found; remembered for the workspace."""

    type: Literal["choose_package"] = "choose_package"
    name: str
    folder: str


class GetUrdf(_Command):
    """The expanded URDF of the last good run."""

    type: Literal["get_urdf"] = "get_urdf"


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
    | SetJoints
    | ZeroJoints
    | RandomizeJoints
    | AnimateJoints
    | SetDisplay
    | ChoosePackage
    | GetUrdf,
    Field(discriminator="type"),
]
COMMANDS: TypeAdapter[Command] = TypeAdapter(Command)


# Events


class Hello(_Message):
    """First on every control lane: who you are here."""

    type: Literal["hello"] = "hello"
    role: Literal["presenter", "viewer"]
    version: str
    session: str
    """Changes when the server was restarted."""


class Done(_Message):
    """The command was carried out."""

    type: Literal["done"] = "done"
    request: int


class Refused(_Message):
    """The command was not carried out, and why; `kind` is the error's class name."""

    type: Literal["refused"] = "refused"
    request: int
    kind: str
    reason: str


class DocumentEntry(_Message):
    """One open document in the list of them."""

    id: str
    title: str
    path: str
    unsaved: bool


class Documents(_Message):
    """All open documents."""

    type: Literal["documents"] = "documents"
    documents: tuple[DocumentEntry, ...]


class DocumentState(_Message):
    """What a document is: its entry file, arguments, and how it was evaluated."""

    type: Literal["document"] = "document"
    id: str
    title: str
    path: str
    root: str
    """Folder that shortest names are shown against."""
    arguments: dict[str, str]
    evaluator: str
    fallback_reason: str
    files: tuple[str, ...]
    packages: dict[str, str]
    """Package name to the copy that is used."""
    read_only: tuple[str, ...]
    """Files that cannot be saved."""
    phase: Literal["opening", "ready", "failed"]
    """`failed`: never expanded so far; after the first good run it stays `ready`."""


class LinkView(_Message):
    """One link as the page lists it; the parent joint is in the joints."""

    name: str
    visuals: int
    collisions: int
    mass_kg: float | None
    meshes: tuple[str, ...]
    file: str
    line: int
    macros: tuple[str, ...]


class JointView(_Message):
    """One joint as the page shows and drags it; rad or m; `axis` normalised, in the child frame."""

    name: str
    type: Literal["fixed", "revolute", "continuous", "prismatic", "planar", "floating"]
    parent: str
    child: str
    axis: tuple[float, float, float]
    lower: float | None
    upper: float | None
    mimic: str
    """Name of the joint that moves this one; empty when it is free."""
    multiplier: float = 1.0
    """How far this one moves for one unit of the joint that it mimics."""
    file: str
    line: int


class RobotState(_Message):
    """The robot's tree. `revision` counts structural changes; joint frames carry it."""

    type: Literal["robot"] = "robot"
    revision: int
    name: str
    root: str
    links: tuple[LinkView, ...]
    joints: tuple[JointView, ...]


class JointPositions(_Message):
    """Positions of all movable joints by name, after a command; streams are binary frames."""

    type: Literal["joints"] = "joints"
    positions: dict[str, float]
    animating: bool


class SiteView(_Message):
    """One editable text, as a property row shows it."""

    id: str
    kind: SiteKind
    name: str
    file: str
    line: int
    text: str
    saved_text: str | None
    """What the file on disk says, when it differs."""
    value: str
    number: float | None
    values: tuple[str, ...]
    reads: int
    widget: Widget
    group: str
    owner: str
    argument: str | None
    """For an arg: the value passed from outside, which wins over the default."""


class Sites(_Message):
    """The changed sites, and the order of all when it changed (sites not in it are gone)."""

    type: Literal["sites"] = "sites"
    order: tuple[str, ...] | None
    changed: tuple[SiteView, ...]


class Problems(_Message):
    """All problems of the document now. `showing_last_good`: the view is older than the text."""

    type: Literal["problems"] = "problems"
    problems: tuple[Problem, ...]
    showing_last_good: bool


class History(_Message):
    """The undo list, newest last, and what is unsaved."""

    type: Literal["history"] = "history"
    undo: tuple[str, ...]
    redo: tuple[str, ...]
    unsaved_files: tuple[str, ...]
    unsaved_count: int


class Displays(_Message):
    """The shared display settings: display, then setting, then value."""

    type: Literal["displays"] = "displays"
    displays: dict[str, dict[str, bool | float | str]]


class Progress(_Message):
    """Long work of the document; `total` 0 when not known; done == total ends it."""

    type: Literal["progress"] = "progress"
    task: Literal["expand", "meshes", "index"]
    label: str
    done: int
    total: int


class Built(_Message):
    """A run ended: how long it took from the edit to the scene."""

    type: Literal["built"] = "built"
    ok: bool
    duration_ms: float


class FolderEntry(_Message):
    """One entry of a folder. `openable` false comes with the reason why not."""

    name: str
    path: str
    kind: Literal["folder", "package", "robot", "zip", "file"]
    openable: bool
    reason: str = ""


class Folder(_Message):
    """Answer to `list_folder`."""

    type: Literal["folder"] = "folder"
    request: int
    path: str
    parent: str | None
    entries: tuple[FolderEntry, ...]


class Opened(_Message):
    """Answer to `open_path`: go to `/d/<document>`."""

    type: Literal["opened"] = "opened"
    request: int
    document: str


class Urdf(_Message):
    """Answer to `get_urdf`."""

    type: Literal["urdf"] = "urdf"
    request: int
    text: str


class Saved(_Message):
    """These files were written."""

    type: Literal["saved"] = "saved"
    files: tuple[str, ...]


class Gone(_Message):
    """The document was closed."""

    type: Literal["gone"] = "gone"
    document: str


Event: TypeAlias = Annotated[
    Hello
    | Done
    | Refused
    | Documents
    | DocumentState
    | RobotState
    | JointPositions
    | Sites
    | Problems
    | History
    | Displays
    | Progress
    | Built
    | Folder
    | Opened
    | Urdf
    | Saved
    | Gone,
    Field(discriminator="type"),
]
EVENTS: TypeAdapter[Event] = TypeAdapter(Event)
