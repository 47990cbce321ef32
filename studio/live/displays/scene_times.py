"""SceneTimes: pause, reset and the time of a document's 3D view, for all who look at it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, Protocol

from studio.live.displays.scene_clock import SceneClock
from studio.protocol.commands import Commands, Scope
from studio.protocol.scene_time import GetSceneTime, PauseScene, ResetScene, SceneTime

if TYPE_CHECKING:
    from collections.abc import Callable


class Frames(Protocol):
    """Where /clock is heard."""

    @property
    def clock_ns(self) -> int | None:
        """The newest time of /clock; None: nobody publishes it."""
        ...

    @property
    def recorded_ns(self) -> int | None:
        """The time of the recording that is shown; None: it is the live system."""
        ...


class Room(Protocol):
    """What is paused and reset."""

    @property
    def frames(self) -> Frames:
        """Its frames."""
        ...

    @property
    def is_paused(self) -> bool:
        """Whether drawing is paused."""
        ...

    def pause(self, *, paused: bool) -> None:
        """Leave the scene as it is, or go on."""
        ...

    def reset(self) -> None:
        """Forget all messages and transforms."""
        ...


class SceneTimes:
    """Carries out the commands about time.

    Args:
        room: The room, made when it is first needed.
        look: Has /clock be subscribed for a while.
        changed: Has pages and the next tick take notice.
    """

    def __init__(
        self, room: Callable[[], Room], look: Callable[[], object], changed: Callable[[], object]
    ) -> None:
        self._room, self._look, self._changed = room, look, changed
        self._clock = SceneClock()

    def now(self, command: GetSceneTime) -> SceneTime:
        """Return the time of the view; subscribes to /clock for a while."""
        self._look()
        room = self._room()
        frames = room.frames
        return self._clock.told(
            command.request, frames.clock_ns, paused=room.is_paused, now_ns=frames.recorded_ns
        )

    def pause(self, command: PauseScene) -> None:
        """Pause drawing, or go on with the newest."""
        room = self._room()
        room.pause(paused=command.paused)
        frames = room.frames
        clock_ns = frames.recorded_ns if frames.clock_ns is None else frames.clock_ns
        self._clock.pause(clock_ns, paused=command.paused)
        self._changed()

    def reset(self, _: ResetScene) -> None:
        """Forget all that was received, and receive again what is latched."""
        self._room().reset()
        self._clock.reset()
        self._changed()


COMMANDS: Final = Commands[SceneTimes](Scope.DOCUMENT)
COMMANDS.controller(PauseScene, lambda times, c, _: times.pause(c))
COMMANDS.controller(ResetScene, lambda times, c, _: times.reset(c))
COMMANDS.viewer(GetSceneTime, lambda times, c, _: times.now(c))
