"""The kinds of displays as the page receives them."""

from __future__ import annotations

import math
from functools import cache
from typing import TYPE_CHECKING

from studio.displays.catalogue import DISPLAYS
from studio.protocol.displays import DisplayKindView, PropertyView

if TYPE_CHECKING:
    from studio.displays.display import Display
    from studio.displays.properties import Property


@cache
def kind_views() -> tuple[DisplayKindView, ...]:
    """Return all kinds, sorted by name."""
    return tuple(_kind_view(one) for one in sorted(DISPLAYS, key=lambda one: one.KIND.lower()))


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


def _kind_view(kind: type[Display]) -> DisplayKindView:
    return DisplayKindView(
        kind=kind.KIND,
        doc=kind.DOC,
        icon=kind.ICON,
        types=kind.TOPICS[0].types if kind.TOPICS else (),
        properties=tuple(map(property_view, kind.PROPERTIES)),
    )
