from __future__ import annotations

import asyncio
import threading
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import (
    CallRefusedError,
    CdrError,
    ForeignAnswerError,
    MessageValueError,
    NoAnswerError,
    NotServedError,
)
from studio.ros.attachment import Attachment
from studio.ros.cdr import codec_of
from studio.ros.messages import message, service
from studio.ros.node.spinning import spinning
from studio.ros.node.task import Future
from studio.ros.node.work import ReentrantCallbackGroup
from studio.ros.wire.zenoh import declare_queryable
from tests.support.node_pair import node_pair, spin_until
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

    from studio.ros.node.node import Node
    from studio.ros.node.service_client import Client
    from studio.ros.types.classes import MessageValue

AddTwoInts = service("example_interfaces/srv/AddTwoInts")
Trigger = service("std_srvs/srv/Trigger")
REQUEST = AddTwoInts.Request(a=41, b=1)


def add(request: MessageValue, response: MessageValue) -> MessageValue:
    response.sum = request.a + request.b
    return response


@pytest.fixture(scope="module")
def nodes() -> Generator[tuple[Node, Node]]:
    with node_pair() as pair:
        yield pair


def test_sv2_a_service_answers(nodes: tuple[Node, Node]):
    asker, server = nodes
    server.create_service(AddTwoInts, "add", add)
    client = asker.create_client(AddTwoInts, "add")
    with spinning(server):
        assert client.wait_for_service(timeout_sec=30)
        future = client.call_async(REQUEST)
        spin_until(future.done, asker)
        raw = client.call_async(REQUEST, raw=True)
        spin_until(raw.done, asker)
    assert future.result().sum == 42
    assert codec_of(AddTwoInts.Response).decode(raw.result()).sum == 42


def test_a_response_is_executors_work(nodes: tuple[Node, Node]):
    asker, server = nodes
    server.create_service(AddTwoInts, "add_work", add)
    client = asker.create_client(AddTwoInts, "add_work")
    with spinning(server):
        assert client.wait_for_service(timeout_sec=30)
        future = client.call_async(REQUEST)
        wait_until("an answer waits", lambda: client.is_ready)
        assert not future.done()
        spin_until(future.done, asker)


def test_answers_belong_to_their_requests_in_any_order(nodes: tuple[Node, Node]):
    asker, server = nodes
    waiting: dict[int, Future[None]] = {number: Future() for number in range(4)}

    async def answer(request: MessageValue, response: MessageValue) -> MessageValue:
        await waiting[request.a]
        return add(request, response)

    group = ReentrantCallbackGroup()
    server.create_service(AddTwoInts, "add_later", answer, callback_group=group)
    client = asker.create_client(AddTwoInts, "add_later")
    with spinning(server):
        assert client.wait_for_service(timeout_sec=30)
        futures = [client.call_async(AddTwoInts.Request(a=number, b=10)) for number in range(4)]
        for number in (2, 0, 3, 1):
            waiting[number].set_result(None)
            spin_until(futures[number].done, asker)
    assert [future.result().sum for future in futures] == [10, 11, 12, 13]


def test_empty_requests_travel(nodes: tuple[Node, Node]):
    asker, server = nodes

    def answer(_request: MessageValue, response: MessageValue) -> MessageValue:
        response.success, response.message = True, "done"
        return response

    server.create_service(Trigger, "trigger", answer)
    client = asker.create_client(Trigger, "trigger")
    with spinning(server, asker):
        assert client.wait_for_service(timeout_sec=30)
        assert client.call(Trigger.Request()).message == "done"


def test_asyncio_awaits_an_answer(nodes: tuple[Node, Node]):
    asker, server = nodes
    server.create_service(AddTwoInts, "add_async", add)
    client = asker.create_client(AddTwoInts, "add_async")

    async def ask() -> int:
        return (await client.call_async(REQUEST)).sum

    with spinning(server, asker):
        assert client.wait_for_service(timeout_sec=30)
        assert asyncio.run(ask()) == 42


def test_a_callback_awaits_the_answer_of_its_own_node(nodes: tuple[Node, Node]):
    _, server = nodes
    server.create_service(AddTwoInts, "add_inner", add)
    client = server.create_client(AddTwoInts, "add_inner")

    async def ask() -> int:
        return (await client.call_async(REQUEST)).sum

    assert client.wait_for_service(timeout_sec=30)
    with spinning(server) as executor:
        task = executor.create_task(ask)
        assert task.wait(30)
    assert task.result() == 42


def test_a_service_that_nobody_serves_says_so(nodes: tuple[Node, Node]):
    asker, _ = nodes
    client = asker.create_client(AddTwoInts, "nobody")
    assert not client.service_is_ready()
    assert not client.wait_for_service(timeout_sec=0.01)
    future = client.call_async(REQUEST)
    spin_until(future.done, asker)
    with pytest.raises(NotServedError, match="/nobody"):
        future.result()


def test_a_server_that_never_answers_is_given_up_in_time(nodes: tuple[Node, Node]):
    asker, server = nodes
    silent = server.create_service(AddTwoInts, "silent", add)  # its node is not spun
    client = asker.create_client(AddTwoInts, "silent", timeout_s=0.2)
    assert client.wait_for_service(timeout_sec=30)
    future = client.call_async(REQUEST)
    spin_until(future.done, asker)
    assert isinstance(future.exception(), NoAnswerError)
    server.destroy_service(silent)


def test_waiting_for_an_answer_ends_in_time(nodes: tuple[Node, Node]):
    asker, server = nodes
    silent = server.create_service(AddTwoInts, "too_slow", add)
    client = asker.create_client(AddTwoInts, "too_slow")
    assert client.wait_for_service(timeout_sec=30)
    with spinning(asker), pytest.raises(NoAnswerError, match=r"0\.1 s"):
        client.call(REQUEST, timeout_sec=0.1)
    server.destroy_service(silent)


def test_sv3_a_cancelled_call_leaves_the_client_usable(nodes: tuple[Node, Node]):
    asker, server = nodes
    server.create_service(AddTwoInts, "cancelled", add)
    client = asker.create_client(AddTwoInts, "cancelled")
    assert client.wait_for_service(timeout_sec=30)
    given_up = client.call_async(REQUEST)
    given_up.cancel()
    with spinning(server):
        future = client.call_async(REQUEST)
        spin_until(future.done, asker)
    assert future.result().sum == 42
    assert (given_up.cancelled(), given_up.result()) == (True, None)


def test_two_servers_both_work_and_the_first_answer_is_taken_which_is_said_once(
    nodes: tuple[Node, Node], capsys: pytest.CaptureFixture[str]
):
    asker, server = nodes
    asked: list[str] = []

    def answer_as(name: str) -> Callable[[MessageValue, MessageValue], MessageValue]:
        def answer(request: MessageValue, response: MessageValue) -> MessageValue:
            asked.append(name)
            return add(request, response)

        return answer

    for name in ("one", "other"):
        server.create_service(AddTwoInts, "twice", answer_as(name))
    client = asker.create_client(AddTwoInts, "twice")
    wait_until("both are seen", lambda: asker.count_services("twice") == 2)
    with spinning(server):
        for _ in range(3):
            future = client.call_async(REQUEST)
            spin_until(future.done, asker)
            assert future.result().sum == 42
        wait_until("both have worked", lambda: sorted(asked) == ["one"] * 3 + ["other"] * 3)
    wait_until("it was said", lambda: "more than one node" in capsys.readouterr().err)
    assert "more than one node" not in capsys.readouterr().err


def test_a_server_that_ends_leaves_no_call_open(nodes: tuple[Node, Node]):
    asker, server = nodes
    ending = server.create_service(AddTwoInts, "ending", add)
    client = asker.create_client(AddTwoInts, "ending")
    assert client.wait_for_service(timeout_sec=30)
    future = client.call_async(REQUEST)
    wait_until("the request arrived", lambda: ending.is_ready)
    server.destroy_service(ending)
    spin_until(future.done, asker)
    assert isinstance(future.exception(), NotServedError)
    wait_until("it is gone", lambda: not client.service_is_ready())


def test_an_error_of_a_foreign_server_is_told(nodes: tuple[Node, Node]):
    asker, server = nodes
    client = asker.create_client(AddTwoInts, "refusing")
    queries = declare_queryable(server.wire.zenoh, client.endpoint.key, 10)

    def refuse() -> None:
        query = next(iter(queries))
        query.reply_err(b"not today")
        query.drop()

    thread = threading.Thread(target=refuse)
    thread.start()
    future = call_until_taken(asker, client, thread)
    with pytest.raises(CallRefusedError, match="not today"):
        future.result()
    queries.undeclare()


def test_bytes_that_are_no_response_are_an_error(nodes: tuple[Node, Node]):
    asker, server = nodes
    client = asker.create_client(AddTwoInts, "garbled")
    queries = declare_queryable(server.wire.zenoh, client.endpoint.key, 10)

    def garble() -> None:
        query = next(iter(queries))
        assert query.attachment is not None
        query.reply(query.key_expr, b"junk", attachment=query.attachment.to_bytes())
        query.drop()

    thread = threading.Thread(target=garble)
    thread.start()
    future = call_until_taken(asker, client, thread)
    assert isinstance(future.exception(), CdrError)
    queries.undeclare()


@pytest.mark.parametrize(
    ("name", "attachment", "reason"),
    [
        ("bare_answer", b"", "came without one"),
        ("foreign_answer", Attachment(1, 1, b"another client..").pack(), "another request"),
    ],
)
def test_an_answer_that_carries_no_number_of_its_request_is_none(
    nodes: tuple[Node, Node], name: str, attachment: bytes, reason: str
):
    asker, server = nodes
    client = asker.create_client(AddTwoInts, name)
    queries = declare_queryable(server.wire.zenoh, client.endpoint.key, 10)
    response = bytes(codec_of(AddTwoInts.Response).encode(AddTwoInts.Response(sum=1)))

    def answer() -> None:
        query = next(iter(queries))
        query.reply(query.key_expr, response, attachment=attachment)
        query.drop()

    thread = threading.Thread(target=answer)
    thread.start()
    future = call_until_taken(asker, client, thread)
    with pytest.raises(ForeignAnswerError, match=reason):
        future.result()
    queries.undeclare()


def call_until_taken(asker: Node, client: Client, server: threading.Thread) -> Future[Any]:
    """Call until a bare queryable has been found, and give the call that it took."""
    while True:
        future = client.call_async(REQUEST)
        spin_until(future.done, asker)
        if not isinstance(future.exception(), NotServedError):
            server.join()
            return future


def test_a_request_of_another_type_is_not_sent(nodes: tuple[Node, Node]):
    asker, _ = nodes
    client = asker.create_client(AddTwoInts, "typed_call")
    with pytest.raises(MessageValueError, match="AddTwoInts_Request"):
        client.call_async(message("std_msgs/msg/String")())
