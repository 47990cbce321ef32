"""The headers that limit what our pages may do, and who may embed or read them."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterable

Headers = list[tuple[bytes, bytes]]

COMMON_HEADERS: Final[Headers] = [
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"same-origin"),
    (b"cross-origin-opener-policy", b"same-origin"),
    (b"cross-origin-resource-policy", b"same-origin"),
    (b"permissions-policy", b"camera=(), geolocation=(), microphone=(), payment=(), usb=()"),
]
NOTHING_POLICY: Final = "default-src 'none'; frame-ancestors 'self'; base-uri 'none'"
"""For answers that are no pages."""
PLAIN_PAGE_POLICY: Final = (
    "default-src 'none'; style-src 'unsafe-inline'; frame-ancestors 'self'; base-uri 'none'"
)
"""For our pages without scripts: not found, not allowed."""


WORKER_POLICY: Final = (
    "default-src 'none'; script-src 'self'; connect-src 'self'; frame-ancestors 'self'; "
    "base-uri 'none'"
)
"""For scripts of workers: it, and not the page's policy, limits what they fetch."""
_ORIGIN: Final = re.compile(r"https?://[A-Za-z0-9.-]+(:[0-9]+)?(?=[/?#]|$)")
"""Of an address; a policy cannot name one by its IPv6 address."""


def probe_policy(neighbours: Iterable[str]) -> str:
    """Return that of the worker which looks whether relays at these addresses are there.

    The page itself may not reach them. Without any it is `WORKER_POLICY`.
    """
    found = {origin[0]: None for one in neighbours if (origin := _ORIGIN.match(one))}
    return WORKER_POLICY.replace("connect-src 'self'", " ".join(("connect-src 'self'", *found)))


def page_policy(nonce: str) -> str:
    """Return the studio's page: its own files, and the one inline script that carries the nonce."""
    return "; ".join(
        (
            "default-src 'self'",
            f"script-src 'self' 'nonce-{nonce}'",
            "style-src 'self' 'unsafe-inline'",
            "img-src 'self' data: blob:",
            "worker-src 'self' blob:",
            "object-src 'none'",
            "base-uri 'self'",
            "form-action 'self'",
            "frame-ancestors 'self'",
        )
    )


SCENE_POLICY: Final = "; ".join(
    (
        "default-src 'self'",
        # viser's page unpacks itself: inline scripts, eval, wasm, workers from blobs.
        "script-src 'self' 'unsafe-inline' 'unsafe-eval' 'wasm-unsafe-eval' blob:",
        "style-src 'self' 'unsafe-inline'",
        "img-src 'self' data: blob:",
        "font-src 'self' data:",
        "worker-src 'self' blob:",
        # A Draco mesh would make viser fetch a decoder from a public host: not from here.
        "connect-src 'self' blob: data:",
        "object-src 'none'",
        "base-uri 'self'",
        "form-action 'none'",
        "frame-ancestors 'self'",
    )
)
