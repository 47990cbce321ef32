"""The 3D lane: viser's own websocket, one per document."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.scene import SUBPROTOCOL
from studio.server.access import may
from studio.server.lane import Lane

if TYPE_CHECKING:
    from collections.abc import Callable

    from starlette.websockets import WebSocket

    from studio.protocol.roles import Role
    from studio.server.surface import OpenScene


def allowed_messages(role: Role) -> Callable[[str], bool]:
    """Which of viser's messages this role may send."""

    def allowed(message_type: str) -> bool:
        return may(role, f"viser:{message_type}")

    return allowed


async def serve_scene(websocket: WebSocket, scene: OpenScene, role: Role) -> None:
    """Speak viser's protocol until the browser leaves or the document is closed."""
    offered: list[str] = websocket.scope["subprotocols"]
    # A page of another version is let in all the same: only so does it hear why it must leave.
    spoken = SUBPROTOCOL if SUBPROTOCOL in offered else next(iter(offered), None)
    await websocket.accept(subprotocol=spoken)
    lane = Lane(websocket)
    await scene.serve(lane, allowed_messages(role), spoken)
    await lane.finish()
