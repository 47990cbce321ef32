from __future__ import annotations

from dataclasses import replace

import pytest

from studio.displays.display import Status
from studio.errors import ExtrapolationError, UnconnectedFramesError, UnknownFrameError
from studio.live.displays.display_list import DisplaySpec
from studio.live.displays.reasons import Facts, remarks_on
from studio.live.topics.request import Fit, StateKind, SubscriptionState
from studio.protocol.message import type_of
from studio.server.commands import COMMAND_ADAPTER

SCAN = "sensor_msgs/msg/LaserScan"


def topic(kind: StateKind, *types: str) -> SubscriptionState:
    """How the topic's subscription stands, with the types under which it is published."""
    fit = Fit(SCAN, None, True, False, 5)
    reason = "No type x." if kind == "refused" else ""
    return SubscriptionState("/scan", kind, fit, len(types), types, reason)


SPEC = DisplaySpec("d1", "LaserScan", "Front", "/scan")
WELL = Facts(
    SPEC,
    types=(SCAN,),
    topic=topic("receiving", SCAN),
    received=7,
    draws=True,
)
NEAREST = UnconnectedFramesError("odom", "laser", "base")
GROUPED = replace(SPEC, group="Sensors")
CLOUD = "sensor_msgs/msg/PointCloud2"
EMPTY = Status("warn", "transparent", "Its alpha is 0.", ("Alpha", 1.0))

APART = Status("error", "not_connected_frame", "Nothing connects a with mop.")


def mended_by(name: str, value: bool | str) -> Status:
    return Status("warn", "empty", "Nothing of it is seen.", (name, value))


def test_of_a_display_that_shows_what_it_should_nothing_else_is_said():
    assert [one.level for one in remarks_on(WELL)] == ["ok"]
    assert remarks_on(replace(WELL, draws=False, waits=True)) == ()


def test_a_display_that_draws_nothing_for_no_other_reason_says_so():
    (remark,) = remarks_on(replace(WELL, draws=False))
    assert (remark.level, remark.reason) == ("warn", "empty")
    assert remark.sentence == "Messages come on /scan, and there is nothing in them to draw."
    (remark,) = remarks_on(replace(WELL, draws=False, types=(), received=0))
    assert remark.sentence == "There is nothing to draw."


def test_a_topic_whose_publisher_ended_is_a_warning_and_one_that_nobody_ever_published_an_error():
    ended = replace(WELL, topic=topic("no_publisher"))
    for facts, level in ((ended, "warn"), (replace(ended, received=0), "error")):
        (remark,) = remarks_on(facts)
        assert (remark.level, remark.reason) == (level, "no_publisher")


def test_a_router_that_is_gone_is_named_before_all_that_follows_from_it():
    (remark,) = remarks_on(replace(WELL, topic=topic("connection_lost"), received=0))
    assert (remark.reason, remark.mend) == ("connection_lost", None)


@pytest.mark.parametrize(
    ("facts", "reason", "words"),
    [
        (replace(WELL, spec=replace(SPEC, topic="")), "no_topic", "choose one"),
        (replace(WELL, topic=topic("not_connected")), "not_connected", "no connection"),
        (replace(WELL, topic=topic("refused"), received=0), "not_heard", "No type x."),
        (replace(WELL, topic=topic("no_publisher")), "no_publisher", "Nobody publishes /scan"),
        (
            replace(WELL, topic=topic("other_type", CLOUD), fitting_kind="PointCloud2", received=0),
            "other_type",
            "is published as sensor_msgs/msg/PointCloud2",
        ),
        (
            replace(WELL, topic=topic("other_type", "a/msg/B"), received=0),
            "other_type",
            "another topic",
        ),
        (
            replace(WELL, topic=topic("other_form", SCAN), received=0),
            "other_hash",
            "of another form",
        ),
        (replace(WELL, received=0), "no_message", "yet"),
        (replace(WELL, silent_s=12.3), "silent", "12 s ago"),
        (replace(WELL, frames=(NEAREST,)), "not_connected_frame", "No chain"),
        (replace(WELL, frames=(UnknownFrameError("laser"),)), "no_frame", "tells of the frame"),
        (replace(WELL, frames=(UnknownFrameError(""),)), "no_frame_id", "without a frame"),
        (
            replace(
                WELL, frames=(ExtrapolationError("laser", 9 * 10**9, 0, 10**9),), frame="laser"
            ),
            "stamp_out_of_buffer",
            "8.000 s newer",
        ),
        (replace(WELL, stamp_zero=True), "stamp_zero", "time 0"),
        (replace(WELL, statuses=(EMPTY,)), "transparent", "alpha is 0"),
        (
            replace(WELL, spec=GROUPED, shown=False, hidden_by="Sensors"),
            "group_off",
            "hidden as a whole",
        ),
    ],
)
def test_each_reason_is_one_sentence(facts: Facts, reason: str, words: str):
    (remark,) = remarks_on(facts)
    assert remark.reason == reason
    assert words in remark.sentence
    assert remark.sentence.endswith((".", "?"))


@pytest.mark.parametrize(
    ("facts", "label"),
    [
        (replace(WELL, topic=topic("not_connected")), "Connect"),
        (
            replace(WELL, topic=topic("other_type", CLOUD), fitting_kind="PointCloud2"),
            "Add a PointCloud2 for it",
        ),
        (
            replace(WELL, spec=replace(SPEC, topic=""), instead="/scan"),
            "Listen to /scan",
        ),
        (
            replace(WELL, topic=topic("no_publisher"), instead="/front/scan"),
            "Listen to /front/scan",
        ),
        (replace(WELL, frames=(NEAREST,)), "Draw everything in base"),
        (
            replace(WELL, frames=(ExtrapolationError("a", 1, 2, 3),), frame="map"),
            "Draw everything in map",
        ),
        (
            replace(WELL, frames=(UnknownFrameError("odom"),), frame="laser"),
            "Draw everything in laser",
        ),
        (replace(WELL, statuses=(EMPTY,)), "Set Alpha to 1"),
        (replace(WELL, statuses=(mended_by("Show Axes", value=True),)), "Switch on Show Axes"),
        (replace(WELL, statuses=(mended_by("Covariance", value=False),)), "Switch off Covariance"),
        (replace(WELL, statuses=(mended_by("Filter", ""),)), "Clear Filter"),
        (replace(WELL, statuses=(mended_by("Shape", "Axes"),)), "Set Shape to Axes"),
        (replace(WELL, statuses=(APART,), frame="odom"), "Draw everything in odom"),
        (replace(WELL, spec=GROUPED, shown=False, hidden_by="Sensors"), "Show Sensors"),
    ],
)
def test_the_click_that_mends_it_is_a_command_as_the_page_sends_it(facts: Facts, label: str):
    mend = remarks_on(facts)[0].mend
    assert mend is not None
    assert mend.label == label
    assert type_of(type(COMMAND_ADAPTER.validate_python(mend.command))) == mend.command["type"]


def test_of_a_display_that_somebody_switched_off_nothing_is_said():
    assert remarks_on(replace(WELL, spec=replace(SPEC, enabled=False), shown=False)) == ()


def test_one_that_was_heard_before_and_is_not_any_more_says_what_else_is_in_the_way():
    facts = replace(WELL, topic=topic("no_publisher"), statuses=(EMPTY,))
    assert [one.reason for one in remarks_on(facts)] == ["no_publisher", "transparent"]


def test_of_a_robot_without_any_frame_the_first_are_told_and_how_many_more_there_are():
    links = tuple(UnknownFrameError(f"link{number}") for number in range(40))
    remarks = remarks_on(replace(WELL, draws=False, frames=links, statuses=(EMPTY,)))
    assert [one.sentence for one in remarks[:3]] == [str(error) for error in links[:3]]
    assert remarks[3].sentence == "37 more of its frames have no place in the fixed frame."
    assert remarks[4].reason == "transparent"


def test_where_no_frame_would_help_none_is_offered():
    lost = replace(WELL, frames=(UnknownFrameError("laser"),), statuses=(APART,))
    assert [one.mend for one in remarks_on(lost)] == [None, None]
