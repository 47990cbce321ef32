# pyright: basic
"""One end of a recording in a process of its own: the sender, our recorder, or bare libraries.

`python -m tests.benchmarks.recording_process send|ours|mcap|rosbags ENDPOINT FOLDER`. A recorder
prints `ready`, measures once data flows, and prints one line of JSON after it closed its bag.
"""

from __future__ import annotations

import json
import queue
import resource
import struct
import sys
import threading
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from studio.ros.node.context import Context
from studio.ros.node.node import Node
from studio.ros.qos import QoSProfile
from studio.ros.tokens import DataKey
from tests.benchmarks.report import say
from tests.support.wire import open_test_session

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.wire.zenoh import Declaration

SMALL, LARGE = "/small", "/large"
KINDS = {SMALL: "std_msgs/msg/String", LARGE: "sensor_msgs/msg/Image"}
SMALL_HZ, LARGE_HZ = 1_000, 30
SMALL_BYTES, LARGE_BYTES = 200, 6_220_800
WARM_UP_S, WINDOW_S = 1.0, 6.0
RECORDERS = ("ours", "mcap", "rosbags")


def cpu_s() -> float:
    """Processor time of this process, of user and system."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def send(endpoint: str) -> None:
    """Send both topics by bare publishers until the input ends; print how many of each."""
    wire = open_test_session(endpoint)
    context = Context.over(wire, owns_wire=True)
    node = Node("sender", context=context)
    made = {
        topic: node.create_publisher(wire.types.message(kind), topic, QoSProfile(depth=100))
        for topic, kind in KINDS.items()
    }
    payloads = {SMALL: bytes(SMALL_BYTES), LARGE: bytes(LARGE_BYTES)}
    sent = dict.fromkeys(KINDS, 0)
    over = threading.Event()
    threading.Thread(target=lambda: (sys.stdin.read(), over.set()), daemon=True).start()
    say("ready")
    time.sleep(WARM_UP_S)  # a recorder finds a topic first, a bare subscriber knows it
    begin_s = time.monotonic()
    while not over.is_set():
        past_s = time.monotonic() - begin_s
        for topic, rate_hz in ((SMALL, SMALL_HZ), (LARGE, LARGE_HZ)):
            while sent[topic] < past_s * rate_hz:
                made[topic].publish(payloads[topic])
                sent[topic] += 1
        time.sleep(0.001)
    say(json.dumps(sent))
    time.sleep(0.5)
    context.shutdown()


class Window:
    """What this process takes while data flows."""

    def __init__(self) -> None:
        self._begin: tuple[float, float] | None = None

    def measure(self, has_begun: Callable[[], bool]) -> float:
        """Give the processor's share of one window."""
        while not has_begun():
            time.sleep(0.01)
        time.sleep(WARM_UP_S)
        begin_s, begin_cpu_s = time.monotonic(), cpu_s()
        time.sleep(WINDOW_S)
        return (cpu_s() - begin_cpu_s) / (time.monotonic() - begin_s)


def record(endpoint: str, folder: Path) -> None:
    """Record by ours."""
    from studio.nodes.bag_recorder import BagRecorder, RecordSettings
    from studio.nodes.recorded_topics import TopicChoice

    context = Context.over(open_test_session(endpoint), owns_wire=True)
    node = Node("recorder", context=context)
    settings = RecordSettings(topics=TopicChoice(topics=frozenset(KINDS)))
    recorder = BagRecorder(node, folder, settings, lambda _: None)
    say("ready")
    share = Window().measure(lambda: any(one.count for one in recorder.counts()))
    sys.stdin.read()
    time.sleep(0.5)
    written = recorder.close()
    counts = {one.name: one.count for one in recorder.counts()}
    lost = sum(one.lost for one in recorder.counts())
    say(json.dumps({"cpu": share, "lost": lost, "written": written.messages, **counts}))
    context.shutdown()


def record_bare(library: str, endpoint: str, folder: Path) -> None:
    """Record as a program that knows zenoh and a library would: a callback, a queue, a thread."""
    wire = open_test_session(endpoint)
    came: queue.SimpleQueue[Any] = queue.SimpleQueue()
    counts = dict.fromkeys(KINDS, 0)

    def subscribe(topic: str) -> Declaration:
        def callback(sample: Any) -> None:  # noqa: ANN401 - of zenoh, which has its own door
            attachment = struct.unpack("<qqB16s", sample.attachment.to_bytes())
            came.put((topic, sample.payload.to_bytes(), attachment[:2], time.time_ns()))

        key = DataKey(
            0, topic, KINDS[topic], wire.profile.type_hash(wire.types.hash_of(KINDS[topic]))
        )
        return wire.zenoh.declare_subscriber(str(key), callback)

    subscribers = [subscribe(topic) for topic in KINDS]
    write, close = {"mcap": by_mcap, "rosbags": by_rosbags}[library](folder)

    def run() -> None:
        while (item := came.get()) is not None:
            counts[item[0]] += 1
            write(*item)

    writing = threading.Thread(target=run)
    writing.start()
    say("ready")
    share = Window().measure(lambda: any(counts.values()))
    sys.stdin.read()
    time.sleep(0.5)
    for one in subscribers:
        one.undeclare()
    came.put(None)
    writing.join()
    close()
    say(json.dumps({"cpu": share, "lost": 0, "written": sum(counts.values()), **counts}))
    wire.close()


def by_mcap(folder: Path) -> tuple[Callable[..., None], Callable[[], object]]:
    """Write with mcap, without compression, as ours and rosbag2 do."""
    from mcap.writer import CompressionType, Writer

    folder.mkdir()
    file = (folder / "bag_0.mcap").open("wb")
    writer = Writer(file, compression=CompressionType.NONE)
    writer.start("ros2")
    channels = {
        topic: writer.register_channel(topic, "cdr", writer.register_schema(kind, "ros2msg", b""))
        for topic, kind in KINDS.items()
    }

    def write(topic: str, payload: bytes, sent: tuple[int, int], at_ns: int) -> None:
        writer.add_message(channels[topic], at_ns, payload, sent[1], sent[0])

    return write, lambda: (writer.finish(), file.close())


def by_rosbags(folder: Path) -> tuple[Callable[..., None], Callable[[], object]]:
    """Write with rosbags, into an mcap."""
    from rosbags.rosbag2 import StoragePlugin, Writer

    writer = Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP)
    writer.open()
    channels = {
        topic: writer.add_connection(topic, kind, msgdef="", rihs01="RIHS01_")
        for topic, kind in KINDS.items()
    }

    def write(topic: str, payload: bytes, _sent: tuple[int, int], at_ns: int) -> None:
        writer.write(channels[topic], at_ns, payload)

    return write, writer.close


if __name__ == "__main__":
    role, at, where = sys.argv[1], sys.argv[2], Path(sys.argv[3])
    if role == "send":
        send(at)
    elif role == "ours":
        record(at, where)
    else:
        record_bare(role, at, where)
