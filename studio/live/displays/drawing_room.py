"""DrawingRoom: the displays of a document at work, and the scene that they draw in."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from functools import partial
from itertools import islice
from typing import TYPE_CHECKING, Final, Protocol

from studio.displays.display import Status, TopicRole
from studio.displays.posed_robot import PosedRobot
from studio.errors import CommandError, DisplayError, SceneError
from studio.live.displays.catalogue_views import property_view
from studio.live.displays.followed_frames import FollowedFrames
from studio.live.displays.plugin_display import MissingDisplay
from studio.live.displays.plugins import PREFIX
from studio.live.displays.reasons import remarks_on
from studio.live.displays.running import RunningDisplay
from studio.live.displays.scene_frames import STILL, SceneFrames
from studio.live.displays.topics_now import TopicsNow
from studio.protocol.displays import (
    DisplayState,
    DisplayStates,
    DisplayView,
    ListeningView,
    PropertyView,
    Remark,
)
from studio.ros.messages import shared_types

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from studio.displays.display import Display
    from studio.displays.drawing import Pose
    from studio.live.displays.display_list import DisplayList, DisplaySpec, Listening
    from studio.live.displays.placing import Shown
    from studio.live.displays.plugins import Plugins
    from studio.live.topics.request import Fit
    from studio.live.topics.source import TopicSource
    from studio.protocol.roles import Visitor
    from studio.ros.types.library import TypeLibrary
    from studio.scene import DocumentScene

_MORE_MAX: Final = 500
"""So many properties from messages are sent for each display."""
_AT_ONCE_S: Final = 0.03
"""All displays together take messages for so long in one step: the loop has other work."""

_SENTENCE_MAX: Final = 600
"""Addresses of meshes come from others."""
_NO_TOPIC: Final = TopicRole("", (), depth=1)


class ShownRobot(PosedRobot, Protocol):
    """A robot that stands in a scene."""

    @property
    def scene(self) -> DocumentScene:
        """The 3D view."""
        ...


class Meshes(Protocol):
    """Loads the meshes that the scene lacks."""

    def want(self) -> None:
        """Load them."""
        ...

    def trouble_of(self, uri: str) -> str:
        """Why one cannot be shown, in a sentence."""
        ...


class DrawingRoom:
    """Steps every display that is shown and applies what it draws."""

    def __init__(
        self, robot: ShownRobot, meshes: Meshes, source: TopicSource, plugins: Plugins
    ) -> None:
        self._plugins = plugins
        self._robot, self._scene, self._meshes, self._source = robot, robot.scene, meshes, source
        self._epoch = source.epoch
        self.frames = SceneFrames(robot, source)
        self._running: dict[str, RunningDisplay] = {}
        self._names: dict[str, str] = {}
        self._faults: dict[str, str] = {}
        self._seen: frozenset[str] = frozenset()
        self._followed = FollowedFrames(robot.scene.live)
        self._held: set[str] | None = None
        """Displays whose news are not drawn yet, while drawing is paused; None: it is not."""
        self._let_through: set[str] = set()
        """Displays that are drawn once nevertheless."""
        self._robot_at: Pose = STILL
        self._robot_trouble = ""

    def open(self, spec: DisplaySpec, *, is_kept: bool = False) -> None:
        """Start a display.

        Args:
            spec: Its settings.
            is_kept: Whether it was there before: then one whose kind is not here keeps its place.

        Raises:
            DisplayError: There is no such kind.
        """
        types = shared_types()
        self._running[spec.id] = RunningDisplay(spec, self._made(spec, types, is_kept=is_kept))

    def _made(self, spec: DisplaySpec, types: TypeLibrary, *, is_kept: bool) -> Display:
        """Return the display of a spec; for one of an `.rviz` file that is not here, why not."""
        if spec.entry and "/" in spec.kind and not spec.kind.startswith(PREFIX):
            return MissingDisplay(types, partial(_unsupported, spec.kind))
        try:
            return self._plugins.of_kind(spec.kind)(types)
        except DisplayError:
            if not is_kept:
                raise
            return MissingDisplay(types, partial(self._not_here, spec.kind))

    def _not_here(self, kind: str) -> Status:
        sentence = f"{self._plugins.why_not(kind)} Its settings are kept."
        return Status("error", "not_here", sentence)

    def get(self, display: str) -> RunningDisplay:
        """Return the one of an id.

        Raises:
            CommandError: There is none any more.
        """
        if found := self._running.get(display):
            return found
        raise CommandError("This display is not there any more: choose another.")

    def close(self, display: str) -> RunningDisplay | None:
        """Remove a display from the scene and return it, to be closed by the caller."""
        self._scene.live.drop(display)
        self._faults.pop(display, None)
        self._let_through.discard(display)
        if self._held is not None:
            self._held.discard(display)
        return self._running.pop(display, None)

    @property
    def running(self) -> Mapping[str, RunningDisplay]:
        """All displays at work, by id."""
        return self._running

    def displays(self) -> dict[str, Display]:
        """Return all displays by id."""
        return {name: running.display for name, running in self._running.items()}

    async def subscribe(self, shown: Collection[str]) -> None:
        """Subscribe to TF and to what is shown wants, and to nothing else."""
        is_new = self.frames.subscribe()
        for display, running in self._running.items():
            if display not in shown:
                running.unsubscribe()
            elif running.subscribe(self._source):
                is_new = True
        if is_new:
            await asyncio.to_thread(self._source.fit_all)
        self.frames.drop_gone()
        await asyncio.to_thread(self._find_instead)

    def _find_instead(self) -> None:
        topics = TopicsNow(self._source)
        for running in tuple(self._running.values()):
            running.find_instead(topics)

    def unsubscribe(self) -> None:
        """Receive nothing."""
        self.frames.unsubscribe()
        for running in self._running.values():
            running.unsubscribe()

    def close_all(self) -> None:
        """Receive nothing any more."""
        self.frames.close()
        for running in self._running.values():
            running.close()

    @property
    def is_paused(self) -> bool:
        """Whether drawing is paused."""
        return self._held is not None

    def pause(self, *, paused: bool) -> None:
        """Leave the scene as it is, or draw what came meanwhile.

        As in RViz all is received and placed while it is paused, so that nothing of it is missing
        afterwards.
        """
        if paused and self._held is None:
            self._held = set()
        elif not paused and self._held is not None:
            held, self._held = self._held, None
            self._let_through.clear()
            for display in held:
                running = self._running[display]
                self._apply(display, running, running.placing.shown)

    def draw_once(self, displays: Iterable[str]) -> None:
        """Draw these although drawing is paused: somebody changed how they look."""
        if self._held is not None:
            self._let_through.update(displays)

    def reset(self) -> None:
        """Forget all messages and transforms; all is subscribed again with the next check."""
        self.frames.unsubscribe()
        self._faults.clear()
        for running in self._running.values():
            running.begin_anew()

    def renew(self) -> None:
        """The fixed frame is another: everything is placed again, also while drawing is paused."""
        for running in self._running.values():
            running.placing.renew()
        if self._held is not None:
            self.draw_once(self._running)
            self._place_robot()

    def follow(self, frame: str, now_ns: int, visitor: Visitor) -> str:
        """Keep a frame in the scene for a while; return why it cannot be, or an empty text."""
        return self._followed.ask(frame, now_ns, visitor) or self.frames.trouble_of(frame)

    def step(self, displays: DisplayList, now_ns: int, wall_ns: int | None = None) -> None:
        """Draw what came since the last step; nothing that came by another connection stays.

        Args:
            displays: Their settings.
            now_ns: The time that is shown, since the Unix epoch.
            wall_ns: Of this machine, by which waiting for transforms ends; None: the same.
        """
        wall_ns = now_ns if wall_ns is None else wall_ns
        self.frames.step()
        if self._epoch != self._source.epoch:
            self._epoch = self._source.epoch
            for running in self._running.values():
                running.begin_epoch()
        shown = self._shown_of(displays)
        self._show_frames(running.display for running in shown.values())
        names = self._names_of(displays)
        for display, running in shown.items():
            running.display.stand(self._robot)
            running.display.beside(names, display)
        if self._held is None:
            self._place_robot()
            self._followed.step(self.frames.lookup, wall_ns)
        for display, running in shown.items():
            self._draw(display, running, (now_ns, wall_ns), _AT_ONCE_S / len(shown))
        self._scene.live.draw_waiting()

    def _names_of(self, displays: DisplayList) -> dict[str, str]:
        """Return the names by id; the same object as long as they are the same."""
        names = {one.id: one.name for one in displays}
        if names != self._names:
            self._names = names
        return self._names

    def view(self, spec: DisplaySpec) -> DisplayView:
        """Return one display and its settings."""
        running = self._running[spec.id]
        fit = _fit(running)
        return DisplayView(
            id=spec.id,
            kind=spec.kind,
            icon=running.display.ICON,
            name=spec.name,
            group=spec.group,
            enabled=spec.enabled,
            topic=spec.topic,
            reliable=fit.reliable,
            latched=fit.latched,
            depth=fit.depth,
            wished=_wished(spec.listening),
            values=dict(running.display.values),
            more=_more_properties(running.display),
        )

    def states(self, displays: DisplayList, now_ns: int) -> DisplayStates:
        """Return the states of all displays."""
        return DisplayStates(
            states=tuple(self._state(one, displays, now_ns) for one in displays),
            fixed_frame=self.frames.fixed_state,
            fixed_frame_trouble=self._robot_trouble,
        )

    def _state(self, spec: DisplaySpec, displays: DisplayList, now_ns: int) -> DisplayState:
        running = self._running[spec.id]
        age_s = running.age_s(now_ns)
        more = self._of_meshes(spec.id)
        facts = running.facts(now_ns, shown=displays.is_shown(spec), more=more)
        frame, hidden_by = self.frames.offered_for(facts.frame), displays.hidden_by(spec)
        remarks = remarks_on(replace(facts, frame=frame, hidden_by=hidden_by))
        if fault := self._faults.get(spec.id):
            remarks = (Remark(level="error", reason="too_much", sentence=fault), *remarks)
        return DisplayState(
            id=spec.id,
            rate_hz=round(running.rate_hz(now_ns), 1),
            age_s=None if age_s is None else round(age_s),
            received=running.received,
            lost=running.lost,
            remarks=remarks,
        )

    def _of_meshes(self, display: str) -> tuple[Status, ...]:
        """Return a status for meshes that cannot be shown; wire boxes are in their places."""
        failed = self._scene.live.failed_meshes(display)
        if not failed:
            return ()
        sentence = self._meshes.trouble_of(failed[0])
        if len(failed) > 1:
            sentence = f"{len(failed)} meshes cannot be shown. The first: {sentence}"
        return (Status("warn", "no_mesh", sentence[:_SENTENCE_MAX]),)

    def _shown_of(self, displays: DisplayList) -> dict[str, RunningDisplay]:
        """Return the displays switched on; for those that are not, forget what was received."""
        shown = {one.id: self._running[one.id] for one in displays if displays.is_shown(one)}
        jumped = self.frames.has_jumped()
        for display, running in self._running.items():
            if jumped or (display in self._seen and display not in shown):
                running.reset()
        self._seen = frozenset(shown)
        return shown

    def _draw(
        self, display: str, running: RunningDisplay, now_ns: tuple[int, int], at_once_s: float
    ) -> None:
        shown = running.step(self.frames.lookup, *now_ns, at_once_s)
        if shown is None:
            return
        if self._held is None or display in self._let_through:
            self._let_through.discard(display)
            self._apply(display, running, shown)
        else:
            self._held.add(display)

    def _apply(self, display: str, running: RunningDisplay, shown: Shown) -> None:
        try:
            if shown.drawing is running.drawn:
                self._scene.live.place(display, shown.poses)
            else:
                self._scene.live.apply(display, shown.drawing, shown.poses)
            running.drawn = shown.drawing
            self._faults.pop(display, None)
        except SceneError as error:
            self._faults[display] = str(error)
        if self._scene.live.missing_meshes():
            self._meshes.want()

    def _show_frames(self, displays: Iterable[Display]) -> None:
        """Hand all frames to those that want them."""
        wanting = [one for one in displays if one.wants_frames]
        if wanting:
            frames = self.frames.now()
            for display in wanting:
                display.see(frames)

    def _place_robot(self) -> None:
        pose, self._robot_trouble = self.frames.robot_pose()
        if pose is not None and pose != self._robot_at:
            self._robot_at = pose
            self._scene.place_robot(*pose)


def _fit(running: RunningDisplay) -> Fit | TopicRole:
    """Return how the main topic is subscribed; before it is, how it would be."""
    return running.fit or next(iter(running.display.roles()), _NO_TOPIC)


def _wished(listening: Listening) -> ListeningView:
    return ListeningView(
        reliable=listening.reliable, latched=listening.latched, depth=listening.depth
    )


def _more_properties(display: Display) -> tuple[PropertyView, ...]:
    own = frozenset(display.PROPERTIES)
    more = (one for one in display.properties() if one not in own)
    return tuple(map(property_view, islice(more, _MORE_MAX)))


def _unsupported(class_name: str) -> Status:
    """Return what is said of a display of an `.rviz` file whose class the studio has not."""
    sentence = (
        f"The studio has no display {class_name[:80]}: it is kept, and written back as it is."
    )
    return Status("error", "unsupported", sentence)
