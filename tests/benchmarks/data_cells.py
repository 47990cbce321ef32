"""The cells of the data lane's benchmark: what is published, how many hear it, what was asked."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

BUSY: Final = 0.9
"""Of a core: browsers that take more measure themselves."""
SLOW_BYTES_PER_S: Final = 2_000_000


@dataclass(frozen=True)
class Cell:
    """What is published, how it is heard, and what part of foxglove-sdk's that may take."""

    name: str
    size: int
    """Bytes of a message."""
    rate_hz: int
    """Of each topic."""
    browsers: int
    topics: int = 1
    processes: int = 1
    """Over which the browsers are spread evenly."""
    subscription: dict[str, object] = field(default_factory=lambda: {"mode": "every"})
    """How a browser of the studio hears."""
    cpu_at_most: float = 0.0
    """Of the other's; 0: it is not asked for."""
    p50_at_most: float = 0.0
    """Of foxglove-sdk's; 0: it is not asked for."""
    over_empty: bool = False
    """Whether it is held against a callback that does nothing, too."""
    for_naive: bool = True
    """Whether a plain FastAPI loop is asked, too; of many browsers it loses most."""

    @property
    def left_out(self) -> frozenset[str]:
        """Servers that are not asked."""
        asked = {"empty": self.over_empty, "naive": self.for_naive}
        return frozenset(name for name, is_asked in asked.items() if not is_asked)

    def __str__(self) -> str:
        """As it is named in the table."""
        return self.name


_NEWEST: Final[dict[str, object]] = {"mode": "newest", "most_hz": 60}
_AT_ONCE: Final[dict[str, object]] = {"mode": "every", "pace": "at_once"}

CELLS: Final = (
    Cell("500 B at 1 kHz x 10", 500, 1_000, 10, cpu_at_most=0.6),
    Cell("500 B at 1 kHz x 30", 500, 1_000, 30, processes=2, cpu_at_most=0.6),
    Cell("4 topics of 5 KB at 50 Hz x 50", 5_000, 50, 50, topics=4, cpu_at_most=0.85),
    Cell("500 B at 1 kHz x 10, at once", 500, 1_000, 10, subscription=_AT_ONCE, p50_at_most=0.3),
    Cell("5 KB at 50 Hz x 10, at once", 5_000, 50, 10, 4, subscription=_AT_ONCE, p50_at_most=0.3),
    Cell(
        "4.8 MB at 10 Hz x 10",
        4_800_000,
        10,
        10,
        processes=2,
        subscription=_NEWEST,
        cpu_at_most=0.42,
    ),
    Cell(
        "6.2 MB at 30 Hz x 10",
        6_200_000,
        30,
        10,
        processes=5,
        subscription=_NEWEST,
        cpu_at_most=0.42,
    ),
    Cell("500 B at 1 kHz x 200", 500, 1_000, 200, processes=4, cpu_at_most=0.3, for_naive=False),
    Cell("500 B at 5 kHz x 10", 500, 5_000, 10, processes=2, cpu_at_most=0.3, over_empty=True),
)
SLOW: Final = Cell(
    "6.2 MB at 30 Hz, 1 of 10 slow", 6_200_000, 30, 10, processes=3, subscription=_NEWEST
)
