"""Where others find a shared studio."""

from __future__ import annotations

from dataclasses import dataclass

from studio.settings import DEFAULT_HOST


@dataclass(frozen=True, slots=True)
class Reach:
    """Where others find the studio.

    Attributes:
        addresses: Of its page, without any token, the best to show first.
        only_here: No other machine reaches it.
        fingerprint: SHA-256 of a certificate that the studio made itself.
        why_not: Why it may not be shared, in a sentence; empty: it may.
        listen: The address of this machine that it listens at.
        host: The address by which others find this machine; empty: `listen`.
    """

    addresses: tuple[str, ...] = ()
    only_here: bool = True
    fingerprint: str = ""
    why_not: str = ""
    listen: str = DEFAULT_HOST
    host: str = ""
