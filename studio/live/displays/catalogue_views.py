"""The kinds of displays as the page receives them."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING

from studio.live.displays.plugin_display import PluginDisplay
from studio.protocol.displays import DisplayKindView, PropertyView

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.displays.display import Display
    from studio.displays.properties import Property


def kind_views(kinds: Iterable[type[Display]]) -> tuple[DisplayKindView, ...]:
    """Return these kinds, sorted by name."""
    by_name = sorted(kinds, key=lambda one: one.KIND.rpartition("/")[2].lower())
    return tuple(map(_kind_view, by_name))


def property_view(one: Property) -> PropertyView:
    """Return one property and its settings."""
    when, when_values = one.when or ("", ())
    return PropertyView(
        name=one.name,
        kind=one.kind,
        default=one.default,
        doc=one.doc,
        low=one.low if math.isfinite(one.low) else None,
        high=one.high if math.isfinite(one.high) else None,
        unit=one.unit,
        choices=one.choices,
        when=when,
        when_values=when_values,
    )


@lru_cache(maxsize=200)
def _kind_view(kind: type[Display]) -> DisplayKindView:
    return DisplayKindView(
        kind=kind.KIND,
        doc=kind.DOC,
        icon=kind.ICON,
        types=kind.TOPICS[0].types if kind.TOPICS else (),
        plugin=kind.FILE.path.name if issubclass(kind, PluginDisplay) else "",
        properties=tuple(map(property_view, kind.PROPERTIES)),
    )
