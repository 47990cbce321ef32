"""The 3D lane: viser's own websocket, one per document."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.scene.connection import SUBPROTOCOL
from studio.web.access import may
from studio.web.lane import Lane

if TYPE_CHECKING:
    from collections.abc import Callable

    from starlette.websockets import WebSocket

    from studio.engine.roles import Role
    from studio.web.surface import OpenScene

_WRONG_VERSION: Final = 1002
"""The close code with which viser's own server answers a page of another version."""


def allowed_messages(role: Role) -> Callable[[str], bool]:
    """Which of viser's messages this role may send."""

    def allowed(message_type: str) -> bool:
        return may(role, f"viser:{message_type}")

    return allowed


async def serve_scene(websocket: WebSocket, scene: OpenScene, role: Role) -> None:
    """Speak viser's protocol until the browser leaves; a page of another version is sent away."""
    offered: list[str] = websocket.scope["subprotocols"]
    if SUBPROTOCOL not in offered:
        await websocket.accept(subprotocol=offered[0] if offered else None)
        await websocket.close(_WRONG_VERSION, "Reload the page: the studio was updated.")
        return
    await websocket.accept(subprotocol=SUBPROTOCOL)
    await scene.serve(Lane(websocket), allowed_messages(role))
