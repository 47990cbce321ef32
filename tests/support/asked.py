"""Commands that a test sends past the door, to a document or to the ROS system."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from studio.documents.document import COMMANDS as DOCUMENT_COMMANDS
from studio.live.panels.ros_system import COMMANDS as ROS_COMMANDS
from studio.protocol.listeners import send

if TYPE_CHECKING:
    from studio.documents.document import Document
    from studio.live.panels.ros_system import RosSystem
    from studio.protocol import Command
    from studio.protocol.listeners import Listener


async def ask_document(document: Document, command: Command, asker: Listener) -> None:
    """Have a document carry a command out; its answer goes to the asker."""
    if (answer := await DOCUMENT_COMMANDS.carry_out(document, command, asker)) is not None:
        send(asker, answer)


async def ask_ros(ros: RosSystem, command: Command, asker: Listener) -> Any:  # noqa: ANN401
    """Have the ROS system carry a command out; gives its answer."""
    if ROS_COMMANDS[type(command)].needs_router:
        ros.check_router()
    return await ROS_COMMANDS.carry_out(ros, command, asker)
