"""What both ends of a line have of Zenoh: its keys, and the limits of a session."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Final

from studio.ros.wire.zenoh import insert

if TYPE_CHECKING:
    from studio.ros.wire.zenoh import Config

CLAIM_KEY: Final = "studio-relay/claim"
LEASE_MS: Final = 5_000
"""A relay or an origin that is silent for so long is gone: a cut cable tells nobody."""
SAMPLES_MAX: Final = 4_096
"""Of a line that are not read yet; of more the oldest are lost, which ends the line."""
PIECES_BYTES_MAX: Final = 128 << 10
"""Of what either side takes of the other at once; a piece of a message is half as large."""


def line_keys(line: str) -> tuple[str, str, str]:
    """Return the keys of a line's two streams, to the origin and to the relay, and of its token.

    Others who have the relay's key may read the first: it does not tell them the name of the line,
    by which they could send something to the second, or end the token.
    """
    shown = hashlib.blake2b(line.encode(), digest_size=8).hexdigest()
    return f"studio-relay/{shown}/up", f"studio-relay/{line}/down", f"studio-relay/{line}/alive"


def key_digest(key: str) -> bytes:
    """Return what names a relay's key to those who have it."""
    return hashlib.blake2b(key.encode(), digest_size=16, person=b"relay of a claim").digest()


def set_limits(config: Config) -> None:
    """Set what a studio and a relay take of each other, and how long they wait."""
    insert(config, "scouting/multicast/enabled", "false")
    insert(config, "transport/link/tx/lease", str(LEASE_MS))
    insert(config, "transport/link/rx/max_message_size", str(PIECES_BYTES_MAX))
