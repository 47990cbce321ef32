from __future__ import annotations

import gzip
import os
import re
from http.client import HTTPConnection
from typing import TYPE_CHECKING

import pytest

from studio.protocol.roles import Role
from studio.server.assets import Assets

if TYPE_CHECKING:
    from pathlib import Path

    from tests.support.web_server import RunningWeb


def base_of(web: RunningWeb) -> str:
    """Where the page says that its files are."""
    with web.client(Role.VIEWER) as client:
        found = re.search(r'src="(/a/\w+/)app/main.js"', client.get("/d/small").text)
    assert found
    return found[1]


def test_a_file_is_public_typed_compressed_and_kept_for_ever(web: RunningWeb):
    with web.client() as client:
        answer = client.get(f"{base_of(web)}app/main.js")
        assert answer.status_code == 200
        assert answer.text.startswith("export const answer")
        assert answer.headers["content-type"] == "text/javascript; charset=utf-8"
        assert answer.headers["content-encoding"] == "gzip"
        assert "immutable" in answer.headers["cache-control"]
        assert answer.headers["vary"] == "accept-encoding"
        plain = client.get(f"{base_of(web)}app/main.js", headers={"accept-encoding": "identity"})
        assert plain.text == answer.text
        assert "content-encoding" not in plain.headers


def test_a_file_of_another_state_of_the_tree_is_not_kept(web: RunningWeb):
    with web.client() as client:
        answer = client.get("/a/0123456789abcdef/app/main.js")
        assert answer.status_code == 200
        assert answer.headers["cache-control"] == "no-store"


@pytest.mark.parametrize(
    "path",
    [
        "../outside.js",
        "app/../../outside.js",
        "%2e%2e/outside.js",
        "..%2foutside.js",
        "..\\outside.js",
        "/etc/passwd",
        "app/main.js%00",
        "app//main.js",
        "./app/main.js",
        "index.html",
        "tools/secret.js",
        ".hidden.js",
        "notes.py",
        "app",
        "",
    ],
)
def test_no_path_leads_to_another_file(web: RunningWeb, path: str):
    # http.client sends a path as it is given; other clients resolve its dots.
    connection = HTTPConnection("127.0.0.1", web.port, timeout=60)
    connection.request("GET", base_of(web) + path)
    answer = connection.getresponse()
    assert answer.status in {403, 404}
    assert b"outside" not in answer.read()
    connection.close()


def test_a_link_out_of_the_folder_is_followed_only_to_files_of_it(tmp_path: Path):
    (tmp_path / "page").mkdir()
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "a.js").write_text("x")
    (tmp_path / "page" / "linked").symlink_to(tmp_path / "elsewhere")
    assert Assets(tmp_path / "page").current().files == {}


def test_a_changed_file_changes_the_address_of_all(tmp_path: Path):
    file = tmp_path / "a.js"
    file.write_text("1")
    assets = Assets(tmp_path)
    first = assets.current()
    assert assets.current() is first
    file.write_text("2")
    os.utime(file, ns=(1, 1))
    second = assets.current()
    assert second.base != first.base
    assert second.files["a.js"].content == b"2"


def test_a_small_file_is_not_made_larger_by_compressing_it(tmp_path: Path):
    (tmp_path / "small.js").write_text("1")
    (tmp_path / "large.js").write_text("1" * 1000)
    files = Assets(tmp_path).current().files
    assert files["small.js"].compressed is None
    compressed = files["large.js"].compressed
    assert compressed is not None
    assert gzip.decompress(compressed) == b"1" * 1000


def test_an_installation_without_the_page_says_so(tmp_path: Path):
    assert "install it again" in Assets(tmp_path / "none").current().index
