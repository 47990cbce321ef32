"""The 3D view: viser in our process, drawings to viser nodes; the only room that imports viser."""

from studio.scene.connection import SUBPROTOCOL, VIEWER_MESSAGES, Connection
from studio.scene.displays import DISPLAY_DEFAULTS
from studio.scene.document_scene import DocumentScene
from studio.scene.page import CLIENT_PATH, viser_client, viser_page

__all__ = [
    "CLIENT_PATH",
    "DISPLAY_DEFAULTS",
    "SUBPROTOCOL",
    "VIEWER_MESSAGES",
    "Connection",
    "DocumentScene",
    "viser_client",
    "viser_page",
]
