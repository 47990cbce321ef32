from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.displays.drawing import FIXED_FRAME
from studio.errors import UnknownFrameError
from studio.live.displays.frames_desk import FramesDesk
from studio.protocol.displays import GetTf
from studio.ros.columns.transforms import TransformCodec
from studio.tf.transforms import TransformColumns
from tests.support.display_messages import encoded
from tests.support.heard_topics import HeardTopics, publisher
from tests.support.posed import Posed, arm
from tests.support.transforms import S, Told, columns

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.ros.graph.endpoints import GraphEndpoint

KNOWN = publisher("tf2_msgs/msg/TFMessage")


class Known:
    """A graph that knows of one publisher."""

    def endpoint_of_gid(self, gid: bytes) -> GraphEndpoint | None:
        return KNOWN if gid == KNOWN.gid else None

    def publishers(self, topic: str) -> Sequence[GraphEndpoint]:
        return [KNOWN] if topic == "/tf" else []


class Empty(Known):
    """A graph that it has left."""

    def publishers(self, topic: str) -> Sequence[GraphEndpoint]:
        del topic
        return []


def message_of(*rows: Told) -> bytes:
    told = columns(*rows)
    return bytes(
        TransformCodec().encode(
            TransformColumns(
                told.parents, told.children, told.stamps_ns, told.translations, told.rotations_wxyz
            )
        )
    )


def listening() -> tuple[FramesDesk, HeardTopics]:
    desk, heard = FramesDesk(Posed(arm())), HeardTopics()
    desk.step()
    desk.listen(heard, Known())
    return desk, heard


def x_m(desk: FramesDesk, frame: str) -> float:
    return desk.lookup(frame, 0)[1][0]


def test_poses_are_in_the_fixed_frame_that_was_chosen_or_else_in_the_root_link():
    desk, heard = listening()
    assert (desk.fixed, x_m(desk, "tip"), x_m(desk, FIXED_FRAME)) == ("base", 0.5, 0.0)
    desk.chosen = "odom"
    pose, trouble = desk.robot_pose()
    assert pose is None
    assert '"odom"' in trouble
    heard.say("/tf", message_of(Told("odom", "base", S, (2.0, 0.0, 0.0))))
    assert x_m(desk, "tip") == 2.5
    assert desk.robot_pose() == (((1.0, 0.0, 0.0, 0.0), (2.0, 0.0, 0.0)), "")


def test_without_a_time_every_frame_stands_by_the_newest_transforms_as_those_that_are_drawn_do():
    desk, heard = listening()
    desk.chosen = "odom"
    heard.say("/tf", message_of(Told("odom", "cart", 1 * S, (1.0, 0.0, 0.0))))
    heard.say("/tf", message_of(Told("cart", "arm", 1 * S, (0.5, 0.0, 0.0))))
    heard.say("/tf", message_of(Told("odom", "cart", 2 * S, (2.0, 0.0, 0.0))))
    # The newest time of both is 1 s: there the arm is at 1.5 m, and no cross is drawn there.
    assert (x_m(desk, "arm"), x_m(desk, "cart")) == (2.5, 2.0)
    pose = desk.now().pose_of("arm")
    assert pose is not None
    assert pose[4] == 2.5


def test_the_answer_names_who_tells_of_each_frame_and_the_way_between_two():
    desk, heard = listening()
    heard.say("/tf", message_of(Told("odom", "base", S)), KNOWN.gid)
    heard.say("/tf_static", message_of(Told("tip", "lamp")))
    answer = desk.answer(GetTf(frame="tip", seen_from="odom"), desk.fixed)
    assert answer.pose
    assert answer.pose.chain == ("odom", "base", "upper", "tip")
    told = {one.name: (one.publisher, one.static) for one in answer.frames}
    assert told["base"] == ("/talker", False)
    assert told["tip"] == ("this robot", True)
    assert told["lamp"] == ("00" * 16, True)
    only = desk.answer(GetTf(frame="tip", seen_from="odom", pose_only=True), desk.fixed)
    assert (only.pose, only.frames, only.more) == (answer.pose, (), 0)


def test_what_is_refused_is_told_in_sentences_of_which_few_are_kept():
    desk, heard = listening()
    for number in range(30):
        heard.say("/tf", message_of(Told(f"f{number}", f"f{number}", S)))
    refused = desk.answer(GetTf(), desk.fixed).refused
    assert len(refused) == 20
    assert "f29" in refused[-1]
    heard.say("/tf", b"no message")
    assert desk.answer(GetTf(), desk.fixed).refused == refused


def test_a_jump_of_time_is_told_once():
    desk, heard = listening()
    heard.say("/tf", message_of(Told("odom", "base", 100 * S)))
    heard.say("/tf", message_of(Told("odom", "base", 101 * S)))
    assert not desk.has_jumped()
    heard.say("/tf", message_of(Told("odom", "base", 1 * S)))
    assert desk.has_jumped()
    assert not desk.has_jumped()


def clock(sec: int, nanosec: int = 0) -> bytes:
    return encoded("rosgraph_msgs/msg/Clock", {"clock": {"sec": sec, "nanosec": nanosec}})


def test_when_clock_goes_back_what_was_told_of_later_times_is_forgotten():
    desk, heard = listening()
    heard.say("/clock", clock(100))
    heard.say("/tf_static", message_of(Told("tip", "lamp")))
    heard.say("/tf", message_of(Told("odom", "base", 100 * S), Told("gps", "car", 900_000 * S)))
    heard.say("/clock", clock(101))
    heard.say("/clock", clock(100, 950_000_000))  # somebody was overtaken by himself
    assert not desk.has_jumped()
    heard.say("/clock", clock(5))
    assert desk.has_jumped()
    assert not desk.has_jumped()
    (said,) = desk.answer(GetTf(), desk.fixed).refused
    assert said == (
        "Time went back by 96.000 s on /clock: what was told of later times was forgotten."
    )
    frames = {one.name: one.parent for one in desk.answer(GetTf(), desk.fixed).frames}
    assert (frames["lamp"], frames["base"]) == ("tip", "")
    assert frames["car"] == "gps"  # goes by another clock
    heard.say("/tf", message_of(Told("odom", "base", 5 * S, (1.0, 0.0, 0.0))))
    desk.chosen = "odom"
    assert x_m(desk, "base") == 1.0


def test_two_who_tell_different_times_on_clock_do_not_make_time_jump():
    desk, heard = listening()
    for second in range(5):
        heard.say("/clock", clock(1000 + second), b"a" * 16)
        heard.say("/clock", clock(second), b"b" * 16)
    heard.say("/clock", b"no message")
    assert not desk.has_jumped()


def test_without_a_connection_only_the_robots_own_frames_are_known_and_nothing_is_refused():
    desk, heard = listening()
    heard.say("/tf", message_of(Told("odom", "base", S), Told("a", "a", S)))
    late = heard.takers["/tf"]
    desk.deafen()
    assert heard.takers == {}
    heard.takers["/tf"] = late
    heard.say("/tf", message_of(Told("map", "odom", S)))  # was on its way meanwhile
    desk.step()
    assert x_m(desk, "tip") == 0.5
    with pytest.raises(UnknownFrameError):
        desk.lookup("odom", 0)
    assert desk.answer(GetTf(), desk.fixed).refused == ()


def test_when_those_who_told_of_the_robots_links_are_gone_they_follow_its_joints_again():
    desk, heard = listening()
    moved = message_of(Told("upper", "tip", S, (2.0, 0.0, 0.0)), Told("odom", "base", S))
    heard.say("/tf", moved, KNOWN.gid)
    desk.look(Known())
    desk.step()
    assert x_m(desk, "tip") == 2.0
    desk.look(Empty())
    desk.step()
    assert x_m(desk, "tip") == 0.5
    assert "odom" in desk.buffer.frames()
    heard.say("/tf", moved, KNOWN.gid)
    desk.step()
    assert x_m(desk, "tip") == 2.0


def test_who_listens_again_hears_once_and_who_is_closed_never():
    desk, heard = listening()
    desk.listen(heard, Known())
    assert [topic for _, topic, _ in heard.asked] == ["/tf_static", "/tf", "/clock"]
    desk.deafen()
    desk.listen(heard, Known())
    heard.say("/tf", message_of(Told("odom", "base", S, (1.0, 0.0, 0.0))))
    desk.step()
    desk.chosen = "odom"
    assert x_m(desk, "tip") == 1.5
    desk.close()
    desk.listen(heard, Known())
    assert heard.takers == {}


def test_where_the_fixed_frame_is_misspelt_all_parts_are_offered_the_root_of_most_frames():
    desk, heard = listening()
    heard.say("/tf", message_of(Told("map", "goal", S)))
    desk.chosen = "mop"
    assert {desk.offered_for(frame) for frame in ("", "laser", "goal", "tip")} == {desk.own.root}


def test_only_a_frame_that_somebody_tells_of_is_offered():
    desk, heard = listening()
    heard.say("/tf", message_of(Told("map", "goal", S)))
    assert desk.offered_for("/goal") == "/goal"
    assert desk.offered_for("laser") == ""


def test_without_any_transform_the_frame_that_messages_name_is_offered():
    desk = FramesDesk(Posed(arm()))
    desk.chosen = "map"
    assert desk.offered_for("laser") == "laser"
