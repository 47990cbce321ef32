"""Samples, requests and answers through a bridge to DDS, as no bridge would send them."""

from __future__ import annotations

from contextlib import ExitStack
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import pytest

from studio.errors import CallRefusedError, CdrError, NoAnswerError, NotServedError
from studio.ros.cdr import codec_of
from studio.ros.messages import message, service
from studio.ros.wire.zenoh import REPLIES_WAITING_MAX
from tests.support.demos import node_at
from tests.support.pretend_bridge import PretendBridge, talking_bridge
from tests.support.wire import running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

    from studio.ros.node.node import Node
    from studio.ros.node.service_client import Client

pytestmark = pytest.mark.network
STRING = "std_msgs/msg/String"
ADD = service("example_interfaces/srv/AddTwoInts")
GOOD = b"\0\1\0\0\3\0\0\0ok\0"
BIG_ENDIAN = b"\0\0\0\0\0\0\0\3be\0"
SUM = bytes(codec_of(ADD.Response).encode(ADD.Response(sum=3)))
ASKED = bytes(codec_of(ADD.Request).encode(ADD.Request(a=1, b=2)))


class Met(NamedTuple):
    """A node of ours, and a bridge that it has met."""

    node: Node
    bridge: PretendBridge

    def ask(self, key: str, **told: object) -> list[bytes]:
        """Ask as a bridge does, and return the answers."""
        replies = cast("Any", self.bridge.session).get(key, timeout=20.0, **told)
        return [one.ok.payload.to_bytes() for one in replies if one.ok is not None]


@pytest.fixture(scope="module")
def endpoint() -> Generator[str]:
    with running_router() as found:
        yield found


@pytest.fixture
def met(endpoint: str) -> Generator[Met]:
    with ExitStack() as stack:
        node = stack.enter_context(node_at(endpoint, "studio_node"))
        bridge = stack.enter_context(talking_bridge(endpoint))
        wait_until("it is seen", lambda: bool(node.graph.publishers("/chatter")))
        yield Met(node, bridge)


def number(client: int, sequence: int) -> bytes:
    """What a bridge attaches to a request."""
    return b"rqh" + client.to_bytes(8, "little") + sequence.to_bytes(8, "little") + b"\1"


@pytest.mark.parametrize(
    "payload", [b"", b"\0", b"\0\1\0\0", b"\0\1\0\0\xff\xff\xff\xff", b"x" * 99, bytes(1 << 20)]
)
def test_malformed_bytes_are_counted_and_the_next_sample_comes(met: Met, payload: bytes):
    came: list[Any] = []
    heard = met.node.create_subscription(message(STRING), "/chatter", came.append, 100)

    def is_counted() -> bool:
        met.bridge.send("chatter", payload)
        return heard.losses.malformed > 0

    wait_until("it is counted", is_counted)
    met.bridge.send("chatter", BIG_ENDIAN)
    wait_until("the next came", lambda: [one.data for one in came if one.data] == ["be"])


@pytest.mark.parametrize("attachment", [b"", b"x", bytes(33), bytes(100_000)])
def test_samples_with_what_no_bridge_attaches_are_no_bridges(met: Met, attachment: bytes):
    came: list[Any] = []
    heard = met.node.create_subscription(message(STRING), "/chatter", came.append, 100)

    def is_heard() -> bool:
        cast("Any", met.bridge.session).put(
            "chatter", b"\0\1\0\0\3\0\0\0no\0", attachment=attachment
        )
        met.bridge.send("chatter", GOOD)
        return bool(came)

    wait_until("good ones come", is_heard)
    assert {one.data for one in came} == {"ok"}
    assert heard.losses.malformed == 0


def test_samples_without_a_time_or_of_no_known_bridge_come_with_ours(met: Met):
    came: list[tuple[Any, Any]] = []

    def take(said: Any, info: Any) -> None:  # noqa: ANN401
        came.append((said, info))

    met.node.create_subscription(message(STRING), "/chatter", take, 100)

    def is_heard() -> bool:
        cast("Any", met.bridge.session).put("chatter", GOOD)
        return bool(came)

    wait_until("it comes", is_heard)
    info = came[0][1]
    assert abs(info["source_timestamp"] - info["received_timestamp"]) < 60e9


@pytest.fixture
def asked(met: Met) -> list[tuple[int, int]]:
    """What a service of ours, /sum, was asked."""
    found: list[tuple[int, int]] = []

    def answer(request: Any, response: Any) -> object:  # noqa: ANN401
        found.append((request.a, request.b))
        response.sum = request.a + request.b
        return response

    met.node.create_service(ADD, "/sum", answer)
    return found


@pytest.mark.parametrize(
    "attachment",
    [b"", b"rqh", b"rqh" + bytes(16), b"xyz" + bytes(17), bytes(33), bytes(100_000)],
    ids=["empty", "short", "shorter", "other", "rmw", "huge"],
)
def test_a_request_with_a_wrong_number_is_dropped_and_the_next_is_answered(
    met: Met, asked: list[tuple[int, int]], attachment: bytes
):
    assert met.ask("sum", payload=ASKED, attachment=attachment) == []
    assert met.ask("sum", payload=ASKED, attachment=number(1, 1)) == [SUM]
    assert asked == [(1, 2)]


@pytest.mark.parametrize("payload", [None, b"", b"\0\1\0\0", b"x" * 99, bytes(1 << 20)])
def test_a_request_without_proper_content_gets_no_answer_and_the_next_one_does(
    met: Met, asked: list[tuple[int, int]], payload: bytes | None
):
    answers = met.ask("sum", payload=payload, attachment=number(1, 1))
    assert answers == [] or asked[0] == (0, 0)
    assert met.ask("sum", payload=ASKED) == [SUM]


def test_a_flood_of_requests_ends_and_others_are_answered(met: Met, asked: list[tuple[int, int]]):
    session = cast("Any", met.bridge.session)
    flood = [
        session.get("sum", payload=ASKED, attachment=number(7, one), timeout=60.0)
        for one in range(10_000)
    ]
    assert met.ask("sum", payload=ASKED, attachment=number(8, 1)) == [SUM]
    answered = sum(any(one.ok is not None for one in replies) for replies in flood)
    assert 0 < answered <= len(asked) <= 10_001


def client_of(met: Met, answer: Callable[[Any], object]) -> Client:
    """A client of a service that a bridge brings from DDS."""
    met.bridge.node("/adder", service_servers=[("/add", ADD.name)])
    met.bridge.serve("add", answer)
    met.bridge.announce("SS/add/example_interfaces§srv§AddTwoInts")
    client = met.node.create_client(ADD, "/add")
    assert client.wait_for_service(30)
    return client


ANSWERS = [b"", b"\0", b"\0\1\0\0", b"\0\1\0\0\1" + bytes(50 << 20)]


@pytest.mark.parametrize("answer", ANSWERS, ids=["empty", "byte", "head", "50 MB"])
def test_an_answer_that_is_none_is_an_error_and_the_next_call_works(met: Met, answer: bytes):
    answers = iter([answer, SUM])
    client = client_of(met, lambda query: query.reply("add", next(answers)))
    if len(answer) > 1_000:  # what follows the fields is passed over
        assert client.call(ADD.Request(a=1, b=2), timeout_sec=30).sum == 1
    else:
        with pytest.raises(CdrError):
            client.call(ADD.Request(a=1, b=2), timeout_sec=30)
    assert client.call(ADD.Request(a=1, b=2), timeout_sec=30).sum == 3


def test_a_refusal_is_told_and_shortened(met: Met):
    client = client_of(met, lambda query: query.reply_err(b"no\x1b[2J" * 100_000))
    with pytest.raises(CallRefusedError) as caught:
        client.call(ADD.Request(), timeout_sec=30)
    assert len(str(caught.value)) < 500


def test_a_call_that_is_never_answered_ends_when_its_caller_waits_no_more(met: Met):
    held: list[Any] = []
    client = client_of(met, held.append)
    with pytest.raises(NoAnswerError):
        client.call(ADD.Request(), timeout_sec=0.2)
    for query in held:
        query.drop()


def test_answers_without_end_are_one_answer(met: Met):
    def flood(query: Any) -> None:  # noqa: ANN401
        for _ in range(10 * REPLIES_WAITING_MAX):
            query.reply("add", SUM)

    client = client_of(met, flood)
    for _ in range(3):
        assert client.call(ADD.Request(a=1, b=2), timeout_sec=30).sum == 3


def test_a_call_ends_soon_when_its_bridge_dies_in_the_middle(met: Met):
    held: list[Any] = []
    client = client_of(met, held.append)
    future = client.call_async(ADD.Request())
    wait_until("it is asked", lambda: bool(held))
    met.bridge.close()
    wait_until("it ends", future.done)
    assert isinstance(future.exception(), NotServedError)
