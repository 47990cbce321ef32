"""Interactive markers: a server, its menus and a client, by the names of `interactive_markers`."""

from studio.ros.interactive_markers.client import (
    ClientState,
    ClientStatus,
    InteractiveMarkerClient,
)
from studio.ros.interactive_markers.menu_handler import MenuHandler
from studio.ros.interactive_markers.server import InteractiveMarkerServer
from studio.ros.interactive_markers.tools import auto_complete, make_title

__all__ = [
    "ClientState",
    "ClientStatus",
    "InteractiveMarkerClient",
    "InteractiveMarkerServer",
    "MenuHandler",
    "auto_complete",
    "make_title",
]
