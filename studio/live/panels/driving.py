"""DriveDesk: robots driven by hand from pages; each stands still once its driver is silent."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final

from studio.errors import CommandError
from studio.live.panels.running import outcome_of
from studio.protocol.commands import Commands, Scope
from studio.protocol.publishing import Drive

if TYPE_CHECKING:
    from studio.live.connection.desk import WireDesk
    from studio.live.panels.driving_work import Wheel
    from studio.protocol.listeners import Listener

_SILENCE_S: Final = 0.5
_DRIVEN_MAX: Final = 20
_ROUTER_PATIENCE_S: Final = 120.0
"""For a router that went away amid a drive: the robot behind it may move on until it is back."""


class _Driver:
    """One who drives on one topic."""

    def __init__(self, listener: Listener) -> None:
        self.listener = listener
        self.turn = asyncio.Lock()
        """Speeds go out in the order in which they came, and none after the end."""
        self.wheel: Wheel | None = None
        self.patience: asyncio.TimerHandle | None = None
        self.is_over = False


class DriveDesk:
    """Has at most one driver on each topic, and stops what nobody drives; all on the loop."""

    def __init__(self, wire: WireDesk) -> None:
        self._wire = wire
        self._drivers: dict[str, _Driver] = {}
        self._ends: set[asyncio.Task[object]] = set()
        self._leaves = False

    async def drive(self, command: Drive, listener: Listener) -> None:
        """Send a speed on its topic, and wait for the next one.

        Raises:
            StudioError: Somebody else drives there, or it cannot be published.
        """
        topic = command.topic if command.topic.startswith("/") else f"/{command.topic}"
        driver = self._driver(topic, listener)
        self._wait_for_more(topic, driver)
        async with driver.turn:
            await self._send(driver, command)

    def detach(self, listener: Listener) -> None:
        """A page is gone: all that it drove stands still."""
        for topic, driver in tuple(self._drivers.items()):
            if driver.listener is listener:
                self._end(topic, driver)

    async def let_go(self) -> None:
        """Have all stand still: the connection is about to end."""
        for topic, driver in tuple(self._drivers.items()):
            self._end(topic, driver)
        self._leaves = True
        await asyncio.gather(*self._ends)
        self._leaves = False

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

    async def _send(self, driver: _Driver, command: Drive) -> None:
        from studio.live.panels.driving_work import Wheel  # noqa: PLC0415 - imports zenoh

        wheel = driver.wheel
        if wheel is not None and wheel.stamped != command.stamped:
            driver.wheel = None
            await asyncio.to_thread(wheel.close)
        if driver.wheel is None and not driver.is_over:
            link = await self._wire.link()
            driver.wheel = await asyncio.to_thread(Wheel, link, command.topic, command.stamped)
        # What was told before the end, and waited until after it, moves nothing any more.
        if driver.wheel is not None and not driver.is_over:
            await asyncio.to_thread(driver.wheel.steer, command.x, command.y, command.yaw)

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
            if driver.wheel is not None:
                await self._router_is_back(driver.wheel)
                await asyncio.to_thread(driver.wheel.close)

    async def _router_is_back(self, wheel: Wheel) -> None:
        """Wait for who is to stand still, if nobody could hear it now and we are to stay."""
        from studio.live.panels.requests import came_true  # noqa: PLC0415 - imports zenoh

        if not wheel.is_reached:
            await came_true(lambda: self._leaves or wheel.is_heard, _ROUTER_PATIENCE_S)


COMMANDS: Final = Commands[DriveDesk](Scope.ROS)
COMMANDS.presenter(Drive, lambda one, c, who: one.drive(c, who), needs_router=True)
