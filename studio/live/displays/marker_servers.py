"""MarkerServers: feeds InteractiveMarkers displays, and sends feedback to the servers.

It imports Zenoh (through `ros`), so it is imported with the first such display.
"""

from __future__ import annotations

import asyncio
import logging
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, NamedTuple, Protocol

from studio.displays.interactive_marker import pose_of, read_marker, shown_name, unit_turn
from studio.displays.interactive_markers import CONTROLS_MAX, InteractiveMarkersDisplay
from studio.errors import CommandError, DisplayMessageError, FrameError, StudioError
from studio.protocol.markers import (
    ControlView,
    InteractiveMarkers,
    MarkersOfDisplay,
    MarkerView,
    MenuItemView,
)
from studio.ros.interactive_markers import ClientState, ClientStatus, InteractiveMarkerClient
from studio.ros.interactive_markers.names import (
    FEEDBACK,
    CommandKind,
    FeedbackEvent,
    Mode,
)
from studio.tf.rotations import compose

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine, Iterable, Mapping

    from studio.displays.display import Display
    from studio.displays.drawing import Pose
    from studio.displays.interactive_marker import MarkerModel, MenuItem
    from studio.displays.interactive_markers import ShownMarker
    from studio.live.connection.link import WireLink
    from studio.protocol.listeners import Listener
    from studio.protocol.markers import InteractWithMarker
    from studio.ros.types.classes import MessageValue
    from studio.tf.buffer import TransformBuffer

_LOOK_EVERY_S: Final = 0.25
"""Between two checks whether the server is there, while nothing comes from it."""
_SILENCE_S: Final = 2.0
"""A page that drags and says nothing for so long is gone."""
_TELL_EVERY_S: Final = 0.1
_BOXES: Final = {"[x]": True, "[ ]": False}
_NOT_CONNECTED: Final = (
    "There is no connection with a ROS 2 system, where the server would be: connect first."
)
_NO_NAMESPACE: Final = "Choose the namespace of a server, as /basic_controls."

_log = logging.getLogger(__name__)


class Frames(Protocol):
    """Where frames are in a document."""

    @property
    def buffer(self) -> TransformBuffer:
        """All transforms; thread-safe."""
        ...

    @property
    def fixed(self) -> str:
        """The frame that everything is drawn in."""
        ...


class _Wanted(NamedTuple):
    """What a client is made for; another one begins anew."""

    link: WireLink
    namespace: str
    is_transparent: bool
    resets: int


class _Moved(NamedTuple):
    """A pose that the server gave a marker."""

    name: str
    pose: Pose
    frame: str
    stamp_ns: int


@dataclass(slots=True)
class _News:
    """What a client handed over in one step, read and to be shown."""

    clears: bool = False
    markers: list[MarkerModel] = field(default_factory=list["MarkerModel"])
    refused: list[tuple[str, str]] = field(default_factory=list[tuple[str, str]])
    poses: list[_Moved] = field(default_factory=list[_Moved])
    erased: list[str] = field(default_factory=list[str])
    left_out: int = 0


class _Held(NamedTuple):
    """Who drags a marker, by which control, and when anything was heard of it last."""

    listener: Listener
    command: InteractWithMarker
    heard_s: float


class _Server:
    """A display, the client of its server, and who drags which of its markers."""

    def __init__(self, display: InteractiveMarkersDisplay, buffer: TransformBuffer) -> None:
        self.display, self._buffer = display, buffer
        self.wanted: _Wanted | None = None
        self.made: _Wanted | None = None
        self.client: InteractiveMarkerClient | None = None
        self.working: asyncio.Task[None] | None = None
        self.looked_s = float("-inf")
        self.held: dict[int, _Held] = {}
        """By number of the marker."""
        self.turn = asyncio.Lock()
        """Feedback goes out in the order in which it was asked for."""
        self.said: tuple[ClientStatus, str] = ClientStatus.INFO, ""
        self._news: list[_News] = []
        self._left_out = 0
        """As the client counted it last."""

    @property
    def is_due(self) -> bool:
        """Whether a step would do something."""
        if self.working is not None:
            return False
        is_other = self.made != self.wanted
        has_news = self.client is not None and self.client.has_news
        return is_other or has_news or time.monotonic() - self.looked_s >= _LOOK_EVERY_S

    def step(self) -> list[_News]:
        """Let the client work, in a thread; return what came."""
        self.looked_s = time.monotonic()
        if self.made != self.wanted:
            self.disconnect()
            self._connect()
        if self.client is not None:
            self.client.update()
        news, self._news = self._news, []
        return news

    def disconnect(self) -> None:
        """Follow no server, until the next step."""
        client, self.client, self.made = self.client, None, None
        self.said = ClientStatus.INFO, ""
        if client is not None:
            client.disconnect()

    def _connect(self) -> None:
        wanted = self.made = self.wanted
        if wanted is None or not wanted.namespace:
            return
        client = InteractiveMarkerClient(wanted.link.node, controls_max=CONTROLS_MAX)
        self.client, self._left_out = client, 0
        client.set_enable_autocomplete_transparency(wanted.is_transparent)
        client.set_initialize_callback(lambda answer: self._take(answer, clears=True))
        client.set_update_callback(self._take)
        client.set_reset_callback(lambda: self._news.append(_News(clears=True)))
        client.set_status_callback(self._say)
        client.connect(wanted.namespace)

    def _say(self, status: ClientStatus, sentence: str) -> None:
        if status is not ClientStatus.DEBUG:
            self.said = status, sentence

    def _take(self, message: MessageValue, *, clears: bool = False) -> None:
        """Read an answer or an update into values."""
        news = _News(clears=clears)
        for marker in message.markers:
            self._read(marker, news)
        for one in getattr(message, "poses", ()):
            self._read_pose(one, news)
        news.erased = list(getattr(message, "erases", ()))
        if self.client is not None:
            news.left_out = self.client.left_out - self._left_out
            self._left_out = self.client.left_out
        self._news.append(news)

    def _read(self, marker: MessageValue, news: _News) -> None:
        wanted = self.made
        # As in RViz, one without controls is as good as none.
        if not marker.controls or wanted is None:
            news.erased.append(marker.name)
            return
        try:
            model = read_marker(marker, wanted.link.types, self._seen_from)
        except (StudioError, ValueError, OverflowError) as error:
            news.refused.append((marker.name, str(error)))
            return
        news.markers.append(model)

    def _read_pose(self, one: MessageValue, news: _News) -> None:
        stamp = one.header.stamp
        try:
            pose = pose_of(one.pose, f'interactive marker "{shown_name(one.name)}"')
        except DisplayMessageError as error:
            news.refused.append((one.name, str(error)))
            return
        stamp_ns = stamp.sec * 1_000_000_000 + stamp.nanosec
        news.poses.append(_Moved(one.name, pose, one.header.frame_id.removeprefix("/"), stamp_ns))

    def _seen_from(self, target: str, frame: str, stamp_ns: int) -> Pose:
        found = self._buffer.fixed_from(target, frame, stamp_ns)
        return found.wxyz, found.xyz


class MarkerServers:
    """Steps on the loop with the displays; clients work in threads.

    Args:
        frames: Of the document.
        tell: Sends an event to all pages of the document.
    """

    def __init__(self, frames: Frames, tell: Callable[[InteractiveMarkers], object]) -> None:
        self._frames, self._tell = frames, tell
        self._servers: dict[str, _Server] = {}
        self._tasks: set[asyncio.Task[None]] = set()
        self._told: tuple[tuple[str, int, int], ...] = ()
        self._told_s = float("-inf")
        self.event = InteractiveMarkers(displays=())
        """As it was sent last."""

    def step(self, shown: Mapping[str, Display], link: WireLink | None) -> None:
        """Let all clients work, show what came, and tell pages what can be done with it.

        Args:
            shown: The displays that are switched on, by their ids.
            link: The connection, if there is one.
        """
        ours = {
            name: one for name, one in shown.items() if isinstance(one, InteractiveMarkersDisplay)
        }
        for name in [name for name, one in self._servers.items() if ours.get(name) != one.display]:
            self._end(self._servers.pop(name))
        for name, display in ours.items():
            server = self._servers.setdefault(name, _Server(display, self._frames.buffer))
            self._step(server, link)
        self._tell_changes()

    def let_go(self) -> None:
        """Receive nothing more: the connection is about to end."""
        for server in self._servers.values():
            server.wanted = None
            server.held.clear()
            if server.working is None:
                server.disconnect()
            else:
                server.working.add_done_callback(lambda _, one=server: one.disconnect())
            server.display.clear()
        self._tell_changes(at_once=True)

    async def close(self) -> None:
        """End all that is running."""
        for server in self._servers.values():
            server.wanted = None
        await asyncio.gather(*self._tasks, return_exceptions=True)
        for server in self._servers.values():
            server.disconnect()

    async def interact(self, command: InteractWithMarker, listener: Listener) -> None:
        """Show what a page does to a marker, and send the feedback to its server.

        Raises:
            CommandError: The marker is gone, somebody else drags it, or nothing can be done so.
        """
        server = self._servers.get(command.display)
        shown = server.display.marker(command.marker) if server else None
        if server is None or shown is None:
            raise CommandError("This marker is not there any more.")
        self._check_holder(server, shown, command, listener)
        if command.action == "select":
            _check_entry(shown, command)
        else:
            _hold(server, shown, command, listener)
            _show(server.display, shown, command)
        async with server.turn:
            feedback = self._feedback(server, shown, command)
            if command.action == "release" and shown.number not in server.held:
                server.display.let_go(shown)  # what is told of is where the page left it
            if feedback:
                await asyncio.to_thread(_publish, server, feedback)

    def _step(self, server: _Server, link: WireLink | None) -> None:
        display = server.display
        wanted = None
        if link is not None and display.namespace:
            wanted = _Wanted(link, display.namespace, display.is_transparent, display.resets)
        server.wanted = wanted
        self._say(server, link)
        for number, held in tuple(server.held.items()):
            if time.monotonic() - held.heard_s > _SILENCE_S:
                self._release(server, number, held)
        if server.is_due:
            server.working = self._spawn(self._work(server))

    def _say(self, server: _Server, link: WireLink | None) -> None:
        display = server.display
        if not display.namespace:
            display.say("error", "no_server", _NO_NAMESPACE)
        elif link is None:
            display.say("error", "no_server", _NOT_CONNECTED)
        elif server.client is not None and server.client.state is ClientState.RUNNING:
            display.say("ok", None, "")
        elif server.said[1]:
            level = "error" if server.said[0] is ClientStatus.ERROR else "warn"
            display.say(level, "no_server", f"{server.said[1].rstrip('.')}.")

    async def _work(self, server: _Server) -> None:
        try:
            for news in await asyncio.to_thread(server.step):
                self._show(server, news)
        finally:
            server.working = None

    def _show(self, server: _Server, news: _News) -> None:
        display = server.display
        if server not in self._servers.values():
            return  # its display was removed meanwhile
        if news.clears:
            server.held.clear()
            display.clear()
        if server.wanted is None:
            return  # it is let go of meanwhile
        if news.markers or news.left_out:
            display.put(news.markers, left_out=news.left_out)
        for moved in news.poses:
            if not display.move(*moved):
                display.refuse(moved.name, _unknown(moved.name))
        for name, sentence in news.refused:
            display.refuse(name, sentence)
        if news.erased:
            display.erase(news.erased)
            there = {one.number for one in display.markers}
            for number in server.held.keys() - there:
                del server.held[number]

    def _check_holder(
        self,
        server: _Server,
        shown: ShownMarker,
        command: InteractWithMarker,
        listener: Listener,
    ) -> None:
        held = server.held.get(shown.number)
        name = shown_name(shown.model.name)
        if held is not None and held.listener is not listener and command.action != "select":
            raise CommandError(f'Somebody else moves "{name}": wait until they let go of it.')
        if held is None and command.action in ("move", "hold", "release"):
            raise CommandError(f'"{name}" is not held any more: press on it again.')

    def _release(self, server: _Server, number: int, held: _Held) -> None:
        """End a drag of a page that is gone."""
        del server.held[number]
        shown = server.display.marker(number)
        if shown is None:
            return
        command = held.command.model_copy(update={"action": "release", "clicked": False})
        feedback = self._feedback(server, shown, command)
        server.display.let_go(shown)
        self._spawn(asyncio.to_thread(_publish, server, feedback))

    def _feedback(
        self, server: _Server, shown: ShownMarker, command: InteractWithMarker
    ) -> list[MessageValue]:
        """Return the messages that RViz would send, in order."""
        if server.made is None:
            return []
        kind = server.made.link.types.message(FEEDBACK)
        control = _control_name(shown, command.control)
        made: list[MessageValue] = []
        for event in _events_of(command, _mode_of(shown, command.control)):
            feedback = kind(
                marker_name=shown.model.name, control_name=control, event_type=int(event)
            )
            if event is FeedbackEvent.MENU_SELECT:
                feedback.menu_entry_id = command.entry
            self._place(shown, command, feedback)
            made.append(feedback)
        return made

    def _place(
        self, shown: ShownMarker, command: InteractWithMarker, feedback: MessageValue
    ) -> None:
        """Say where marker and mouse are: of one with a stamp in the fixed frame, as RViz does."""
        model, fixed = shown.model, self._frames.fixed
        pose, point = _flat(model.pose), command.mouse_point
        feedback.header.frame_id = model.frame
        try:
            found = self._frames.buffer.fixed_from(fixed, model.frame, model.stamp_ns)
            if model.stamp_ns:
                fixed_from_frame = _flat((found.wxyz, found.xyz))
                pose = compose(fixed_from_frame, pose)
                point = point and compose(fixed_from_frame, (1, 0, 0, 0, *point))[4:]
                feedback.header.frame_id = fixed
            elif fixed != model.frame:
                stamp = feedback.header.stamp
                stamp.sec, stamp.nanosec = divmod(found.stamp_ns, 1_000_000_000)
        except FrameError:
            feedback.header.stamp.sec = 0  # its place in its own frame is right all the same
        _put_pose(feedback.pose, pose)
        if point is not None and command.action in ("press", "release", "select"):
            feedback.mouse_point_valid = True
            place = feedback.mouse_point
            place.x, place.y, place.z = point

    def _tell_changes(self, *, at_once: bool = False) -> None:
        """Tell the pages what can be done with the markers, when that changed."""
        now_s = time.monotonic()
        now = tuple(
            (name, id(one.display), one.display.version) for name, one in self._servers.items()
        )
        is_early = now_s - self._told_s < _TELL_EVERY_S and not at_once
        if now == self._told or is_early:
            return
        self._told, self._told_s = now, now_s
        event = InteractiveMarkers(
            displays=tuple(_view(name, one.display) for name, one in self._servers.items())
        )
        if event != self.event:
            self.event = event
            self._tell(event)

    def _end(self, server: _Server) -> None:
        server.wanted = None
        server.display.clear()
        if server.working is None:
            self._spawn(asyncio.to_thread(server.disconnect))
        else:
            server.working.add_done_callback(lambda _: server.disconnect())

    def _spawn(self, work: Coroutine[None, None, None]) -> asyncio.Task[None]:
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._ended)
        return task

    def _ended(self, task: asyncio.Task[None]) -> None:
        self._tasks.discard(task)
        if not task.cancelled() and (error := task.exception()):
            _log.error("An interactive marker server could not be followed.", exc_info=error)


def _hold(
    server: _Server, shown: ShownMarker, command: InteractWithMarker, listener: Listener
) -> None:
    """Note who drags a marker from now on, or that nobody does."""
    if command.action == "release":
        server.held.pop(shown.number, None)
    else:
        server.held[shown.number] = _Held(listener, command, time.monotonic())


def _publish(server: _Server, feedback: Iterable[MessageValue]) -> None:
    client = server.client
    for one in feedback:
        if client is not None:
            client.publish_feedback(one)


def _show(
    display: InteractiveMarkersDisplay, shown: ShownMarker, command: InteractWithMarker
) -> None:
    """Have the marker where the page dragged it, for all who look."""
    turn, place = shown.model.pose
    if command.position is not None:
        place = command.position
    if command.orientation is not None:
        turn = unit_turn(command.orientation) or turn
    display.drag(shown, (turn, place), (command.control or 0, command.turn_rad))


def _events_of(command: InteractWithMarker, mode: int) -> tuple[FeedbackEvent, ...]:
    match command.action:
        case "press":
            return FeedbackEvent.POSE_UPDATE, FeedbackEvent.MOUSE_DOWN
        case "move":
            return (FeedbackEvent.POSE_UPDATE,)
        case "hold":
            return (FeedbackEvent.KEEP_ALIVE,)
        case "select":
            return (FeedbackEvent.MENU_SELECT,)
        case "release":
            clicked = command.clicked and mode == Mode.BUTTON
            first = (FeedbackEvent.BUTTON_CLICK,) if clicked else ()
            return (*first, FeedbackEvent.POSE_UPDATE, FeedbackEvent.MOUSE_UP)


def _check_entry(shown: ShownMarker, command: InteractWithMarker) -> None:
    """Pass if a click on the entry is for the server.

    Raises:
        CommandError: There is no such entry any more, or it would start a program.
    """
    entry = next((one for one in shown.model.menu if one.id == command.entry), None)
    if entry is None:
        raise CommandError("This entry is not in the menu any more: open it again.")
    if entry.command_type != CommandKind.FEEDBACK:
        verb = "launch" if entry.command_type == CommandKind.ROSLAUNCH else "run"
        raise CommandError(
            f"The entry asks for `ros2 {verb} {entry.command}` on this machine: the studio starts "
            "no programs for a server, so run it in a terminal if you trust it."
        )


def _control_name(shown: ShownMarker, number: int | None) -> str:
    return next((name for name, one in shown.control_numbers.items() if one == number), "")


def _mode_of(shown: ShownMarker, number: int | None) -> int:
    name = _control_name(shown, number)
    return next((one.mode for one in shown.model.controls if one.name == name), int(Mode.NONE))


def _unknown(name: str) -> str:
    return (
        f'A pose came for an interactive marker "{shown_name(name)}", which the server never '
        "sent: it may have been left out."
    )


def _flat(pose: Pose) -> tuple[float, float, float, float, float, float, float]:
    (w, x, y, z), (px, py, pz) = pose
    return w, x, y, z, px, py, pz


def _put_pose(pose: MessageValue, parts: tuple[float, ...]) -> None:
    turn, place = pose.orientation, pose.position
    turn.w, turn.x, turn.y, turn.z, place.x, place.y, place.z = parts


def _view(name: str, display: InteractiveMarkersDisplay) -> MarkersOfDisplay:
    return MarkersOfDisplay(
        display=name,
        visual_aids=display.has_visual_aids,
        markers=tuple(_marker_view(one) for one in display.markers),
    )


def _marker_view(shown: ShownMarker) -> MarkerView:
    model, numbers = shown.model, shown.control_numbers
    return MarkerView(
        number=shown.number,
        name=shown_name(model.name),
        description=model.description,
        scale=model.scale,
        controls=tuple(
            ControlView(
                number=numbers[one.name],
                mode=one.mode,
                facing=one.facing,
                wxyz=one.wxyz,
                independent=one.independent,
                always_visible=one.always_visible,
                description=one.description,
            )
            for one in model.controls
        ),
        menu=tuple(map(_menu_item, model.menu)),
    )


def _menu_item(item: MenuItem) -> MenuItemView:
    """Take the box that a title begins with out of it, as RViz does."""
    checked = _BOXES.get(item.title[:3])
    title = item.title if checked is None else item.title[3:].strip()
    return MenuItemView(id=item.id, parent=item.parent, title=title, checked=checked)
