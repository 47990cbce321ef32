"""A relay that is measured: what it takes, and what it counts itself."""

from __future__ import annotations

import os
import re
import sys
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import httpx2

from tests.benchmarks.relays_places import inside
from tests.support.demos import RunningDemo
from tests.support.relay import RunningRelay
from tests.support.relays import free_port

if TYPE_CHECKING:
    from collections.abc import Generator

    from tests.benchmarks.relays_places import Place


class LineBytes(NamedTuple):
    """Bytes of messages between studios and a relay so far."""

    down: int
    """To the relay."""
    up: int


class MeasuredRelay:
    """A relay in a process of its own."""

    def __init__(self, running: RunningRelay, place: Place) -> None:
        self._running, self.place = running, place
        self.line, self.address = running.line, running.address
        self._client = httpx2.Client(
            headers={"authorization": f"Bearer {running.key}"}, trust_env=False, verify=False
        )

    @property
    def pid(self) -> int:
        """Its process id."""
        return self._running.process.process.pid

    def line_bytes(self) -> LineBytes:
        """As it counts them itself."""
        text = self._client.get(f"{self.address}metrics").raise_for_status().text

        def total(name: str) -> int:
            found = re.findall(rf"^studio_relay_{name}_bytes_total\{{.*\}} (\S+)", text, re.M)
            return int(sum(map(float, found)))

        return LineBytes(total("received"), total("sent"))

    def close(self) -> None:
        """Ask no more."""
        self._client.close()


@contextmanager
def measured_relay(place: Place, folder: Path) -> Generator[MeasuredRelay]:
    """Run a relay at a place until the block ends."""
    with inside(place.path):
        words = [sys.executable, "-m", "studio", "relay", "--data-dir", str(folder)]
        words += ["--listen", f"tls/{place.host}:{free_port()}"]
        words += ["--host", place.host, "--port", str(free_port())]
        process = RunningDemo(words, dict(os.environ), warm=False)
    try:
        relay = MeasuredRelay(RunningRelay(process), place)
        yield relay
        relay.close()
    finally:
        process.close()


def rss_bytes_of(pid: int) -> int:
    """Memory that a process has in RAM (Linux)."""
    pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")
