"""Messages: those that modules of rclpy and tf2_ros have names of, and all as bytes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from studio.ros.cdr import codec_of
from studio.ros.messages import message, service

if TYPE_CHECKING:
    from studio.ros.types.classes import MessageValue

_TYPES: Final = {
    "FloatingPointRange": "rcl_interfaces/msg/FloatingPointRange",
    "IntegerRange": "rcl_interfaces/msg/IntegerRange",
    "ListParametersResult": "rcl_interfaces/msg/ListParametersResult",
    "ParameterDescriptor": "rcl_interfaces/msg/ParameterDescriptor",
    "ParameterEvent": "rcl_interfaces/msg/ParameterEvent",
    "ParameterMsg": "rcl_interfaces/msg/Parameter",
    "ParameterType": "rcl_interfaces/msg/ParameterType",
    "ParameterValue": "rcl_interfaces/msg/ParameterValue",
    "SetParametersResult": "rcl_interfaces/msg/SetParametersResult",
    "TransformStamped": "geometry_msgs/msg/TransformStamped",
}
"""By name; each is made when it is asked for."""


def __getattr__(name: str) -> Any:  # noqa: ANN401
    if name == "ListParameters":
        return service("rcl_interfaces/srv/ListParameters")
    if name not in _TYPES:
        raise AttributeError(name)
    return message(_TYPES[name])


def serialize_message(message: MessageValue) -> bytes:
    """Write a message as CDR with its header.

    Raises:
        MessageValueError: A field holds what its type does not take.
    """
    return bytes(codec_of(type(message)).encode(message))


def deserialize_message(serialized_message: bytes, message_type: type[MessageValue]) -> Any:  # noqa: ANN401
    """Read a message.

    Raises:
        CdrError: The bytes are no such message.
    """
    return codec_of(message_type).decode(serialized_message)
