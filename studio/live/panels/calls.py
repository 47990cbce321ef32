"""Services that pages call, each with its timeout and its reply."""

from __future__ import annotations

import asyncio
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from studio.live.panels.operations import Operations, Outcome, RunningTasks
from studio.protocol.calls import Begun, Calls, CallService, CallView, CancelCall
from studio.protocol.commands import Commands, Scope

if TYPE_CHECKING:
    from studio.live.connection.ros_connection import RosConnection
    from studio.live.panels.requests import ServiceRequest

_KEPT: Final = 40
_RUNNING_MAX: Final = 30
_State: TypeAlias = Literal["calling", "answered", "failed", "cancelled"]


@dataclass
class Call:
    """A call, from the request to its reply."""

    operation: int
    name: str
    service_type: str
    text: str
    timeout_s: float
    state: _State = "calling"
    began_s: float = field(default_factory=lambda: time.time_ns() / 1e9)
    took_s: float = 0.0
    reply: str = ""
    trouble: str = ""

    @property
    def is_over(self) -> bool:
        """Whether it has its end."""
        return self.state != "calling"

    def view(self) -> CallView:
        """Return the call as the page receives it."""
        return CallView(**{name: getattr(self, name) for name in CallView.model_fields})


def _event_of(is_whole: bool, calls: tuple[Call, ...]) -> Calls:  # noqa: FBT001 - `Operations.event_of`
    return Calls(whole=is_whole, operations=tuple(one.view() for one in calls))


class ServiceCalls:
    """Begins and ends calls; `operations` has their state."""

    def __init__(self, wire: RosConnection) -> None:
        self._wire = wire
        self.operations: Operations[Call] = Operations(_event_of, kept=_KEPT, running=_RUNNING_MAX)
        self._running = RunningTasks()

    async def begin(self, command: CallService) -> Begun:
        """Call a service, and do not wait for its reply.

        Raises:
            StudioError: It cannot be asked.
        """
        from studio.live.panels.requests import ServiceRequest  # noqa: PLC0415 - imports zenoh

        number = self.operations.next_number()
        link = await self._wire.link()
        request = await asyncio.to_thread(ServiceRequest, link, command)
        call = Call(number, request.name, request.type_name, command.text, command.timeout_s)
        self.operations.add(call)
        self._running.start(
            number,
            request.answer(call.timeout_s),
            lambda outcome: self._finish(call, request, outcome),
        )
        return Begun(request=command.request, operation=number)

    def cancel(self, command: CancelCall) -> None:
        """Stop waiting for a reply; a call that is over stays as it is.

        Raises:
            CommandError: There is no such call.
        """
        self.operations.get(command.operation)
        self._running.cancel(command.operation)

    async def let_go(self) -> None:
        """End all: the connection is about to."""
        await self._running.end_all("The connection with ROS 2 was ended.")

    async def close(self) -> None:
        """End all that runs, and send no more events."""
        await self.let_go()
        await self.operations.close()

    async def _finish(self, call: Call, request: ServiceRequest, outcome: Outcome[str]) -> None:
        call.took_s = round(time.time_ns() / 1e9 - call.began_s, 4)
        call.state, call.trouble = _STATES[outcome.kind], outcome.trouble
        call.reply = outcome.value or ""
        self.operations.changed(call)
        await asyncio.to_thread(request.close)


_STATES: Final[dict[str, _State]] = {
    "done": "answered",
    "failed": "failed",
    "cancelled": "cancelled",
}

COMMANDS: Final = Commands[ServiceCalls](Scope.ROS)
COMMANDS.controller(CallService, lambda one, c, _: one.begin(c), needs_router=True)
COMMANDS.controller(CancelCall, lambda one, c, _: one.cancel(c))
