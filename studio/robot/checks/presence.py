"""Checks of what links lack: a mass, a collision shape, or a root without a mass."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.problems import Severity
from studio.robot.checks.finding import Finding
from studio.robot.values import JointType, Mesh

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.robot.checks.finding import CheckedRobot
    from studio.robot.values import Joint, Link, Robot


@dataclass(frozen=True, slots=True)
class Body:
    """Links that move as one, the one nearest to the root first; `mover` is None for a root's."""

    links: tuple[Link, ...]
    mover: Joint | None


def rigid_bodies(robot: Robot) -> list[Body]:
    """Return every link of the robot in exactly one body; joints in a cycle belong to none."""
    children: dict[str, list[Joint]] = {}
    for joint in robot.joints.values():
        children.setdefault(joint.parent, []).append(joint)
    held = {joint.child for joint in robot.joints.values()}
    waiting: list[tuple[str, Joint | None]] = [(n, None) for n in robot.links if n not in held]
    found: list[Body] = []
    while waiting:
        first, mover = waiting.pop(0)
        names = [first]
        for name in names:  # grows while it is gone through
            for joint in children.get(name, ()):
                if joint.type is JointType.FIXED:
                    names.append(joint.child)
                else:
                    waiting.append((joint.child, joint))
        found.append(Body(tuple(robot.links[one] for one in names), mover))
    return found


def findings(checked: CheckedRobot) -> Iterator[Finding]:
    """Yield moving bodies without mass or collision, and a root link with a mass.

    A robot that has no mass, or no collision, at all gets a single finding: it is made to be seen.
    """
    robot = checked.robot
    bodies = rigid_bodies(robot)
    links = robot.links.values()
    moving = [(body, body.mover) for body in bodies if body.mover is not None]
    if any(link.inertial for link in links):
        yield from _massless(moving)
        yield from _heavy_roots(bodies)
    elif any(link.visuals or link.collisions for link in links):
        sentence = (
            "No link has an <inertial>: the robot can be shown, and a simulator needs the masses."
        )
        yield Finding(Severity.INFO, "no-inertials", sentence, "")
    if any(link.collisions for link in links):
        yield from _untouchable(moving)
    elif any(link.visuals for link in links):
        sentence = (
            "No link has a <collision>: the robot can be shown, and falls through the floor of "
            "a simulator."
        )
        yield Finding(Severity.INFO, "no-collisions", sentence, "")


def _massless(moving: list[tuple[Body, Joint]]) -> Iterator[Finding]:
    for body, mover in moving:
        solid = [link for link in body.links if link.visuals or link.collisions]
        if not solid or any(link.inertial for link in body.links):
            continue
        link = solid[0]
        sentence = (
            f'Link "{link.name}" is moved by joint "{mover.name}" and has no <inertial>: '
            "simulators leave such a link out, say what it weighs."
        )
        yield _at(link, Severity.WARNING, "missing-inertial", sentence, mover)


def _untouchable(moving: list[tuple[Body, Joint]]) -> Iterator[Finding]:
    for body, mover in moving:
        seen = [link for link in body.links if _seems_a_mesh(link)]
        if not seen or any(link.collisions for link in body.links):
            continue
        link = seen[0]
        sentence = (
            f'Link "{link.name}" is moved by joint "{mover.name}" and has no <collision>: it goes '
            "through other things, add a simple shape."
        )
        yield _at(link, Severity.INFO, "missing-collision", sentence, mover)


def _seems_a_mesh(link: Link) -> bool:
    return any(isinstance(visual.geometry, Mesh) for visual in link.visuals)


def _heavy_roots(bodies: list[Body]) -> Iterator[Finding]:
    for body in bodies:
        root = body.links[0]
        if body.mover is None and root.inertial is not None and root.inertial.mass_kg > 0:
            sentence = (
                f'The root link "{root.name}" has an <inertial>, which KDL ignores with a warning: '
                "put a link without one above it, on a fixed joint."
            )
            yield Finding(Severity.INFO, "root-inertial", sentence, f"link:{root.name}")


def _at(link: Link, severity: Severity, code: str, sentence: str, mover: Joint) -> Finding:
    others = (f"joint:{mover.name}",)
    return Finding(severity, code, sentence, f"link:{link.name}", others=others)


WHY: Final = {
    "no-inertials": {
        "en": "The robot can be drawn without masses, but no simulator can move it.",
        "de": "Ohne Massen lässt sich der Roboter zeichnen, aber kein Simulator kann ihn bewegen.",
    },
    "no-collisions": {
        "en": "Without collision shapes planners and simulators take the whole robot for air.",
        "de": "Ohne Kollisionsformen ist der ganze Roboter für Planer und Simulatoren Luft.",
    },
    "missing-inertial": {
        "en": "A link that a joint moves needs mass and inertia: simulators drop a link without "
        "them, or weld it to its parent.",
        "de": "Ein Link, den ein Gelenk bewegt, braucht Masse und Trägheit: Simulatoren lassen "
        "ihn sonst weg oder verschweißen ihn mit seinem Elternteil.",
    },
    "missing-collision": {
        "en": "What has only a visual is seen, but nothing can touch it: planners and simulators "
        "go through it.",
        "de": "Was nur ein Visual hat, ist zu sehen, aber nichts stößt daran an: Planer und "
        "Simulatoren gehen hindurch.",
    },
    "root-inertial": {
        "en": "KDL, which robot_state_publisher uses, ignores the inertia of the root link and "
        "warns. An empty root link with a fixed joint to this one avoids that.",
        "de": "KDL, das robot_state_publisher verwendet, ignoriert die Trägheit des Wurzel-Links "
        "und warnt. Ein leerer Wurzel-Link mit einem festen Gelenk zu diesem vermeidet das.",
    },
}
"""By code and language: why a finding matters, as the page explains it."""
