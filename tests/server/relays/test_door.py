"""The door of a relay: a class is found by its code."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import httpx2
import pytest

from tests.support.relays import RelayedClass, ServedRelay, relayed_class, served_relay

if TYPE_CHECKING:
    from collections.abc import Generator


@pytest.fixture(scope="module")
def relay() -> Generator[ServedRelay]:
    with served_relay() as made:
        yield made


@pytest.fixture(scope="module")
def rooms(
    relay: ServedRelay, tmp_path_factory: pytest.TempPathFactory
) -> Generator[tuple[RelayedClass, RelayedClass]]:
    one, other = (tmp_path_factory.mktemp(name) for name in ("one", "other"))
    with relayed_class(one, [relay.line]) as first, relayed_class(other, [relay.line]) as second:
        yield first, second


@pytest.fixture
def browser(relay: ServedRelay) -> Generator[httpx2.Client]:
    with httpx2.Client(base_url=relay.address, trust_env=False) as made:
        yield made


def code_of(room: RelayedClass) -> str:
    return room.served.classroom.admission.code


@pytest.mark.parametrize(
    ("language", "word"), [("en", "Code"), ("de-DE", "Code")], ids=["English", "German"]
)
def test_it_asks_for_the_code_alone(browser: httpx2.Client, language: str, word: str):
    page = browser.get("/", headers={"accept-language": language})
    assert page.status_code == 200
    assert word in page.text
    assert f'<html lang="{language[:2]}">' in page.text
    assert 'name="code"' in page.text
    assert 'name="name"' not in page.text


def test_a_code_leads_to_its_own_class_where_the_name_is_asked_for(
    browser: httpx2.Client, rooms: tuple[RelayedClass, RelayedClass]
):
    for room in rooms:
        browser.cookies.clear()
        answer = browser.post("/join", data={"code": code_of(room).lower()}, follow_redirects=True)
        assert str(answer.url) == f"{room.address()}join"
        assert 'name="name"' in answer.text
        assert 'name="code"' not in answer.text


def test_it_leads_to_a_class_that_is_locked_or_has_a_password_too(
    browser: httpx2.Client, rooms: tuple[RelayedClass, RelayedClass]
):
    served = rooms[1].served
    admission = served.classroom.admission
    served.run(admission.set_password("secret"))
    try:
        answer = browser.post("/", data={"code": code_of(rooms[1])})
        assert answer.headers["location"].startswith(f"/{rooms[1].origin.identity.id}/join?")
    finally:
        served.run(admission.set_password(""))


def test_nobody_joins_by_it(browser: httpx2.Client, rooms: tuple[RelayedClass, RelayedClass]):
    before = len(rooms[0].served.classroom.members)
    assert browser.post("/", data={"code": code_of(rooms[0])}).status_code == 303
    assert len(rooms[0].served.classroom.members) == before
    assert not browser.cookies


def test_a_studio_that_does_not_answer_keeps_nobody_elses_people_out(
    browser: httpx2.Client,
    relay: ServedRelay,
    rooms: tuple[RelayedClass, RelayedClass],
    monkeypatch: pytest.MonkeyPatch,
):
    slow = relay.relay.rooms[rooms[0].origin.identity.id]

    async def never(_code: str) -> bool:
        await asyncio.sleep(3600)
        return False

    monkeypatch.setattr(slow, "knows", never)
    answer = browser.post("/", data={"code": code_of(rooms[1])})
    assert rooms[1].origin.identity.id in answer.headers["location"]
    monkeypatch.setattr("studio.server.relays.door._PATIENCE_S", 0.1)
    assert browser.post("/", data={"code": "QQQQQQ"}).status_code == 200


@pytest.mark.usefixtures("rooms")
def test_another_code_is_said_to_be_none_and_too_many_are_not_taken(browser: httpx2.Client):
    answer = browser.post("/", data={"code": "<b>QQQ"})
    assert answer.status_code == 200
    assert "No class that is here now has this code" in answer.text
    assert "&lt;b&gt;QQQ" in answer.text
    statuses = [browser.post("/", data={"code": "QQQQQQ"}).status_code for _ in range(40)]
    assert statuses[0] == 200
    assert statuses[-1] == 429


@pytest.mark.parametrize("body", [b"\xff\xfe", b"code=" + b"A" * 100_000, b"", b"a=1&" * 50])
def test_what_is_no_form_is_no_code(browser: httpx2.Client, body: bytes):
    kind = {"content-type": "application/x-www-form-urlencoded"}
    assert browser.post("/", content=body, headers=kind).status_code in {200, 429}
