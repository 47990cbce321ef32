"""The 3D view as one page of its own: viser's page with the scene in it, and no server behind."""

# viser's insides are met here, in host.py and in wire.py only.
# pyright: reportPrivateUsage=false
from __future__ import annotations

import html
import math
from typing import TYPE_CHECKING, Final

from viser import _messages

from studio.errors import SceneError
from studio.scene.naming import GRID

if TYPE_CHECKING:
    from collections.abc import Callable

    import viser

    from studio.robot.values import Vector3

_TOWARDS_EYE: Final = (1.0, -0.8, 0.62)
"""From what is looked at, as the view begins in the studio."""
_DISTANCE: Final = 0.95
"""Of the eye, in sizes of the robot."""
_FIELD_OF_VIEW_RAD: Final = math.radians(42)
_GRID: Final = {
    True: {"cell_color": (66, 75, 91), "section_color": (88, 100, 120)},
    False: {"cell_color": (150, 160, 178), "section_color": (122, 135, 158)},
}
"""By whether the ground is dark, as the studio paints it."""
_POLICY: Final = (
    "default-src 'none'; script-src 'unsafe-inline' 'unsafe-eval' 'wasm-unsafe-eval' blob: data:; "
    "style-src 'unsafe-inline'; img-src data: blob:; font-src data:; worker-src blob: data:; "
    "connect-src blob: data:"
)
"""The page asks nobody for anything, wherever it is opened."""


def standalone_page(
    server: viser.ViserServer, title: str, centre_m: Vector3, size_m: float, *, dark: bool
) -> Callable[[], bytes]:
    """Take the scene as it is now; what is returned makes the page, in any thread.

    Args:
        server: Whose scene it is.
        title: Of the page.
        centre_m: What the camera looks at.
        size_m: How large that is.
        dark: Whether on a dark ground.
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
