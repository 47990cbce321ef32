"""Calls that nobody answers, that two answer, and whose server dies in the middle."""

from __future__ import annotations

import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import CdrError, NoAnswerError, NotServedError, WireError
from studio.ros.action import ActionClient
from studio.ros.client import action
from studio.ros.messages import service
from studio.ros.tokens import DataKey
from studio.ros.wire.zenoh import declare_queryable
from tests.support.demos import heard, node_at, running_demo
from tests.support.patience import Stopwatch
from tests.support.wire import PATIENCE_S, open_test_session, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.client import Future
    from studio.ros.node.node import Node

pytestmark = pytest.mark.network
ADD = service("example_interfaces/srv/AddTwoInts")
ADD_NAME = "example_interfaces/srv/AddTwoInts"
CHOOSE_SONG = "radio_station_interfaces/action/ChooseSong"


@pytest.fixture
def node(endpoint: str) -> Generator[Node]:
    with node_at(endpoint) as found:
        yield found


def failure_of(future: Future[Any]) -> BaseException | None:
    wait_until("it ends", future.done)
    return future.exception()


@contextmanager
def mute_server(endpoint: str, name: str) -> Generator[None]:
    """A server that answers no request until the end of the block."""
    released = threading.Event()

    def wait(_request: object, response: object) -> object:
        released.wait(PATIENCE_S)
        return response

    with node_at(endpoint, "mute") as mute:
        mute.create_service(ADD, name, wait)
        try:
            yield
        finally:
            released.set()


def test_a_service_that_never_answers_is_given_up_in_time(endpoint: str, node: Node):
    with mute_server(endpoint, "/mute"):
        client = node.create_client(ADD, "/mute", timeout_s=0.3)
        assert client.wait_for_service(PATIENCE_S)
        watch = Stopwatch()
        error = failure_of(client.call_async(ADD.Request()))
        assert isinstance(error, NoAnswerError)
        assert "/mute" in str(error)
        assert watch.s < 10


def test_a_wait_of_ones_own_ends_while_the_call_goes_on(endpoint: str, node: Node):
    with mute_server(endpoint, "/mute_too"):
        client = node.create_client(ADD, "/mute_too")
        assert client.wait_for_service(PATIENCE_S)
        with pytest.raises(NoAnswerError, match="/mute_too"):
            client.call(ADD.Request(), 0.2)


def test_a_service_that_nobody_serves_is_told_at_once(node: Node):
    client = node.create_client(ADD, "/nobody")
    assert isinstance(failure_of(client.call_async(ADD.Request())), NotServedError)
    assert not client.wait_for_service(0.05)


def test_two_servers_both_do_what_is_asked_and_the_first_answer_counts(endpoint: str, node: Node):
    done: list[str] = []
    said = heard(node, "rcl_interfaces/msg/Log", "/rosout")
    with node_at(endpoint, "one") as one, node_at(endpoint, "two") as two:
        for server in (one, two):

            def add(request: Any, response: Any, name: str = server.get_name()) -> Any:  # noqa: ANN401
                done.append(name)
                response.sum = request.a + request.b
                return response

            server.create_service(ADD, "/twice", add)
        graph = node.graph
        assert graph.wait_for(lambda: len(graph.servers("/twice")) == 2, PATIENCE_S)
        client = node.create_client(ADD, "/twice")
        assert client.call(ADD.Request(a=1, b=2), PATIENCE_S).sum == 3
        wait_until("both did it", lambda: sorted(done) == ["one", "two"])
        wait_until("it is said", lambda: any("more than one node" in each.msg for each in said))


def test_an_answer_of_malformed_bytes_is_told_as_such(endpoint: str, node: Node):
    with open_test_session(endpoint) as strange:
        key = str(DataKey(0, "/garbled", ADD_NAME, strange.types.hash_of(ADD_NAME)))
        queries = declare_queryable(strange.zenoh, key, 8)
        client = node.create_client(ADD, "/garbled")
        future = client.call_async(ADD.Request())
        query = None

        def asked() -> bool:
            nonlocal query, future
            query = query or queries.try_recv()
            if query is None and future.done():
                future = client.call_async(ADD.Request())
            return query is not None

        wait_until("it is asked", asked)
        assert query is not None
        assert query.attachment is not None
        answered = query.attachment.to_bytes()
        query.reply(query.key_expr, b"\0\1\0\0x", attachment=answered)
        query.drop()
        assert isinstance(failure_of(future), CdrError)


def test_a_request_of_malformed_bytes_is_refused_and_the_next_one_answered(
    endpoint: str, node: Node
):
    def add(request: Any, response: Any) -> Any:  # noqa: ANN401
        response.sum = request.a + request.b
        return response

    server = node.create_service(ADD, "/careful", add)
    key = str(DataKey(0, "/careful", ADD_NAME, node.wire.types.hash_of(ADD_NAME)))
    with open_test_session(endpoint) as strange:

        def is_reached() -> bool:
            assert list(strange.zenoh.get(key, payload=b"x", timeout=20.0)) == []
            return server.refused > 0

        wait_until("the service is known where it is asked", is_reached)
        for payload, attached in ((b"x", None), (b"x", bytes(33)), (b"x", b"y"), (None, None)):
            before = server.refused
            replies = strange.zenoh.get(key, payload=payload, attachment=attached, timeout=20.0)
            assert list(replies) == []
            assert server.refused == before + 1
    client = node.create_client(ADD, "/careful")
    assert client.wait_for_service(PATIENCE_S)
    with node_at(endpoint, "asker") as asker:
        honest = asker.create_client(ADD, "/careful")
        assert honest.call(ADD.Request(a=2, b=2), PATIENCE_S).sum == 4


def test_a_goal_whose_server_is_killed_ends_with_an_error(endpoint: str, node: Node):
    with running_demo(endpoint, "radio_dj", "--ros-args", "-p", "step_seconds:=0.2") as dj:
        client = ActionClient(node, action(CHOOSE_SONG), "choose_song")
        assert client.wait_for_server(PATIENCE_S)
        told: list[Any] = []
        sent = client.send_goal_async(
            action(CHOOSE_SONG).Goal(song_name="Clocks"), feedback_callback=told.append
        )
        wait_until("it is accepted", sent.done)
        result = sent.result().get_result_async()
        wait_until("the song plays", lambda: bool(told))
        dj.process.kill()
        assert isinstance(failure_of(result), WireError)
    wait_until("it is known to be gone", lambda: not client.server_is_ready())
    with running_demo(endpoint, "radio_dj", "--ros-args", "-p", "step_seconds:=0.01"):
        assert client.wait_for_server(PATIENCE_S)
        again = client.send_goal_async(action(CHOOSE_SONG).Goal(song_name="Clocks"))
        wait_until("it is accepted", again.done)
        result = again.result().get_result_async()
        wait_until("it ends", result.done)
        assert result.result().result.success
