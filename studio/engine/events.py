"""The closed union of events: what the studio tells its browsers."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import Field, TypeAdapter

from studio.description.values import SiteKind, Widget
from studio.engine.commands import TextChange
from studio.engine.language_events import (
    CompletionsAnswer,
    MeaningAnswer,
    OutlineAnswer,
    ReferencesAnswer,
)
from studio.engine.message import Message
from studio.engine.origin_events import Effects, Origin
from studio.engine.variant_events import Comparison, VariantApplied, Variants, VariantSaved
from studio.problems import Problem


class Hello(Message):
    """First on every control lane: who you are here."""

    type: Literal["hello"] = "hello"
    role: Literal["presenter", "viewer"]
    version: str
    session: str
    """Changes when the server was restarted."""


class Done(Message):
    """The command was carried out."""

    type: Literal["done"] = "done"
    request: int


class Refused(Message):
    """The command was not carried out, and why; `kind` is the error's class name."""

    type: Literal["refused"] = "refused"
    request: int
    kind: str
    reason: str


class DocumentEntry(Message):
    """One open document in the list of them."""

    id: str
    title: str
    path: str
    unsaved: bool


class Documents(Message):
    """All open documents."""

    type: Literal["documents"] = "documents"
    documents: tuple[DocumentEntry, ...]


class DocumentState(Message):
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


class LinkView(Message):
    """One link as the page lists it; the parent joint is in the joints."""

    name: str
    visuals: int
    collisions: int
    mass_kg: float | None
    meshes: tuple[str, ...]
    file: str
    line: int
    macros: tuple[str, ...]


class JointView(Message):
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


class RobotState(Message):
    """The robot's tree. `revision` counts structural changes; joint frames carry it."""

    type: Literal["robot"] = "robot"
    revision: int
    name: str
    root: str
    links: tuple[LinkView, ...]
    joints: tuple[JointView, ...]


class JointPositions(Message):
    """Positions of all movable joints by name, after a command; streams are binary frames."""

    type: Literal["joints"] = "joints"
    positions: dict[str, float]
    animating: bool


class SiteView(Message):
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


class Sites(Message):
    """The changed sites, and the order of all when it changed (sites not in it are gone)."""

    type: Literal["sites"] = "sites"
    order: tuple[str, ...] | None
    changed: tuple[SiteView, ...]


class Problems(Message):
    """All problems of the document now. `showing_last_good`: the view is older than the text."""

    type: Literal["problems"] = "problems"
    problems: tuple[Problem, ...]
    showing_last_good: bool


class History(Message):
    """The undo list, newest last, and what is unsaved."""

    type: Literal["history"] = "history"
    undo: tuple[str, ...]
    redo: tuple[str, ...]
    unsaved_files: tuple[str, ...]
    unsaved_count: int


class Displays(Message):
    """The shared display settings: display, then setting, then value."""

    type: Literal["displays"] = "displays"
    displays: dict[str, dict[str, bool | float | str]]


class Progress(Message):
    """Long work of the document; `total` 0 when not known; done == total ends it."""

    type: Literal["progress"] = "progress"
    task: Literal["expand", "meshes", "index"]
    label: str
    done: int
    total: int


class Built(Message):
    """A run ended: how long it took from the edit to the scene."""

    type: Literal["built"] = "built"
    ok: bool
    duration_ms: float


class FolderEntry(Message):
    """One entry of a folder. `openable` false comes with the reason why not."""

    name: str
    path: str
    kind: Literal["folder", "package", "robot", "zip", "file"]
    openable: bool
    reason: str = ""


class Folder(Message):
    """Answer to `list_folder`."""

    type: Literal["folder"] = "folder"
    request: int
    path: str
    parent: str | None
    entries: tuple[FolderEntry, ...]


class Opened(Message):
    """Answer to `open_path`: go to `/d/<document>`."""

    type: Literal["opened"] = "opened"
    request: int
    document: str


class Urdf(Message):
    """Answer to `get_urdf`."""

    type: Literal["urdf"] = "urdf"
    request: int
    text: str


class Text(Message):
    """Answer to `get_text`: the text at a version, as `TextChange` describes texts."""

    type: Literal["text"] = "text"
    request: int
    file: str
    """As the studio names it, which may differ from how it was asked for."""
    version: int
    text: str
    saved: str | None
    """The text on disk, where it is another one."""
    read_only: str
    """Why it may not be edited, a sentence; empty: it may."""


class TextsChanged(Message):
    """A text that somebody asked for changed, by whatever way; it now has this version."""

    type: Literal["texts_changed"] = "texts_changed"
    file: str
    version: int
    changes: tuple[TextChange, ...]
    origin: str
    """Of the `edit_text` that did it; empty: it was none."""


class DiskMerged(Message):
    """Another program wrote a file; its changes are taken, and so many edits are kept unsaved."""

    type: Literal["disk_merged"] = "disk_merged"
    file: str
    kept: int


class CollisionView(Message):
    """Whole lines that were edited here and changed on disk; `line` counts from 1 in the base."""

    line: int
    base: str
    mine: str
    theirs: str


class Collisions(Message):
    """Answer to `get_collisions`: the first of `count` places."""

    type: Literal["collisions"] = "collisions"
    request: int
    file: str
    places: tuple[CollisionView, ...]
    count: int


class ArgumentView(Message):
    """One argument of a robot, as a form shows it."""

    name: str
    file: str
    line: int
    default: str | None
    """As written in the file; None: the robot needs a value from outside."""
    value: str | None
    """What is passed now."""
    shown: str
    """What it comes to now, where that is known without a run."""
    widget: Widget
    is_file: bool
    """Its value names a file."""


class Arguments(Message):
    """Answer to `get_arguments`; `missing`: those without which it cannot be shown."""

    type: Literal["arguments"] = "arguments"
    request: int
    path: str
    arguments: tuple[ArgumentView, ...]
    missing: tuple[str, ...]


class Link(Message):
    """Answer to `get_link`: `text` goes behind `#robot=` of the studio's address."""

    type: Literal["link"] = "link"
    request: int
    text: str
    arguments: int
    files: tuple[str, ...]
    """Those whose unsaved edits it holds."""
    edits: int


class LinkOpened(Message):
    """Answer to `open_link`: go to `/d/<document>`; `left_out` says which edits found no place."""

    type: Literal["link_opened"] = "link_opened"
    request: int
    document: str
    left_out: tuple[str, ...]


class Saved(Message):
    """These files were written."""

    type: Literal["saved"] = "saved"
    files: tuple[str, ...]


class Gone(Message):
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
    | Text
    | TextsChanged
    | OutlineAnswer
    | MeaningAnswer
    | ReferencesAnswer
    | CompletionsAnswer
    | DiskMerged
    | Collisions
    | Arguments
    | Link
    | LinkOpened
    | Saved
    | Origin
    | Effects
    | Variants
    | VariantApplied
    | VariantSaved
    | Comparison
    | Gone,
    Field(discriminator="type"),
]
EVENTS: TypeAdapter[Event] = TypeAdapter(Event)
