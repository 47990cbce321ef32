from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from studio.course.lessons.text import CHECKS_MAX, STEPS_MAX, TEXT_MAX, read_lesson

LESSON = """# A pair of nodes
needs: talker listener

What is said here.

## Look at

- the node

check: node /talker runs
check: topic /chatter comes at 2 Hz

## Try

check: topic /chatter has 1 subscription

check: opened graph
"""


def test_a_lesson_has_a_title_demos_that_it_needs_and_steps_below_headings():
    lesson = read_lesson(LESSON)
    assert (lesson.title, lesson.needs) == ("A pair of nodes", ("talker", "listener"))
    assert lesson.faults == ()
    assert [(one.heading, len(one.checks)) for one in lesson.steps] == [
        ("Look at", 2),
        ("Try", 1),
        ("Try", 1),
    ]


def test_a_step_is_known_by_its_checks_whatever_the_words_around_it_say():
    other = LESSON.replace("What is said here.", "Etwas anderes.").replace("## Try", "## Probiere")
    ids = [one.id for one in read_lesson(LESSON).steps]
    assert [one.id for one in read_lesson(other).steps] == ids
    assert len(set(ids)) == 3
    changed = read_lesson(LESSON.replace("2 Hz", "3 Hz"))
    assert [one.id for one in changed.steps][1:] == ids[1:]
    assert changed.steps[0].id != ids[0]


def test_two_steps_of_the_same_checks_are_told_apart():
    twice = "# T\n\ncheck: no errors\n\nThen:\n\ncheck: no errors\n"
    first, second = read_lesson(twice).steps
    assert first.id != second.id


def test_each_fault_is_named_with_its_line():
    lesson = read_lesson("A text.\n\ncheck: nothing\ncheck: no errors\n")
    assert [one.line for one in lesson.faults] == [1, 3]
    assert "write `# Title` in the first line" in lesson.faults[0].sentence
    assert [len(one.checks) for one in lesson.steps] == [1]
    assert read_lesson("").faults[0].line == 1


def test_a_lesson_has_bounds():
    many = "# T\n\n" + "check: no errors\n\n" * (STEPS_MAX + 1)
    lesson = read_lesson(many)
    assert len(lesson.steps) == STEPS_MAX
    assert f"{STEPS_MAX} steps" in lesson.faults[0].sentence
    wide = "# T\n\n" + "check: no errors\n" * (CHECKS_MAX + 1)
    assert len(read_lesson(wide).steps[0].checks) == CHECKS_MAX
    assert read_lesson(wide).faults[0].line == CHECKS_MAX + 3
    assert f"{TEXT_MAX} characters" in read_lesson("# T\n" + "x" * TEXT_MAX).faults[0].sentence


@given(st.text(alphabet=st.sampled_from("# check:\nno errors/"), max_size=200))
def test_any_text_is_read(text: str):
    for fault in read_lesson(text).faults:
        assert 1 <= fault.line <= max(1, len(text.splitlines()))
