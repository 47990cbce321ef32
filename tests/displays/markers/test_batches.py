from __future__ import annotations

import re
from copy import deepcopy
from typing import TYPE_CHECKING, Any

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule

from studio.displays.drawing import Lines, Points, Solids
from studio.displays.markers import batches as batches_module
from studio.displays.markers.batches import shapes_of
from studio.displays.markers.display import MarkerArrayDisplay
from studio.displays.markers.kinds import Action, Kind
from studio.displays.markers.store import APART_MAX
from tests.support.markers import TYPES, array_of, marker, sentences, shapes_in

if TYPE_CHECKING:
    from collections.abc import Callable

    import pytest

    from studio.displays.drawing import Drawing, Shape
    from studio.displays.markers.table import Rows

S = 10**9
LINE = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0)]
HALF_RED = (0.9, 0.0, 0.2, 0.5)
DELETE_ALL = int(Action.DELETE_ALL)
NAMESPACES = ("lane", "wall", "")


class Shown:
    """A display that draws after each message."""

    def __init__(self) -> None:
        self.display = MarkerArrayDisplay(TYPES)

    def after(self, *markers: Any) -> Drawing:  # noqa: ANN401
        self.display.take(array_of(*markers))
        return self.display.draw(0)


def test_a_message_that_changes_nothing_leaves_the_very_same_drawing():
    shown = Shown()
    many = [
        *(marker(Kind.CUBE, each, at=(each, 0.0, 0.0)) for each in range(4)),
        marker(Kind.LINE_STRIP, 4, points=LINE),
        marker(Kind.TEXT, 5, text="here"),
    ]
    first = shown.after(*many)
    assert shown.after(*many) is first
    assert shown.display.draw(5) is first


def test_deleting_all_and_saying_the_same_again_leaves_the_very_same_drawing():
    shown = Shown()
    clear = marker(0, action=DELETE_ALL, ns="")
    many = [marker(kind, kind.value, points=LINE, text="a") for kind in list(Kind)[:10]]
    first = shown.after(clear, *many)
    assert len(shapes_in(first)) == 7
    assert shown.after(clear, *many) is first


def test_shapes_that_did_not_change_are_the_same_objects_in_a_new_drawing():
    shown = Shown()
    first = shown.after(
        marker(Kind.CUBE, ns="a"), marker(Kind.CUBE, ns="b"), marker(Kind.SPHERE, 1, ns="b")
    )
    second = shown.after(marker(Kind.CUBE, ns="b", at=(9.0, 9.0, 9.0)))
    [old], [new] = first.values(), second.values()
    assert old.shapes.keys() == new.shapes.keys()
    changed = [name for name in new.shapes if new.shapes[name] is not old.shapes[name]]
    assert [name.split("-", 1)[1] for name in changed] == ["boxes"]


def test_arrays_that_did_not_change_are_the_same_objects_in_a_new_shape():
    shown = Shown()
    two = [marker(Kind.CUBE, each, at=(each, 0.0, 0.0)) for each in range(2)]
    first = shapes_in(shown.after(*two))["boxes"]
    paler = [marker(Kind.CUBE, each, at=(each, 0.0, 0.0), rgba=HALF_RED) for each in range(2)]
    second = shapes_in(shown.after(*paler))["boxes"]
    assert isinstance(first, Solids)
    assert isinstance(second, Solids)
    assert second.positions is first.positions
    assert second.colors is not first.colors
    assert second.opacities == 128 / 255


def test_points_that_were_far_once_stay_precise():
    shown = Shown()
    for x, precise in ((1.0, False), (500.0, True), (1.0, True)):
        dots = marker(Kind.POINTS, points=[(x, 0.0, 0.0)], scale=(0.1, 0.1, 0.0))
        drawn = shapes_in(shown.after(dots))["points-0"]
        assert isinstance(drawn, Points)
        assert drawn.precise == precise


def test_a_group_that_did_not_change_is_the_same_object_in_a_new_drawing():
    shown = Shown()
    first = shown.after(marker(Kind.CUBE, 0), marker(Kind.CUBE, 1, frame="odom"))
    second = shown.after(marker(Kind.CUBE, 1, frame="odom", at=(0.0, 0.0, 0.0)))
    same = [placed.frame for path, placed in second.items() if placed is first[path]]
    assert same == ["map"]


def test_a_new_stamp_keeps_the_path_and_the_shapes():
    shown = Shown()
    first = shown.after(marker(Kind.CUBE, stamp_ns=S))
    second = shown.after(marker(Kind.CUBE, stamp_ns=2 * S))
    assert list(first) == list(second)
    [old], [new] = first.values(), second.values()
    assert (old.stamp_ns, new.stamp_ns) == (S, 2 * S)
    [before], [after] = old.shapes.values(), new.shapes.values()
    assert after is before


def test_each_frame_stamp_and_lock_is_a_group_of_its_own():
    shown = Shown()
    drawing = shown.after(
        marker(Kind.CUBE, 0),
        marker(Kind.CUBE, 1, frame="odom"),
        marker(Kind.CUBE, 2, stamp_ns=S),
        marker(Kind.CUBE, 3, stamp_ns=S, frame_locked=True),
        marker(Kind.CUBE, 4, stamp_ns=2 * S, frame_locked=True),
        marker(Kind.CUBE, 5, frame="/map", stamp_ns=S),
    )
    groups = {
        (placed.frame, placed.stamp_ns, placed.follows): sum(
            len(shape.positions) for shape in placed.shapes.values() if isinstance(shape, Solids)
        )
        for placed in drawing.values()
    }
    assert groups == {
        ("map", 0, False): 1, ("odom", 0, False): 1, ("map", S, False): 2, ("map", 0, True): 2,
    }  # fmt: skip


def test_a_marker_that_goes_to_another_frame_leaves_the_one_it_was_in():
    shown = Shown()
    shown.after(marker(Kind.CUBE))
    drawing = shown.after(marker(Kind.CUBE, frame="odom"))
    assert [placed.frame for placed in drawing.values()] == ["odom"]
    assert list(drawing) == ["g0"]


def test_a_marker_of_another_type_takes_the_place_of_the_old():
    shown = Shown()
    shown.after(marker(Kind.CUBE), marker(Kind.LINE_STRIP, 1, points=LINE))
    drawing = shown.after(marker(Kind.SPHERE), marker(Kind.LINE_STRIP, 1))
    assert list(shapes_in(drawing)) == ["balls"]


def test_two_thousand_markers_are_a_handful_of_shapes():
    shown = Shown()
    kinds = [Kind.ARROW, Kind.CUBE, Kind.SPHERE, Kind.CYLINDER, Kind.LINE_STRIP]
    drawing = shown.after(
        *(marker(kinds[each % 5], each, points=LINE[: 2 * (each % 5 == 4)]) for each in range(2000))
    )
    assert list(shapes_in(drawing)) == ["boxes", "balls", "cylinders", "shafts", "heads", "lines-0"]
    boxes = shapes_in(drawing)["boxes"]
    assert isinstance(boxes, Solids)
    assert boxes.positions.shape == (400, 3)


def test_names_are_plain_words_whatever_namespaces_are_called():
    shown = Shown()
    names = ["", "a/b", "../..", "<b>", "\x00", "\U0001f600", "a b"]
    drawing = shown.after(*(marker(Kind.CUBE, ns=name, frame=name or "map") for name in names))
    found = [name for placed in drawing.values() for name in placed.shapes]
    assert len(set(found)) == len(names)
    assert all(re.fullmatch(r"[a-z0-9-]+", name) for name in [*found, *drawing])


def test_more_shapes_than_can_be_shown_are_left_out_and_told(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(batches_module, "SHAPES_MAX", 3)
    shown = Shown()
    drawing = shown.after(*(marker(Kind.CUBE, each, stamp_ns=each * S) for each in range(5)))
    assert len(shapes_in(drawing)) == 1
    assert len(drawing) == 3
    assert sentences(shown.display) == ["2 texts, meshes or batches are too many to be shown."]
    shown.after(marker(Kind.CUBE, 0, action=DELETE_ALL, ns=""))
    assert not any("too many" in sentence for sentence in sentences(shown.display))


def test_nobody_writes_into_what_was_drawn():
    shown = Shown()
    first = shapes_in(shown.after(marker(Kind.CUBE)))["boxes"]
    assert isinstance(first, Solids)
    before = np.array(first.positions)
    shown.after(marker(Kind.CUBE, at=(7.0, 7.0, 7.0)))
    assert np.array_equal(first.positions, before)


def test_of_ever_so_many_namespaces_the_first_are_drawn_apart_and_the_rest_as_one():
    display = MarkerArrayDisplay(TYPES)
    many = [marker(Kind.CUBE, ns=f"n{each}", at=(each, 0.0, 0.0)) for each in range(500)]
    display.take(array_of(*many))
    [placed] = display.draw(0).values()
    assert len(placed.shapes) == APART_MAX + 1
    rest = placed.shapes["rest-boxes"]
    assert isinstance(rest, Solids)
    assert rest.positions[:, 0].tolist() == list(range(APART_MAX, 500))


def test_a_namespace_of_the_rest_is_hidden_and_shown_by_itself():
    display = MarkerArrayDisplay(TYPES)
    many = [marker(Kind.CUBE, ns=f"n{each}", at=(each, 0.0, 0.0)) for each in range(40)]
    display.take(array_of(*many))
    display.set("Namespaces/n39", value=False)
    [placed] = display.draw(0).values()
    rest = placed.shapes["rest-boxes"]
    assert isinstance(rest, Solids)
    assert rest.positions[:, 0].tolist() == list(range(APART_MAX, 39))
    display.set("Namespaces/n39", value=True)
    [placed] = display.draw(0).values()
    rest = placed.shapes["rest-boxes"]
    assert isinstance(rest, Solids)
    assert rest.positions[:, 0].tolist() == list(range(APART_MAX, 40))


def test_more_batches_than_can_be_drawn_are_told_and_drawn_when_others_go(
    monkeypatch: pytest.MonkeyPatch,
):
    monkeypatch.setattr(batches_module, "BATCHES_MAX", 2)
    shown = Shown()
    three = [marker(Kind.CUBE, each, frame=f"f{each}") for each in range(3)]
    drawing = shown.after(*three)
    assert [placed.frame for placed in drawing.values()] == ["f0", "f1"]
    assert sentences(shown.display) == ["1 texts, meshes or batches are too many to be shown."]
    drawing = shown.after(marker(0, 0, action=int(Action.DELETE)))
    assert sorted(placed.frame for placed in drawing.values()) == ["f1", "f2"]
    assert sentences(shown.display) == []


def test_a_batch_of_which_nothing_changed_is_not_even_looked_at(monkeypatch: pytest.MonkeyPatch):
    shown = Shown()
    two = [marker(Kind.CUBE, 0), marker(Kind.CUBE, 1, frame="odom")]
    shown.after(*two)
    looked: list[int] = []

    def counted(markers: Rows) -> dict[str, Shape]:
        looked.extend(markers.rows.tolist())
        return shapes_of(markers)

    monkeypatch.setattr(batches_module, "shapes_of", counted)
    shown.after(*two)
    assert looked == []
    shown.after(two[0], marker(Kind.CUBE, 1, frame="odom", rgba=(0.0, 0.0, 0.0, 1.0)))
    assert looked == [1]


@st.composite
def any_marker(draw: st.DrawFn) -> Any:  # noqa: ANN401
    return marker(
        draw(st.sampled_from([*[Kind.CUBE] * 4, Kind.LINE_STRIP, Kind.POINTS, Kind.TEXT])),
        draw(st.integers(0, 3)),
        at=(draw(st.sampled_from([0.0, 1.0])), 0.0, 0.0),
        points=LINE[: draw(st.integers(0, 2))],
        rgba=(1.0, 0.0, 0.0, draw(st.sampled_from([1.0, 1.0, 1.0, 0.5, 0.0]))),
        frame=draw(st.sampled_from(["map", "map", "odom", "odom", ""])),
        stamp_ns=draw(st.sampled_from([0, S])),
        ns=draw(st.sampled_from(NAMESPACES)),
        action=draw(st.sampled_from([*[0] * 8, int(Action.DELETE), DELETE_ALL])),
        frame_locked=draw(st.booleans()),
        text=draw(st.sampled_from(["", "a", "b"])),
    )


def turn(one: Any) -> None:  # noqa: ANN401
    one.pose.orientation.w, one.pose.orientation.z = 0.0, 1.0


def lift(one: Any) -> None:  # noqa: ANN401
    one.pose.position.z += 1


def stretch(one: Any) -> None:  # noqa: ANN401
    one.scale.x += 1


def fade(one: Any) -> None:  # noqa: ANN401
    one.color.a = 0.5 - one.color.a / 4


def say_more(one: Any) -> None:  # noqa: ANN401
    one.text += "."


def reach_further(one: Any) -> None:  # noqa: ANN401
    for point in one.points:
        point.y += 1


def lock(one: Any) -> None:  # noqa: ANN401
    one.frame_locked = not one.frame_locked


CHANGES: list[Callable[[Any], None]] = [turn, lift, stretch, fade, say_more, reach_further, lock]


class Story(RuleBasedStateMachine):
    """Whatever happened before, the drawing is that of one who hears of those there are at once."""

    def __init__(self) -> None:
        super().__init__()
        self.display = MarkerArrayDisplay(TYPES)
        self.there: dict[tuple[str, int], Any] = {}

    @rule(messages=st.lists(st.lists(any_marker(), max_size=5), min_size=1, max_size=2))
    def messages_come(self, messages: list[list[Any]]) -> None:
        for markers in messages:
            self._take(markers)

    @rule(changes=st.lists(st.tuples(st.integers(0, 9), st.sampled_from(CHANGES)), min_size=5))
    def markers_change_a_little(self, changes: list[tuple[int, Callable[[Any], None]]]) -> None:
        for which, change in changes if self.there else []:
            one = deepcopy(list(self.there.values())[which % len(self.there)])
            change(one)
            self._take([one])
            self.it_is_drawn()

    @rule()
    def all_come_again(self) -> None:
        self._take(list(self.there.values()))

    @rule(namespace=st.sampled_from(NAMESPACES), shown=st.sampled_from([*[True] * 4, False]))
    def a_namespace_is_switched(self, namespace: str, shown: bool) -> None:
        self.display.set(f"Namespaces/{namespace}", shown)

    @invariant()
    def it_is_drawn(self) -> None:
        fresh = MarkerArrayDisplay(TYPES, self.display.values)
        fresh.take(array_of(*self.there.values()))
        drawn = self.display.draw(0)
        assert listed(drawn) == listed(fresh.draw(0))
        assert self.display.draw(0) is drawn

    def _take(self, markers: list[Any]) -> None:
        self.display.take(array_of(*markers))
        for one in markers:
            if one.action == DELETE_ALL:
                self.there = {k: v for k, v in self.there.items() if one.ns not in ("", k[0])}
            elif one.action == Action.DELETE:
                self.there.pop((one.ns, one.id), None)
            else:
                self.there[one.ns, one.id] = one


def listed(drawing: Drawing) -> list[str]:
    """All things that are drawn, one by one, in the order of the alphabet."""
    found: list[str] = []
    for placed in drawing.values():
        where = f"{placed.frame} {placed.stamp_ns} {placed.follows}"
        for name, shape in placed.shapes.items():
            match shape:
                case Solids():
                    looks = np.concatenate((shape.positions, shape.wxyz, shape.scales), axis=1)
                    colors = np.broadcast_to(shape.colors, (len(shape.positions), 3)).tolist()
                    alphas = np.broadcast_to(shape.opacities, len(shape.positions)).tolist()
                    each = zip(looks.tolist(), colors, alphas, strict=True)
                case Points():
                    each = [
                        (place, shape.size_m, shape.opacity) for place in shape.positions.tolist()
                    ]
                case Lines():
                    each = [(ends, shape.width_m, shape.opacity) for ends in shape.ends.tolist()]
                case _:
                    name, each = name.split("-")[0], [shape]  # noqa: PLW2901 - its row is anyone's
            found += [f"{where} {name} {one}" for one in each]
    return sorted(found)


Story.TestCase.settings = settings(max_examples=50, stateful_step_count=15, deadline=None)
TestStory = Story.TestCase
