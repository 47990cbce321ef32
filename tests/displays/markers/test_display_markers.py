from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.displays.display import Received
from studio.displays.markers.display import MarkerArrayDisplay
from studio.displays.markers.kinds import Action, Kind
from studio.errors import CdrError, DisplayPropertyError
from tests.support.markers import TYPES, array_of, marker, sentences, shapes_in

if TYPE_CHECKING:
    from studio.displays.properties import Value

S = 10**9


def names(display: MarkerArrayDisplay) -> list[str]:
    return [one.name for one in display.properties()]


def with_lanes() -> MarkerArrayDisplay:
    display = MarkerArrayDisplay(TYPES)
    display.take(array_of(marker(Kind.CUBE, ns="lane"), marker(Kind.SPHERE, ns="wall")))
    return display


def shown(display: MarkerArrayDisplay, now_ns: int = 0) -> list[str]:
    return sorted(shapes_in(display.draw(now_ns)))


def test_namespaces_are_properties_when_they_are_heard_of():
    display = MarkerArrayDisplay(TYPES)
    assert names(display) == ["Namespaces"]
    display.take(array_of(marker(Kind.CUBE, ns="lane"), marker(Kind.CUBE, ns="")))
    assert names(display) == ["Namespaces", "Namespaces/lane", "Namespaces/"]
    display.take(array_of(marker(Kind.CUBE, ns="lane", action=int(Action.DELETE))))
    assert names(display) == ["Namespaces", "Namespaces/lane", "Namespaces/"]
    display.reset()
    assert names(display) == ["Namespaces"]


def test_a_namespace_is_hidden_and_shown_with_what_it_was():
    display = with_lanes()
    first = display.draw(0)
    display.set("Namespaces/lane", value=False)
    assert shown(display) == ["balls"]
    display.take(array_of(marker(Kind.CYLINDER, 1, ns="lane")))
    assert shown(display) == ["balls"]
    display.take(array_of(marker(Kind.CYLINDER, 1, ns="lane", action=int(Action.DELETE))))
    display.set("Namespaces/lane", value=True)
    again = display.draw(0)
    assert shapes_in(again).keys() == shapes_in(first).keys()


def test_switching_all_off_and_on_leaves_each_as_it_was():
    display = with_lanes()
    display.set("Namespaces/lane", value=False)
    display.set("Namespaces", value=False)
    assert shown(display) == []
    display.set("Namespaces", value=True)
    assert shown(display) == ["balls"]


@pytest.mark.parametrize("first", ["Namespaces", "Namespaces/lane"])
def test_what_is_saved_means_the_same_in_any_order(first: str):
    values: dict[str, Value] = {
        "Namespaces": True,
        "Namespaces/lane": False,
        "Namespaces/wall": True,
    }
    display = MarkerArrayDisplay(TYPES, {first: values[first]} | values)
    display.take(array_of(marker(Kind.CUBE, ns="lane"), marker(Kind.SPHERE, ns="wall")))
    assert shown(display) == ["balls"]


def test_a_namespace_that_was_saved_as_hidden_is_hidden_when_it_comes():
    display = MarkerArrayDisplay(TYPES, {"Namespaces/lane": False})
    display.take(array_of(marker(Kind.CUBE, ns="lane"), marker(Kind.SPHERE, ns="wall")))
    assert shown(display) == ["balls"]
    display.reset()
    display.take(array_of(marker(Kind.CUBE, ns="lane")))
    assert shown(display) == []


def test_what_is_no_namespace_or_no_switch_is_refused(monkeypatch: pytest.MonkeyPatch):
    display = with_lanes()
    with pytest.raises(DisplayPropertyError, match="is on or off"):
        display.set("Namespaces/lane", "yes")
    with pytest.raises(DisplayPropertyError, match="is no property of MarkerArray"):
        display.set("Alpha", 1.0)
    monkeypatch.setattr(display, "SETTINGS_MAX", 1)
    with pytest.raises(DisplayPropertyError, match="one too many"):
        display.set("Namespaces/more", value=False)


def test_lifetimes_begin_when_a_message_comes_and_end_to_the_nanosecond():
    display = MarkerArrayDisplay(TYPES)
    display.take(
        array_of(
            marker(Kind.CUBE, 0, lifetime_ns=2 * S, stamp_ns=50 * S),
            marker(Kind.SPHERE, 1, lifetime_ns=3 * S),
            marker(Kind.CYLINDER, 2),
            at_ns=100 * S,
        )
    )
    assert shown(display, 102 * S - 1) == ["balls", "boxes", "cylinders"]
    assert shown(display, 102 * S) == ["balls", "cylinders"]
    assert shown(display, 103 * S) == ["cylinders"]
    assert shown(display, 10**9 * S) == ["cylinders"]


def test_a_marker_that_comes_again_lives_again():
    display = MarkerArrayDisplay(TYPES)
    for second in range(5):
        display.take(array_of(marker(Kind.CUBE, lifetime_ns=2 * S), at_ns=second * S))
        assert shown(display, second * S + 1) == ["boxes"]
    display.take(array_of(marker(Kind.CUBE), at_ns=5 * S))
    assert shown(display, 100 * S) == ["boxes"]


def test_the_longest_lifetime_is_no_trouble():
    display = MarkerArrayDisplay(TYPES)
    display.take(array_of(marker(Kind.CUBE, lifetime_ns=(2**31 - 1) * S), at_ns=1_800_000_000 * S))
    assert shown(display, 1_900_000_000 * S) == ["boxes"]


def test_bytes_that_are_no_message_leave_what_was_drawn():
    display = with_lanes()
    before = display.draw(0)
    with pytest.raises(CdrError):
        display.take(Received("visualization_msgs/msg/MarkerArray", b"\0\1\0\0\xff\xff\xff\xff", 0))
    assert display.draw(0) is before


def test_a_display_without_trouble_says_nothing():
    assert MarkerArrayDisplay(TYPES).statuses() == ()
    assert with_lanes().statuses() == ()


def test_it_says_that_all_markers_are_gone():
    display = with_lanes()
    display.take(array_of(marker(0, action=int(Action.DELETE_ALL), ns="")))
    assert display.draw(0) == {}
    assert sentences(display) == [
        "There are no markers: all were deleted, or their lifetime is over."
    ]


def test_of_a_marker_that_is_left_out_it_is_not_said_that_it_was_deleted():
    display = MarkerArrayDisplay(TYPES)
    display.take(array_of(marker(Kind.CUBE, at=(float("nan"), 0.0, 0.0))))
    assert display.draw(0) == {}
    [status] = display.statuses()
    assert (status.level, status.reason) == ("error", "not_finite")


@pytest.mark.parametrize("off", [["Namespaces"], ["Namespaces/lane", "Namespaces/wall"]])
def test_it_says_that_all_namespaces_are_off_and_how_to_see_them(off: list[str]):
    display = with_lanes()
    for name in off:
        assert display.statuses() == ()
        display.set(name, value=False)
    [status] = display.statuses()
    assert status.sentence == "Markers are there, and all of their namespaces are switched off."
    assert status.mend == (off[0], True)
    display.set(off[0], value=True)
    assert display.statuses() == ()
    assert "boxes" in shown(display)


def test_of_namespaces_that_are_off_one_is_offered_that_holds_markers():
    display = with_lanes()
    display.take(array_of(marker(0, ns="lane", action=int(Action.DELETE_ALL))))
    display.set("Namespaces/wall", value=False)
    [status] = display.statuses()
    assert status.mend == ("Namespaces/wall", True)
