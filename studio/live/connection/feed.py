"""RobotFeed: a document's robot on the wire: what goes out, and who moves its joints."""

from __future__ import annotations

import asyncio
import logging
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal, Protocol

from studio.errors import CommandError, StudioError
from studio.live.connection.sending import RobotSending
from studio.packages.received_texts import keep_description
from studio.protocol.commands import Commands, Scope
from studio.protocol.connection import PublishJoints, PublishRobot, SetJointSource, WireFeed
from studio.protocol.listeners import LastSent

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, Callable, Iterable, Mapping
    from pathlib import Path

    from studio.description.values import Expansion
    from studio.live.connection.followed_joints import FollowedJoints
    from studio.live.connection.received_description import ReceivedDescription
    from studio.live.connection.ros_connection import RosConnection
    from studio.live.connection.sending import SentRobot
    from studio.live.topics.source import TopicSource
    from studio.protocol.connection import JointSource
    from studio.protocol.listeners import Audience

TICK_S: Final = 1 / 60
_SEND_EVERY_S: Final = 0.5
_TOPICS: Final = {"joint_states": "/joint_states", "tf": "/tf"}

_log = logging.getLogger(__name__)


class MovesJoints(Protocol):
    """The joints of a document, for a source that moves them."""

    def animate(self, *, running: bool) -> None:
        """Swing them, or stop."""
        ...

    def lead(self, leader: str) -> None:
        """Let `leader` move the joints from now on, by `follow`; an empty name ends that."""
        ...

    def follow(self, positions: Mapping[str, float]) -> None:
        """Move the joints to the positions of the leader, rad or m by name."""
        ...


@dataclass(slots=True)
class _Described:
    """The source of the description, and what was wrong with the last one received."""

    description: ReceivedDescription
    data_folder: Path
    trouble: str = ""


class RobotFeed:
    """Carries out the commands that connect one document's robot with ROS.

    Args:
        model: The document's robot.
        motion: Moves its joints.
        expansion: Gives the last good run; None before the first.
        wire: The connection.
        source: The topics that the document shows.
        audience: Is sent the state of the feed when it changes.
    """

    def __init__(
        self,
        model: SentRobot,
        motion: MovesJoints,
        expansion: Callable[[], Expansion | None],
        wire: RosConnection,
        source: TopicSource,
        audience: Audience,
    ) -> None:
        self._model, self._motion, self._wire, self._topics = model, motion, wire, source
        self._sending = RobotSending(model, expansion)
        self._following: FollowedJoints | None = None
        self._source: Literal["sliders", "joint_states", "tf"] = "sliders"
        self._described: _Described | None = None
        self._sent = LastSent[WireFeed](audience)
        self._sent_s = 0.0
        self._ticking: asyncio.Task[None] | None = None
        self._turn = asyncio.Lock()
        """Held while the source or the publishing is switched."""
        self._closed = False
        self.is_held: Callable[[], bool] = lambda: False
        """Whether the robot stands still meanwhile, as while drawing is paused."""

    def events(self) -> Iterable[WireFeed]:
        """Yield the events for a new page."""
        yield self._state()

    async def choose(self, source: JointSource) -> None:
        """Choose the one source that moves the joints.

        Raises:
            StudioError: There is no connection.
        """
        async with self._switching():
            if source == "joint_states" or source == "tf":  # noqa: PLR1714 - it narrows the type
                await self._follow(source)
            else:
                await self._stop_following()
                self._motion.animate(running=source == "animation")

    async def publish_robot(self, *, running: bool) -> None:
        """Publish the description and TF, or stop; errors as for `choose`."""
        async with self._switching():
            if running:
                self._demand_other_description()
                await self._sending.start_robot(await self._wire.link())
            else:
                await self._sending.stop_robot()

    async def publish_joints(self, *, running: bool) -> None:
        """Publish the joints' positions, or stop; errors as for `choose`."""
        async with self._switching():
            if running:
                await self._sending.start_joints(await self._wire.link())
            else:
                await self._sending.stop_joints()

    async def describe(self, description: ReceivedDescription, data_folder: Path) -> None:
        """Let the description come from the wire: what comes again is written into the file."""
        async with self._switching():
            await self._sending.stop_robot()  # it would be its own echo
            before, self._described = self._described, _Described(description, data_folder)
            if before is not None:
                before.description.close()

    async def let_go(self) -> None:
        """Switch everything off that uses the connection, which is about to end."""
        async with self._turn:
            following = None if self._topics.is_live else self._following_from
            await self._end()
            if following is not None:
                await self._follow(following)
                self._go_on()
            self._send()

    @property
    def source(self) -> JointSource:
        """What moves the joints."""
        return self._source

    def take(self) -> None:
        """Move the joints to what came, before the next tick does."""
        self._take()

    @property
    def _following_from(self) -> Literal["joint_states", "tf"] | None:
        return None if self._source == "sliders" else self._source

    async def close(self) -> None:
        """Stop sending and receiving; what is being started ends by itself."""
        self._closed = True
        await self._end()

    async def _end(self) -> None:
        if self._ticking is not None:
            self._ticking.cancel()
            await asyncio.gather(self._ticking, return_exceptions=True)
        await self._sending.stop_robot()
        await self._sending.stop_joints()
        await self._stop_following()
        described, self._described = self._described, None
        if described is not None:
            described.description.close()

    @asynccontextmanager
    async def _switching(self) -> AsyncGenerator[None]:
        """Switch something; a document that was closed meanwhile keeps nothing on."""
        async with self._turn:
            yield
            if self._closed:
                await self._end()
            else:
                self._go_on()

    async def _follow(self, source: Literal["joint_states", "tf"]) -> None:
        from studio.live.connection.followed_joints import FollowedJoints  # noqa: PLC0415 - takes its time

        if self._topics.is_live:
            await self._wire.link()
        await self._stop_following()
        model = self._model
        await self._sending.pause_joints(paused=source == "joint_states")  # no echo
        self._following = FollowedJoints(
            self._topics, model.robot, model.kinematics, from_tf=source == "tf"
        )
        self._source = source
        self._motion.lead(_TOPICS[source])

    async def _stop_following(self) -> None:
        self._source = "sliders"
        self._motion.lead("")
        self._sending.measured(0)
        following, self._following = self._following, None
        if following is not None:
            following.close()
        await self._sending.pause_joints(paused=False)

    def _demand_other_description(self) -> None:
        """Refuse to publish a description that was itself received from ROS.

        Raises:
            CommandError: The description was received.
        """
        if self._described is not None:
            raise CommandError(
                f"This robot comes from {self._described.description.source}, so another node "
                "publishes it: save it as a file of your own to publish it from here."
            )

    def _go_on(self) -> None:
        """Tick while anything is on; a tick that finds nothing is the last one."""
        self._send()
        if self._is_on and (self._ticking is None or self._ticking.done()):
            self._ticking = asyncio.create_task(self._tick())

    @property
    def _is_on(self) -> bool:
        sends = self._sending.sends_robot or self._sending.sends_joints
        return sends or self._following is not None or self._described is not None

    async def _tick(self) -> None:
        loop = asyncio.get_running_loop()
        while self._is_on:
            began_s = loop.time()
            try:
                self._take()
                await self._take_description()
                await self._sending.step(began_s)
            except Exception:  # noqa: BLE001 - one robot that fails must not end the rest
                _log.exception("A tick of the wire failed.")
            if began_s - self._sent_s >= _SEND_EVERY_S:
                self._sent_s = began_s
                self._send()
            await asyncio.sleep(max(0.0, began_s + TICK_S - loop.time()))

    def _take(self) -> None:
        """Move the joints to the newest positions received."""
        following, model = self._following, self._model
        if following is None:
            return
        following.fit(model.robot, model.kinematics)
        if self.is_held():
            return  # the newest positions are taken when it goes on
        if positions := following.collect():
            self._motion.follow(positions)
            self._sending.measured(following.stamp_ns)

    async def _take_description(self) -> None:
        """Write what came into the file, which is watched as every file of a document is."""
        described = self._described
        text = described.description.newest() if described else None
        if described is None or text is None:
            return
        source = described.description.source
        try:
            await asyncio.to_thread(keep_description, described.data_folder, source, text)
            described.trouble = ""
        except StudioError as error:
            described.trouble = str(error)

    def _send(self) -> None:
        self._sent.send(self._state())

    def _state(self) -> WireFeed:
        following = self._following
        return WireFeed(
            source=self._source,
            source_state=following.state() if following else "",
            rate_hz=following.rate_hz() if following else 0,
            strangers=following.strangers() if following else (),
            publishes_robot=self._sending.sends_robot,
            publishes_joints=self._sending.sends_joints,
            joints_paused=self._sending.joints_paused,
            rivals=self._sending.rivals(),
            description_from=self._described.description.source if self._described else "",
            trouble=self._described.trouble if self._described else "",
        )


COMMANDS: Final = Commands[RobotFeed](Scope.ROS)
COMMANDS.controller(SetJointSource, lambda feed, c, _: feed.choose(c.source))
COMMANDS.controller(PublishRobot, lambda feed, c, _: feed.publish_robot(running=c.running))
COMMANDS.controller(PublishJoints, lambda feed, c, _: feed.publish_joints(running=c.running))
