"""Rates, sizes and ages of the messages of topics."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from studio.protocol.commands import Commands, Limits, Scope
from studio.protocol.topic_rates import GetTopicRates, TopicRate, TopicRates
from studio.ros.qos import DurabilityPolicy

if TYPE_CHECKING:
    from studio.live.topics.source import TopicSource
    from studio.ros.node.topic_statistics import Flow

_State: TypeAlias = Literal["waiting", "live", "silent", "latched"]


async def topic_rates(source: TopicSource, command: GetTopicRates) -> TopicRates:
    """Return how messages come on some topics; without a connection nothing is known of any.

    Pages ask again and again: a rate changes with the time, also when nothing comes.
    """
    # To subscribe to two hundred more takes some 10 ms.
    found = await asyncio.to_thread(_rates, source, command.topics)
    return TopicRates(request=command.request, rates=found)


def _rates(source: TopicSource, topics: tuple[str, ...]) -> tuple[TopicRate, ...]:
    return tuple(
        TopicRate(
            name=name,
            rate_hz=round(flow.rate_hz, 2),
            bytes_per_s=round(flow.bytes_per_s),
            age_s=None if flow.age_s is None else round(flow.age_s, 2),
            state=_state(flow, is_latched=_is_latched(source, name)),
        )
        for name, flow in source.flows(topics).items()
    )


def _is_latched(source: TopicSource, topic: str) -> bool:
    offered = (one.qos.durability for one in source.publishers(topic))
    return any(one is DurabilityPolicy.TRANSIENT_LOCAL for one in offered)


def _state(flow: Flow, *, is_latched: bool) -> _State:
    if flow.is_silent:
        return "latched" if is_latched else "silent"
    return "waiting" if flow.age_s is None else "live"


COMMANDS: Final = Commands["TopicSource"](Scope.ROS)
COMMANDS.viewer(GetTopicRates, lambda one, c, _: topic_rates(one, c), limits=Limits(per_second=20))
