"""Checks of masses and moments of inertia: by themselves, and against the shape of the link."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from studio.problems import Severity
from studio.robot.checks.extents import is_marker
from studio.robot.checks.finding import Finding, RemoveChild, SetAttributes
from studio.robot.rotations import matrix_from_rpy
from studio.robot.values import Box, Cylinder, Sphere

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from studio.robot.checks.extents import Extent
    from studio.robot.checks.finding import CheckedRobot
    from studio.robot.rotations import Floats
    from studio.robot.values import Inertial, Link, Robot, Vector3

_ENTRIES: Final = {
    "ixx": (0, 0),
    "ixy": (0, 1),
    "ixz": (0, 2),
    "iyy": (1, 1),
    "iyz": (1, 2),
    "izz": (2, 2),
}
_TOLERANCE: Final = 1e-6
"""Share of the largest moment: rounding in the file is no fault."""
_WHY: Final = {
    "bad-inertia": "all must be above zero",
    "inertia-triangle": "in a real body none exceeds the sum of the two others",
}
_DENSEST_KG_M3: Final = 20_000.0
"""Gold has 19,300; steel 7,850."""
_LIGHTEST_KG_M3: Final = 5.0
"""Mean density of the box around a link, mostly air; of the corpus the lightest has 19."""
_THINNEST_M: Final = 0.005
"""A sheet or a line as a picture of something is taken to be that thick."""
_TOO_WIDE: Final = 1.5
"""Times the moment of the whole mass in the farthest corner, which nothing exceeds."""
_TOO_NARROW: Final = 0.01
"""Share of the moment of a solid box of that size: a tenth of its size."""


def findings(checked: CheckedRobot) -> Iterator[Finding]:
    """Yield masses and moments that no body has, or not one of the link's shape."""
    yield from _of_masses(checked.robot, checked.extents)
    yield from _against_shapes(checked.robot, checked.extents)


def inertia_mend(link: Link, extent: Extent) -> SetAttributes | None:
    """Write the inertia of the link's shape at its mass; None when the shape is not known.

    Of a single box, cylinder or sphere its own, else that of the box around the link. The centre
    of mass stays where it is.
    """
    inertial, box = link.inertial, extent.whole
    if inertial is None or inertial.mass_kg <= 0 or box is None:
        return None
    solid = _only_primitive(link)
    if solid is None:
        x, y, z = (box[1] - box[0]).tolist()
        shape, rpy = Box((x, y, z)), (0.0, 0.0, 0.0)
    else:
        shape, rpy = solid
    per_kg = _moments_per_kg(shape)
    if not per_kg.all():
        return None
    tensor = _in_axes_of(inertial, rpy, inertial.mass_kg * per_kg)
    texts = tuple((name, f"{_rounded(tensor, i, j):.6g}") for name, (i, j) in _ENTRIES.items())
    label = f"Take a solid {type(shape).__name__.lower()}'s inertia"
    return SetAttributes(label, ("inertial", "inertia"), texts, is_for_one=True)


def _only_primitive(link: Link) -> tuple[Box | Cylinder | Sphere, Vector3] | None:
    """Return the only collision geometry, else the only visual one, and how it is turned."""
    for side in (link.collisions, link.visuals):
        if len(side) == 1 and isinstance(side[0].geometry, Box | Cylinder | Sphere):
            return side[0].geometry, side[0].origin.rpy
        if side:
            return None
    return None


def _moments_per_kg(shape: Box | Cylinder | Sphere) -> Floats:
    """Moments about the axes of a solid through its centre, (3,), m²."""
    match shape:
        case Box((x, y, z)):
            return np.array([y * y + z * z, x * x + z * z, x * x + y * y]) / 12
        case Cylinder(radius_m, length_m):
            across = (3 * radius_m**2 + length_m**2) / 12
            return np.array([across, across, radius_m**2 / 2])
        case Sphere(radius_m):
            return np.full(3, 0.4 * radius_m**2)


def _in_axes_of(inertial: Inertial, rpy: Vector3, moments: Floats) -> Floats:
    """Return the tensor (3, 3) of a turned solid's moments, in the axes of the inertial."""
    link_from_solid = matrix_from_rpy(np.array(rpy))
    link_from_inertial = matrix_from_rpy(np.array(inertial.origin.rpy))
    turn = link_from_inertial.T @ link_from_solid
    return turn @ np.diag(moments) @ turn.T


def _rounded(tensor: Floats, i: int, j: int) -> float:
    """Return an entry, without the dust that turning leaves off the diagonal."""
    entry = float(tensor[i, j])
    return 0.0 if abs(entry) < 1e-9 * float(np.trace(tensor)) else entry


def _of_masses(robot: Robot, extents: Mapping[str, Extent]) -> Iterator[Finding]:
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
    """Return what is wrong with principal moments (3,), kg m², ascending."""
    if not (fault := moments_fault(moments)):
        return None
    why = _WHY[fault]
    shown = ", ".join(f"{moment:.4g}" for moment in moments.tolist())
    sentence = f'Link "{link.name}" has principal moments of inertia of {shown} kg m²: {why}.'
    key, mend = f"link:{link.name}", inertia_mend(link, extent)
    return Finding(Severity.WARNING, fault, sentence, key, mend)


def _against_shapes(robot: Robot, extents: Mapping[str, Extent]) -> Iterator[Finding]:
    """Yield links much denser or lighter than matter, or with the inertia of another size.

    Shapes that only mark a frame do not count.
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


WHY: Final = {
    "bad-inertia": {
        "en": "An inertia tensor belongs to a body only when it is positive definite: every "
        "direction needs some resistance to turning. Simulators blow up or refuse such a link.",
        "de": "Ein Trägheitstensor gehört nur dann zu einem Körper, wenn er positiv definit ist: "
        "Jede Richtung setzt dem Drehen etwas entgegen. Simulatoren werden damit instabil oder "
        "lehnen den Link ab.",
    },
    "inertia-triangle": {
        "en": "Of the three principal moments none can be larger than the two others together; no "
        "distribution of mass does that. Physics engines reject or distort such a link.",
        "de": "Von den drei Hauptträgheitsmomenten kann keines größer sein als die beiden anderen "
        "zusammen; keine Massenverteilung ergibt das. Physik-Engines lehnen einen solchen "
        "Link ab oder verfälschen ihn.",
    },
    "bad-mass": {
        "en": "A link that moves needs a positive mass, of a density that things can have; forces "
        "divide by it.",
        "de": "Ein bewegter Link braucht eine positive Masse mit einer Dichte, die es gibt; "
        "Kräfte werden durch sie geteilt.",
    },
    "inertia-size": {
        "en": "The moments of inertia do not fit a body of this size and mass. The link will turn "
        "far too easily or far too sluggishly.",
        "de": "Die Trägheitsmomente passen nicht zu einem Körper dieser Größe und Masse. Der "
        "Link dreht sich viel zu leicht oder viel zu träge.",
    },
}
"""By code and language: why a finding matters, as the page explains it."""
