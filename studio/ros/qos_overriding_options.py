"""QoSOverridingOptions: which policies of a topic the user may set by parameters, as in rclpy."""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from typing import Self

    from studio.ros.qos import QoSProfile


class QoSPolicyKind(IntEnum):
    """The policies of a profile, by rclpy's numbers."""

    INVALID = 1
    DURABILITY = 2
    DEADLINE = 4
    LIVELINESS = 8
    RELIABILITY = 16
    HISTORY = 32
    LIFESPAN = 64
    DEPTH = 128
    LIVELINESS_LEASE_DURATION = 256
    AVOID_ROS_NAMESPACE_CONVENTIONS = 512


class QosCallbackResult(NamedTuple):
    """What a callback answers that judges a profile."""

    successful: bool = True
    reason: str = ""


class QoSOverridingOptions:
    """Policies that parameters `qos_overrides.<topic>.<publisher|subscription>[_id].*` may set.

    `callback` is given the profile that comes of it, and says whether it may be.
    """

    def __init__(
        self,
        policy_kinds: Iterable[QoSPolicyKind],
        *,
        callback: Callable[[QoSProfile], Any] | None = None,
        entity_id: str | None = None,
    ) -> None:
        self.policy_kinds = tuple(policy_kinds)
        self.callback = callback
        self.entity_id = entity_id

    @classmethod
    def with_default_policies(
        cls,
        *,
        callback: Callable[[QoSProfile], Any] | None = None,
        entity_id: str | None = None,
    ) -> Self:
        """Let history, depth and reliability be set."""
        kinds = (QoSPolicyKind.HISTORY, QoSPolicyKind.DEPTH, QoSPolicyKind.RELIABILITY)
        return cls(kinds, callback=callback, entity_id=entity_id)
