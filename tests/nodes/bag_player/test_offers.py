from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import SettingsError
from studio.nodes.bag_player.offers import DEPTH, Choice, offered_qos
from studio.ros.duration import Duration
from studio.ros.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

TOPICS = ("/a", "/b/c", "/add/_service_event")
PROFILES = st.builds(
    QoSProfile,
    reliability=st.sampled_from([ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT]),
    durability=st.sampled_from([DurabilityPolicy.VOLATILE, DurabilityPolicy.TRANSIENT_LOCAL]),
    deadline=st.sampled_from([Duration(), Duration(seconds=1)]),
)


@pytest.mark.parametrize(
    ("choice", "taken"),
    [
        (Choice(), TOPICS),
        (Choice(topics=("a",)), ("/a",)),
        (Choice(topics=("/a", "/add/_service_event")), ("/a", "/add/_service_event")),
        (Choice(services=("/add",)), ("/add/_service_event",)),
        (Choice(services=("add",), topics=("/a",)), ("/a", "/add/_service_event")),
        (Choice(regex="^/[ab]/?"), ("/a", "/b/c", "/add/_service_event")),
        (Choice(regex="c$"), ("/b/c",)),
        (Choice(regex="c$", topics=("/a",)), ("/a", "/b/c")),
        (Choice(exclude_regex="/a"), ("/b/c",)),
        (Choice(exclude_topics=("/a",)), ("/b/c", "/add/_service_event")),
        (Choice(exclude_services=("/add",)), ("/a", "/b/c")),
        (Choice(topics=("/a", "/b/c"), exclude_regex="c"), ("/a",)),
    ],
)
def test_topics_are_chosen_as_ros2_chooses_them(choice: Choice, taken: tuple[str, ...]):
    assert tuple(one for one in TOPICS if choice.takes(one)) == taken


@pytest.mark.parametrize("choice", [Choice(regex="["), Choice(exclude_regex="*")])
def test_what_is_no_regular_expression_is_refused(choice: Choice):
    with pytest.raises(SettingsError, match="regex"):
        choice.check()


@given(PROFILES, st.lists(st.tuples(st.integers(0, 100), st.sampled_from(HistoryPolicy))))
def test_publishers_that_differ_in_what_they_keep_are_offered_as_one(
    profile: QoSProfile, kept: list[tuple[int, HistoryPolicy]]
):
    offers = [profile, *(replace(profile, depth=d, history=h) for d, h in kept)]
    assert offered_qos(offers) == replace(profile, depth=DEPTH)


@given(st.lists(PROFILES, min_size=2))
def test_publishers_that_contradict_each_other_are_offered_as_none_of_them(
    offers: list[QoSProfile],
):
    is_one = all(one == offers[0] for one in offers)
    assert (offered_qos(offers) is not None) == is_one


def test_what_was_recorded_without_its_quality_is_offered_as_topics_are():
    assert offered_qos([]) == QoSProfile(depth=DEPTH)
