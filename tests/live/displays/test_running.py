from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

from studio.displays.catalogue import display_of_kind
from studio.displays.robot_model import RobotModelDisplay
from studio.errors import DisplayError
from studio.live.displays.display_list import DisplaySpec
from studio.live.displays.running import RunningDisplay
from studio.nodes.robot_state_publisher import LATCHED
from studio.robot.values import Link, Robot
from tests.support.display_messages import NOW_NS, TYPES, pose, received
from tests.support.memory_source import MemorySource

if TYPE_CHECKING:
    from studio.displays.drawing import Pose

POSE = "geometry_msgs/msg/PoseStamped"
SPEC = DisplaySpec("d1", "Pose", "Goal", "/goal")


def running_of(spec: DisplaySpec) -> RunningDisplay:
    return RunningDisplay(spec, display_of_kind(spec.kind)(TYPES))


def goal(x_m: float = 0.0) -> bytes:
    return bytes(received(POSE, {"pose": pose((x_m, 0.0, 0.0))}).cdr)


def here(_frame: str, _stamp_ns: int) -> Pose:
    return (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0)


@pytest.fixture
def source() -> MemorySource:
    return MemorySource()


def draws(running: RunningDisplay) -> bool:
    running.step(here, NOW_NS)
    return running.facts(NOW_NS, shown=True).draws


def test_what_comes_is_drawn(source: MemorySource):
    running = running_of(SPEC)
    source.offer("/goal", POSE)
    running.subscribe(source)
    assert not draws(running)
    source.say("/goal", goal())
    assert draws(running)
    assert (running.lost, running.age_s(NOW_NS + 2_000_000_000)) == (0, 2.0)
    assert running.age_s(NOW_NS - 1) == 0.0  # the clock of this machine was set back


def test_when_time_jumps_what_was_drawn_is_forgotten_also_what_waits(source: MemorySource):
    running = running_of(SPEC)
    source.offer("/goal", POSE)
    running.subscribe(source)
    source.say("/goal", goal())
    assert draws(running)
    running.reset()
    assert not draws(running)
    source.say("/goal", goal(1.0))
    assert draws(running)


def test_what_is_latched_holds_for_all_times(source: MemorySource):
    running = running_of(SPEC)
    source.offer("/goal", POSE, LATCHED)
    running.subscribe(source)
    source.say("/goal", goal())
    assert draws(running)
    running.reset()
    assert draws(running)


def test_who_is_closed_receives_nothing_whoever_has_it_subscribe(source: MemorySource):
    source.offer("/goal", POSE)
    running = running_of(SPEC)
    assert running.subscribe(source)
    assert [one.topic for one in source.opened] == ["/goal"]
    running.close()
    assert not running.subscribe(source)
    assert source.opened == []


def test_a_name_that_is_no_topic_is_told_and_raises_nothing(source: MemorySource):
    running = running_of(replace(SPEC, topic="/no goal"))
    running.subscribe(source)
    topic = running.facts(NOW_NS, shown=True).topic
    assert topic.kind == "refused"
    assert "/no goal" in topic.sentence


def test_those_who_are_gone_are_listened_to_as_before_so_nothing_is_lost(source: MemorySource):
    running = running_of(SPEC)
    goals = source.offer("/goal", POSE, LATCHED)
    running.subscribe(source)
    goals.leave()
    assert not running.subscribe(source)
    source.offer("/goal", POSE, LATCHED)
    assert not running.subscribe(source)
    assert len(source.asked) == 1


def test_a_flood_is_taken_in_parts(source: MemorySource):
    running = running_of(DisplaySpec("d1", "MarkerArray", "All", "/all"))
    kind = "visualization_msgs/msg/MarkerArray"
    source.offer("/all", kind)
    running.subscribe(source)
    empty = bytes(received_array())
    for _ in range(5):
        source.say("/all", empty)
    taken: list[Any] = []
    running.display.take = lambda *one: taken.append(one)  # type: ignore[method-assign]
    running.step(here, NOW_NS, at_once_s=0.0)
    assert len(taken) == 1
    running.step(here, NOW_NS)
    assert len(taken) == 5


def received_array() -> bytes:
    from studio.ros.cdr import codec_of

    kind = TYPES.message("visualization_msgs/msg/MarkerArray")
    return bytes(codec_of(kind).encode(kind()))


def test_a_display_that_fails_says_so_and_raises_nothing(
    source: MemorySource, caplog: pytest.LogCaptureFixture
):
    def fail(_now_ns: int) -> None:
        raise ZeroDivisionError

    running = running_of(SPEC)
    source.offer("/goal", POSE)
    running.subscribe(source)
    running.display.draw = fail  # type: ignore[method-assign, assignment]
    for _ in range(3):
        running.step(here, NOW_NS)
    (status,) = running.facts(NOW_NS, shown=True).statuses
    assert status.sentence == "A message could not be drawn: the terminal says why."
    assert len(caplog.records) == 1


def test_settings_of_another_studio_that_do_not_fit_are_left_out():
    spec = DisplaySpec("d1", "Pose", "Goal", values={"Shape": "Moon", "Alpha": 0.5, "Mood": 1})
    assert running_of(spec).display.values["Alpha"] == 0.5
    with pytest.raises(DisplayError):
        running_of(DisplaySpec("d1", "Moon", "Moon"))


def test_links_of_a_robot_stay_where_they_are_for_as_long_as_is_chosen():
    running = running_of(DisplaySpec("d1", "RobotModel", "Robot"))
    running.set("Update Interval", 0.5)
    display = running.display
    assert isinstance(display, RobotModelDisplay)
    display.show(Robot("r", {"base": Link("base")}))
    at_m = 0.0

    def moving(_frame: str, _stamp_ns: int) -> Pose:
        return (1.0, 0.0, 0.0, 0.0), (at_m, 0.0, 0.0)

    assert running.step(moving, NOW_NS) is not None
    at_m = 1.0
    assert running.step(moving, NOW_NS + 400_000_000) is None
    running.placing.renew()
    assert running.step(moving, NOW_NS + 450_000_000) is not None
    at_m = 2.0
    assert running.step(moving, NOW_NS + 900_000_000) is None
    shown = running.step(moving, NOW_NS + 960_000_000)
    assert shown is not None
    assert shown.poses["base"] == ((1.0, 0.0, 0.0, 0.0), (2.0, 0.0, 0.0))


def test_a_robot_that_is_described_elsewhere_listens_to_no_topic(source: MemorySource):
    spec = DisplaySpec("d1", "RobotModel", "Robot", "/robot_description")
    running = running_of(spec)
    running.subscribe(source)
    assert running.fit is not None
    running.set("Description Source", "Document")
    running.subscribe(source)
    assert running.fit is None
    assert running.facts(NOW_NS, shown=True).types == ()
