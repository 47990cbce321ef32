from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.errors import QosOverrideError
from studio.ros.duration import Duration
from studio.ros.messages import message
from studio.ros.node.node import Node
from studio.ros.node.qos_overriding_options import (
    QosCallbackResult,
    QoSOverridingOptions,
    QoSPolicyKind,
)
from studio.ros.parameters.parameter import Parameter
from studio.ros.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from tests.support.node_pair import context_at
from tests.support.wire import running_router

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.context import Context

pytestmark = pytest.mark.network
String = message("std_msgs/msg/String")
DEFAULTS = QoSOverridingOptions.with_default_policies()


@pytest.fixture(scope="module")
def context() -> Generator[Context]:
    with running_router() as endpoint, context_at(endpoint) as found:
        yield found


def node_with(context: Context, **values: object) -> Node:
    """A node whose parameters of /chatter are overridden; `__` stands for a dot."""
    overrides = [
        Parameter(f"qos_overrides./chatter.{name.replace('__', '.')}", value=value)
        for name, value in values.items()
    ]
    return Node("overridden", context=context, parameter_overrides=overrides)


def test_parameters_override_the_policies_that_may_be(context: Context):
    node = node_with(
        context,
        publisher__depth=3,
        publisher__reliability="best_effort",
        publisher__durability="transient_local",
    )
    publisher = node.create_publisher(String, "chatter", 10, qos_overriding_options=DEFAULTS)
    made = publisher.qos_profile
    assert (made.depth, made.reliability) == (3, ReliabilityPolicy.BEST_EFFORT)
    assert made.durability is DurabilityPolicy.VOLATILE  # it was not named
    assert node.get_parameter("qos_overrides./chatter.publisher.history").value == "keep_last"
    name = "qos_overrides./chatter.publisher.depth"
    assert not node.set_parameters([Parameter(name, value=9)])[0].successful


def test_of_two_on_a_topic_each_has_its_own_by_an_id(context: Context):
    node = node_with(context, subscription_fast__depth=1, subscription__depth=7)
    options = QoSOverridingOptions([QoSPolicyKind.DEPTH], entity_id="fast")
    subscriptions = [
        node.create_subscription(String, "chatter", print, 10, qos_overriding_options=one)
        for one in (options, DEFAULTS, DEFAULTS)
    ]
    assert [one.qos_profile.depth for one in subscriptions] == [1, 7, 7]


def test_spans_are_nanoseconds_and_a_subscription_has_no_lifespan(context: Context):
    node = node_with(context, subscription__deadline=5_000)
    options = QoSOverridingOptions([QoSPolicyKind.DEADLINE, QoSPolicyKind.LIFESPAN])
    made = node.create_subscription(String, "chatter", print, 10, qos_overriding_options=options)
    assert made.qos_profile.deadline == Duration(nanoseconds=5_000)
    assert not node.has_parameter("qos_overrides./chatter.subscription.lifespan")


@pytest.mark.parametrize(
    ("values", "reason"),
    [
        ({"publisher__history": "keep_some"}, "none of system_default, keep_last, keep_all"),
        ({"publisher__depth": -1}, "-1 is below zero"),
    ],
)
def test_what_is_no_policy_is_refused(context: Context, values: dict[str, object], reason: str):
    node = node_with(context, **values)
    with pytest.raises(QosOverrideError, match=reason):
        node.create_publisher(String, "chatter", 10, qos_overriding_options=DEFAULTS)


def test_a_callback_may_refuse_what_comes_of_it(context: Context):
    def judge(qos: QoSProfile) -> QosCallbackResult:
        return QosCallbackResult(qos.history is HistoryPolicy.KEEP_ALL, "it must keep all")

    options = QoSOverridingOptions([QoSPolicyKind.HISTORY], callback=judge)
    with pytest.raises(QosOverrideError, match="it must keep all"):
        node_with(context).create_publisher(String, "chatter", 10, qos_overriding_options=options)
    node = node_with(context, publisher__history="keep_all")
    made = node.create_publisher(String, "chatter", 10, qos_overriding_options=options)
    assert made.qos_profile.history is HistoryPolicy.KEEP_ALL
