"""The face of a node for those who know rclpy: `import studio.ros.client as rclpy`."""

from __future__ import annotations

from studio.errors import ExternalShutdownException
from studio.ros.action import (
    ActionClient,
    ActionServer,
    CancelResponse,
    ClientGoalHandle,
    GoalResponse,
    GoalStatus,
    ServerGoalHandle,
)
from studio.ros.duration import Duration
from studio.ros.lifecycle import (
    LifecycleNode,
    LifecyclePublisher,
    LifecycleState,
    TransitionCallbackReturn,
)
from studio.ros.messages import action, message, service
from studio.ros.node.clock import Clock, ClockType, Time
from studio.ros.node.context import Context
from studio.ros.node.context import default_context as get_default_context
from studio.ros.node.executors import Executor, MultiThreadedExecutor, SingleThreadedExecutor
from studio.ros.node.logger import LoggingSeverity, get_logger
from studio.ros.node.node import Node
from studio.ros.node.publisher import Publisher
from studio.ros.node.service import Service
from studio.ros.node.service_client import Client
from studio.ros.node.signals import SignalHandlerOptions
from studio.ros.node.spinning import (
    create_node,
    get_global_executor,
    init,
    ok,
    shutdown,
    spin,
    spin_once,
    spin_until_future_complete,
    spinning,
    try_shutdown,
)
from studio.ros.node.subscription import Subscription
from studio.ros.node.task import Future, Task
from studio.ros.node.timer import Rate, Timer
from studio.ros.node.work import (
    CallbackGroup,
    MutuallyExclusiveCallbackGroup,
    ReentrantCallbackGroup,
)
from studio.ros.parameters.parameter import (
    Parameter,
)
from studio.ros.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_sensor_data,
)

__all__ = [
    "ActionClient",
    "ActionServer",
    "CallbackGroup",
    "CancelResponse",
    "Client",
    "ClientGoalHandle",
    "Clock",
    "ClockType",
    "Context",
    "DurabilityPolicy",
    "Duration",
    "Executor",
    "ExternalShutdownException",
    "Future",
    "GoalResponse",
    "GoalStatus",
    "HistoryPolicy",
    "LifecycleNode",
    "LifecyclePublisher",
    "LifecycleState",
    "LivelinessPolicy",
    "LoggingSeverity",
    "MultiThreadedExecutor",
    "MutuallyExclusiveCallbackGroup",
    "Node",
    "Parameter",
    "Publisher",
    "QoSProfile",
    "Rate",
    "ReentrantCallbackGroup",
    "ReliabilityPolicy",
    "ServerGoalHandle",
    "Service",
    "SignalHandlerOptions",
    "SingleThreadedExecutor",
    "Subscription",
    "Task",
    "Time",
    "Timer",
    "TransitionCallbackReturn",
    "action",
    "create_node",
    "get_default_context",
    "get_global_executor",
    "get_logger",
    "init",
    "message",
    "ok",
    "qos_profile_sensor_data",
    "service",
    "shutdown",
    "spin",
    "spin_once",
    "spin_until_future_complete",
    "spinning",
    "try_shutdown",
]
