"""viser's own page with our script in it, its client, and the view as one page without a server.

viser's page holds its client, packed with zstd and written as letters. Here the page fetches the
client instead: a browser keeps it, and the page around can have it fetched early.
"""

# viser's insides are met here, in host.py and in wire.py only.
# pyright: reportPrivateUsage=false

from __future__ import annotations

import html
import math
import re
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
import viser
from viser import _messages

from studio.errors import SceneError
from studio.scene.graph import GRID
from studio.scene.host import check_version

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.robot.values import Vector3

CLIENT_PATH: Final = "viser/client.zst"
"""Path of `viser_client` below the address of the assets."""

_HEAD: Final = "<head>"
_PACKED: Final = re.compile(r'(?<= data-p=")[^"]{100000,}(?=")')
_UNPACKED: Final = "const a=de(d.p);"
_FETCHED: Final = "const a=new Uint8Array(await(await fetch(d.p)).arrayBuffer());"
_LETTERS: Final = (
    b"!#$%()*+,-./0123456789:;=?@ABCDEFGHIJKLMNOPQRSTUVWXYZ[\\]^_abcdefghijklmnopqrstuvwxyz{|}~"
)
_GROUP: Final = 5
"""So many letters, of 88 kinds, encode four bytes."""
_TOWARDS_EYE: Final = (1.0, -0.8, 0.62)
"""Direction from the centre, as in the studio's first view."""
_DISTANCE: Final = 0.95
"""Of the camera, in sizes of the robot."""
_FIELD_OF_VIEW_RAD: Final = math.radians(42)
_GRID: Final = {
    True: {"cell_color": (66, 75, 91), "section_color": (88, 100, 120)},
    False: {"cell_color": (150, 160, 178), "section_color": (122, 135, 158)},
}
"""By whether the ground is dark, in the studio's colours."""
_POLICY: Final = (
    "default-src 'none'; script-src 'unsafe-inline' 'unsafe-eval' 'wasm-unsafe-eval' blob: data:; "
    "style-src 'unsafe-inline'; img-src data: blob:; font-src data:; worker-src blob: data:; "
    "connect-src blob: data:"
)
"""The page loads nothing from anywhere, wherever it is opened."""


def viser_page(assets_prefix: str, first: str = "") -> bytes:
    """Return the page as HTML; send it with `no-store`, for an old one cannot talk to a new server.

    Args:
        assets_prefix: Address below which `frontend_assets` and `CLIENT_PATH` are served, without a
            slash at the end.
        first: Markup for the beginning of the head.

    Raises:
        SceneError: Another version of viser is installed, or its page is not as we know it.
    """
    check_version()
    prefix = html.escape(assets_prefix)
    # First in the head, so that the script runs before viser's own.
    ours = (
        f'{first}<link rel="stylesheet" href="{prefix}/viser/studio3d.css">'
        f'<script src="{prefix}/viser/early.js"></script>'
        f'<script type="module" src="{prefix}/viser/studio3d.js"></script>'
    )
    before, after = _split().around
    page = f"{before}{prefix}/{CLIENT_PATH}{after}"
    return page.replace(_HEAD, _HEAD + ours).encode()


def viser_client() -> bytes:
    """Viser's styles and scripts as its page unpacks them: one zstd frame.

    Raises:
        SceneError: As for `viser_page`.
    """
    check_version()
    return _split().client


class _Split(NamedTuple):
    """viser's page in parts: its text around the address of the client, and the client."""

    around: tuple[str, str]
    client: bytes


@lru_cache(maxsize=1)
def _split() -> _Split:
    page = (Path(viser.__file__).parent / "client" / "build" / "index.html").read_text("utf-8")
    packed = _PACKED.search(page)
    if packed is None or page.count(_HEAD) != 1 or page.count(_UNPACKED) != 1:
        raise SceneError("viser's page is not as the 3D view knows it: install viser anew.")
    before, after = page[: packed.start()], page[packed.end() :]
    return _Split((before, after.replace(_UNPACKED, _FETCHED)), _bytes_of(packed[0].encode()))


def _bytes_of(letters: bytes) -> bytes:
    """Decode what viser wrote as letters."""
    digit_of = np.zeros(256, dtype=np.uint64)
    digit_of[np.frombuffer(_LETTERS, dtype=np.uint8)] = np.arange(len(_LETTERS))
    digits = digit_of[np.frombuffer(letters, dtype=np.uint8)]
    whole = len(digits) // _GROUP * _GROUP
    places = np.array([88**power for power in range(_GROUP - 1, -1, -1)], dtype=np.uint64)
    head = (digits[:whole].reshape(-1, _GROUP) @ places).astype(">u4").tobytes()
    rest = 0
    for digit in digits[whole:]:
        rest = rest * 88 + int(digit)
    return head + rest.to_bytes(max(0, len(digits) - whole - 1), "big")


def standalone_page(
    server: viser.ViserServer, title: str, centre_m: Vector3, size_m: float, *, dark: bool
) -> Callable[[], bytes]:
    """Record the scene as it is now; return a thread-safe function that makes the page.

    Args:
        server: The viser server of the scene.
        title: Of the page.
        centre_m: The point that the camera is directed at.
        size_m: Size of the robot.
        dark: Whether the ground is dark.
    """
    recording = server.get_scene_serializer()
    for message in _camera(centre_m, max(size_m, 0.05)):
        recording._insert_message(message)
    recording._insert_message(_messages.SceneNodeUpdateMessage(GRID, dict(_GRID[dark])))

    def make() -> bytes:
        page = recording.as_html(dark_mode=dark)
        head = page.find("<head>")
        if head < 0:
            raise SceneError("viser's page is not as the 3D view knows it: install viser anew.")
        own = (
            "<style>.mantine-Notifications-root { display: none; }</style>"
            f'<meta http-equiv="Content-Security-Policy" content="{_POLICY}">'
            f"<title>{html.escape(title)}</title>"
        )
        at = head + len("<head>")
        return (page[:at] + own + page[at:]).encode()

    return make


def _camera(centre_m: Vector3, size_m: float) -> list[_messages.Message]:
    away_m = [part * size_m * _DISTANCE for part in _TOWARDS_EYE]
    eye_m = (centre_m[0] + away_m[0], centre_m[1] + away_m[1], centre_m[2] + away_m[2])
    return [
        _messages.SetCameraFovMessage(_FIELD_OF_VIEW_RAD, initial=True),
        _messages.SetCameraUpDirectionMessage((0.0, 0.0, 1.0), initial=True),
        _messages.SetCameraLookAtMessage(centre_m, initial=True),
        _messages.SetCameraPositionMessage(eye_m, initial=True),
    ]
