"""Checks of what links touch with against what they look like."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np

from studio.problems import Severity
from studio.robot.checks.extents import is_marker
from studio.robot.checks.finding import Finding

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from numpy.typing import NDArray

    from studio.robot.checks.extents import Extent
    from studio.robot.values import Robot

    Floats: TypeAlias = NDArray[np.float64]

_TIMES: Final = 3.0
"""How much larger one diagonal may be than the other."""
_SLACK_M: Final = 0.002


def shape_findings(robot: Robot, extents: Mapping[str, Extent]) -> Iterator[Finding]:
    """Links whose collision lies elsewhere than the visual, or is of another size."""
    for name in robot.links:
        extent = extents[name]
        if extent.visual is None or extent.collision is None or is_marker(extent.visual):
            continue
        what = _difference(extent.visual, extent.collision)
        if what:
            code, sentence = what
            sentence = f'The <collision> of link "{name}" {sentence}'
            yield Finding(Severity.WARNING, code, sentence, f"link:{name}")


def _difference(
    visual: tuple[Floats, Floats], collision: tuple[Floats, Floats]
) -> tuple[str, str] | None:
    """Code and the end of a sentence; None when the boxes are alike."""
    gap = np.maximum(visual[0] - collision[1], collision[0] - visual[1])
    if (gap > _SLACK_M).any():
        apart_m = float(np.linalg.norm(np.maximum(gap, 0)))
        return (
            "collision-apart",
            f"lies {apart_m:.3g} m beside its <visual>: check the <origin> of both.",
        )
    seen_m, touched_m = (float(np.linalg.norm(high - low)) for low, high in (visual, collision))
    larger, smaller = max(seen_m, touched_m), min(seen_m, touched_m)
    if larger <= _TIMES * smaller + _SLACK_M:
        return None
    how = "larger" if touched_m > seen_m else "smaller"
    times = f"{larger / smaller:.3g} times" if smaller else "much"
    return "collision-size", f"is {times} {how} than its <visual>: check the size or the scale."
