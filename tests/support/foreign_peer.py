"""ForeignPeer: zenoh-ros2-sdk in a process of its own, driven from a test."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
from contextlib import contextmanager
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

REPOSITORY = Path(__file__).resolve().parents[2]


class ForeignPeer:
    """Tells the other process what to do, and keeps what it says."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        assert process.stdin
        assert process.stdout
        self._stdin = process.stdin
        self._said: list[dict[str, Any]] = []
        self._reader = threading.Thread(target=self._read, args=(process.stdout,), daemon=True)
        self._reader.start()
        self._await("ready")

    def tell(self, do: str, **arguments: object) -> None:
        """Have one thing done; it is done when this returns."""
        before = len(self._of("done"))
        self._stdin.write(json.dumps({"do": do, **arguments}) + "\n")
        self._stdin.flush()
        wait_until(f"{do} is done", lambda: len(self._of("done")) > before or self._failure())
        assert not self._of("failed")

    def heard(self, topic: str) -> list[str]:
        """The texts that came on a topic until now."""
        return [said["heard"] for said in list(self._said) if said.get("topic") == topic]

    def asked(self, do: str, answer: str, **arguments: object) -> Any:  # noqa: ANN401
        """Have one thing done, and give what it said of that name."""
        self.tell(do, **arguments)
        return self._of(answer)[-1]

    def _of(self, name: str) -> list[Any]:
        return [said[name] for said in list(self._said) if name in said]

    def _failure(self) -> bool:
        return bool(self._of("failed"))

    def _await(self, name: str) -> None:
        wait_until(f"the peer says {name}", lambda: bool(self._of(name)))

    def _read(self, lines: IO[str]) -> None:
        for line in lines:
            self._said.append(json.loads(line))


@contextmanager
def foreign_peer(endpoint: str, home: Path) -> Generator[ForeignPeer]:
    """Run the peer at a router; `home` is where it may keep files."""
    process = subprocess.Popen(
        [sys.executable, "-m", "tests.support.foreign_process", endpoint.rpartition(":")[2]],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        cwd=REPOSITORY,
        env=os.environ | {"HOME": str(home)},
    )
    with process:
        try:
            yield ForeignPeer(process)
        finally:
            process.kill()
