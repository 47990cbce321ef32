"""The `<group_state>` elements of an SRDF, which is expanded as a robot description is.

Source: the SRDF specification, as MoveIt reads it: `<group_state name group>` holds `<joint name
value>`; a joint of several degrees of freedom has several numbers in its value.
"""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.etree import ElementTree

from studio.description.poses.named_poses import JOINT_LIMIT, NAME_LIMIT, NamedPose, position_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.description.values import Expansion, Part


def group_states(expansion: Expansion) -> Iterator[NamedPose]:
    """The states of a run of an SRDF, in its order; those without a name or joint are left out."""
    for part in expansion.changed_parts:
        if part.key.startswith("other:") and part.xml.startswith("<group_state"):
            pose = _pose(part)
            if pose.name and (pose.positions or pose.unread):
                yield pose


def _pose(part: Part) -> NamedPose:
    element = ElementTree.fromstring(part.xml)
    positions: dict[str, float] = {}
    unread: list[str] = []
    for joint in element.findall("joint")[:JOINT_LIMIT]:
        name = joint.get("name", "")
        value = position_of(joint.get("value", ""))
        if value is None:
            unread.append(name)
        elif name:
            positions[name] = value
    return NamedPose(
        name=element.get("name", "").strip()[:NAME_LIMIT],
        positions=positions,
        group=element.get("group", "").strip()[:NAME_LIMIT],
        file=part.place.file,
        line=part.place.line,
        unread=tuple(unread),
    )
