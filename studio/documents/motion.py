"""What moves the joints of a document: sliders, a glide to a pose, a swing, or a ROS topic."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final

from studio.errors import CommandError
from studio.protocol.commands import Commands, Scope
from studio.protocol.robot import AnimateJoints, RandomizeJoints, SetJoints, ZeroJoints

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from studio.documents.model import Model
    from studio.documents.robot_view import RobotView

TICK_S: Final = 1 / 60


class Animation:
    """Calls `step(time_s)` once per tick between `start` and `stop`; late ticks are skipped."""

    def __init__(self, step: Callable[[float], None]) -> None:
        self._step = step
        self._task: asyncio.Task[None] | None = None

    @property
    def running(self) -> bool:
        """Whether the joints swing now."""
        return self._task is not None and not self._task.done()

    def start(self) -> None:
        """Begin, unless it runs."""
        if not self.running:
            self._task = asyncio.create_task(self._run())

    def stop(self) -> None:
        """End where the joints are."""
        if self._task:
            self._task.cancel()
        self._task = None

    async def _run(self) -> None:
        loop = asyncio.get_running_loop()
        began_s = next_s = loop.time()
        while True:
            self._step(loop.time() - began_s)
            next_s = max(next_s + TICK_S, loop.time())
            await asyncio.sleep(next_s - loop.time())


class Glide:
    """Calls `move` with positions between two poses, once per tick, and at last with the second."""

    def __init__(self, move: Callable[[Mapping[str, float]], None]) -> None:
        self._move = move
        self._animation = Animation(self._step)
        self._from: dict[str, float] = {}
        self._to: dict[str, float] = {}
        self._duration_s = 0.0

    @property
    def running(self) -> bool:
        """Whether the joints are moving to a position."""
        return self._animation.running

    def start(
        self, begin: Mapping[str, float], end: Mapping[str, float], duration_s: float
    ) -> None:
        """Begin; joints that are not in `begin` are not moved. `duration_s` 0 moves at once."""
        self.stop()
        self._from = {name: begin[name] for name in end if name in begin}
        self._to, self._duration_s = dict(end), duration_s
        if duration_s > 0:
            self._animation.start()
        else:
            self._step(0.0)

    def stop(self) -> None:
        """End where the joints are."""
        self._animation.stop()

    def _step(self, time_s: float) -> None:
        share = min(1.0, time_s / self._duration_s) if self._duration_s > 0 else 1.0
        eased = share * share * (3 - 2 * share)
        if share >= 1:
            self.stop()
        self._move(
            {
                name: self._to[name] if share >= 1 else begin + eased * (self._to[name] - begin)
                for name, begin in self._from.items()
            }
        )


class Motion:
    """Moves the joints of a robot, and sends their positions to the audience of its view."""

    def __init__(self, model: Model, view: RobotView) -> None:
        self._model, self._view = model, view
        self._animation = Animation(self._swing)
        self._glide = Glide(self._move)
        self._swing_start = model.joints.values
        self.leader = ""
        """Keyword of what else moves the joints; while it does, no page may. Empty: nothing."""

    @property
    def swinging(self) -> bool:
        """Whether the joints swing now."""
        return self._animation.running

    def set(self, positions: Mapping[str, float]) -> None:
        """Move joints, rad or m by name; ends a swing.

        Raises:
            CommandError: Something else moves them; so for all that follow.
        """
        self._begin()
        self._move(positions)

    def glide(self, positions: Mapping[str, float], duration_s: float) -> None:
        """Move joints, rad or m by name, within a time; ends a swing."""
        self._begin()
        self._glide.start(self._model.joints.by_name(), positions, duration_s)

    def zero(self) -> None:
        """Move all joints to zero."""
        self._begin()
        self._model.joints.zero()
        self._show()

    def randomize(self) -> None:
        """Move all joints to random positions."""
        self._begin()
        self._model.joints.randomize()
        self._show()

    def animate(self, *, running: bool) -> None:
        """Swing the joints from where they are, or stop."""
        if running:
            self._check_leader()
        self._glide.stop()
        if running and not self.swinging:
            self._swing_start = self._model.joints.values
            self._animation.start()
        elif not running:
            self._animation.stop()
        self._send()

    def lead(self, leader: str) -> None:
        """Let `leader` move the joints from now on, by `follow`; an empty name ends that."""
        self._stop_swinging()
        self.leader = leader

    def follow(self, positions: Mapping[str, float]) -> None:
        """Move joints to the positions of the leader, rad or m by name."""
        self._model.joints.follow(positions)
        self._show()

    def close(self) -> None:
        """End a swing without an event."""
        self._glide.stop()
        self._animation.stop()

    def _swing(self, time_s: float) -> None:
        self._model.joints.swing(time_s, self._swing_start)
        self._show()

    def _move(self, positions: Mapping[str, float]) -> None:
        self._model.joints.set(positions)
        self._show()

    def _begin(self) -> None:
        self._check_leader()
        self._stop_swinging()

    def _check_leader(self) -> None:
        if self.leader:
            raise CommandError(
                f"The joints follow {self.leader}: choose the sliders as their source first."
            )

    def _stop_swinging(self) -> None:
        self._glide.stop()
        if self.swinging:
            self._animation.stop()
            self._send()

    def _show(self) -> None:
        self._model.pose()
        self._view.send_joints()

    def _send(self) -> None:
        self._view.animating = self.swinging
        self._view.send_positions()


COMMANDS: Final = Commands[Motion](Scope.DOCUMENT)
COMMANDS.controller(SetJoints, lambda motion, c, _: motion.set(c.positions))
COMMANDS.controller(ZeroJoints, lambda motion, _, __: motion.zero())
COMMANDS.controller(RandomizeJoints, lambda motion, _, __: motion.randomize())
COMMANDS.controller(AnimateJoints, lambda motion, c, _: motion.animate(running=c.running))
