import math

import pytest

from studio.displays.properties import FIXED_FRAME
from studio.errors import DisplayPropertyError, ViewError
from studio.rviz.views import VIEW_KINDS, ViewSpec, view_kind


def firsts(kind: str) -> dict[str, object]:
    return {one.name: one.default for one in VIEW_KINDS[kind].properties}


def test_the_kinds_are_rvizs_and_each_can_follow_a_frame():
    assert list(VIEW_KINDS) == [
        "Orbit",
        "XYOrbit",
        "FPS",
        "TopDownOrtho",
        "ThirdPersonFollower",
        "FrameAligned",
    ]
    for kind in VIEW_KINDS:
        assert firsts(kind)["Target Frame"] == FIXED_FRAME
        assert firsts(kind)["Near Clip Distance"] == 0.01


def test_first_values_are_rvizs():
    orbit = firsts("Orbit")
    assert orbit["Distance"] == 10.0
    assert orbit["Yaw"] == orbit["Pitch"] == math.pi / 4
    assert [orbit[f"Focal Point/{axis}"] for axis in "XYZ"] == [0.0, 0.0, 0.0]
    assert (orbit["Focal Shape Size"], orbit["Focal Shape Fixed Size"]) == (0.05, True)
    fps = firsts("FPS")
    assert [fps[f"Position/{axis}"] for axis in "XYZ"] == [5.0, 5.0, 10.0]
    top = firsts("TopDownOrtho")
    assert (top["Scale"], top["Angle"], top["X"], top["Y"]) == (10.0, 0.0, 0.0, 0.0)
    assert "Invert Z Axis" not in fps
    assert "Orthographic" not in top


def test_a_views_values_are_held_within_rvizs_ranges():
    spec = ViewSpec("Orbit", " Side ", {"Pitch": 9.0, "Distance": -1}).checked()

    assert spec == ViewSpec("Orbit", "Side", {"Pitch": math.pi / 2 - 0.001, "Distance": 0.001})


@pytest.mark.parametrize(
    ("kind", "values", "error", "sentence"),
    [
        ("Ego", {}, ViewError, 'There is no view "Ego": it is one of Orbit, XYOrbit'),
        ("FPS", {"Distance": 1.0}, ViewError, 'A view "FPS" has no property "Distance"'),
        ("Orbit", {"Yaw": "left"}, DisplayPropertyError, "Yaw is a number"),
        ("FrameAligned", {"Point towards": "up"}, DisplayPropertyError, "is one of arbitrary"),
    ],
)
def test_what_is_no_view_is_refused_with_a_sentence(
    kind: str, values: dict[str, float | str], error: type[Exception], sentence: str
):
    with pytest.raises(error, match=sentence):
        ViewSpec(kind, "", values).checked()


def test_a_kind_is_found_by_rvizs_name_of_its_class():
    assert view_kind("XYOrbit").property("Focal Point/Z").unit == "m"
