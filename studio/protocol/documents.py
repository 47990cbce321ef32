"""Messages about which documents are open, and what each of them is."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

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
    """What a served folder holds; an empty path lists the served roots."""

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
    role: Literal["presenter", "viewer"]
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


class Progress(Event):
    """Long work of the document; `total` 0 when not known; done == total ends it."""

    type: Literal["progress"] = "progress"
    task: Literal["expand", "meshes", "index"]
    label: str
    done: int
    total: int


class FolderEntry(Message):
    """One entry of a folder. `openable` false comes with the reason why not."""

    name: str
    path: str
    kind: Literal["folder", "package", "robot", "zip", "file"]
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

    type: Literal["gone"] = "gone"
    document: str
