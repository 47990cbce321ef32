"""Clouds on their whole way: a node, the wire, the studio as it runs, and a page that counts."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from studio.displays.point_cloud2 import PointCloud2Display
from studio.ros.cdr import Codec
from studio.ros.messages import message
from tests.benchmarks.displays import cloud_message
from tests.benchmarks.report import judge, judge_that, say
from tests.support.bare_page import bare_page, processor_s
from tests.support.demos import node_at
from tests.support.server import running_studio
from tests.support.wire import free_endpoint, router_at, wait_until

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.client import Node
    from tests.support.bare_page import BarePage
    from tests.support.server import RunningStudio

_TYPE: Final = "sensor_msgs/msg/PointCloud2"
_TOPIC: Final = "/points"
_WINDOW: Final = (1280, 800)
_AT_REST_S: Final = 3.0
_VIEW: Final = 'document.querySelector("iframe").contentWindow'
_COUNTS: Final = f"""(() => {{
  window.arrived = 0;
  const {{ messageQueue }} = {_VIEW}.__viserMutable;
  const push = messageQueue.push;
  messageQueue.push = function (...messages) {{
    for (const one of messages) if (one.updates?.points) window.arrived += 1;
    return push.apply(this, messages);
  }};
}})()"""
_CLOUD: Final = """(() => {
  const view = document.querySelector("iframe")?.contentWindow;
  const names = Object.keys(view?.__viserMutable?.nodeRefFromName ?? {});
  return names.some((name) => name.endsWith(".points"));
})()"""
_PICTURES: Final = f"{_VIEW}.__viserTestpoints.rendererInfo.render.frame"


def run() -> None:
    """A third of a million points at 10 Hz, and a million at 5 Hz."""
    _measure(300_000, 10.0, 100)
    _measure(1_000_000, 5.0, 50)


def _measure(points: int, rate_hz: float, count: int) -> None:
    with (
        tempfile.TemporaryDirectory() as scratch,
        router_at(free_endpoint()) as router,
        node_at(router.endpoint.text, "lidar") as node,
        running_studio(
            ["demo", "--no-token", "--connect", router.endpoint.text, "--router", "off"],
            Path(scratch) / "data",
        ) as studio,
    ):
        send = _sender(node, points)
        _show(studio, points)
        with bare_page(f"{studio.origin}/", *_WINDOW) as page:
            wait_until("a cloud in the 3D view", lambda: send() or bool(page.evaluate(_CLOUD)))
            _count(studio, page, send, f"{points:,} points at {rate_hz:g} Hz", rate_hz, count)


def _sender(node: Node, points: int) -> Callable[[], None]:
    """Sends a cloud in the root frame of the rover; as bytes, for it is not what is measured."""
    kind: Any = message(_TYPE)
    publisher = node.create_publisher(kind, _TOPIC, 1)
    one = Codec(kind).decode(cloud_message(points, "intensity").cdr)
    one.header.frame_id = "base_footprint"

    def send() -> None:
        one.header.stamp = node.get_clock().now().to_msg()
        publisher.publish(one)
        time.sleep(0.05)

    return send


def _show(studio: RunningStudio, points: int) -> None:
    """Add the display."""
    with studio.client() as client:
        document = client.get("/api/documents").json()["documents"][0]["id"]
        for command in (
            {"type": "add_display", "kind": PointCloud2Display.KIND, "topic": _TOPIC},
            {"type": "set_display_property", "display": "d1", "name": "Points at most",
             "value": points},
        ):  # fmt: skip
            answer = client.post("/api/commands", json={**command, "document": document})
            assert answer.is_success, answer.text


def _count(
    studio: RunningStudio,
    page: BarePage,
    send: Callable[[], None],
    title: str,
    rate_hz: float,
    count: int,
) -> None:
    time.sleep(_AT_REST_S)
    page.evaluate(_COUNTS)
    before = processor_s(studio.pid), processor_s(page.pid), page.evaluate(_PICTURES)
    began_s = time.perf_counter()
    for number in range(1, count + 1):
        send()
        time.sleep(max(0.0, began_s + number / rate_hz - time.perf_counter()))
    took_s = time.perf_counter() - began_s
    server = (processor_s(studio.pid) - before[0]) / took_s
    browser = (processor_s(page.pid) - before[1]) / took_s
    drawn = (page.evaluate(_PICTURES) - before[2]) / took_s
    time.sleep(_AT_REST_S)
    arrived = int(page.evaluate("arrived"))
    say(f"  {title}: {arrived} of {count} arrived in {took_s:.1f} s, {drawn:.1f} pictures a second")
    say(f"  cores kept busy: {server:.2f} by the studio, {browser:.2f} by the browser")
    judge_that(f"{title}, over the wire: all reach Chromium", holds=arrived >= count)
    judge(f"{title}: the studio's processor", server, at_most=1.0, unit="cores")
