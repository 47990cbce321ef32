"""Every display says what its shapes are: items with boxes around them, and facts of messages."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np
import pytest

from studio.displays.catalogue import DISPLAYS, display_of_kind
from studio.displays.display import Display, Received
from studio.displays.drawing import Arrows, Axes, Lines, Picture, Points, Solids, Triangles
from studio.displays.robot_model import RobotModelDisplay
from studio.displays.selection import Box, Item, Picked, box_of, message_facts
from studio.displays.tf import TfDisplay
from studio.robot.urdf_text import robot_from_urdf
from studio.tf.buffer import TransformBuffer
from tests.support.display_messages import NOW_NS, TYPES, encoded, point, pose, received
from tests.support.display_samples import BASE, FRAMES, SAMPLES, Sample, headed
from tests.support.transforms import HandClock, S, Told, columns

if TYPE_CHECKING:
    from studio.displays.drawing import Shape

STAMP: Final = {"sec": 12, "nanosec": 500}
GHOSTS: Final = {"DisplayTrajectory", "JointTrajectory"}
"""They draw a robot that is given to them, and is not where it is drawn yet."""


def display_of(sample: Sample) -> Display:
    """The display of a sample, after its messages came."""
    display = display_of_kind(sample.kind)(TYPES, sample.values)
    if isinstance(display, TfDisplay):
        buffer = TransformBuffer(clock=HandClock())
        for parent, child, xyz, wxyz in FRAMES:
            buffer.put(columns(Told(parent, child, S, xyz, wxyz)), static=True)
        display.see(buffer.all_in("odom"))
        return display
    roles = {role.topic(sample.topic): role.name for role in display.roles()}
    for topic, (type_name, fields) in sample.messages().items():
        told = encoded(type_name, headed(type_name, fields, sample.frame, STAMP))
        display.take(Received(type_name, told, NOW_NS), roles[topic])
    if isinstance(display, RobotModelDisplay):
        display.show(robot_from_urdf(display.description))
    return display


def rows_in(shape: Shape) -> int:
    """How many rows can be pointed at."""
    match shape:
        case Points() | Axes() | Solids():
            return len(shape.positions)
        case Lines() | Arrows():
            return len(shape.ends)
        case Triangles():
            return len(shape.faces)
        case _:
            return 1


def picked_of(path: str, name: str, shape: Shape, row: int) -> Picked:
    """What is pointed at with a row of a shape: its item, if it has them."""
    items = getattr(shape, "items", None)
    number = row if items is None else int(items[row])
    return Picked(path, name, np.array([number], np.intp))


def every_key(display: Display) -> set[str]:
    """The keys of all that is drawn."""
    keys: set[str] = set()
    for path, placed in display.draw(NOW_NS).items():
        for name, shape in placed.shapes.items():
            for row in range(rows_in(shape)):
                found = display.picked(picked_of(path, name, shape, row))
                assert len(found) == 1, (path, name, row)
                keys.update(found)
    return keys


def item_of(display: Display, key: str) -> Item:
    item = display.item(key)
    assert item is not None
    return item


def facts_of(display: Display, key: str) -> dict[str, Any]:
    return {one.name: one.value for one in display.facts(key)}


def sample(name: str) -> Sample:
    return next(one for one in SAMPLES if one.name == name)


HEADED: Final = [
    one
    for one in SAMPLES
    if display_of_kind(one.kind).item is not Display.item and one.kind not in GHOSTS
]
"""Of displays that say what their shapes are; others are selected group by group."""


@pytest.mark.parametrize("one", HEADED, ids=[one.name for one in HEADED])
def test_all_that_is_drawn_is_an_item_in_a_group_of_the_drawing_with_a_box_and_facts(one: Sample):
    display = display_of(one)
    drawing = display.draw(NOW_NS)
    if not drawing:
        pytest.skip("draws nothing without the rest of the studio")
    keys = every_key(display)
    assert keys
    for key in sorted(keys)[:50]:
        item = item_of(display, key)
        assert item.path in drawing
        assert item.frame == drawing[item.path].frame
        if item.box is not None:
            assert min(item.box.size_m) > 0
            assert np.isfinite(item.box.middle).all()
        assert display.facts(key) or one.kind == "Axes"


@pytest.mark.parametrize("kind", [one.KIND for one in DISPLAYS])
@pytest.mark.parametrize(
    "key", ["", "0", "newest", "newest/7", "7/x", "-1/-1", "1" * 400, "/", "\n"]
)
def test_what_is_no_key_is_gone_and_nothing_is_known_of_it(kind: str, key: str):
    display = display_of_kind(kind)(TYPES)
    display.draw(NOW_NS)
    assert display.item(key) is None
    assert display.facts(key) == ()


def test_lines_of_a_grid_are_nothing_to_be_selected():
    display = display_of_kind("Grid")(TYPES)
    (path,) = display.draw(0)
    assert display.picked(Picked(path, "grid", np.zeros(1, np.intp))) == ()


def test_a_point_of_a_cloud_has_its_index_its_place_and_each_field_by_its_name():
    display = display_of(sample("cloud_intensity"))
    item = item_of(display, "newest/8450")
    facts = facts_of(display, "newest/8450")
    assert list(facts) == ["index", "position", "intensity"]
    assert facts["index"] == 8450
    at = -1.5 + 3.0 / 129 * np.array([8450 % 130, 8450 // 130])
    assert facts["position"] == pytest.approx(
        (*at, 0.2 * np.sin(3 * at[0]) * np.cos(2 * at[1]) - 0.1)
    )
    assert facts["intensity"] == pytest.approx(np.hypot(*at))
    assert (item.kind, item.name, item.frame, item.stamp_ns) == (
        "point",
        "8450",
        BASE,
        12_000_000_500,
    )


def test_a_colour_that_is_packed_into_a_float_is_shown_as_a_colour():
    display = display_of(sample("cloud_rgb"))
    (fact,) = (one for one in display.facts("newest/0") if one.name == "rgb")
    assert fact.kind == "colour"
    assert fact.value[3] == 1.0  # type: ignore[index]


def test_the_points_of_a_thinned_cloud_keep_their_index_in_the_message():
    display = display_of(sample("cloud_intensity"))
    display.set("Points at most", 1000)
    (placed,) = display.draw(NOW_NS).values()
    shape = placed.shapes["points"]
    assert isinstance(shape, Points)
    (key,) = display.picked(Picked("0", "points", np.array([999])))
    index = int(key.removeprefix("newest/"))
    assert index > 10_000
    assert facts_of(display, key)["position"] == pytest.approx(shape.positions[999].tolist())
    assert item_of(display, key).box == Box(
        tuple(shape.positions[999].tolist()), (0.02, 0.02, 0.02)
    )


def test_points_of_messages_that_decay_are_gone_with_their_message():
    display = display_of(sample("cloud_intensity"))
    display.set("Decay Time", 10.0)
    (key,) = display.picked(Picked("0", "points", np.array([3])))
    assert key == "1/3"
    assert display.item(key) is not None
    display.draw(NOW_NS + 11 * 10**9)
    assert display.item(key) is None


def test_a_beam_has_its_range_its_angle_and_its_intensity():
    display = display_of(sample("laser_scan"))
    item = item_of(display, "newest/360")
    facts = facts_of(display, "newest/360")
    assert item.kind == "beam"
    assert facts["angle"] == pytest.approx(0.0, abs=1e-6)
    assert facts["range"] == pytest.approx(facts["position"][0])
    assert facts["intensity"] == pytest.approx(200.0)


def test_a_cell_of_a_map_is_found_by_its_place_however_the_map_is_turned():
    fields = {
        "info": {
            "resolution": 0.5, "width": 4, "height": 3,
            "origin": pose((1.0, 2.0, 0.0), (0.7071067811865476, 0.0, 0.0, 0.7071067811865476)),
        },
        "data": list(range(12)),
    }  # fmt: skip
    display = display_of_kind("Map")(TYPES)
    display.take(received("nav_msgs/msg/OccupancyGrid", fields))
    # A quarter to the left: columns go along y, rows along -x.
    picked = Picked("map", "0-0", np.zeros(1, np.intp), (1.0 - 1.25, 2.0 + 0.75, 0.0))
    assert display.picked(picked) == ("2/1",)
    facts = facts_of(display, "2/1")
    assert (facts["row"], facts["column"], facts["index"], facts["value"]) == (2, 1, 9, 9)
    assert facts["position"] == pytest.approx((-0.25, 2.75, 0.0))
    assert display.picked(picked._replace(place=(5.0, 5.0, 0.0))) == ()
    assert display.picked(picked._replace(place=None)) == ("map",)
    assert facts_of(display, "map")["width"] == 4
    for key in ("3/0", "0/4", "0", "x/1", "-1/0"):
        assert display.item(key) is None


def test_markers_are_known_by_namespace_and_id_in_whatever_shape_they_are_drawn():
    display = display_of(sample("marker_array"))
    assert every_key(display) == {f"{number}/samples" for number in range(12)}
    facts = facts_of(display, "4/samples")
    assert (facts["ns"], facts["id"], facts["type"], facts["points"]) == (
        "samples",
        4,
        "LINE_STRIP",
        20,
    )
    assert facts["position"] == (-1.2, 0.0, 0.2)
    assert facts_of(display, "9/samples")["text"] == "Docking station"
    item = item_of(display, "1/samples")
    assert (item.kind, item.name) == ("marker", "samples/1")
    assert item.xyz == pytest.approx((-0.4, 0.8, 0.2))
    assert item.box == Box(item.xyz or (0.0, 0.0, 0.0), (0.3, 0.3, 0.3))


def test_a_marker_that_moves_keeps_its_key_and_one_that_is_deleted_is_gone():
    display = display_of(sample("marker"))
    (key,) = every_key(display)
    (_, (type_name, fields)) = next(iter(sample("marker").messages().items()))
    display.take(received(type_name, {**fields, "pose": pose((5.0, 6.0, 7.0))}))
    assert every_key(display) == {key}
    assert item_of(display, key).xyz == (5.0, 6.0, 7.0)
    display.take(received(type_name, {**fields, "action": 2}))
    display.draw(NOW_NS)
    assert display.item(key) is None


def test_a_marker_of_a_namespace_that_is_switched_off_is_gone():
    display = display_of(sample("marker"))
    (key,) = every_key(display)
    display.set("Namespaces/samples", False)
    display.draw(NOW_NS)
    assert display.item(key) is None


def test_a_pose_of_many_has_its_index_in_the_message_although_others_cannot_be_drawn():
    poses = [pose((float("nan"), 0.0, 0.0)), pose((1.0, 2.0, 3.0)), pose((4.0, 5.0, 6.0))]
    for kind, type_name, fields in (
        ("PoseArray", "geometry_msgs/msg/PoseArray", {"poses": poses}),
        ("Path", "nav_msgs/msg/Path", {"poses": [{"pose": one} for one in poses]}),
    ):
        display = display_of_kind(kind)(TYPES)
        display.take(received(type_name, fields))
        assert every_key(display) <= {"newest/1", "newest/2"}
        assert facts_of(display, "newest/2")["position"] == (4.0, 5.0, 6.0)
        assert item_of(display, "newest/1").xyz == (1.0, 2.0, 3.0)
        assert display.item("newest/0") is None


def test_a_pose_of_a_path_has_its_own_stamp():
    stamped = {"header": {"frame_id": "odom", "stamp": {"sec": 7, "nanosec": 8}}, "pose": pose()}
    display = display_of_kind("Path")(TYPES)
    display.take(received("nav_msgs/msg/Path", {"poses": [stamped, stamped]}))
    facts = facts_of(display, "newest/1")
    assert (facts["header.frame_id"], facts["header.stamp"]) == ("odom", "7.000000008")


def test_a_cell_of_grid_cells_has_its_index():
    display = display_of(sample("grid_cells"))
    (key,) = display.picked(Picked("0", "cells", np.array([14, 15])))
    assert key == "newest/7"
    assert facts_of(display, key)["cell_width"] == pytest.approx(0.1)


def test_messages_of_a_history_are_apart_and_the_oldest_one_is_gone_when_it_is_dropped():
    display = display_of_kind("TwistStamped")(TYPES, {"History Length": 2})
    one = sample("twist")
    for x in (1.0, 2.0):
        fields = {"twist": {"linear": point(x, 0.0, 0.0), "angular": point(0.0, 0.0, 0.0)}}
        display.take(received(one.type_name, fields))
    assert every_key(display) == {"1", "2"}
    assert facts_of(display, "1")["twist.linear"] == (1.0, 0.0, 0.0)
    display.take(received(one.type_name, one.fields))
    display.draw(NOW_NS)
    assert display.item("1") is None
    assert facts_of(display, "2")["twist.linear"] == (2.0, 0.0, 0.0)


def test_a_frame_has_its_parent_and_its_pose_there():
    display = display_of(sample("tf"))
    display.draw(NOW_NS)
    facts = facts_of(display, "dock")
    assert (facts["name"], facts["parent"]) == ("dock", "odom")
    assert facts["position"] == pytest.approx((-0.8, -0.6, 0.0))
    assert facts["orientation"] == pytest.approx((0.0, 0.0, 0.0, 1.0))
    assert item_of(display, "dock").xyz == pytest.approx((-0.8, -0.6, 0.0))
    assert display.picked(Picked("names/dock", "name", np.zeros(1, np.intp))) == ("dock",)


def test_a_joint_has_its_effort_and_the_limit_of_it():
    display = display_of(sample("effort"))
    (key,) = every_key(display)
    assert facts_of(display, key) == {"name": "turn", "effort": 2.0, "limit.effort": 10.0}


def test_a_link_has_the_joint_above_it():
    display = display_of(sample("robot_model"))
    facts = facts_of(display, "sensor")
    assert (facts["parent"], facts["joint"], facts["type"]) == ("laser", "jib", "fixed")


def test_fields_of_a_message_are_as_they_were_sent_and_long_ones_are_counted():
    display = display_of(sample("odometry"))
    (key,) = every_key(display)
    facts = facts_of(display, key)
    assert facts["child_frame_id"] == BASE
    assert facts["pose.pose.position"] == (0.3, 0.2, 0.0)
    assert len(facts["pose.covariance"]) == 36
    kind = TYPES.message("sensor_msgs/msg/LaserScan")
    scan = kind(ranges=np.ones(1000, np.float32), range_max=float("inf"))
    found = {one.name: one.value for one in message_facts(scan)}
    assert (found["ranges"], found["range_max"]) == ("[1,000]", "inf")


def test_a_box_is_around_all_shapes_and_unknown_where_one_of_them_is():
    solid = Solids(
        "box",
        np.array([[1, 0, 0]], np.float32),
        np.array([[0.70710678, 0, 0, 0.70710678]], np.float32),
        np.array([[2, 1, 1]], np.float32),
        np.zeros(3, np.uint8),
    )
    box = box_of({"solid": solid})
    assert box is not None
    assert box.middle == pytest.approx((1, 0, 0))
    assert box.size_m == pytest.approx((1, 2, 1), abs=1e-6)
    assert box_of({}) is None


def test_a_box_is_around_a_picture_as_it_is_turned():
    half = 0.5**0.5
    picture = Picture(
        np.zeros((1, 1, 4), np.uint8), (2.0, 1.0), (5.0, 0.0, 1.0), (half, 0.0, 0.0, half)
    )
    box = box_of({"picture": picture})
    assert box is not None
    np.testing.assert_allclose(box.middle, (4.5, 1.0, 1.0))
    np.testing.assert_allclose(box.size_m[:2], (1.0, 2.0))
