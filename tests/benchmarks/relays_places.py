"""Where relays run: each in a network namespace of its own, or all on loopback.

A namespace has one line to the rest of this machine (a veth pair), so that what goes over it is
what studio and relay say to each other: who looks at a robot there does so within the namespace.
"""

from __future__ import annotations

import os
import subprocess
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from tests.benchmarks import line_link
from tests.benchmarks.report import say

if TYPE_CHECKING:
    from collections.abc import Generator
    from contextlib import AbstractContextManager

_NETWORK: Final = "198.18.0"
"""From the addresses that are kept for benchmarks (RFC 2544); four for each place."""
_NAMESPACES: Final = Path("/run/netns")


@dataclass(frozen=True)
class Place:
    """One relay's."""

    host: str
    namespace: str = ""
    """Empty: loopback."""

    @property
    def path(self) -> str:
        """File of the namespace; empty on loopback."""
        return str(_NAMESPACES / self.namespace) if self.namespace else ""

    def line_bytes(self) -> int:
        """Bytes that went from here to the relay, with all heads of TCP and below; 0: unknown."""
        counter = f"/sys/class/net/{self.namespace}/statistics/tx_bytes"
        return int(Path(counter).read_text()) if self.namespace else 0


def inside(path: str) -> AbstractContextManager[None]:
    """Be in the namespace of this file within the block: this thread, and what it starts."""
    return _inside(path) if path else nullcontext()


@contextmanager
def _inside(path: str) -> Generator[None]:
    namespace = os.open(path, os.O_RDONLY)
    try:
        with line_link.within(namespace):
            yield
    finally:
        os.close(namespace)


@contextmanager
def places(count: int) -> Generator[list[Place]]:
    """So many places; on loopback, which is said, where the system lets us make no namespaces."""
    made: list[Place] = []
    try:
        try:
            for number in range(count):
                made.append(Place(f"{_NETWORK}.{4 * number + 2}", f"sr{number}-{os.getpid()}"))
                _make(made[-1], f"{_NETWORK}.{4 * number + 1}")
        except (OSError, subprocess.CalledProcessError):
            say("  no network namespaces here: the relays are on loopback")
            yield [Place("127.0.0.1")] * count
        else:
            yield made
    finally:
        for place in made:  # the pair of devices ends with it
            with suppress(OSError):
                _ip("netns", "del", place.namespace, check=False)


def _make(place: Place, near: str) -> None:
    name, far = place.namespace, "relay"
    _ip("netns", "add", name)
    _ip("link", "add", name, "type", "veth", "peer", "name", far, "netns", name)
    _ip("addr", "add", f"{near}/30", "dev", name)
    _ip("link", "set", name, "up")
    _ip("-n", name, "addr", "add", f"{place.host}/30", "dev", far)
    _ip("-n", name, "link", "set", far, "up")
    _ip("-n", name, "link", "set", "lo", "up")


def _ip(*words: str, check: bool = True) -> None:
    subprocess.run(["ip", *words], check=check, capture_output=True)
