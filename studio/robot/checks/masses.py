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

TOLERANCE: Final = 1e-6
"""Of the largest moment: rounding in the file is no fault."""


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


def _bad_mass(link: Link, inertial: Inertial) -> Finding:
    mend = None
    todo = "write what it weighs"
    if inertial.mass_kg == 0:
        mend = RemoveChild("Remove the <inertial>", "inertial")
        todo = "write what it weighs, or leave the <inertial> out of a link that is only a frame"
    sentence = f'Link "{link.name}" has a mass of {inertial.mass_kg:g} kg: {todo}.'
    return Finding(Severity.WARNING, "bad-mass", sentence, f"link:{link.name}", mend)


def _moments_finding(link: Link, moments: Floats, extent: Extent) -> Finding | None:
    """What is wrong with principal moments (3,), kg m², ascending."""
    least, middle, most = moments.tolist()
    slack = TOLERANCE * max(abs(least), abs(most))
    if least <= slack:
        code, why = "bad-inertia", "all must be above zero"
    elif most > least + middle + slack:
        code, why = "inertia-triangle", "in a real body none exceeds the sum of the two others"
    else:
        return None
    shown = ", ".join(f"{moment:.4g}" for moment in (least, middle, most))
    sentence = f'Link "{link.name}" has principal moments of inertia of {shown} kg m²: {why}.'
    key, mend = f"link:{link.name}", inertia_mend(link, extent)
    return Finding(Severity.WARNING, code, sentence, key, mend)
