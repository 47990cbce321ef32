"""Parts in, robot out: parses only what changed, and returns which links and joints did."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING

from studio.problems import Problem, Severity
from studio.robot.elements import ParsedElement, read_element
from studio.robot.structure import Structure
from studio.robot.values import Joint, Link, Material, Mesh, Robot, Visual

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.description.values import Expansion, Part
    from studio.robot.values import Geometry


@dataclass(frozen=True, slots=True)
class Change:
    """The result of `Assembly.apply`, compared with the robot before it."""

    robot: Robot
    changed_links: frozenset[str]
    """Links that are new or differ in looks, collisions or mass; not those that only moved."""
    changed_joints: frozenset[str]
    structural: bool
    """Links or joints came, went, changed order, type, parent, child or leader."""
    problems: tuple[Problem, ...]
    """All present problems of the robot, not only new ones."""
    kept_last_good: bool
    """The parts make no robot (no link, a cycle): `robot` is the one before."""
    only_numbers: bool = dataclasses.field(default=False, compare=False)
    """Names, ties, materials and meshes are known to be those of the robot before."""


@dataclass(frozen=True, slots=True)
class _Element:
    """A part as parsed, and its value: while it is broken, the last good one."""

    part: Part
    parsed: ParsedElement
    value: Link | Joint | Material | None


class Assembly:
    """Holds the elements of one robot by part key.

    Severities: an error means that something last good is shown (a broken element keeps its last
    good value, a cycle keeps the whole robot) or, when there is none, that the broken sub-element
    is left out; and that ROS rejects the file, though it is drawn as far as it makes sense.
    """

    def __init__(self, name: str = "") -> None:
        self.robot = Robot(name)
        self._name = name
        self._order: tuple[str, ...] = ()
        self._elements: dict[str, _Element] = {}
        self._structure = Structure.of(self.robot)
        self._kept: Change | None = None
        """The result of the last `apply`, unless it kept the robot before it."""
        self._resolved: dict[str, tuple[Link, tuple[Material | None, ...], Link]] = {}

    def rename(self, name: str) -> None:
        """Name the robot so from the next `apply` on."""
        self._name = name

    def part(self, key: str) -> Part | None:
        """Return the part of an element by its key, as in `Part.key`."""
        element = self._elements.get(key)
        return element.part if element else None

    def parts(self) -> tuple[Part, ...]:
        """Return all elements of the last `apply`, in document order."""
        return tuple(self._elements[key].part for key in self._order if key in self._elements)

    def apply(self, order: tuple[str, ...] | None, changed_parts: Iterable[Part]) -> Change:
        """Take in changed parts; `order` lists all keys, or is None when it stayed as it was."""
        parsed = {part.key: self._parse(part) for part in changed_parts}
        if order is None and (change := self._swapped(parsed)) is not None:
            return change
        self._elements |= parsed
        if order is not None:
            self._order = order
            self._elements = {key: self._elements[key] for key in order if key in self._elements}
        return self._assemble()

    def _parse(self, part: Part) -> _Element:
        before = self._elements.get(part.key)
        parsed = read_element(part.element)
        keep = bool(parsed.faults) and before is not None and before.value is not None
        return _Element(part, parsed, before.value if keep and before else parsed.value)

    def _swapped(self, parsed: Mapping[str, _Element]) -> Change | None:
        """Replace values that differ in numbers only; return None when it is not that simple.

        A drag changes a few numbers sixty times a second: names, ties, materials, meshes and
        problems are then as before, and are not checked again.
        """
        before = self._kept
        if before is None or self._name != self.robot.name:
            return None
        if not all(self._is_swap(self._elements.get(key), one) for key, one in parsed.items()):
            return None
        links, joints = dict(self.robot.links), dict(self.robot.joints)
        for one in parsed.values():
            match one.value:
                case Link() as link:
                    links[link.name] = self._dress(link, self._resolved[link.name][1])
                case Joint() as joint:
                    joints[joint.name] = joint
                case _:
                    pass
        self._elements |= parsed
        was, self.robot = self.robot, dataclasses.replace(self.robot, links=links, joints=joints)
        self._kept = dataclasses.replace(
            before,
            robot=self.robot,
            changed_links=_differing(was.links, links),
            changed_joints=_differing(was.joints, joints),
            structural=False,
            only_numbers=True,
        )
        return self._kept

    def _is_swap(self, old: _Element | None, new: _Element) -> bool:
        """Whether only numbers differ, in an element that is drawn and has nothing wrong."""
        if old is None or (old.part.place, old.part.calls) != (new.part.place, new.part.calls):
            return False
        if old.parsed.faults or new.parsed.faults:
            return False
        match old.value, new.value:
            case Link() as was, Link() as link:
                known = self._resolved.get(was.name)
                return (
                    was.name == link.name
                    and known is not None
                    and known[0] is was
                    and _appearance(was) == _appearance(link)
                )
            case Joint() as was, Joint() as joint:
                return _ties(was) == _ties(joint) and self.robot.joints.get(was.name) is was
            case _:
                return False

    def _assemble(self) -> Change:
        self._kept = None
        problems = [*self._element_problems()]
        written, repeats = self._written()
        structure = self._structure
        if not structure.fits(written):
            structure = Structure.of(written)
        problems += repeats
        problems += (self._located(one, key) for one, key in structure.findings)
        if structure.broken:
            return _unchanged(self.robot, tuple(problems))
        self._structure = structure
        before, self.robot = self.robot, structure.pruned(written)
        self._kept = _compare(before, self.robot, tuple(problems))
        return self._kept

    def _element_problems(self) -> Iterable[Problem]:
        for element in self._elements.values():
            for fault in element.parsed.faults:
                yield _problem(Severity.ERROR, "bad-element", str(fault), element.part)

    def _written(self) -> tuple[Robot, list[Problem]]:
        """Return the robot of all parts: the first of a name wins, materials are resolved."""
        links: dict[str, Link] = {}
        joints: dict[str, Joint] = {}
        materials: dict[str, Material] = {}
        problems: list[Problem] = []
        for element in self._elements.values():
            match element.value:
                case Link() as link if link.name not in links:
                    links[link.name] = link
                case Joint() as joint if joint.name not in joints:
                    joints[joint.name] = joint
                case Material() as material:
                    # gazebo and rviz users repeat materials freely; the first one wins, as in ROS
                    materials.setdefault(material.name, material)
                case None:
                    pass
                case Link() | Joint() as repeat:
                    problems.append(_repeated(repeat, element.part))
        _add_inline_materials(links.values(), materials)
        resolved = {name: self._resolve(link, materials, problems) for name, link in links.items()}
        return Robot(self._name, resolved, joints, materials), problems

    def _resolve(
        self, link: Link, materials: Mapping[str, Material], problems: list[Problem]
    ) -> Link:
        """Return the link with each named material resolved; the same object if nothing changed."""
        found = tuple(_lookup(visual, materials) for visual in link.visuals)
        for visual, material in zip(link.visuals, found, strict=True):
            if visual.material is not None and material is None:
                problems.append(self._undefined_material(link, visual.material.name))
        known = self._resolved.get(link.name)
        if known is not None and known[0] is link and known[1] == found:
            return known[2]
        return self._dress(link, found)

    def _dress(self, link: Link, found: tuple[Material | None, ...]) -> Link:
        visuals = tuple(  # not by `replace`: that takes most of the time of a drag
            Visual(visual.origin, visual.geometry, material, visual.name)
            for visual, material in zip(link.visuals, found, strict=True)
        )
        resolved = Link(link.name, visuals, link.collisions, link.inertial)
        self._resolved[link.name] = (link, found, resolved)
        return resolved

    def _undefined_material(self, link: Link, name: str) -> Problem:
        sentence = (
            f'Link "{link.name}" uses the material "{name}", which is not defined: '
            f'add <material name="{name}"> with a color.'
        )
        problem = Problem(Severity.WARNING, "undefined-material", sentence)
        return self._located(problem, f"link:{link.name}")

    def _located(self, problem: Problem, key: str) -> Problem:
        part = self.part(key)
        if part is None:
            return problem
        return dataclasses.replace(
            problem, place=part.place, macro_stack=part.calls, parts=(part.key,)
        )


def assembled(expansion: Expansion) -> tuple[Robot, str]:
    """Return the robot of a whole run, and what is wrong with it, a sentence or empty."""
    change = Assembly(expansion.robot_name).apply(expansion.part_order, expansion.changed_parts)
    if change.kept_last_good:
        fault = str(change.problems[0]) if change.problems else "It describes no robot."
    else:
        fault = str(expansion.warnings[0]) if expansion.is_recovered else ""
    return change.robot, fault


def _problem(severity: Severity, code: str, sentence: str, part: Part) -> Problem:
    return Problem(severity, code, sentence, part.place, macro_stack=part.calls, parts=(part.key,))


def _repeated(value: Link | Joint, part: Part) -> Problem:
    kind = "link" if isinstance(value, Link) else "joint"
    sentence = (
        f'A second {kind} is named "{value.name}" and was left out; ROS rejects this: '
        "give it a name of its own."
    )
    return _problem(Severity.ERROR, f"duplicate-{kind}", sentence, part)


def _add_inline_materials(links: Iterable[Link], materials: dict[str, Material]) -> None:
    """A material written inside a visual defines its name for the links after it, as in ROS."""
    for link in links:
        for visual in link.visuals:
            material = visual.material
            if material is not None and material.name and _has_appearance(material):
                materials.setdefault(material.name, material)


def _lookup(visual: Visual, materials: Mapping[str, Material]) -> Material | None:
    """Return the material of a visual: a defined name wins over the colour beside it."""
    material = visual.material
    if material is None:
        return None
    known = materials.get(material.name) if material.name else None
    return known or (material if _has_appearance(material) or not material.name else None)


def _has_appearance(material: Material) -> bool:
    return material.rgba is not None or bool(material.texture_uri)


def _unchanged(robot: Robot, problems: tuple[Problem, ...]) -> Change:
    return Change(
        robot,
        changed_links=frozenset(),
        changed_joints=frozenset(),
        structural=False,
        problems=problems,
        kept_last_good=True,
    )


def _compare(before: Robot, after: Robot, problems: tuple[Problem, ...]) -> Change:
    return Change(
        after,
        changed_links=_differing(before.links, after.links),
        changed_joints=_differing(before.joints, after.joints),
        structural=_skeleton(before) != _skeleton(after),
        problems=problems,
        kept_last_good=False,
    )


def _differing(before: Mapping[str, object], after: Mapping[str, object]) -> frozenset[str]:
    return frozenset(
        name
        for name, value in after.items()
        if (known := before.get(name)) is not value and known != value
    )


def _skeleton(robot: Robot) -> object:
    return tuple(robot.links), [_ties(joint) for joint in robot.joints.values()]


def _appearance(link: Link) -> object:
    """Return what a link is drawn with, but for numbers: kinds of shapes, meshes, materials."""
    return (
        [(_kind(one.geometry), one.material) for one in link.visuals],
        [_kind(one.geometry) for one in link.collisions],
    )


def _kind(geometry: Geometry) -> object:
    return geometry.uri if isinstance(geometry, Mesh) else type(geometry)


def _ties(joint: Joint) -> object:
    leader = joint.mimic and joint.mimic.joint
    return joint.name, joint.type, joint.parent, joint.child, leader
