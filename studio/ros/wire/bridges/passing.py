"""What bridges to DDS have no route for, although a session announced it: they are asked."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final

from studio.ros.wire.bridges.admin import Bounds, admin_key, read_routes
from studio.ros.wire.bridges.bridges import ANSWER_TIMEOUT_S
from studio.ros.wire.zenoh import all_admin_answers

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from studio.ros.wire.bridges.dialect import Place
    from studio.ros.wire.zenoh import Session

_LOOKS: Final = 4
_ASKS_S: Final = 10.0
"""So long all bridges together are asked: of those that are left nothing is known."""
_ON_ITS_WAY_S: Final = 0.5
"""A bridge makes a route within a second after an end was announced."""


def missing_routes(
    zenoh: Session, wanted: Mapping[str, Collection[Place]]
) -> dict[str, list[Place]]:
    """Return what bridges do not pass on for a session.

    Bridges are asked again until a route that is on its way had its time, which takes some
    seconds: call it in a thread.

    Args:
        zenoh: The session.
        wanted: By bridge, what the session has and DDS nodes have the other end of.

    Returns:
        What is left of it; nothing of bridges that do not answer, of which nothing is known.
    """
    missing = {bridge: list(places) for bridge, places in wanted.items()}
    end_s = time.monotonic() + _ASKS_S
    for look in range(_LOOKS):
        if not missing:
            break
        if look:
            time.sleep(_ON_ITS_WAY_S)
        missing = _without_route(zenoh, missing, end_s)
    return missing


def _without_route(
    zenoh: Session, wanted: Mapping[str, Collection[Place]], end_s: float
) -> dict[str, list[Place]]:
    found: dict[str, list[Place]] = {}
    own, bounds = str(zenoh.info.zid()), Bounds()
    for bridge, places in wanted.items():
        left_s = end_s - time.monotonic()
        if left_s <= 0:
            break
        answers, is_whole = all_admin_answers(
            zenoh,
            admin_key(bridge, "route/**"),
            min(ANSWER_TIMEOUT_S, left_s),
            most=bounds.answers,
            most_bytes=bounds.bytes,
        )
        routed = read_routes(answers, own)
        left = [place for place in places if place not in routed]
        if answers and is_whole and left:  # else nothing is known of it
            found[bridge] = left
    return found
