from __future__ import annotations

from dataclasses import dataclass, field

from hypothesis import given
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from studio.outlet import Outlet

GATE, QUEUE = 100, 1000


@dataclass
class Pipe:
    """A transport that takes all and hands it on only when the test reads."""

    pending: list[bytes] = field(default_factory=list[bytes])
    read: list[bytes] = field(default_factory=list[bytes])

    def write(self, data: bytes) -> None:
        self.pending.append(data)

    def pending_bytes(self) -> int:
        return sum(map(len, self.pending))

    def drain(self) -> None:
        self.read += self.pending
        self.pending = []


def outlet_on(pipe: Pipe) -> Outlet:
    return Outlet(pipe, gate_bytes=GATE, queue_bytes=QUEUE)


def test_a_message_goes_out_at_once_while_the_transport_drains():
    pipe = Pipe()
    assert outlet_on(pipe).post(b"hello")
    assert pipe.pending == [b"hello"]


def test_a_slow_client_gets_the_newest_of_each_key_once_and_keyless_ones_all_in_order():
    pipe = Pipe()
    outlet = outlet_on(pipe)
    outlet.post(bytes(GATE + 1))
    for number in range(50):
        assert not outlet.post(b"pose %d" % number, "pose")
        outlet.post(b"event %d" % number)
    outlet.post(b"scan", "scan")
    while not outlet.resume():
        pipe.drain()
    pipe.drain()
    assert pipe.read[1:] == [
        *(b"event %d" % n for n in range(49)),
        b"pose 49",
        b"event 49",
        b"scan",
    ]


def test_a_late_message_is_made_when_it_goes_out():
    pipe = Pipe()
    outlet = outlet_on(pipe)
    outlet.post(bytes(GATE + 1))
    outlet.post(b"then", "state", late=lambda: b"now")
    pipe.drain()
    outlet.resume()
    assert pipe.pending == [b"now"]


def test_a_late_message_with_nothing_to_say_writes_nothing():
    pipe = Pipe()
    outlet = outlet_on(pipe)
    outlet.post(bytes(GATE + 1))
    outlet.post(b"then", "state", late=lambda: b"")
    pipe.drain()
    assert outlet.resume()
    assert pipe.pending == []


def test_what_can_be_made_late_is_not_written_behind_more_than_a_little():
    pipe = Pipe()
    outlet = Outlet(pipe, gate_bytes=GATE, fresh_bytes=10)
    for number in range(9):
        outlet.post(b"pose %d" % number, "pose", late=lambda: b"pose of now")
    outlet.post(b"an answer")
    assert pipe.pending == [b"pose 0", b"pose 1"]
    pipe.drain()
    assert outlet.resume()
    assert pipe.pending == [b"pose of now", b"an answer"]


def test_a_large_message_that_can_be_made_late_is_written_behind_one_as_large():
    pipe = Pipe()
    outlet = Outlet(pipe, gate_bytes=GATE, fresh_bytes=10)
    cloud = bytes(GATE - 20)
    assert outlet.post(cloud, "cloud", late=lambda: cloud)
    assert outlet.post(cloud, "cloud", late=lambda: cloud)
    assert not outlet.post(cloud, "cloud", late=lambda: cloud)


def test_a_client_that_owes_too_many_ordered_messages_is_given_up_once_and_forgotten():
    given_up: list[str] = []
    pipe = Pipe()
    outlet = Outlet(
        pipe, gate_bytes=GATE, queue_bytes=QUEUE, on_hopeless=lambda: given_up.append("bye")
    )
    for _ in range(100):
        outlet.post(bytes(GATE))
    assert given_up == ["bye"]
    assert outlet.closed
    assert not outlet.holds_back


def test_a_slow_client_slows_nobody_and_everyone_gets_the_very_same_bytes():
    slow, fast = Pipe(), Pipe()
    outlets = [outlet_on(slow), outlet_on(fast)]
    sent = [bytes([number]) * GATE for number in range(40)]
    for data in sent:
        for outlet in outlets:
            outlet.post(data, "image")
        fast.drain()
    assert [a is b for a, b in zip(fast.read, sent, strict=True)] == [True] * 40
    assert slow.pending_bytes() <= 2 * GATE
    assert not outlets[0].resume()
    slow.drain()
    assert outlets[0].resume()
    assert slow.pending == [sent[-1]]


def test_an_outlet_that_was_closed_sends_nothing_more():
    pipe = Pipe()
    outlet = outlet_on(pipe)
    outlet.close()
    outlet.close()
    outlet.post(b"anything")
    assert pipe.pending == []


class SlowClient(RuleBasedStateMachine):
    """Whatever is posted and whenever the client reads: order, newest-wins and bounds hold."""

    def __init__(self) -> None:
        super().__init__()
        self.pipe = Pipe()
        self.outlet = outlet_on(self.pipe)
        self.posted: list[tuple[bytes, str | None]] = []

    @precondition(lambda self: not self.outlet.closed)
    @rule(key=st.sampled_from([None, "a", "b"]), size=st.integers(0, 60))
    def post(self, key: str | None, size: int) -> None:
        data = len(self.posted).to_bytes(4, "big") + bytes(size)
        self.posted.append((data, key))
        self.outlet.post(data, key)

    @rule()
    def read(self) -> None:
        self.pipe.drain()
        self.outlet.resume()

    @invariant()
    def the_transport_holds_at_most_the_gate_and_one_message(self) -> None:
        assert self.pipe.pending_bytes() <= GATE + 64

    @invariant()
    def nothing_overtakes(self) -> None:
        arrived = [int.from_bytes(data[:4], "big") for data in self.pipe.read + self.pipe.pending]
        assert arrived == sorted(set(arrived))

    def teardown(self) -> None:
        while not self.outlet.closed and not self.outlet.resume():
            self.pipe.drain()
        if self.outlet.closed:
            return
        self.pipe.drain()
        arrived = set(self.pipe.read)
        assert {data for data, key in self.posted if key is None} <= arrived
        for wanted in ("a", "b"):
            of_key = [data for data, key in self.posted if key == wanted]
            assert not of_key or of_key[-1] in arrived


TestSlowClient = SlowClient.TestCase


@given(st.lists(st.binary(max_size=GATE)))
def test_without_back_pressure_all_arrives_as_sent(messages: list[bytes]):
    pipe = Pipe()
    outlet = outlet_on(pipe)
    for data in messages:
        outlet.post(data)
        pipe.drain()
    assert pipe.read == messages
