"""A server and a client of one action, in two sessions at a router, spun beside a test."""

from __future__ import annotations

import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from studio.ros.action import ActionClient, ActionServer
from tests.support.demos import node_at
from tests.support.wire import PATIENCE_S, running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

    from studio.ros.action import ClientGoalHandle, ServerGoalHandle
    from studio.ros.node.node import Node
    from studio.ros.node.task import Future
    from studio.ros.types.library import ActionType

FIBONACCI = "example_interfaces/action/Fibonacci"


def finished(future: Future[Any]) -> Any:  # noqa: ANN401
    """What a future becomes, once somebody else's thread has made it so."""
    wait_until("an answer", future.done)
    return future.result()


class ActionPair:
    """Both ends, and what the client heard."""

    def __init__(
        self,
        serving: Node,
        asking: Node,
        execute: Callable[[ServerGoalHandle], Any],
        **options: Any,  # noqa: ANN401  # of the server
    ) -> None:
        self.serving, self.asking = serving, asking
        self.kind: ActionType = serving.wire.types.action(FIBONACCI)
        self.server = ActionServer(serving, self.kind, "fibonacci", execute, **options)
        self.client = ActionClient(asking, asking.wire.types.action(FIBONACCI), "fibonacci")
        self.heard: list[Any] = []
        assert self.client.wait_for_server(PATIENCE_S)

    def send(self, order: int = 3) -> ClientGoalHandle:
        """Send a goal and wait whether it is accepted."""
        goal = self.client.action_type.Goal(order=order)
        return finished(self.client.send_goal_async(goal, feedback_callback=self.heard.append))


@contextmanager
def action_pair(
    execute: Callable[[ServerGoalHandle], Any],
    **options: Any,  # noqa: ANN401
) -> Generator[ActionPair]:
    """A pair at a router of its own."""
    with (
        running_router() as endpoint,
        node_at(endpoint, "server") as serving,
        node_at(endpoint, "client") as asking,
    ):
        yield ActionPair(serving, asking, execute, **options)


class Held:
    """Work on goals that ends when the test says so, and hands each goal to the test.

    Its callback is a coroutine, so that the server hears what comes meanwhile.
    """

    def __init__(self) -> None:
        self.goals: list[ServerGoalHandle] = []
        self.futures: list[Future[str]] = []
        self._lock = threading.Lock()

    async def __call__(self, goal: ServerGoalHandle) -> object:
        future: Future[Any] = goal.result.__class__(executor=None)
        with self._lock:
            self.goals.append(goal)
            self.futures.append(future)
        what = await future
        getattr(goal, what)()
        return None

    def end(self, what: str, place: int = 0) -> None:
        """End a goal by `succeed`, `abort` or `canceled`."""
        wait_until("the goal is under way", lambda: len(self.futures) > place)
        self.futures[place].set_result(what)
