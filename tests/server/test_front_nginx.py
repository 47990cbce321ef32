"""Behind a real nginx, with TLS and a path, everybody comes from the address of this machine."""

from __future__ import annotations

import json
import ssl
from contextlib import contextmanager
from typing import TYPE_CHECKING, NamedTuple

import httpx2
import pytest
from websockets.exceptions import InvalidStatus

from studio.scene import SUBPROTOCOL
from tests.support.certificates import make_certificates
from tests.support.classmates import Classmate
from tests.support.nginx import Nginx, free_port, running_nginx
from tests.support.server import RunningStudio, running_studio

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator

    from tests.support.certificates import Certificates

pytestmark = pytest.mark.network
PATH = "/class/robots"


class Behind(NamedTuple):
    """A studio behind nginx, and the address that others use."""

    studio: RunningStudio
    nginx: Nginx
    address: str
    context: ssl.SSLContext

    @contextmanager
    def browser(self) -> Generator[Classmate]:
        """Somebody who comes through nginx."""
        made = Classmate(self.address, self.context)
        try:
            yield made
        finally:
            made.close()


@pytest.fixture(scope="module")
def certificates(tmp_path_factory: pytest.TempPathFactory) -> Certificates:
    return make_certificates(tmp_path_factory.mktemp("certificates"), "front")


@pytest.fixture(scope="module", params=[False, True], ids=["path kept", "path stripped"])
def behind(
    request: pytest.FixtureRequest,
    tmp_path_factory: pytest.TempPathFactory,
    certificates: Certificates,
) -> Iterator[Behind]:
    folder = tmp_path_factory.mktemp("behind")
    tls_port = free_port()
    address = f"https://localhost:{tls_port}{PATH}/"
    words = ["demo", "--share", "--host", "127.0.0.1", "--public-url", address]
    words += ["--trusted-proxy", "127.0.0.1", "--base-path", PATH]
    with (
        running_studio(words, folder / "data") as studio,
        running_nginx(
            folder / "nginx", studio.port, tls_port, certificates, f"{PATH}/", strips=request.param
        ) as nginx,
    ):
        context = ssl.create_default_context(cafile=certificates.authority)
        yield Behind(studio, nginx, address, context)


def test_a_student_joins_by_the_code_and_all_lanes_are_below_the_path(behind: Behind):
    with behind.browser() as ada:
        sent_on = ada.client.get("/d/rover")
        assert (sent_on.status_code, sent_on.headers["location"]) == (303, f"{PATH}/join")
        assert 'name="code"' in ada.client.get("/join").text
        joined = ada.join("Ada", behind.studio.class_code.lower())
        assert (joined.status_code, joined.headers["location"]) == (303, f"{PATH}/")
        page = ada.client.get("/d/rover")
        assert f'data-root="{PATH}"' in page.text
        assert f'src="{PATH}/a/' in page.text
        assert ada.client.get("/d/rover/viser/").status_code == 200
        with ada.lane() as lane:
            assert lane.until("you", name="Ada")["role"] == "student"
            assert lane.ask("zero_joints", document="rover")["kind"] == "NotInControlError"


def test_the_3d_view_and_streams_come_through(behind: Behind):
    with behind.browser() as ada:
        ada.join("Ada", behind.studio.class_code)
        with ada.websocket("/d/rover/viser", SUBPROTOCOL) as scene:
            assert len(scene.recv(timeout=60)) > 100
        with ada.websocket("/data") as data:
            data.send(json.dumps({"type": "ask_bulk"}))
            key = json.loads(data.recv(timeout=60))["key"]
            # The answer begins though nothing is streamed yet, and ends with the data lane.
            with ada.client.stream("GET", f"/bulk?key={key}") as bulk:
                assert bulk.status_code == 200
                data.close()
                assert bulk.read() == b""


def test_its_cookie_is_for_tls_scripts_do_not_see_it_and_a_link_from_a_chat_carries_it(
    behind: Behind,
):
    with behind.browser() as ada:
        given = ada.join("Ada", behind.studio.class_code).headers.get_list("set-cookie")
        (cookie,) = (one for one in given if "-member=" in one)
        parts = {part.strip().lower() for part in cookie.split(";")[1:]}
        assert {"secure", "httponly", "samesite=lax", f"path={PATH}"} <= parts


def test_the_owner_is_who_has_the_token_and_its_address_is_clean_at_once(behind: Behind):
    with behind.browser() as owner:
        answer = owner.client.get(f"/?token={behind.studio.token}")
        assert (answer.status_code, answer.headers["location"]) == (303, f"{PATH}/")
        assert answer.headers["referrer-policy"] == "no-referrer"
        assert "samesite=strict" in answer.headers["set-cookie"].lower()
        with owner.lane() as lane:
            assert lane.until("you")["role"] == "presenter"
            assert lane.ask("list_recent")["type"] == "done"
    log = behind.nginx.log
    assert log.count(behind.studio.token) == 1


def test_the_owner_chooses_packages_only_among_the_opened_folders(behind: Behind):
    with behind.browser() as owner:
        owner.client.get(f"/?token={behind.studio.token}")
        with owner.lane() as lane:
            refused = lane.ask("choose_package", name="x", folder="/etc", document="rover")
            assert refused["kind"] == "OutsideRootsError"


def test_who_comes_by_a_proxy_that_the_studio_was_not_told_of_owns_nothing(behind: Behind):
    """It asks from 127.0.0.1 under the name 127.0.0.1, as the owner's own browser does."""
    plain = f"http://127.0.0.1:{behind.nginx.plain_port}"
    with httpx2.Client(base_url=plain, trust_env=False) as stranger:
        for path in ("/api/health", "/api/documents", "/d/rover", "/api/documents/rover/urdf"):
            assert stranger.get(path).status_code == 403, path
        command = {"type": "choose_package", "name": "x", "folder": "/etc"}
        assert stranger.post("/api/commands", json=command).status_code == 403
        assert (
            stranger.get("/", headers={"accept": "text/html"}).headers["location"].endswith("/join")
        )


def test_a_page_of_another_site_gets_no_lane_though_the_cookie_was_stolen(behind: Behind):
    with behind.browser() as ada:
        ada.join("Ada", behind.studio.class_code)
        with pytest.raises(InvalidStatus) as refused, ada.lane(origin="https://evil.example"):
            pass
        assert refused.value.response.status_code == 403


def test_wrong_codes_are_counted_by_the_address_that_the_proxy_names(behind: Behind):
    """Last of all: this address is out of tries for a while, and a link is good all the same."""
    with behind.browser() as guesser:
        answers = [guesser.join("Eve", f"WRONG{number}") for number in range(40)]
        assert answers[0].status_code == 200
        assert answers[-1].status_code == 429
        assert guesser.join("Eve", behind.studio.class_code).status_code == 429
        assert not any("member" in one.headers.get("set-cookie", "") for one in answers)
        # A direct connection has an address of its own... of this machine, as nginx has.
        with httpx2.Client(base_url=behind.studio.origin, trust_env=False) as other:
            passed_on = {"x-forwarded-for": "203.0.113.9", "origin": behind.studio.origin}
            form = {"code": behind.studio.class_code, "name": "Bob"}
            assert other.post("/join", data=form, headers=passed_on).status_code == 303
