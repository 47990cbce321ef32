"""Which frames are shown: each by its switch, and those whose names a pattern lets through."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from studio.displays.name_pattern import PatternProperty, pattern_of
from studio.displays.properties import Property

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.displays.properties import Value
    from studio.displays.turning import Flags

FRAMES: Final = "Frames"
WHITELIST: Final = "Filter (whitelist)"
BLACKLIST: Final = "Filter (blacklist)"
FILTER_PROPERTIES: Final = (
    PatternProperty(
        WHITELIST, "text", "", "Only frames in whose names this pattern is found are shown."
    ),
    PatternProperty(
        BLACKLIST, "text", "", "Frames in whose names this pattern is found are not shown."
    ),
    Property(FRAMES, "switch", default=True, doc="Shows all frames, or none."),
)
_NAMES_KEPT_MAX: Final = 50_000


class FrameChoice:
    """Checks each name once, until a setting changes."""

    def __init__(self, values: Mapping[str, Value]) -> None:
        self._values = values
        self._passes: dict[str, bool] = {}
        self._last: tuple[tuple[str, ...], Flags] | None = None
        self.changed()

    def changed(self) -> None:
        """Start again after a change of the settings."""
        self._only = self._pattern(WHITELIST)
        self._without = self._pattern(BLACKLIST)
        self._passes.clear()
        self._last = None

    def of(self, names: tuple[str, ...]) -> Flags:
        """Return which of the names, (F,), are chosen."""
        if self._last is None or self._last[0] is not names:
            if len(self._passes) > _NAMES_KEPT_MAX:
                self._passes.clear()
            self._last = names, np.array([self._is_chosen(name) for name in names], np.bool_)
        return self._last[1]

    def _is_chosen(self, name: str) -> bool:
        passes = self._passes.get(name)
        if passes is None:
            passes = self._passes[name] = self._is_checked(name) and self._is_let_through(name)
        return passes

    def _is_checked(self, name: str) -> bool:
        return bool(self._values.get(f"{FRAMES}/{name}", self._values[FRAMES]))

    def _is_let_through(self, name: str) -> bool:
        if self._only is not None and not self._only.is_in(name):
            return False
        return self._without is None or not self._without.is_in(name)

    def _pattern(self, name: str):  # noqa: ANN202 - as pattern_of gives it, or None
        text = str(self._values[name])
        return pattern_of(name, text) if text else None
