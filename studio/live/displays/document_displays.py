"""DocumentDisplays: what is asked of the displays of a document, and the tick that draws them."""

from __future__ import annotations

import asyncio
import logging
import time
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

from msgspec import structs

from studio.errors import CommandError, StudioError, ToolError
from studio.live.displays.asked_frames import COMMANDS as FRAME_COMMANDS
from studio.live.displays.asked_frames import AskedFrames
from studio.live.displays.display_file import Keeper, KeptDisplays
from studio.live.displays.display_list import DisplayList, Listening
from studio.live.displays.document_tools import COMMANDS as TOOL_COMMANDS
from studio.live.displays.document_tools import DocumentTools
from studio.live.displays.followed_markers import COMMANDS as MARKER_COMMANDS
from studio.live.displays.followed_markers import FollowedMarkers
from studio.live.displays.groups import all_groups, group_path
from studio.live.displays.plugins import Plugins
from studio.live.displays.saved_views import COMMANDS as VIEW_COMMANDS
from studio.live.displays.saved_views import SavedViews
from studio.live.displays.scene_times import COMMANDS as TIME_COMMANDS
from studio.live.displays.scene_times import SceneTimes
from studio.live.displays.selecting import AllDrawn
from studio.live.displays.topic_offers import COMMANDS as TOPIC_COMMANDS
from studio.live.displays.topic_offers import TopicOffers, full_name
from studio.protocol.commands import Commands, OnCopies, Scope
from studio.protocol.displays import (
    AddDisplay,
    ArrangeDisplay,
    ArrangeGroup,
    DisplayStates,
    DuplicateDisplay,
    LiveDisplays,
    RemoveDisplay,
    RestoreDisplays,
    SetDisplayProperty,
    SetDisplayTopic,
    SetFixedFrame,
    SwitchDisplays,
)
from studio.protocol.listeners import LastSent

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from studio.displays.properties import Value
    from studio.live.connection.ros_connection import RosConnection
    from studio.live.displays.display_file import DisplayFile, OpenedConfig
    from studio.live.displays.display_list import DisplaySpec
    from studio.live.displays.document_tools import Pointed, ToolUse
    from studio.live.displays.drawing_room import DrawingRoom, Meshes, ShownRobot
    from studio.live.displays.placing import Shown
    from studio.live.displays.robot_models import RobotModels
    from studio.live.displays.robot_reading import RobotReader
    from studio.live.time.document_source import DocumentSource
    from studio.protocol import Event
    from studio.protocol.listeners import Audience


_TICK_S: Final = 1 / 30
_CHECK_EVERY_S: Final = 0.5
"""Between two checks of who publishes, and between two states sent of the displays."""
_UNSEEN_S: Final = 10.0
"""After so long without a page, subscribing and drawing stop; a reload is quicker than that."""
_PAUSE_SHARE: Final = 0.5
"""After a step that took long, others get this share of its time."""
_ASKED_FOR_S: Final = 5.0
"""TF is subscribed so long after frames were asked for: a panel asks every second."""

_log = logging.getLogger(__name__)


class DocumentDisplays:
    """Carries out the commands about displays, and ticks while there is anything to draw.

    A command that fails raises a CommandError or DisplayError and leaves everything as it was.

    Args:
        robot: The document's own robot, with the scene that the displays draw in.
        meshes: Loads the meshes that the scene lacks.
        reader: Reads descriptions of other robots.
        file: Keeps the displays.
        wire: The connection.
        source: The topics that the document shows.
        audience: Is sent the displays; they are drawn as long as it is not empty.
    """

    def __init__(  # noqa: PLR0913, PLR0917 - each is another part of the document
        self,
        robot: ShownRobot,
        meshes: Meshes,
        reader: RobotReader,
        file: DisplayFile,
        wire: RosConnection,
        source: DocumentSource,
        audience: Audience,
    ) -> None:
        self._robot, self._meshes, self._reader = robot, meshes, reader
        self._file, self._wire, self._audience = file, wire, audience
        self._source = source
        self._plugins = Plugins()
        self._unwatch: Callable[[], None] = lambda: None
        self._list = DisplayList()
        self._beside = KeptDisplays()
        """Of this, options of the view and an opened config; others have the rest."""
        self.views = SavedViews(audience, self._kept_changed)
        self.tools = DocumentTools(audience, self._kept_changed)
        self.offers = TopicOffers(wire, source)
        self._made: DrawingRoom | None = None
        self._robots: RobotModels | None = None
        """Made with the room."""
        self._markers = FollowedMarkers(audience)
        self._ticking: asyncio.Task[None] | None = None
        self._keeper = Keeper(file)
        self._seen_s = time.monotonic()
        self.times = SceneTimes(lambda: self._room, self._look, self._changed)
        self.frames = AskedFrames(lambda: self._room, self._look)
        self._fault = ""
        self._checked_s = 0.0
        self._asked_until_s = 0.0
        self._states = LastSent[DisplayStates](audience)
        self._settings = LastSent[LiveDisplays](audience)
        self._subscribing = asyncio.Lock()
        self._closed = False
        self.on_list: Callable[[], object] = lambda: None
        """Called when displays, tools or views were added, removed or changed."""
        self.on_change: Callable[[], object] = lambda: None
        """Called after any change of what is kept."""

    def use(self, plugins: Plugins) -> None:
        """Have the owner's displays, too; to be called before any is made."""
        self._plugins, self._unwatch = plugins, plugins.on_change(self._plugins_changed)
        self.offers.plugins = plugins

    @property
    def kept(self) -> KeptDisplays:
        """All that is kept of them."""
        return structs.replace(
            self._beside,
            displays=tuple(self._list),
            groups_off=self._list.groups_off,
            fixed_frame=self._fixed_frame,
            tools=self.tools.kept,
            views=self.views.specs,
        )

    @property
    def config(self) -> OpenedConfig | None:
        """The config file that is open; thread-safe."""
        return self._beside.config

    def replace_all(self, kept: KeptDisplays) -> None:
        """Have these displays, this fixed frame and all else that is kept, instead of what is."""
        for one in tuple(self._list):
            self._remove(one.id)
        self._take(kept)
        self._room.renew()
        self._changed()

    def keep_beside(self, **changes: Any) -> None:  # noqa: ANN401 - fields of KeptDisplays
        """Change what is kept beside the displays."""
        self._beside = structs.replace(self._beside, **changes)
        self._changed()

    def set_entries(self, entries: Sequence[dict[str, Any]]) -> None:
        """Note what a config file says of each display from now on."""
        self._list.set_entries(entries)
        self._respecify()

    async def connect_if_needed(self) -> None:
        """Ensure a connection where a display has a topic, or the fixed frame is no link."""
        frame = self._fixed_frame
        is_foreign = frame and frame not in self._room.frames.own.links
        if is_foreign or any(one.topic for one in self._list):
            await self._connect()

    @property
    def states(self) -> DisplayStates | None:
        """The states sent last; None: nothing was drawn yet."""
        return self._states.event

    def mirror(self, other: KeptDisplays) -> None:
        """Have the displays and tools of another document; how displays look here stays."""
        self.tools.mirror(other.tools)
        missing = {(one.kind, one.name, one.topic): one for one in other.displays}
        gone = [one for one in self._list if not missing.pop((one.kind, one.name, one.topic), None)]
        for one in gone:
            self._remove(one.id)
        for spec in missing.values():
            self._restore_one(spec)
        options = {"background": other.background, "frame_rate": other.frame_rate}
        if self._beside != structs.replace(self._beside, **options):
            self.keep_beside(**options)
        elif gone or missing:
            self._changed()

    @property
    def _room(self) -> DrawingRoom:
        """Made when it is first needed: what it imports takes time, and no opening waits for it."""
        if self._made is None:
            from studio.live.displays.drawing_room import DrawingRoom  # noqa: PLC0415 - see above
            from studio.live.displays.robot_models import RobotModels  # noqa: PLC0415

            self._made = DrawingRoom(self._robot, self._meshes, self._source, self._plugins)
            self._robots = RobotModels(self._robot, self._source, self._reader)
        return self._made

    def restore(self) -> None:
        """Take up the displays of the last time."""
        self._take(self._file.read())
        self._show_and_hide()
        self._go_on()

    def _take(self, kept: KeptDisplays) -> None:
        self._beside = kept
        self.views.restore(kept.views)
        self.tools.restore(kept.tools)
        if kept.fixed_frame != self._fixed_frame:
            self._room.frames.chosen = kept.fixed_frame
        for spec in kept.displays:
            self._restore_one(spec)
        for group in all_groups(one.group for one in self._list):
            self._list.switch_group(group, shown=group not in kept.groups_off)

    def _restore_one(self, spec: DisplaySpec) -> None:
        added = self._list.put(spec)
        self._room.open(added, is_kept=True)

    def events(self) -> Iterable[Event]:
        """Yield the events for a new page; with a page there, displays are drawn again."""
        self._seen_s = time.monotonic()
        self._go_on()
        yield self._displays()
        yield self.views.event()
        yield self.tools.event()
        if self._states.event is not None:
            yield self._states.event
        yield from self._markers.events()

    async def add(self, command: AddDisplay) -> None:
        """Add a display; with a topic, the connection is made if there is none."""
        kind = self._plugins.of_kind(command.kind)
        topic = full_name(command.topic) or kind.FIRST_TOPIC
        spec = self._list.add(command.kind, topic)
        if settings := kind.settings_for(topic):
            spec = replace(spec, topic="", values=settings)
            self._list.change(spec)
        try:
            self._room.open(spec)
        except StudioError:
            self._list.remove(spec.id)
            raise
        self._changed()
        if topic:
            await self._connect()

    def remove(self, command: RemoveDisplay) -> None:
        """Take a display away, or a group with all that is in it."""
        if command.display:
            self._remove(command.display)
        else:
            for one in self._list.members(command.group):
                self._remove(one.id)
        self._changed()

    def put_back(self, command: RestoreDisplays) -> None:
        """Put back what was taken away; what fails leaves the others there."""
        try:
            for display in command.displays:
                self._open_again(self._list.put_back(display))
        finally:
            self._changed()

    def _open_again(self, spec: DisplaySpec) -> None:
        try:
            self._room.open(spec)
        except StudioError:
            self._list.remove(spec.id)
            raise

    def _remove(self, display: str) -> None:
        self._list.remove(display)
        running = self._room.close(display)
        if running is not None:
            running.close()

    def duplicate(self, command: DuplicateDisplay) -> None:
        """Add one like another."""
        self._room.open(self._list.duplicate(command.display), is_kept=True)
        self._changed()

    def arrange(self, command: ArrangeDisplay) -> None:
        """Name, group or move one."""
        spec = self._list.get(command.display)
        name = spec.name if command.name is None else command.name.strip()
        if not name:
            raise CommandError("A display needs a name of at least one letter.")
        group = spec.group if command.group is None else group_path(command.group)
        if command.before is not None:
            self._list.move(spec.id, command.before)
        self._change(replace(spec, name=name, group=group))

    def arrange_group(self, command: ArrangeGroup) -> None:
        """Name or move a group with all that is in it."""
        beside = self._beside.regrouped(command.group, command.to)
        self._list.arrange_group(command.group, command.to, command.before)
        self._beside = beside
        self._respecify()
        self._changed()

    def switch(self, command: SwitchDisplays) -> None:
        """Show or hide one, a group as a whole, or each."""
        if command.display:
            self._change(replace(self._list.get(command.display), enabled=command.enabled))
            return
        if command.group:
            self._list.switch_group(command.group, shown=command.enabled)
        else:
            self._list.switch_all(shown=command.enabled)
        self._respecify()
        self._changed()

    def _respecify(self) -> None:
        """Hand the settings of several displays to those that work with them."""
        for spec in self._list:
            self._room.get(spec.id).spec = spec

    async def set_topic(self, command: SetDisplayTopic) -> None:
        """Listen to another topic, or otherwise."""
        before = self._list.get(command.display)
        listening = Listening(command.reliable, command.latched, command.depth)
        spec = replace(before, topic=full_name(command.topic), listening=listening)
        old = None
        if spec.topic != before.topic:
            old = self._room.close(spec.id)
            self._room.open(spec, is_kept=True)
        self._change(spec)
        if old is not None:
            old.close()
        if spec.topic:
            await self._connect()

    def set_property(self, command: SetDisplayProperty) -> None:
        """Change a property."""
        spec = self._list.get(command.display)
        value = self._room.get(spec.id).set(command.name, command.value)
        self._room.draw_once((spec.id,))
        values: dict[str, Value] = {**spec.values, command.name: value}
        self._change(replace(spec, values=values))

    async def fix(self, frame: str) -> None:
        """Draw everything in another frame; empty: in that of the robot's root link."""
        frame, frames = frame.strip().removeprefix("/"), self._room.frames
        frames.chosen = frame
        self._room.renew()
        self._changed()
        if frame and frame not in frames.own.links:
            await self._connect()

    @property
    def markers(self) -> FollowedMarkers:
        """Its interactive markers."""
        return self._markers

    def shown(self, display: str) -> Shown:
        """Return what a display shows, and the poses of its parts in the fixed frame."""
        return self._room.get(display).placing.shown

    def drawn(self) -> AllDrawn:
        """Return what is drawn in the scene, for those who point at it."""
        frames = self._room.frames
        return AllDrawn(self._room.running, self._robot.robot, frames.lookup, frames.fixed)

    async def tool_use(self, pointed: Pointed) -> ToolUse:
        """Return what a tool is to send; subscribes to TF and the clock for a while.

        Raises:
            StudioError: There is no connection, or the tool cannot be used so, or a recording is
                shown: nobody is to drive where a robot once was.
        """
        if not self._source.is_live:
            raise ToolError("The view shows a recording: go back to what runs now to point there.")
        await self._wire.link()  # frames and the time come over it
        frames = await self.frames.now(wait=True)
        await frames.wait_for_clock()
        return self.tools.use(pointed, frames)

    @property
    def is_paused(self) -> bool:
        """Whether drawing is paused."""
        return self._made is not None and self._made.is_paused

    def _look(self) -> bool:
        """Subscribe to TF and the clock for a while; return whether nothing was subscribed."""
        is_first = not self._is_on
        self._asked_until_s = time.monotonic() + _ASKED_FOR_S
        self._go_on()
        return is_first

    def let_go(self) -> None:
        """Receive nothing until it is drawn again."""
        if self._robots is not None:
            self._robots.let_go()
        self._markers.let_go()
        if self._made is not None:
            self._made.unsubscribe()

    async def close(self) -> None:
        """Draw nothing more."""
        self._closed = True
        self._unwatch()
        self.tools.close()
        if self._ticking is not None:
            self._ticking.cancel()
            await asyncio.gather(self._ticking, return_exceptions=True)
        self.let_go()
        if self._robots is not None:
            await self._robots.close()
        await self._markers.close()
        if self._made is not None:
            self._made.close_all()
        await self._keeper.close()

    async def _plugins_changed(self, kinds: frozenset[str]) -> None:
        """Begin anew with the displays of kinds that came, changed or went."""
        for spec in self._list:
            if spec.kind in kinds and (old := self._room.close(spec.id)) is not None:
                self._room.open(spec, is_kept=True)
                old.close()
        self._show_and_hide()
        self._checked_s = 0.0
        self._send_displays()
        self._go_on()

    async def _connect(self) -> None:
        """Ensure a connection; if there is none, the displays' states say why."""
        try:
            if self._source.is_live:
                await self._wire.link()
        except StudioError as error:
            _log.info("Displays without a connection: %s", error)
        self._checked_s = 0.0
        self._go_on()

    def _change(self, spec: DisplaySpec) -> None:
        self._list.change(spec)
        self._room.get(spec.id).spec = spec
        self._changed()

    def _changed(self) -> None:
        """Send, keep and draw the list after a change."""
        self._show_and_hide()
        self._send_displays()
        self._checked_s = 0.0
        self._go_on()
        self._kept_changed()

    def _kept_changed(self) -> None:
        self._keeper.keep(self.kept)
        self.on_list()
        self.on_change()

    def _show_and_hide(self) -> None:
        for spec in self._list:
            self._robot.scene.live.show(spec.id, visible=self._list.is_shown(spec))

    @property
    def fixed_frame_in_use(self) -> str:
        """The frame that all is drawn in; empty: there is no robot yet."""
        return self._room.frames.fixed

    @property
    def _fixed_frame(self) -> str:
        return self._made.frames.chosen if self._made else ""

    @property
    def _is_on(self) -> bool:
        now_s = time.monotonic()
        if self._audience:
            self._seen_s = now_s
        wanted = now_s < self._asked_until_s or len(self._list) > 0 or self._fixed_frame != ""
        return wanted and now_s - self._seen_s < _UNSEEN_S

    def _go_on(self) -> None:
        idle = self._ticking is None or self._ticking.done()
        if idle and self._is_on and not self._closed:
            self._ticking = asyncio.create_task(self._tick())

    async def _tick(self) -> None:
        loop = asyncio.get_running_loop()
        while self._is_on:
            began_s = loop.time()
            try:
                is_due = began_s - self._checked_s >= _CHECK_EVERY_S
                if is_due:
                    self._checked_s = began_s
                    await self._subscribe()
                self._step()
                if is_due:
                    self._send_displays()
                    self._send_states()
            except Exception as error:  # noqa: BLE001 - what fails once must not end the rest
                self._log_once(error)
            ended_s = loop.time()
            rest_s = max(began_s + _TICK_S - ended_s, _PAUSE_SHARE * (ended_s - began_s))
            await asyncio.sleep(rest_s)
        self._step()
        self._send_states()
        self.let_go()
        self._ticking = None
        self._go_on()  # somebody may have asked meanwhile

    async def draw(self) -> None:
        """Draw what came, before the next tick does; what is new is subscribed first."""
        if self._ticking is None or self._ticking.done():
            return
        if not self._checked_s or self._subscribing.locked():
            await self._subscribe()
        self._step()

    def begin_source(self) -> None:
        """Subscribe soon where the topics come from now."""
        self._checked_s = 0.0
        self._go_on()

    def _step(self) -> None:
        """Draw what came, unless all is just being replaced by another moment's."""
        room = self._room
        # What reaches nodes reaches only those that run.
        link = self._wire.current if self._source.is_live else None
        if self._robots is not None:
            self._robots.step(room.displays(), link)
        shown = {one.id for one in self._list if self._list.is_shown(one)}
        self._markers.step(room, shown, link)
        with self._source.held() as is_steady:
            if is_steady:
                room.step(self._list, self._source.now_ns, time.time_ns())

    def _log_once(self, error: Exception) -> None:
        """Log the error of a tick, unless it is the one logged last: there are many ticks."""
        if repr(error) != self._fault:
            self._fault = repr(error)
            _log.error("A tick of the live scene failed.", exc_info=error)

    async def _subscribe(self) -> None:
        """Subscribe to what is shown."""
        async with self._subscribing:
            shown = {one.id for one in self._list if self._list.is_shown(one)}
            await self._room.subscribe(shown)

    def _send_states(self) -> None:
        self._states.send(self._room.states(self._list, self._source.now_ns))

    def _send_displays(self) -> None:
        """Send all settings if they changed: the QoS changes with the publishers."""
        self._settings.send(self._displays())

    def _displays(self) -> LiveDisplays:
        return LiveDisplays(
            displays=tuple(self._room.view(spec) for spec in self._list),
            groups_off=self._list.groups_off,
            fixed_frame=self._fixed_frame,
            kinds=self._plugins.generation,
            paused=self.is_paused,
            background=self._beside.background,
            frame_rate=self._beside.frame_rate,
        )


COMMANDS: Final = Commands[DocumentDisplays](Scope.DOCUMENT)
COMMANDS.controller(AddDisplay, lambda displays, c, _: displays.add(c), on_copies=OnCopies.REFUSED)
COMMANDS.controller(
    RemoveDisplay, lambda displays, c, _: displays.remove(c), on_copies=OnCopies.REFUSED
)
COMMANDS.controller(
    DuplicateDisplay, lambda displays, c, _: displays.duplicate(c), on_copies=OnCopies.REFUSED
)
COMMANDS.controller(
    RestoreDisplays, lambda displays, c, _: displays.put_back(c), on_copies=OnCopies.REFUSED
)
COMMANDS.controller(ArrangeDisplay, lambda displays, c, _: displays.arrange(c))
COMMANDS.controller(ArrangeGroup, lambda displays, c, _: displays.arrange_group(c))
COMMANDS.controller(SwitchDisplays, lambda displays, c, _: displays.switch(c))
COMMANDS.controller(SetDisplayTopic, lambda displays, c, _: displays.set_topic(c))
COMMANDS.controller(SetDisplayProperty, lambda displays, c, _: displays.set_property(c))
COMMANDS.controller(SetFixedFrame, lambda displays, c, _: displays.fix(c.frame))
COMMANDS.include(FRAME_COMMANDS, lambda displays, _: displays.frames)
COMMANDS.include(MARKER_COMMANDS, lambda displays, _: displays.markers)
COMMANDS.include(VIEW_COMMANDS, lambda displays, _: displays.views)
COMMANDS.include(TIME_COMMANDS, lambda displays, _: displays.times)
COMMANDS.include(TOOL_COMMANDS, lambda displays, _: displays.tools)
COMMANDS.include(TOPIC_COMMANDS, lambda displays, _: displays.offers)
