from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any

import pytest

from studio.displays.robot_model import RobotModelDisplay
from studio.errors import DisplayError, RosNameError
from studio.live.displays.display_list import DisplaySpec
from studio.live.displays.running import RunningDisplay
from studio.robot.values import Link, Robot
from tests.support.display_messages import NOW_NS, TYPES, pose, received
from tests.support.heard_topics import HeardTopics, publisher

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.live.displays.placing import Pose
    from studio.ros.graph.endpoints import GraphEndpoint

POSE = "geometry_msgs/msg/PoseStamped"
SPEC = DisplaySpec("d1", "Pose", "Goal", "/goal")


def goal(x_m: float = 0.0) -> bytes:
    return bytes(received(POSE, {"pose": pose((x_m, 0.0, 0.0))}).cdr)


def nobody(_topic: str) -> Sequence[GraphEndpoint]:
    return ()


def somebody(_topic: str) -> Sequence[GraphEndpoint]:
    return (publisher(POSE),)


def latched(_topic: str) -> Sequence[GraphEndpoint]:
    return (publisher(POSE, latched=True),)


def here(_frame: str, _stamp_ns: int) -> Pose:
    return (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0)


@pytest.fixture
def heard() -> HeardTopics:
    return HeardTopics()


def draws(running: RunningDisplay) -> bool:
    running.step(here, NOW_NS)
    return running.facts(NOW_NS, shown=True).draws


def test_what_comes_is_drawn(heard: HeardTopics):
    running = RunningDisplay(SPEC, TYPES)
    running.listen(heard, somebody)
    assert not draws(running)
    heard.say("/goal", goal())
    assert draws(running)
    assert (running.lost, running.age_s(NOW_NS + 2_000_000_000)) == (0, 2.0)
    assert running.age_s(NOW_NS - 1) == 0.0  # the clock of this machine was set back


def test_when_time_jumps_what_was_drawn_is_forgotten_also_what_waits(heard: HeardTopics):
    running = RunningDisplay(SPEC, TYPES)
    running.listen(heard, somebody)
    heard.say("/goal", goal())
    assert draws(running)
    running.reset()
    assert not draws(running)
    heard.say("/goal", goal(1.0))
    assert draws(running)


def test_what_is_latched_holds_for_all_times(heard: HeardTopics):
    running = RunningDisplay(SPEC, TYPES)
    running.listen(heard, latched)
    heard.say("/goal", goal())
    assert draws(running)
    running.reset()
    assert draws(running)


def test_who_is_closed_while_it_begins_to_listen_hears_nothing_afterwards(heard: HeardTopics):
    running = RunningDisplay(SPEC, TYPES)
    begun, may_go_on = threading.Event(), threading.Event()

    def hold() -> None:
        begun.set()
        may_go_on.wait(60)

    heard.before_hearing = hold
    listening = threading.Thread(target=running.listen, args=(heard, somebody))
    listening.start()
    assert begun.wait(60)
    closing = threading.Thread(target=running.close)
    closing.start()
    may_go_on.set()
    listening.join()
    closing.join()
    running.listen(heard, somebody)
    assert heard.takers == {}


def test_a_name_that_is_no_topic_is_told_and_raises_nothing(heard: HeardTopics):
    def refuse(topic: str) -> Sequence[GraphEndpoint]:
        raise RosNameError(topic, "it has a space")

    running = RunningDisplay(SPEC, TYPES)
    running.listen(heard, refuse)
    facts = running.facts(NOW_NS, shown=True)
    assert "it has a space" in facts.trouble
    assert facts.wire.connected


def test_those_who_are_gone_are_listened_to_as_before_so_nothing_is_lost(heard: HeardTopics):
    running = RunningDisplay(SPEC, TYPES)
    running.listen(heard, latched)
    running.listen(heard, nobody)
    running.listen(heard, latched)
    assert len(heard.asked) == 1


def test_a_flood_is_taken_in_parts(heard: HeardTopics):
    running = RunningDisplay(DisplaySpec("d1", "MarkerArray", "All", "/all"), TYPES)
    kind = "visualization_msgs/msg/MarkerArray"
    running.listen(heard, lambda _topic: (publisher(kind),))
    empty = bytes(received_array())
    for _ in range(5):
        heard.say("/all", empty)
    taken: list[Any] = []
    running.display.take = lambda *one: taken.append(one)  # type: ignore[method-assign]
    running.step(here, NOW_NS, at_once_s=0.0)
    assert len(taken) == 1
    running.step(here, NOW_NS)
    assert len(taken) == 5


def received_array() -> bytes:
    from studio.ros.cdr import Codec

    kind = TYPES.message("visualization_msgs/msg/MarkerArray")
    return bytes(Codec(kind).encode(kind()))


def test_a_display_that_fails_says_so_and_raises_nothing(
    heard: HeardTopics, caplog: pytest.LogCaptureFixture
):
    def fail(_now_ns: int) -> None:
        raise ZeroDivisionError

    running = RunningDisplay(SPEC, TYPES)
    running.listen(heard, somebody)
    running.display.draw = fail  # type: ignore[method-assign, assignment]
    for _ in range(3):
        running.step(here, NOW_NS)
    (status,) = running.facts(NOW_NS, shown=True).statuses
    assert status.sentence == "A message could not be drawn: the terminal says why."
    assert len(caplog.records) == 1


def test_settings_of_another_studio_that_do_not_fit_are_left_out():
    spec = DisplaySpec("d1", "Pose", "Goal", values={"Shape": "Moon", "Alpha": 0.5, "Mood": 1})
    assert RunningDisplay(spec, TYPES).display.values["Alpha"] == 0.5
    with pytest.raises(DisplayError):
        RunningDisplay(DisplaySpec("d1", "Moon", "Moon"), TYPES)


def test_links_of_a_robot_stay_where_they_are_for_as_long_as_is_chosen():
    running = RunningDisplay(DisplaySpec("d1", "RobotModel", "Robot"), TYPES)
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


def test_a_robot_that_is_described_elsewhere_listens_to_no_topic(heard: HeardTopics):
    spec = DisplaySpec("d1", "RobotModel", "Robot", "/robot_description")
    running = RunningDisplay(spec, TYPES)
    running.listen(heard, nobody)
    assert running.wish() is not None
    running.set("Description Source", "Document")
    running.listen(heard, nobody)
    assert running.wish() is None
    assert running.facts(NOW_NS, shown=True).types == ()
