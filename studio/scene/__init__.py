"""The 3D view: viser in our process, drawings to viser nodes; the only room that imports viser."""

from studio.scene.document_scene import DISPLAY_DEFAULTS, DocumentScene
from studio.scene.host import VIEWER_MESSAGES
from studio.scene.pages import CLIENT_PATH, viser_client, viser_page
from studio.scene.relayed import RelayedScene
from studio.scene.seats import SUBPROTOCOL, Connection

__all__ = [
    "CLIENT_PATH",
    "DISPLAY_DEFAULTS",
    "SUBPROTOCOL",
    "VIEWER_MESSAGES",
    "Connection",
    "DocumentScene",
    "RelayedScene",
    "viser_client",
    "viser_page",
]
