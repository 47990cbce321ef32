"""The QoS of a topic as the parameters of its node override it."""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, Any

from studio.errors import ParameterAlreadyDeclaredError, QosOverrideError
from studio.ros.duration import Duration
from studio.ros.parameters.messages import ParameterMessages
from studio.ros.qos import as_profile
from studio.ros.qos_overriding_options import QoSPolicyKind
from studio.ros.tokens import EndpointKind

if TYPE_CHECKING:
    from studio.ros.node.node import Node
    from studio.ros.qos import QoSProfile
    from studio.ros.qos_overriding_options import QoSOverridingOptions

_NAMES = {EndpointKind.PUBLISHER: "publisher", EndpointKind.SUBSCRIPTION: "subscription"}


def overridden(
    node: Node,
    kind: EndpointKind,
    topic: str,
    qos: QoSProfile | int,
    options: QoSOverridingOptions | None,
) -> QoSProfile | int:
    """Declare the parameters that options name, and give the profile that they make.

    Raises:
        QosOverrideError: A parameter is no such policy, or the callback refuses the profile.
    """
    if options is None:
        return qos
    profile = as_profile(qos)
    suffix = f"_{options.entity_id}" if options.entity_id else ""
    where = f"qos_overrides.{node.resolve_topic_name(topic)}.{_NAMES[kind]}{suffix}"
    for policy in options.policy_kinds:
        # A subscription has no lifespan.
        if not (policy is QoSPolicyKind.LIFESPAN and kind is EndpointKind.SUBSCRIPTION):
            _override(node, f"{where}.{policy.name.lower()}", profile, policy.name.lower())
    _ask(options, profile, where)
    return profile


def _override(node: Node, name: str, profile: QoSProfile, policy: str) -> None:
    kept: Any = getattr(profile, policy, None)
    if kept is None:
        raise QosOverrideError(name, "there is no such policy")
    descriptor = ParameterMessages.of(node.wire.types).ParameterDescriptor(read_only=True)
    try:
        given = node.declare_parameter(name, _plain(kept), descriptor).value
    except ParameterAlreadyDeclaredError:  # by another endpoint of the topic
        given = node.get_parameter(name).value
    setattr(profile, policy, _like(kept, given, name))


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


def _ask(options: QoSOverridingOptions, profile: QoSProfile, where: str) -> None:
    if options.callback is None:
        return
    answer = options.callback(profile)
    if not getattr(answer, "successful", False):
        reason = getattr(answer, "reason", "") or "the callback of the node refused it"
        raise QosOverrideError(where, reason.rstrip("."))
