"""A Hub: all outlets of one stream; a message is encoded once and the same bytes go to all."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.hub.outlet import Outlet


class Hub:
    """Publishes to every outlet; a slow one holds its own back and nobody else's."""

    def __init__(self) -> None:
        self._outlets: dict[Outlet, None] = {}

    def __len__(self) -> int:
        return len(self._outlets)

    def __iter__(self) -> Iterator[Outlet]:
        return iter(tuple(self._outlets))

    def add(self, outlet: Outlet) -> None:
        """Let it hear what is published from now on."""
        self._outlets[outlet] = None

    def discard(self, outlet: Outlet) -> None:
        """Forget it and what it holds back; it need not be there."""
        if outlet in self._outlets:
            del self._outlets[outlet]
            outlet.close()

    def publish(self, data: bytes, key: str | None = None) -> None:
        """Send one whole message to all; of one `key` a slow outlet keeps only the newest."""
        for outlet in self:
            outlet.post(data, key)

    def resume(self) -> bool:
        """Let every outlet write what it held back; True when none holds anything back."""
        left = [outlet for outlet in self if not outlet.resume()]
        return not left

    def close(self) -> None:
        """Forget all outlets."""
        for outlet in self:
            self.discard(outlet)
