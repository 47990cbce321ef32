"""Ids of goals: 16 bytes as nodes compare them, and the UUID message that carries them."""

from __future__ import annotations

import uuid
from typing import TYPE_CHECKING

from studio.ros.action.cancelling import GOAL_ID_BYTES
from studio.ros.types.classes import shown

if TYPE_CHECKING:
    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import TypeLibrary

UUID = "unique_identifier_msgs/msg/UUID"


def new_goal_id() -> bytes:
    """Make an id that no other goal has."""
    return uuid.uuid4().bytes


def goal_id_of(message: MessageValue) -> bytes:
    """Give the bytes of a UUID message."""
    return bytes(message.uuid)


def goal_id_message(types: TypeLibrary, goal_id: bytes) -> MessageValue:
    """Make a UUID message.

    Raises:
        ValueError: It has not 16 bytes.
    """
    if len(goal_id) != GOAL_ID_BYTES:
        raise ValueError(f"a goal has an id of {GOAL_ID_BYTES} bytes, not {shown(goal_id)}")
    return types.message(UUID)(uuid=goal_id)
