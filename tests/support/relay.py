"""`studio relay` in a process of its own."""

from __future__ import annotations

import os
import re
import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING

from tests.support.demos import RunningDemo
from tests.support.warm_python import STUDIO

if TYPE_CHECKING:
    from collections.abc import Generator, Sequence
    from pathlib import Path


class RunningRelay:
    """A relay that has printed its line and its address."""

    def __init__(self, process: RunningDemo) -> None:
        self.process = process
        process.wait_for("--via")
        self.line = self._found(r"Relay: (tls/\S+)")
        """For `--via`."""
        self.key = self.line.partition("#")[2]
        self.address = self._found(r"People join at (\S+)")

    def _found(self, pattern: str) -> str:
        found = re.search(pattern, self.process.printed)
        assert found, self.process.printed
        return found[1]


@contextmanager
def running_relay(words: Sequence[str], data_folder: Path) -> Generator[RunningRelay]:
    """Run a relay with these options until the block ends."""
    line = [sys.executable, "-m", "studio", "relay", *words, "--data-dir", str(data_folder)]
    process = RunningDemo(line, dict(os.environ), imported=STUDIO)
    try:
        yield RunningRelay(process)
    finally:
        process.close()
