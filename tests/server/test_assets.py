from __future__ import annotations

import gzip
import json
import os
import re
from http.client import HTTPConnection
from typing import TYPE_CHECKING

import pytest
import zstandard

from studio.protocol.roles import Role
from studio.server.assets import CHECK_TEXTS, Assets, accepted_coding, check_texts

if TYPE_CHECKING:
    from pathlib import Path

    from tests.support.web_server import RunningWeb


def base_of(web: RunningWeb) -> str:
    """Where the page says that its files are."""
    with web.client(Role.GUEST) as client:
        found = re.search(r'src="(/a/\w+/)app/main.js"', client.get("/d/small").text)
    assert found
    return found[1]


def test_a_file_is_public_typed_compressed_and_kept_for_ever(web: RunningWeb):
    with web.client() as client:
        path = f"{base_of(web)}app/main.js"
        answer = client.get(path, headers={"accept-encoding": "gzip"})
        assert answer.status_code == 200
        assert answer.text.startswith("export const answer")
        assert answer.headers["content-type"] == "text/javascript; charset=utf-8"
        assert answer.headers["content-encoding"] == "gzip"
        assert "immutable" in answer.headers["cache-control"]
        assert answer.headers["vary"] == "accept-encoding"
        smaller = client.get(path, headers={"accept-encoding": "gzip, zstd"})
        assert smaller.headers["content-encoding"] == "zstd"
        assert smaller.text == answer.text
        plain = client.get(path, headers={"accept-encoding": "identity"})
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


def test_only_the_folder_beside_the_page_is_kept_back(tmp_path: Path):
    for folder in ("tools", "viser/tools"):
        (tmp_path / folder).mkdir(parents=True)
        (tmp_path / folder / "a.js").write_text("x")
    assert list(Assets(tmp_path).current().files) == ["viser/tools/a.js"]


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
    assert files["small.js"].packed("gzip") is None
    assert files["small.js"].packed("zstd") is None
    compressed = files["large.js"].packed("gzip")
    assert compressed is not None
    assert gzip.decompress(compressed) == b"1" * 1000
    compressed = files["large.js"].packed("zstd")
    assert compressed is not None
    assert zstandard.decompress(compressed) == b"1" * 1000
    assert files["large.js"].packed("zstd") is compressed


@pytest.mark.parametrize(
    ("accepted", "coding"),
    [
        ("gzip, deflate, br, zstd", "zstd"),
        ("gzip;q=1.0, identity", "gzip"),
        ("br", None),
        ("xgzip", None),
        ("", None),
    ],
)
def test_a_file_is_packed_as_the_browser_takes_it(accepted: str, coding: str | None):
    assert accepted_coding(accepted) == coding


def write_all(folder: Path, texts: dict[str, str]) -> Assets:
    for name, text in texts.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    return Assets(folder)


def test_a_stylesheet_holds_what_it_imports_in_its_place(tmp_path: Path):
    texts = {
        "styles/page.css": '/* all */\n@import "a.css";\n@import "../b.css";\n@import "no.css";\n',
        "styles/a.css": '@import "c.css";\n.a {}\n',
        "styles/c.css": ".c {}\n",
        "b.css": ".b {}\n",
    }
    files = write_all(tmp_path, texts).current().files
    page = files["styles/page.css"].content.decode()
    assert page == '/* all */\n.c {}\n.a {}\n.b {}\n@import "no.css";\n'
    assert files["b.css"].content == b".b {}\n"


def test_a_stylesheet_imports_all_of_a_folder_by_name(tmp_path: Path):
    texts = {
        "styles/page.css": '@import "../panels/**/*.css";\n.z {}\n',
        "panels/b/b.css": ".b {}\n",
        "panels/a.css": ".a {}\n",
        "panels/b/b.js": "",
    }
    files = write_all(tmp_path, texts).current().files
    assert files["styles/page.css"].content == b".a {}\n.b {}\n.z {}\n"


def test_the_words_of_a_language_hold_those_of_the_panels_and_english_ones_that_it_lacks(
    tmp_path: Path,
):
    texts = {
        "i18n/en.json": '{"close": "Close", "open": "Open"}',
        "i18n/de.json": '{"close": "Schließen"}',
        "panels/log/panel.json": json.dumps(
            {"words": {"en": {"log": "Log", "a": "A"}, "de": {"log": "Protokoll"}}}
        ),
    }
    files = write_all(tmp_path, texts).current().files
    english, german = (json.loads(files[f"i18n/{one}.json"].content) for one in ("en", "de"))
    assert english == {"close": "Close", "open": "Open", "log": "Log", "a": "A"}
    assert german == {"close": "Schließen", "open": "Open", "log": "Protokoll", "a": "A"}


def test_the_page_holds_what_each_folder_of_a_panel_says_of_it(tmp_path: Path):
    battery = {"group": "watch", "icon": [["path", {"d": "</script>"}]]}
    texts = {
        "index.html": '<script id="panels">{{panels}}</script>',
        "panels/battery/panel.json": json.dumps({**battery, "words": {"en": {"a": "A"}}}),
        "panels/log/panel.json": '{"group": "watch", "icon": "log"}',
        "panels/parts.js": "",
    }
    index = write_all(tmp_path, texts).current().index
    rows = index.removeprefix('<script id="panels">').removesuffix("</script>")
    assert "<" not in rows
    assert json.loads(rows) == {"battery": battery, "log": {"group": "watch", "icon": "log"}}


def test_the_words_hold_why_a_finding_matters(tmp_path: Path):
    written = tmp_path / "i18n"
    written.mkdir()
    for language in ("en", "de"):
        (written / f"{language}.json").write_text("{}")
    made = check_texts({"bad-mass": {"en": "Forces divide by it.", "de": "Kräfte."}})
    files = Assets(tmp_path, {CHECK_TEXTS: lambda: made}).current().files
    assert json.loads(files["i18n/en.json"].content) == {"why.bad-mass": "Forces divide by it."}
    assert json.loads(files["i18n/de.json"].content) == {"why.bad-mass": "Kräfte."}


def test_the_page_names_all_modules_that_its_own_import_but_not_those_that_come_later(
    tmp_path: Path,
):
    texts = {
        "index.html": '{{preloads}}<script type="module" src="{{base}}app/main.js"></script>',
        "app/main.js": (
            '/** import "../not/this.js" */\nimport { one,\n  two } from "../lib/one.js";\n'
            'import "vendor/large.js";\nexport * from "./own.js";\nimport("./later.js");\n'
        ),
        "lib/one.js": 'import { deep } from "./deep.js";\n',
        "lib/deep.js": 'import * as one from "./one.js";\n',
        "vendor/large.js": "0;" * 500,
        "app/own.js": "export const a = 1;",
        "app/later.js": "",
    }
    tree = write_all(tmp_path, texts).current()
    named = re.findall(r'<link rel="modulepreload" href="{{base}}([^"]+)">', tree.index)
    assert named[0] == "vendor/large.js"
    assert sorted(named) == ["app/own.js", "lib/deep.js", "lib/one.js", "vendor/large.js"]


def test_a_file_made_in_memory_is_one_of_the_tree(tmp_path: Path):
    plain = Assets(tmp_path).current()
    tree = Assets(tmp_path, {"viser/client.zst": lambda: b"packed" * 100}).current()
    asset = tree.files["viser/client.zst"]
    assert (asset.content, asset.type) == (b"packed" * 100, "application/zstd")
    assert asset.packed("gzip") is None
    assert tree.base != plain.base


def test_an_installation_without_the_page_says_so(tmp_path: Path):
    assert "install it again" in Assets(tmp_path / "none").current().index
