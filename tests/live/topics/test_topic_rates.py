"""Rates of topics, measured only while somebody asks: of a source in memory and one at a router."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.live.topics import topic_rates
from studio.ros.node.topic_statistics import Flow
from studio.ros.qos import QoSProfile
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Callable

    from tests.support.topic_worlds import Speaker, World

pytestmark = pytest.mark.network


def publishers(world: World, *topics: str) -> list[Speaker]:
    """Those of some topics, once the source knows them."""
    made = [world.speaker(topic, QoSProfile(depth=10)) for topic in topics]
    wait_until("all", lambda: all(world.source.publishers(one) for one in topics))
    return made


def saying(outs: list[Speaker], holds: Callable[[], bool]) -> Callable[[], bool]:
    """Publishes on all before it looks again."""

    def look() -> bool:
        for out in outs:
            out.say("x" * 1_000)
        return holds()

    return look


def test_nothing_is_measured_before_somebody_asks(world: World):
    publishers(world, "/quiet")

    assert world.source.rates.measured == ()


def test_what_is_published_has_a_rate_and_bytes(world: World):
    outs, source = publishers(world, "/one", "/two"), world.source

    def both_flow() -> bool:
        flows = source.flows(["/one", "/two"])
        return len(flows) == 2 and all(one.rate_hz > 0 for one in flows.values())

    wait_until("rates", saying(outs, both_flow))

    flow = source.flows(["/one"])["/one"]
    assert flow.bytes_per_s == pytest.approx(flow.rate_hz * 1_009, rel=0.01)
    assert source.rates.measured == ("/one", "/two")


def test_nobody_sees_that_a_topic_is_measured(world: World):
    publishers(world, "/one")
    world.source.flows(["/one"])

    assert world.source.rates.measured == ("/one",)
    assert world.depths("/one") == []


@pytest.mark.parametrize("name", ["/nobody", "", "/**", "/on*", "relative", "/a b", "/é"])
def test_what_nobody_publishes_is_not_measured(world: World, name: str):
    publishers(world, "/one")

    assert world.source.flows([name]) == {}
    assert world.source.rates.measured == ()


def test_it_is_let_go_soon_after_the_last_question_and_measured_again_after_the_next(
    world: World, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(topic_rates, "KEPT_S", 0.05)
    outs, source = publishers(world, "/one"), world.source
    assert "/one" in source.flows(["/one"])

    wait_until("its end", saying(outs, lambda: source.rates.measured == ()))

    wait_until("a rate again", saying(outs, lambda: source.flows(["/one"])["/one"].rate_hz > 0))


def test_what_was_measured_of_one_connection_is_forgotten_with_it(world: World):
    outs, source = publishers(world, "/one"), world.source
    wait_until("a rate", saying(outs, lambda: source.flows(["/one"])["/one"].rate_hz > 0))

    world.disconnect()
    assert source.rates.measured == ()
    assert source.flows(["/one"]) == {}

    world.connect()
    wait_until("it anew", lambda: "/one" in source.flows(["/one"]))
    assert source.flows(["/one"])["/one"].age_s is None


def test_no_more_topics_are_measured_than_there_is_room_for(
    world: World, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(topic_rates, "TOPICS_MAX", 2)
    names = [f"/topic_{at}" for at in range(5)]
    publishers(world, *names)

    assert list(world.source.flows(names)) == names[:2]
    assert list(world.source.flows(names)) == names[:2]


def test_the_heaviest_rests_with_what_was_measured_and_the_others_go_on(
    world: World, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(topic_rates, "BYTES_MAX", 1)
    monkeypatch.setattr(topic_rates, "_MEASURED_S", 0.0)
    monkeypatch.setattr(topic_rates, "_REST_S", 600.0)
    heavy, source = publishers(world, "/heavy"), world.source
    assert "/heavy" in source.flows(["/heavy"])

    def rests() -> bool:
        return bool(source.flows(["/heavy"])) and not source.rates.measured

    wait_until("a rest", saying(heavy, rests))

    assert source.flows(["/heavy"])["/heavy"].rate_hz > 0
    assert source.rates.measured == ()


def test_a_topic_that_rested_is_measured_again(world: World, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(topic_rates, "BYTES_MAX", 1)
    monkeypatch.setattr(topic_rates, "_MEASURED_S", 0.0)
    monkeypatch.setattr(topic_rates, "_REST_S", 0.01)
    outs, source = publishers(world, "/heavy"), world.source
    rested: list[bool] = []

    def came_back() -> bool:
        is_known = bool(source.flows(["/heavy"]))
        rested.append(is_known and not source.rates.measured)
        return True in rested and bool(source.rates.measured)

    wait_until("it again", saying(outs, came_back))


class Meter:
    """A topic of which so many bytes come in a second."""

    def __init__(self, bytes_per_s: float) -> None:
        self.is_open, self._bytes_per_s = True, bytes_per_s

    def flow(self) -> Flow:
        return Flow(rate_hz=1.0, bytes_per_s=self._bytes_per_s, age_s=0.0)

    def close(self) -> None:
        self.is_open = False


def test_light_ones_do_not_rest_for_a_heavy_one_that_is_too_new_to():
    meters = {"/light": Meter(1), "/heavy": Meter(1_000)}
    rates = topic_rates.TopicRates(lambda topic, _: meters[topic], bytes_max=100)
    rates.flows(["/light"])
    rates._measured["/light"].began_s -= 60  # pyright: ignore[reportPrivateUsage]
    rates.flows(["/light", "/heavy"])
    assert rates.measured == ("/light", "/heavy")
    rates._measured["/heavy"].began_s -= 60  # pyright: ignore[reportPrivateUsage]
    rates.flows(["/light", "/heavy"])
    assert rates.measured == ("/light",)
