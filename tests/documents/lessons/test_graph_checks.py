"""Checks of the graph, beside real nodes at a router of this machine."""

from __future__ import annotations

import asyncio
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

import pytest

from studio.course.lessons.checks import read_check
from studio.documents.lessons import frames
from studio.documents.lessons import graph_checks as module
from studio.documents.lessons.graph_checks import GraphChecks
from studio.live.connection.link import WireLink
from studio.ros.client import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from studio.ros.messages import message, service
from studio.ros.types.library import TypeLibrary
from studio.settings import WireChoice
from tests.support.demos import node_at
from tests.support.wire import PATIENCE_S, free_endpoint, router_at

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, Callable
    from typing import Any

    from studio.documents.lessons.verdict import Verdict
    from studio.ros.client import Node

pytestmark = pytest.mark.network

TEMPERATURE = message("sensor_msgs/msg/Temperature")
ADD = service("example_interfaces/srv/AddTwoInts")


class Looking:
    """Asks again and again until a check stands as it is wanted to."""

    def __init__(self, checks: GraphChecks) -> None:
        self.checks = checks

    async def now(self, line: str, *, may_call: bool = True) -> Verdict:
        lines = {line} if may_call else set[str]()
        return (await self.checks.verdicts([read_check(line)], may_call=lines))[line]

    async def until(self, line: str, code: str = "") -> Verdict:
        async with asyncio.timeout(PATIENCE_S):
            while (verdict := await self.now(line)).code != code:  # noqa: ASYNC110 - nothing tells us when
                await asyncio.sleep(0.02)
        assert verdict.ok is (code == "")
        return verdict


@asynccontextmanager
async def looking(endpoint: str) -> AsyncGenerator[Looking]:
    link = await asyncio.to_thread(WireLink, WireChoice("off", (endpoint,)), lambda: None)
    checks = GraphChecks(link)
    try:
        yield Looking(checks)
    finally:
        await checks.close()
        await asyncio.to_thread(link.close)


def with_node(work: Callable[[Looking, Node], Any], types: TypeLibrary | None = None) -> None:
    """Look at the graph of a router with one node."""

    async def begin(endpoint: str, node: Node) -> None:
        async with looking(endpoint) as checks:
            await work(checks, node)

    endpoint = free_endpoint()
    with router_at(endpoint), node_at(endpoint, "sensor", types) as node:
        asyncio.run(begin(endpoint, node))


def test_a_topic_has_its_type_its_ends_its_rate_and_its_qos():
    async def work(checks: Looking, node: Node) -> None:
        assert (await checks.now("topic /temperature has 0 publishers")).ok
        await checks.until("topic /temperature comes at 20 Hz", "publishers.none")
        await checks.until("topic /temperature is of sensor_msgs/Temperature", "topic.none")
        await checks.until("topic /temperature is published reliable", "publishers.none")
        publisher = node.create_publisher(
            TEMPERATURE,
            "/temperature",
            QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT),
        )
        await checks.until("node /sensor runs")
        await checks.until("topic /temperature has 1 publisher")
        found = await checks.until("topic /temperature has 2 publishers", "count.other")
        assert found.found == {"count": "1"}
        await checks.until("topic /temperature is of sensor_msgs/Temperature")
        other = await checks.until("topic /temperature is of std_msgs/String", "type.other")
        assert other.found == {"type": "sensor_msgs/msg/Temperature"}
        await checks.until("topic /temperature is published best_effort volatile")
        qos = await checks.until("topic /temperature is published reliable", "qos.other")
        assert qos.found == {"qos": "best_effort volatile"}
        await checks.until("topic /temperature comes at 20 Hz", "rate.waiting")
        node.create_timer(0.05, lambda: publisher.publish(TEMPERATURE(temperature=21.0)))
        await checks.until("topic /temperature comes at 20 Hz ± 40 %")
        wrong = await checks.until("topic /temperature comes at 1 Hz", "rate.other")
        assert 10 < float(wrong.found["rate"]) < 30
        await checks.until("topic /temperature has 0 subscriptions")
        node.create_subscription(
            TEMPERATURE,
            "/temperature",
            lambda _: None,
            QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL),
        )
        await checks.until("topic /temperature has 1 subscription")
        await checks.until("topic /temperature is subscribed reliable transient_local")
        await checks.until("topic /temperature is subscribed best_effort", "qos.other")

    with_node(work)


def test_a_service_is_called_until_it_answers_as_wanted_and_by_nobody_without_control(
    monkeypatch: pytest.MonkeyPatch,
):
    monkeypatch.setattr(module, "_AGAIN_S", 0.1)
    line = "service /add_two_ints answers {sum: 42} to {a: 41, b: 1}"
    asked: list[int] = []

    async def work(checks: Looking, node: Node) -> None:
        await checks.until(
            "service /add_two_ints is of example_interfaces/AddTwoInts", "service.none"
        )
        await checks.until(line, "service.none")
        wrong = 1

        def add(request: Any, response: Any) -> Any:  # noqa: ANN401 - made at run time
            asked.append(request.a)
            response.sum = request.a + request.b + wrong
            return response

        server = node.create_service(ADD, "/add_two_ints", add)
        await checks.until("service /add_two_ints has 1 server")
        await checks.until("service /add_two_ints is of example_interfaces/AddTwoInts")
        found = await checks.until(line, "answer.other")
        assert found.found == {"answer": '{"sum": 43}'}
        wrong = 0
        await checks.until(line)
        node.destroy_service(server)
        wrong = 2
        node.create_service(ADD, "/add_two_ints", add)
        await checks.until(line, "answer.other")  # what another one answered does not count
        unasked = "service /add_two_ints answers {sum: 3} to {a: 1, b: 2}"
        assert (await checks.now(unasked, may_call=False)).code == "control.none"
        assert 1 not in asked
        failed = await checks.until(
            "service /add_two_ints answers {sum: 3} to {a: one, b: 2}", "answer.failed"
        )
        assert "'one' is no whole number" in failed.found["reason"]

    with_node(work)


def test_a_parameter_has_its_value(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(module, "_AGAIN_S", 0.1)

    async def work(checks: Looking, node: Node) -> None:
        values = {"speed": 0.5, "name": "R2", "on": True, "count": 3}
        for name, value in values.items():
            node.declare_parameter(name, value)
        await checks.until("parameter /nobody speed is 0.5", "node.none")
        await checks.until("parameter /sensor nothing is 0.5", "parameter.none")
        for line in ("speed is 0.50", 'name is "R2"', "on is true", "count is 3"):
            await checks.until(f"parameter /sensor {line}")
        other = await checks.until("parameter /sensor speed is 2", "parameter.other")
        assert other.found == {"value": "0.5"}

    with_node(work)


def test_a_rate_that_is_right_for_a_moment_only_is_not_right():
    async def work(checks: Looking, node: Node) -> None:
        line = "topic /temperature comes at 20 Hz ± 50 %"
        publisher = node.create_publisher(TEMPERATURE, "/temperature", 10)
        await checks.until(line, "rate.waiting")
        timer = node.create_timer(0.05, lambda: publisher.publish(TEMPERATURE()))
        rate = node_rate(checks, "/temperature")
        while not 15 < rate() < 25:
            assert not (await checks.now(line)).ok
        timer.cancel()
        codes: set[str] = set()
        while "rate.silent" not in codes:
            codes.add((await checks.now(line)).code)
        assert "" not in codes

    with_node(work)


def node_rate(checks: Looking, topic: str) -> Callable[[], float]:
    """What the studio measures."""
    link = checks.checks._link  # pyright: ignore[reportPrivateUsage]
    measured = link.measure(topic, 60.0)
    return lambda: measured.flow().rate_hz


def test_the_type_of_a_service_that_is_not_known_is_asked_of_nobody(
    monkeypatch: pytest.MonkeyPatch,
):
    monkeypatch.setattr(module, "_AGAIN_S", 0.1)
    library = TypeLibrary("jazzy")
    library.add_texts({"odd_msgs/srv/Odd": "int64 a\n---\nint64 sum\n"})

    async def work(checks: Looking, node: Node) -> None:
        node.create_service(library.service("odd_msgs/srv/Odd"), "/odd", lambda _, answer: answer)
        line = "service /odd answers {sum: 0} to {a: 1}"
        found = await checks.until(line, "answer.failed")
        assert "odd_msgs/srv/Odd" in found.found["reason"]

    with_node(work, library)


def transform(parent: str, child: str) -> Any:  # noqa: ANN401 - made at run time
    made = message("geometry_msgs/msg/TransformStamped")(child_frame_id=child)
    made.header.frame_id = parent
    made.transform.rotation.w = 1.0
    return made


def test_a_frame_is_gone_when_nobody_sends_it_any_more(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(frames, "_GONE_S", 0.3)
    monkeypatch.setattr(module, "_KEPT_S", 0.3)
    monkeypatch.setattr(frames, "FRAMES_MAX", 3)
    kind = message("tf2_msgs/msg/TFMessage")
    moving, still = "tf leads from odom to base_link", "tf leads from map to odom"

    async def work(checks: Looking, node: Node) -> None:
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        static = node.create_publisher(kind, "/tf_static", kept)
        static.publish(kind(transforms=[transform("map", "/odom")]))
        publisher = node.create_publisher(kind, "/tf", 10)
        many = [transform("a", f"b{number}") for number in range(9)]
        sent = kind(transforms=[transform("/odom", "base_link"), *many])
        timer = node.create_timer(0.05, lambda: publisher.publish(sent))
        await checks.until(moving)
        await checks.until(still)
        await checks.until("tf leads from a to b8", "tf.unknown")
        timer.cancel()
        await checks.until(moving, "tf.unknown")
        await checks.until(still)
        node.destroy_publisher(static)
        await checks.until(still, "tf.unknown")
        await checks.until("topic /tf has 0 subscriptions")
        subscribed = node.count_subscribers
        while subscribed("/tf") > 0:  # the studio lets go, too
            await checks.now("node /sensor runs")

    with_node(work)


def test_frames_lead_from_one_to_another():
    kind = message("tf2_msgs/msg/TFMessage")

    async def work(checks: Looking, node: Node) -> None:
        line = "tf leads from odom to base_link"
        unknown = await checks.until(line, "tf.unknown")
        assert unknown.found["frame"] in {"odom", "base_link"}
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        publisher = node.create_publisher(kind, "/tf_static", kept)
        apart = [transform("map", "odom"), transform("world", "base_link")]
        publisher.publish(kind(transforms=apart))
        await checks.until(line, "tf.unconnected")
        publisher.publish(kind(transforms=[*apart, transform("odom", "world")]))
        await checks.until(line)

    with_node(work)


def test_an_action_is_not_there_and_neither_is_a_router_that_went():
    async def begin() -> None:
        endpoint = free_endpoint()
        with router_at(endpoint) as router:
            async with looking(endpoint) as checks:
                await checks.until("action /fibonacci is of a_package/Fibonacci", "action.none")
                await checks.until("node /sensor runs", "node.none")
                router.close()
                await checks.until("node /sensor runs", "ros.lost")

    asyncio.run(begin())
