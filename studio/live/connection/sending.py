"""RobotSending: publishes a document's robot and its joints, at a limited rate."""

from __future__ import annotations

import asyncio
import time
from functools import partial
from typing import TYPE_CHECKING, Final, Protocol

from studio.description.urdf import urdf_text
from studio.displays.posed_robot import PosedRobot
from studio.errors import StudioError

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.description.values import Expansion
    from studio.live.connection.link import WireLink
    from studio.live.connection.robot_publishers import JointsOut, RobotOut
    from studio.robot.assembly import Assembly
    from studio.robot.kinematics import Floats

MOVING_PERIOD_S: Final = 1 / 30
RESTING_PERIOD_S: Final = 1 / 16
"""Between two messages of joints at rest: more than 10 Hz."""
_PAUSE_SHARE: Final = 4
"""A period lasts at least this many times as long as publishing takes."""
_RIVALS_SHOWN: Final = 3
DESCRIPTION_PERIOD_S: Final = 0.5
"""Between two descriptions during a drag."""


class SentRobot(PosedRobot, Protocol):
    """A robot whose description and joints are published."""

    @property
    def assembly(self) -> Assembly:
        """The elements of its URDF, as written."""
        ...


class RobotSending:
    """Checks at each tick whether anything is due; messages are made and sent in a thread.

    Args:
        model: The robot.
        expansion: Gives the last good run; None before the first.
    """

    def __init__(self, model: SentRobot, expansion: Callable[[], Expansion | None]) -> None:
        self._model, self._expansion = model, expansion
        self._robot: RobotOut | None = None
        self._joints: JointsOut | None = None
        self._joints_link: WireLink | None = None
        """The connection on which joints are published; None: on none."""
        self._paused = False
        self._description: Expansion | None = None
        """The one published last."""
        self._description_s = -DESCRIPTION_PERIOD_S
        self._values: Floats | None = None
        """The positions published last."""
        self._values_s = -RESTING_PERIOD_S
        self._stamp_ns = self._sent_stamp_ns = 0
        """Stamps of the positions, from the joint states received; 0: the present time."""
        self._took_s = 0.0
        self._turn = asyncio.Lock()
        """Held while something is published, so that it is not closed meanwhile."""

    @property
    def sends_robot(self) -> bool:
        """Whether the description and TF go out."""
        return self._robot is not None

    @property
    def sends_joints(self) -> bool:
        """Whether the joints' positions go out."""
        return self._joints_link is not None

    @property
    def joints_paused(self) -> bool:
        """Whether they are to go out, and do not for now."""
        return self._paused and self.sends_joints

    def rivals(self) -> tuple[str, ...]:
        """Nodes of others that publish the same; the first ones."""
        found = [
            name for out in (self._robot, self._joints) if out is not None for name in out.rivals()
        ]
        return tuple(dict.fromkeys(found))[:_RIVALS_SHOWN]

    async def start_robot(self, link: WireLink) -> None:
        """Publish the description and TF from now on.

        Raises:
            StudioError: It cannot.
        """
        if self._robot is None:
            self._robot = await asyncio.to_thread(link.robot_out)
            self._description, self._values = None, None

    async def start_joints(self, link: WireLink) -> None:
        """Publish the joints' positions from now on; errors as for `start_robot`."""
        self._joints_link = link
        await self._fit_joints()

    def measured(self, stamp_ns: int) -> None:
        """Use `stamp_ns`, of a measured joint state, as the stamp of the positions; 0: the present.

        TF gets that stamp once: published again it would be refused as repeated data.
        """
        self._stamp_ns = stamp_ns

    async def stop_robot(self) -> None:
        """Stop publishing the description and TF."""
        async with self._turn:
            robot, self._robot = self._robot, None
        if robot is not None:
            await asyncio.to_thread(robot.close)

    async def stop_joints(self) -> None:
        """Stop publishing the joints' positions."""
        self._joints_link = None
        await self._fit_joints()

    async def pause_joints(self, *, paused: bool) -> None:
        """Pause publishing the joints' positions, or resume; errors as for `start_robot`.

        The node is gone meanwhile: others that would make room for it need not.
        """
        self._paused = paused
        await self._fit_joints()

    async def _fit_joints(self) -> None:
        link = None if self._paused else self._joints_link
        if link is not None and self._joints is None:
            try:
                self._joints = await asyncio.to_thread(link.joints_out)
            except StudioError:
                self._joints_link = None
                raise
            self._values = None
        elif link is None:
            async with self._turn:
                joints, self._joints = self._joints, None
            if joints is not None:
                await asyncio.to_thread(joints.close)

    async def step(self, now_s: float) -> None:
        """Publish what is due."""
        async with self._turn:
            await self._step(now_s)

    async def _step(self, now_s: float) -> None:
        robot = self._robot
        if robot is not None and self._is_description_due(now_s):
            await self._publish_description(robot, now_s)
        if self._are_positions_due(now_s):
            await self._publish_positions(now_s)

    def _is_description_due(self, now_s: float) -> bool:
        newest = self._expansion()
        due = now_s - self._description_s >= DESCRIPTION_PERIOD_S
        return due and newest is not None and newest is not self._description

    async def _publish_description(self, robot: RobotOut, now_s: float) -> None:
        model, expansion = self._model, self._expansion()
        assert expansion is not None
        self._description, self._description_s = expansion, now_s
        make = partial(urdf_text, model.assembly.parts(), expansion.root_attributes)
        shown, kinematics = model.robot, model.kinematics
        await asyncio.to_thread(lambda: robot.describe(make(), shown, kinematics))
        self._values = None  # the links may stand elsewhere

    def _are_positions_due(self, now_s: float) -> bool:
        if self._robot is None and self._joints is None:
            return False
        is_old = self._stamp_ns != 0 and self._stamp_ns == self._sent_stamp_ns
        if is_old and self._values is not None:
            return False
        moved = self._model.joints.values is not self._values
        period_s = MOVING_PERIOD_S if moved else RESTING_PERIOD_S
        return now_s - self._values_s >= max(period_s, _PAUSE_SHARE * self._took_s)

    async def _publish_positions(self, now_s: float) -> None:
        positions = self._model.joints
        self._values, self._values_s = positions.values, now_s
        stamp_ns = self._sent_stamp_ns = self._stamp_ns
        by_name = positions.by_name()
        robot, joints = self._robot, self._joints

        def publish() -> None:
            if robot is not None:
                robot.place(by_name, stamp_ns or None)
            if joints is not None:
                joints.publish(by_name)

        began_s = time.perf_counter()
        await asyncio.to_thread(publish)
        self._took_s = time.perf_counter() - began_s
