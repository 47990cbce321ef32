"""The engine: all open documents, and the commands that concern more than one of them."""

from __future__ import annotations

import asyncio
import gc
import os
import re
from contextlib import nullcontext
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.classroom.classroom import COMMANDS as CLASS_COMMANDS
from studio.classroom.classroom import Classroom
from studio.course.lessons.shelf import Shelf
from studio.documents.arguments import form_at, form_of
from studio.documents.bags import (
    bag_instead,
    demand_bag,
    folder_of_bag,
    is_bag,
    location_of_bag,
    opened_bag,
    root_frame,
    served_folder,
)
from studio.documents.copies.copies import COMMANDS as COPY_COMMANDS
from studio.documents.copies.copies import Copies
from studio.documents.document import COMMANDS as DOCUMENT_COMMANDS
from studio.documents.document import Document
from studio.documents.left_work import LeftDrafts
from studio.documents.lessons.lesson_room import COMMANDS as LESSON_COMMANDS
from studio.documents.lessons.lesson_room import LessonRoom
from studio.documents.library import COMMANDS as LIBRARY_COMMANDS
from studio.documents.library import Library
from studio.documents.link_opening import moment_of, open_link
from studio.documents.links import link_to
from studio.documents.seen import seen_document
from studio.documents.services import Services
from studio.documents.uploads import Uploads
from studio.errors import CommandError, OutsideRootsError, StudioError, UnknownDocumentError
from studio.live.connection.rejoining import Rejoining
from studio.live.connection.robots import COMMANDS as ROBOT_COMMANDS
from studio.live.connection.robots import ConnectionCommands
from studio.live.displays.document_tools import Pointed
from studio.live.panels.recording import FOLDER as BAGS_FOLDER
from studio.live.panels.ros_system import COMMANDS as ROS_COMMANDS
from studio.live.panels.ros_system import RosSystem
from studio.live.programs.program_room import COMMANDS as PROGRAM_COMMANDS
from studio.live.programs.program_room import Programs
from studio.packages.listing import list_folder
from studio.packages.roots import ServedRoots
from studio.packages.workspace import Location, open_location
from studio.protocol.commands import (
    Answer,
    AtMostOnce,
    CommandRates,
    Commands,
    Limits,
    OnCopies,
    Scope,
)
from studio.protocol.documents import (
    Arguments,
    CloseDocument,
    DocumentEntry,
    Documents,
    Done,
    Folder,
    FolderEntry,
    GetArguments,
    GetLink,
    Gone,
    Link,
    LinkOpened,
    ListFolder,
    Opened,
    OpenLink,
    OpenPath,
    Watch,
)
from studio.protocol.listeners import Audience, send
from studio.protocol.playback import OpenBag
from studio.protocol.roles import Role, owner_of
from studio.protocol.saving import ForgetWork
from studio.protocol.tools import ToolUsed, UseTool
from studio.settings import repository_or_wheel

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.live.connection.link import WireLink
    from studio.live.doctor.seen import SeenDocument
    from studio.live.time.document_source import DocumentSource
    from studio.packages.workspace import Progress
    from studio.protocol import Command
    from studio.protocol.listeners import Listener
    from studio.settings import Settings

_DOCUMENT_LIMIT = 32
_WATCHED = Limits(per_second=30)
"""Each is answered with a whole document; all tabs of a browser may come back at once."""
_TOOL_USES = Limits(per_second=10)


class Engine:
    """Holds the documents by id; built, started and closed on the server's loop."""

    def __init__(self, settings: Settings, classroom: Classroom | None = None) -> None:
        self.documents: dict[str, Document] = {}
        self.default_document: str | None = None
        self._settings = settings
        self._once, self._rates = AtMostOnce(), CommandRates()
        self._services = Services(settings)
        self._lobby = Audience()
        self._watching: dict[Listener, Document] = {}
        self.library = Library(settings, self)
        self.uploads = Uploads(settings.data_folder, self)
        wire = self._services.wire
        self._rejoining = Rejoining(wire, settings.data_folder)
        self.ros = RosSystem(wire, settings.data_folder / BAGS_FOLDER)
        folders = self._services.run_folders
        self.programs = Programs(
            settings, folders, wire, lambda: self.served.writable, self.ros.changes
        )
        self.ros.end_programs = self.programs.let_go
        self.ros.doctor.document_of = self._seen_document
        self.ros.doctor.own_link = self._own_link
        self.classroom = classroom or Classroom()
        self.classroom.robot = self.ros
        self.classroom.on_control = self._lent
        self.classroom.nodes.choice = lambda: wire.choice
        self.ros.source_of = self._source_of
        self.ros.recording.shown = lambda name: self.document(name).time.held()
        self.ros.recording.past = lambda _: nullcontext(self._services.rewinding.looked_at())
        self._services.on_time_switch = self._time_switched
        self._services.on_moment = self.ros.moment_changed
        self.copies = Copies(self.classroom.folder, self, self._services, self.classroom)
        self.lessons = LessonRoom(
            Shelf(
                repository_or_wheel("frontend_assets") / "lessons",
                settings.lesson_folders,
                settings.data_folder / "lessons",
            ),
            self,
            self.classroom,
            self._system_of,
            self.ros.changes.changed,
            self.programs.workspaces.folders_now,
        )
        self.browser_topics = self.ros.browser_topics
        self.wire_robots = ConnectionCommands(wire, settings.data_folder, self, self.ros)
        self.bags_folder = self.ros.recording.folder
        """Where topics are recorded, a folder for each bag."""
        self.is_writing = self.ros.recording.is_writing
        self.served = ServedRoots((self.library.robots_folder,), (self.bags_folder,))
        """The folders that can be listed and opened from the page."""
        self.left_work = LeftDrafts(lambda: self.served, settings.data_folder)

    async def start(self) -> None:
        """Warm the workers in the background; pages are served meanwhile."""
        await self._services.start()
        self.classroom.nodes.resume()

    def rejoin(self, *, always: bool = False) -> None:
        """Join the ROS 2 system that it was connected with when it ended; `always`: in any case."""
        self._rejoining.begin(always=always)

    async def close(self) -> None:
        """Close all documents and end all workers."""
        await self._rejoining.close()
        await self.lessons.close()
        await self.programs.close()
        await self.classroom.close()
        await asyncio.gather(self.left_work.close(), self.ros.close())
        await self.copies.close()
        documents, self.documents = tuple(self.documents.values()), {}
        await asyncio.gather(*(document.close() for document in documents), self._services.close())

    def attach(self, listener: Listener) -> None:
        """Send the list of documents to a new control lane."""
        self._lobby.add(listener)
        send(listener, self._list())
        self.left_work.attach(listener)
        self._services.wire.attach(listener)
        self.ros.attach(listener)
        self.classroom.attach(listener)
        self.copies.attach(listener)

    def arrive(self, listener: Listener) -> None:
        """A page was opened at a relay, which sends it what all pages are sent."""
        self.classroom.arrive(listener)
        self.copies.attach(listener)

    def detach(self, listener: Listener) -> None:
        """A control lane was closed."""
        self._lobby.remove(listener)
        self.left_work.detach(listener)
        self._services.wire.detach(listener)
        self.ros.detach(listener)
        self.classroom.detach(listener)
        self.copies.detach(listener)
        self.lessons.detach(listener)
        if document := self._watching.pop(listener, None):
            document.audience.remove(listener)

    def document(self, name: str) -> Document:
        """Return the open document of that id.

        Raises:
            UnknownDocumentError: There is none.
        """
        if owner_of(name):
            return self.copies.document(name)
        try:
            return self.documents[name]
        except KeyError:
            raise UnknownDocumentError(name) from None

    def open_now(self, name: str) -> Document | None:
        """Return the document of that id if it is open; a resting copy is not woken."""
        return self.copies.awake(name) if owner_of(name) else self.documents.get(name)

    def check(self, name: str) -> None:
        """Pass if a document of that id is open, or a copy that rests.

        Raises:
            UnknownDocumentError: There is none.
        """
        if owner_of(name):
            self.copies.check(name)
        else:
            self.document(name)

    async def ready(self, name: str) -> Document:
        """Return the document of that id; a copy that rests is opened.

        Raises:
            StudioError: There is none, or its files are gone.
        """
        return await self.copies.ready(name) if owner_of(name) else self.document(name)

    async def execute(self, command: Command, asker: Listener) -> None:
        """Carry out one command and answer it; whether the asker may was decided at the door.

        Raises:
            StudioError: It cannot be done.
        """
        if (answer := await self._once.run(command, asker, self._carry_out)) is not None:
            send(asker, answer)
        send(asker, Done(request=command.request))

    async def _carry_out(self, command: Command, asker: Listener) -> Answer:
        entry = COMMANDS[type(command)]
        self._rates.spend(asker.person, entry)
        if entry.needs_router:
            self.ros.check_router()
        if owner_of(command.document):
            self._check_copy(command.document, entry.on_copies)
        answer = await COMMANDS.carry_out(self, command, asker)
        if entry.reviews and asker.role is Role.PRESENTER:
            document, control = self.document(command.document), self.classroom.control
            # It may have been given while the command was carried out.
            if not control.holder or control.document != document.id:
                document.free()
        return answer

    def _source_of(self, name: str) -> DocumentSource | None:
        document = self.open_now(name)
        return None if document is None else document.source

    def _time_switched(self, name: str) -> None:
        self.ros.time_switched(name)
        self.copies.follow_time(name)

    async def _system_of(self, person: str) -> tuple[WireLink | None, bool]:
        """Return the ROS system that a person's lessons are about, and whether it is theirs."""
        own = await self.classroom.nodes.link(person)
        return (self.ros.connection.current, False) if own is None else (own, True)

    def _seen_document(self, name: str) -> SeenDocument | None:
        document = self.open_now(name)
        return None if document is None else seen_document(document)

    async def _own_link(self, document: str, person: str) -> WireLink | None:
        """Return the system of a member's own nodes, which a copy of theirs is about."""
        if not person or owner_of(document) != person:
            return None
        try:
            return await self.classroom.nodes.link(person)
        except StudioError:  # their nodes may not join now
            return None

    def _lent(self, document: str) -> None:
        """A member has control of a document now."""
        if document in self.documents:
            self.documents[document].confine()

    def _check_copy(self, name: str, rule: OnCopies) -> None:
        """Pass if a copy can have this done.

        Raises:
            CommandError: Only a shared document can, or the copy is full.
        """
        if rule is OnCopies.REFUSED:
            raise CommandError("A copy is not saved and has the displays of the class: hand it in.")
        if rule is OnCopies.WITHIN_ROOM:
            self.copies.check_room(name)

    async def open_path(
        self, path: Path, arguments: dict[str, str], progress: Progress | None = None
    ) -> str:
        """Open what the command line names; its folders are served from now on.

        Args:
            path: A file, a folder or a zip.
            arguments: Passed to xacro.
            progress: Told, in another thread, how far the search for packages is.

        Raises:
            StudioError: Nothing there can be opened.
        """
        found = await self._found(path, progress)
        if isinstance(found, Location):
            return self._open(found, arguments)
        self.served = self.served.with_roots((), [served_folder(found)])
        return await self._open_bag(found, progress)

    async def show_bag(self, bag: str, name: str = "") -> str:
        """Show a bag for the page, in an open document or as one of its own; returns which.

        Raises:
            StudioError: It may not be opened, or nothing of it can be read.
        """
        path = self._may_open_bag(bag)
        await asyncio.to_thread(demand_bag, path)
        return await self._open_or_show_bag(path, name)

    def _may_open_bag(self, path: str) -> Path:
        """Return the path of a bag if it is served, or was opened before.

        Raises:
            OutsideRootsError: It may not be opened.
        """
        try:
            return self.served.resolve(Path(path))
        except OutsideRootsError:
            if not self.library.may_reopen(path):
                raise
            return Path(path)

    async def _open_or_show_bag(self, path: Path, beside: str) -> str:
        """Show a bag in an open document, whose robot moves by it, else as one of its own."""
        if not beside:
            return await self._open_bag(path)
        document = await self.ready(beside)
        shown = await opened_bag(path, document.time.note_progress)
        await document.show_bag(shown, with_ghost=not owner_of(document.id))
        return document.id

    async def _open_bag(self, path: Path, progress: Progress | None = None) -> str:
        """Open a bag as a document of its own: its robot, or a frame to show its topics in."""
        path = folder_of_bag(path)

        def told(share: float | None) -> None:
            if progress is not None and share is not None:
                progress(f"reading {path.name}", round(share * 100), 100)
            self.ros.recording.note_opening(path.name, share)

        shown = await opened_bag(path, told)
        try:
            indexes = [one.location.index for one in self.documents.values()]
            frame = await asyncio.to_thread(root_frame, shown.recording)
            found = await asyncio.to_thread(
                location_of_bag, shown, path, frame, self._settings.data_folder, indexes
            )
            location = found if isinstance(found, Location) else await self._locate(found)
            known = location.entry and self.find_open(location.entry)
            name = known.id if known else self._open(location, {}, str(path))
            document = self.documents[name]
        except BaseException:
            await asyncio.to_thread(shown.let_go)
            raise
        await document.show_bag(shown, with_ghost=False)
        if frame and not document.live.kept.fixed_frame:  # so that the robot drives through it
            await document.live.fix(frame)
        return name

    async def _found(
        self, path: Path, progress: Progress | None = None, within: ServedRoots | None = None
    ) -> Location | Path:
        """Return what can be opened at a path: a robot, a workspace without one, or a bag's path.

        Raises:
            StudioError: Nothing there can be opened.
        """
        if await asyncio.to_thread(is_bag, path):
            return path
        location = await self._locate(path, progress, within)
        may_run = self._services.run_folders.allows(location.root)
        location = location.with_bare_entry(may_run=may_run)
        return await bag_instead(location) or location

    def find_open(self, path: Path) -> Document | None:
        """Return the document whose entry file this is."""
        return next((one for one in self.documents.values() if one.entry == path), None)

    async def open_at(
        self,
        path: Path,
        arguments: Mapping[str, str],
        within: ServedRoots | None,
        beside: str = "",
    ) -> str:
        """Open for the library, which saw to it that the path may be opened.

        Raises:
            StudioError: Nothing there can be opened.
        """
        found = await self._found(path, within=within)
        if not isinstance(found, Location):
            return await self._open_or_show_bag(found, beside)
        known = found.entry and not arguments and self.find_open(found.entry)
        return known.id if known else self._open(found, dict(arguments))

    async def close_saved(self, document: Document) -> None:
        """Close a document whose text was saved elsewhere."""
        await self.close_document(document, discard=True)

    async def open_served(self, name: str, arguments: dict[str, str]) -> str:
        """Open out of the page: nothing is served then that was not before, but a zip's folder.

        Raises:
            StudioError: Nothing there can be opened, or it may not be.
        """
        try:
            path = self.served.resolve(Path(name))
        except OutsideRootsError:  # a page that outlived the studio shows what was opened before
            if not self.library.may_reopen(name):
                raise
            return await self.open_at(Path(name), arguments, None)
        found = await self._found(path, within=self.served)
        if isinstance(found, Location):
            return self._open(found, arguments)
        return await self._open_bag(found)

    async def launch_form(self, command: GetArguments) -> Arguments:
        """Return the form of an open document, or of a file below the served folders."""
        if not command.path:
            one = self.document(command.document)
            return await form_of(one.workspace, one.last_run, one.sites, command.request)
        path = self.served.resolve(Path(command.path))
        return await form_at(await self._locate(path, within=self.served), command.request)

    async def _locate(
        self, path: Path, progress: Progress | None = None, within: ServedRoots | None = None
    ) -> Location:
        settings = self._settings
        find = partial(open_location, path, settings.package_paths, settings.data_folder)
        return await asyncio.to_thread(find, dict(os.environ), progress, within=within)

    def _open(self, location: Location, arguments: dict[str, str], bag: str = "") -> str:
        served = location.served
        self.served = self.served.with_roots(served.writable, served.read_only)
        if len(self.documents) >= _DOCUMENT_LIMIT:
            raise CommandError(f"{_DOCUMENT_LIMIT} documents are open: close one first.")
        document = Document(self._free_id(location), location, arguments, self._services)
        document.on_unsaved, document.own_bag = self._send_list, bag
        self.documents[document.id] = document
        self.default_document = self.default_document or document.id
        document.start()
        document.begin_background_work()
        self.library.note(document, bag)
        self._send_list()
        return document.id

    def _free_id(self, location: Location) -> str:
        """Return a readable id that stays the same when the same file is opened after a restart."""
        stem = location.title.split(".")[0]
        base = re.sub(r"[^a-z0-9]+", "-", stem.lower()).strip("-") or "robot"
        names = [base, *(f"{base}-{number}" for number in range(2, _DOCUMENT_LIMIT + 2))]
        return next(name for name in names if name not in self.documents)

    async def watch(self, name: str, listener: Listener) -> None:
        """Send a listener the events of one document, and of no other."""
        document = await self.ready(name)
        if before := self._watching.pop(listener, None):
            before.audience.remove(listener)
        self._watching[listener] = document
        document.attach(listener)

    async def close_document(self, document: Document, *, discard: bool) -> None:
        """Close one document.

        Raises:
            CommandError: It has unsaved edits, which are not to be discarded.
        """
        if document.has_unsaved and not discard:
            raise CommandError(f"{document.title} has unsaved edits: save or discard them first.")
        del self.documents[document.id]
        if self.default_document == document.id:
            self.default_document = next(iter(self.documents), None)
        document.audience.send(Gone(document=document.id))
        document.drafts.forget()
        self._watching = {who: one for who, one in self._watching.items() if one is not document}
        await document.close()
        self._send_list()
        # Its parts know each other. The garbage of several documents would stall the loop longer.
        asyncio.get_running_loop().call_soon(gc.collect)

    async def list_folder(self, command: ListFolder) -> Folder:
        """Return the content of a served folder."""
        listed = await asyncio.to_thread(list_folder, command.path, self.served)
        return Folder(
            request=command.request,
            path=listed.path,
            parent=listed.parent,
            entries=tuple(
                FolderEntry.model_validate(entry, from_attributes=True) for entry in listed.entries
            ),
        )

    def _list(self) -> Documents:
        return Documents(
            documents=tuple(
                DocumentEntry(id=one.id, title=one.title, path=one.path, unsaved=one.has_unsaved)
                for one in self.documents.values()
            )
        )

    def _send_list(self) -> None:
        self._lobby.send(self._list())
        self.left_work.trigger()


def _link_to(engine: Engine, command: GetLink) -> Link:
    document = engine.document(command.document)
    moment = moment_of(document)
    return link_to(document.sources, document.location, command.request, command.look, moment)


async def _open_path(engine: Engine, command: OpenPath) -> Opened:
    name = await engine.open_served(command.path, command.arguments)
    return Opened(request=command.request, document=name)


async def _open_bag(engine: Engine, command: OpenBag) -> Opened:
    name = await engine.show_bag(command.path, command.document)
    return Opened(request=command.request, document=name)


async def _open_link(engine: Engine, command: OpenLink) -> LinkOpened:
    name, left_out, look = await open_link(engine, command.link)
    return LinkOpened(request=command.request, document=name, left_out=left_out, look=look)


async def _use_tool(engine: Engine, command: UseTool, asker: Listener) -> ToolUsed:
    xyz = (command.x, command.y, command.z)
    pointed = Pointed(command.tool, command.fixed_frame, xyz, command.yaw)
    live, publishing = engine.document(command.document).live, engine.ros.tools
    live.tools.on_tools = partial(publishing.keep_only, command.document)
    use = await live.tool_use(pointed)
    sent = await publishing.use(command.document, use, asker.person)
    return ToolUsed(
        request=command.request,
        sent_as="action" if sent.operation else "topic",
        name=sent.name,
        frame=use.frame,
        xyz=use.xyz,
        wxyz=use.wxyz,
        subscriptions=sent.subscriptions,
        operation=sent.operation,
    )


COMMANDS: Final = Commands[Engine](Scope.STUDIO)
"""Every command of the studio."""
COMMANDS.viewer(Watch, lambda engine, c, who: engine.watch(c.document, who), limits=_WATCHED)
COMMANDS.presenter(OpenPath, lambda engine, c, _: _open_path(engine, c))
COMMANDS.presenter(OpenBag, lambda engine, c, _: _open_bag(engine, c))
COMMANDS.presenter(
    CloseDocument,
    lambda engine, c, _: engine.close_document(engine.document(c.document), discard=c.discard),
    scope=Scope.DOCUMENT,
)
COMMANDS.presenter(ListFolder, lambda engine, c, _: engine.list_folder(c))
COMMANDS.presenter(GetArguments, lambda engine, c, _: engine.launch_form(c))
COMMANDS.controller(GetLink, lambda engine, c, _: _link_to(engine, c), scope=Scope.DOCUMENT)
COMMANDS.controller(UseTool, _use_tool, scope=Scope.ROS, needs_router=True, limits=_TOOL_USES)
COMMANDS.presenter(OpenLink, lambda engine, c, _: _open_link(engine, c))
COMMANDS.presenter(ForgetWork, lambda engine, c, _: engine.left_work.forget(c.path))
COMMANDS.include(COPY_COMMANDS, lambda engine, _: engine.copies)
COMMANDS.include(LESSON_COMMANDS, lambda engine, _: engine.lessons)
COMMANDS.include(CLASS_COMMANDS, lambda engine, _: engine.classroom)
COMMANDS.include(LIBRARY_COMMANDS, lambda engine, _: engine.library)
COMMANDS.include(ROBOT_COMMANDS, lambda engine, _: engine.wire_robots)
COMMANDS.include(PROGRAM_COMMANDS, lambda engine, _: engine.programs)
COMMANDS.include(ROS_COMMANDS, lambda engine, _: engine.ros)
COMMANDS.include(DOCUMENT_COMMANDS, lambda engine, c: engine.document(c.document))
