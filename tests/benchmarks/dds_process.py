"""One end of a topic in a process of its own: `python -m ... studio|zenoh|dds|router ENDPOINT`.

Each line of stdin has a method of the role done, as in `tests.support.dds_robot`. Messages carry
when they were sent, ns of the monotonic clock, which is one for all of a machine, and a number.
"""

from __future__ import annotations

import json
import math
import sys
import threading
import time
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from studio.ros.attachment import packed
from studio.ros.cdr import codec_of
from studio.ros.client import Context
from studio.ros.messages import message
from studio.ros.node.node import Node
from studio.ros.node.publisher import Publisher
from studio.ros.node.raw_subscription import RawSubscription
from studio.ros.qos import QoSProfile, ReliabilityPolicy
from studio.ros.tokens import EndpointKind, EndpointToken, NodeToken
from studio.ros.types.convert import from_dict
from studio.ros.wire.endpoints import parse_endpoint
from studio.ros.wire.router import start_router
from studio.ros.wire.session import open_session
from studio.ros.wire.settings import WireSettings
from studio.ros.wire.zenoh import declare_token, use_few_threads
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.node.samples import RawSample
    from studio.ros.wire.session import WireSession
    from studio.ros.wire.zenoh import Declaration

_FAR: Final = {"transport/shared_memory/enabled": "false"}
"""A robot is another machine: between sessions of one, Zenoh sends pictures by shared memory."""
_STAMP_DIGITS: Final = 20
_NUMBER_DIGITS: Final = 10
_STAMPED: Final = "0" * (_STAMP_DIGITS + _NUMBER_DIGITS)
STRING: Final = "std_msgs/msg/String"
_KINDS: Final = ((EndpointKind.PUBLISHER, 0), (EndpointKind.SUBSCRIPTION, 1))
_NOTHING: Final = dict.fromkeys(("came", "lost", "twice", "a_read"), 0.0)
_PUBLISHES: Final = 1_000
_ROUNDS: Final = 201


@dataclass(frozen=True)
class Load:
    """What is sent; the stamped text begins at byte `stamp_at` of the CDR."""

    topic: str
    type_name: str
    rate_hz: float
    depth: int
    is_reliable: bool
    stamp_at: int
    values: dict[str, Any]

    @property
    def qos(self) -> QoSProfile:
        """Of publisher and subscription."""
        policy = ReliabilityPolicy
        reliability = policy.RELIABLE if self.is_reliable else policy.BEST_EFFORT
        return QoSProfile(depth=self.depth, reliability=reliability)

    def cdr(self) -> bytearray:
        """A message without its time and number."""
        kind = message(self.type_name)
        return bytearray(codec_of(kind).encode(from_dict(kind, self.values)))

    def stamp(self, cdr: bytearray, number: int) -> None:
        """Write time and number into a message."""
        text = f"{time.monotonic_ns():0{_STAMP_DIGITS}d}{number:0{_NUMBER_DIGITS}d}"
        cdr[self.stamp_at : self.stamp_at + len(text)] = text.encode()

    def read(self, cdr: bytes) -> tuple[int, int]:
        """Time and number of a message."""
        middle = self.stamp_at + _STAMP_DIGITS
        return int(cdr[self.stamp_at : middle]), int(cdr[middle : middle + _NUMBER_DIGITS])


_PICTURE: Final = {
    "header": {"frame_id": _STAMPED},
    "width": 1920,
    "height": 1080,
    "encoding": "rgb8",
    "step": 1920 * 3,
    "data": bytes(1920 * 1080 * 3),
}
_IMAGE: Final = "sensor_msgs/msg/Image"
LOADS: Final = {
    "small": Load("/small", STRING, 1000, 100, True, 8, {"data": _STAMPED}),
    "image": Load("/image", _IMAGE, 30, 10, True, 16, _PICTURE),
    "image, best effort": Load("/image_effort", _IMAGE, 30, 10, False, 16, _PICTURE),
}


class Sender(ABC):
    """Sends one load after the other, each at its rate."""

    def __init__(self) -> None:
        self._thread: threading.Thread | None = None
        self._ended = threading.Event()
        self._sent = 0

    def send(self, load: str) -> None:
        """Begin to send, until `stop`."""
        self._ended.clear()
        self._sent = 0
        words = (LOADS[load], self.publisher(LOADS[load]))
        self._thread = threading.Thread(target=self._run, args=words, daemon=True)
        self._thread.start()

    def stop(self) -> int:
        """End it; how many were sent."""
        self._ended.set()
        assert self._thread is not None
        self._thread.join()
        return self._sent

    @abstractmethod
    def publisher(self, load: Load) -> Callable[[bytearray], object]:
        """Make what sends CDR on the load's topic."""

    def _run(self, load: Load, publish: Callable[[bytearray], object]) -> None:
        cdr, begin_s = load.cdr(), time.monotonic()
        while not self._ended.is_set():
            time.sleep(max(0.0, begin_s + self._sent / load.rate_hz - time.monotonic()))
            load.stamp(cdr, self._sent)
            publish(cdr)
            self._sent += 1


class ZenohSender(Sender):
    """A node of rmw_zenoh, as the studio makes them."""

    def __init__(self, wire: WireSession) -> None:
        super().__init__()
        self._node = Node("sender", context=Context.over(wire), enable_rosout=False)
        self._shown: list[Declaration] = []

    def publisher(self, load: Load) -> Callable[[bytearray], object]:
        """Of rmw_zenoh."""
        return self._node.create_publisher(message(load.type_name), load.topic, load.qos).publish

    def many(self, nodes: int, ends: int) -> None:
        """Show so many nodes with so many publishers, and as many subscriptions, each."""
        wire = self._node.context.wire
        known, qos = wire.types.hash_of(STRING), QoSProfile(depth=10)
        for number in range(nodes):
            node = NodeToken(wire.domain, wire.zid, wire.next_id(), "/", f"node_{number}")
            self._shown.append(declare_token(wire.zenoh, str(node)))
            for kind, group in _KINDS:
                for end in range(ends):
                    topic = topic_of(number + group, end)
                    token = EndpointToken(node, wire.next_id(), kind, topic, STRING, known, qos)
                    self._shown.append(declare_token(wire.zenoh, str(token)))


class DdsSender(Sender):
    """A node of a robot on DDS."""

    def __init__(self, domain: int) -> None:
        from tests.support.dds_node import DdsProcess

        super().__init__()
        self._process = DdsProcess("jazzy", domain)
        self._node = self._process.node("sender")
        threading.Thread(target=self._process.run, daemon=True).start()

    def publisher(self, load: Load) -> Callable[[bytearray], object]:
        """Of Cyclone DDS."""
        kind = self._process.types.message(load.type_name)
        made: list[Any] = []
        self._process.ask(
            lambda: made.append(self._node.create_publisher(kind, load.topic, load.qos))
        )
        wait_until("a publisher is made", lambda: bool(made))
        return lambda cdr: made[0].publish_cdr(bytes(cdr))

    def many(self, nodes: int, ends: int) -> None:
        """Have so many nodes with so many publishers, and as many subscriptions, each."""
        kind = self._process.types.message(STRING)

        def make() -> None:
            for node in range(nodes):
                made = self._process.node(f"node_{node}")
                for end in range(ends):
                    made.create_publisher(kind, topic_of(node, end), 10)
                    made.create_subscription(kind, topic_of(node + 1, end), lambda _: None, 10)

        self._process.ask(make)


def topic_of(node: int, end: int) -> str:
    """A topic of one of many nodes."""
    return f"/group_{node}/topic_{end}"


class Receiver:
    """The studio's subscription, which takes bytes in the thread that empties the rings."""

    def __init__(self, wire: WireSession) -> None:
        self._wire = wire
        self._node = Node("studio", context=Context.over(wire), enable_rosout=False)
        self._graph = self._node.graph
        self._load = LOADS["small"]
        self._subscription: RawSubscription | None = None
        self._came: list[tuple[int, int]] = []
        self._batches = 0

    def subscribe(self, load: str) -> None:
        """Hear this load, and no other."""
        if self._subscription is not None:
            self._subscription.close()
        self._load = one = LOADS[load]
        self._came = []
        self._subscription = RawSubscription(
            self._node, one.topic, one.type_name, None, one.qos, self._take
        )

    def count(self) -> int:
        """How many came since `begin`."""
        return len(self._came)

    def begin(self) -> None:
        """Measure from now on."""
        self._came, self._batches = [], 0

    def figures(self) -> dict[str, float]:
        """What came since `begin`; delays are endless where nothing did, which happens over DDS."""
        came, batches = self._came, self._batches
        self._came = []
        delays = sorted(delay for delay, _ in came)
        numbers = [number for _, number in came]
        if not came:
            return {**dict.fromkeys(("p50_ms", "p95_ms", "p99_ms", "max_ms"), math.inf), **_NOTHING}
        due = max(numbers) - min(numbers) + 1
        return {
            "p50_ms": delays[len(delays) // 2] / 1e6,
            "p95_ms": delays[int(0.95 * len(delays))] / 1e6,
            "p99_ms": delays[int(0.99 * len(delays))] / 1e6,
            "max_ms": delays[-1] / 1e6,
            "came": len(came),
            "lost": due - len(set(numbers)),
            "twice": len(numbers) - len(set(numbers)),
            "a_read": len(came) / max(1, batches),
        }

    def ends_shown(self) -> int:
        """How many publishers and subscriptions of the many nodes the graph has."""
        graph = self._graph
        names = [name for name, _ in graph.topics() if name.startswith("/group_")]
        ends = (one for name in names for one in graph.publishers(name) + graph.subscriptions(name))
        return sum(one.node.path.startswith("/node_") for one in ends)

    def wait_ends(self, count: int) -> float:
        """Wait for so many in the graph; when they were there, s of the monotonic clock."""
        assert self._graph.wait_for(lambda: self.ends_shown() >= count, 60.0), self.ends_shown()
        return time.monotonic()

    def publish_costs(self) -> dict[str, float]:
        """Nanoseconds of a publication that nobody hears, with and without a look at the side.

        Of this thread's processor, so that others on the machine count less.
        """
        with_side = self._node.create_publisher(message(STRING), "/unheard", 10)
        without = _Sideless(with_side.endpoint, message(STRING))
        payload = bytes(LOADS["small"].cdr())
        found: dict[str, list[float]] = {"with": [], "without": []}
        for _ in range(_ROUNDS):
            for name, one in (("without", without), ("with", with_side)):
                begin_ns = time.thread_time_ns()
                for _ in range(_PUBLISHES):
                    one.send(payload)
                found[name].append((time.thread_time_ns() - begin_ns) / _PUBLISHES)
        return {name: sorted(values)[_ROUNDS // 2] for name, values in found.items()}

    def is_bridged(self) -> bool:
        """Whether a bridge of this domain is met."""
        return self._wire.bridges.is_used

    def _take(self, samples: list[RawSample], _count: int, _size: int) -> None:
        now_ns, read = time.monotonic_ns(), self._load.read
        self._batches += 1
        for one in samples:
            sent_ns, number = read(one.payload)
            self._came.append((now_ns - sent_ns, number))


class _Sideless(Publisher):
    """A publisher as it was before there were bridges."""

    def send(self, payload: bytes | bytearray) -> None:
        """Send without a look at the half for bridges."""
        with self._lock:
            outgoing = self._outgoing
            assert outgoing is not None
            self._sequence = number = self._sequence + 1
            outgoing.put(payload, attachment=packed(number, time.time_ns(), self._gid))


def _role(name: str, endpoint: str) -> object:
    if name == "router":
        return start_router(parse_endpoint(endpoint))
    if name == "dds":
        return DdsSender(0)
    use_few_threads()
    wire = open_session(WireSettings(connect=(endpoint,), overrides=_FAR))
    return Receiver(wire) if name == "studio" else ZenohSender(wire)


def _say(what: str, **values: object) -> None:
    sys.stdout.write(json.dumps({"what": what, **values}) + "\n")
    sys.stdout.flush()


def main(name: str, endpoint: str) -> None:
    """Do what each line says, until there are no more."""
    began_s = time.monotonic()
    role = _role(name, endpoint)
    _say("ready", at_s=began_s)
    for line in sys.stdin:
        told = json.loads(line)
        number, work = told.pop("id"), getattr(role, told.pop("do"))
        _say("done", id=number, answer=work(**told))


if __name__ == "__main__":
    main(*sys.argv[1:])
