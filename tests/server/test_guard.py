from __future__ import annotations

import socket
from typing import TYPE_CHECKING

import httpx2
import pytest
from websockets.exceptions import InvalidStatus

from studio.protocol.roles import Role
from tests.support.web_server import TOKEN, RunningWeb, running_web

if TYPE_CHECKING:
    from pathlib import Path

HTML = {"accept": "text/html"}


@pytest.mark.parametrize(
    "host",
    [
        "evil.example",
        "127.0.0.1.evil.example",
        "localhost.",
        "user@127.0.0.1",
        "",
        "10.1.2.3",
        "[::2]",
    ],
)
def test_another_host_name_gets_nothing_at_all(web: RunningWeb, host: str):
    with web.client(Role.PRESENTER) as client:
        for path in ("/", "/d/small", "/api/documents", "/a/none/app/main.js"):
            answer = client.get(path, headers={"host": f"{host}:{web.port}" if host else ""})
            assert answer.status_code in {400, 403}, path
            assert "small" not in answer.text


@pytest.mark.parametrize("name", ["localhost", "127.0.0.1", "[::1]"])
def test_the_loopback_names_are_known(web: RunningWeb, name: str):
    with web.client(Role.PRESENTER, {"host": f"{name}:{web.port}"}) as client:
        origin = f"http://{name}:{web.port}"
        assert client.get("/api/health", headers={"origin": origin}).status_code == 200


def test_two_host_headers_are_refused(web: RunningWeb):
    lines = [
        "GET /api/health HTTP/1.1",
        f"Host: 127.0.0.1:{web.port}",
        "Host: evil.example",
        f"Cookie: {web.cookie(Role.PRESENTER)}",
        "Connection: close",
    ]
    with socket.create_connection(("127.0.0.1", web.port), timeout=60) as raw:
        raw.sendall("\r\n".join([*lines, "", ""]).encode())
        assert raw.makefile("rb").readline().split()[1] in {b"400", b"403"}


def test_a_stranger_sees_the_way_in_and_nothing_else(web: RunningWeb):
    with web.client() as client:
        page = client.get("/d/small", headers=HTML)
        assert page.status_code == 403
        assert "address that the studio prints" in page.text
        for path in ("/", "/api/documents", "/api/openapi.json", "/d/small/viser/", "/no/such"):
            assert client.get(path).status_code == 403


@pytest.mark.parametrize("path", ["/control", "/d/small/viser", "/no/such"])
def test_a_stranger_opens_no_websocket(web: RunningWeb, path: str):
    with pytest.raises(InvalidStatus) as refused, web.websocket(path, role=None):
        pass
    assert refused.value.response.status_code == 403


def test_the_token_is_exchanged_for_a_cookie_and_leaves_the_address(web: RunningWeb):
    with web.client() as client:
        answer = client.get(f"/?token={TOKEN}&theme=dark")
        assert answer.status_code == 303
        assert answer.headers["location"] == "/?theme=dark"
        cookie = answer.headers["set-cookie"]
        assert cookie.startswith(f"studio-{web.port}=")
        assert {"HttpOnly", "Path=/", "SameSite=strict"} <= set(cookie.split("; "))
        assert TOKEN not in cookie
        assert client.get("/", headers=HTML).headers["location"] == "/d/small"
        assert client.get("/d/small", headers=HTML).status_code == 200


def test_each_role_has_its_own_token(web: RunningWeb):
    for role in (Role.PRESENTER, Role.GUEST):
        with web.client() as client:
            assert client.get(f"/?token={web.credentials.token_of(role)}").status_code == 303
            saves = client.post(
                "/api/commands", content='{"type":"zero_joints"}', headers={"origin": web.origin}
            )
            assert saves.status_code == (200 if role is Role.PRESENTER else 403)


@pytest.mark.parametrize("token", ["", "wrong", TOKEN + "x", TOKEN[:-1], "%00", "ä"])
def test_a_wrong_token_gives_no_cookie(web: RunningWeb, token: str):
    with web.client() as client:
        answer = client.get(f"/?token={token}", headers=HTML)
        assert answer.status_code == 403
        assert "set-cookie" not in answer.headers


def test_a_viewer_s_link_leaves_a_presenter_the_presenter(web: RunningWeb):
    link = f"/?token={web.credentials.token_of(Role.GUEST)}"
    with web.client(headers={"origin": web.origin}) as client:
        client.get(f"/?token={TOKEN}")
        assert "set-cookie" not in client.get(link).headers
        # From another site the strict cookie does not come along: who asks is not known.
        from_chat = {"sec-fetch-site": "cross-site", "sec-fetch-mode": "navigate"}
        kept = client.cookies
        client.cookies = httpx2.Cookies()
        came = client.get(link, headers=from_chat | {"sec-fetch-dest": "document"})
        kept.update(came.cookies)
        client.cookies = kept
        assert len(kept) == 2
        assert client.post("/api/commands", content='{"type":"zero_joints"}').status_code == 200


def test_a_presenter_s_link_makes_a_viewer_the_presenter(web: RunningWeb):
    with web.client() as client:
        for role, status in {Role.GUEST: 403, Role.PRESENTER: 200}.items():
            client.get(f"/?token={web.credentials.token_of(role)}")
            did = client.post(
                "/api/commands", content='{"type":"zero_joints"}', headers={"origin": web.origin}
            )
            assert did.status_code == status


def test_a_one_time_code_opens_the_page_for_the_first_who_shows_it(web: RunningWeb):
    code = web.credentials.new_code()
    with web.client() as owner, web.client() as thief:
        assert owner.head(f"/?code={code}").status_code == 403  # a look does not spend it
        came = owner.get(f"/?code={code}&theme=dark")
        assert (came.status_code, came.headers["location"]) == (303, "/?theme=dark")
        assert owner.get("/api/health").status_code == 200
        assert thief.get(f"/?code={code}").status_code == 403
        assert thief.get("/api/health").status_code == 403
        assert owner.get(f"/?code={code}").status_code == 303  # the same tab, opened again


def test_an_old_address_still_works_for_who_is_known(web: RunningWeb):
    with web.client(Role.PRESENTER) as client:
        answer = client.get("/d/small?token=of-yesterday")
        assert (answer.status_code, answer.headers["location"]) == (303, "/d/small")


@pytest.mark.parametrize(
    "path", ["//evil.example/x", "/\\evil.example", "/%5Cevil.example", "/%2F%2Fevil.example"]
)
def test_the_exchange_never_leads_to_another_host(web: RunningWeb, path: str):
    with web.client() as client:
        request = client.build_request("GET", "/")
        request.url = request.url.copy_with(raw_path=f"{path}?token={TOKEN}".encode())
        location = client.send(request).headers.get("location", "/")
        assert location.startswith("/")
        assert not location.startswith(("//", "/\\"))


@pytest.mark.parametrize("site", ["cross-site", "same-site"])
def test_a_link_on_another_site_leads_in_by_a_step_of_our_own_page(web: RunningWeb, site: str):
    headers = HTML | {
        "sec-fetch-site": site,
        "sec-fetch-mode": "navigate",
        "sec-fetch-dest": "document",
    }
    with web.client(headers=headers) as client:
        answer = client.get(f"/?token={TOKEN}")
        assert answer.status_code == 200
        assert 'http-equiv="refresh" content="0;url=/"' in answer.text
        assert "set-cookie" in answer.headers
    with web.client(headers=headers) as client:  # the strict cookie does not come along at first
        assert 'content="0;url=/d/small?a=%22"' in client.get("/d/small?a=%22").text


@pytest.mark.parametrize("cookie", ["x", "studio-{port}=", "studio-{port}=x", "studio-{port}=\xff"])
def test_a_forged_cookie_opens_nothing(web: RunningWeb, cookie: str):
    with web.client() as client:
        value = cookie.format(port=web.port).encode("latin-1")
        assert client.get("/api/health", headers={b"cookie": value}).status_code == 403


def test_a_cookie_is_found_among_odd_ones_of_other_programs(web: RunningWeb):
    with web.client() as client:
        odd = f'a="; =; b[]=1; {web.cookie(Role.GUEST)}; c=@@,,'
        assert client.get("/api/health", headers={"cookie": odd}).status_code == 200


def test_a_script_shows_its_token_as_bearer(web: RunningWeb):
    with web.client(headers={"authorization": f"Bearer {TOKEN}"}) as client:
        assert client.post("/api/commands", content='{"type":"zero_joints"}').status_code == 200
    with web.client(headers={"authorization": "Bearer wrong"}) as client:
        assert client.get("/api/health").status_code == 403


OTHER_ORIGINS = [
    "http://evil.example",
    "http://127.0.0.1:1",
    "http://localhost:{port}",
    "http://127.0.0.1:{port}.evil.example",
    "http://127.0.0.1:{port}/x",
    "ftp://127.0.0.1:{port}",
    "null",
    "",
]


@pytest.mark.parametrize("origin", OTHER_ORIGINS)
def test_a_page_of_another_origin_reads_saves_and_opens_nothing(web: RunningWeb, origin: str):
    origin = origin.format(port=web.port)
    before = len(web.engine.executed)
    with web.client(Role.PRESENTER, {"origin": origin}) as client:
        assert client.get("/api/documents").status_code == 403
        for kind in ("save", "zero_joints"):
            body = f'{{"type":"{kind}","document":"small"}}'
            assert client.post("/api/commands", content=body).status_code == 403
    for path in ("/control", "/d/small/viser"):
        with pytest.raises(InvalidStatus) as refused, web.websocket(path, origin=origin):
            pass
        assert refused.value.response.status_code == 403
    assert len(web.engine.executed) == before


def test_an_origin_is_needed_for_a_websocket_and_for_changes(web: RunningWeb):
    with pytest.raises(InvalidStatus), web.websocket("/control", origin=None):
        pass
    with web.client(headers={"cookie": web.cookie(Role.PRESENTER)}) as client:
        assert client.post("/api/commands", content='{"type":"save"}').status_code == 403


@pytest.mark.parametrize("site", ["cross-site", "same-site", "none"])
def test_what_the_browser_says_of_the_asking_site_is_heard(web: RunningWeb, site: str):
    with web.client(Role.PRESENTER, {"sec-fetch-site": site}) as client:
        assert client.post("/api/commands", content='{"type":"save"}').status_code == 403
        readable = 200 if site == "none" else 403  # none: a person typed the address
        assert client.get("/api/health").status_code == readable
    with pytest.raises(InvalidStatus), web.websocket("/control", headers={"Sec-Fetch-Site": site}):
        pass


def test_another_site_may_not_frame_the_page(web: RunningWeb):
    asks = {
        "sec-fetch-site": "cross-site",
        "sec-fetch-mode": "navigate",
        "sec-fetch-dest": "iframe",
    }
    with web.client(Role.PRESENTER, asks) as client:
        del client.headers["origin"]
        assert client.get("/d/small").status_code == 403


def test_without_a_token_everyone_who_reaches_the_port_looks_and_nobody_owns(
    assets_folder: Path,
):
    with running_web(assets_folder, guests=True) as web:
        with web.client(headers={"accept": "text/html"}) as client:
            client.follow_redirects = True
            assert client.get("/d/small").status_code == 200
            own = {"origin": web.origin}
            command = {"type": "save", "document": "small"}
            answer = client.post("/api/commands", json=command, headers=own)
            assert answer.json()["kind"] == "NotAllowedError"
            assert client.get("/api/health", headers={"host": "evil.example"}).status_code == 403
            cookie = "; ".join(f"{name}={value}" for name, value in client.cookies.items())
        with (
            pytest.raises(InvalidStatus),
            web.websocket(
                "/control", None, origin="http://evil.example", headers={"Cookie": cookie}
            ),
        ):
            pass


def test_beyond_loopback_addresses_are_known_but_names_are_not(assets_folder: Path):
    with running_web(assets_folder, host="0.0.0.0") as web, web.client(Role.PRESENTER) as client:
        del client.headers["origin"]
        for host, status in {"192.168.1.7": 200, "evil.example": 403}.items():
            answer = client.get("/api/health", headers={"host": f"{host}:{web.port}"})
            assert answer.status_code == status


def test_every_answer_tells_the_browser_how_to_treat_it(web: RunningWeb):
    with web.client(Role.PRESENTER) as client:
        for path in (
            "/",
            "/d/small",
            "/d/small/viser/",
            "/api/health",
            "/no/such",
            "/a/x/app/main.js",
        ):
            headers = client.get(path).headers
            assert headers["x-content-type-options"] == "nosniff", path
            assert headers["cross-origin-resource-policy"] == "same-origin"
            assert headers["cross-origin-opener-policy"] == "same-origin"
            assert headers["referrer-policy"] == "same-origin"
            assert "frame-ancestors 'self'" in headers["content-security-policy"]
            assert "server" not in headers
