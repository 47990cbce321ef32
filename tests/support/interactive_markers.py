"""Interactive markers, and feedback about them, for tests."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.ros.interactive_markers.names import FEEDBACK, MARKER, Mode

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import TypeLibrary

CONTROL = "visualization_msgs/msg/InteractiveMarkerControl"


def pose_at(types: TypeLibrary, x: float, y: float, z: float) -> MessageValue:
    """A pose without a turn."""
    pose = types.message("geometry_msgs/msg/Pose")()
    pose.position.x, pose.position.y, pose.position.z = x, y, z
    return pose


def control_of(types: TypeLibrary, name: str, mode: Mode, **fields: object) -> MessageValue:
    """A control whose x axis is that of the marker."""
    return types.message(CONTROL)(name=name, interaction_mode=int(mode), **fields)


def moving_marker(
    types: TypeLibrary, name: str, modes: Sequence[Mode] = (Mode.MOVE_AXIS,), frame: str = "base"
) -> MessageValue:
    """A marker of scale 1 in a frame, with a control of each of some modes."""
    marker = types.message(MARKER)(name=name, scale=1.0, description=f"The {name} one")
    marker.header.frame_id = frame
    marker.controls = [control_of(types, mode.name.lower(), mode) for mode in modes]
    return marker


def feedback_of(
    types: TypeLibrary, marker: str, event: int, position: tuple[float, float, float] = (0, 0, 0)
) -> MessageValue:
    """A feedback about a marker."""
    feedback = types.message(FEEDBACK)(marker_name=marker, event_type=int(event))
    feedback.pose = pose_at(types, *map(float, position))
    return feedback
