"""One open description: its texts, its robot, its 3D view, and everyone who looks at it."""

from __future__ import annotations

import asyncio
import contextlib
import time
from pathlib import Path
from typing import TYPE_CHECKING, Literal, TypeVar

from studio.description.editing.sources import Change, Sources
from studio.description.urdf import urdf_text
from studio.description.values import Expansion, Failure, NoReply
from studio.documents.board import Board
from studio.documents.checks.findings import Fixes
from studio.documents.checks.robot_checks import RobotChecks
from studio.documents.checks.text_checks import TextChecks
from studio.documents.drafts import Drafts
from studio.documents.exports import Exports
from studio.documents.file_watch import FileWatch
from studio.documents.history import HistoryDesk
from studio.documents.inspection import Inspection
from studio.documents.joints import Motion
from studio.documents.links import SharedFile, place_edits
from studio.documents.meshes import Meshes
from studio.documents.model import Model
from studio.documents.origins import Origins
from studio.documents.poses import NamedPoses
from studio.documents.rewriting import Rewriting
from studio.documents.runs import Outcome, Runs, Target
from studio.documents.saving import DiskDesk, SaveDesk
from studio.documents.texts import EditorQuestions, Texts
from studio.documents.urdf import UrdfText
from studio.documents.variants.variants import NamedVariants
from studio.documents.workspace import PackagesUsed, target_of
from studio.errors import CommandError
from studio.live.connection.feed import FeedDesk
from studio.live.connection.opened_types import take_types
from studio.live.displays.display_file import DisplayFile
from studio.live.displays.live_desk import LiveDesk
from studio.live.displays.robot_reading import RobotReader
from studio.packages.uris import resolve_uri
from studio.protocol.edits import Built
from studio.protocol.saving import Saved
from studio.scene import DocumentScene
from studio.settings import LOOPBACK_HOSTS

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Collection, Mapping, Sequence

    from studio.description.requests import Query
    from studio.description.values import Edit, ReadPolicy
    from studio.documents.services import Services
    from studio.packages.workspace import Location
    from studio.protocol.listeners import Listener
    from studio.protocol.texts import EditText

AnyReply = TypeVar("AnyReply")


class Document:
    """Carries out what is asked of one document; its board tells the audience what came of it.

    Every asking method returns when the thing is done and shown, or raises a StudioError with the
    document as it was before.
    """

    def __init__(
        self, name: str, location: Location, arguments: Mapping[str, str], services: Services
    ) -> None:
        if location.entry is None:
            raise CommandError(f"{location.root} holds no robot description: open a file.")
        self.id, self.location, self.entry = name, location, location.entry
        self.scene = DocumentScene(asyncio.get_running_loop())
        self.model = Model(self.scene)
        self.expansion: Expansion | None = None
        """The last good run."""
        self.failed = False
        """Whether the last run failed: the view is older than the texts."""
        self.failure = ""
        """What the last run that failed said."""
        self.on_unsaved: Callable[[], None] = lambda: None
        """Called when the document comes to have unsaved edits, or no longer has any."""
        self.sources = Sources(
            # Asked anew each time: a package that is chosen later is served from then on.
            lambda path: self.location.served.read(path),  # noqa: PLW0108
            lambda path: self.location.served.resolve(path),  # noqa: PLW0108
            lambda path: self.location.served.may_write(path),  # noqa: PLW0108
            arguments,
        )
        self.board = Board(self)
        self.board.find("packages", location.problems)
        self.texts, self.origins = Texts(self), Origins(self)
        self.inspection = Inspection(self, services.meshes)
        self.language = EditorQuestions(self)
        self.rewriting = Rewriting(self)
        self.expanded = UrdfText(self, services.description_worker)
        self.mending, self.checks = Fixes(self), TextChecks(self, services)
        self.disk = DiskDesk(self)
        self.history, self.saving = HistoryDesk(self), SaveDesk(self)
        self.drafts, self.exports = Drafts(self, services.settings.data_folder), Exports(self)
        self.motion = Motion(self.model, self.board)
        self.poses = NamedPoses(self, services)
        self.feed = FeedDesk(
            self.model, self.motion, lambda: self.expansion, services.wire, self.board.audience
        )
        self._services = services
        worker = services.description_worker(self.opened)
        self._runs = Runs(worker, self.sources, self.target, self._take)
        self._meshes = Meshes(self, services.meshes, self._watch_files)
        self.robot_checks = RobotChecks(self, services, self._meshes)
        self.variants = NamedVariants(self, services, self._meshes.want)
        self.live = self._displays_of(services)
        self._files: tuple[str, ...] = (self.path,)
        self._watch = FileWatch(self._changed_on_disk, troubled=self.disk.tell_watch)
        self._packages, self._was_unsaved = PackagesUsed(), False
        self._packages_seen: dict[str, str] | None = None
        self._background: dict[str, asyncio.Task[None]] = {}

    def _displays_of(self, services: Services) -> LiveDesk:
        data_folder = services.settings.data_folder
        return LiveDesk(
            self.model,
            self._meshes,
            RobotReader(services.description_worker, self, data_folder / "from_ros" / "nowhere"),
            DisplayFile(data_folder, self.entry),
            services.wire,
            self.board.audience,
        )

    @property
    def title(self) -> str:
        """The entry file's name, or which untitled text it is."""
        return self.location.title

    @property
    def path(self) -> str:
        """The entry file."""
        return str(self.entry)

    @property
    def phase(self) -> Literal["opening", "ready", "failed"]:
        """Whether there is a robot to look at."""
        if self.expansion:
            return "ready"
        return "failed" if self.failed else "opening"

    @property
    def has_unsaved(self) -> bool:
        """Whether any text differs from the disk."""
        return bool(self.sources.unsaved_files)

    @property
    def target(self) -> Target:
        """What its xacro worker runs, and what that may read."""
        return target_of(self.location, trusted=self._services.settings.trusted)

    @property
    def policy(self) -> ReadPolicy:
        """What its xacro worker may read."""
        return self.target.policy

    def resolve_uri(self, uri: str) -> Path:
        """The file of a URI in this document; looks at the disk, may run in any thread.

        Raises:
            PackageError: It names no file that may be read.
        """
        return resolve_uri(uri, self.entry, self.location.index, self.location.served)

    @property
    def worker_pid(self) -> int | None:
        """Process id of its xacro worker while that runs."""
        return self._runs.worker_pid

    @property
    def files_read(self) -> tuple[str, ...]:
        """What the last run read, whether or not it came to an end."""
        return self._files

    def packages_used(self) -> dict[str, str]:
        """Each package that a file of the last run or a mesh lies in, and which copy it is."""
        return self._packages.of((*self._files, *self._meshes.files), self.location)

    def start(self) -> None:
        """Begin the first run; the audience hears how it goes."""
        self.sources.track([self.path])
        self.drafts.restore()
        self.live.restore()
        self._spawn("opening", self._open())

    def learn_types(self) -> None:
        """Take up the types of the opened packages beside, and get ready for what comes later."""
        self._spawn("types", self._take_types())
        self._spawn("sweep", self.saving.sweep())
        self._spawn("imports", self._services.import_rest(self.opened))

    async def _take_types(self) -> None:
        self.board.find("types", await asyncio.to_thread(take_types, self.location))

    async def _open(self) -> None:
        self.board.progress("expand", 0, 1)
        await self._timed(self._runs.reopen())
        self.board.progress("expand", 1, 1)

    async def opened(self, at_most_s: float | None = None) -> None:
        """Wait for the first run and the meshes that it named, for so long at most."""
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(at_most_s):
                if opening := self._background.get("opening"):
                    await asyncio.shield(opening)
                await self._meshes.settled()

    async def close(self) -> None:
        """End everything that runs for this document."""
        self.motion.close()
        await asyncio.gather(self.feed.close(), self.live.close())
        background = tuple(self._background.values())
        for task in background:
            task.cancel()
        await asyncio.gather(*background, return_exceptions=True)
        await self.robot_checks.close()
        await self.checks.close()
        await asyncio.gather(self._watch.close(), self._meshes.close(), self._runs.close())
        await asyncio.gather(self.variants.close(), self.drafts.close(), self.poses.close())
        self.scene.close()

    async def edit_site(self, site: str, text: str, gesture: str) -> None:
        """Write a new text at a site and show what it does."""
        edit = self.sources.edit_site(site, text, gesture)
        self.drafts.note(shown=False)
        await self._timed(self._runs.edit((edit,), in_gesture=bool(gesture)))

    async def edit_text(self, command: EditText) -> None:
        """Write into a file's text, as an editor does, and show what it does."""
        edits = self.texts.edit(command)
        self._texts_changed()
        await self._timed(self._run(edits, in_gesture=bool(command.gesture)))

    async def reset_site(self, site: str) -> None:
        """Put a site back to what the disk says."""
        if edit := self.sources.reset_site(site):
            await self._timed(self._runs.edit((edit,)))

    async def set_argument(self, name: str, value: str | None) -> None:
        """Pass or take back an argument."""
        self.sources.set_argument(name, value)
        await self._arguments_changed()

    async def set_arguments(self, values: Mapping[str, str | None]) -> None:
        """Pass or take back several arguments at once."""
        self.sources.set_arguments(values, "Arguments" if len(values) > 1 else next(iter(values)))
        await self._arguments_changed()

    async def take_shared(self, files: Sequence[SharedFile]) -> tuple[str, ...]:
        """Take a link's edits as unsaved ones, in one step; says which found no place."""
        edits, left_out = place_edits(self.sources, self.location, files)
        if edits:
            self._texts_changed()
            await self._timed(self._run(edits))
        return left_out

    async def undo(self) -> None:
        """Take the last step back."""
        await self.follow(self.sources.undo())

    async def redo(self) -> None:
        """Do the step last taken back again."""
        await self.follow(self.sources.redo())

    async def save(self, files: Collection[str] | None = None) -> None:
        """Write these changed files, or all."""
        await self._changed_on_disk(set(self.sources.unsaved_files))
        with self.drafts.saving(files):
            written = self.sources.save(files)
        self.board.book.doubt_all()
        self._texts_changed()
        self.board.audience.tell(Saved(files=written))

    async def choose_package(self, name: str, folder: str) -> None:
        """Use a folder for a package from now on, read-only.

        On the owner's own machine it may lie anywhere, for a missing package lies where nothing
        is served; whoever presents from elsewhere chooses among the served folders.
        """
        chosen = Path(folder)
        if self._services.settings.host not in LOOPBACK_HOSTS:
            chosen = self.location.served.resolve(chosen)
        self.location = await asyncio.to_thread(self.location.choose_package, name, chosen)
        self._meshes.retry()
        await self._timed(self._runs.reopen(self.target))

    def set_display(self, display: str, name: str, *, value: bool | float | str) -> None:
        """Change one shared display setting."""
        self.scene.set_display(display, name, value)
        self._meshes.want()
        self.board.displays()
        self.variants.doubt()

    async def urdf(self) -> str:
        """The expanded URDF of the last good run, written in another thread.

        Raises:
            CommandError: There was none yet.
        """
        if self.expansion is None:
            raise CommandError(f"{self.title} has not been expanded yet: mend its problems first.")
        parts, root = self.model.assembly.parts(), self.expansion.root_attributes
        return await asyncio.to_thread(urdf_text, parts, root)

    async def ask(self, query: Query, reply: type[AnyReply], asker: Listener) -> AnyReply:
        """Ask the worker about the last good run.

        Raises:
            CommandError: It has no answer; the sentence says why.
        """
        answer = await self._runs.ask(query, asker)
        if isinstance(answer, reply):
            return answer
        raise CommandError(
            answer.sentence if isinstance(answer, NoReply) else f"{self.title} gave no answer."
        )

    def _take(self, outcome: Outcome, version: int) -> None:
        """A run ended: show what it gave, or say why the last good one stays."""
        before = self.phase, self._files, self.failed
        match outcome:
            case Failure():
                self._take_failure(outcome)
            case Expansion():
                self._take_expansion(outcome, version)
        if before != (self.phase, self._files, self.failed):
            self.board.state()
            self.board.problems()
        self._watch_files()
        self._texts_changed()
        if self.sources.conflicts:  # an undo, say, may have ended them
            self._spawn("disk", self._changed_on_disk(set(self.sources.conflicts)))

    def _take_failure(self, failure: Failure) -> None:
        self.failed, self.failure = True, failure.problem.sentence
        self._files = tuple(dict.fromkeys((*self._files, *failure.files)))
        self.sources.track(failure.files)
        self.board.book.take_failure(self.sources)
        self.checks.failed(failure)

    def _take_expansion(self, expansion: Expansion, version: int) -> None:
        is_first = self.expansion is None
        self.expansion, self.failed, self._files = expansion, False, expansion.files
        change = self.model.take(expansion)  # first: this is the picture, what follows is talk
        self.sources.adopt(expansion, version)
        self.board.book.take(expansion)
        self.checks.expanded(expansion, change.problems, structural=is_first or change.structural)
        self._look_at_packages()
        if is_first or change.new_meshes:
            self._meshes.want()
        self.board.robot()

    async def follow(self, change: Change | None) -> None:
        """Run what an undo or redo, say, changed in the sources."""
        if change is None:
            return
        if change.arguments is None:
            await self._timed(self._run(change.edits))
            return
        if change.edits:  # both wait for the same run
            await asyncio.gather(self._run(change.edits), self._arguments_changed())
        else:
            await self._arguments_changed()

    async def _run(self, edits: Sequence[Edit], *, in_gesture: bool = False) -> None:
        """Run with edits; of files that the last run did not read, the worker holds no text."""
        files = {edit.file for edit in edits}
        if files <= set(self._files):
            await self._runs.edit(edits, in_gesture=in_gesture)
        else:
            await self._runs.reload(files)

    async def _arguments_changed(self) -> None:
        self.board.book.doubt_all()
        self.board.state()
        await self._timed(self._runs.arguments_changed())

    async def _timed(self, run: Awaitable[None]) -> None:
        """Wait for a run and tell how long it took from the edit to the scene."""
        began_s = time.perf_counter()
        await run
        took_ms = (time.perf_counter() - began_s) * 1000
        self.board.audience.tell(Built(ok=not self.failed, duration_ms=took_ms))

    async def _changed_on_disk(self, files: set[str]) -> None:
        self._meshes.reload(files)
        ours = files & {*self._files, *self.sources.conflicts}
        edits = self.disk.look(sorted(ours))
        self.board.book.doubt_all()
        self._texts_changed()
        if edits:
            await self._timed(self._run(edits))
        elif self.failed and files - ours:
            await self._timed(self._runs.reload(()))

    def _look_at_packages(self) -> None:
        """Tell of the packages in use of which there is more than one copy."""
        used = self.packages_used()
        if used is not self._packages_seen:
            self._packages_seen = used
            duplicates = self.location.index.duplicates(self.entry, used)
            self.board.find("packages", (*self.location.problems, *duplicates))

    def _texts_changed(self) -> None:
        self.board.texts()
        self.texts.follow()
        self.drafts.note()
        self.variants.doubt()
        if self.has_unsaved != self._was_unsaved:
            self._was_unsaved = self.has_unsaved
            self.on_unsaved()

    def _watch_files(self) -> None:
        self._watch.watch((*self._files, *self._meshes.files))
        self.variants.doubt()  # with a mesh come sizes
        self.robot_checks.doubt()

    def _spawn(self, name: str, work: Awaitable[None]) -> None:
        """Run something beside; the one of the same name before it is given up."""
        if before := self._background.get(name):
            before.cancel()
        self._background[name] = asyncio.ensure_future(work)
