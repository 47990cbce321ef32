"""The face of a node for those who know rclpy: `import studio.ros.client as rclpy`."""

from __future__ import annotations

from studio.errors import ExternalShutdownException
from studio.ros.duration import Duration
from studio.ros.messages import action, message, service
from studio.ros.node.clock import Clock
from studio.ros.node.context import Context
from studio.ros.node.context import default_context as get_default_context
from studio.ros.node.executor import Executor, SingleThreadedExecutor
from studio.ros.node.future import Future
from studio.ros.node.node import Node
from studio.ros.node.spinning import (
    create_node,
    get_global_executor,
    init,
    ok,
    shutdown,
    spin,
    spin_once,
    spin_until_future_complete,
    try_shutdown,
)
from studio.ros.node.time import ClockType, Time
from studio.ros.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_sensor_data,
)

__all__ = [
    "Clock",
    "ClockType",
    "Context",
    "DurabilityPolicy",
    "Duration",
    "Executor",
    "ExternalShutdownException",
    "Future",
    "HistoryPolicy",
    "LivelinessPolicy",
    "Node",
    "QoSProfile",
    "ReliabilityPolicy",
    "SingleThreadedExecutor",
    "Time",
    "action",
    "create_node",
    "get_default_context",
    "get_global_executor",
    "init",
    "message",
    "ok",
    "qos_profile_sensor_data",
    "service",
    "shutdown",
    "spin",
    "spin_once",
    "spin_until_future_complete",
    "try_shutdown",
]
