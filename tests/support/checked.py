"""Small robots written as URDF text, checked where they stand, and mended by one click."""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.etree import ElementTree

from studio.description.syntax.source_tree import parse_source
from studio.description.values import Part
from studio.robot.assembly import Assembly
from studio.robot.checks.finding import CheckedRobot
from studio.robot.checks.robot_checks import check_robot, robot_findings
from studio.robot.xml_tree import plain_element

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.problems import Fix, MacroCall, Place, Problem
    from studio.robot.checks.finding import Finding
    from studio.robot.measures import Bounds

FILE = "robot.urdf"


def checked(
    urdf: str | bytes,
    meshes: Mapping[str, Bounds] | None = None,
    calls: tuple[MacroCall, ...] = (),
) -> CheckedRobot:
    """A robot whose parts stand where they do in its text."""
    data = urdf.encode() if isinstance(urdf, str) else urdf
    tree = parse_source(FILE, data)
    elements = zip(tree.root.elements(), ElementTree.fromstring(data), strict=True)
    parts = [_part(xml, one.place, calls) for one, xml in elements]
    assembly = Assembly()
    assembly.apply(tuple(part.key for part in parts), parts)
    return CheckedRobot(
        assembly.robot,
        assembly.part,
        (meshes or {}).get,
        lambda file: data if file == FILE else None,
    )


def _part(element: ElementTree.Element, place: Place, calls: tuple[MacroCall, ...]) -> Part:
    element.tail = None
    name = f"{element.tag}:{element.get('name')}"
    return Part(name, plain_element(element), place, calls)


def robot(*elements: str) -> str:
    """A whole URDF, one line for each element."""
    return "\n".join(['<robot name="r">', *elements, "</robot>"])


def link(name: str, *inner: str) -> str:
    return f'<link name="{name}">{"".join(inner)}</link>'


def joint(kind: str, child: str, inner: str = "", parent: str = "base") -> str:
    """A joint named as its child is."""
    return (
        f'<joint name="{child}" type="{kind}"><parent link="{parent}"/>'
        f'<child link="{child}"/>{inner}</joint>'
    )


def shape(tag: str, geometry: str, origin: str = "") -> str:
    """A visual or a collision."""
    return f"<{tag}>{origin}<geometry>{geometry}</geometry></{tag}>"


def box(tag: str, size: str, xyz: str = "0 0 0") -> str:
    return shape(tag, f'<box size="{size}"/>', f'<origin xyz="{xyz}"/>')


def inertial(mass_kg: float | str, *moments: float | str) -> str:
    """Mass and the three moments about its axes."""
    ixx, iyy, izz = moments
    return (
        f'<inertial><mass value="{mass_kg}"/><inertia ixx="{ixx}" ixy="0" ixz="0" iyy="{iyy}" '
        f'iyz="0" izz="{izz}"/></inertial>'
    )


def findings(urdf: str | bytes, meshes: Mapping[str, Bounds] | None = None) -> list[Finding]:
    return list(robot_findings(checked(urdf, meshes)))


def codes(urdf: str | bytes, meshes: Mapping[str, Bounds] | None = None) -> list[str]:
    return [finding.code for finding in findings(urdf, meshes)]


def problem_of(one: CheckedRobot, code: str) -> Problem:
    """The only problem with that code."""
    (found,) = [problem for problem in check_robot(one) if problem.code == code]
    return found


def mended(urdf: str, code: str, meshes: Mapping[str, Bounds] | None = None) -> str:
    """The text after a click on the fix of the only problem with that code."""
    fix = problem_of(checked(urdf, meshes), code).fix
    assert fix is not None
    return applied(urdf, fix)


def applied(text: str, fix: Fix) -> str:
    """A text with the edits of a fix; each finds what it wants to replace."""
    data = text.encode()
    for edit in sorted(fix.edits, key=lambda one: -one.start):
        assert data[edit.start : edit.end].decode() == edit.before
        data = data[: edit.start] + edit.text.encode() + data[edit.end :]
    return data.decode()


def without(all_codes: Iterable[str], *passed_over: str) -> list[str]:
    """Codes but for those that a small robot has anyway."""
    return [code for code in all_codes if code not in passed_over]
