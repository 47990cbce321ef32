"""Managed nodes: transitions in, states and events out, on both ends."""

from studio.ros.lifecycle.entities import LifecyclePublisher, LifecycleState, ManagedEntity
from studio.ros.lifecycle.node import LifecycleNode
from studio.ros.lifecycle.states import StateId, TransitionCallbackReturn

__all__ = [
    "LifecycleNode",
    "LifecyclePublisher",
    "LifecycleState",
    "ManagedEntity",
    "StateId",
    "TransitionCallbackReturn",
]
