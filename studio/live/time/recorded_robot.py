"""What a recording says of its robot: where the description is, and what moves the joints."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, Literal

if TYPE_CHECKING:
    from studio.bags.recording import Recording

DESCRIPTION: Final = "/robot_description"


def recorded_joints(recording: Recording) -> Literal["joint_states", "tf"] | None:
    """Return the topic that moves the joints of a recording; None: there is none."""
    names = {one.name for one in recording.topics if one.count}
    if "/joint_states" in names:
        return "joint_states"
    return "tf" if "/tf" in names else None
