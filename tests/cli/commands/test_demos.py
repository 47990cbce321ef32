from __future__ import annotations

from typing import TYPE_CHECKING

from studio.course.demos import DEMOS
from tests.support.command_line import started, studio
from tests.support.wire import free_endpoint

if TYPE_CHECKING:
    from pathlib import Path


def test_without_names_the_demos_are_listed_with_what_they_show():
    ran = studio("demos")
    assert ran.code == 0
    for demo in DEMOS:
        assert f"{demo.name} " in ran.out
        assert demo.shows in ran.out
    assert "Start some with `studio demos NAME ...`" in ran.out


def test_what_to_try_is_said_without_starting_anything():
    ran = studio("demos", "--about", "song_requester", "my_tiny_sub")
    assert ran.code == 0
    assert "studio run radio_station song_requester Clocks" in ran.out
    assert "the counter grows by 2" in ran.out


def test_types_that_are_not_there_are_said_before_anything_is_started(tmp_path: Path):
    for words in (("demos", "talker"), ("run", "demo_nodes_py", "talker")):
        with started(free_endpoint(), *words, "--interfaces", str(tmp_path / "none")) as process:
            assert process.wait() == 2
        assert "holds no msg, srv or action folder" in process.printed
        assert "Publishing" not in process.printed


def test_an_unknown_name_is_one_sentence_and_starts_none_of_the_others():
    ran = studio("demos", "talker", "no_such")
    assert (ran.code, ran.out) == (2, "")
    assert ran.err == "studio: No demo is called no_such: `studio demos` lists them.\n"


def test_a_demo_that_needs_words_is_started_with_those_of_its_lesson():
    with started(free_endpoint(), "demos", "adder_server", "adder_client") as demos:
        demos.wait_for("Result of add_two_ints: for 41 + 1 = 42")
        assert "Two integers are needed" not in demos.printed
