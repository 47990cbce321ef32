"""The bar of a bag dragged over all of it: how often the 3D view and panels are at the moment.

The bag has 70 s, 52 topics and about 1 GB: a camera, a cloud, a scan, TF of 24 frames at 100 Hz,
joints, an IMU at 200 Hz, a log, diagnostics and many small ones. What is shown: the robot, six
displays, the log, diagnostics, and four topics on the data lane of a page. STUDIO_BAG_S is its
length, STUDIO_DRAG_S how long it is dragged.
"""

from __future__ import annotations

import asyncio
import math
import os
import random
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from studio.bags.recording import RecordedTopic
from studio.bags.writer import BagWriter, Storing
from studio.documents.engine import Engine
from studio.protocol.diagnostics import GetDiagnostics
from studio.protocol.displays import AddDisplay, SetFixedFrame
from studio.protocol.logs import GetLog
from studio.protocol.playback import SeekTime
from studio.protocol.subscriptions import Subscribe
from studio.ros.attachment import Attachment
from studio.ros.cdr import Codec
from studio.ros.node.samples import RawSample
from studio.ros.qos import QoSProfile
from studio.ros.types.convert import from_dict
from studio.settings import Settings
from tests.benchmarks.report import judge, say
from tests.support.display_messages import TYPES
from tests.support.hearers import KeepingHearer
from tests.support.open_documents import opened
from tests.support.recorded_arm import BEGIN_NS, LATCHED, URDF, base_pose, stamp, transform

if TYPE_CHECKING:
    from collections.abc import Mapping

    from tests.support.open_documents import Ear

LENGTH_S: Final = float(os.environ.get("STUDIO_BAG_S", "70"))
DRAGGED_S: Final = float(os.environ.get("STUDIO_DRAG_S", "15"))
PIXELS: Final = 1_000
_SMALL: Final = 41
_ENCODED_HZ: Final = 200
_KINDS: Final = {
    "/robot_description": ("std_msgs/msg/String", 0.0),
    "/tf_static": ("tf2_msgs/msg/TFMessage", 0.0),
    "/map": ("nav_msgs/msg/OccupancyGrid", 0.0),
    "/camera": ("sensor_msgs/msg/Image", 15.0),
    "/cloud": ("sensor_msgs/msg/PointCloud2", 10.0),
    "/scan": ("sensor_msgs/msg/LaserScan", 20.0),
    "/tf": ("tf2_msgs/msg/TFMessage", 100.0),
    "/joint_states": ("sensor_msgs/msg/JointState", 100.0),
    "/odom": ("nav_msgs/msg/Odometry", 50.0),
    "/imu": ("sensor_msgs/msg/Imu", 200.0),
    "/rosout": ("rcl_interfaces/msg/Log", 5.0),
}
DISPLAYS: Final = (
    ("TF", ""),
    ("Map", "/map"),
    ("LaserScan", "/scan"),
    ("PointCloud2", "/cloud"),
    ("Odometry", "/odom"),
    ("Image", "/camera"),
)


def run() -> None:
    """Make the bag and drag its bar."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        bag = write_bench_bag(folder / "drive")
        size = sum(one.stat().st_size for one in bag.iterdir())
        say(f"a bag of {LENGTH_S:.0f} s, {len(_KINDS) + _SMALL} topics, {size / 1e6:.0f} MB")
        asyncio.run(_dragged(bag, folder / "data"))


async def _dragged(bag: Path, data_folder: Path) -> None:
    data_folder.mkdir()
    engine = Engine(Settings(data_folder=data_folder))
    try:
        document, ear = await opened(engine, bag)
        engine.attach(ear)
        hearer = KeepingHearer()
        engine.ros.browser_topics.attach(hearer)
        shown = _Shown(engine, document.id, ear)
        await shown.show()
        for number, (topic, mode) in enumerate(
            (
                ("/camera", "newest"),
                ("/odom", "newest"),
                ("/imu", "every"),
                ("/joint_states", "every"),
            )
        ):
            command: Any = {"subscription": number, "topic": topic, "mode": mode}
            asked = Subscribe(document=document.id, **command)
            engine.ros.browser_topics.carry_out(hearer, asked)
        for settled in (True, False):
            await shown.drag(settled=settled, seconds=DRAGGED_S / (3 if settled else 1))
    finally:
        await engine.close()


class _Shown:
    """A document with displays and panels, and its bar."""

    def __init__(self, engine: Engine, document: str, ear: Ear) -> None:
        self._engine, self._document, self._ear = engine, document, ear

    async def ask(self, command: Any) -> None:  # noqa: ANN401 - any command
        asked = command.model_copy(update={"document": self._document})
        await self._engine.execute(asked, self._ear)

    async def show(self) -> None:
        """Show all that follows the bar."""
        await self.ask(SetFixedFrame(frame="map"))
        for kind, topic in DISPLAYS:
            await self.ask(AddDisplay(kind=kind, topic=topic))
        await self.ask(SeekTime(at_s=1.0))
        await self.ask(GetLog())
        await self.ask(GetDiagnostics())

    async def drag(self, *, settled: bool, seconds: float) -> None:
        """Move the bar to and fro, a step once the one before is drawn and panels have asked."""
        took_s: list[float] = []
        hand = random.Random(1)
        until_s, pixel, pace = time.perf_counter() + seconds, 0.0, 7.0
        while (began_s := time.perf_counter()) < until_s:
            pixel += pace * hand.uniform(0.2, 1.8)
            if not 0 < pixel < PIXELS:
                pace, pixel = -pace, max(0.0, min(PIXELS, pixel))
            await self.ask(SeekTime(at_s=pixel / PIXELS * LENGTH_S, settled=settled))
            await self.ask(GetLog(after=0 if settled else 1 << 30))
            await self.ask(GetDiagnostics())
            took_s.append(time.perf_counter() - began_s)
            self._ear.events = self._ear.events[-200:]
            await asyncio.sleep(0)
        took_s.sort()
        rate_hz = len(took_s) / sum(took_s)
        what = "settled each time" if settled else "while it is dragged"
        say(
            f"{what}: {rate_hz:.0f} Hz, median {took_s[len(took_s) // 2] * 1e3:.1f} ms, "
            f"of 100 the 95th {took_s[len(took_s) * 95 // 100] * 1e3:.1f} ms"
        )
        if not settled:
            judge(
                "a step of the bar until the 3D view and panels are there",
                1e3 / rate_hz,
                at_most=50,
            )


def write_bench_bag(
    folder: Path, storing: Storing | None = None, rates_hz: Mapping[str, float] | None = None
) -> Path:
    """Write the bag, the same each time, and return its folder.

    Args:
        folder: Is not there yet.
        storing: How it is written.
        rates_hz: Of topics that are to come at others than usual.
    """
    rates_hz = rates_hz or {}
    kinds = {name: (kind, rates_hz.get(name, rate)) for name, (kind, rate) in _KINDS.items()}
    kinds |= {f"/small_{number}": ("std_msgs/msg/Float64", 10.0) for number in range(_SMALL)}
    with BagWriter(folder, TYPES, storing) as writer:
        numbers: dict[str, int] = {}
        for name, (kind, rate_hz) in kinds.items():
            qos = QoSProfile(depth=10) if rate_hz else LATCHED
            topic = RecordedTopic(name, kind, TYPES.hash_of(kind), (qos,))
            numbers[name] = writer.add_topic(topic)
        due = sorted(
            (number / rate_hz if rate_hz else 0.0, name)
            for name, (_, rate_hz) in kinds.items()
            for number in range(max(1, round(LENGTH_S * rate_hz)))
        )
        payloads = _Payloads()
        for at_s, name in due:
            at_ns = BEGIN_NS + round(at_s * 1e9)
            payload = payloads.of(name, kinds[name][0], at_s)
            writer.write(numbers[name], RawSample(payload, Attachment(0, at_ns, bytes(16)), at_ns))
    return folder


class _Payloads:
    """The bytes of each message; the noise of a picture is made once.

    What comes more often than 200 times a second says the same for 5 ms: encoding takes the most
    time of all.
    """

    def __init__(self) -> None:
        self._codecs: dict[str, Codec] = {}
        self._last: dict[str, tuple[int, bytes]] = {}
        self._noise = random.Random(2).randbytes(640 * 480 * 3)

    def of(self, name: str, kind: str, at_s: float) -> bytes:
        """Return a message of a topic at a time."""
        step = math.floor(at_s * _ENCODED_HZ)
        last = self._last.get(name)
        if last is None or last[0] != step:
            last = self._last[name] = step, self._encoded(name, kind, at_s)
        return last[1]

    def _encoded(self, name: str, kind: str, at_s: float) -> bytes:
        codec = self._codecs.get(kind)
        if codec is None:
            codec = self._codecs[kind] = Codec(TYPES.message(kind))
        fields = self._large(name) or _FIELDS.get(name, _small)(at_s)
        if hasattr(TYPES.message(kind)(), "header"):
            fields = {"header": {"frame_id": "base", "stamp": stamp(at_s)}, **fields}
        return bytes(codec.encode(from_dict(TYPES.message(kind), fields)))

    def _large(self, name: str) -> dict[str, Any]:
        if name == "/camera":
            size = {"height": 480, "width": 640, "step": 1920, "encoding": "rgb8"}
            return {**size, "data": self._noise}
        return _cloud(self._noise) if name == "/cloud" else {}


def _small(at_s: float) -> dict[str, Any]:
    return {"data": at_s}


def _described(_: float) -> dict[str, Any]:
    return {"data": URDF}


def _static(_: float) -> dict[str, Any]:
    return {"transforms": [transform("upper", "tip", 0.0, 0.5)]}


def _map(_: float) -> dict[str, Any]:
    about = {"resolution": 0.05, "width": 1_000, "height": 1_000}
    return {"header": {"frame_id": "map"}, "info": about, "data": [0] * 1_000_000}


def _scan(at_s: float) -> dict[str, Any]:
    beams = {"angle_min": -2.0, "angle_max": 2.0, "angle_increment": 4 / 1080, "range_max": 10.0}
    return {**beams, "ranges": [2.0 + math.sin(at_s + beam / 50) for beam in range(1080)]}


def _tf(at_s: float) -> dict[str, Any]:
    x, y, yaw = base_pose(at_s)
    parts = (transform("base", f"part_{number}", at_s, yaw=at_s + number) for number in range(22))
    moved = transform("map", "base", at_s, x, y, yaw)
    return {"transforms": [moved, transform("base", "upper", at_s, yaw=yaw), *parts]}


def _joints(at_s: float) -> dict[str, Any]:
    return {"name": ["shoulder"], "position": [math.sin(at_s)]}


def _odom(at_s: float) -> dict[str, Any]:
    x, y, _ = base_pose(at_s)
    pose = {"pose": {"position": {"x": x, "y": y}, "orientation": {"w": 1.0}}}
    return {"header": {"frame_id": "map", "stamp": stamp(at_s)}, "pose": pose}


def _imu(at_s: float) -> dict[str, Any]:
    return {"angular_velocity": {"z": at_s}}


def _line(at_s: float) -> dict[str, Any]:
    return {"stamp": stamp(at_s), "level": 20, "name": "arm", "msg": f"at {at_s:.1f}"}


_FIELDS: Final = {
    "/robot_description": _described,
    "/tf_static": _static,
    "/map": _map,
    "/scan": _scan,
    "/tf": _tf,
    "/joint_states": _joints,
    "/odom": _odom,
    "/imu": _imu,
    "/rosout": _line,
}


def _cloud(noise: bytes) -> dict[str, Any]:
    fields = [
        {"name": name, "offset": 4 * place, "datatype": 7, "count": 1}
        for place, name in enumerate("xyz")
    ]
    count = 16_000
    size = {"height": 1, "width": count, "point_step": 12, "row_step": 12 * count}
    return {"fields": fields, **size, "data": noise[: 12 * count], "is_dense": True}
