from __future__ import annotations

import re
from pathlib import Path

import pytest
import viser
import zstandard

from studio.errors import SceneError
from studio.scene import CLIENT_PATH, viser_client, viser_page


def test_our_script_and_style_come_before_everything_of_viser():
    page = viser_page("/a/abc").decode()
    head = page.index("<head>")
    assert page.index('href="/a/abc/viser/studio3d.css"') > head
    assert page.index('src="/a/abc/viser/early.js"') < page.index('src="/a/abc/viser/studio3d.js"')
    assert page.index('src="/a/abc/viser/studio3d.js"') < page.index("<script data-p=")


def test_the_address_of_the_assets_cannot_break_out_of_its_attribute():
    assert b'"><script>' not in viser_page('/a"><script>alert(1)</script>')[:1000]


def test_the_client_is_what_the_page_held():
    client = zstandard.decompress(viser_client())
    held = (Path(viser.__file__).parent / "client/build/index.html").read_text()
    styles, scripts = (int(re.findall(rf'data-{part}="(\d+)"', held)[0]) for part in ("ss", "cs"))
    assert len(client) == styles + scripts
    assert b"ZstdWasm" in client[styles:]


def test_the_page_is_small_and_fetches_the_client():
    page = viser_page("/a/abc").decode()
    assert len(page) < 40_000
    assert f'data-p="/a/abc/{CLIENT_PATH}"' in page
    assert "await fetch(d.p)" in page


def test_the_page_of_another_version_is_not_served(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(viser, "__version__", "2.0.0")
    with pytest.raises(SceneError, match=r"2\.0\.0"):
        viser_page("/a/of another version")
