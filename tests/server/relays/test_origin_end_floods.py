"""A relay that floods its studio, lies about what came, and sends what is no message."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.server.relays import line as line_module
from studio.server.relays.messages import (
    Arrive,
    Ask,
    AskDownload,
    AskJoin,
    AskTopic,
    Leave,
    OpenLane,
    OpenScene,
    Ping,
    Pong,
    Refresh,
    Taken,
    Up,
    Viewers,
    WantBlobs,
)
from tests.support.hostile_relay import HostileClass, HostileRelay, hostile_relay
from tests.support.loop_watch import Stall, stalls
from tests.support.relays import relayed_class, served_relay, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

STALL_S = 0.25
ANSWER_S = 5.0
"""Of the presenter's command, on a machine that does much else; a quarter of a second otherwise."""
GROWTH_BYTES = 400 << 20
"""The flood is made in this process, too."""


@pytest.fixture(scope="module")
def relay() -> Generator[HostileRelay]:
    with hostile_relay() as made:
        yield made


@pytest.fixture(scope="module")
def shared(
    relay: HostileRelay, tmp_path_factory: pytest.TempPathFactory
) -> Generator[HostileClass]:
    with relayed_class(tmp_path_factory.mktemp("class"), [relay.line]) as room:
        yield HostileClass(room, relay)


@pytest.fixture
def hostile(shared: HostileClass, relay: HostileRelay) -> HostileClass:
    relay.confirms = "honestly"
    wait_until(lambda: shared.room.uplink().state == "there", "the line")
    shared.answers()
    return shared


def rss_bytes() -> int:
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096


Made = Callable[[int], Up]


@contextmanager
def goes_on(hostile: HostileClass) -> Generator[None]:
    """The presenter's page is answered meanwhile; the loop and memory stay within bounds."""
    served, found, before = hostile.room.served, list[Stall](), rss_bytes()
    with served.presenting() as presenter, ExitStack() as watch:
        served.look(lambda: watch.enter_context(stalls(STALL_S, found.append)))
        ended, answered, worst_s = threading.Event(), [0], [0.0]

        def ask() -> None:
            while not ended.is_set():
                began_s = time.monotonic()
                assert presenter.ask("watch", document="rover")["type"] in {"done", "refused"}
                worst_s[0] = max(worst_s[0], time.monotonic() - began_s)
                answered[0] += 1
                time.sleep(0.1)

        asking = threading.Thread(target=ask)
        asking.start()
        try:
            yield
        finally:
            ended.set()
            asking.join()
            served.look(watch.close)
    ours = [one for one in found if "hostile" not in one.what]
    assert not ours, "\n".join(map(str, ours))
    assert answered[0] > 0
    assert worst_s[0] < ANSWER_S
    assert rss_bytes() - before < GROWTH_BYTES


def flood_of(kind: str, hostile: HostileClass) -> Made:
    ticket = hostile.flooder()
    page = hostile.page(ticket)
    text = b'{"type":"get_urdf","document":"rover","request":1}'
    made: dict[str, Made] = {
        "ping": Ping,
        "ask": lambda n: Ask(page, n, text),
        "no page": lambda n: Ask(n + (1 << 40), n, text),
        "join": lambda n: AskJoin(n, f"K{n}", "WRONG1", "", ""),
        "arrive": lambda n: Arrive(n + (1 << 41), "x" * 300),
        "arrive and leave": lambda n: Arrive(n, ticket) if n % 2 else Leave(n - 1),
        "lane": lambda n: OpenLane("rover" if n % 2 else ""),
        "lanes": lambda n: OpenLane(f"no{n % 600}"),
        "scene": lambda n: OpenScene("rover", 1),
        "refresh": lambda n: Refresh(""),
        "topic": lambda n: AskTopic(b"{"),
        "download": lambda n: AskDownload(n, ticket, "rover", "page"),
        "viewers": lambda n: Viewers(n % 50, n % 7),
    }
    return made[kind]


FLOODS = (
    *("ping", "ask", "no page", "join", "arrive", "arrive and leave", "lane", "lanes", "scene"),
    *("refresh", "topic", "download", "viewers"),
)


def flood(hostile: HostileClass, make: Made, count: int) -> None:
    lines = len(hostile.relay.lines)
    for _ in range(count):
        if len(hostile.relay.lines) > lines:  # the origin has had enough, and dialled again
            return
        hostile.relay.say(make(hostile.relay.number()))


@pytest.mark.parametrize("kind", FLOODS)
def test_a_flood_of_messages_leaves_the_presenter_and_the_loop_alone(
    hostile: HostileClass, kind: str
):
    make = flood_of(kind, hostile)
    with goes_on(hostile):
        flood(hostile, make, 300)


@pytest.mark.sweep
@pytest.mark.parametrize("kind", FLOODS)
def test_a_flood_of_a_hundred_thousand_messages_does_neither(hostile: HostileClass, kind: str):
    make = flood_of(kind, hostile)
    with goes_on(hostile):
        flood(hostile, make, 100_000)


@pytest.mark.parametrize("mb", [5, pytest.param(64, marks=pytest.mark.sweep)])
def test_a_message_larger_than_a_relay_has_reason_for_is_not_even_joined(
    hostile: HostileClass, mb: int
):
    with goes_on(hostile):
        for _ in range(4):
            hostile.relay.raw(bytes((mb << 20) - 64))
        hostile.answers()
    line = hostile.room.uplink().line
    assert line is not None
    assert line.refused >= 4


def test_another_relay_goes_on_while_one_floods(tmp_path: Path):
    with (
        hostile_relay() as bad,
        served_relay() as good,
        relayed_class(tmp_path, [bad.line, good.line]) as room,
    ):
        hostile, endpoint = HostileClass(room, bad), good.line.partition("#")[0]
        with room.student("Lea", endpoint) as lea, lea.lane() as lane:
            lane.ask("watch", document="rover")
            flood(hostile, flood_of("ask", hostile), 500)
            assert lane.ask("raise_hand", raised=True)["type"] == "done"
            bad.raw(b"nonsense")
            assert lane.ask("raise_hand", raised=False)["type"] == "done"
        assert room.uplink(endpoint).state == "there"


# Lies about what came


@pytest.mark.parametrize("confirms", ["never", "everything"])
def test_lies_about_what_came_cost_the_origin_a_bounded_memory(
    hostile: HostileClass, confirms: Literal["never", "everything"]
):
    hostile.relay.confirms = confirms
    lines = len(hostile.relay.lines)
    with goes_on(hostile):
        for number in range(60):
            hostile.relay.say(OpenLane("rover"), OpenScene("rover", 1), Ping(number))
            if len(hostile.relay.lines) > lines:
                break
            if confirms == "everything":
                hostile.relay.now.confirm((1 << 64) - 1)
        line = hostile.room.uplink().line
        if line is not None:
            assert line.confirmed_bytes <= line.sent_bytes


def test_a_relay_that_asks_on_and_confirms_nothing_is_given_up(
    hostile: HostileClass, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(line_module, "_OWED_MAX", 2_000)
    hostile.relay.confirms, lines = "never", len(hostile.relay.lines)
    with goes_on(hostile):
        flood(hostile, Ping, 3_000)
        hostile.relay.until_line(lines)


# What is no message


def struct_of(kind: type) -> st.SearchStrategy[Any]:
    fields = msgspec.structs.fields(kind)
    return st.tuples(*(_ANY for _ in fields)).map(lambda given: [kind.__name__, *given])


_LEAF = (
    st.none() | st.booleans() | st.integers(-(1 << 63), (1 << 64) - 1) | st.floats()
    | st.text(max_size=20) | st.binary(max_size=20)
    | st.sampled_from(["", "rover", "rover~x", "!changes graph", "!operations goals", "!changes x"])
)  # fmt: skip
_ANY = st.recursive(_LEAF, lambda inner: st.lists(inner, max_size=3), max_leaves=6)
_KINDS: tuple[type, ...] = (
    *(OpenLane, Refresh, OpenScene, WantBlobs, Arrive, Leave, Viewers, Ask, AskJoin, AskTopic),
    *(AskDownload, Ping, Taken),
)


def well_formed() -> st.SearchStrategy[Up]:
    """Messages whose fields are of their kinds, and of no sense; none that ends it for good."""
    name = st.sampled_from(["", "rover", "rover~x", "~", "!changes graph", "!changes ", "\0", "é"])
    ticket = st.just("") | st.text(max_size=30)
    number = st.integers(0, 1 << 60)
    options = st.lists(st.tuples(st.text(max_size=9), st.text(max_size=9)), max_size=3).map(tuple)
    text = st.binary(max_size=40) | st.just(b'{"type":"subscribe","subscription":1,"topic":"/a"}')
    return st.one_of(
        st.builds(OpenLane, name, ticket),
        st.builds(OpenScene, name, number, ticket),
        st.builds(Refresh, name),
        st.builds(WantBlobs, name, number, st.lists(st.binary(max_size=20), max_size=3).map(tuple)),
        st.builds(Arrive, number, ticket),
        st.builds(Leave, number),
        st.builds(Ask, number, number, text),
        st.builds(AskJoin, number, ticket, ticket, ticket, ticket),
        st.builds(AskTopic, text, ticket),
        st.builds(
            AskDownload, number, ticket, name, st.sampled_from(["page", "series", "x"]), options
        ),
        st.builds(Ping, number),
        st.builds(Viewers, st.integers(0, 9), st.integers(0, 9)),
    )


@given(st.binary(max_size=200) | st.sampled_from(_KINDS[:-1]).flatmap(struct_of) | well_formed())
def send_any(hostile: HostileClass, made: object) -> None:
    lines = len(hostile.relay.lines)
    uplink = hostile.room.uplink()
    data = made if isinstance(made, bytes) else msgspec.msgpack.encode(made)
    hostile.relay.raw(data)
    number = hostile.relay.number()
    hostile.relay.say(Ping(number))

    def is_over() -> bool:
        ended = len(hostile.relay.lines) > lines and uplink.state == "there"
        return ended or any(
            isinstance(one, Pong) and one.sent_ns == number for one in hostile.relay.heard[-50:]
        )

    wait_until(is_over, "an answer, or another line")


def test_whatever_a_relay_sends_is_ignored_or_ends_the_line(
    hostile: HostileClass, caplog: pytest.LogCaptureFixture
):
    with caplog.at_level(logging.ERROR):
        send_any(hostile)
    assert not [one for one in caplog.records if one.levelno >= logging.ERROR]
    assert hostile.room.uplink().state in {"there", "lost"}
