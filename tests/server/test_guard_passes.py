"""A member goes on at a relay by a pass of another one."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.protocol.roles import Role
from tests.support.classmates import Classmate
from tests.support.web_server import RunningWeb, running_web

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from httpx2 import Response

pytestmark = pytest.mark.network
MOVED = {
    "sec-fetch-site": "same-site",
    "sec-fetch-mode": "navigate",
    "sec-fetch-dest": "document",
}
"""As a browser comes from the page of another relay."""
NEIGHBOURS = ("http://one.example:8100/room/join?pass=secret",)


@pytest.fixture(scope="module")
def relay(assets_folder: Path) -> Iterator[RunningWeb]:
    with running_web(assets_folder, neighbours=lambda: NEIGHBOURS) as web:
        yield web


def pass_of(web: RunningWeb, role: Role = Role.STUDENT) -> str:
    return web.engine.classroom.members.cookie_of(web.member(role))


def come(web: RunningWeb, cookie: str = "", **query: str) -> Response:
    with web.client(headers={"accept": "text/html", **MOVED}) as client:
        return client.get("/join", params=query, headers={"cookie": cookie} if cookie else {})


def test_a_pass_becomes_the_member_s_cookie_and_leads_to_the_document(relay: RunningWeb):
    given = pass_of(relay)
    answer = come(relay, **{"pass": given, "next": "/d/small", "fullscreen": "1"})
    assert (answer.status_code, answer.headers["location"]) == (303, "/d/small?fullscreen=1")
    assert answer.headers["referrer-policy"] == "no-referrer"
    assert answer.headers["cache-control"] == "no-store"
    assert answer.headers["set-cookie"].startswith(f"studio-{relay.port}-member={given};")
    assert given not in answer.text
    cookie = {"cookie": relay.cookie(Role.STUDENT)}
    with relay.client(headers={"accept": "text/html", **MOVED, **cookie}) as client:
        assert client.get("/d/small").status_code == 200


@pytest.mark.parametrize(
    "path",
    [
        "http://evil.example/",
        "//evil.example/d/x",
        "/\\evil.example",
        "/d//evil.example",
        "/d/small?x=1",
        "/d/small#x",
        "/d/small\r\nset-cookie: x=1",
        "/api/log-out",
        "d/small",
        "",
    ],
)
def test_a_pass_leads_to_a_document_of_here_and_nowhere_else(relay: RunningWeb, path: str):
    answer = come(relay, **{"pass": pass_of(relay), "next": path})
    assert (answer.status_code, answer.headers["location"]) == (303, "/")


@pytest.mark.parametrize("given", ["", "wrong", "ä"])
def test_a_pass_that_is_none_leads_to_the_form_and_leaves_the_address(
    relay: RunningWeb, given: str
):
    relay.member(Role.STUDENT)  # the class is open
    answer = come(relay, **{"pass": given, "next": "/d/small"})
    assert (answer.status_code, answer.headers["location"]) == (303, "/join")
    assert "set-cookie" not in answer.headers


def test_a_pass_is_worth_nothing_once_the_class_is_paused(relay: RunningWeb):
    given = pass_of(relay)
    relay.engine.classroom.admission.open = False
    assert come(relay, **{"pass": given}).headers["location"] == "/join"


def test_a_pass_of_another_takes_nobody_s_place(relay: RunningWeb):
    helper = relay.cookie(Role.HELPER)
    theirs = come(relay, helper, **{"pass": pass_of(relay), "next": "/d/small"})
    own = come(relay, helper, **{"pass": pass_of(relay, Role.HELPER), "next": "/d/small"})
    assert [one.headers["location"] for one in (theirs, own)] == ["/", "/d/small"]
    assert "set-cookie" not in theirs.headers
    assert "set-cookie" not in own.headers


def test_who_was_sent_out_comes_in_by_no_pass_of_another(relay: RunningWeb):
    relay.member(Role.HELPER)
    out = Classmate(relay.origin)
    out.join("Eve", relay.engine.classroom.admission.code)
    member = next(one for one in relay.engine.classroom.members if one.name == "Eve")
    relay.run(relay.engine.classroom.remove(member.person))
    answer = come(relay, out.cookie, **{"pass": pass_of(relay), "next": "/d/small"})
    out.close()
    assert answer.headers["location"] == "/join"
    assert "set-cookie" not in answer.headers


def test_a_studio_that_is_no_relay_takes_no_pass(web: RunningWeb):
    answer = come(web, **{"pass": pass_of(web), "next": "/d/small"})
    assert "-member=" not in answer.headers.get("set-cookie", "")
    assert pass_of(web) not in answer.text
    assert "/d/small" not in answer.text
    assert "location" not in answer.headers or answer.headers["location"] == "/join"


def test_pages_of_other_relays_see_that_a_relay_runs_and_read_nothing(
    relay: RunningWeb, web: RunningWeb
):
    asks = {"sec-fetch-site": "cross-site", "sec-fetch-mode": "no-cors", "sec-fetch-dest": "empty"}
    with relay.client(headers=asks) as client:
        answer = client.get("/health")
        assert (answer.status_code, answer.content) == (204, b"")
        assert answer.headers["cross-origin-resource-policy"] == "cross-origin"
        assert "access-control-allow-origin" not in answer.headers
    with web.client(headers=asks) as client:
        assert client.get("/health").status_code == 403
    with web.client(Role.PRESENTER) as client:
        assert client.get("/health").status_code == 404


def test_only_the_probe_of_a_relay_may_reach_its_neighbours(relay: RunningWeb, web: RunningWeb):
    with relay.client(Role.GUEST) as client:
        page = client.get("/d/small").headers["content-security-policy"]
        tree = client.get("/d/small").text.partition('src="/a/')[2].partition("/")[0]
        probe = client.get(f"/a/{tree}/workers/probe.js")
    assert "one.example" not in page
    assert "connect-src 'self' http://one.example:8100;" in probe.headers["content-security-policy"]
    assert "secret" not in str(probe.headers)
    assert probe.headers["cache-control"] == "no-store"
    with web.client(Role.GUEST) as client:
        probe = client.get(f"/a/{tree}/workers/probe.js")
    assert "connect-src 'self';" in probe.headers["content-security-policy"]
    assert "immutable" in probe.headers["cache-control"]
