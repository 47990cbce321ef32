"""The copies of a class: made, put to sleep when nobody looks, handed in, sent back, shown."""

from __future__ import annotations

import asyncio
import itertools
import json
import logging
import shutil
import time
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final, Protocol

import msgspec

from studio.classroom.members import now_s
from studio.description.editing.merging import hunks_between
from studio.documents.copies.evaluators import Evaluators
from studio.documents.copies.folder import (
    TEXTS_MAX_BYTES,
    Original,
    location_of,
    make_folder,
    size_of,
)
from studio.documents.document import Document
from studio.documents.draft_files import forget_drafts
from studio.documents.exports import Download
from studio.documents.services import Services
from studio.errors import CommandError, DataFolderError, UnknownDocumentError
from studio.files import write_whole
from studio.live.displays.display_file import DisplayFile
from studio.packages.packing import PackedFile, zip_chunks
from studio.packages.roots import ServedRoots
from studio.packages.run_folders import RunFolders
from studio.protocol.commands import Commands, Limits, OnCopies, Scope
from studio.protocol.copies import (
    Copies as CopiesEvent,
)
from studio.protocol.copies import (
    CopyView,
    DiscardCopy,
    HandIn,
    MyCopies,
    OpenCopy,
    SendBack,
    ShowCopy,
)
from studio.protocol.documents import Gone, Opened
from studio.protocol.listeners import send
from studio.protocol.roles import OWNER, Role, original_of, owner_of

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine, Iterator

    from studio.classroom.classroom import Classroom
    from studio.description.client import DescriptionWorker
    from studio.documents.services import Opened as WaitsForOpening
    from studio.live.time.shown import ShownRecording
    from studio.protocol.listeners import Listener

_LOOK_EVERY_S: Final = 5.0
_REST_AFTER_S: Final = 20.0
"""A page that is loaded again is back within this time."""
_HANDED: Final = "handed"
_RECORD: Final = "copy.json"
_JOINTS: Final = "joints.json"
_log = logging.getLogger(__name__)


class CopyRecord(msgspec.Struct, frozen=True):
    """What is kept of a copy beside its files."""

    of: str
    """Id of the shared document."""
    person: str
    title: str
    entry: str
    """Below the folder of the copy."""
    arguments: dict[str, str]
    meshes: tuple[str, ...]
    joints: dict[str, float]
    made_s: float
    handed_s: float | None = None
    changes: int = 0
    remark: str = ""
    remarked_s: float | None = None


class SharedDocuments(Protocol):
    """The engine."""

    @property
    def documents(self) -> dict[str, Document]:
        """The shared documents by id."""
        ...


class CopyServices(Services):
    """Those of the studio, with few evaluators, without trust, and with nothing to run."""

    def __init__(self, base: Services) -> None:
        # The base is not initialised: what it has is the studio's.
        self.settings = replace(base.settings, trusted=False, run_folders=())
        self.quiet_s, self.patience_s = 2.0, base.patience_s
        self.meshes, self.validator, self.wire = base.meshes, base.validator, base.wire
        self.plugins, self.rewinding = base.plugins, base.rewinding
        self.on_time_switch, self.on_moment = base.on_time_switch, base.on_moment
        # Nothing in a student's copy is run, or changed as a program.
        self.run_folders = RunFolders((), base.settings.data_folder)
        self.evaluators = Evaluators()

    def description_worker(self, opened: WaitsForOpening | None = None) -> DescriptionWorker:
        """Return a worker that shares its process with others."""
        del opened
        return self.evaluators.worker()


class Copies:
    """All copies by id; those that nobody looks at are only files. On the event loop only.

    Args:
        folder: Where they are kept; None: nowhere, and there are none.
        engine: Has the originals.
        services: The studio's.
        classroom: Whose people they are.
    """

    def __init__(
        self, folder: Path | None, engine: SharedDocuments, services: Services, classroom: Classroom
    ) -> None:
        self._folder, self._engine, self._classroom = folder, engine, classroom
        self.services = CopyServices(services)
        self._records: dict[str, CopyRecord] = dict(_read_all(folder)) if folder else {}
        self._awake: dict[str, Document] = {}
        self._resting: dict[str, asyncio.Task[None]] = {}
        self._unwatched_s: dict[str, float] = {}
        self._making: dict[str, asyncio.Task[None]] = {}
        self._handing = asyncio.Lock()
        """Held while one is handed in: a person may do so in two pages at once."""
        self._pages: dict[Listener, None] = {}
        self._watching: asyncio.Task[None] | None = None
        classroom.on_end = self.delete_all

    async def close(self) -> None:
        """Put all to sleep."""
        if self._watching is not None:
            self._watching.cancel()
        await asyncio.gather(*(self._rest(name) for name in tuple(self._awake)))

    def attach(self, listener: Listener) -> None:
        """Send a page its copies, or all of them to one that leads."""
        self._pages[listener] = None
        self._tell(listener)

    def detach(self, listener: Listener) -> None:
        """Forget a page."""
        self._pages.pop(listener, None)

    def document(self, name: str) -> Document:
        """Return a copy, which is opened if it rests.

        Raises:
            UnknownDocumentError: There is none of that id.
            CommandError: It is being put to rest.
            PackageError: Its files are gone.
        """
        self._known(name)
        if name in self._resting:
            raise CommandError("The copy is being closed: try again in a moment.")
        return self._awake.get(name) or self._wake(name)

    def awake(self, name: str) -> Document | None:
        """Return a copy that is open; a resting one is not woken."""
        return self._awake.get(name)

    def check(self, name: str) -> None:
        """Pass if there is a copy of that id.

        Raises:
            UnknownDocumentError: There is none.
        """
        self._known(name)

    async def ready(self, name: str) -> Document:
        """Return a copy, as `document`, once one that is being put to rest does."""
        if resting := self._resting.get(name):
            await asyncio.wait({resting})
        return self.document(name)

    # What is asked of them

    async def open(self, command: OpenCopy, asker: Listener) -> Opened:
        """Open the copy that a person has of a document; make it first, if they have none."""
        if not asker.person or asker.role is Role.PRESENTER:
            raise CommandError("Copies are for those who joined the class: the robot is yours.")
        original = self._engine.documents.get(command.document)
        name = f"{command.document}{OWNER}{asker.person}"
        if name not in self._records:
            if original is None:
                raise UnknownDocumentError(command.document)
            await self._once(name, lambda: self._make(name, original, asker.person))
        await self.ready(name)
        return Opened(request=command.request, document=name)

    async def discard(self, name: str) -> None:
        """Give a copy up, with all that is kept of it."""
        self._known(name)
        self.show(name, shown=False)
        await self._rest(name)
        record = self._records.pop(name)
        await asyncio.to_thread(self._delete, name, record)
        self._send()

    async def hand_in(self, name: str) -> None:
        """Keep a copy as it is now, for those who lead the class."""
        document = await self.ready(name)
        await document.opened()
        async with self._handing:
            texts, changes = _texts_of(document)
            joints = document.model.joints.by_name()
            await asyncio.to_thread(_write_handed, self._folder_of(name), texts, joints)
            record = self._known(name)  # meanwhile it may have been sent back, or given up
            handed = {"handed_s": now_s(record.remarked_s), "changes": changes, "joints": joints}
            await self._keep(name, msgspec.structs.replace(record, **handed))

    async def send_back(self, command: SendBack) -> None:
        """Send a copy back with a remark."""
        record = self._known(command.document)
        remark = {"remark": command.remark.strip(), "remarked_s": now_s(record.handed_s)}
        await self._keep(command.document, msgspec.structs.replace(record, **remark))

    def show(self, name: str, *, shown: bool) -> None:
        """Let everybody see a copy, or no longer; one at a time is shown."""
        self._known(name)
        control = self._classroom.control
        if not shown and control.shown != name:
            return
        control.shown = name if shown else ""
        self._end_sight()
        if shown:
            self._classroom.following.gather(name)
        self._send()

    def _end_sight(self) -> None:
        """Have all stop looking who may not any more."""
        for name, document in self._awake.items():
            for page in tuple(self._pages):
                if page in document.audience and not page.sees(name):
                    document.audience.remove(page)
                    send(page, Gone(document=name))

    def check_room(self, name: str) -> None:
        """Pass if the texts of a copy may still grow.

        Raises:
            CommandError: They are as large as they may be.
        """
        sources = self.document(name).sources
        if sum(len(sources.text(file)) for file in sources.files) > TEXTS_MAX_BYTES:
            raise CommandError(
                f"The texts of a copy have {TEXTS_MAX_BYTES >> 20} MB at most: undo, or make them "
                "shorter."
            )

    def download(self) -> Download:
        """Return all that was handed in as a zip, a folder for each person.

        Raises:
            CommandError: Nobody handed one in.
        """
        files = [PackedFile(name, path) for name, path in self.handed_files()]
        if not files or self._folder is None:
            raise CommandError("Nobody has handed in a copy yet.")
        return Download(
            "copies.zip", "application/zip", zip_chunks(files, ServedRoots((), (self._folder,)))
        )

    def handed_files(self) -> list[tuple[str, Path]]:
        """Return all files that were handed in, each with its name in a zip: a folder a person."""
        found: list[tuple[str, Path]] = []
        people = self._zip_folders()
        for name, record in self._records.items():
            folder = self._folder_of(name) / _HANDED
            if record.handed_s is not None:
                above = f"{people[record.person]}/{_plain(record.of)}"
                found += [
                    (f"{above}/{path.relative_to(folder).as_posix()}", path)
                    for path in sorted(folder.rglob("*"))
                    if path.is_file() and not path.is_symlink()
                ]
        return found

    def _zip_folders(self) -> dict[str, str]:
        """Return the folder of each person in a zip; names that become one there get a number."""
        found: dict[str, str] = {}
        for person in dict.fromkeys(record.person for record in self._records.values()):
            name, taken = _plain(self._name_of(person)), {one.casefold() for one in found.values()}
            names = itertools.chain([name], (f"{name} {number}" for number in itertools.count(2)))
            found[person] = next(one for one in names if one.casefold() not in taken)
        return found

    async def delete_all(self) -> None:
        """Delete all copies: the class has ended."""
        await asyncio.gather(*(self._rest(name) for name in tuple(self._awake)))
        records, self._records = self._records, {}
        self._classroom.control.shown = ""
        for name, record in records.items():
            await asyncio.to_thread(self._delete, name, record)
        if self._folder is not None:
            await asyncio.to_thread(shutil.rmtree, self._folder, ignore_errors=True)
        self._send()

    def _delete(self, name: str, record: CopyRecord) -> None:
        """Delete all that is kept of a copy; in another thread."""
        folder, data_folder = self._folder_of(name), self.services.settings.data_folder
        forget_drafts(data_folder, folder.rglob("*"))
        DisplayFile(data_folder, folder / record.entry).delete()
        shutil.rmtree(folder, ignore_errors=True)

    # Making, waking and resting

    async def _once(self, name: str, make: Callable[[], Coroutine[None, None, None]]) -> None:
        """Make a copy once, though two pages of a person ask."""
        if name not in self._making:
            task = self._making[name] = asyncio.create_task(make())
            task.add_done_callback(lambda _: self._making.pop(name, None))
        await asyncio.shield(self._making[name])

    async def _make(self, name: str, original: Document, person: str) -> None:
        if self._folder is None:
            raise CommandError("This studio keeps no copies.")
        await original.opened()  # until its first run nobody knows of which files it is made
        sources, files = original.sources, original.last_run.files
        texts = {file: sources.text(file) for file in files if file in sources.files}
        folder = self._folder_of(name)
        size = await asyncio.to_thread(size_of, folder.parent)
        copied = Original(original.entry, texts, original.mesh_files, original.location, size)
        entry, meshes = await asyncio.to_thread(make_folder, copied, folder)
        shared = DisplayFile(self.services.settings.data_folder, original.entry)
        own = DisplayFile(self.services.settings.data_folder, folder / entry)
        await asyncio.to_thread(lambda: own.write(shared.read()))
        await self._keep(
            name,
            CopyRecord(
                of=original.id,
                person=person,
                title=original.title,
                entry=entry,
                arguments=dict(sources.arguments),
                meshes=meshes,
                joints=original.model.joints.by_name(),
                made_s=now_s(),
            ),
        )

    def _wake(self, name: str) -> Document:
        record, settings = self._records[name], self.services.settings
        assert self._folder is not None
        location = location_of(
            self._folder_of(name), record.entry, record.meshes, settings.data_folder
        )
        document = Document(name, location, record.arguments, self.services)
        self._awake[name] = document
        document.start()
        document.put_joints(record.joints)
        if original := self._engine.documents.get(record.of):
            original.live.on_list = partial(self._mirror_displays, original)
            document.live.mirror(original.live.kept)
            document.time.others = partial(_bag_of, original)
            document.follow_time(original)
        if self._watching is None or self._watching.done():
            self._watching = asyncio.create_task(self._put_to_rest())
        return document

    def follow_time(self, name: str) -> None:
        """Have the copies of a document show the bag that it shows; each where it likes."""
        if (original := self._engine.documents.get(name)) is not None:
            for copy, document in self._awake.items():
                if original_of(copy) == name:
                    document.follow_time(original)

    def _mirror_displays(self, original: Document) -> None:
        """Have the copies that are open show what the class sees now."""
        for name, document in self._awake.items():
            if original_of(name) == original.id:
                document.live.mirror(original.live.kept)

    async def _put_to_rest(self) -> None:
        """Close what nobody has looked at for a while."""
        while self._awake:
            await asyncio.sleep(_LOOK_EVERY_S)
            self._end_sight()  # a helper may have become a student
            at_s = time.monotonic()
            for name, document in tuple(self._awake.items()):
                if len(document.audience):
                    self._unwatched_s.pop(name, None)
                elif at_s - self._unwatched_s.setdefault(name, at_s) >= _REST_AFTER_S:
                    await self._rest(name)

    async def _rest(self, name: str) -> None:
        """Close the document of a copy; its draft and its joints are kept."""
        if name in self._awake and name not in self._resting:
            task = self._resting[name] = asyncio.create_task(self._close(name))
            task.add_done_callback(lambda _: self._resting.pop(name, None))
        if resting := self._resting.get(name):
            await asyncio.shield(resting)

    async def _close(self, name: str) -> None:
        self._unwatched_s.pop(name, None)
        document, record = self._awake.pop(name), self._records[name]
        document.audience.send(Gone(document=name))
        joints = document.model.joints.by_name()
        await document.close()
        if joints and joints != record.joints:
            await self._keep(name, msgspec.structs.replace(record, joints=joints))

    # Keeping and telling

    def _known(self, name: str) -> CopyRecord:
        if name not in self._records:
            raise UnknownDocumentError(name)
        return self._records[name]

    def _folder_of(self, name: str) -> Path:
        assert self._folder is not None
        return self._folder / owner_of(name) / original_of(name)

    async def _keep(self, name: str, record: CopyRecord) -> None:
        self._records[name] = record
        path = self._folder_of(name) / _RECORD
        try:
            await asyncio.to_thread(write_whole, path, msgspec.json.encode(record), mode=0o600)
        except OSError as error:
            raise DataFolderError(str(path), error.strerror or "not writable") from error
        self._send()

    def _send(self) -> None:
        for page in tuple(self._pages):
            self._tell(page)

    def _tell(self, page: Listener) -> None:
        if page.role.includes(Role.HELPER):
            send(page, CopiesEvent(copies=tuple(map(self._view, self._records))))
        if own := [name for name in self._records if owner_of(name) == page.person]:
            send(page, MyCopies(copies=tuple(map(self._view, own))))

    def _view(self, name: str) -> CopyView:
        record = self._records[name]
        return CopyView(
            document=name,
            of=record.of,
            person=record.person,
            name=self._name_of(record.person),
            title=record.title,
            made_s=record.made_s,
            handed_s=record.handed_s,
            changes=record.changes,
            remark=record.remark,
            remarked_s=record.remarked_s,
            shown=self._classroom.control.shown == name,
        )

    def _name_of(self, person: str) -> str:
        member = self._classroom.members.find(person)
        return member.name if member else "?"


def _bag_of(original: Document) -> ShownRecording | None:
    """Return what a copy goes back to instead of the last minutes: the bag of the class."""
    shown = original.time.shown
    return shown if shown is not None and shown.mode == "bag" else None


def _read_all(folder: Path) -> Iterator[tuple[str, CopyRecord]]:
    for path in sorted(folder.glob(f"*/*/{_RECORD}")):
        try:
            record = msgspec.json.decode(path.read_bytes(), type=CopyRecord)
        except (OSError, msgspec.MsgspecError) as error:
            _log.warning("The copy in %s cannot be read: %s", path.parent, error)
            continue
        name = f"{record.of}{OWNER}{record.person}"
        if path.parent != folder / record.person / record.of or ".." in Path(record.entry).parts:
            _log.warning("The copy in %s says that it is %r, and is left out.", path.parent, name)
            continue
        yield name, record


def _texts_of(document: Document) -> tuple[dict[str, bytes], int]:
    """Return the texts of a copy as they are now, by their place in it, and the changes in them."""
    sources, root = document.sources, document.location.root
    texts: dict[str, bytes] = {}
    changes = 0
    for file in document.last_run.files:
        # A text may read a mesh, which is the original's and not handed in.
        if file in sources.files and Path(file).is_relative_to(root):
            texts[Path(file).relative_to(root).as_posix()] = sources.text(file)
            changes += len(hunks_between(sources.saved(file), sources.text(file)))
    return texts, changes


def _write_handed(folder: Path, texts: dict[str, bytes], joints: dict[str, float]) -> None:
    """Put these texts in the place of what was handed in before."""
    handed, before = folder / f"{_HANDED}.new", folder / _HANDED
    shutil.rmtree(handed, ignore_errors=True)
    try:
        for name, data in texts.items():
            path = handed / name
            path.parent.mkdir(parents=True, exist_ok=True)
            write_whole(path, data)
        handed.mkdir(parents=True, exist_ok=True)
        write_whole(handed / _JOINTS, json.dumps(joints, indent=1).encode())
        shutil.rmtree(before, ignore_errors=True)
        handed.rename(before)
    except OSError as error:
        raise DataFolderError(str(folder), error.strerror or "not writable") from error


def _plain(name: str) -> str:
    """Return a name as that of a folder in a zip, on any system."""
    kept = "".join(one if one.isalnum() or one in "-_ " else "_" for one in name).strip()
    return kept or "_"


_OFTEN: Final = Limits(bytes_max=1_000, per_second=2)

COMMANDS: Final = Commands[Copies](Scope.DOCUMENT)
COMMANDS.student(OpenCopy, lambda copies, c, who: copies.open(c, who), limits=_OFTEN)
COMMANDS.controller(DiscardCopy, lambda copies, c, _: copies.discard(c.document), limits=_OFTEN)
COMMANDS.controller(
    HandIn,
    lambda copies, c, _: copies.hand_in(c.document),
    limits=_OFTEN,
    on_copies=OnCopies.WITHIN_ROOM,
)
COMMANDS.helper(SendBack, lambda copies, c, _: copies.send_back(c))
COMMANDS.presenter(ShowCopy, lambda copies, c, _: copies.show(c.document, shown=c.shown))
