"""Whether classes are those of messages and services."""

from __future__ import annotations

from studio.importable.rclpy_parts.exceptions import NoTypeSupportImportedException
from studio.ros.types.classes import MessageValue
from studio.ros.types.library import ActionType, ServiceType


def check_for_type_support(msg_or_srv_type: object) -> None:
    """Refuse what is no type of ROS.

    Raises:
        AttributeError: It is none.
    """
    if not _is_message(msg_or_srv_type) and not isinstance(
        msg_or_srv_type, ServiceType | ActionType
    ):
        raise AttributeError(f"{msg_or_srv_type!r} is no message, service or action of ROS 2")


def check_is_valid_msg_type(msg_type: object) -> None:
    """Refuse what is no message.

    Raises:
        RuntimeError: It is none.
    """
    _refuse(_is_message(msg_type), msg_type, "message")


def check_is_valid_srv_type(srv_type: object) -> None:
    """Refuse what is no service.

    Raises:
        RuntimeError: It is none.
    """
    _refuse(isinstance(srv_type, ServiceType), srv_type, "service")


def _is_message(kind: object) -> bool:
    return isinstance(kind, type) and issubclass(kind, MessageValue)


def _refuse(is_right: bool, kind: object, wanted: str) -> None:  # noqa: FBT001
    if not is_right:
        raise RuntimeError(f"The type provided is not valid: {kind!r} is no {wanted} of ROS 2")


__all__ = [
    "NoTypeSupportImportedException",
    "check_for_type_support",
    "check_is_valid_msg_type",
    "check_is_valid_srv_type",
]
