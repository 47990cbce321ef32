# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportMissingTypeStubs=false
"""What yourdfpy makes of a URDF: a second opinion. The door to yourdfpy, in the worker only."""

from __future__ import annotations

import io
import logging
from dataclasses import replace
from typing import TYPE_CHECKING
from xml.etree.ElementTree import tostring

import yourdfpy

from studio.errors import RobotError
from studio.problems import Problem, Severity
from studio.robot.requests import CheckAnswer
from studio.robot.xml_tree import parse_tree

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

_NAME = "unnamed_robot"
logging.getLogger("yourdfpy.urdf").disabled = True
"""It writes to the terminal of the studio; its findings become problems."""


def check_urdf(text: str) -> CheckAnswer:
    """Parse and validate an expanded URDF without its meshes; never raises for what it holds."""
    problems: list[Problem] = []
    try:
        clean = _clean(text, problems)
    except RobotError as error:
        return CheckAnswer((), (), "", (_problem("bad-urdf", f"The URDF cannot be read. {error}"),))
    try:
        robot = yourdfpy.URDF.load(io.BytesIO(clean), load_meshes=False)
        problems += _broken_rules(robot)
        return CheckAnswer(
            tuple(map(str, robot.link_map)),
            tuple(map(str, robot.actuated_joint_names)),
            str(robot.base_link or ""),
            tuple(dict.fromkeys(problems)),
        )
    except Exception as error:  # noqa: BLE001 - it raises whatever a broken file leads it to
        reason = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
        sentence = (
            f"yourdfpy, which other Python tools read robots with, cannot read it ({reason})."
        )
        return CheckAnswer((), (), "", (*problems, _problem("yourdfpy", sentence)))


def _clean(text: str, problems: list[Problem]) -> bytes:
    """Return the text parsed and written again: no entities, no undeclared prefixes, with a name.

    yourdfpy's own parser would follow entities to files.

    Raises:
        RobotError: Not well-formed, or it declares entities.
    """
    root = parse_tree(text)
    if not root.get("name"):
        sentence = "The <robot> has no name; ROS rejects this: give it one."
        problems.append(Problem(Severity.ERROR, "no-robot-name", sentence))
        root.set("name", _NAME)
    for parent in root.iter():
        for child in [one for one in parent if ":" in one.tag]:
            parent.remove(child)
        for key in [one for one in parent.attrib if ":" in one or one == "xmlns"]:
            del parent.attrib[key]
    return tostring(root)


def _broken_rules(robot: yourdfpy.URDF) -> Iterator[Problem]:
    """Yield the rules that each link and joint breaks; yourdfpy does not name the part."""
    whole = robot.robot
    links, joints = list(whole.links), list(whole.joints)
    whole.links, whole.joints = [], []
    for link in links:
        whole.links = [link]
        yield from _of_part("link", link.name, _errors(robot))
    whole.links = []
    for joint in joints:
        whole.joints = [joint]
        yield from _of_part("joint", joint.name, _errors(robot))
    whole.links, whole.joints = links, joints


def _of_part(kind: str, name: str, errors: Iterable[object]) -> Iterator[Problem]:
    for error in errors:
        sentence = f'{kind.capitalize()} "{name}": {error}'
        yield replace(_problem("urdf-rule", sentence), parts=(f"{kind}:{name}",))


def _errors(robot: yourdfpy.URDF) -> Iterable[object]:
    """Return what `validate` finds; yourdfpy hands it to a handler only."""
    found: list[object] = []

    def keep(errors: Iterable[object]) -> bool:
        found.extend(errors)
        return True

    robot.validate(validation_fn=keep)
    return found


def _problem(code: str, sentence: str) -> Problem:
    return Problem(Severity.WARNING, code, sentence)
