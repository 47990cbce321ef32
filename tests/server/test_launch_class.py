"""A class of a real studio: its options, TLS of its own, and coming back after it was killed."""

from __future__ import annotations

import base64
import hashlib
import io
import signal
import socket
import ssl
import zipfile
from contextlib import closing, suppress
from typing import TYPE_CHECKING, Any

import pytest

from tests.support.classmates import Classmate
from tests.support.command_line import studio as command
from tests.support.nginx import free_port
from tests.support.server import running_studio
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from pathlib import Path

    from tests.support.classmates import Lane

pytestmark = pytest.mark.network
WORDS = ["demo", "--share", "--host", "127.0.0.1", "--tls", "self"]
LESSON = "find_the_wheel"


def untrusting() -> ssl.SSLContext:
    """A context that takes any certificate; which one it is, is compared by its fingerprint."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    return context


def test_it_is_encrypted_and_all_come_back_after_the_studio_was_killed(tmp_path: Path):
    data, port = tmp_path / "data", free_port()
    with running_studio(WORDS, data, port=port) as studio:
        assert studio.url.startswith(f"https://127.0.0.1:{port}/?token=")
        code = studio.class_code
        assert studio.next_line("SHA-256").split()[-1] == fingerprint_at(port)
        ada = Classmate(studio.url, untrusting())
        assert ada.join("Ada", code).status_code == 303
        with ada.lane() as lane:
            person = lane.until("you")["person"]
            steps = work_of_a_student(lane, data)
        studio.process.send_signal(signal.SIGKILL)
        studio.process.wait(60)
    with closing(ada), running_studio(WORDS, data, port=port) as studio:
        assert studio.class_code == code
        with ada.lane() as lane:
            assert lane.until("you", name="Ada")["person"] == person
            assert lane.newest("control")["holder"] == ""
            (copy,) = lane.until("my_copies")["copies"]
            assert (copy["document"], copy["changes"]) == (f"rover~{person}", 2)
            lane.ask("watch", document=copy["document"])
            assert value_of(lane, "base_length") == "0.777"
            lane.ask("open_lesson", document=copy["document"], lesson=LESSON)
            assert done_s(lane) == steps
        owner = Classmate(studio.url, untrusting())
        owned = owner.client.get(f"/?token={studio.token}")
        assert {"Secure", "HttpOnly"} <= set(owned.headers["set-cookie"].split("; "))
        with closing(owner), owner.lane() as lane:
            names = [one["name"] for one in lane.until("class_state")["members"]]
            assert names == ["Ada"]
            assert [one["handed_s"] for one in lane.until("copies")["copies"]] == [copy["handed_s"]]
            zipped = zipfile.ZipFile(io.BytesIO(owner.client.get("/api/copies").content))
            text = zipped.read("Ada/rover/rover_description/urdf/rover.urdf.xacro")
            assert b'name="base_length" value="0.777"' in text
            lane.ask("get_lesson_table", lesson=LESSON)
            assert [one["done_s"] for one in lane.newest("lesson_table")["rows"]] == [steps]
            assert lane.ask("end_class")["type"] == "done"
        assert not list(data.glob("class-*.json"))
        assert ada.client.get("/d/rover").status_code == 403


def work_of_a_student(lane: Lane, data: Path) -> list[float | None]:
    """Make a copy, do steps of a lesson on it and hand it in; when the steps were done."""
    answer = lane.ask("open_copy", document="rover")
    assert answer["type"] == "done", answer
    name = lane.newest("opened")["document"]
    lane.ask("watch", document=name)
    lane.ask("open_lesson", document=name, lesson=LESSON)
    lane.ask("saw_panel", panel="origin")
    for site, text in (("wheel_radius", "0.2"), ("base_length", "0.777")):
        edit = {"document": name, "site": site_of(lane, site)["id"], "text": text}
        assert lane.ask("edit_site", **edit)["type"] == "done"
    while (done := done_s(lane)).count(None) != 1:
        lane.until("lesson_state")
    assert lane.ask("hand_in", document=name)["type"] == "done"
    # What is not answered is kept soon: a student loses what they did in that moment at most.
    edited = base64.b64encode(b"0.777")
    wait_until("the draft", lambda: holds(data / "drafts", edited))
    wait_until("the ticks", lambda: holds(data, LESSON.encode() + b"/"))
    return done


def holds(folder: Path, what: bytes) -> bool:
    """Whether a file in a folder has this in it."""
    with suppress(FileNotFoundError):
        return any(what in one.read_bytes() for one in folder.glob("*.json*"))
    return False


def site_of(lane: Lane, name: str) -> dict[str, Any]:
    """A site of the watched document, as it was told last."""
    while True:
        told = [
            one for event in lane.events if event["type"] == "sites" for one in event["changed"]
        ]
        if found := [one for one in told if one["name"].endswith(name)]:
            return found[-1]
        lane.until("sites")


def value_of(lane: Lane, name: str) -> str:
    """Its text."""
    return site_of(lane, name)["text"]


def done_s(lane: Lane) -> list[float | None]:
    """When the steps of the lesson were done, as was told last."""
    if not any(event["type"] == "lesson_state" for event in lane.events):
        lane.until("lesson_state")
    return [one["done_s"] for one in lane.newest("lesson_state")["steps"]]


def fingerprint_at(port: int) -> str:
    """Of the certificate that is shown there."""
    with (
        socket.create_connection(("127.0.0.1", port), 60) as plain,
        untrusting().wrap_socket(plain) as opened,
    ):
        certificate = opened.getpeercert(binary_form=True)
    assert certificate is not None
    return hashlib.sha256(certificate).digest().hex(":").upper()


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--trust", "--share"], "--trust is for you alone"),
        (["--trust", "--trusted-proxy", "127.0.0.1"], "--trust is for you alone"),
        (["--trust", "--no-token"], "--trust is for you alone"),
        (["--trust", "--viewer-link"], "--trust is for you alone"),
        (["--trust", "--host", "0.0.0.0"], "--trust is for you alone"),
        (["--tls-cert", "x.pem"], "belong together"),
        (["--tls", "self", "--tls-cert", "x", "--tls-key", "y"], "Choose one"),
        (["--tls-cert", "/no/x.pem", "--tls-key", "/no/y.pem"], "cannot use the certificate"),
        (["--public-url", "robots.example"], "--public-url"),
        (["--base-path", "/a b"], "--base-path"),
        (["--trusted-proxy", "nginx"], "--trusted-proxy"),
    ],
)
def test_options_that_do_not_go_together_are_refused_in_one_sentence(
    tmp_path: Path, words: list[str], sentence: str
):
    line = ["demo", *words, "--no-browser", "--no-graph", "--port", "0", "--data-dir", tmp_path]
    done = command(*map(str, line))
    assert done.code == 2
    assert sentence in done.err
    assert len(done.err.strip().splitlines()) == 1
