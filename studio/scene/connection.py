"""The Connection that web hands to the scene, and viser's version, which both must agree on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable

VISER_VERSION = "1.1.1"
"""The one version whose insides this room knows."""
SUBPROTOCOL = f"viser-v{VISER_VERSION}"
"""Websocket subprotocol that viser's page offers; accept with it, or refuse the socket."""

VIEWER_MESSAGES = frozenset({"ViewerCameraMessage"})
"""What a page that only looks has to say to viser."""
NEVER_ALLOWED = frozenset({"ShareUrlRequest", "ShareUrlDisconnect"})
"""Opens a public tunnel on a foreign server: refused whatever the role."""


class Connection(Protocol):
    """One accepted websocket of viser's page; messages are binary."""

    async def receive(self) -> bytes | None:
        """The next message, or None when the socket is closed."""
        ...

    def write(self, data: bytes, /) -> None:
        """Send one message without waiting."""
        ...

    def pending_bytes(self) -> int:
        """Bytes written and not yet handed to the system."""
        ...

    def on_drain(self, resume: Callable[[], object], /) -> None:
        """Call `resume` on the loop's thread whenever a full buffer has emptied."""
        ...

    def close(self, code: int, /) -> None:
        """Close the socket; `receive` then answers None."""
        ...
