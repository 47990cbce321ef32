"""Bridges to DDS as pages are told of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.protocol.connection import BridgeView, SlowedTopics

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.protocol.connection import BridgeState
    from studio.ros.wire.bridges.bridge import Bridge

BRIDGES_SHOWN: Final = 20
_NAMES_SHOWN: Final = 20
_RULE_MAX: Final = 200
"""Letters of a rule that are shown: every page is sent all of it again and again."""


def bridge_views(bridges: Iterable[Bridge]) -> tuple[BridgeView, ...]:
    """Return what pages show of bridges; of the first ones, and of each the first names."""
    return tuple(_view(one) for one in tuple(bridges)[:BRIDGES_SHOWN])


def _view(bridge: Bridge) -> BridgeView:
    settings, rules = bridge.settings, bridge.rules
    withheld = tuple(dict.fromkeys(name for _, name in bridge.withheld))
    slowed = settings.slowed if settings else ()
    return BridgeView(
        name=bridge.name,
        version=bridge.version,
        domain=settings.domain if settings else None,
        namespace=settings.namespace if settings else "/",
        node_count=len(bridge.nodes),
        fast_dds_count=len(bridge.fast_dds_nodes),
        hosts=bridge.hosts[:_NAMES_SHOWN],
        state=_state(bridge),
        twin=bridge.twin,
        allows=rules is not None and rules.allows,
        rules=tuple(map(_shortened, rules.texts())) if rules else (),
        withheld=withheld[:_NAMES_SHOWN],
        withheld_count=len(withheld),
        slowed=tuple(
            SlowedTopics(topics=_shortened(topics), rate_hz=rate_hz)
            for topics, rate_hz in slowed[:_NAMES_SHOWN]
        ),
        localhost_only=settings is not None and settings.localhost_only,
    )


def _shortened(rule: str) -> str:
    return rule if len(rule) <= _RULE_MAX else f"{rule[: _RULE_MAX - 1]}…"


def _state(bridge: Bridge) -> BridgeState:
    if not bridge.is_used:
        return "other_domain"
    if bridge.nodes or bridge.ends:
        return "used"
    return "twin" if bridge.twin else "empty"
