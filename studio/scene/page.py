"""viser's own page with our script and style in it."""

from __future__ import annotations

import gzip
import html
from functools import lru_cache
from pathlib import Path

import viser

from studio.errors import SceneError
from studio.scene.host import check_version

_HEAD = b"<head>"


@lru_cache(maxsize=4)
def viser_page(assets_prefix: str) -> bytes:
    """The page as HTML; send it with `no-store`, for an old one cannot talk to a new server.

    Args:
        assets_prefix: Address below which `frontend_assets` is served, without a slash at the end.

    Raises:
        SceneError: Another version of viser is installed, or its page is not as we know it.
    """
    check_version()
    page = (Path(viser.__file__).parent / "client" / "build" / "index.html").read_bytes()
    if page.count(_HEAD) != 1:
        raise SceneError("viser's page is not as the 3D view knows it: install viser anew.")
    return page.replace(_HEAD, _HEAD + _injected(html.escape(assets_prefix)).encode())


@lru_cache(maxsize=4)
def viser_page_gzipped(assets_prefix: str) -> bytes:
    """`viser_page`, compressed once."""
    return gzip.compress(viser_page(assets_prefix), mtime=0)


def _injected(prefix: str) -> str:
    """First in the head, so that the script runs before viser's own."""
    return (
        f'<link rel="stylesheet" href="{prefix}/viser/studio3d.css">'
        f'<script src="{prefix}/viser/early.js"></script>'
        f'<script type="module" src="{prefix}/viser/studio3d.js"></script>'
    )
