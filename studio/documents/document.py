"""One open description: builds its parts, and connects those that follow others' changes."""

from __future__ import annotations

import asyncio
import contextlib
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.description.values import Expansion, Failure
from studio.documents.checks.fixes import COMMANDS as FIX_COMMANDS
from studio.documents.checks.fixes import Fixes
from studio.documents.checks.mesh_checks import MeshChecks
from studio.documents.checks.pace import Pace
from studio.documents.checks.robot_checks import RobotChecks
from studio.documents.checks.text_checks import TextChecks, second_opinion
from studio.documents.disk_sync import COMMANDS as DISK_COMMANDS
from studio.documents.disk_sync import DiskSync
from studio.documents.drafts import COMMANDS as DRAFT_COMMANDS
from studio.documents.drafts import Drafts
from studio.documents.edits import COMMANDS as EDIT_COMMANDS
from studio.documents.edits import Edits, history_event
from studio.documents.exports import Exports
from studio.documents.file_watch import FileWatch
from studio.documents.findings import Findings
from studio.documents.inspection import COMMANDS as INSPECTION_COMMANDS
from studio.documents.inspection import Inspection
from studio.documents.meshes import Meshes
from studio.documents.model import Model
from studio.documents.motion import COMMANDS as MOTION_COMMANDS
from studio.documents.motion import Motion
from studio.documents.origins import COMMANDS as ORIGIN_COMMANDS
from studio.documents.origins import Origins
from studio.documents.pose_search import PoseSearch
from studio.documents.poses import COMMANDS as POSE_COMMANDS
from studio.documents.poses import NamedPoses
from studio.documents.rewriting import COMMANDS as REWRITING_COMMANDS
from studio.documents.rewriting import Rewriting
from studio.documents.robot_view import RobotView
from studio.documents.runs import Outcome, Runs
from studio.documents.saving import COMMANDS as SAVING_COMMANDS
from studio.documents.saving import Saving
from studio.documents.sites import SiteTable
from studio.documents.texts import COMMANDS as TEXT_COMMANDS
from studio.documents.texts import QUESTIONS as QUESTION_COMMANDS
from studio.documents.texts import EditorQuestions, Texts
from studio.documents.urdf import COMMANDS as URDF_COMMANDS
from studio.documents.urdf import UrdfText
from studio.documents.variants.comparison import VariantComparison
from studio.documents.variants.recipes import RecipeBook
from studio.documents.variants.second_robot import Ghost, SecondRobots
from studio.documents.variants.variants import COMMANDS as VARIANT_COMMANDS
from studio.documents.variants.variants import NamedVariants
from studio.documents.workspace import Workspace
from studio.errors import CommandError, StudioError
from studio.live.connection.feed import COMMANDS as FEED_COMMANDS
from studio.live.connection.feed import RobotFeed
from studio.live.connection.opened_types import take_types
from studio.live.displays.display_file import DisplayFile
from studio.live.displays.document_displays import COMMANDS as DISPLAY_COMMANDS
from studio.live.displays.document_displays import DocumentDisplays
from studio.live.displays.ghost import Ghost as RecordedGhost
from studio.live.displays.robot_reading import RobotReader
from studio.live.displays.rviz_configs import COMMANDS as CONFIG_COMMANDS
from studio.live.displays.rviz_configs import RvizConfigs
from studio.live.displays.selecting import COMMANDS as SELECTION_COMMANDS
from studio.live.displays.selecting import Selecting
from studio.live.time.bookmarks import BookmarkFile
from studio.live.time.document_source import DocumentSource
from studio.live.time.document_time import COMMANDS as TIME_COMMANDS
from studio.live.time.document_time import DocumentTime
from studio.live.time.recorded_robot import DESCRIPTION, recorded_joints
from studio.protocol.commands import Commands, Scope
from studio.protocol.documents import ChoosePackage, DocumentState, Progress
from studio.protocol.listeners import Audience, Listener, send
from studio.protocol.robot import Displays, SetDisplay
from studio.protocol.roles import owner_of
from studio.scene import DocumentScene

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Iterable, Mapping

    from studio.bags.recording import Recording
    from studio.documents.services import Services
    from studio.live.time.shown import ShownRecording
    from studio.packages.workspace import Location
    from studio.protocol import Event
    from studio.protocol.connection import JointSource


class Document:
    """An open description, from its first run until it is closed.

    Raises:
        CommandError: The location has no entry file.
    """

    def __init__(
        self, name: str, location: Location, arguments: Mapping[str, str], services: Services
    ) -> None:
        self.id, self._services = name, services
        self.on_unsaved: Callable[[], None] = lambda: None
        """Called when the document comes to have unsaved edits, or no longer has any."""
        self.own_bag = ""
        """The bag that it was opened for, whose robot it is."""
        self._build_state(location, arguments)
        self._build_parts()
        self._build_watchers()
        self._watch = FileWatch(self._files_changed, troubled=self.disk.report_watch)
        self.texts.on_first = self._watch_files
        self._was_unsaved = False
        self._state_before = self._run_state()
        self._packages_before: dict[str, str] | None = None
        self._background: dict[str, asyncio.Task[None]] = {}
        self.findings.replace("packages", location.problems)

    def _build_state(self, location: Location, arguments: Mapping[str, str]) -> None:
        """Make what many parts share."""
        services = self._services
        self.workspace = Workspace(
            location, arguments, trusted=services.settings.trusted, runs=services.run_folders
        )
        self.entry, self.path = self.workspace.entry, self.workspace.path
        self.sources, self.audience = self.workspace.sources, Audience()
        self.scene = DocumentScene(asyncio.get_running_loop())
        self.model = Model(self.scene)
        worker = services.description_worker(self.opened)
        self.runs = Runs(worker, self.sources, self.workspace, self._take)
        self.last_run = self.runs.last
        self.findings = Findings(self.audience, self.last_run)
        self.sites = SiteTable(self.sources, self.audience)
        self.robot_view = RobotView(self.model, self.audience)
        self.edits = Edits(self.workspace, self.runs, self.sites, self.audience, self)

    def _build_parts(self) -> None:
        """Make the parts that act when they are asked."""
        services, workspace, runs = self._services, self.workspace, self.runs
        last, model, audience = self.last_run, self.model, self.audience
        findings, edits = self.findings, self.edits
        self.texts = Texts(workspace, last, audience, edits)
        self.language = EditorQuestions(self.texts, runs)
        self.rewriting = Rewriting(workspace, runs, self.texts, edits)
        self.fixes = Fixes(workspace, findings, edits)
        self.origins = Origins(runs, model)
        self.inspection = Inspection(model, workspace, services.meshes)
        self.urdf = UrdfText(workspace, last, model, services.description_worker)
        self.exports = Exports(
            workspace, last, self.urdf, self.scene, self.opened, self.packages_used
        )
        self.disk = DiskSync(workspace, runs, edits, findings, audience)
        data_folder = services.settings.data_folder
        self.drafts = Drafts(workspace, self.disk, findings, audience, data_folder)
        self.saving = Saving(workspace, self.disk, edits, self.drafts, audience)
        self.motion = Motion(model, self.robot_view)

    def _build_watchers(self) -> None:
        """Make the parts that follow the robot, the files or the ROS system by themselves."""
        services, workspace, audience = self._services, self.workspace, self.audience
        last, model, library = self.last_run, self.model, services.meshes
        take_worker = services.description_worker
        self._meshes = Meshes(workspace, model, library, self.findings, audience, self._watch_files)
        pace = Pace(partial(self.opened, services.patience_s), services.quiet_s)
        validate = partial(second_opinion, model, self.urdf, services.validator)
        self.checks = TextChecks(workspace, self.runs, self.findings, validate, pace)
        mesh_checks = MeshChecks(workspace, model, self._meshes, library)
        self.robot_checks = RobotChecks(workspace, last, model, mesh_checks, self.findings, pace)
        search = PoseSearch(workspace, last, self.sites, model, take_worker)
        self.poses = NamedPoses(workspace, model, self.motion, search, audience)
        book = RecipeBook(self.sources, lambda: self.workspace.location)
        robots = SecondRobots(workspace, last, model, self.sites, take_worker)
        comparison = VariantComparison(book, robots, Ghost(model), audience, self._meshes.want)
        self.variants = NamedVariants(workspace, self.edits, book, comparison, audience)
        self.source = DocumentSource(services.wire.topics)
        self.feed = RobotFeed(
            model, self.motion, lambda: last.expansion, services.wire, self.source, audience
        )
        data_folder = services.settings.data_folder
        self.live = DocumentDisplays(
            model,
            self._meshes,
            RobotReader(take_worker, workspace, data_folder / "from_ros" / "nowhere"),
            DisplayFile(data_folder, self.entry),
            services.wire,
            self.source,
            audience,
        )
        self.time = DocumentTime(
            self.source,
            audience,
            services.rewinding,
            lambda path: BookmarkFile(Path(path), data_folder),
            writes=not owner_of(self.id),
        )
        self.time.on_moment = self._draw_moment
        self.time.on_switch = self._time_switched
        self._joints_before: JointSource | None = None
        """What moved the joints before a recording did; None: none does."""
        self._ghost = RecordedGhost(self.live)
        self.live.use(services.plugins)
        self.selecting = Selecting(self.live.drawn)
        self.feed.is_held = lambda: self.live.is_paused
        self.configs = RvizConfigs(self.live, workspace, data_folder, audience)

    @property
    def title(self) -> str:
        """The entry file's name, or which untitled text it is."""
        return self.workspace.title

    @property
    def location(self) -> Location:
        """The folders of its files at present."""
        return self.workspace.location

    @property
    def has_unsaved(self) -> bool:
        """Whether any text differs from the disk."""
        return bool(self.sources.unsaved_files)

    def confine(self) -> None:
        """Read no file that was not read so far: somebody who is not trusted with them edits now.

        It stays so, whoever has control, until a presenter saves or reloads: else what they wrote
        would read more at the presenter's next edit.
        """
        self.workspace.confine((*self.last_run.files, self.path))
        self._spawn("confined", self.runs.reopen())

    def free(self) -> None:
        """A presenter has looked at the texts: read what the opened folders have, again."""
        if self.workspace.free():
            self._spawn("confined", self.runs.reopen())

    @property
    def mesh_files(self) -> tuple[Path, ...]:
        """The files of all meshes in use."""
        return tuple(map(Path, self._meshes.files))

    def put_joints(self, positions: Mapping[str, float]) -> None:
        """Have the joints stand so once the robot is there."""
        self._spawn("joints", self._put_joints(positions))

    def packages_used(self) -> dict[str, str]:
        """Return each package that the last run or a mesh used, and its folder."""
        return self.workspace.packages_of((*self.last_run.files, *self._meshes.files))

    def start(self) -> None:
        """Start the first run; the audience is sent its progress."""
        self.sources.track([self.path])
        self.drafts.restore()
        self.live.restore()
        self._spawn("opening", self._open())

    def begin_background_work(self) -> None:
        """Take up the types of the opened packages, and prepare what is used later."""
        self._spawn("types", self._take_types())
        self._spawn("sweep", self._sweep())
        self._spawn("imports", self._services.import_rest(self.opened))

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
        await self.configs.close()
        await asyncio.gather(self.feed.close(), self.live.close())
        background = tuple(self._background.values())
        for task in background:
            task.cancel()
        await asyncio.gather(*background, return_exceptions=True)
        # Afterwards, for what follows a recording would follow what runs then, and connect for it.
        await self.time.close()
        await self.robot_checks.close()
        await self.checks.close()
        await asyncio.gather(self._watch.close(), self._meshes.close(), self.runs.close())
        await asyncio.gather(self.variants.close(), self.drafts.close(), self.poses.close())
        self.scene.close()

    def attach(self, listener: Listener) -> None:
        """Send a new page the whole state, and every change from then on."""
        for event in self._snapshot():
            send(listener, event)
        self.audience.add(listener)
        self.poses.trigger()

    async def choose_package(self, name: str, folder: str) -> None:
        """Use a folder for a package from now on, read-only.

        It may be anywhere while the studio is offered to nobody else, for a missing package is
        where nothing is served; otherwise it is one of the served folders.
        """
        chosen = Path(folder)
        if not self._services.settings.is_private:
            chosen = self.workspace.served.resolve(chosen)
        await self.workspace.choose_package(name, chosen)
        self._meshes.retry()
        await self.edits.timed(self.runs.reopen())

    def set_display(self, display: str, name: str, *, value: bool | float | str) -> None:
        """Change one shared display setting."""
        self.scene.set_display(display, name, value)
        self._meshes.want()
        self.audience.send(self._displays_event())
        self.variants.trigger()

    def value_edited(self) -> None:
        """Keep a draft soon, though no run has shown the edit yet."""
        self.drafts.note()

    def texts_changed(self) -> None:
        """Send the sites that changed, the undo list and what is unsaved."""
        self.sites.send()
        self.audience.send(history_event(self.sources))
        self.texts.follow()
        self.drafts.note()
        self.variants.trigger()
        if self.has_unsaved != self._was_unsaved:
            self._was_unsaved = self.has_unsaved
            self.on_unsaved()

    def arguments_changed(self) -> None:
        """Send the arguments, with the rest of the state."""
        self.audience.send(self._state_event())

    async def show_bag(self, shown: ShownRecording, *, with_ghost: bool) -> None:
        """Show a bag, and let the joints follow it once the robot is there.

        Args:
            shown: The bag, which is let go with the next one.
            with_ghost: Whether the robot of the bag is shown beside this one, as it was recorded.
        """
        await self.time.show(shown)
        is_described = shown.recording.topic(DESCRIPTION) is not None
        if with_ghost and is_described:
            await self._ghost.show(DESCRIPTION)

    def follow_time(self, original: Document) -> None:
        """Show the bag that another document shows, or what runs now once it shows none."""
        theirs, mine = original.time.shown, self.time.shown
        if theirs is not None and (theirs is mine or theirs.mode != "bag"):
            return
        if theirs is None and (mine is None or mine.mode != "bag"):
            self.time.refresh()
            return
        self._spawn("time", self._take_time(theirs))

    async def _take_time(self, theirs: ShownRecording | None) -> None:
        held = None if theirs is None else theirs.hold()  # here, for it may never begin
        if held is not None:
            await self.time.show(held)
        else:
            await self.time.go_live()

    async def _time_switched(self) -> None:
        """Let displays, panels and joints follow the time that is shown now."""
        self.live.begin_source()
        self._services.on_time_switch(self.id)
        recording = self.time.recording
        if recording is None:
            self._ghost.end()
        self._spawn("recorded joints", self._follow_joints(recording))

    async def _follow_joints(self, recording: Recording | None) -> None:
        """Let the joints follow a recording, or what they followed before."""
        await self.opened()
        source = recorded_joints(recording) if recording is not None else self._joints_before
        if recording is None:
            self._joints_before = None
        elif self._joints_before is None:
            self._joints_before = self.feed.source
        if source is not None:
            try:
                await self.feed.choose(source)
            except StudioError:  # what runs now is not there any more
                await self.feed.choose("sliders")

    async def _draw_moment(self) -> None:
        """Draw what the document shows now, before the next tick does."""
        self.feed.take()
        await self.live.draw()
        self._services.on_moment(self.id)

    async def _take_types(self) -> None:
        self.findings.replace("types", await asyncio.to_thread(take_types, self.location))

    async def _put_joints(self, positions: Mapping[str, float]) -> None:
        await self.opened()
        with contextlib.suppress(CommandError):  # something moves them already
            self.motion.set(positions)

    async def _sweep(self) -> None:
        await self.opened()  # then it is known which files it reads
        await self.saving.sweep()

    async def _open(self) -> None:
        self._send_progress(0)
        await self.edits.timed(self.runs.reopen())
        self._send_progress(1)

    def _send_progress(self, done: int) -> None:
        label = "Reading the description"
        self.audience.send(Progress(task="expand", label=label, done=done, total=1))

    def _take(self, outcome: Outcome, version: int) -> None:
        """Show the outcome of a run, or report why the last good one stays."""
        before, self._state_before = self._state_before, self._run_state()
        match outcome:
            case Failure():
                self._take_failure(outcome)
            case Expansion():
                self._take_expansion(outcome, version, is_first=before[0] != "ready")
        if before != self._state_before:
            self.audience.send(self._state_event())
            self.findings.send()
        self._watch_files()
        self.texts_changed()
        if self.sources.conflicts:  # an undo may have ended them
            self._spawn("disk", self.disk.changed(set(self.sources.conflicts)))

    def _run_state(self) -> tuple[object, ...]:
        """Return the part of the state event that comes from the last run."""
        last = self.last_run
        return last.phase, last.files, last.failed

    def _take_failure(self, failure: Failure) -> None:
        self.sources.track(failure.files)
        self.sites.take_failure()
        self.checks.failed(failure)

    def _take_expansion(self, expansion: Expansion, version: int, *, is_first: bool) -> None:
        change = self.model.take(expansion)  # first: this is the picture, what follows is talk
        self.sources.adopt(expansion, version)
        self.sites.take(expansion)
        self.checks.expanded(expansion, change.problems, structural=is_first or change.structural)
        self._report_duplicates()
        if is_first or change.new_meshes:
            self._meshes.want()
        if self.robot_view.send():
            self.poses.trigger()

    def _report_duplicates(self) -> None:
        """Report the packages in use of which there is more than one copy."""
        used = self.packages_used()
        if used is not self._packages_before:
            self._packages_before = used
            location = self.location
            duplicates = location.index.duplicates(self.entry, used)
            self.findings.replace("packages", (*location.problems, *duplicates))

    async def _files_changed(self, files: set[str]) -> None:
        self._meshes.reload(files)
        await self.disk.changed(files)

    def _watch_files(self) -> None:
        self._watch.watch(
            (*self.last_run.files, *self._meshes.files, *self.workspace.sources.files)
        )
        self.variants.trigger()  # with a mesh come sizes
        self.robot_checks.trigger()

    def _spawn(self, name: str, work: Awaitable[None]) -> None:
        """Run something beside; the one of the same name before it is given up."""
        if before := self._background.get(name):
            before.cancel()
        self._background[name] = asyncio.ensure_future(work)

    def _snapshot(self) -> Iterable[Event]:
        yield self._state_event()
        if self.last_run.expansion:
            yield self.robot_view.robot_event()
            yield self.robot_view.joints_event()
            yield self.sites.event()
        yield self._displays_event()
        yield history_event(self.sources)
        yield self.findings.event()
        yield from self.variants.events()
        yield from self.poses.events()
        yield from self.feed.events()
        yield from self.live.events()
        yield from self.configs.events()
        yield from self.time.events()
        yield from self.drafts.events()

    def _state_event(self) -> DocumentState:
        """Files, arguments, evaluator and phase."""
        expansion, workspace = self.last_run.expansion, self.workspace
        files = expansion.files if expansion else (self.path,)
        return DocumentState(
            id=self.id,
            title=self.title,
            path=self.path,
            root=str(workspace.location.root),
            arguments=self.sources.arguments,
            evaluator=expansion.evaluator if expansion else "",
            fallback_reason=expansion.fallback_reason if expansion else "",
            files=files,
            packages=self.packages_used(),
            read_only=tuple(file for file in files if not workspace.may_write(file)),
            phase=self.last_run.phase,
            is_bare=workspace.location.is_bare,
            may_run=workspace.may_run,
        )

    def _displays_event(self) -> Displays:
        return Displays(displays=self.scene.displays())


COMMANDS: Final = Commands[Document](Scope.DOCUMENT)
"""Every command of a document."""
COMMANDS.presenter(ChoosePackage, lambda d, c, _: d.choose_package(c.name, c.folder))
COMMANDS.controller(SetDisplay, lambda d, c, _: d.set_display(c.display, c.name, value=c.value))
COMMANDS.include(EDIT_COMMANDS, lambda document, _: document.edits)
COMMANDS.include(FIX_COMMANDS, lambda document, _: document.fixes)
COMMANDS.include(TEXT_COMMANDS, lambda document, _: document.texts)
COMMANDS.include(QUESTION_COMMANDS, lambda document, _: document.language)
COMMANDS.include(REWRITING_COMMANDS, lambda document, _: document.rewriting)
COMMANDS.include(DISK_COMMANDS, lambda document, _: document.disk)
COMMANDS.include(SAVING_COMMANDS, lambda document, _: document.saving)
COMMANDS.include(DRAFT_COMMANDS, lambda document, _: document.drafts)
COMMANDS.include(MOTION_COMMANDS, lambda document, _: document.motion)
COMMANDS.include(URDF_COMMANDS, lambda document, _: document.urdf)
COMMANDS.include(ORIGIN_COMMANDS, lambda document, _: document.origins)
COMMANDS.include(INSPECTION_COMMANDS, lambda document, _: document.inspection)
COMMANDS.include(VARIANT_COMMANDS, lambda document, _: document.variants)
COMMANDS.include(POSE_COMMANDS, lambda document, _: document.poses)
COMMANDS.include(FEED_COMMANDS, lambda document, _: document.feed)
COMMANDS.include(TIME_COMMANDS, lambda document, _: document.time)
COMMANDS.include(DISPLAY_COMMANDS, lambda document, _: document.live)
COMMANDS.include(SELECTION_COMMANDS, lambda document, _: document.selecting)
COMMANDS.include(CONFIG_COMMANDS, lambda document, _: document.configs)
