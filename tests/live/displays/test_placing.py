from collections.abc import Mapping

import pytest

from studio.displays.drawing import NO_TURN, Placed, Pose, Text
from studio.errors import ExtrapolationError, UnknownFrameError
from studio.live.displays.placing import PATIENCE_NS, Placing

MOMENT = 1_000_000_000


class Frames:
    """Frames on a line: each is at its own x, and known up to a time."""

    def __init__(self, **known_until: int) -> None:
        self.known_until = known_until
        self.x_m: dict[str, float] = {}
        self.asked = 0

    def lookup(self, frame: str, stamp_ns: int) -> Pose:
        self.asked += 1
        if frame not in self.known_until:
            raise UnknownFrameError(frame)
        newest_ns = self.known_until[frame]
        if stamp_ns > newest_ns:
            raise ExtrapolationError(frame, stamp_ns, 0, newest_ns)
        return NO_TURN, (self.x_m.get(frame, 0.0) + stamp_ns, 0.0, 0.0)


def drawing(frame: str, stamp_ns: int, *, follows: bool = False) -> Mapping[str, Placed]:
    return {"": Placed(frame, stamp_ns, {"word": Text("here")}, follows)}


def test_a_drawing_whose_transform_is_known_is_shown_at_once_and_only_once():
    placing, frames = Placing(), Frames(scan=10)
    first = drawing("scan", 5)
    placing.offer(first, MOMENT)
    shown = placing.step(frames.lookup, MOMENT)
    assert shown is not None
    assert shown.drawing is first
    assert shown.poses == {"": (NO_TURN, (5.0, 0.0, 0.0))}
    placing.offer(first, MOMENT)
    assert placing.step(frames.lookup, MOMENT) is None
    assert frames.asked == 1


def test_a_message_that_comes_before_its_transform_waits_and_the_one_before_stays():
    placing, frames = Placing(), Frames(scan=10)
    placing.offer(drawing("scan", 5), MOMENT)
    placing.step(frames.lookup, MOMENT)
    late = drawing("scan", 20)
    placing.offer(late, MOMENT)
    assert placing.step(frames.lookup, MOMENT + 1) is None
    assert not placing.troubles
    frames.known_until["scan"] = 20
    shown = placing.step(frames.lookup, MOMENT + 2)
    assert shown is not None
    assert shown.drawing is late


def test_of_several_that_wait_the_newest_that_can_be_placed_is_shown():
    placing, frames = Placing(), Frames(scan=12)
    drawings = [drawing("scan", stamp) for stamp in (10, 11, 12, 13, 14)]
    for one in drawings:
        placing.offer(one, MOMENT)
    shown = placing.step(frames.lookup, MOMENT)
    assert shown is not None
    assert shown.drawing is drawings[2]
    frames.known_until["scan"] = 14
    shown = placing.step(frames.lookup, MOMENT)
    assert shown is not None
    assert shown.drawing is drawings[4]


def test_what_waited_for_too_long_is_shown_as_far_as_it_can_be_and_the_rest_is_told():
    placing, frames = Placing(), Frames(scan=10)
    both = {**drawing("scan", 5), "far": Placed("moon", 5, {})}
    placing.offer(both, MOMENT)
    assert placing.step(frames.lookup, MOMENT) is None
    shown = placing.step(frames.lookup, MOMENT + PATIENCE_NS)
    assert shown is not None
    assert shown.poses["far"] is None
    assert shown.poses[""] is not None
    assert isinstance(placing.troubles["far"], UnknownFrameError)


def test_what_is_too_old_for_the_buffer_does_not_wait():
    placing = Placing()

    def lookup(frame: str, stamp_ns: int) -> Pose:
        raise ExtrapolationError(frame, stamp_ns, 100, 200)

    placing.offer(drawing("scan", 5), MOMENT)
    shown = placing.step(lookup, MOMENT)
    assert shown is not None
    assert shown.poses == {"": None}


def test_what_had_no_place_gets_one_when_its_frame_comes():
    placing, frames = Placing(), Frames()
    placing.offer(drawing("scan", 5), MOMENT)
    placing.step(frames.lookup, MOMENT + PATIENCE_NS)
    assert placing.step(frames.lookup, MOMENT + PATIENCE_NS) is None
    frames.known_until["scan"] = 10
    shown = placing.step(frames.lookup, MOMENT + PATIENCE_NS)
    assert shown is not None
    assert shown.poses == {"": (NO_TURN, (5.0, 0.0, 0.0))}
    assert not placing.troubles


def test_what_follows_its_frame_moves_with_it_and_what_does_not_stays():
    placing, frames = Placing(), Frames(arm=10, scan=10)
    placing.offer(
        {
            "still": Placed("scan", 5, {}),
            "locked": Placed("arm", 5, {}, follows=True),
            "newest": Placed("arm", 0, {}),
        },
        MOMENT,
    )
    placing.step(frames.lookup, MOMENT)
    assert placing.step(frames.lookup, MOMENT) is None
    frames.x_m = {"arm": 100.0, "scan": 100.0}
    shown = placing.step(frames.lookup, MOMENT)
    assert shown is not None
    xs = {path: pose[1][0] for path, pose in shown.poses.items() if pose}
    assert xs == {"still": 5.0, "locked": 105.0, "newest": 100.0}


def test_all_is_looked_up_again_when_the_fixed_frame_is_another():
    placing, frames = Placing(), Frames(scan=10)
    placing.offer(drawing("scan", 5), MOMENT)
    placing.step(frames.lookup, MOMENT)
    frames.x_m = {"scan": 7.0}
    placing.renew()
    shown = placing.step(frames.lookup, MOMENT)
    assert shown is not None
    assert shown.poses == {"": (NO_TURN, (12.0, 0.0, 0.0))}


def test_what_does_not_turn_with_its_frame_is_only_moved():
    placing, turned = Placing(), (0.0, 1.0, 0.0, 0.0)
    both = {"turns": Placed("imu", 1, {}), "stays": Placed("imu", 1, {}, turns=False)}
    placing.offer(both, MOMENT)
    shown = placing.step(lambda _frame, _stamp_ns: (turned, (1.0, 2.0, 3.0)), MOMENT)
    assert shown is not None
    assert shown.poses == {"turns": (turned, (1.0, 2.0, 3.0)), "stays": (NO_TURN, (1.0, 2.0, 3.0))}


def test_other_shapes_at_the_same_place_and_time_stay_there_however_long_ago_it_was():
    placing, frames = Placing(), Frames(scan=10)
    placing.offer(drawing("scan", 5), MOMENT)
    placing.step(frames.lookup, MOMENT)

    def lookup(frame: str, stamp_ns: int) -> Pose:
        raise ExtrapolationError(frame, stamp_ns, 100, 200)

    placing.offer({"": Placed("scan", 5, {})}, MOMENT)
    shown = placing.step(lookup, MOMENT)
    assert shown is not None
    assert shown.poses == {"": (NO_TURN, (5.0, 0.0, 0.0))}


def test_what_is_beside_its_frame_goes_with_it():
    placing = Placing()
    turned_about_z = (2**-0.5, 0.0, 0.0, 2**-0.5)
    offset = ((1.0, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0))
    placing.offer({"a": Placed("arm", 0, {}, follows=True, offset=offset)}, 0)
    shown = placing.step(lambda _frame, _stamp_ns: (turned_about_z, (0.0, 0.0, 2.0)), 0)
    assert shown is not None
    pose = shown.poses["a"]
    assert pose is not None
    assert pose[0] == pytest.approx(turned_about_z)
    assert pose[1] == pytest.approx((0.0, 1.0, 2.0))


def test_what_moves_in_its_frame_stays_with_it_though_the_time_of_its_pose_is_forgotten():
    placing, frames = Placing(), Frames(scan=10)
    quarter = (0.5**0.5, 0.0, 0.0, 0.5**0.5)
    placing.offer({"": Placed("scan", 5, {}, offset=(quarter, (0.0, 2.0, 0.0)))}, MOMENT)
    shown = placing.step(frames.lookup, MOMENT)
    assert shown is not None
    assert shown.poses == {"": (quarter, (5.0, 2.0, 0.0))}
    del frames.known_until["scan"]
    placing.offer({"": Placed("scan", 5, {}, offset=(NO_TURN, (0.0, 3.0, 0.0)))}, MOMENT)
    shown = placing.step(frames.lookup, MOMENT)
    assert shown is not None
    assert shown.poses == {"": (NO_TURN, (5.0, 3.0, 0.0))}
    assert not placing.troubles
