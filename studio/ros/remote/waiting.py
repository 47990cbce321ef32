"""Waiting for answers: within a time, and whoever carries out the node's work."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from studio.errors import NoAnswerError, NotServedError
from studio.ros.node.spinning import spin_until_future_complete

if TYPE_CHECKING:
    from studio.ros.node.future import Future
    from studio.ros.node.node import Node
    from studio.ros.node.service_client import Client
    from studio.ros.types.classes import MessageValue

TIMEOUT_S = 5.0


def asked(node: Node, client: Client, request: MessageValue, timeout_s: float = TIMEOUT_S) -> Any:  # noqa: ANN401  # a response of the service
    """Wait until a service is there, ask it and give its answer.

    Raises:
        NotServedError: No node serves it in time, or that node ended.
        NoAnswerError: The answer does not come in time.
    """
    if not client.wait_for_service(timeout_sec=timeout_s):
        raise NotServedError("service", client.srv_name)
    return answer(node, client.call_async(request), client.srv_name, timeout_s)


def answer(node: Node, future: Future[Any], name: str, timeout_s: float = TIMEOUT_S) -> Any:  # noqa: ANN401  # what the future becomes
    """Wait for a future: a node that nobody spins is spun meanwhile.

    Raises:
        NoAnswerError: It is not known in time; it is cancelled then.
    """
    if node.executor is None:
        spin_until_future_complete(node, future, timeout_sec=timeout_s)
    else:
        future.wait(timeout_s)
    if not future.done():
        future.cancel()
        raise NoAnswerError("service", name, timeout_s)
    return future.result()
