"""Steps of undo: gestures grow one, and end as none when they end where they began."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from studio.description.editing.edits import apply
from studio.description.editing.undo import ArgumentChange, Splice, Step, UndoStack


def turned(old: bytes, new: bytes, gesture: str = "", start: int = 7) -> Step:
    return Step("wheel_radius", (Splice("f", start, old, new),), gesture=gesture)


def labels(stack: UndoStack) -> list[str]:
    return [step.label for step in stack.done]


def test_a_step_names_its_value_before_and_after():
    assert turned(b"0.1", b"0.12").label == "wheel_radius 0.1 → 0.12"
    assert turned(b"", b"x").label == "wheel_radius (empty) → x"
    assert turned(b"a" * 41, b"x").label == "wheel_radius"


def test_an_argument_names_its_value_too():
    step = Step("arm", arguments=(ArgumentChange("arm", None, "false"),))
    assert step.label == "arm (empty) → false"


def test_edits_of_one_gesture_are_one_step_from_its_begin_to_its_end():
    stack = UndoStack()
    for old, new in [(b"0.1", b"0.11"), (b"0.11", b"0.125"), (b"0.125", b"0.2")]:
        stack.push(turned(old, new, "drag 1"))
    assert labels(stack) == ["wheel_radius 0.1 → 0.2"]
    assert stack.done[0].splices == (Splice("f", 7, b"0.1", b"0.2"),)


def test_a_gesture_that_ends_where_it_began_leaves_no_step():
    stack = UndoStack()
    stack.push(turned(b"0.1", b"0.11", "drag 1"))
    stack.push(turned(b"0.11", b"0.1", "drag 1"))
    assert labels(stack) == []


def test_an_edit_that_changes_nothing_leaves_no_step():
    stack = UndoStack()
    stack.push(turned(b"0.1", b"0.1"))
    assert labels(stack) == []


def test_edits_without_a_gesture_are_steps_of_their_own():
    stack = UndoStack()
    stack.push(turned(b"1", b"2"))
    stack.push(turned(b"2", b"3"))
    assert labels(stack) == ["wheel_radius 1 → 2", "wheel_radius 2 → 3"]


def test_two_places_in_one_gesture_are_one_step_with_two_splices():
    stack = UndoStack()
    stack.push(turned(b"1", b"2", "type"))
    stack.push(turned(b"5", b"6", "type", start=90))
    assert labels(stack) == ["wheel_radius"]
    assert len(stack.done[0].splices) == 2


def test_undo_ends_the_gesture_and_a_new_step_forgets_what_was_undone():
    stack = UndoStack()
    stack.push(turned(b"1", b"2", "drag"))
    stack.push(turned(b"5", b"6", "other", start=90))
    assert stack.undo() is not None
    stack.push(turned(b"2", b"3", "drag"))
    assert labels(stack) == ["wheel_radius 1 → 2", "wheel_radius 2 → 3"]
    assert stack.redo() is None


def test_redo_gives_back_what_undo_took():
    stack = UndoStack()
    stack.push(turned(b"1", b"2"))
    taken = stack.undo()
    assert (stack.done, stack.redo(), stack.undone) == ([taken], taken, [])


def test_an_empty_stack_has_nothing_to_undo_or_redo():
    assert (UndoStack().undo(), UndoStack().redo()) == (None, None)


def test_one_argument_in_one_gesture_is_one_step_and_two_arguments_are_two():
    stack = UndoStack()
    for name, old, new in [("a", None, "1"), ("a", "1", "2"), ("b", None, "3")]:
        stack.push(Step(name, arguments=(ArgumentChange(name, old, new),), gesture="g"))
    assert labels(stack) == ["a (empty) → 2", "b (empty) → 3"]


def test_the_stack_forgets_the_oldest_of_a_thousand_steps():
    stack = UndoStack()
    for number in range(1002):
        stack.push(turned(b"%d" % number, b"%d" % (number + 1)))
    assert len(stack.done) == 1000
    assert stack.done[0].label == "wheel_radius 2 → 3"


def test_what_is_typed_letter_by_letter_and_partly_taken_back_is_one_splice():
    stack = UndoStack()
    stack.push(turned(b"", b"1", "type", start=7))
    stack.push(turned(b"", b".5", "type", start=8))
    stack.push(turned(b"5", b"", "type", start=9))
    stack.push(turned(b"", b"25", "type", start=9))
    assert stack.done[0].splices == (Splice("f", 7, b"", b"1.25"),)


def test_what_reaches_beyond_the_typed_text_is_a_splice_of_its_own():
    stack = UndoStack()
    stack.push(turned(b"", b"ab", "type", start=7))
    stack.push(turned(b"bc", b"", "type", start=8))
    assert len(stack.done[0].splices) == 2


STROKES = st.lists(
    st.tuples(st.integers(0, 40), st.integers(0, 3), st.binary(max_size=3), st.sampled_from("ab")),
    max_size=25,
)


@given(STROKES)
def test_whatever_is_typed_in_whatever_order_is_taken_back_and_done_again(
    strokes: list[tuple[int, int, bytes, str]],
):
    before = text = b"<robot name='r'/>"
    stack = UndoStack()
    for at, length, new, gesture in strokes:
        start = min(at, len(text))
        splice = Splice("f", start, text[start : start + length], new)
        text = apply(text, [splice.forward()])
        stack.push(Step("typed", (splice,), gesture=gesture))
    after = text
    while step := stack.undo():
        text = apply(text, [splice.backward() for splice in reversed(step.splices)])
    assert text == before
    while step := stack.redo():
        text = apply(text, [splice.forward() for splice in step.splices])
    assert text == after
