"""The rates of several topics, as `ros2 topic hz` prints them: a row for each."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.cli.topic.measuring import Rate

_HEAD = ("topic", "rate", "min_delta", "max_delta", "stddev", "window")
_GAP = "   "


def rate_table(rates: Iterable[tuple[str, Rate]]) -> str | None:
    """Write the topics that have a rate; None where none has."""
    rows = [(topic, *cells) for topic, rate in rates if (cells := _cells(rate)) is not None]
    if not rows:
        return None
    widths = [max(map(len, column)) for column in zip(_HEAD, *rows, strict=True)]
    head = _GAP.join(name.center(width) for name, width in zip(_HEAD, widths, strict=True))
    lines = [_GAP.join(map(str.ljust, row, widths)) for row in rows]
    return "\n".join([head, "=" * len(head), *lines, ""])


def _cells(rate: Rate) -> tuple[str, ...] | None:
    hertz = rate.hertz
    if hertz is None:
        return None
    gaps = rate.gaps()
    spread = (f"{gaps.lowest:.3f}", f"{gaps.highest:.3f}", f"{gaps.deviation:.5f}")
    return (f"{hertz:.3f}", *spread, str(gaps.count + 1))
