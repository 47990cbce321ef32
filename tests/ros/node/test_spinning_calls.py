from __future__ import annotations

import threading
from typing import Any

import pytest

from studio.errors import NoAnswerError, NotServedError
from studio.ros.node.context import Context
from studio.ros.node.node import Node
from studio.ros.node.spinning import call_service
from tests.support.demos import node_at
from tests.support.wire import open_test_session

pytestmark = pytest.mark.network


def test_a_node_that_nobody_spins_is_spun_for_its_answer(endpoint: str):
    with node_at(endpoint, "server") as server, open_test_session(endpoint) as wire:
        trigger = server.wire.types.service("std_srvs/srv/Trigger")

        def answer(_: Any, response: Any) -> Any:  # noqa: ANN401
            response.message = "done"
            return response

        server.create_service(trigger, "do", answer)
        context = Context.over(wire)
        node = Node("asking", context=context)
        kind = wire.types.service("std_srvs/srv/Trigger")
        client = node.create_client(kind, "do")
        assert call_service(node, client, kind.Request()).message == "done"
        assert node.executor is None
        context.shutdown()


def test_what_nobody_serves_is_said_by_name_in_time(endpoint: str):
    with node_at(endpoint, "asking") as node:
        kind = node.wire.types.service("std_srvs/srv/Trigger")
        client = node.create_client(kind, "/nowhere")
        with pytest.raises(NotServedError, match="No node serves the service /nowhere"):
            call_service(node, client, kind.Request(), timeout_s=0.1)


def test_a_server_that_is_silent_is_given_up(endpoint: str):
    goes_on = threading.Event()
    with node_at(endpoint, "silent") as server, node_at(endpoint, "asking") as node:
        kind = server.wire.types.service("std_srvs/srv/Trigger")

        def never(_: Any, response: Any) -> Any:  # noqa: ANN401
            goes_on.wait(30.0)
            return response

        server.create_service(kind, "hang", never)
        client = node.create_client(node.wire.types.service("std_srvs/srv/Trigger"), "hang")
        try:
            with pytest.raises(NoAnswerError, match=r"/hang gave no answer within 0\.3 s"):
                call_service(node, client, client.srv_type.Request(), timeout_s=0.3)
        finally:
            goes_on.set()
