from __future__ import annotations

import pytest

from studio.displays.properties import FIXED_FRAME
from studio.errors import UnknownFrameError
from studio.live.displays.scene_frames import SceneFrames
from studio.protocol.displays import GetTf
from studio.ros.columns.transforms import TransformCodec
from studio.tf.transforms import TransformColumns
from tests.support.display_messages import encoded
from tests.support.memory_source import MemorySource
from tests.support.posed import Posed, arm
from tests.support.transforms import S, Told, columns

KNOWN = b"k" * 16
"""The GID of `/talker`, which publishes /tf."""
TF = "tf2_msgs/msg/TFMessage"


def message_of(*rows: Told) -> bytes:
    told = columns(*rows)
    return bytes(
        TransformCodec().encode(
            TransformColumns(
                told.parents, told.children, told.stamps_ns, told.translations, told.rotations_wxyz
            )
        )
    )


def receiving() -> tuple[SceneFrames, MemorySource]:
    source = MemorySource()
    source.offer("/tf", TF, gid=KNOWN)
    frames = SceneFrames(Posed(arm()), source)
    frames.step()
    frames.subscribe()
    return frames, source


def x_m(frames: SceneFrames, frame: str) -> float:
    return frames.lookup(frame, 0)[1][0]


def test_poses_are_in_the_fixed_frame_that_was_chosen_or_else_in_the_root_link():
    frames, source = receiving()
    assert (frames.fixed, x_m(frames, "tip"), x_m(frames, FIXED_FRAME)) == ("base", 0.5, 0.0)
    frames.chosen = "odom"
    pose, trouble = frames.robot_pose()
    assert pose is None
    assert '"odom"' in trouble
    source.say("/tf", message_of(Told("odom", "base", S, (2.0, 0.0, 0.0))))
    assert x_m(frames, "tip") == 2.5
    assert frames.robot_pose() == (((1.0, 0.0, 0.0, 0.0), (2.0, 0.0, 0.0)), "")


def test_without_a_time_every_frame_stands_by_the_newest_transforms_as_those_that_are_drawn_do():
    frames, source = receiving()
    frames.chosen = "odom"
    source.say("/tf", message_of(Told("odom", "cart", 1 * S, (1.0, 0.0, 0.0))))
    source.say("/tf", message_of(Told("cart", "arm", 1 * S, (0.5, 0.0, 0.0))))
    source.say("/tf", message_of(Told("odom", "cart", 2 * S, (2.0, 0.0, 0.0))))
    # The newest time of both is 1 s: there the arm is at 1.5 m, and no cross is drawn there.
    assert (x_m(frames, "arm"), x_m(frames, "cart")) == (2.5, 2.0)
    pose = frames.now().pose_of("arm")
    assert pose is not None
    assert pose[4] == 2.5


def test_the_answer_names_who_tells_of_each_frame_and_the_way_between_two():
    frames, source = receiving()
    source.say("/tf", message_of(Told("odom", "base", S)), KNOWN)
    source.say("/tf_static", message_of(Told("tip", "lamp")))
    answer = frames.answer(GetTf(frame="tip", seen_from="odom"), frames.fixed)
    assert answer.pose
    assert answer.pose.chain == ("odom", "base", "upper", "tip")
    told = {one.name: (one.publisher, one.static) for one in answer.frames}
    assert told["base"] == ("/talker", False)
    assert told["tip"] == ("this robot", True)
    assert told["lamp"] == ("00" * 16, True)
    only = frames.answer(GetTf(frame="tip", seen_from="odom", pose_only=True), frames.fixed)
    assert (only.pose, only.frames, only.more) == (answer.pose, (), 0)


def test_what_is_refused_is_told_in_sentences_of_which_few_are_kept():
    frames, source = receiving()
    for number in range(30):
        source.say("/tf", message_of(Told(f"f{number}", f"f{number}", S)))
    refused = frames.answer(GetTf(), frames.fixed).refused
    assert len(refused) == 20
    assert "f29" in refused[-1]
    source.say("/tf", b"no message")
    assert frames.answer(GetTf(), frames.fixed).refused == refused


def test_a_jump_of_time_is_told_once():
    frames, source = receiving()
    source.say("/tf", message_of(Told("odom", "base", 100 * S)))
    source.say("/tf", message_of(Told("odom", "base", 101 * S)))
    assert not frames.has_jumped()
    source.say("/tf", message_of(Told("odom", "base", 1 * S)))
    assert frames.has_jumped()
    assert not frames.has_jumped()


def clock(sec: int, nanosec: int = 0) -> bytes:
    return encoded("rosgraph_msgs/msg/Clock", {"clock": {"sec": sec, "nanosec": nanosec}})


def test_when_clock_goes_back_what_was_told_of_later_times_is_forgotten():
    frames, source = receiving()
    source.say("/clock", clock(100))
    source.say("/tf_static", message_of(Told("tip", "lamp")))
    source.say("/tf", message_of(Told("odom", "base", 100 * S), Told("gps", "car", 900_000 * S)))
    source.say("/clock", clock(101))
    source.say("/clock", clock(100, 950_000_000))  # somebody was overtaken by himself
    assert not frames.has_jumped()
    source.say("/clock", clock(5))
    assert frames.has_jumped()
    assert not frames.has_jumped()
    (said,) = frames.answer(GetTf(), frames.fixed).refused
    assert said == ("Time went back by 96.000 s on /clock: transforms of later times were dropped.")
    parents = {one.name: one.parent for one in frames.answer(GetTf(), frames.fixed).frames}
    assert (parents["lamp"], parents["base"]) == ("tip", "")
    assert parents["car"] == "gps"  # goes by another clock
    source.say("/tf", message_of(Told("odom", "base", 5 * S, (1.0, 0.0, 0.0))))
    frames.chosen = "odom"
    assert x_m(frames, "base") == 1.0


def test_two_who_tell_different_times_on_clock_do_not_make_time_jump():
    frames, source = receiving()
    for second in range(5):
        source.say("/clock", clock(1000 + second), b"a" * 16)
        source.say("/clock", clock(second), b"b" * 16)
    source.say("/clock", b"no message")
    assert not frames.has_jumped()


def test_without_a_connection_only_the_robots_own_frames_are_known_and_nothing_is_refused():
    frames, source = receiving()
    source.say("/tf", message_of(Told("odom", "base", S), Told("a", "a", S)))
    frames.unsubscribe()
    assert source.opened == []
    source.say("/tf", message_of(Told("map", "odom", S)))
    frames.step()
    assert x_m(frames, "tip") == 0.5
    with pytest.raises(UnknownFrameError):
        frames.lookup("odom", 0)
    assert frames.answer(GetTf(), frames.fixed).refused == ()


def test_frames_of_another_connection_are_forgotten_and_those_of_the_new_one_stay():
    frames, source = receiving()
    source.say("/tf", message_of(Told("odom", "base", S), Told("a", "a", S)))
    source.connect("none")
    frames.step()
    assert x_m(frames, "tip") == 0.5
    assert "odom" not in frames.buffer.frames()
    source.connect()
    source.say("/tf_static", message_of(Told("tip", "lamp")))  # before anybody looks
    frames.step()
    assert "lamp" in frames.buffer.frames()
    assert frames.answer(GetTf(), frames.fixed).refused == ()


def test_when_those_who_told_of_the_robots_links_are_gone_they_follow_its_joints_again():
    frames, source = receiving()
    moved = message_of(Told("upper", "tip", S, (2.0, 0.0, 0.0)), Told("odom", "base", S))
    source.say("/tf", moved, KNOWN)
    frames.drop_gone()
    frames.step()
    assert x_m(frames, "tip") == 2.0
    source.speakers("/tf")[0].leave()
    frames.drop_gone()
    frames.step()
    assert x_m(frames, "tip") == 0.5
    assert "odom" in frames.buffer.frames()
    source.offer("/tf", TF, gid=KNOWN).say(moved)
    frames.step()
    assert x_m(frames, "tip") == 2.0


def test_who_subscribes_again_receives_once_and_who_is_closed_never():
    frames, source = receiving()
    frames.subscribe()
    assert [topic for topic, _ in source.asked] == ["/tf_static", "/tf", "/clock"]
    frames.unsubscribe()
    frames.subscribe()
    source.say("/tf", message_of(Told("odom", "base", S, (1.0, 0.0, 0.0))))
    frames.step()
    frames.chosen = "odom"
    assert x_m(frames, "tip") == 1.5
    frames.close()
    frames.subscribe()
    assert source.opened == []


def test_where_the_fixed_frame_is_misspelt_all_parts_are_offered_the_root_of_most_frames():
    frames, source = receiving()
    source.say("/tf", message_of(Told("map", "goal", S)))
    frames.chosen = "mop"
    assert {frames.offered_for(frame) for frame in ("", "laser", "goal", "tip")} == {
        frames.own.root
    }


def test_only_a_frame_that_somebody_tells_of_is_offered():
    frames, source = receiving()
    source.say("/tf", message_of(Told("map", "goal", S)))
    assert frames.offered_for("/goal") == "/goal"
    assert frames.offered_for("laser") == ""


def test_without_any_transform_the_frame_that_messages_name_is_offered():
    frames = SceneFrames(Posed(arm()), MemorySource())
    frames.chosen = "map"
    assert frames.offered_for("laser") == "laser"
