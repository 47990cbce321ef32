# pyright: basic
"""One end of a topic in a process of its own: ours, bare zenoh's, or zenoh-ros2-sdk's.

`python -m tests.benchmarks.wire_process receive|publish KIND PORT RATE_HZ` prints `ready`, and
one line of JSON when it has measured. Every text begins with the nanoseconds at which it was sent.
"""

from __future__ import annotations

import json
import resource
import statistics
import sys
import threading
import time
from typing import TYPE_CHECKING, Any

from studio.ros.attachment import Attachment
from studio.ros.cdr import Codec
from studio.ros.client import Context, SingleThreadedExecutor
from studio.ros.messages import message
from studio.ros.node.node import Node
from studio.ros.qos import QoSProfile
from studio.ros.tokens import DataKey
from studio.ros.wire.zenoh import declare_publisher, declare_subscription, use_few_threads
from tests.support.wire import open_test_session

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.wire.session import WireSession

STRING = "std_msgs/msg/String"
TOPIC = "/measured"
TEXT_BYTES = 500
WARM_UP_S = 0.7
WINDOW_S = 3.0
_STAMP_DIGITS = 20
_TEXT_AT = 8
_GID = b"bare publisher.."


class Meter:
    """What came in one window after the warm-up, and what this process took for it."""

    def __init__(self) -> None:
        self._first_s = 0.0
        self._begin_cpu_s = self._begin_s = 0.0
        self._delays_ms: list[float] = []
        self.done = threading.Event()
        self.figures: dict[str, float] = {}

    def text(self, text: str) -> None:
        """Take note of a text."""
        self.sent(int(text[:_STAMP_DIGITS]))

    def sent(self, sent_ns: int) -> None:
        """Take note of what was sent at a time."""
        now_ns = time.monotonic_ns()
        now_s = now_ns / 1e9
        self._first_s = self._first_s or now_s
        if self.done.is_set() or now_s < self._first_s + WARM_UP_S:
            return
        if not self._begin_s:
            self._begin_s, self._begin_cpu_s = now_s, cpu_s()
        self._delays_ms.append((now_ns - sent_ns) / 1e6)
        if now_s > self._begin_s + WINDOW_S:
            self._finish(now_s)

    def _finish(self, now_s: float) -> None:
        span_s, ordered = now_s - self._begin_s, sorted(self._delays_ms)
        self.figures = {
            "rate_hz": len(ordered) / span_s,
            "cpu": (cpu_s() - self._begin_cpu_s) / span_s,
            "p50_ms": statistics.median(ordered),
            "p95_ms": ordered[int(0.95 * len(ordered))],
        }
        self.done.set()


def cpu_s() -> float:
    """Seconds of processor that this process took, all threads."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def text_now() -> str:
    """A text that says when it was made."""
    return f"{time.monotonic_ns():0{_STAMP_DIGITS}d}".ljust(TEXT_BYTES, ".")


def key_of(wire: WireSession) -> str:
    """The data key of the topic."""
    return str(DataKey(wire.domain, TOPIC, STRING, wire.types.hash_of(STRING)))


def receive_ours(wire: WireSession, meter: Meter, _port: int) -> None:
    """A node whose callback is given decoded messages."""
    _spin(wire, lambda node: _subscribe(node, lambda said: meter.text(said.data), raw=False))
    meter.done.wait()


def receive_ours_raw(wire: WireSession, meter: Meter, _port: int) -> None:
    """A node whose callback is given bytes."""
    _spin(wire, lambda node: _subscribe(node, lambda data: meter.sent(_stamp_of(data)), raw=True))
    meter.done.wait()


def receive_drain(wire: WireSession, meter: Meter, _port: int) -> None:
    """A subscription that nobody takes from: what the drain thread alone costs."""
    context = Context.over(wire)
    subscription = Node("receiver", context=context, enable_rosout=False).create_subscription(
        message(STRING), TOPIC, None, QoSProfile(depth=100), raw=True
    )
    before = subscription.drain

    def drain() -> int:
        taken = before()
        for _ in range(taken):
            meter.sent(time.monotonic_ns())
        return taken

    subscription.drain = drain  # counted there, since nothing is called back
    meter.done.wait()
    context.shutdown()


def receive_bare(wire: WireSession, meter: Meter, _port: int) -> None:
    """Zenoh's own callback, which copies the payload and the attachment."""

    def take(sample: Any) -> None:  # noqa: ANN401
        sample.attachment.to_bytes()
        meter.sent(_stamp_of(sample.payload.to_bytes()))

    kept = wire.zenoh.declare_subscriber(key_of(wire), take)
    meter.done.wait()
    kept.undeclare()


def receive_ring(wire: WireSession, meter: Meter, _port: int) -> None:
    """Zenoh's ring, looked into every 2 ms, and nothing more."""
    incoming = declare_subscription(wire.zenoh, key_of(wire), 4096, reliable=True)
    while not meter.done.is_set():
        time.sleep(0.002)
        while (sample := incoming.try_recv()) is not None:
            assert sample.attachment is not None
            sample.attachment.to_bytes()
            meter.sent(_stamp_of(sample.payload.to_bytes()))
    incoming.undeclare()


def receive_sdk(_wire: WireSession, meter: Meter, port: int) -> None:
    """A subscriber of zenoh-ros2-sdk."""
    import zenoh_ros2_sdk as sdk

    kept = sdk.ROS2Subscriber(
        TOPIC, STRING, lambda said: meter.text(said.data), "string data", router_port=port
    )
    meter.done.wait()
    kept.close()
    sdk.ZenohSession.get_instance().close()


def publisher_ours(wire: WireSession, _port: int) -> Callable[[str], None]:
    """A publisher of a node."""
    kind = message(STRING)
    node = Node("sender", context=Context.over(wire), enable_rosout=False)
    publisher = node.create_publisher(kind, TOPIC, 100)
    return lambda text: publisher.publish(kind(data=text))


def publisher_bare(wire: WireSession, _port: int) -> Callable[[str], None]:
    """A publisher of Zenoh, whose CDR and attachment are packed by struct alone."""
    publisher = declare_publisher(wire.zenoh, key_of(wire), blocking=False, reliable=True)
    head = bytes(Codec(message(STRING)).encode(message(STRING)(data="." * TEXT_BYTES)))[:_TEXT_AT]
    number = 0

    def send(text: str) -> None:
        nonlocal number
        number += 1
        attachment = Attachment(number, time.time_ns(), _GID).pack()
        publisher.put(head + text.encode() + b"\0", attachment=attachment)

    return send


def publisher_sdk(_wire: WireSession, port: int) -> Callable[[str], None]:
    """A publisher of zenoh-ros2-sdk."""
    import zenoh_ros2_sdk as sdk

    publisher = sdk.ROS2Publisher(TOPIC, STRING, "string data", router_port=port)
    return lambda text: publisher.publish(data=text)


RECEIVERS = {
    "ours": receive_ours, "ours-raw": receive_ours_raw, "drain": receive_drain,
    "bare": receive_bare, "ring": receive_ring, "sdk": receive_sdk,
}  # fmt: skip
PUBLISHERS = {"ours": publisher_ours, "bare": publisher_bare, "sdk": publisher_sdk}


def publish(send: Callable[[str], None], rate_hz: int) -> dict[str, float]:
    """Send at a rate, in bursts each millisecond, until stdin closes; measured after warm-up."""
    ended = threading.Event()
    threading.Thread(target=lambda: (sys.stdin.read(), ended.set()), daemon=True).start()
    begin_s, sent = time.monotonic(), 0
    measured_s = measured_cpu_s = 0.0
    measured_from = 0
    while not ended.is_set():
        now_s = time.monotonic()
        due = int((now_s - begin_s) * rate_hz)
        while sent < due:
            send(text_now())
            sent += 1
        if not measured_s and now_s > begin_s + WARM_UP_S:
            measured_s, measured_cpu_s, measured_from = now_s, cpu_s(), sent
        time.sleep(0.001)
    span_s = time.monotonic() - measured_s
    return {"rate_hz": (sent - measured_from) / span_s, "cpu": (cpu_s() - measured_cpu_s) / span_s}


def main(role: str, kind: str, port: int, rate_hz: int) -> None:
    """Run one end; others have Zenoh's threads as they are by default."""
    if kind.startswith(("ours", "drain")):
        use_few_threads()
    with open_test_session(f"tcp/127.0.0.1:{port}") as wire:
        if role == "publish":
            send = PUBLISHERS[kind](wire, port)
            _say("ready")
            figures = publish(send, rate_hz)
        else:
            meter = Meter()
            _say("ready")
            RECEIVERS[kind](wire, meter, port)
            figures = meter.figures
        _say(json.dumps(figures))


def _spin(wire: WireSession, subscribe: Callable[[Node], object]) -> None:
    context = Context.over(wire)
    node = Node("receiver", context=context, enable_rosout=False)
    subscribe(node)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    threading.Thread(target=executor.spin, daemon=True).start()


def _subscribe(node: Node, callback: Callable[[Any], object], *, raw: bool) -> None:
    node.create_subscription(message(STRING), TOPIC, callback, QoSProfile(depth=100), raw=raw)


def _stamp_of(data: bytes) -> int:
    return int(data[_TEXT_AT : _TEXT_AT + _STAMP_DIGITS])


def _say(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4]))
