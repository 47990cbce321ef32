"""One interactive marker, from the bytes in which it would come to what is drawn of it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from studio.displays.drawing import Placed, Solids, Text, Triangles
from studio.displays.interactive_marker import MarkerModel, MenuItem, read_marker
from studio.errors import DisplayMessageError, UnknownFrameError
from studio.ros.cdr import codec_of
from studio.ros.interactive_markers.names import MARKER, Mode, OrientationMode
from studio.ros.interactive_markers.tools import auto_complete
from tests.support.display_messages import TYPES, encoded, point, pose
from tests.support.drawn import assert_drawable, plain
from tests.support.interactive_markers import moving_marker

if TYPE_CHECKING:
    from studio.displays.drawing import Pose, Shape
    from studio.ros.types.classes import MessageValue

HALF = math.sqrt(0.5)
BLUE = {"w": HALF, "x": 0.0, "y": HALF, "z": 0.0}
"""A control whose x is the z of the marker."""
ARROW_SHAFTS = {
    "shape": "Solids",
    "kind": "cylinder",
    "positions": [[1.2, 0.0, 0.0], [-1.2, 0.0, 0.0]],
    "wxyz": [[0.70711, 0.0, 0.70711, 0.0], [0.70711, 0.0, -0.70711, 0.0]],
    "scales": [[0.3, 0.3, 0.4], [0.3, 0.3, 0.4]],
    "colors": [255.0, 0.0, 0.0],
    "opacities": 0.50196,
}
ARROW_HEADS = {
    **ARROW_SHAFTS,
    "kind": "cone",
    "positions": [[1.8, 0.0, 0.0], [-1.8, 0.0, 0.0]],
    "wxyz": [[0.0, 0.70711, 0.0, -0.70711], [0.0, 0.70711, 0.0, 0.70711]],
    "scales": [[0.5, 0.5, 0.4], [0.5, 0.5, 0.4]],
}
BOX = {"type": 1, "scale": point(0.2, 0.2, 0.2), "color": {"r": 1.0, "a": 1.0}}


def read(
    fields: dict[str, Any],
    *,
    transparent: bool = True,
    frames: dict[str, Pose] | None = None,
) -> MarkerModel:
    """A marker of these fields, as a client completes it."""

    def seen_from(target: str, frame: str, stamp_ns: int) -> Pose:
        assert (target, stamp_ns) == ("base", 0)
        if frames is None or frame not in frames:
            raise UnknownFrameError(frame)
        return frames[frame]

    whole = {"name": "one", "header": {"frame_id": "base"}, "scale": 2.0, **fields}
    message = codec_of(TYPES.message(MARKER)).decode(encoded(MARKER, whole))
    auto_complete(message, TYPES, transparent=transparent)
    return read_marker(message, TYPES, seen_from)


def only_shape(model: MarkerModel) -> Shape:
    (control,) = model.controls
    (shape,) = control.shapes.values()
    return shape


def of_mode(mode: Mode, **fields: Any) -> dict[str, Any]:  # noqa: ANN401
    return {"controls": [{"name": "c", "interaction_mode": int(mode), **fields}]}


def test_an_axis_has_two_arrows_in_its_colour_that_can_be_seen_through():
    (control,) = read(of_mode(Mode.MOVE_AXIS)).controls
    shafts, heads = control.shapes.values()
    assert [plain(shafts), plain(heads)] == [ARROW_SHAFTS, ARROW_HEADS]
    (opaque,) = read(of_mode(Mode.MOVE_AXIS), transparent=False).controls
    assert all(isinstance(one, Solids) and one.opacities == 1.0 for one in opaque.shapes.values())
    (upright,) = read(of_mode(Mode.MOVE_AXIS, orientation=BLUE)).controls
    for one in upright.shapes.values():
        assert isinstance(one, Solids)
        assert one.colors.tolist() == [0, 0, 255]
        assert np.abs(one.positions[:, :2]).max() < 1e-6


@pytest.mark.parametrize(
    ("mode", "shades"),
    [(Mode.MOVE_PLANE, 1), (Mode.ROTATE_AXIS, 2), (Mode.MOVE_ROTATE, 2)],
)
def test_a_plane_and_a_turn_have_a_ring_with_a_pattern_of_its_own(mode: Mode, shades: int):
    ring = only_shape(read(of_mode(mode)))
    assert isinstance(ring, Triangles)
    assert len(ring.faces) == 72
    radii = np.linalg.norm(ring.vertices, axis=1)
    assert (radii.min(), radii.max()) == (pytest.approx(1.0), pytest.approx(1.3))
    assert np.abs(ring.vertices[:, 0]).max() < 1e-6, "the axis is the x of the control"
    assert len(np.unique(ring.colors.reshape(-1, 3), axis=0)) == shades
    assert ring.colors.reshape(-1, 3).max(axis=0).tolist() == [255, 0, 0]


def test_a_menu_without_markers_is_its_description_over_it():
    fields = of_mode(Mode.MENU, description="Choose")
    (control,) = read(fields).controls
    assert control.facing == OrientationMode.VIEW_FACING
    (text,) = control.shapes.values()
    assert isinstance(text, Text)
    assert (text.text, text.height_m) == ("Choose", pytest.approx(0.5))
    assert text.position == pytest.approx((-0.05, 0.0, 2.35))


@pytest.mark.parametrize("mode", [Mode.NONE, Mode.BUTTON, Mode.MOVE_3D, Mode.ROTATE_3D, 200])
def test_other_modes_show_the_markers_that_they_have(mode: int):
    assert read({"controls": [{"interaction_mode": int(mode)}]}).controls[0].shapes == {}
    shape = only_shape(read({"controls": [{"interaction_mode": int(mode), "markers": [BOX]}]}))
    assert isinstance(shape, Solids)


def test_what_a_server_left_empty_is_filled_in():
    zero = {"w": 0.0}
    model = read(
        {
            "scale": 0.0,
            "description": "Title",
            "pose": {"orientation": zero},
            "controls": [
                {"name": "same", "interaction_mode": 3, "orientation": zero},
                {"name": "same", "interaction_mode": 5},
            ],
        }
    )
    assert model.scale == 1.0
    assert model.pose == ((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    assert [one.name for one in model.controls] == ["same", "same_u0"]
    (title,) = model.title.values()
    assert isinstance(title, Text)
    assert (title.text, title.position) == ("Title", pytest.approx((0.0, 0.0, 1.4)))


def test_markers_in_the_frame_of_the_interactive_marker_are_put_into_the_axes_of_its_control():
    """As those of MoveIt: they are where their header says, and go along from then on."""
    marker = {**BOX, "header": {"frame_id": "/base"}, "pose": pose((3.0, 1.0, 0.0))}
    turned = pose((1.0, 1.0, 0.0), (HALF, 0.0, 0.0, HALF))
    for facing, wanted in ((0, (0.0, -2.0, 0.0)), (1, (2.0, 0.0, 0.0))):
        control = {"orientation_mode": facing, "markers": [marker]}
        shape = only_shape(read({"pose": turned, "controls": [control]}))
        assert isinstance(shape, Solids)
        assert shape.positions[0].tolist() == pytest.approx(wanted, abs=1e-6)


def test_markers_in_other_frames_are_where_those_are_or_left_out():
    control = {"markers": [{**BOX, "header": {"frame_id": "arm"}, "pose": pose((1.0, 0.0, 0.0))}]}
    there = {"arm": ((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 5.0))}
    shape = only_shape(read({"controls": [control]}, frames=there))
    assert isinstance(shape, Solids)
    assert shape.positions[0].tolist() == [1.0, 0.0, 5.0]
    model = read({"controls": [control]})
    assert model.controls[0].shapes == {}
    assert "No transform tells of" in model.problems[0]


def test_a_menu_keeps_its_order_and_leaves_out_what_has_no_place_in_it():
    entries = [
        {"id": 1, "title": "One"},
        {"id": 2, "parent_id": 1, "title": "[x] Below"},
        {"id": 3, "parent_id": 99, "title": "Before its parent"},
        {"id": 1, "title": "Again"},
        {"id": 0, "title": "Of the root itself"},
    ]
    model = read({**of_mode(Mode.MENU), "menu_entries": entries})
    assert model.menu == (MenuItem(1, 0, "One", 0, ""), MenuItem(2, 1, "[x] Below", 0, ""))


NAN, FAR = math.nan, 1e300


@pytest.mark.parametrize(
    "fields",
    [
        {"pose": {"position": point(NAN, 0.0, 0.0)}},
        {"pose": {"position": point(0.0, math.inf, 0.0)}},
        {"pose": {"orientation": {"w": NAN}}},
        {"scale": NAN},
        {"scale": -1.0},
        {"header": {"frame_id": ""}},
        {"name": "n" * 1_000_000},
    ],
)
def test_a_marker_of_no_sense_is_refused_in_a_sentence(fields: dict[str, Any]):
    with pytest.raises(DisplayMessageError) as raised:
        read({**of_mode(Mode.MOVE_AXIS), **fields})
    assert len(str(raised.value)) < 300


def test_parts_of_no_sense_are_left_out_and_the_rest_stays():
    bad = {**BOX, "pose": {"position": point(NAN, 0.0, 0.0)}}
    controls: list[dict[str, Any]] = [
        {"name": "good", "markers": [BOX, bad]},
        {"name": "turned", "orientation": {"w": NAN}, "markers": [BOX]},
        {"name": "n" * 1_000_000, "markers": [BOX]},
        {"name": "wide", "markers": [{**BOX, "scale": point(FAR, 1.0, 1.0)}]},
        {"name": "long", "orientation": {"w": 1e6}, "markers": [BOX]},
    ]
    model = read({"controls": controls})
    assert [one.name for one in model.controls] == ["good", "wide", "long"]
    assert [len(one.shapes) for one in model.controls] == [1, 0, 1]
    assert model.controls[2].wxyz == (1.0, 0.0, 0.0, 0.0)
    assert len(model.problems) == 2
    for one in model.controls:
        assert_drawable({"m": Placed("base", 0, one.shapes)})


def test_a_marker_is_completed_as_its_server_completes_it():
    """The same whether it is made here or came: completing twice changes nothing."""

    def completed(times: int) -> MessageValue:
        marker = moving_marker(TYPES, "m", (Mode.MOVE_AXIS, Mode.ROTATE_AXIS, Mode.MENU))
        for _ in range(times):
            auto_complete(marker, TYPES)
        return marker

    assert completed(2) == completed(1)
