"""Goals that pages send: several at once, each with its feedback and its result."""

from __future__ import annotations

import asyncio
import time
from collections import deque
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

from studio.errors import CommandError
from studio.live.panels.operations import Begins, Operations, Outcome, RunningTasks, outcome_of
from studio.protocol.calls import Begun
from studio.protocol.commands import Commands, Scope
from studio.protocol.goals import CancelGoal, FeedbackView, Goals, GoalState, GoalView, SendGoal

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.live.connection.link import WireLink
    from studio.live.connection.ros_connection import RosConnection
    from studio.live.panels.goal_work import ActionClients, GoalRequest
    from studio.live.panels.logs import NodeLogs
    from studio.protocol.logs import LogLine

_KEPT: Final = 40
_RUNNING_MAX: Final = 30
_FEEDBACK_KEPT: Final = 50
_FEEDBACK_CHARACTERS: Final = 4_000
_CHECK_EVERY_S: Final = 0.2
"""Between two checks of the status of a goal without feedback."""
_LOG_PATIENCE_S: Final = 1.0
"""A server's log may arrive later than its answer."""
_CLOCKS_APART_S: Final = 1.0
_OVER: Final = frozenset({"succeeded", "canceled", "aborted", "rejected", "failed"})


@dataclass
class Goal:
    """A goal, from the request to its result."""

    operation: int
    name: str
    action_type: str
    text: str
    state: GoalState = "sending"
    began_s: float = field(default_factory=lambda: time.time_ns() / 1e9)
    took_s: float = 0.0
    goal_id: str = ""
    result: str = ""
    trouble: str = ""
    servers: tuple[str, ...] = ()
    server_said: LogLine | None = None
    log_from: int = 0
    """Number of the last line of the log before it was sent."""
    feedback_count: int = 0
    kept: deque[tuple[int, float, Any]] = field(
        default_factory=lambda: deque(maxlen=_FEEDBACK_KEPT)
    )
    sent: int = 0
    """Number of the last feedback sent to all who follow."""

    @property
    def is_over(self) -> bool:
        """Whether it has its end."""
        return self.state in _OVER

    def take_feedback(self, feedback: object) -> None:
        """Take in a feedback message."""
        self.feedback_count += 1
        self.kept.append((self.feedback_count, time.time_ns() / 1e9 - self.began_s, feedback))

    def view(self, *, is_whole: bool) -> GoalView:
        """Return the goal for the page: with all feedback kept, or with what is new."""
        from studio.ros.types.convert import to_json  # noqa: PLC0415 - takes its time

        kept = [one for one in tuple(self.kept) if is_whole or one[0] > self.sent]
        if not is_whole and kept:
            self.sent = kept[-1][0]
        views = tuple(
            FeedbackView(
                number=number, after_s=round(at_s, 3), values=to_json(one, _FEEDBACK_CHARACTERS)
            )
            for number, at_s, one in kept
        )
        own = {name: getattr(self, name) for name in GoalView.model_fields if name != "feedback"}
        return GoalView(**own, feedback=views)


def _event_of(is_whole: bool, goals: tuple[Goal, ...]) -> Goals:  # noqa: FBT001 - `Operations.event_of`
    return Goals(whole=is_whole, operations=tuple(one.view(is_whole=is_whole) for one in goals))


class ActionGoals:
    """Sends goals and cancels them; `operations` has their state.

    `named` is called when a goal of ours gets its id, which is in its server's status messages.
    """

    def __init__(
        self, wire: RosConnection, logs: NodeLogs, named: Callable[[], object] = lambda: None
    ) -> None:
        self._wire, self._logs, self._named = wire, logs, named
        self.operations: Operations[Goal] = Operations(_event_of, kept=_KEPT, running=_RUNNING_MAX)
        self._running, self._begins = RunningTasks(), Begins()
        self._requests: dict[int, GoalRequest] = {}
        self._clients: tuple[WireLink, ActionClients] | None = None

    async def begin(self, command: SendGoal) -> Begun:
        """Send a goal, and do not wait for its result.

        Raises:
            StudioError: It cannot be sent.
        """
        from studio.live.panels.goal_work import GoalRequest  # noqa: PLC0415 - imports zenoh

        number = self.operations.next_number()
        with self._begins.of("") as begin:
            link = await self._wire.link()
            clients = self._clients_of(link)
            request = await asyncio.to_thread(GoalRequest, link, clients, command)
            if not begin.may_go_on:
                await asyncio.to_thread(request.close)
                raise CommandError("The robot was stopped: send the goal again.")
        goal = Goal(number, request.name, request.type_name, command.text)
        goal.log_from = self._logs.listen()
        self._requests[number] = request
        self.operations.add(goal)
        self._running.start(
            number,
            self._follow(goal, request, command.timeout_s),
            lambda outcome: self._finish(goal, request, outcome),
        )
        return Begun(request=command.request, operation=number)

    async def send(self, name: str, action_type: str, text: str) -> int:
        """Send a goal for another part, as `begin`; return its number."""
        return (await self.begin(SendGoal(name=name, action_type=action_type, text=text))).operation

    async def cancel(self, command: CancelGoal) -> None:
        """Ask a server to cancel a goal.

        Raises:
            StudioError: There is no such goal, or its server refuses.
        """
        goal = self.operations.get(command.operation)
        request = self._requests.get(command.operation)
        if request is None or goal.is_over:
            return
        if goal.state == "sending":
            self._running.cancel(goal.operation)
            return
        before, goal.state = goal.state, "canceling"
        self.operations.changed(goal)
        try:
            await request.cancel()
        except BaseException:
            if goal.state == "canceling":
                goal.state = before
                self.operations.changed(goal)
            raise

    async def cancel_all(self) -> None:
        """Ask for every goal that was sent from here to be canceled; what refuses goes on."""
        self._begins.release(lambda _: False)
        orders = (CancelGoal(operation=one.operation) for one in self.operations.unfinished())
        await asyncio.gather(*(outcome_of(self.cancel(order)) for order in orders))

    def own_ids(self) -> frozenset[str]:
        """Ids of the goals that were sent from here, in hex."""
        return frozenset(one.goal_id for one in self.operations.all() if one.goal_id)

    async def let_go(self) -> None:
        """End all: the connection is about to end."""
        await self._running.end_all(
            "The connection with ROS 2 was ended: the goal may go on where it is carried out."
        )
        self._clients = None

    async def close(self) -> None:
        """End all that runs, and send no more events."""
        await self.let_go()
        await self.operations.close()

    def _clients_of(self, link: WireLink) -> ActionClients:
        from studio.live.panels.goal_work import ActionClients  # noqa: PLC0415 - imports zenoh

        if self._clients is None or self._clients[0] is not link:
            self._clients = link, ActionClients(link)
        return self._clients[1]

    async def _follow(
        self, goal: Goal, request: GoalRequest, timeout_s: float
    ) -> tuple[GoalState, str]:
        """Return how it ended, and its result."""
        loop = asyncio.get_running_loop()

        def take(feedback: object) -> None:
            goal.take_feedback(feedback)
            self.operations.changed(goal)

        def on_feedback(feedback: object) -> None:  # in the thread of the link
            if not loop.is_closed():
                loop.call_soon_threadsafe(take, feedback)

        if not await request.accepted(timeout_s, on_feedback):
            return "rejected", ""
        goal.state, goal.goal_id = "accepted", request.goal_id
        self._named()
        self.operations.changed(goal)
        following = asyncio.create_task(self._follow_status(goal, request))
        try:
            status, result = await request.result()
        finally:
            following.cancel()
        return _ended(status.name.lower()), result

    async def _follow_status(self, goal: Goal, request: GoalRequest) -> None:
        """Follow its status on the topic of all goals."""
        while True:
            if goal.state == "accepted" and request.status.name == "EXECUTING":
                goal.state = "executing"
                self.operations.changed(goal)
            await asyncio.sleep(_CHECK_EVERY_S)

    async def _finish(
        self, goal: Goal, request: GoalRequest, outcome: Outcome[tuple[GoalState, str]]
    ) -> None:
        goal.took_s = round(time.time_ns() / 1e9 - goal.began_s, 3)
        goal.trouble = outcome.trouble
        if outcome.value is not None:
            goal.state, goal.result = outcome.value
        else:
            goal.state = "canceled" if outcome.kind == "cancelled" else "failed"
        self._requests.pop(goal.operation, None)
        goal.servers = request.servers
        self.operations.changed(goal)
        await asyncio.to_thread(request.close)
        if goal.state in {"aborted", "rejected"}:
            await self._find_why(goal)

    async def _find_why(self, goal: Goal) -> None:
        """Find what its server logged, for its answer has no reason."""
        goal.server_said = await self._logs.newest_warning(
            goal.servers,
            after=goal.log_from,
            since_s=goal.began_s - _CLOCKS_APART_S,
            patience_s=_LOG_PATIENCE_S,
        )
        if goal.server_said is not None:
            self.operations.changed(goal)


def _ended(name: str) -> GoalState:
    match name:
        case "succeeded" | "canceled" | "aborted":
            return name
        case _:
            return "failed"


COMMANDS: Final = Commands[ActionGoals](Scope.ROS)
COMMANDS.controller(SendGoal, lambda one, c, _: one.begin(c), needs_router=True)
COMMANDS.controller(CancelGoal, lambda one, c, _: one.cancel(c), needs_router=True)
