from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.classroom.control import Control
from studio.classroom.members import Members, readable
from studio.classroom.record import MemberRecord
from studio.errors import CommandError
from studio.protocol.classroom import NAME_MAX
from studio.protocol.roles import Role

if TYPE_CHECKING:
    from studio.classroom.members import Member


def members() -> Members:
    return Members(b"k" * 32, Control(lambda before: None))


def add(made: Members, name: str = "Ada", role: Role = Role.STUDENT) -> Member:
    return made.add(name, role)


def test_a_cookie_finds_its_person_and_nobody_else():
    made = members()
    ada, bob = add(made), add(made, "Bob")
    assert made.of_cookie(made.cookie_of(ada)) is ada
    assert made.of_cookie(made.cookie_of(bob)) is bob
    swapped = f"{ada.person}.{made.cookie_of(bob).partition('.')[2]}"
    assert made.of_cookie(swapped) is None


@given(st.text())
def test_nothing_else_is_a_cookie(text: str):
    made = members()
    add(made)
    assert made.of_cookie(text) is None


def test_a_cookie_of_another_class_finds_nobody():
    one, other = members(), Members(b"x" * 32, Control(lambda before: None))
    ada = add(one)
    other.restore([MemberRecord(person=ada.person, name="Ada", role="student")])
    assert other.of_cookie(one.cookie_of(ada)) is None


def test_who_was_sent_out_is_known_by_the_cookie_and_not_let_in():
    made = members()
    ada = add(made)
    ada.removed = True
    assert made.of_cookie(made.cookie_of(ada)) is None
    assert made.any_of_cookie(made.cookie_of(ada)) is ada


def test_after_the_end_no_cookie_finds_anybody():
    made = members()
    cookie = made.cookie_of(add(made))
    made.clear()
    assert made.any_of_cookie(cookie) is None
    assert len(made) == 0


def test_two_of_a_name_are_told_apart_and_one_may_keep_the_own():
    made = members()
    ada, second = add(made, "Ada"), add(made, " ada ")
    assert (ada.name, second.name) == ("Ada", "ada 2")
    assert made.free_name("ADA", own=ada.person) == "ADA"


@pytest.mark.parametrize("typed", ["", "  ", "\n\t", "\u200b\u202e", "\x00"])
def test_a_name_of_which_nothing_is_seen_is_refused(typed: str):
    with pytest.raises(CommandError, match="needs letters"):
        add(members(), typed)


@given(st.text())
def test_a_name_is_one_line_that_can_be_seen_and_not_too_long(typed: str):
    name = readable(typed)
    assert len(name) <= NAME_MAX
    assert name == name.strip()
    assert all(one.isprintable() for one in name)
    assert readable(name) == name


def test_markup_in_a_name_is_kept_as_letters():
    assert readable("<script>alert(1)</script>") == "<script>alert(1)</script>"
