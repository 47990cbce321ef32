from __future__ import annotations

import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus

from studio.protocol.roles import Role
from studio.server import joining
from tests.support.classmates import Classmate
from tests.support.web_server import TOKEN, RunningWeb, running_web

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator
    from pathlib import Path

    from studio.classroom.admission import Admission
    from studio.classroom.classroom import Classroom

pytestmark = pytest.mark.network
HTML = {"accept": "text/html"}


@pytest.fixture(scope="module")
def running(assets_folder: Path) -> Iterator[RunningWeb]:
    with running_web(assets_folder) as web:
        yield web


@pytest.fixture
def web(running: RunningWeb, monkeypatch: pytest.MonkeyPatch) -> RunningWeb:
    """With a class that is open and new; each test has all its tries."""
    running.run(classroom(running).end())
    running.run(classroom(running).start())
    monkeypatch.setattr(joining.Tries, "begin", pass_all)
    return running


def pass_all(tries: joining.Tries, address: str) -> None:
    del tries, address


def classroom(web: RunningWeb) -> Classroom:
    return web.engine.classroom


def admission(web: RunningWeb) -> Admission:
    return classroom(web).admission


@contextmanager
def browser(web: RunningWeb) -> Generator[Classmate]:
    made = Classmate(web.origin)
    try:
        yield made
    finally:
        made.close()


def trouble(web: RunningWeb, name: str = "Ada", code: str = "", password: str = "") -> str:
    """What the form says; it is given no cookie."""
    with browser(web) as one:
        answer = one.join(name, code, password)
        assert answer.status_code == 200
        assert "-member=" not in answer.headers.get("set-cookie", "")
        return answer.text.partition('role="alert">')[2].partition("<")[0]


def test_the_bare_address_leads_to_the_form_while_the_class_is_open(web: RunningWeb):
    with browser(web) as ada:
        for path in ("/", "/d/small", "/no/such"):
            answer = ada.client.get(path)
            assert (answer.status_code, answer.headers["location"]) == (303, "/join")
        form = ada.client.get("/join")
        assert (form.status_code, form.headers["cache-control"]) == (200, "no-store")
        assert "form-action 'self'" in form.headers["content-security-policy"]
        admission(web).open = False
        assert ada.client.get("/").status_code == 403
        assert ada.client.get("/join").status_code == 403


def test_a_link_from_a_chat_leads_to_the_form_and_its_code_leaves_the_address_at_once(
    web: RunningWeb,
):
    with browser(web) as ada:
        link = f"/join?code={admission(web).link}"
        chat = {"sec-fetch-site": "cross-site", "sec-fetch-mode": "navigate"}
        answer = ada.client.get(link, headers=chat | {"sec-fetch-dest": "document"})
        assert admission(web).link not in answer.text
        assert 'content="0;url=/join"' in answer.text
        form = ada.client.get("/join", headers={"sec-fetch-site": "same-origin"})
        assert 'name="code"' not in form.text
        assert 'name="name"' in form.text
        joined = ada.client.post("/join", data={"name": "Ada"})
        assert joined.headers["location"] == "/"
        assert ada.client.get("/d/small").status_code == 200


def test_who_has_a_place_is_not_asked_again_and_a_link_makes_no_presenter_a_student(
    web: RunningWeb,
):
    with browser(web) as owner:
        owner.client.get(f"/?token={TOKEN}")
        answer = owner.client.get(f"/join?code={admission(web).link}")
        assert answer.headers["location"] == "/"
        assert "member" not in answer.headers.get("set-cookie", "")
        with owner.lane() as lane:
            assert lane.until("hello")["role"] == "presenter"
        # Even who fills in the form with the presenter's cookie stays the presenter.
        owner.join("Ada", admission(web).code)
        with owner.lane() as lane:
            assert lane.until("hello")["role"] == "presenter"


def test_the_same_browser_is_the_same_person_and_another_is_not(web: RunningWeb):
    with browser(web) as ada, browser(web) as bob:
        ada.join("Ada", admission(web).code)
        bob.join("Ada", admission(web).code)
        ada.join("Eve", admission(web).code)
        with ada.lane() as one, bob.lane() as other:
            assert one.until("hello")["role"] == other.until("hello")["role"] == "student"
        assert [one.name for one in classroom(web).members] == ["Ada", "Ada 2"]


def test_a_wrong_code_a_lock_and_a_password_are_said_in_one_sentence_each(web: RunningWeb):
    code = admission(web).code
    assert trouble(web, code="WRONG1") == "trouble.code"
    assert trouble(web, name=" ", code=code) == "trouble.name"
    admission(web).locked = True
    assert trouble(web, code=code) == "trouble.locked"
    admission(web).locked = False
    web.run(admission(web).set_password("sesame"))
    assert trouble(web, code=code) == "trouble.password"
    assert trouble(web, code=code, password="Sesame") == "trouble.password"
    with browser(web) as ada:
        assert 'type="password"' in ada.client.get("/join").text
        assert ada.join("Ada", code, "sesame").status_code == 303


def test_who_joins_as_a_guest_only_looks(web: RunningWeb):
    admission(web).join_as = "guest"
    with browser(web) as ada:
        ada.join("Ada", admission(web).code)
        command = {"type": "ask_control"}
        answer = ada.client.post("/api/commands", json=command)
        assert answer.json()["kind"] == "NotAllowedError"


def test_names_are_shown_as_letters(web: RunningWeb):
    with browser(web) as eve:
        answer = eve.join('"><script>alert(1)</script>', "WRONG1")
        assert "<script" not in answer.text
        assert "&quot;&gt;&lt;script&gt;" in answer.text


@pytest.mark.parametrize(
    "body", [b"", b"\xff\xfe", b"name=Ada&" * 100, b"code=" + b"A" * 10_000, b"%", b"name"]
)
def test_any_other_body_is_a_form_that_was_not_filled_in(web: RunningWeb, body: bytes):
    with browser(web) as eve:
        kind = {"content-type": "application/x-www-form-urlencoded"}
        answer = eve.client.post("/join", content=body, headers=kind)
        assert answer.status_code == 200
        assert "trouble" in answer.text


def test_another_site_cannot_fill_in_the_form(web: RunningWeb):
    with browser(web) as ada:
        for origin in ("http://evil.example", "null"):
            form = {"name": "Ada", "code": admission(web).code}
            answer = ada.client.post("/join", data=form, headers={"origin": origin})
            assert answer.status_code == 403


def test_who_is_sent_out_loses_the_page_at_once_and_stays_out(web: RunningWeb):
    with browser(web) as ada:
        ada.join("Ada", admission(web).code)
        (member,) = classroom(web).members
        with ada.lane() as lane:
            lane.until("documents")
            web.run(classroom(web).remove(member.person))
            with pytest.raises(ConnectionClosed):
                lane.until("nothing more")
        with pytest.raises(InvalidStatus), ada.lane():
            pass
        assert ada.client.get("/d/small").headers["location"] == "/join"
        answer = ada.join("Grace", admission(web).code)
        assert "trouble.removed" in answer.text
        web.run(classroom(web).readmit(member.person))
        assert ada.client.get("/d/small").status_code == 200


def test_a_thousand_wrong_codes_are_not_all_looked_at_and_others_join_by_the_link(
    assets_folder: Path,
):
    with running_web(assets_folder) as web:
        web.run(classroom(web).start())
        with browser(web) as eve, browser(web) as ada:
            statuses = [eve.join("Eve", f"WRONG{n}").status_code for n in range(1_000)]
            assert 25 <= statuses.count(200) <= 200
            assert statuses[-1] == 429
            # Not even the right one is, from there.
            assert eve.join("Eve", admission(web).code).status_code == 429
            assert ada.join("Ada", admission(web).link).status_code == 303


def test_tries_are_limited_in_all_too_and_one_that_was_none_is_given_back():
    tries = joining.Tries(joining.Rate(3, 0.001), joining.Rate(5, 0.001))
    for _ in range(10):
        tries.begin("one")
        tries.give_back("one")
    for address in ("one", "one", "one", "two", "three"):
        tries.begin(address)
    for address in ("one", "four"):
        with pytest.raises(joining.NotJoiningError):
            tries.begin(address)


def test_many_passwords_at_once_are_no_more_than_one_after_the_other(assets_folder: Path):
    with running_web(assets_folder) as web:
        web.run(classroom(web).start())
        web.run(admission(web).set_password("sesame"))
        code = admission(web).code

        def guess(number: int) -> int:
            with browser(web) as eve:
                return eve.join("Eve", code, f"guess {number}").status_code

        with ThreadPoolExecutor(60) as pool:
            statuses = list(pool.map(guess, range(60)))
        assert statuses.count(200) <= 32
        assert statuses.count(429) >= 28


def test_everybody_has_to_join_again_after_all_were_logged_out(web: RunningWeb):
    with browser(web) as ada, web.client(Role.PRESENTER) as owner:
        ada.join("Ada", admission(web).code)
        assert owner.post("/api/log-out").status_code == 204
        assert ada.client.get("/d/small").headers["location"] == "/join"


@pytest.mark.parametrize("origin", ["http://evil.example", "http://localhost:{port}", "null"])
def test_a_students_cookie_in_the_page_of_another_site_opens_and_does_nothing(
    web: RunningWeb, origin: str
):
    origin = origin.format(port=web.port)
    with browser(web) as ada:
        ada.join("Ada", admission(web).code)
        before = len(web.engine.executed)
        for path in ("/control", "/data", "/d/small/viser"):
            with pytest.raises(InvalidStatus) as refused, ada.websocket(path, origin=origin):
                pass
            assert refused.value.response.status_code == 403
        theirs = {"origin": origin}
        for path in ("/api/documents", "/api/documents/small/urdf", "/bulk?key=x"):
            assert ada.client.get(path, headers=theirs).status_code == 403
        for path in ("/api/commands", "/api/uploads", "/api/log-out"):
            command = {"type": "raise_hand"}
            assert ada.client.post(path, json=command, headers=theirs).status_code == 403
        # A picture or a form of another site says no origin, but that it is of another site.
        del ada.client.headers["origin"]
        for site in ("cross-site", "same-site"):
            embedded = {"sec-fetch-site": site, "sec-fetch-mode": "no-cors"}
            assert ada.client.get("/api/documents", headers=embedded).status_code == 403
            assert ada.client.post("/api/commands", headers=embedded).status_code == 403
        assert ada.client.post("/api/commands").status_code == 403
        assert len(web.engine.executed) == before


def test_who_was_sent_out_is_no_guest_either_where_everybody_may_look(assets_folder: Path):
    with running_web(assets_folder, guests=True) as web:
        web.run(classroom(web).start())
        with browser(web) as ada, browser(web) as other:
            ada.client.get("/d/small")
            assert any("guest" in name for name in ada.client.cookies)
            ada.join("Ada", admission(web).code)
            (member,) = classroom(web).members
            web.run(classroom(web).remove(member.person))
            for one, location in ((ada, "/join"), (other, "/d/small")):
                assert one.client.get("/d/small").headers["location"] == location
            other.client.get("/d/small")
            assert other.client.get("/api/health").status_code == 200
            assert ada.client.get("/api/health").headers["location"] == "/join"
            with pytest.raises(InvalidStatus), ada.lane():
                pass


@pytest.mark.parametrize("days", [-1, 1])
def test_a_clock_that_jumps_gives_nobody_more_tries_and_takes_none(
    monkeypatch: pytest.MonkeyPatch, days: int
):
    tries = joining.Tries(joining.Rate(3, 0.001), joining.Rate(9, 0.001))
    now_s = time.time  # noqa: TID251 - it is what jumps
    for _ in range(3):
        tries.begin("one")
    monkeypatch.setattr(time, "time", lambda: now_s() + days * 86_400)
    with pytest.raises(joining.NotJoiningError):
        tries.begin("one")
    for _ in range(3):
        tries.begin("two")
