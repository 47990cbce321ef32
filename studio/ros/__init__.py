"""ROS 2 over Zenoh in Python: nodes as rclpy has them, on the wire of rmw_zenoh, without a ROS.

The names below are the library's face; each module is imported when one of its names is first
used. `studio.ros.client` has all names of rclpy, and `studio.ros.messages` the message classes.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from studio.ros.action import ActionClient, ActionServer
    from studio.ros.cdr import Codec
    from studio.ros.duration import Duration
    from studio.ros.graph.graph import Graph
    from studio.ros.lifecycle import LifecycleNode
    from studio.ros.node.clock import Time
    from studio.ros.node.context import Context
    from studio.ros.node.executors import MultiThreadedExecutor, SingleThreadedExecutor
    from studio.ros.node.node import Node
    from studio.ros.node.spinning import init, shutdown, spin, spinning
    from studio.ros.node.task import Future
    from studio.ros.parameter_client import ParameterClient
    from studio.ros.parameters.parameter import Parameter
    from studio.ros.qos import QoSProfile
    from studio.ros.types.convert import from_dict, to_dict
    from studio.ros.types.library import TypeLibrary
    from studio.ros.wire.router import run_router, start_router
    from studio.ros.wire.session import RouterWatch, WireSession, open_wire
    from studio.ros.wire.settings import WireSettings, wire_settings

_NAMES = {
    "action": ("ActionClient", "ActionServer"),
    "cdr": ("Codec",),
    "duration": ("Duration",),
    "graph.graph": ("Graph",),
    "lifecycle": ("LifecycleNode",),
    "node.clock": ("Time",),
    "node.context": ("Context",),
    "node.executors": ("MultiThreadedExecutor", "SingleThreadedExecutor"),
    "node.node": ("Node",),
    "node.spinning": ("init", "shutdown", "spin", "spinning"),
    "node.task": ("Future",),
    "parameter_client": ("ParameterClient",),
    "parameters.parameter": ("Parameter",),
    "qos": ("QoSProfile",),
    "types.convert": ("from_dict", "to_dict"),
    "types.library": ("TypeLibrary",),
    "wire.router": ("run_router", "start_router"),
    "wire.session": ("RouterWatch", "WireSession", "open_wire"),
    "wire.settings": ("WireSettings", "wire_settings"),
}
_MODULE_OF = {name: module for module, names in _NAMES.items() for name in names}

__all__ = [
    "ActionClient", "ActionServer", "Codec", "Context", "Duration", "Future", "Graph",
    "LifecycleNode", "MultiThreadedExecutor", "Node", "Parameter", "ParameterClient", "QoSProfile",
    "RouterWatch", "SingleThreadedExecutor", "Time", "TypeLibrary", "WireSession", "WireSettings",
    "from_dict", "init", "open_wire", "run_router", "shutdown", "spin", "spinning", "start_router",
    "to_dict", "wire_settings",
]  # fmt: skip


def __getattr__(name: str) -> Any:  # noqa: ANN401
    module = _MODULE_OF.get(name)
    if module is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = getattr(import_module(f"{__name__}.{module}"), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted(__all__)
