"""GuardCondition: work that any thread may set off."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.ros.node.work import Work

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.node.work import CallbackGroup


class GuardCondition(Work):
    """Calls back once after it was triggered, however often that was."""

    def __init__(self, callback: Callable[[], object], group: CallbackGroup) -> None:
        super().__init__(group)
        self.callback = callback
        self._triggered = False

    @property
    def is_ready(self) -> bool:
        """Whether it was triggered."""
        return self._triggered

    def trigger(self) -> None:
        """Set it off; from any thread."""
        self._triggered = True
        self.announce()

    def take(self) -> Callable[[], object] | None:
        """Give the callback, once for all triggers."""
        triggered, self._triggered = self._triggered, False
        return self.callback if triggered else None
