"""Managed nodes: transitions in, states and events out, on both ends."""

from studio.ros.lifecycle.machine import StateId, TransitionCallbackReturn
from studio.ros.lifecycle.node import (
    LifecycleNode,
    LifecyclePublisher,
    LifecycleState,
    ManagedEntity,
)

__all__ = [
    "LifecycleNode",
    "LifecyclePublisher",
    "LifecycleState",
    "ManagedEntity",
    "StateId",
    "TransitionCallbackReturn",
]
