"""Types and topics of interactive markers, and the numbers that their messages use."""

from __future__ import annotations

from enum import IntEnum
from typing import Final

MARKER: Final = "visualization_msgs/msg/InteractiveMarker"
CONTROL: Final = "visualization_msgs/msg/InteractiveMarkerControl"
POSE: Final = "visualization_msgs/msg/InteractiveMarkerPose"
UPDATE: Final = "visualization_msgs/msg/InteractiveMarkerUpdate"
FEEDBACK: Final = "visualization_msgs/msg/InteractiveMarkerFeedback"
MENU_ENTRY: Final = "visualization_msgs/msg/MenuEntry"
SERVICE: Final = "visualization_msgs/srv/GetInteractiveMarkers"

UPDATE_TOPIC: Final = "/update"
FEEDBACK_TOPIC: Final = "/feedback"
SERVICE_NAME: Final = "/get_interactive_markers"
DEPTH: Final = 100
"""Of the topics, as upstream has it."""


class Mode(IntEnum):
    """Field `interaction_mode` of a control."""

    NONE = 0
    MENU = 1
    BUTTON = 2
    MOVE_AXIS = 3
    MOVE_PLANE = 4
    ROTATE_AXIS = 5
    MOVE_ROTATE = 6
    MOVE_3D = 7
    ROTATE_3D = 8
    MOVE_ROTATE_3D = 9


class OrientationMode(IntEnum):
    """Field `orientation_mode` of a control."""

    INHERIT = 0
    FIXED = 1
    VIEW_FACING = 2


class FeedbackEvent(IntEnum):
    """Field `event_type` of a feedback."""

    KEEP_ALIVE = 0
    POSE_UPDATE = 1
    MENU_SELECT = 2
    BUTTON_CLICK = 3
    MOUSE_DOWN = 4
    MOUSE_UP = 5


class UpdateKind(IntEnum):
    """Field `type` of an update."""

    KEEP_ALIVE = 0
    UPDATE = 1


class CommandKind(IntEnum):
    """Field `command_type` of a menu entry."""

    FEEDBACK = 0
    ROSRUN = 1
    ROSLAUNCH = 2
