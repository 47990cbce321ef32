from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from studio.errors import ExtrapolationError
from studio.tf.buffer import TransformBuffer
from studio.tf.forest import DEPTH_MAX, FRAMES_MAX
from studio.tf.transforms import NAME_LETTERS_MAX
from tests.support.transforms import HandClock, S, Told, Vector, about_z, columns

ALONG = (1.0, 0.0, 0.0)
AHEAD = (1.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("told", "kind", "says"),
    [
        (Told("a", "b", S, ALONG, (0.0, 0.0, 0.0, 0.0)), "zero_quaternion", "zero"),
        (Told("a", "b", S, ALONG, (math.nan, 0.0, 0.0, 1.0)), "not_finite", "finite"),
        (Told("a", "b", S, ALONG, (math.inf, 0.0, 0.0, 1.0)), "not_finite", "finite"),
        (Told("a", "b", S, (math.nan, 0.0, 0.0)), "not_finite", "finite"),
        (Told("a", "b", S, (0.0, -math.inf, 0.0)), "not_finite", "finite"),
        (Told("a", "b", S, (0.0, 1e300, 0.0)), "too_far", "farther"),
        (Told("a", "b", S, ALONG, (1e200, 0.0, 0.0, 0.0)), "no_unit_quaternion", "length 1e"),
        (Told("a", "b", S, ALONG, (0.0, 0.0, 0.0, 2.0)), "no_unit_quaternion", "length 2,"),
        (Told("a", "b", -1, ALONG), "no_stamp", "beginning of time"),
        (Told("b", "/b", S, ALONG), "own_parent", "its own parent"),
        (Told("", "b", S, ALONG), "no_name", "parent has no name"),
        (Told("a", "/", S, ALONG), "no_name", "child has no name"),
        (Told("a", "b" * (NAME_LETTERS_MAX + 1), S, ALONG), "long_name", "letters"),
    ],
)
@pytest.mark.parametrize("static", [False, True])
def test_what_is_no_transform_is_left_out_and_the_rest_is_taken(
    told: Told, kind: str, says: str, static: bool
):
    buffer = TransformBuffer()
    for _ in range(3):
        good = Told("c", "d", S, ALONG), Told("d", "e", S, ALONG)
        (notice,) = buffer.put(columns(good[0], told, good[1]), static=static, publisher="p")
        assert (notice.kind, notice.left_out, notice.publisher) == (kind, True, "p")
        assert says in notice.sentence
        assert buffer.frames() == ["c", "d", "e"]
        assert buffer.fixed_from("c", "e").xyz == (2.0, 0.0, 0.0)


@pytest.mark.parametrize("length", [1.004, 0.996])
def test_a_quaternion_that_is_nearly_of_length_one_is_made_so(length: float):
    buffer = TransformBuffer()
    wxyz = tuple(part * length for part in about_z(1.0))
    assert buffer.put(columns(Told("a", "b", S, ALONG, wxyz))) == ()
    assert buffer.fixed_from("a", "b").wxyz == pytest.approx(about_z(1.0), abs=1e-15)


def test_a_fault_of_a_transform_that_was_good_leaves_what_was_known():
    buffer = TransformBuffer()
    for at in range(1, 4):
        assert buffer.put(columns(Told("a", "b", at * S, ALONG), Told("b", "c", at * S))) == ()
    broken = Told("a", "b", 4 * S, ALONG, (0.0, 0.0, 0.0, 0.0))
    (notice,) = buffer.put(columns(broken, Told("b", "c", 4 * S)))
    assert notice.kind == "zero_quaternion"
    assert buffer.fixed_from("a", "b").stamp_ns == 3 * S
    assert buffer.fixed_from("b", "c").stamp_ns == 4 * S


def test_a_circle_is_not_closed():
    buffer = TransformBuffer()
    buffer.put(columns(Told("a", "b", S), Told("b", "c", S), Told("c", "d", S)))
    (notice,) = buffer.put(columns(Told("d", "a", S)))
    assert notice.kind == "circle"
    assert "hangs on the child already" in notice.sentence
    assert buffer.fixed_from("a", "d").xyz == (0.0, 0.0, 0.0)
    (notice,) = buffer.put(columns(Told("d", "b", 60 * S)))
    assert notice.kind == "circle"
    assert buffer.chain("a", "c") == ("a", "b", "c")


def test_another_publisher_takes_a_frame_only_when_its_edge_is_older_than_the_history():
    buffer = TransformBuffer()
    buffer.put(columns(Told("odom", "base", 5 * S)), publisher="driver")
    (notice,) = buffer.put(columns(Told("map", "base", 14 * S)), publisher="slam")
    assert (notice.kind, notice.left_out) == ("other_parent", True)
    assert '"base" hangs on "odom"' in notice.sentence
    assert buffer.frames() == ["base", "odom"]
    (notice,) = buffer.put(columns(Told("map", "base", 16 * S)), publisher="slam")
    assert (notice.kind, notice.left_out) == ("moved", False)
    assert 'from "odom" to "map"' in notice.sentence
    assert buffer.frames() == ["base", "map"]
    (notice,) = buffer.put(columns(Told("odom", "base", 16 * S)), publisher="driver")
    assert notice.kind == "other_parent"
    assert buffer.put(columns(Told("map", "base", 17 * S)), publisher="slam") == ()


def test_a_publisher_moves_its_own_frame_but_not_to_and_fro():
    clock = HandClock()
    buffer = TransformBuffer(clock=clock)
    buffer.put(columns(Told("table", "cup", S)), publisher="world")
    (notice,) = buffer.put(columns(Told("gripper", "cup", S + 1)), publisher="world")
    assert (notice.kind, notice.left_out) == ("moved", False)
    (notice,) = buffer.put(columns(Told("table", "cup", S + 2)), publisher="world")
    assert (notice.kind, notice.left_out) == ("other_parent", True)
    clock.now_ns += S
    (notice,) = buffer.put(columns(Told("table", "cup", S + 3)), publisher="world")
    assert notice.kind == "moved"
    assert buffer.fixed_from("table", "cup").stamp_ns == S + 3


def test_who_is_not_known_moves_nothing():
    buffer = TransformBuffer()
    buffer.put(columns(Told("table", "cup", S)))
    (notice,) = buffer.put(columns(Told("gripper", "cup", S + 1)))
    assert notice.kind == "other_parent"


def test_there_are_so_many_frames_and_no_more():
    buffer = TransformBuffer()
    names = tuple(f"f{number}" for number in range(FRAMES_MAX - 1))
    many = columns(*(Told("map", name, S) for name in names))
    assert buffer.put(many) == ()
    (notice,) = buffer.put(columns(Told("map", "one_more", S)))
    assert notice.kind == "too_many"
    assert "frames already" in notice.sentence
    assert buffer.put(columns(Told("map", "f7", 2 * S, ALONG))) == ()
    assert buffer.fixed_from("map", "f7").xyz == ALONG
    buffer.drop(["f8"])
    assert buffer.put(columns(Told("map", "one_more", S))) == ()


def test_a_message_full_of_faults_is_told_of_in_a_few_sentences():
    buffer = TransformBuffer()
    notices = buffer.put(columns(*[Told("a", "a", S)] * 5000))
    assert len(notices) == 21
    assert notices[-1].sentence == "4980 more transforms of this message have faults."


def test_a_frame_named_twice_in_a_message_keeps_both():
    buffer = TransformBuffer()
    for at in (1, 3, 5):
        twice = (
            Told("a", "b", at * S, (float(at), 0.0, 0.0)),
            Told("a", "b", (at + 1) * S, (float(at + 1), 0.0, 0.0)),
        )
        assert buffer.put(columns(*twice)) == ()
    assert buffer.fixed_from("a", "b", 4 * S).xyz[0] == 4.0
    assert buffer.fixed_from("a", "b").stamp_ns == 6 * S


def test_the_same_stamp_again_takes_the_place_of_the_former():
    buffer = TransformBuffer()
    for x_m in (1.0, 2.0, 3.0):
        assert buffer.put(columns(Told("a", "b", S, (x_m, 0.0, 0.0)))) == ()
    buffer.put(columns(Told("a", "b", 2 * S, (9.0, 0.0, 0.0))))
    assert buffer.put(columns(Told("a", "b", S, (5.0, 0.0, 0.0)))) == ()
    assert buffer.fixed_from("a", "b", S + S // 2).xyz[0] == 7.0


def test_a_frame_becomes_static_and_moves_again():
    buffer = TransformBuffer()
    buffer.put(columns(Told("a", "b", 5 * S, ALONG)))
    buffer.put(columns(Told("a", "b", 5 * S, (2.0, 0.0, 0.0))), static=True)
    assert buffer.fixed_from("a", "b", 99 * S).xyz[0] == 2.0
    buffer.put(columns(Told("a", "b", 3 * S, (3.0, 0.0, 0.0))))
    assert buffer.fixed_from("a", "b", 3 * S).xyz[0] == 3.0
    with pytest.raises(ExtrapolationError):
        buffer.fixed_from("a", "b", 99 * S)


def test_static_frames_that_are_told_again_have_their_new_places():
    buffer = TransformBuffer()
    for x_m in (1.0, 2.0, 3.0):
        rows = Told("a", "b", 0, (x_m, 0.0, 0.0)), Told("b", "c", 0, (0.0, x_m, 0.0))
        assert buffer.put(columns(*rows), static=True, publisher="robot") == ()
        assert buffer.fixed_from("a", "c", 77 * S).xyz == (x_m, x_m, 0.0)
    names = buffer.all_in("a").names
    buffer.put(columns(Told("a", "b", 5 * S, (9.0, 0.0, 0.0)), Told("b", "c", 0)), static=True)
    assert buffer.fixed_from("a", "c").xyz == (9.0, 0.0, 0.0)
    assert buffer.all_in("a").names is names


def fed(clock: HandClock) -> TransformBuffer:
    """A driver and a localisation, 30 s long, and a static laser."""
    buffer = TransformBuffer(clock=clock)
    buffer.put(columns(Told("base", "laser", S)), static=True, publisher="driver")
    for at in range(31):
        stamp_ns = (100 + at) * S
        buffer.put(columns(Told("odom", "base", stamp_ns, ALONG)), publisher="driver")
        buffer.put(columns(Told("map", "odom", stamp_ns)), publisher="amcl")
        clock.now_ns += S
    return buffer


def test_when_time_begins_anew_what_its_publisher_told_is_forgotten_and_the_rest_stays():
    buffer = fed(HandClock())
    (notice,) = buffer.put(columns(Told("odom", "base", 3 * S)), publisher="driver")
    assert (notice.kind, notice.left_out) == ("time_jumped", False)
    assert 'back by 127.000 s for "base"' in notice.sentence
    assert buffer.fixed_from("odom", "laser").stamp_ns == 3 * S
    assert buffer.put(columns(Told("odom", "base", 4 * S)), publisher="driver") == ()
    assert buffer.fixed_from("map", "odom").stamp_ns == 130 * S
    buffer.put(columns(Told("map", "odom", 4 * S)), publisher="amcl")
    assert buffer.fixed_from("map", "laser").stamp_ns == 4 * S


def test_who_has_another_clock_does_not_make_time_jump():
    clock = HandClock()
    buffer = fed(clock)
    clock.now_ns -= S // 2
    (notice,) = buffer.put(columns(Told("odom", "base", 3 * S)), publisher="imposter")
    assert (notice.kind, notice.left_out) == ("too_old", True)
    assert "127.0 s older" in notice.sentence
    assert buffer.fixed_from("map", "base").stamp_ns == 130 * S
    # After a second of silence it is the new one, as when a bag is played again.
    clock.now_ns += 2 * S
    (notice,) = buffer.put(columns(Told("odom", "base", 4 * S)), publisher="imposter")
    assert notice.kind == "time_jumped"
    assert buffer.fixed_from("odom", "base").stamp_ns == 4 * S


def test_a_stamp_of_zero_is_one_that_was_forgotten_not_a_jump():
    buffer = fed(HandClock())
    (notice,) = buffer.put(columns(Told("odom", "base", 0)), publisher="driver")
    assert notice.kind == "too_old"
    assert buffer.fixed_from("odom", "base").stamp_ns == 130 * S


def test_a_short_loop_is_noticed_after_some_transforms():
    buffer = TransformBuffer()
    kinds: list[str] = []
    for _ in range(3):
        for at in range(20):
            told = Told("a", "b", (at + 1) * S // 10, (float(at), 0.0, 0.0))
            kinds += [notice.kind for notice in buffer.put(columns(told), publisher="bag")]
    assert kinds == ["time_jumped", "time_jumped"]
    assert buffer.fixed_from("a", "b").stamp_ns == 2 * S


def test_a_publisher_that_is_late_now_and_then_is_no_loop():
    buffer = TransformBuffer()
    for at in range(100):
        stamp_ns = (at + 10) * S // 10
        assert buffer.put(columns(Told("a", "b", stamp_ns)), publisher="one") == ()
        late = columns(Told("a", "b", stamp_ns - 5 * S // 10 + 1))
        assert buffer.put(late, publisher="two") == ()
        assert buffer.put(late, publisher="one") == ()


def test_a_jump_of_the_clock_forgets_all_that_is_newer():
    buffer = fed(HandClock())
    buffer.jump_back(125 * S)
    assert buffer.fixed_from("map", "laser").stamp_ns == 125 * S
    buffer.jump_back(5 * S)
    assert buffer.frames() == ["base", "laser"]
    assert not np.any(buffer.all_in("base").wxyz_xyz[:, 4:])


def test_a_message_of_nothing_is_nothing():
    buffer = TransformBuffer()
    assert buffer.put(columns()) == ()
    assert buffer.put(columns(), static=True) == ()
    assert buffer.frames() == []
    assert buffer.all_in("map").names == ()


@pytest.mark.parametrize("static", [False, True])
def test_a_chain_is_as_deep_as_it_may_be_and_no_deeper(static: bool):
    count = DEPTH_MAX
    names = [f"f{number}" for number in range(count)]
    rows = [Told(*pair, S, ALONG) for pair in itertools.pairwise(names)]
    buffer = TransformBuffer()
    assert buffer.put(columns(*rows), static=static) == ()
    frames = buffer.all_in("f0", S)
    assert frames.connected.all()
    far_m: Vector = tuple(frames.wxyz_xyz[frames.names.index(names[-1])].tolist())
    assert far_m == (*AHEAD, count - 1.0, 0.0, 0.0)
    (notice,) = buffer.put(columns(Told(names[-1], "deeper", S)))
    assert notice.kind == "too_deep"
