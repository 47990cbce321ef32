"""The whole studio as a person starts it; all else of this room is tested beside it."""

from __future__ import annotations

import json
import re
import signal
import socket
import sys
from collections import deque
from contextlib import ExitStack, contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit
from urllib.request import url2pathname

import httpx2
import pytest
from websockets.exceptions import ConnectionClosed

from studio.scene import SUBPROTOCOL
from studio.server.launch import remarks
from studio.settings import DEFAULT_PORT, Settings
from tests.support.server import RunningStudio, running_process, running_studio
from tests.support.studio_page import wait_until
from tests.support.wire import free_port

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator

    from websockets.sync.connection import Connection

linux = pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")


@pytest.fixture(scope="module")
def demo(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningStudio]:
    words = ["demo", "--viewer-link"]
    with running_studio(words, tmp_path_factory.mktemp("demo") / "data") as running:
        yield running


@pytest.fixture(scope="module")
def tokenless(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningStudio]:
    """Without a token, and without the port that it would have."""
    with socket.socket() as held:
        held.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        with suppress(OSError):  # taken by somebody else: as good
            held.bind(("127.0.0.1", DEFAULT_PORT))
            held.listen()
        data = tmp_path_factory.mktemp("tokenless") / "data"
        with running_studio(["demo", "--no-token"], data, port=None) as running:
            yield running


def until(lane: Connection, kind: str) -> dict[str, Any]:
    """The next event of a kind."""
    while True:
        message = lane.recv(timeout=60)
        if isinstance(message, str):
            event: dict[str, Any] = json.loads(message)
            if event["type"] == kind:
                return event


def watch(studio: RunningStudio, document: str) -> Connection:
    """A control lane that looks at a document."""
    lane = studio.websocket("/control")
    lane.send(json.dumps({"type": "watch", "document": document}))
    return lane


def test_one_plain_line_says_where_it_is(demo: RunningStudio):
    assert re.fullmatch(r"Studio: http://127\.0\.0\.1:\d+/\?token=[\w-]{32}", demo.line)


def test_the_page_answers_when_the_line_is_printed(demo: RunningStudio):
    with demo.client() as client:
        page = client.get("/", headers={"accept": "text/html"})
        assert page.status_code == 200
        assert page.url.path == "/d/rover"
        assert "{{" not in page.text
        for address in set(re.findall(r'(?:src|href)="(/a/[^"]+\.\w+)"', page.text)):
            assert client.get(address).status_code == 200, address


@linux
def test_the_browser_needs_one_port_and_it_listens_on_no_other(demo: RunningStudio):
    assert demo.listening_ports() == {demo.port}


def test_the_scene_speaks_on_the_same_port(demo: RunningStudio):
    with demo.client() as client:
        page = client.get("/d/rover/viser/")
        assert page.status_code == 200
        for address in set(re.findall(r'(?:src|href)="(/a/[^"]+\.\w+)"', page.text)):
            assert client.get(address).status_code == 200, address
    with demo.websocket("/d/rover/viser", SUBPROTOCOL) as lane:
        assert isinstance(lane.recv(timeout=60), bytes)


def test_the_robot_comes_over_the_control_lane(demo: RunningStudio):
    with watch(demo, "rover") as lane:
        assert len(until(lane, "robot")["links"]) > 10


def test_the_urdf_of_the_demo_comes_as_a_file(demo: RunningStudio):
    with demo.client() as client, watch(demo, "rover") as lane:
        until(lane, "robot")
        assert "<robot name=" in client.get("/api/documents/rover/urdf").text


@linux
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_with_all_its_workers_within_two_seconds(
    tmp_path: Path, number: signal.Signals
):
    with running_studio(["demo"], tmp_path / "data") as studio:
        control = watch(studio, "rover")
        scene = studio.websocket("/d/rover/viser", SUBPROTOCOL)
        scene.recv(timeout=60)
        site = until(control, "sites")["changed"][0]["id"]
        for request in range(30):  # the workers are busy when the signal comes
            edit = {"type": "edit_site", "document": "rover", "site": site}
            control.send(json.dumps(edit | {"text": f"{request}", "request": request}))
        workers = studio.children()
        assert workers
        code, took_s = studio.stop(number)
        assert (code, took_s < 2) == (0, True)
        assert not [pid for pid in workers if Path(f"/proc/{pid}").exists()]
        for lane in (control, scene):
            with pytest.raises(ConnectionClosed):
                deque(iter(partial(lane.recv, timeout=60), None), maxlen=0)
        assert not [line for line in studio.stderr.splitlines() if "runs as root" not in line]


def test_the_default_port_or_the_next_free_one_and_it_says_so(tokenless: RunningStudio):
    assert DEFAULT_PORT < tokenless.port < DEFAULT_PORT + 100
    assert f"Port {DEFAULT_PORT} is taken" in tokenless.stderr
    assert f"uses {tokenless.port}" in tokenless.stderr


def test_an_open_tab_is_still_known_after_a_restart(tmp_path: Path):
    port = free_port()  # one that nobody is lent while no studio holds it
    with running_studio(["demo"], tmp_path / "data", port=port) as first, first.client() as client:
        cookies = dict(client.cookies)
        first.stop()
    with running_studio(["demo"], tmp_path / "data", port=port) as second:
        assert second.token != first.token
        with httpx2.Client(base_url=second.origin, cookies=cookies, trust_env=False) as client:
            assert client.get("/api/health").status_code == 200
            assert client.get(f"/?token={first.token}").status_code == 303


def test_a_viewer_gets_an_address_of_their_own_and_only_looks(demo: RunningStudio):
    token = re.fullmatch(rf"{demo.origin}/\?token=(\w+)", demo.viewer_url)
    assert token
    headers = {"authorization": f"Bearer {token[1]}"}
    with httpx2.Client(base_url=demo.origin, headers=headers, trust_env=False) as client:
        assert client.get("/d/rover").status_code == 200
        refused = client.post("/api/commands", json={"type": "save", "document": "rover"})
        assert (refused.status_code, refused.json()["kind"]) == (403, "NotAllowedError")


def test_without_a_token_one_may_look_and_the_owners_address_has_it_still(
    tokenless: RunningStudio,
):
    assert re.fullmatch(rf"Studio: {tokenless.origin}/\?token=[\w-]{{32}}", tokenless.line)
    with httpx2.Client(base_url=tokenless.origin, trust_env=False, follow_redirects=True) as client:
        client.headers["accept"] = "text/html"
        assert client.get("/d/rover").status_code == 200
        own, command = {"origin": tokenless.origin}, {"type": "list_recent"}
        refused = client.post("/api/commands", json=command, headers=own)
        assert refused.json()["kind"] == "NotAllowedError"


def test_beyond_this_machine_it_warns():
    assert remarks(Settings(), DEFAULT_PORT) == []
    (warning,) = remarks(Settings(host="0.0.0.0", port=8000), 8000)
    assert "not encrypted" in warning


def test_as_root_it_warns_once():
    (warning,) = remarks(Settings(), DEFAULT_PORT, is_root=True)
    assert "runs as root" in warning


@pytest.mark.skipif(sys.platform != "linux", reason="xdg-open and BROWSER")
def test_no_command_line_shows_the_token_and_the_opened_page_is_the_presenter_s(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    shown = tmp_path / "shown"
    browser = tmp_path / "browser"
    browser.write_text(f'#!/bin/sh\necho "$0 $@" > {shown}.part && mv {shown}.part {shown}\n')
    browser.chmod(0o755)
    monkeypatch.setenv("BROWSER", f"{browser} %s")
    monkeypatch.setenv("DISPLAY", ":0")
    errors = tmp_path / "stderr"
    options = ["--data-dir", str(tmp_path / "data"), "--port", "0", "--no-graph"]
    with running_process(["studio", "demo", *options], errors) as studio:
        wait_until("the browser", shown.exists)
        command = shown.read_text()
        assert studio.token not in command
        file = Path(url2pathname(urlsplit(command.split()[1]).path))
        text = file.read_text()
        assert studio.token not in text
        found = re.search(r'href="(http://[^"]+)"', text)
        assert found
        with httpx2.Client(trust_env=False, follow_redirects=True) as client:
            assert client.get(found[1]).status_code == 200
            command = '{"type": "zero_joints", "document": "rover"}'
            did = client.post(
                f"{studio.origin}/api/commands", content=command, headers={"origin": studio.origin}
            )
            assert did.status_code == 200
        assert httpx2.get(found[1], trust_env=False).status_code == 403
        studio.stop()
        assert not file.exists()


def asked(studio: RunningStudio, **command: object) -> list[dict[str, Any]]:
    """The events that a command by REST brought about."""
    with studio.client() as client:
        answer = client.post("/api/commands", content=json.dumps({"document": "rover"} | command))
        assert answer.status_code == 200, answer.text
        return answer.json()["events"]


def texts_of(studio: RunningStudio, name: str = "rover") -> dict[str, Any]:
    """The text of an open file, as it is edited and as the disk has it."""
    with studio.client() as client:
        documents = client.get("/api/documents").json()["documents"]
    (path,) = (one["path"] for one in documents if one["id"] == name)
    (text, _) = asked(studio, type="get_text", file=path, document=name)
    return text


@linux
def test_unsaved_work_outlasts_a_kill_and_ends_with_a_fresh_copy(tmp_path: Path):
    data = tmp_path / "data"
    with running_studio(["demo"], data) as studio:
        text = texts_of(studio)
        at = text["text"].index("<robot")
        change = {"start": at, "end": at, "text": "<!-- mine ü🤖 -->"}
        seen = {"file": text["file"], "version": text["version"]}
        asked(studio, type="edit_text", changes=[change], **seen)
        drafts = data / "drafts"
        wait_until("a draft", lambda: any(drafts.glob("*.json")))
        studio.stop(signal.SIGKILL)
    with running_studio(["demo"], data) as studio:
        again = texts_of(studio)
        assert "<!-- mine ü🤖 --><robot" in again["text"]
        assert again["saved"] == text["text"]
    with running_studio(["demo", "--fresh"], data) as studio:
        fresh = texts_of(studio)
        assert (fresh["text"], fresh["saved"]) == (text["text"], None)


@contextmanager
def descriptors(limit: int) -> Generator[None]:
    """What is started in the block may hold so many; this process may hold all it can."""
    import resource

    _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    if most < 2 * limit:
        pytest.skip(f"This system lets nobody hold {2 * limit} descriptors")
    resource.setrlimit(resource.RLIMIT_NOFILE, (limit, most))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))


@pytest.mark.sweep
@linux
def test_with_more_silent_strangers_than_descriptors_the_presenter_gets_in_and_works(
    tmp_path: Path,
):
    data = tmp_path / "data"
    with ExitStack() as held:
        with descriptors(1_024):
            studio = held.enter_context(running_studio(["demo"], data))
        for _ in range(1_100):
            held.enter_context(socket.create_connection(("127.0.0.1", studio.port), timeout=60))
        held.enter_context(watch(studio, "rover"))
        meshes = set((data / "meshes").rglob("*"))
        asked(studio, type="open_example", name="arm6_description", document="")
        wait_until("its meshes", lambda: len(set((data / "meshes").rglob("*")) - meshes) > 0)
        text = texts_of(studio, "arm6")
        at = text["text"].index("<robot")
        change = {"start": at, "end": at, "text": "<!-- mine -->"}
        seen = {"file": text["file"], "version": text["version"], "document": "arm6"}
        asked(studio, type="edit_text", changes=[change], **seen)
        asked(studio, type="save", document="arm6")
        assert "<!-- mine --><robot" in Path(text["file"]).read_text(encoding="utf-8")
