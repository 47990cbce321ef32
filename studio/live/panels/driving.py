"""Robots driven by hand from pages; each stops once its page is silent."""

from __future__ import annotations

import asyncio
import time
from typing import TYPE_CHECKING, Any, Final

from studio.errors import CommandError
from studio.live.panels.operations import outcome_of
from studio.protocol.commands import Commands, Limits, Scope
from studio.protocol.publishing import Drive

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from studio.live.connection.link import WireLink
    from studio.live.connection.ros_connection import RosConnection
    from studio.protocol.listeners import Listener

_SILENCE_S: Final = 0.5
_DRIVEN_MAX: Final = 20
_STAYS_STOPPED_S: Final = 1.0
"""After a stop: a key that is held sends twenty speeds in it."""
_HALT_PATIENCE_S: Final = 0.3
"""A publisher that is made for a stop is known to the subscribers after a few milliseconds."""
_LOOK_EVERY_S: Final = 0.005
_ROUTER_PATIENCE_S: Final = 120.0
"""When a router goes away during a drive: the robot may move on until it is back."""


SPEED_MAX: Final = 100.0
"""m/s and rad/s: nothing that is driven by hand is faster."""
_TWIST: Final = "geometry_msgs/msg/Twist"
_STAMPED: Final = "geometry_msgs/msg/TwistStamped"


class VelocityPublisher:
    """Publishes velocities, and zero before it is closed.

    Made, used and closed in threads, by one at a time.

    Raises:
        StudioError: The topic cannot be named so, or its type is not known.
    """

    def __init__(self, link: WireLink, topic: str, stamped: bool) -> None:  # noqa: FBT001
        from studio.live.panels.requests import wire_name  # noqa: PLC0415 - imports zenoh
        from studio.ros.type_lookup import known_message  # noqa: PLC0415 - imports zenoh
        from studio.ros.types.convert import from_dict  # noqa: PLC0415 - takes its time

        name = wire_name(topic)
        why: list[str] = []
        self.stamped = stamped
        self._kind = known_message(link.node, name, _STAMPED if stamped else _TWIST, why.append)
        self._link, self._from_dict = link, from_dict
        self._publisher = link.node.create_publisher(self._kind, name, 10)

    @property
    def is_reached(self) -> bool:
        """Whether the router is there."""
        return self._link.is_connected

    @property
    def has_subscriber(self) -> bool:
        """Whether the router is there, and somebody subscribes."""
        return self.is_reached and self._publisher.get_subscription_count() > 0

    def wait_for_subscriber(self, timeout_s: float) -> None:
        """Return once somebody subscribes, or the time is over."""
        end_s = time.monotonic() + timeout_s
        while not self.has_subscriber and time.monotonic() < end_s:
            time.sleep(_LOOK_EVERY_S)

    def steer(self, x_m_s: float, y_m_s: float, yaw_rad_s: float) -> None:
        """Publish a velocity, each part of it no faster than `SPEED_MAX`."""
        x, y, yaw = (max(-SPEED_MAX, min(part, SPEED_MAX)) for part in (x_m_s, y_m_s, yaw_rad_s))
        twist: dict[str, Any] = {"linear": {"x": x, "y": y}, "angular": {"z": yaw}}
        values = {"header": "auto", "twist": twist} if self.stamped else twist
        self._publisher.publish(self._from_dict(self._kind, values, now_ns=time.time_ns()))

    def close(self) -> None:
        """Publish zero velocity, then nothing any more."""
        try:
            self.steer(0.0, 0.0, 0.0)
        finally:
            self._link.node.destroy_publisher(self._publisher)


class _Driver:
    """A page that drives on one topic."""

    def __init__(self, listener: Listener) -> None:
        self.listener = listener
        self.turn = asyncio.Lock()
        """Speeds go out in the order in which they came, and none after the end."""
        self.publisher: VelocityPublisher | None = None
        self.patience: asyncio.TimerHandle | None = None
        self.is_over = False


class Driving:
    """Lets one page drive on each topic, and sends a stop when it ends.

    Used on the event loop only.
    """

    def __init__(self, wire: RosConnection) -> None:
        self._wire = wire
        self._drivers: dict[str, _Driver] = {}
        self._driven: dict[str, bool] = {}
        """Topics on which somebody drove with this connection, and whether it was stamped."""
        self._all_stopped_until_s = 0.0
        self._stopped_until_s: dict[str, float] = {}
        """By topic, where keys are held on: each try puts it off."""
        self._ends: set[asyncio.Task[object]] = set()
        self._leaves = False

    async def drive(self, command: Drive, listener: Listener) -> None:
        """Send a speed on its topic, and wait for the next one.

        Raises:
            StudioError: Another page drives there, or it cannot be published.
        """
        topic = command.topic if command.topic.startswith("/") else f"/{command.topic}"
        self._check_stopped(topic, command)
        driver = self._driver(topic, listener)
        self._wait_for_more(topic, driver)
        async with driver.turn:
            await self._send(topic, driver, command)

    def detach(self, listener: Listener) -> None:
        """Remove a page, and stop all that it drove."""
        for topic, driver in tuple(self._drivers.items()):
            if driver.listener is listener:
                self._end(topic, driver)

    def release(self, may_go_on: Callable[[str], bool]) -> None:
        """Stop all that persons drive who have no control any more."""
        for topic, driver in tuple(self._drivers.items()):
            if not may_go_on(driver.listener.person):
                self._end(topic, driver)

    async def stop(self, also: Mapping[str, bool]) -> None:
        """Stop all, and publish zero wherever somebody drove since the connection stands.

        Args:
            also: Other topics of velocities, and whether their messages are stamped.
        """
        self._stopped_until_s.clear()
        self._all_stopped_until_s = time.monotonic() + _STAYS_STOPPED_S
        for topic, driver in tuple(self._drivers.items()):
            self._end(topic, driver)
        await asyncio.gather(*self._ends)
        if (link := self._wire.current) is not None:
            halted = (self._driven | dict(also)).items()
            await asyncio.gather(
                *(outcome_of(asyncio.to_thread(_halt, link, *one)) for one in halted)
            )

    async def let_go(self) -> None:
        """Stop all: the connection is about to end."""
        for topic, driver in tuple(self._drivers.items()):
            self._end(topic, driver)
        self._leaves = True
        await asyncio.gather(*self._ends)
        self._leaves = False
        self._driven.clear()

    def _driver(self, topic: str, listener: Listener) -> _Driver:
        driver = self._drivers.get(topic)
        if driver is not None and driver.listener is not listener:
            raise CommandError(f"Somebody else drives on {topic}: wait until they let go of it.")
        if driver is None:
            if len(self._drivers) >= _DRIVEN_MAX:
                raise CommandError(f"{_DRIVEN_MAX} robots are driven already: let go of one.")
            driver = self._drivers[topic] = _Driver(listener)
        return driver

    def _wait_for_more(self, topic: str, driver: _Driver) -> None:
        if driver.patience is not None:
            driver.patience.cancel()
        loop = asyncio.get_running_loop()
        driver.patience = loop.call_later(_SILENCE_S, self._end, topic, driver)

    async def _send(self, topic: str, driver: _Driver, command: Drive) -> None:
        publisher = driver.publisher
        if publisher is not None and publisher.stamped != command.stamped:
            driver.publisher = None
            await asyncio.to_thread(publisher.close)
        if driver.publisher is None and not driver.is_over:
            link = await self._wire.link()
            driver.publisher = await asyncio.to_thread(
                VelocityPublisher, link, command.topic, command.stamped
            )
        # A command sent before the end that waited until after it must not move anything.
        if driver.publisher is not None and not driver.is_over:
            await asyncio.to_thread(driver.publisher.steer, command.x, command.y, command.yaw)
            self._note(topic, stamped=command.stamped)

    def _note(self, topic: str, *, stamped: bool) -> None:
        """Note that somebody drove there; the topics of long ago are forgotten first."""
        self._driven.pop(topic, None)
        self._driven[topic] = stamped
        while len(self._driven) > _DRIVEN_MAX:
            del self._driven[next(iter(self._driven))]

    def _check_stopped(self, topic: str, command: Drive) -> None:
        """Pass, unless the robot was stopped and nobody has let go of the keys since.

        Raises:
            CommandError: It was stopped a moment ago.
        """
        until_s = self._stopped_until_s.get(topic, self._all_stopped_until_s)
        if time.monotonic() >= until_s:
            return
        if command.x == command.y == command.yaw == 0.0:
            self._stopped_until_s[topic] = 0.0
            return
        self._stopped_until_s[topic] = time.monotonic() + _STAYS_STOPPED_S
        raise CommandError("The robot was stopped: let go of the controls first.")

    def _end(self, topic: str, driver: _Driver) -> None:
        driver.is_over = True
        if driver.patience is not None:
            driver.patience.cancel()
        if self._drivers.get(topic) is driver:
            del self._drivers[topic]
            end = asyncio.create_task(outcome_of(self._stand_still(driver)))
            self._ends.add(end)
            end.add_done_callback(self._ends.discard)

    async def _stand_still(self, driver: _Driver) -> None:
        async with driver.turn:
            if driver.publisher is not None:
                await self._router_is_back(driver.publisher)
                await asyncio.to_thread(driver.publisher.close)

    async def _router_is_back(self, publisher: VelocityPublisher) -> None:
        """Wait for the router, if the stop could not be sent and the studio stays."""
        from studio.live.panels.requests import came_true  # noqa: PLC0415 - imports zenoh

        if not publisher.is_reached:
            await came_true(lambda: self._leaves or publisher.has_subscriber, _ROUTER_PATIENCE_S)


def _halt(link: WireLink, topic: str, stamped: bool) -> None:  # noqa: FBT001 - see `stop`
    """Publish zero once, to all who subscribe by then."""
    publisher = VelocityPublisher(link, topic, stamped)
    try:
        publisher.wait_for_subscriber(_HALT_PATIENCE_S)
    finally:
        publisher.close()


COMMANDS: Final = Commands[Driving](Scope.ROS)
COMMANDS.controller(
    Drive,
    lambda driving, c, who: driving.drive(c, who),
    needs_router=True,
    limits=Limits(bytes_max=1_000, per_second=200),
)
