"""Downloads over the wire: their names, whole contents, and refusals as sentences."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING
from urllib.parse import unquote

import pytest

from studio.protocol.roles import Role
from studio.server.api import disposition

if TYPE_CHECKING:
    from tests.support.web_server import RunningWeb

EXPORT = "/api/documents/small/export"


def test_a_download_keeps_its_name_and_cannot_be_shown_as_a_page(web: RunningWeb):
    with web.client(Role.PRESENTER) as client:
        answer = client.get(f"{EXPORT}/urdf?meshes=absolute")
    assert (answer.status_code, answer.text) == (200, "absolute")
    assert answer.headers["content-type"].startswith("application/xml")
    assert "sandbox" in answer.headers["content-security-policy"]
    told = answer.headers["content-disposition"]
    assert unquote(told.partition("filename*=UTF-8''")[2]) == "small 'robot\" ü🤖.urdf"


@pytest.mark.parametrize(("query", "data"), [("", b"entry!"), ("?packages=used", b"used!")])
def test_a_zip_comes_in_pieces_and_whole(web: RunningWeb, query: str, data: bytes):
    with web.client(Role.PRESENTER) as client:
        answer = client.get(f"{EXPORT}/package{query}")
    assert (answer.status_code, answer.content) == (200, data)


def test_what_cannot_be_exported_is_said(web: RunningWeb):
    with web.client(Role.PRESENTER) as client:
        answer = client.get(f"{EXPORT}/page?theme=light")
        assert answer.status_code == 409
        assert answer.json()["reason"] == "small was not exported: it has no light."
        assert client.get(f"{EXPORT}/urdf?meshes=none").status_code == 422
        assert client.get("/api/documents/gone/export/urdf").status_code == 404


def test_a_table_has_a_path_of_each_topic(web: RunningWeb):
    with web.client(Role.GUEST) as client:
        answer = client.get(f"{EXPORT}/series?topic=/a&topic=/b&path=.x&path=.y[0]")
        assert (answer.status_code, answer.text) == (200, "topic,path\n/a,.x\n/b,.y[0]\n")
        assert "plot.csv" in answer.headers["content-disposition"]
        refused = client.get(f"{EXPORT}/series?topic=/none&path=.x")
        assert (refused.status_code, refused.json()["reason"]) == (409, "/none has no number.")
        assert client.get(f"{EXPORT}/series?topic=/a").status_code == 422


@pytest.mark.parametrize(
    "name",
    ['a"b.urdf', "a\\b.urdf", "../../etc/passwd", "a\r\nset-cookie: x=1", "🤖", "", "ünï code"],
)
def test_no_name_breaks_out_of_its_header(name: str):
    header = disposition(name)
    assert re.fullmatch(
        r"attachment; filename=\"[\w\-.() ]+\"; filename\*=UTF-8''[\w%.~-]+", header
    )
    assert header.isascii()
    assert "/" not in unquote(header)
