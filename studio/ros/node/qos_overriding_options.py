"""QoSOverridingOptions: which policies of a topic parameters may override, as in rclpy."""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, Any, NamedTuple

from studio.errors import ParameterAlreadyDeclaredError, QosOverrideError
from studio.ros.duration import Duration
from studio.ros.parameters.parameter import ParameterMessages
from studio.ros.qos import as_profile
from studio.ros.tokens import EndpointKind

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from typing import Self

    from studio.ros.parameters.node_parameters import NodeParameters
    from studio.ros.qos import QoSProfile
    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import TypeLibrary

_NAMES = {EndpointKind.PUBLISHER: "publisher", EndpointKind.SUBSCRIPTION: "subscription"}


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
    """Result of a callback that accepts or refuses a profile."""

    successful: bool = True
    reason: str = ""


class QoSOverridingOptions:
    """Policies that parameters `qos_overrides.<topic>.<publisher|subscription>[_id].*` may set.

    `callback` receives the resulting profile, and decides whether it is accepted.
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


def override_qos(
    parameters: NodeParameters,
    types: TypeLibrary,
    endpoint: tuple[EndpointKind, str],
    qos: QoSProfile | int,
    options: QoSOverridingOptions,
) -> QoSProfile:
    """Declare the parameters that options name, and return the profile that they make.

    Args:
        parameters: Those of the node.
        types: Those of its session.
        endpoint: Publisher or subscription, and the full name of its topic.
        qos: The profile in the code.
        options: Which policies may be overridden.

    Raises:
        QosOverrideError: A parameter is no such policy, or the callback refuses the profile.
    """
    kind, topic = endpoint
    profile = as_profile(qos)
    suffix = f"_{options.entity_id}" if options.entity_id else ""
    where = f"qos_overrides.{topic}.{_NAMES[kind]}{suffix}"
    descriptor = ParameterMessages.of(types).ParameterDescriptor(read_only=True)
    for policy in options.policy_kinds:
        # A subscription has no lifespan.
        if not (policy is QoSPolicyKind.LIFESPAN and kind is EndpointKind.SUBSCRIPTION):
            name = f"{where}.{policy.name.lower()}"
            kept: Any = getattr(profile, policy.name.lower(), None)
            if kept is None:
                raise QosOverrideError(name, "there is no such policy")
            given = _declared_value(parameters, descriptor, name, _plain(kept))
            setattr(profile, policy.name.lower(), _like(kept, given, name))
    _check_answer(options, profile, where)
    return profile


def _declared_value(
    parameters: NodeParameters, descriptor: MessageValue, name: str, default: object
) -> Any:  # noqa: ANN401  # of the type of the default
    try:
        return parameters.declare_parameter(name, default, descriptor).value
    except ParameterAlreadyDeclaredError:  # by another endpoint of the topic
        return parameters.get_parameter(name).value


def _plain(policy: Any) -> bool | int | str:  # noqa: ANN401  # what a field of a profile holds
    """Write a policy as parameters hold it: names in small letters, nanoseconds."""
    if isinstance(policy, IntEnum):
        return policy.name.lower()
    return policy.nanoseconds if isinstance(policy, Duration) else policy


def _like(kept: object, given: Any, name: str) -> object:  # noqa: ANN401
    if isinstance(kept, IntEnum):
        kinds = type(kept)
        try:
            return kinds[str(given).upper()]
        except KeyError:
            known = ", ".join(one.name.lower() for one in kinds)
            raise QosOverrideError(name, f'"{given}" is none of {known}') from None
    if isinstance(given, int) and given < 0:
        raise QosOverrideError(name, f"{given} is below zero")
    return Duration(nanoseconds=given) if isinstance(kept, Duration) else given


def _check_answer(options: QoSOverridingOptions, profile: QoSProfile, where: str) -> None:
    if options.callback is None:
        return
    answer = options.callback(profile)
    if not getattr(answer, "successful", False):
        reason = getattr(answer, "reason", "") or "the callback of the node refused it"
        raise QosOverrideError(where, reason.rstrip("."))
