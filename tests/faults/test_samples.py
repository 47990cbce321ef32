"""Samples as no rmw_zenoh would send them, very large ones, and more than a reader can take."""

from __future__ import annotations

import resource
import subprocess
import sys
import threading
import time
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from studio.ros.attachment import Attachment
from studio.ros.client import (
    ExternalShutdownException,
    HistoryPolicy,
    QoSProfile,
    ReliabilityPolicy,
)
from studio.ros.messages import message
from studio.ros.node.executors import SingleThreadedExecutor
from studio.ros.node.node import Node
from studio.ros.tokens import DataKey
from studio.ros.wire.zenoh import declare_publisher
from tests.support.demos import heard, node_at
from tests.support.wire import PATIENCE_S, open_test_session, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.subscription import Subscription
    from studio.ros.wire.zenoh import Outgoing

pytestmark = pytest.mark.network
STRING = "std_msgs/msg/String"
GOOD, BAD = b"\0\1\0\0\3\0\0\0ok\0", b"\0\1\0\0\3\0\0\0no\0"

# As fast as one process can, until its pipe closes.
FLOOD = """
import sys, threading, time
from studio.ros.client import Context
from studio.ros.messages import message
from studio.ros.node.node import Node
from tests.support.wire import open_test_session

threading.Thread(target=lambda: (sys.stdin.read(), stop.set()), daemon=True).start()
stop = threading.Event()
with open_test_session(sys.argv[1]) as wire:
    context = Context.over(wire)
    node = Node("flood", context=context)
    kind = message("std_msgs/msg/String")
    fast = node.create_publisher(kind, "/fast", 10)
    beat = node.create_publisher(kind, "/beat", 10)
    begin, sent, beats = time.monotonic(), 0, 0
    print("ready", flush=True)
    while not stop.is_set():
        due = int((time.monotonic() - begin) * 20_000)
        for _ in range(min(due - sent, 400)):
            fast.publish(kind(data="x" * 100))
        sent = due
        if (time.monotonic() - begin) * 50 > beats:
            beat.publish(kind(data=str(beats)))
            beats += 1
        time.sleep(0.001)
    context.shutdown()
"""


@pytest.fixture
def node(endpoint: str) -> Generator[Node]:
    with node_at(endpoint) as found:
        yield found


@contextmanager
def strange_sender(endpoint: str, topic: str, type_hash: str | None = None) -> Generator[Outgoing]:
    """A bare publisher on the key of a topic of texts, which may send what it likes."""
    with open_test_session(endpoint) as wire:
        known = wire.types.hash_of(STRING)
        key = str(DataKey(0, topic, STRING, type_hash or known))
        yield declare_publisher(wire.zenoh, key, blocking=True, reliable=True)


def attachment(number: int) -> bytes:
    return Attachment(number, 1, b"strange sender..").pack()


def send_until(sender: Outgoing, came: list[Any], first: int = 1000) -> None:
    """Send good samples until one has come: then all before have, or are lost."""
    number = iter(range(first, first + 1_000_000))

    def send() -> bool:
        sender.put(GOOD, attachment=attachment(next(number)))
        return bool(came)

    wait_until("a good sample comes", send)


def subscribed(node: Node, topic: str) -> tuple[Subscription, list[Any]]:
    came: list[Any] = []
    return node.create_subscription(message(STRING), topic, came.append, 100), came


@pytest.mark.parametrize(
    "malformed",
    [
        b"",
        b"\0",
        b"\0\1\0\0",
        b"\0\1\0\0\xff\xff\xff\xff",
        b"\0\1\0\0\3\0\0\0\xff\xff\0",
        b"x" * 99,
    ],
)
def test_malformed_bytes_are_counted_and_the_next_message_comes(
    endpoint: str, node: Node, malformed: bytes
):
    subscription, came = subscribed(node, "/malformed")
    with strange_sender(endpoint, "/malformed") as sender:
        send_until(sender, came)
        sender.put(malformed, attachment=attachment(1))
        wait_until("it is counted", lambda: subscription.losses.malformed == 1)
        came.clear()
        send_until(sender, came, 2_000_000)
    assert {each.data for each in came} == {"ok"}
    assert "std_msgs/msg/String" in (subscription.losses.reason or "")


@pytest.mark.parametrize(
    "wrong",
    [None, b"", b"x", bytes(32), b"\xff" * 33, b"\x0fsequence_number" + bytes(40), bytes(100_000)],
    ids=["missing", "empty", "short", "below", "negative", "old", "huge"],
)
def test_a_sample_without_a_proper_attachment_is_dropped_and_counted(
    endpoint: str, node: Node, wrong: bytes | None
):
    subscription, came = subscribed(node, "/unattached")
    with strange_sender(endpoint, "/unattached") as sender:
        send_until(sender, came)
        sender.put(BAD, attachment=wrong)
        wait_until("it is refused", lambda: subscription.losses.refused == 1)
    assert subscription.losses.reason
    assert {each.data for each in came} == {"ok"}


def test_a_wrong_hash_is_silence_on_both_sides(endpoint: str, node: Node):
    subscription, came = subscribed(node, "/hashed")
    with (
        strange_sender(endpoint, "/hashed", "RIHS01_" + "0" * 64) as wrong,
        strange_sender(endpoint, "/hashed") as right,
    ):
        wrong.put(GOOD, attachment=attachment(1))
        send_until(right, came)
    assert subscription.losses.malformed == subscription.losses.refused == 0


def test_a_message_of_50_megabytes_arrives_whole(endpoint: str, node: Node):
    pixels = np.arange(50_000_000, dtype=np.uint32).astype(np.uint8)
    image = message("sensor_msgs/msg/Image")
    came = heard(node, "sensor_msgs/msg/Image", "/large", 1)
    # Its sender waits: one that keeps the newest drops a whole message where one part has no room.
    keeps_all = QoSProfile(history=HistoryPolicy.KEEP_ALL)
    with node_at(endpoint, "camera") as camera:
        publisher = camera.create_publisher(image, "/large", keeps_all)
        assert camera.graph.wait_for(lambda: bool(camera.graph.subscriptions("/large")), PATIENCE_S)
        publisher.publish(image(width=10_000, height=5_000, data=pixels))
        wait_until("it comes", lambda: bool(came))
    assert (came[0].width, came[0].height) == (10_000, 5_000)
    assert np.array_equal(came[0].data, pixels)


def test_a_slow_reader_of_20_khz_holds_up_no_other_and_no_memory(endpoint: str):
    """The slow one sleeps 50 ms in each callback; another node of its process hears every beat."""
    beats: list[int] = []

    def dawdle(_: object) -> None:
        time.sleep(0.05)

    def count(said: Any) -> None:  # noqa: ANN401
        beats.append(int(said.data))

    sensor = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
    with flooded(endpoint), node_at(endpoint, "slow") as slow, beside(slow) as quick:
        reader = slow.create_subscription(message(STRING), "/fast", dawdle, sensor)
        other = quick.create_subscription(message(STRING), "/beat", count, 1000)
        wait_until("it is behind", lambda: reader.losses.overwritten > 10_000)
        before_mb, from_beat = peak_mb(), len(beats)
        overwritten = reader.losses.overwritten
        wait_until("much more came", lambda: reader.losses.overwritten > overwritten + 40_000)
        wait_until("it beats on", lambda: len(beats) > from_beat + 20)
        assert peak_mb() - before_mb < 64
        # Zenoh may drop a beat at the sender of so much; here none falls out.
        assert beats == sorted(set(beats))
        assert other.losses.overwritten == 0


@contextmanager
def beside(node: Node) -> Generator[Node]:
    """Another node of the same session and drain, spun by a thread of its own."""
    executor = SingleThreadedExecutor(context=node.context)
    other = Node("quick", context=node.context)
    executor.add_node(other)

    def spin() -> None:
        with suppress(ExternalShutdownException):
            executor.spin()

    thread = threading.Thread(target=spin)
    thread.start()
    try:
        yield other
    finally:
        executor.shutdown()
        thread.join()


def peak_mb() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


@contextmanager
def flooded(endpoint: str) -> Generator[None]:
    process = subprocess.Popen(
        [sys.executable, "-c", FLOOD, endpoint], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    with process:
        try:
            assert process.stdout is not None
            assert process.stdout.readline() == b"ready\n"
            yield
        finally:
            process.kill()
