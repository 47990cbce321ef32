from __future__ import annotations

import asyncio
import re

import pytest

from studio.classroom.admission import Admission
from studio.classroom.record import ClassRecord, new_code, new_link
from studio.errors import NotJoiningError


def admission() -> Admission:
    return Admission(ClassRecord(open=True, code="ABCDEF", link="long-and-secret-x"))


def why(made: Admission, given: str) -> str:
    """Why it is refused; empty: it is not."""
    try:
        made.check_code(given)
    except NotJoiningError as error:
        return error.why
    return ""


@pytest.mark.parametrize("typed", ["ABCDEF", "abcdef", " abc def ", "abc-def", "long-and-secret-x"])
def test_the_code_is_good_however_it_is_typed_and_so_is_that_of_the_link(typed: str):
    assert why(admission(), typed) == ""


@pytest.mark.parametrize("typed", ["", "ABCDEG", "ABCDE", "ABCDEFG", "LONG-AND-SECRET", "ä", "\0"])
def test_any_other_is_not(typed: str):
    assert why(admission(), typed) == "code"


def test_nobody_joins_a_class_that_is_closed_and_nobody_new_one_that_is_locked():
    made = admission()
    made.locked = True
    assert why(made, "ABCDEF") == "locked"
    assert why(made, "WRONG") == "code"
    made.open = False
    assert why(made, "ABCDEF") == "closed"
    assert not made.knows_link("long-and-secret-x")


def test_a_new_code_makes_the_old_ones_worthless():
    made = admission()
    made.renew()
    assert why(made, "ABCDEF") == why(made, "long-and-secret-x") == "code"
    assert why(made, made.code) == why(made, made.link) == ""


def test_a_password_is_asked_for_until_it_is_taken_away_and_not_kept_as_it_is():
    async def run() -> None:
        made = admission()
        await made.check_password("anything")
        await made.set_password("open sesame")
        assert "sesame" not in made.password
        await made.check_password("open sesame")
        for given in ("", "open", "Open sesame"):
            with pytest.raises(NotJoiningError) as refused:
                await made.check_password(given)
            assert refused.value.why == "password"
        await made.set_password("")
        await made.check_password("")

    asyncio.run(run())


def test_codes_are_six_letters_that_nobody_confuses_and_links_are_long():
    codes = {new_code() for _ in range(200)}
    assert len(codes) == 200
    assert all(re.fullmatch("[A-HJKMNP-TV-Z]{6}", one) for one in codes)
    assert min(len(new_link()) for _ in range(50)) >= 16
