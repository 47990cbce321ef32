from __future__ import annotations

from typing import Any

import pytest

from studio.displays.markers.display import MarkerArrayDisplay
from studio.displays.markers.kinds import Action, Kind
from tests.support.markers import TYPES, array_of, marker, sentences

LINE = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0)]
CORNERS = [*LINE, (1.0, 1.0, 0.0)]
RED, CLEAR = (1.0, 0.0, 0.0, 1.0), (0.0, 0.0, 0.0, 0.0)
THIN = (0.0, 1.0, 1.0)
MESH = "package://rover/meshes/wheel.dae"
TROUBLES = {
    "scale of 0 in x, y or z": (marker(Kind.CUBE, scale=(1.0, 0.0, 1.0)), "warn", "empty", True),
    "which are drawn square": (
        marker(Kind.POINTS, points=LINE, scale=(1.0, 2.0, 0.0)), "warn", "unsupported", True,
    ),
    "alpha of 0; set color.a": (marker(Kind.CUBE, rgba=CLEAR), "warn", "transparent", False),
    "an alpha of 0": (
        marker(Kind.POINTS, points=LINE, colors=[CLEAR] * 2, scale=(1.0, 1.0, 0.0)),
        "warn", "transparent", False,
    ),
    "scale.x of 0": (marker(Kind.LINE_STRIP, points=LINE, scale=THIN), "warn", "empty", False),
    "has no text": (marker(Kind.TEXT), "warn", "empty", False),
    "the height of its text": (
        marker(Kind.TEXT, text="a", scale=(1.0, 1.0, 0.0)), "warn", "empty", False,
    ),
    "too few points": (marker(Kind.LINE_STRIP, points=LINE[:1]), "warn", "no_points", False),
    "names no frame": (marker(Kind.CUBE, frame=""), "error", "bad_message", False),
    "to nowhere": (marker(Kind.ARROW, points=LINE[:1]), "error", "no_points", False),
    "an odd number": (marker(Kind.LINE_LIST, points=CORNERS), "error", "no_points", False),
    "in threes": (marker(Kind.TRIANGLES, points=LINE), "error", "no_points", False),
    "names no mesh": (marker(Kind.MESH), "error", "no_mesh", False),
    "neither a package://": (
        marker(Kind.MESH, mesh_resource="embedded://m"), "error", "no_mesh", False,
    ),
    "a type that does not exist": (marker(13), "error", "unsupported", False),
    "not finite or too large": (
        marker(Kind.CUBE, at=(float("nan"), 0.0, 0.0)), "error", "not_finite", False,
    ),
    "an action that does not exist": (marker(Kind.CUBE, action=1), "error", "bad_message", False),
}  # fmt: skip


@pytest.mark.parametrize("words", list(TROUBLES))
def test_what_keeps_a_marker_from_being_seen_is_told_with_its_name(words: str):
    one, level, reason, is_drawn = TROUBLES[words]
    display = MarkerArrayDisplay(TYPES)
    display.take(array_of(one))
    status = display.statuses()[0]
    assert words in status.sentence
    assert status.sentence.startswith("Marker lane/0 ")
    assert status.sentence.endswith(".")
    assert (status.level, status.reason) == (level, reason)
    assert bool(display.draw(0)) == is_drawn


@pytest.mark.parametrize(
    "one",
    [
        marker(Kind.ARROW, points=LINE),
        marker(Kind.TRIANGLES, points=CORNERS, colors=[RED] * 3, rgba=CLEAR),
        marker(Kind.MESH, mesh_resource=MESH, mesh_use_embedded_materials=True, rgba=CLEAR),
        marker(Kind.LINE_STRIP, points=LINE, scale=(1.0, 0.0, 0.0)),
        marker(Kind.TEXT, text="a", scale=(0.0, 0.0, 1.0)),
        marker(Kind.SPHERE_LIST, points=LINE),
    ],
)  # fmt: skip
def test_nothing_is_said_of_markers_that_are_well(one: Any):  # noqa: ANN401
    display = MarkerArrayDisplay(TYPES)
    display.take(array_of(one))
    assert display.statuses() == ()
    assert display.draw(0)


def test_the_same_trouble_of_many_is_one_sentence_and_the_worst_comes_first():
    display = MarkerArrayDisplay(TYPES)
    clear = [marker(Kind.CUBE, each, rgba=CLEAR) for each in range(3, 8)]
    display.take(array_of(*clear, marker(Kind.CUBE, 1, frame="")))
    assert sentences(display) == [
        "Marker lane/1 names no frame in its header.",
        "Marker lane/3 (and 4 more) has an alpha of 0; set color.a to see it.",
    ]


def test_a_trouble_goes_with_its_cause():
    display = MarkerArrayDisplay(TYPES)
    display.take(array_of(marker(Kind.CUBE, rgba=CLEAR), marker(99, 1), marker(0, 2, action=1)))
    assert len(display.statuses()) == 3
    display.take(array_of(
        marker(Kind.CUBE), marker(0, 1, action=int(Action.DELETE)), marker(Kind.CUBE, 2)
    ))  # fmt: skip
    assert display.statuses() == ()


def test_nothing_is_said_of_namespaces_that_are_hidden():
    display = MarkerArrayDisplay(TYPES, {"Namespaces/lane": False})
    display.take(array_of(
        marker(99), marker(0, 1, action=1), marker(Kind.CUBE, 2, ns="wall")
    ))  # fmt: skip
    assert display.statuses() == ()


def test_two_markers_of_one_name_are_told_first():
    display = MarkerArrayDisplay(TYPES)
    display.take(array_of(marker(Kind.CUBE), marker(Kind.SPHERE)))
    assert sentences(display) == [
        "One message holds marker lane/0 more than once: the last one is shown."
    ]


def test_a_name_without_end_is_cut():
    display = MarkerArrayDisplay(TYPES)
    display.take(array_of(marker(99, ns="x" * 10_000)))
    assert len(sentences(display)[0]) < 120
