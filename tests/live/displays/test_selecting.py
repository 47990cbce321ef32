"""What is pointed at in 3D becomes items, which are followed from message to message."""

from __future__ import annotations

import asyncio
import time
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import pytest

from studio.displays.display import Limits, StillDisplay
from studio.displays.drawing import Placed, Points, Text
from studio.displays.laser_scan import LaserScanDisplay
from studio.displays.markers.display import MarkerDisplay
from studio.displays.point_cloud2 import PointCloud2Display
from studio.errors import FrameError
from studio.live.displays.placing import Shown
from studio.live.displays.selecting import AllDrawn, Selecting
from studio.protocol.selection import (
    DescribeItems,
    ItemKeys,
    ItemRef,
    PickedNode,
    PickItems,
)
from studio.robot.urdf_text import robot_from_urdf
from tests.support.clouds import CLOUD
from tests.support.display_messages import NOW_NS, TYPES, point, pose, received

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from studio.displays.display import Display, Received
    from studio.displays.drawing import Drawing, Pose

MARKER: Final = "visualization_msgs/msg/Marker"
ROBOT: Final = robot_from_urdf('<robot name="r"><link name="base"/></robot>')
LEFT: Final[Pose] = ((0.7071067811865476, 0.0, 0.0, 0.7071067811865476), (10.0, 0.0, 0.0))
"""A quarter turn to the left, 10 m ahead."""


class Drawn(NamedTuple):
    """A display whose drawing stands where it is told."""

    display: Display
    pose: Pose | None = LEFT

    @property
    def shown(self) -> Shown:
        drawing = self.display.draw(NOW_NS)
        return Shown(drawing, dict.fromkeys(drawing, self.pose))


def marker(number: int = 1, x: float = 1.0, action: int = 0) -> Any:  # noqa: ANN401
    fields = {
        "ns": "a/b", "id": number, "type": 1, "action": action, "pose": pose((x, 2.0, 3.0)),
        "scale": point(0.1, 0.2, 0.3), "color": {"r": 1.0, "g": 0.5, "b": 0.0, "a": 1.0},
    }  # fmt: skip
    return received(MARKER, fields)


def markers(*numbers: int) -> MarkerDisplay:
    display = MarkerDisplay(TYPES)
    for number in numbers:
        display.take(marker(number))
    display.draw(NOW_NS)
    return display


def lookup(frame: str, stamp_ns: int) -> Pose:
    if frame != "base" or stamp_ns:
        raise FrameError(frame)
    return LEFT


def selecting(displays: Mapping[str, Drawn | Swept]) -> Selecting:
    return Selecting(lambda: AllDrawn(displays, ROBOT, lookup, "world"))


def node(display: str, path: str, shape: str, part: str, *rows: int) -> PickedNode:
    return PickedNode(display=display, path=path, shape=shape, node=part, rows=rows)


def boxes(drawn: Drawn) -> tuple[str, str]:
    """Path and name of the shape with boxes."""
    ((path, placed),) = drawn.shown.drawing.items()
    (name,) = placed.shapes
    return path, name


def refs(answer: Any) -> list[tuple[str, str]]:  # noqa: ANN401
    return [(one.display, one.key) for one in answer.items]


def test_what_was_pointed_at_is_named_once_and_what_is_not_there_is_ignored():
    drawn = Drawn(markers(1, 2))
    path, name = boxes(drawn)
    command = PickItems(
        nodes=(
            node("d1", path, name, "many", 1, 1, 0, 99),
            node("d1", path, name, "many", 0),
            node("d1", "no such path", name, "many", 0),
            node("d1", path, "no such shape", "many", 0),
            node("d9", path, name, "many", 0),
        )
    )
    answer = asyncio.run(selecting({"d1": drawn}).pick(command))
    assert refs(answer) == [("d1", "1/a/b"), ("d1", "2/a/b")]
    assert answer.left_out == 0


def test_an_item_is_described_in_its_frame_and_in_the_fixed_one():
    items = selecting({"d1": Drawn(markers(1))})
    ref = ItemRef(display="d1", key="1/a/b")
    command = DescribeItems(
        items=(ItemKeys(display="d1", keys=("1/a/b", "2/a/b")),), detailed=(ref,)
    )
    answer = asyncio.run(items.describe(command))
    (view,) = answer.items
    assert (view.kind, view.name, view.frame, answer.fixed) == ("marker", "a/b/1", "map", "world")
    assert view.place == pytest.approx((8.0, 1.0, 3.0))
    assert view.box == (1.0, 2.0, 3.0, 0.1, 0.2, 0.3)
    (details,) = answer.details
    facts = {one.name: one.value for one in details.facts}
    assert facts["color"] == (1.0, 0.5, 0.0, 1.0)
    in_fixed = {one.name: one.value for one in details.in_fixed}
    assert in_fixed["position"] == pytest.approx((8.0, 1.0, 3.0))
    assert in_fixed["orientation"] == pytest.approx((0.0, 0.0, 0.7071068, 0.7071068))


def test_an_item_is_followed_until_it_is_gone():
    drawn = Drawn(markers(1))
    items = selecting({"d1": drawn})
    command = DescribeItems(items=(ItemKeys(display="d1", keys=("1/a/b",)),))
    drawn.display.take(marker(x=5.0))
    (view,) = asyncio.run(items.describe(command)).items
    assert view.place == pytest.approx((8.0, 5.0, 3.0))
    drawn.display.take(marker(action=2))
    drawn.display.draw(NOW_NS)
    assert asyncio.run(items.describe(command)).items == ()


def test_an_item_whose_frame_is_not_connected_has_no_place():
    items = selecting({"d1": Drawn(markers(1), None)})
    ref = ItemRef(display="d1", key="1/a/b")
    command = DescribeItems(items=(ItemKeys(display="d1", keys=("1/a/b",)),), detailed=(ref,))
    answer = asyncio.run(items.describe(command))
    assert answer.items[0].place is None
    assert answer.details[0].in_fixed == ()
    assert answer.details[0].facts


def test_a_link_of_the_document_is_an_item_without_a_display():
    ref = ItemRef(display="", key="base")
    command = DescribeItems(
        items=(ItemKeys(display="", keys=("base", "no such")),), detailed=(ref,)
    )
    answer = asyncio.run(selecting({}).describe(command))
    (view,) = answer.items
    assert (view.kind, view.name, view.place) == ("link", "base", (10.0, 0.0, 0.0))
    assert [one.name for one in answer.details[0].in_fixed] == ["position", "orientation"]


def test_a_namespace_that_no_page_could_send_back_is_left_out():
    display = markers(1)
    fields = {"ns": "n" * 500, "id": 2, "type": 1, "pose": pose(), "scale": point(1.0, 1.0, 1.0)}
    display.take(received(MARKER, {**fields, "color": {"r": 1.0, "g": 1.0, "b": 1.0, "a": 1.0}}))
    drawn = Drawn(display)
    nodes = tuple(
        node("d1", path, name, "many", 0)
        for path, placed in drawn.shown.drawing.items()
        for name in placed.shapes
    )
    answer = asyncio.run(selecting({"d1": drawn}).pick(PickItems(nodes=nodes)))
    assert refs(answer) == [("d1", "1/a/b")]
    assert answer.left_out == 1


class Plain(StillDisplay):
    """A display that does not say what its shapes are, as somebody's own may be."""

    def _drawn(self) -> Drawing:
        return {"a/b": Placed("map", 7, {"words": Text("words", (1.0, 2.0, 3.0))})}


def test_a_display_that_does_not_say_what_it_draws_is_selected_group_by_group():
    drawn = Drawn(Plain(TYPES))
    items = selecting({"d1": drawn})
    answer = asyncio.run(items.pick(PickItems(nodes=(node("d1", "a/b", "words", "text", 0),))))
    assert refs(answer) == [("d1", "a/b")]
    command = DescribeItems(items=(ItemKeys(display="d1", keys=("a/b", "c")),))
    (view,) = asyncio.run(items.describe(command)).items
    assert (view.kind, view.name, view.frame, view.stamp) == (
        "message",
        "a/b",
        "map",
        "0.000000007",
    )
    assert view.place == pytest.approx((8.0, 1.0, 3.0))


class Swept(NamedTuple):
    """A scan whose points are drawn 1 m higher than its message has them."""

    display: LaserScanDisplay

    @property
    def shown(self) -> Shown:
        ((path, placed),) = self.display.draw(NOW_NS).items()
        points = placed.shapes["points"]
        assert isinstance(points, Points)
        assert placed.sweep is not None
        moved = replace(points, positions=points.positions + np.array([0, 0, 1], np.float32))
        return Shown({path: replace(placed, shapes={"points": moved})}, {path: LEFT})


def test_a_beam_of_a_turning_lidar_is_where_it_is_drawn():
    display = LaserScanDisplay(TYPES)
    fields = {
        "angle_increment": 0.1,
        "range_max": 9.0,
        "time_increment": 0.01,
        "ranges": [1.0, 2.0],
    }
    display.take(received("sensor_msgs/msg/LaserScan", fields))
    items = selecting({"d1": Swept(display)})
    command = DescribeItems(items=(ItemKeys(display="d1", keys=("newest/0",)),))
    (view,) = asyncio.run(items.describe(command)).items
    assert view.place == pytest.approx((10.0, 1.0, 1.0))
    assert view.box is not None
    assert view.box[:3] == pytest.approx((1.0, 0.0, 1.0))


def test_of_too_many_items_some_of_each_display_are_taken_and_the_loop_has_its_turns():
    """A cloud of a million points, all of which were pointed at."""
    display = PointCloud2Display(TYPES, {"Points at most": 1_000_000})
    display.limit(Limits(points=1_000_000))
    display.take(cloud_of(np.random.default_rng(1).random((1_000_000, 3), np.float32)))
    drawn = Drawn(display)
    drawn.shown  # noqa: B018 - drawn before
    items = selecting({"d1": drawn, "d2": drawn})
    rows = tuple(range(0, 1_000_000, 25))
    command = PickItems(
        nodes=(node("d1", "0", "points", "points", *rows), node("d2", "0", "points", "points", 7))
    )
    (answer, longest_s) = asyncio.run(watched(items.pick(command)))
    assert len(answer.items) == 4000
    assert ("d2", "newest/7") in refs(answer)
    assert answer.left_out == 40_001 - 4000
    assert longest_s < 0.05
    keys = tuple(one.key for one in answer.items if one.display == "d1")
    describe = DescribeItems(items=(ItemKeys(display="d1", keys=keys),))
    (described, longest_s) = asyncio.run(watched(items.describe(describe)))
    assert len(described.items) == 3999
    assert longest_s < 0.05


def cloud_of(places: NDArray[np.float32]) -> Received:
    """A cloud of x, y and z, shape (N, 3)."""
    fields = [{"name": name, "offset": 4 * at, "datatype": 7} for at, name in enumerate("xyz")]
    whole = {
        "height": 1, "width": len(places), "fields": [{**one, "count": 1} for one in fields],
        "point_step": 12, "row_step": 12 * len(places), "data": places.tobytes(), "is_dense": True,
    }  # fmt: skip
    return received(CLOUD, whole)


async def watched(work: Any) -> tuple[Any, float]:  # noqa: ANN401 - what it answers
    """The answer, and how long the loop worked without a turn for others at most, s."""
    turns: list[float] = [time.thread_time()]

    async def look() -> None:
        while True:
            await asyncio.sleep(0)
            turns.append(time.thread_time())

    looking = asyncio.create_task(look())
    answer = await work
    looking.cancel()
    turns.append(time.thread_time())
    return answer, max(b - a for a, b in pairwise(turns))
