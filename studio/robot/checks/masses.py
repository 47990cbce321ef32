"""Checks of masses and moments of inertia by themselves: what no body can have."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np

from studio.problems import Severity
from studio.robot.checks.finding import Finding, RemoveChild
from studio.robot.checks.solids import inertia_mend

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from numpy.typing import NDArray

    from studio.robot.checks.extents import Extent
    from studio.robot.values import Inertial, Link, Robot

    Floats: TypeAlias = NDArray[np.float64]

_TOLERANCE: Final = 1e-6
"""Of the largest moment: rounding in the file is no fault."""
_WHY: Final = {
    "bad-inertia": "all must be above zero",
    "inertia-triangle": "in a real body none exceeds the sum of the two others",
}


def mass_findings(robot: Robot, extents: Mapping[str, Extent]) -> Iterator[Finding]:
    """Masses not above zero, tensors not positive definite, and the triangle rule broken.

    The triangle rule: no principal moment exceeds the sum of the two others.
    """
    heavy: list[tuple[Link, Inertial]] = []
    for link in robot.links.values():
        if link.inertial is None:
            continue
        if link.inertial.mass_kg > 0:
            heavy.append((link, link.inertial))
        else:
            yield _bad_mass(link, link.inertial)
    if heavy:
        moments = np.linalg.eigvalsh(tensors([inertial for _, inertial in heavy]))
        for (link, _), found in zip(heavy, moments, strict=True):
            if finding := _moments_finding(link, found, extents[link.name]):
                yield finding


def tensors(inertials: list[Inertial]) -> Floats:
    """Inertia tensors (N, 3, 3), kg m², in the axes of each origin."""
    rows = [(i.ixx, i.ixy, i.ixz, i.ixy, i.iyy, i.iyz, i.ixz, i.iyz, i.izz) for i in inertials]
    return np.array(rows).reshape(-1, 3, 3)


def moments_fault(moments: Floats) -> str:
    """Why no body has these principal moments (3,), ascending; empty when one may."""
    least, middle, most = moments.tolist()
    slack = _TOLERANCE * max(abs(least), abs(most))
    if least <= slack:
        return "bad-inertia"
    return "inertia-triangle" if most > least + middle + slack else ""


def _bad_mass(link: Link, inertial: Inertial) -> Finding:
    is_frame = inertial.mass_kg == 0 and not (link.visuals or link.collisions)
    todo = (
        "leave the <inertial> out of a link that is only a frame"
        if is_frame
        else "write what it weighs"
    )
    sentence = f'Link "{link.name}" has a mass of {inertial.mass_kg:g} kg: {todo}.'
    mend = RemoveChild("Remove the <inertial>", "inertial") if is_frame else None
    return Finding(Severity.WARNING, "bad-mass", sentence, f"link:{link.name}", mend)


def _moments_finding(link: Link, moments: Floats, extent: Extent) -> Finding | None:
    """What is wrong with principal moments (3,), kg m², ascending."""
    if not (fault := moments_fault(moments)):
        return None
    why = _WHY[fault]
    shown = ", ".join(f"{moment:.4g}" for moment in moments.tolist())
    sentence = f'Link "{link.name}" has principal moments of inertia of {shown} kg m²: {why}.'
    key, mend = f"link:{link.name}", inertia_mend(link, extent)
    return Finding(Severity.WARNING, fault, sentence, key, mend)
