"""Messages that modules of rclpy and tf2_ros have names of, each made when it is asked for."""

from __future__ import annotations

from typing import Any, Final

from studio.ros.messages import message, service

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


def __getattr__(name: str) -> Any:  # noqa: ANN401
    if name == "ListParameters":
        return service("rcl_interfaces/srv/ListParameters")
    if name not in _TYPES:
        raise AttributeError(name)
    return message(_TYPES[name])
