"""The open documents, how more are opened or made, their arguments, and links to them."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from studio.description.values import Widget
from studio.protocol.message import ArgumentName, Command, Event, Message


class Watch(Command):
    """Show me this document: its whole state now, then every change."""

    type: Literal["watch"] = "watch"


class OpenPath(Command):
    """Open a file, package folder, workspace folder or zip below the served roots."""

    type: Literal["open_path"] = "open_path"
    path: str
    arguments: dict[ArgumentName, str] = Field(default_factory=dict)


class CloseDocument(Command):
    """Close a document; refused while it has unsaved edits unless `discard`."""

    type: Literal["close_document"] = "close_document"
    discard: bool = False


class ListFolder(Command):
    """Ask for the content of a served folder; an empty path lists the served roots."""

    type: Literal["list_folder"] = "list_folder"
    path: str = ""


class ChoosePackage(Command):
    """Use this folder for a package that was not found; remembered for the workspace."""

    type: Literal["choose_package"] = "choose_package"
    name: str
    folder: str


class Hello(Event):
    """First on every control lane: who you are here."""

    type: Literal["hello"] = "hello"
    role: Literal["presenter", "helper", "student", "guest"]
    version: str
    session: str
    """Changes when the server was restarted."""


class Done(Event):
    """The command was carried out."""

    type: Literal["done"] = "done"
    request: int


class Refused(Event):
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


class Documents(Event):
    """All open documents."""

    type: Literal["documents"] = "documents"
    documents: tuple[DocumentEntry, ...]


class DocumentState(Event):
    """State of a document: its entry file, arguments, and how it was evaluated."""

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
    is_bare: bool = False
    """Whether it is a folder of packages without a robot: its entry file is a frame alone."""
    may_run: bool = False
    """Whether it lies in a folder of --allow-run, so that its owner runs what lies there."""


class Progress(Event):
    """Long work of the document; `total` 0 when not known; done == total ends it."""

    type: Literal["progress"] = "progress"
    task: Literal["expand", "meshes", "index"]
    label: str
    done: int
    total: int


class FolderEntry(Message):
    """One entry of a folder. With `openable` false comes the reason."""

    name: str
    path: str
    kind: Literal["folder", "package", "robot", "bag", "zip", "file"]
    openable: bool
    reason: str = ""


class Folder(Event):
    """Answer to `list_folder`."""

    type: Literal["folder"] = "folder"
    request: int
    path: str
    parent: str | None
    entries: tuple[FolderEntry, ...]


class Opened(Event):
    """Answer to `open_path`: go to `/d/<document>`."""

    type: Literal["opened"] = "opened"
    request: int
    document: str


class Gone(Event):
    """The document was closed."""

    is_moment: ClassVar[bool] = True
    type: Literal["gone"] = "gone"
    document: str


class ListRecent(Command):
    """The files that were opened last."""

    type: Literal["list_recent"] = "list_recent"


class OpenRecent(Command):
    """Open a file of that list again, with the arguments that it had."""

    type: Literal["open_recent"] = "open_recent"
    path: str = Field(max_length=4096)


class ForgetRecent(Command):
    """Take a file out of that list; the file stays."""

    type: Literal["forget_recent"] = "forget_recent"
    path: str = Field(max_length=4096)


class ListExamples(Command):
    """The models that the studio ships."""

    type: Literal["list_examples"] = "list_examples"


class OpenExample(Command):
    """Open the working copy of a shipped model."""

    type: Literal["open_example"] = "open_example"
    name: str = Field(max_length=200)
    arguments: dict[ArgumentName, str] = Field(default_factory=dict)
    """Arguments that the model is opened with."""


class ListPlaces(Command):
    """The folders in which something new can be made."""

    type: Literal["list_places"] = "list_places"


class NewRobot(Command):
    """Make a package `folder/name` out of a template, and open its robot."""

    type: Literal["new_robot"] = "new_robot"
    template: Literal["blank", "rover", "arm"]
    name: str = Field(max_length=200)
    folder: str = Field(default="", max_length=4096)
    """Empty: that of the data folder."""


class NewUntitled(Command):
    """Open a text that has no file yet."""

    type: Literal["new_untitled"] = "new_untitled"
    text: str


class SaveAs(Command):
    """Write the document's robot to a new place, and go on there."""

    type: Literal["save_as"] = "save_as"
    name: str = Field(max_length=200)
    folder: str = Field(default="", max_length=4096)
    """Empty: that of the data folder."""
    as_package: bool = True
    """With package.xml, launch/ and README.md around it."""


class RecentEntry(Message):
    """One file of the list; `is_there` false: it was removed."""

    path: str
    title: str
    time_s: float
    """When it was opened, Unix time."""
    origin: Literal["file", "example", "upload", "untitled"]
    is_there: bool


class Recent(Event):
    """Answer to `list_recent` and `forget_recent`: newest first."""

    type: Literal["recent"] = "recent"
    request: int
    files: tuple[RecentEntry, ...]


class ExampleEntry(Message):
    """One shipped model; `text` describes it."""

    name: str
    robot: str
    text: str


class Examples(Event):
    """Answer to `list_examples`."""

    type: Literal["examples"] = "examples"
    request: int
    examples: tuple[ExampleEntry, ...]


class Places(Event):
    """Answer to `list_places`: the data folder's own first."""

    type: Literal["places"] = "places"
    request: int
    folders: tuple[str, ...]


class SetArgument(Command):
    """Pass an argument as `name:=value` on the command line would; None takes it back."""

    type: Literal["set_argument"] = "set_argument"
    name: ArgumentName
    value: str | None


class GetArguments(Command):
    """Ask for the arguments of a robot: of the open document, or of a file not yet open."""

    type: Literal["get_arguments"] = "get_arguments"
    path: str = Field(default="", max_length=4096)


class SetArguments(Command):
    """Pass several arguments at once, as one run and one undo step; None takes one back."""

    type: Literal["set_arguments"] = "set_arguments"
    values: dict[ArgumentName, str | None] = Field(min_length=1, max_length=1000)


class ArgumentView(Message):
    """One argument of a robot, as a form shows it."""

    name: str
    file: str
    line: int
    default: str | None
    """As written in the file; None: the robot needs a value from outside."""
    value: str | None
    """The value passed now."""
    shown: str
    """Its present value, where that is known without a run."""
    widget: Widget
    is_file: bool
    """Whether its value names a file."""


class Arguments(Event):
    """Answer to `get_arguments`; `missing`: those without which it cannot be shown."""

    type: Literal["arguments"] = "arguments"
    request: int
    path: str
    arguments: tuple[ArgumentView, ...]
    missing: tuple[str, ...]


class LinkCamera(Message, allow_inf_nan=False):
    """Where a page looks from, in the fixed frame, m; `field` is the angle of its picture, rad."""

    eye: tuple[float, float, float]
    target: tuple[float, float, float]
    up: tuple[float, float, float]
    flat: bool
    field: float


class LinkLook(Message):
    """How the page that a link is made on shows the robot; what is empty is as it was there."""

    camera: LinkCamera | None = None
    part: Annotated[str, Field(max_length=300)] = ""
    """That is selected."""
    layout: Annotated[str, Field(max_length=50_000)] = ""
    """How its panels are arranged, as pages write it; who opens the link reads it as hostile."""


class GetLink(Command):
    """A link that opens this robot with its arguments and unsaved edits, and a bag's moment."""

    type: Literal["get_link"] = "get_link"
    look: LinkLook = LinkLook()


class OpenLink(Command):
    """Open what a link holds as a document of its own; its edits are unsaved there."""

    type: Literal["open_link"] = "open_link"
    link: str = Field(max_length=400_000)


class Link(Event):
    """Answer to `get_link`: `text` goes behind `#robot=` of the studio's address."""

    type: Literal["link"] = "link"
    request: int
    text: str
    arguments: int
    files: tuple[str, ...]
    """Files whose unsaved edits it holds."""
    edits: int
    bag: str
    """Name of the bag that is shown; empty: none is part of it."""
    at_s: float
    """The moment, since the bag begins."""


class LinkOpened(Event):
    """Answer to `open_link`: go to `/d/<document>`, and show it so.

    `left_out` lists edits that found no place, and a bag that is not here.
    """

    type: Literal["link_opened"] = "link_opened"
    request: int
    document: str
    left_out: tuple[str, ...]
    look: LinkLook
