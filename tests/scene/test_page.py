from __future__ import annotations

import gzip

import pytest
import viser

from studio.errors import SceneError
from studio.scene import viser_page, viser_page_gzipped


def test_our_script_and_style_come_before_everything_of_viser():
    page = viser_page("/a/abc").decode()
    head = page.index("<head>")
    assert page.index('href="/a/abc/viser/studio3d.css"') > head
    assert page.index('src="/a/abc/viser/early.js"') < page.index('src="/a/abc/viser/studio3d.js"')
    assert page.index('src="/a/abc/viser/studio3d.js"') < page.index("<script data-p=")


def test_the_address_of_the_assets_cannot_break_out_of_its_attribute():
    assert b'"><script>' not in viser_page('/a"><script>alert(1)</script>')[:1000]


def test_the_page_is_compressed_once():
    assert viser_page_gzipped("/a/abc") is viser_page_gzipped("/a/abc")
    assert gzip.decompress(viser_page_gzipped("/a/abc")) == viser_page("/a/abc")


def test_the_page_of_another_version_is_not_served(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(viser, "__version__", "2.0.0")
    with pytest.raises(SceneError, match=r"2\.0\.0"):
        viser_page("/a/of another version")
