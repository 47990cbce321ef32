from __future__ import annotations

import gc
import threading
import weakref
from typing import TYPE_CHECKING

import pytest
import zenoh

from studio.errors import MessageValueError, NotServedError
from studio.ros.attachment import Attachment, unpack
from studio.ros.cdr import codec_of
from studio.ros.messages import service
from studio.ros.node.spinning import spinning
from studio.ros.node.task import Future
from studio.ros.node.work import ReentrantCallbackGroup
from studio.ros.qos import QoSProfile
from studio.ros.wire.zenoh import declare_querier
from tests.support.node_pair import node_pair, spin_until
from tests.support.wire import PATIENCE_S, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.node import Node
    from studio.ros.node.service import Service
    from studio.ros.types.classes import MessageValue

AddTwoInts = service("example_interfaces/srv/AddTwoInts")
PAYLOAD = bytes(codec_of(AddTwoInts.Request).encode(AddTwoInts.Request(a=1, b=2)))
GID = b"c" * 16


def add(request: MessageValue, response: MessageValue) -> MessageValue:
    response.sum = request.a + request.b
    return response


@pytest.fixture(scope="module")
def nodes() -> Generator[tuple[Node, Node]]:
    with node_pair() as pair:
        yield pair


def asked(
    asker: Node, served: Service, payload: bytes = PAYLOAD, attachment: bytes | None = None
) -> list[zenoh.Reply]:
    """Ask as a bare client does, and give all replies."""
    packed = Attachment(7, 123, GID).pack() if attachment is None else attachment
    assert asker.graph.wait_for_service(served.srv_name, timeout_s=30)
    querier = declare_querier(asker.wire.zenoh, served.endpoint.key, 30.0)
    replies = querier.get(zenoh.handlers.FifoChannel(16), payload=payload, attachment=packed)
    found = list(replies)
    querier.undeclare()
    return found


def test_a_reply_has_the_key_number_and_sender_of_its_request(nodes: tuple[Node, Node]):
    asker, server = nodes
    served = server.create_service(AddTwoInts, "plain", add)
    with spinning(server):
        (reply,) = asked(asker, served)
    assert reply.ok is not None
    assert str(reply.ok.key_expr) == served.endpoint.key
    attachment = reply.ok.attachment
    assert attachment is not None
    told = unpack(attachment.to_bytes())
    assert (told.sequence, told.gid) == (7, GID)
    assert told.source_time_ns > 123


@pytest.mark.parametrize(
    ("name", "payload", "attachment", "reason"),
    [
        ("bare", PAYLOAD, b"short", "5 bytes"),
        ("junk", b"junk", None, "header"),
        ("cut", b"\x00\x01\x00\x00", None, "AddTwoInts"),
    ],
)
def test_a_request_that_is_none_is_counted_and_gets_no_answer(
    nodes: tuple[Node, Node], name: str, payload: bytes, attachment: bytes | None, reason: str
):
    asker, server = nodes
    served = server.create_service(AddTwoInts, f"strict_{name}", add)
    with spinning(server):
        assert asked(asker, served, payload, attachment) == []
        assert served.refused == 1
        assert reason in str(served.reason)
        assert len(asked(asker, served)) == 1


def test_what_is_said_of_a_dropped_request_begins_once(
    nodes: tuple[Node, Node], capsys: pytest.CaptureFixture[str]
):
    asker, server = nodes
    served = server.create_service(AddTwoInts, "worded", add)
    asked(asker, served, attachment=b"short")
    said = capsys.readouterr().err
    assert "A request to /worded was dropped. Its attachment cannot be read: it has 5 b" in said


def test_a_client_may_leave_so_many_requests_without_an_answer(
    nodes: tuple[Node, Node], monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr("studio.ros.node.service.PENDING_OF_CLIENT_MAX", 2)
    asker, server = nodes
    gate: Future[None] = Future()
    seen: list[int] = []

    async def answer(request: MessageValue, response: MessageValue) -> MessageValue:
        seen.append(request.a)
        await gate
        return response

    served = server.create_service(
        AddTwoInts, "patient", answer, callback_group=ReentrantCallbackGroup()
    )
    client, other = (asker.create_client(AddTwoInts, "patient") for _ in range(2))
    assert client.wait_for_service(timeout_sec=30)
    with spinning(server):
        calls = [client.call_async(AddTwoInts.Request(a=number)) for number in range(3)]
        spin_until(calls[2].done, asker)
        calls.append(other.call_async(AddTwoInts.Request(a=3)))
        wait_until("the others are begun", lambda: seen == [0, 1, 3])
        assert isinstance(calls[2].exception(), NotServedError)
        assert served.reason == "Its client waits for 2 answers already."
        gate.set_result(None)
        spin_until(lambda: all(call.done() for call in calls), asker)
        again = client.call_async(AddTwoInts.Request(a=4))
        spin_until(again.done, asker)
    assert again.exception() is None


def test_a_callback_that_awaits_what_nobody_else_holds_is_not_lost(nodes: tuple[Node, Node]):
    asker, server = nodes
    gates: list[weakref.ref[Future[None]]] = []

    async def answer(_request: MessageValue, response: MessageValue) -> MessageValue:
        gate: Future[None] = Future()
        gates.append(weakref.ref(gate))
        await gate
        return response

    server.create_service(AddTwoInts, "held", answer)
    client = asker.create_client(AddTwoInts, "held")
    assert client.wait_for_service(timeout_sec=30)
    with spinning(server):
        future = client.call_async(AddTwoInts.Request())
        wait_until("it waits", lambda: bool(gates))
        gc.collect()
        held = gates[0]()
        assert held is not None
        held.set_result(None)
        spin_until(future.done, asker)
    assert future.exception() is None


def test_a_callback_whose_awaited_future_is_cancelled_gives_no_answer_and_ends_no_spinning(
    nodes: tuple[Node, Node],
):
    asker, server = nodes

    async def answer(request: MessageValue, response: MessageValue) -> MessageValue:
        gate: Future[None] = Future()
        if request.a:
            gate.cancel()
            await gate
        return response

    served = server.create_service(AddTwoInts, "given_up", answer)
    client = asker.create_client(AddTwoInts, "given_up")
    assert client.wait_for_service(timeout_sec=30)
    with spinning(server):
        cancelled = client.call_async(AddTwoInts.Request(a=1))
        spin_until(cancelled.done, asker)
        answered = client.call_async(AddTwoInts.Request())
        spin_until(answered.done, asker)
    assert isinstance(cancelled.exception(), NotServedError)
    assert answered.exception() is None
    assert served.reason == "What its callback awaited was cancelled."


def test_a_callback_that_fails_ends_the_spinning_and_leaves_nobody_waiting(
    nodes: tuple[Node, Node],
):
    asker, server = nodes
    served = server.create_service(AddTwoInts, "failing", lambda _asked, _given: 1 // 0)
    client = asker.create_client(AddTwoInts, "failing")
    assert client.wait_for_service(timeout_sec=30)
    future = client.call_async(AddTwoInts.Request())
    wait_until("the request arrived", lambda: served.is_ready)
    with pytest.raises(ZeroDivisionError):
        spin_until(lambda: False, server)
    spin_until(future.done, asker)


@pytest.mark.parametrize("given", [None, 5, AddTwoInts.Request()], ids=["nothing", "5", "request"])
def test_a_callback_that_gives_no_response_is_told_so(nodes: tuple[Node, Node], given: object):
    asker, server = nodes
    name = f"wrong_{type(given).__name__}"  # of its own: the asker may still see the one before
    served = server.create_service(AddTwoInts, name, lambda _asked, _given: given)
    client = asker.create_client(AddTwoInts, name)
    assert client.wait_for_service(timeout_sec=30)
    client.call_async(AddTwoInts.Request())
    wait_until("the request arrived", lambda: served.is_ready)
    with pytest.raises(MessageValueError, match="AddTwoInts_Response"):
        spin_until(lambda: False, server)
    server.destroy_service(served)


def test_the_last_of_the_depth_wait_and_older_ones_get_no_answer(nodes: tuple[Node, Node]):
    asker, server = nodes
    seen: list[int] = []

    def note(request: MessageValue, response: MessageValue) -> MessageValue:
        seen.append(request.a)
        return response

    served = server.create_service(AddTwoInts, "deep", note, qos_profile=QoSProfile(depth=2))
    client = asker.create_client(AddTwoInts, "deep")
    assert client.wait_for_service(timeout_sec=30)
    futures = [client.call_async(AddTwoInts.Request(a=number)) for number in range(4)]
    spin_until(lambda: futures[0].done() and futures[1].done(), asker)
    assert served.is_ready
    with spinning(server):
        spin_until(lambda: all(future.done() for future in futures), asker)
    assert seen == [2, 3]
    assert [future.exception() is None for future in futures] == [False, False, True, True]


def test_an_asynchronous_callback_that_fails_leaves_nobody_waiting(nodes: tuple[Node, Node]):
    asker, server = nodes

    async def fail(_asked: MessageValue, _given: MessageValue) -> MessageValue:
        raise KeyError("x")

    served = server.create_service(AddTwoInts, "failing_later", fail)
    client = asker.create_client(AddTwoInts, "failing_later")
    assert client.wait_for_service(timeout_sec=30)
    future = client.call_async(AddTwoInts.Request())
    wait_until("the request arrived", lambda: served.is_ready)
    with pytest.raises(KeyError):
        spin_until(lambda: False, server)
    spin_until(future.done, asker)


def test_a_server_that_is_taken_back_while_it_works_leaves_nobody_waiting(
    nodes: tuple[Node, Node],
):
    asker, server = nodes
    begun: list[int] = []
    never: Future[None] = Future()

    async def answer(_asked: MessageValue, given: MessageValue) -> MessageValue:
        begun.append(1)
        await never
        return given

    served = server.create_service(AddTwoInts, "interrupted", answer)
    client = asker.create_client(AddTwoInts, "interrupted")
    with spinning(server) as executor:
        assert client.wait_for_service(timeout_sec=30)
        future = client.call_async(AddTwoInts.Request())
        wait_until("it works", lambda: bool(begun))
        server.destroy_service(served)
        spin_until(future.done, asker)
        never.set_result(None)
        after = executor.create_task(lambda: None)
        assert after.wait(30)
    assert isinstance(future.exception(), NotServedError)


def test_requests_that_come_while_a_server_is_taken_back_are_never_left_open(
    nodes: tuple[Node, Node],
):
    asker, server = nodes
    client = asker.create_client(AddTwoInts, "flickering")
    for _ in range(20):
        served = server.create_service(AddTwoInts, "flickering", add)
        assert client.wait_for_service(timeout_sec=30)
        futures = [client.call_async(AddTwoInts.Request()) for _ in range(5)]
        server.destroy_service(served)
        spin_until(lambda: all(future.done() for future in futures), asker)  # noqa: B023
        wait_until("it is gone", lambda: not client.service_is_ready())


def test_a_server_that_is_taken_back_at_the_moment_of_its_answer_harms_nobody(
    nodes: tuple[Node, Node],
):
    asker, server = nodes
    for number in range(20):
        begun, goes_on = threading.Event(), threading.Event()

        def answer(
            _asked: MessageValue,
            given: MessageValue,
            begun: threading.Event = begun,
            goes_on: threading.Event = goes_on,
        ) -> MessageValue:
            begun.set()
            goes_on.wait(PATIENCE_S)
            return given

        name = f"leaving_{number}"
        served = server.create_service(AddTwoInts, name, answer)
        client = asker.create_client(AddTwoInts, name)
        assert client.wait_for_service(timeout_sec=PATIENCE_S)
        with spinning(server):  # what its callbacks raise is raised here
            future = client.call_async(AddTwoInts.Request())
            wait_until("it works", begun.is_set)
            goes_on.set()
            server.destroy_service(served)
            spin_until(future.done, asker)
