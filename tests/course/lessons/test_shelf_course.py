"""The lessons of the course: each reads, has steps, and checks what there is to check."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

from studio.course.demos import LESSONS, code_of
from studio.course.lessons.checks import Check, Concern
from studio.course.lessons.shelf import EXERCISES, Shelf
from studio.course.lessons.text import read_lesson
from studio.settings import repository_or_wheel

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.course.lessons.text import LessonText

ASSETS = repository_or_wheel("frontend_assets")
COURSE = Shelf(ASSETS / "lessons")
NAMES = [*LESSONS, *EXERCISES]
LANGUAGES = ("en", "de")
EVERYWHERE = {"/rosout", "use_sim_time"}
"""What every node has."""


def lesson(name: str, language: str = "en") -> LessonText:
    return read_lesson(COURSE.find(name).text(language))


def checks(name: str, language: str = "en") -> list[Check]:
    return [check for step in lesson(name, language).steps for check in step.checks]


def ros_names(name: str) -> Iterator[str]:
    """Names of nodes, topics, services, actions and parameters that are checked."""
    for check in checks(name):
        if check.concern is Concern.GRAPH:
            yield from (check.values[one] for one in ("name", "node") if one in check.values)


def test_every_demo_and_every_exercise_has_a_lesson():
    assert [one.name for one in COURSE.lessons()] == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_a_lesson_reads_without_faults_in_every_language(name: str):
    for language in LANGUAGES:
        read = lesson(name, language)
        assert read.faults == ()
        assert read.title
        assert set(read.needs) <= LESSONS.keys() - {name}


@pytest.mark.parametrize("name", NAMES)
def test_a_lesson_has_steps_under_a_heading_and_the_same_in_every_language(name: str):
    english, german = (lesson(name, language) for language in LANGUAGES)
    assert english.steps
    assert all(one.heading and one.checks for one in (*english.steps, *german.steps))
    assert [one.checks for one in english.steps] == [one.checks for one in german.steps]
    # A tick is kept by the id.
    assert [one.id for one in english.steps] == [one.id for one in german.steps]
    assert english.needs == german.needs


@pytest.mark.parametrize("name", NAMES)
def test_checks_stand_apart_from_the_text_as_the_page_wants_them(name: str):
    for language in LANGUAGES:
        for block in re.split(r"\n\s*\n", COURSE.find(name).text(language)):
            lines = block.strip().splitlines()
            are_checks = {line.startswith("check: ") for line in lines}
            assert len(are_checks) == 1, block


@pytest.mark.parametrize("name", NAMES)
def test_panels_that_are_to_be_opened_are_there(name: str):
    for check in checks(name):
        if check.kind == "opened":
            assert (ASSETS / "panels" / check.values["panel"] / "panel.json").is_file()


@pytest.mark.parametrize("name", list(LESSONS))
def test_names_that_are_checked_are_those_of_the_demos(name: str):
    code = "\n".join(text for one in (name, *lesson(name).needs) for text in code_of(one).values())
    nodes = {one.node for one in LESSONS.values()}
    for named in ros_names(name):
        first = re.match(r"/?([a-z_]+)", named)
        assert first is not None
        assert named in EVERYWHERE | nodes or first[1] in code, f"{named} is in none of the demos"


@pytest.mark.parametrize("name", list(LESSONS))
def test_the_first_step_of_a_demo_looks_at_its_graph(name: str):
    assert any(one.concern is Concern.GRAPH for one in lesson(name).steps[0].checks)


def test_only_services_that_change_nothing_are_called():
    asked = {
        check.values["name"] for name in NAMES for check in checks(name) if check.kind == "answers"
    }
    assert asked == {
        *("/add_two_ints", "/get_now_playing", "/add_points", "/distance", "/transform_point"),
        *("/tide", "/how_many"),
    }
