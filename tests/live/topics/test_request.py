"""How what a display wants of a topic is fitted to those who publish it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.displays.display import TopicRole
from studio.live.displays.display_list import Listening
from studio.live.displays.running import request_for
from studio.live.topics.request import Endpoint, Fit, fit_request
from studio.ros.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

if TYPE_CHECKING:
    from collections.abc import Sequence

SCAN, IMAGE, SMALL = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Image", "std_msgs/msg/Empty"
ROLE = TopicRole("", (SCAN, IMAGE), depth=5)
ANY = Listening()


def publisher(type_name: str, *, reliable: bool = True, latched: bool = False) -> Endpoint:
    qos = QoSProfile(
        depth=1,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )
    return Endpoint("/talker", False, type_name, f"hash of {type_name}", qos)


def fit(chosen: Listening, publishers: Sequence[Endpoint], before: Fit | None = None) -> Fit:
    found = fit_request(request_for(ROLE, "/scan", chosen), publishers, before, "hash of {}".format)
    assert found is not None
    return found


def test_it_is_listened_to_as_those_publish_who_are_there():
    assert fit(ANY, ()) == Fit(SCAN, f"hash of {SCAN}", True, False, 5)
    best_effort = publisher(SCAN, reliable=False)
    assert fit(ANY, [publisher(SCAN), best_effort]).reliable is False
    assert fit(ANY, [publisher(SCAN, latched=True), best_effort]).latched
    assert fit(ANY, [publisher(SMALL, latched=True)]).latched is False


def test_what_somebody_chose_holds_within_bounds():
    chosen = Listening(reliable=False, latched=True, depth=1_000_000)
    assert fit(chosen, [publisher(SCAN)]) == Fit(SCAN, f"hash of {SCAN}", False, True, 1000)
    assert fit(Listening(depth=-3), ()).depth == 1


def test_of_two_types_that_fit_the_choice_does_not_hang_on_who_came_first():
    both = [publisher(IMAGE), publisher(SCAN)]
    assert fit(ANY, both).type_name == SCAN
    assert fit(ANY, both[::-1]).type_name == SCAN


def test_when_all_publishers_are_gone_it_is_listened_to_as_before():
    before = fit(ANY, [publisher(IMAGE, reliable=False, latched=True)])
    assert fit(ANY, (), before) == before


def test_whoever_reads_the_bytes_shares_with_those_who_take_them_as_they_are():
    role = request_for(ROLE, "/scan", ANY)
    assert role.as_known_here
    there = publisher(SCAN)
    assert fit(ANY, [there]).type_hash == there.type_hash
    foreign = there._replace(type_hash="of another form")
    assert fit(ANY, [foreign]).type_hash == there.type_hash


def test_a_topic_is_asked_for_as_a_fit_says():
    qos = Fit(SCAN, None, False, True, 7).qos
    assert qos.depth == 7
    assert qos.reliability is ReliabilityPolicy.BEST_EFFORT
    assert qos.durability is DurabilityPolicy.TRANSIENT_LOCAL
