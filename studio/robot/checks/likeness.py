"""Checks of a mass and its inertia against the shape of the link that has them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np

from studio.problems import Severity
from studio.robot.checks.extents import is_marker
from studio.robot.checks.finding import Finding
from studio.robot.checks.masses import moments_fault, tensors
from studio.robot.checks.solids import inertia_mend

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from numpy.typing import NDArray

    from studio.robot.checks.extents import Extent
    from studio.robot.values import Inertial, Link, Robot

    Floats: TypeAlias = NDArray[np.float64]

_DENSEST_KG_M3: Final = 20_000.0
"""Gold has 19,300; steel 7,850."""
_LIGHTEST_KG_M3: Final = 5.0
"""Of the box around a link, most of which may be air; of the corpus the lightest has 19."""
_THINNEST_M: Final = 0.005
"""A sheet or a line as a picture of something is taken to be that thick."""
_TOO_WIDE: Final = 1.5
"""Times the moment of the whole mass in the farthest corner, which nothing exceeds."""
_TOO_NARROW: Final = 0.01
"""Of the moment of a solid box of that size: a tenth of its size."""


def likeness_findings(robot: Robot, extents: Mapping[str, Extent]) -> Iterator[Finding]:
    """Links much denser or lighter than matter, or that turn like something of another size.

    What only marks a frame says nothing of the body that is meant.
    """
    known: list[tuple[Link, Inertial, Floats, Floats]] = []
    for link in robot.links.values():
        extent = extents[link.name]
        if link.inertial is None or link.inertial.mass_kg <= 0:
            continue
        if (box := extent.whole) is not None and not is_marker(box):
            known.append((link, link.inertial, *box))
    if not known:
        return
    moments = np.linalg.eigvalsh(tensors([inertial for _, inertial, _, _ in known]))
    for (link, inertial, low, high), own in zip(known, moments, strict=True):
        if finding := _density_finding(link, inertial, high - low):
            yield finding
        elif not moments_fault(own) and (how := _misfit(inertial, float(own[2]), low, high)):
            yield _inertia_finding(link, high - low, how, extents[link.name])


def _density_finding(link: Link, inertial: Inertial, sides_m: Floats) -> Finding | None:
    density = inertial.mass_kg / float(np.prod(np.maximum(sides_m, _THINNEST_M)))
    if _LIGHTEST_KG_M3 <= density <= _DENSEST_KG_M3:
        return None
    is_heavy = density > _DENSEST_KG_M3
    what = "heavier than any metal" if is_heavy else "lighter than foam"
    sentence = (
        f'Link "{link.name}" weighs {inertial.mass_kg:.4g} kg in a box of {_shown(sides_m)}, which '
        f"is {what} ({density:.2g} kg/m³): check the mass (kg) and the size (m)."
    )
    severity = Severity.WARNING if is_heavy else Severity.INFO
    return Finding(severity, "density", sentence, f"link:{link.name}")


def _misfit(inertial: Inertial, most: float, low: Floats, high: Floats) -> str:
    """Whether the greatest moment is more or less than fits the box; empty when it fits."""
    sides = np.maximum(high - low, _THINNEST_M)
    centre = np.array(inertial.origin.xyz)
    farthest = np.maximum(np.abs(low - centre), np.abs(high - centre))
    farthest = np.maximum(farthest, _THINNEST_M)
    if most > _TOO_WIDE * inertial.mass_kg * float(farthest @ farthest):
        return "more"
    squares = np.sort(sides**2)
    solid = inertial.mass_kg * float(squares[1] + squares[2]) / 12
    return "less" if most < _TOO_NARROW * solid else ""


def _inertia_finding(link: Link, sides_m: Floats, how: str, extent: Extent) -> Finding:
    if how == "more":
        why = f"more than its mass can have anywhere in a box of {_shown(sides_m)}"
    else:
        why = f"less than a hundredth of that of a solid box of {_shown(sides_m)}"
    sentence = (
        f'Link "{link.name}" has moments of inertia that are {why}: check them (kg m²), the mass '
        "(kg) and the size (m)."
    )
    mend = inertia_mend(link, extent)
    return Finding(Severity.INFO, "inertia-size", sentence, f"link:{link.name}", mend)


def _shown(sides_m: Floats) -> str:
    return " x ".join(f"{side:.3g}" for side in sides_m.tolist()) + " m"
