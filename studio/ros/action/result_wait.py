"""ResultWait: a question for the result of a goal, asked again when the router was away."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from studio.errors import ActionServerGoneError, NotServedError, WireError
from studio.ros.node.future import Future
from studio.ros.node.work import ReentrantCallbackGroup

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.node.node import Node
    from studio.ros.node.service_client import Client
    from studio.ros.node.timer import Timer
    from studio.ros.types.classes import MessageValue

LOOK_S = 0.5
RETURNS_WITHIN_S = 10.0
"""A server whose router is back shows itself again before long."""
TRIES_MAX = 20


class ResultWait:
    """Waits as long as the goal takes, or until its server is gone.

    A question ends without an answer when the server ends, and when the router does: then it is
    asked anew once router and server are there again, since the goal went on meanwhile.
    """

    def __init__(
        self,
        node: Node,
        client: Client,
        request: MessageValue,
        follow: Callable[[Any], Any],
        action_name: str,
    ) -> None:
        self._node = node
        self._client = client
        self._request = request
        self._follow = follow
        self._gone = ActionServerGoneError(action_name)
        self._asked: Future[Any] | None = None
        self._looking: Timer | None = None
        self._router_was_away = False
        self._patience_until_s = 0.0
        self._tries_left = TRIES_MAX
        self.answer: Future[Any] = Future(executor=node.executor)
        self._ask()
        self.answer.listen(self._end)

    def _ask(self) -> None:
        try:
            asked = self._asked = self._client.call_async(self._request)
        except WireError as error:
            self.answer.set_exception(error)
            return
        asked.listen(lambda: self._settle(asked))

    def _settle(self, asked: Future[Any]) -> None:
        error = asked.exception()
        if self.answer.done():
            return
        if asked.cancelled():
            self.answer.cancel()
        elif isinstance(error, NotServedError):
            self._look_for_server()
        elif error is not None:
            self.answer.set_exception(error)
        else:
            self.answer.set_result(self._follow(asked.result()))

    def _look_for_server(self) -> None:
        self._tries_left -= 1
        if self._tries_left <= 0:
            self.answer.set_exception(self._gone)
            return
        self._stay_patient()
        self._looking = self._node.create_timer(
            LOOK_S, self._look, callback_group=ReentrantCallbackGroup()
        )

    def _look(self) -> None:
        if self.answer.done():  # it was given up while the look was being prepared
            self._stop_looking()
        if self.answer.done() or not self._stay_patient():
            return
        if self._client.service_is_ready():
            self._stop_looking()
            self._ask()
        elif not self._router_was_away or time.monotonic() > self._patience_until_s:
            self._stop_looking()
            self.answer.set_exception(self._gone)

    def _stay_patient(self) -> bool:
        """Take note of a router that is away; whether one is there."""
        is_there = self._node.wire.is_connected
        if not is_there:
            self._router_was_away = True
            self._patience_until_s = time.monotonic() + RETURNS_WITHIN_S
        return is_there

    def _stop_looking(self) -> None:
        looking, self._looking = self._looking, None
        if looking is not None:
            self._node.destroy_timer(looking)

    def _end(self) -> None:
        self._stop_looking()
        if self._asked is not None:
            self._asked.cancel()
