"""The way of the joints from where they are to a pose: smooth, and ended by whatever moves them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.documents.posing.animation import Animation

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping


class Glide:
    """Calls `move` with positions between two poses, once per tick, and at last with the second."""

    def __init__(self, move: Callable[[Mapping[str, float]], None]) -> None:
        self._move = move
        self._animation = Animation(self._step)
        self._from: dict[str, float] = {}
        self._to: dict[str, float] = {}
        self._duration_s = 0.0

    @property
    def running(self) -> bool:
        """Whether the joints are on their way."""
        return self._animation.running

    def start(
        self, begin: Mapping[str, float], end: Mapping[str, float], duration_s: float
    ) -> None:
        """Begin; joints that are not in `begin` are not moved. `duration_s` 0 moves at once."""
        self.stop()
        self._from = {name: begin[name] for name in end if name in begin}
        self._to, self._duration_s = dict(end), duration_s
        if duration_s > 0:
            self._animation.start()
        else:
            self._step(0.0)

    def stop(self) -> None:
        """End where the joints are."""
        self._animation.stop()

    def _step(self, time_s: float) -> None:
        share = min(1.0, time_s / self._duration_s) if self._duration_s > 0 else 1.0
        eased = share * share * (3 - 2 * share)
        if share >= 1:
            self.stop()
        self._move(
            {
                name: self._to[name] if share >= 1 else begin + eased * (self._to[name] - begin)
                for name, begin in self._from.items()
            }
        )
