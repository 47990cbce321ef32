"""What is opened besides the served folders: recent files, examples, new robots."""

from __future__ import annotations

import asyncio
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal, Protocol, TypeAlias

from studio.errors import CommandError, NotMadeError, UnreadableFileError
from studio.files import is_folder, is_there
from studio.packages.examples import COPIES_FOLDER as EXAMPLES
from studio.packages.examples import examples, working_copy
from studio.packages.received_texts import UNTITLED_FOLDER as UNTITLED
from studio.packages.received_texts import drop_untitled, new_untitled
from studio.packages.recent import RecentFile, RecentFiles
from studio.packages.roots import ServedRoots, is_below
from studio.packages.skeleton import ROBOTS, make_file, make_package, robot_of, template_text
from studio.packages.workspace import UPLOADS
from studio.protocol.commands import Commands, Scope
from studio.protocol.documents import (
    ExampleEntry,
    Examples,
    ForgetRecent,
    ListExamples,
    ListPlaces,
    ListRecent,
    NewRobot,
    NewUntitled,
    Opened,
    OpenExample,
    OpenRecent,
    Places,
    Recent,
    RecentEntry,
    SaveAs,
)
from studio.settings import repository_or_wheel

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.documents.document import Document
    from studio.settings import Settings

_Opening: TypeAlias = OpenRecent | OpenExample | NewRobot | NewUntitled | SaveAs


class Opener(Protocol):
    """The part of the engine that the library uses."""

    @property
    def served(self) -> ServedRoots:
        """The folders that may be read and written already."""
        ...

    def document(self, name: str, /) -> Document:
        """Return the open document of that id.

        Raises:
            UnknownDocumentError: There is none.
        """
        ...

    def find_open(self, path: Path, /) -> Document | None:
        """Return the document that shows this file."""
        ...

    async def open_at(
        self,
        path: Path,
        arguments: Mapping[str, str],
        within: ServedRoots | None,
        beside: str = "",
    ) -> str:
        """Open a path, serve its folders from now on, and give the document's id.

        A bag is shown in the open document `beside`, if one is named.

        Raises:
            StudioError: Nothing there can be opened.
        """
        ...

    async def close_saved(self, document: Document, /) -> None:
        """Close a document whose text was saved elsewhere."""
        ...


class Library:
    """Carries out the commands of the start page; `noted` is called for every opening."""

    def __init__(self, settings: Settings, opener: Opener) -> None:
        self._settings, self._opener = settings, opener
        self._data_folder = settings.data_folder
        self._recent = RecentFiles(settings.data_folder)
        self._models = repository_or_wheel("models")

    @property
    def robots_folder(self) -> Path:
        """The folder of new robots; served and writable, though it may not exist yet."""
        return self._data_folder / ROBOTS

    async def recent(self, command: ListRecent | ForgetRecent) -> Recent:
        """Return the recent files, newest first."""
        if isinstance(command, ForgetRecent):
            self._recent.forget(command.path)
        files = await asyncio.to_thread(self._recent_entries)
        return Recent(request=command.request, files=files)

    async def open(self, command: _Opening) -> Opened:
        """Open what the command names, or make it first.

        Raises:
            StudioError: It is not there, or cannot be made.
        """
        match command:
            case OpenRecent():
                document = await self._open_recent(command.path)
            case OpenExample():
                document = await self._open_example(command)
            case NewRobot():
                document = await self._open_new_robot(command)
            case NewUntitled():
                document = await self._open_untitled(command)
            case SaveAs():
                document = await self._save_as(command)
        return Opened(request=command.request, document=document)

    def note(self, document: Document, bag: str = "") -> None:
        """A document was opened, or the bag that has its robot: it is the newest of the recent."""
        now_s = datetime.now(UTC).timestamp()
        arguments = document.sources.arguments
        location = document.location
        path = bag or (str(location.root) if location.is_bare else document.path)
        self._recent.note(path, document.title, arguments, now_s)

    def may_reopen(self, path: str) -> bool:
        """Whether a path may be opened though nothing serves it: it was opened before."""
        known = self._recent.find(path)
        return known is not None and self._may_open(known)

    async def _open_example(self, command: OpenExample) -> str:
        if all(one.package != command.name for one in examples(self._models)):
            raise CommandError(f'There is no example "{command.name}": choose another.')
        copy = await asyncio.to_thread(
            working_copy, self._models, self._data_folder, command.name, fresh=False
        )
        return await self._opener.open_at(copy, command.arguments, None)

    async def _open_new_robot(self, command: NewRobot) -> str:
        text = template_text(command.template, robot_of(command.name))
        folder = self._place(command.folder)
        file = await asyncio.to_thread(make_package, folder, command.name, text)
        return await self._opener.open_at(file, {}, self._opener.served)

    async def _open_untitled(self, command: NewUntitled) -> str:
        file = await asyncio.to_thread(new_untitled, self._data_folder, command.text)
        return await self._opener.open_at(file, {}, None)

    async def _open_recent(self, path: str) -> str:
        known = self._recent.find(path)
        if known is None or not self.may_reopen(path):
            raise CommandError(f"{path} is not among the recent files: open its folder.")
        if not is_there(Path(path)):
            raise UnreadableFileError(path, "is no longer there: take it out of the list.")
        if (document := self._opener.find_open(Path(path))) is not None:
            return document.id
        return await self._opener.open_at(Path(path), known.arguments, None)

    async def _save_as(self, command: SaveAs) -> str:
        document = self._opener.document(command.document)
        if len(document.last_run.files) > 1:
            raise CommandError(
                f"{document.title} reads other files, which would stay behind: "
                "save it where it is, and copy its folder."
            )
        text = document.sources.text(document.path)
        make = make_package if command.as_package else make_file
        folder = self._place(command.folder)
        file = await asyncio.to_thread(make, folder, command.name, text)
        opened = await self._opener.open_at(file, document.sources.arguments, self._opener.served)
        if (self._data_folder / UNTITLED) in document.entry.parents:
            await self._opener.close_saved(document)
            drop_untitled(document.entry, self._data_folder)
            self._recent.forget(document.path)
        return opened

    def _place(self, folder: str) -> Path:
        """Return the folder in which something is to be made.

        Raises:
            PackageError: It is not served, or may not be written.
        """
        if not folder:
            return self.robots_folder
        place = self._opener.served.resolve(folder)
        if place != self.robots_folder and not is_folder(place):
            raise NotMadeError(str(place), "there is no such folder: choose another one.")
        if place != self.robots_folder and not self._opener.served.may_write(place / "x"):
            raise NotMadeError(str(place), "it may only be read: choose another folder.")
        return place

    def _recent_entries(self) -> tuple[RecentEntry, ...]:
        return tuple(
            RecentEntry(
                path=one.path,
                title=one.title,
                time_s=one.time_s,
                origin=self._origin_of(Path(one.path)),
                is_there=is_there(Path(one.path)),
            )
            for one in self._recent.all()
            if self._may_open(one)
        )

    def _may_open(self, one: RecentFile) -> bool:
        """All that was opened once, while only the owner comes; what is served, where others do."""
        return self._settings.is_private or self._opener.served.serves(one.path)

    def _origin_of(self, path: Path) -> Literal["file", "example", "upload", "untitled"]:
        for folder, origin in _ORIGINS.items():
            if is_below(path, self._data_folder / folder):
                return origin
        return "file"

    def examples(self, command: ListExamples) -> Examples:
        """Return the robots that come with the studio."""
        found = (
            ExampleEntry(name=one.package, robot=one.robot, text=one.text)
            for one in examples(self._models)
        )
        return Examples(request=command.request, examples=tuple(found))

    def places(self, command: ListPlaces) -> Places:
        """Folders where a new robot may go."""
        apart = (EXAMPLES, UPLOADS, UNTITLED)
        served = [
            str(one)
            for one in self._opener.served.writable
            if is_folder(one) and not any(is_below(one, self._data_folder / name) for name in apart)
        ]
        folders = dict.fromkeys((str(self.robots_folder), *served))
        return Places(request=command.request, folders=tuple(folders))


_ORIGINS: Final[dict[str, Literal["example", "upload", "untitled"]]] = {
    EXAMPLES: "example",
    UPLOADS: "upload",
    UNTITLED: "untitled",
}


COMMANDS: Final = Commands[Library](Scope.STUDIO)
COMMANDS.presenter(ListRecent, lambda library, c, _: library.recent(c))
COMMANDS.presenter(ForgetRecent, lambda library, c, _: library.recent(c))
COMMANDS.presenter(ListExamples, lambda library, c, _: library.examples(c))
COMMANDS.presenter(ListPlaces, lambda library, c, _: library.places(c))
COMMANDS.presenter(OpenRecent, lambda library, c, _: library.open(c))
COMMANDS.presenter(OpenExample, lambda library, c, _: library.open(c))
COMMANDS.presenter(NewRobot, lambda library, c, _: library.open(c))
COMMANDS.presenter(NewUntitled, lambda library, c, _: library.open(c))
COMMANDS.presenter(SaveAs, lambda library, c, _: library.open(c))
