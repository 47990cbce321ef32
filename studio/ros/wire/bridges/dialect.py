"""Keys and tokens of zenoh-bridge-ros2dds, written and read as the bridge does.

Source: eclipse-zenoh/zenoh-plugin-ros2dds 1.10, `liveliness_mgt.rs` and `ros2_utils.rs`.
"""

from __future__ import annotations

import re
import struct
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Final, TypeAlias

from studio.errors import AttachmentError, RosNameError, TokenError
from studio.ros.attachment import GID_BYTES, Attachment
from studio.ros.names import (
    action_part,
    check_full_name,
    split_action_part,
    split_type_name,
)
from studio.ros.qos import (
    DEPTH_DEFAULT,
    DurabilityPolicy,
    HistoryPolicy,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_action_status_default,
    qos_profile_services_default,
)
from studio.ros.tokens import EndpointKind, EndpointToken

PROGRAM: Final = "zenoh-bridge-ros2dds"
"""The bridge, as it is started."""
BRIDGES: Final = "@/*/@ros2_lv"
"""The key expression of the token that every bridge shows for itself."""
TOKENS: Final = f"{BRIDGES}/**"
_MARK: Final = "@ros2_lv"
_SLASH: Final = "§"
_TYPE_HASH: Final = "typehash="
_HASH: Final = "RIHS01_"
_HASH_TEXT: Final = re.compile(r"RIHS01_[0-9a-f]{64}")
_ZID: Final = re.compile(r"[0-9a-f]{1,32}")
_DEPTH_MAX: Final = 2**31 - 1
_SEND_GOAL: Final = "send_goal"
_OF_GOALS: Final = "_SendGoal"
_QUERY_MARK: Final = b"rqh"
_QUERY_BYTES: Final = 20


class RouteKind(StrEnum):
    """What a bridge routes, by its letters in a token; of an action all parts at once."""

    PUBLISHER = "MP"
    SUBSCRIPTION = "MS"
    SERVICE = "SS"
    CLIENT = "SC"
    ACTION_SERVER = "AS"
    ACTION_CLIENT = "AC"


Place: TypeAlias = tuple[RouteKind, str]
"""Kind and full name by which bridges know an end; all parts of an action have one."""
_OF_ACTION: Final = {
    EndpointKind.SERVICE: RouteKind.ACTION_SERVER,
    EndpointKind.CLIENT: RouteKind.ACTION_CLIENT,
}


@dataclass(frozen=True, slots=True)
class Route:
    """One route of a bridge, as its token tells it.

    Attributes:
        zid: The Zenoh session of the bridge.
        name: Full, with the bridge's namespace in front.
        type_hash: As the DDS end told it (Iron and later); empty: it did not.
        qos: Of the first DDS end that the bridge found; None of services and actions.
    """

    zid: str
    kind: RouteKind
    name: str
    type_name: str
    type_hash: str = ""
    qos: QoSProfile | None = None


@dataclass(frozen=True, slots=True)
class RouteEnd:
    """A publisher, subscription, service or client, as rmw_zenoh's tokens would show it."""

    kind: EndpointKind
    name: str
    type_name: str
    type_hash: str
    qos: QoSProfile


def bridge_key(name: str) -> str:
    """Return the data key of a topic or service: its full name without the first slash."""
    return name.removeprefix("/")


def parse_bridge_token(token: str) -> str | Route:
    """Read a token: the session of a bridge, or one of its routes.

    Raises:
        TokenError: It is none of a bridge.
    """
    chunks = token.split("/")
    if len(chunks) < 3 or chunks[0] != "@" or chunks[2] != _MARK or not _ZID.fullmatch(chunks[1]):
        raise TokenError(token, "it is no token of a bridge")
    if len(chunks) == 3:
        return chunks[1]
    kind = chunks[3]
    if kind not in set(RouteKind):
        raise TokenError(token, f"a bridge has no routes of the kind {kind[:20]}")
    is_topic = kind in {RouteKind.PUBLISHER, RouteKind.SUBSCRIPTION}
    if len(chunks) != (7 if is_topic else 6):
        raise TokenError(token, "it has too few or too many parts")
    try:
        name = check_full_name("/" + chunks[4].replace(_SLASH, "/"))
        type_name = chunks[5].replace(_SLASH, "/")
        split_type_name(type_name)
    except RosNameError as error:
        raise TokenError(token, str(error).rstrip(".")) from None
    route = Route(chunks[1], RouteKind(kind), name, type_name)
    if not is_topic:
        return route
    qos, told = _parse_qos(token, route.kind, chunks[6])
    return replace(route, qos=qos, type_hash=told)


def _parse_qos(token: str, kind: RouteKind, text: str) -> tuple[QoSProfile, str]:
    """Read `KEY:RELIABILITY:DURABILITY:HISTORY,DEPTH[:USER DATA]`, with the numbers of DDS.

    What is left empty is the default of DDS: writers are reliable, readers best effort.
    """
    fields = text.split(":", 4)
    if len(fields) < 4:
        raise TokenError(token, "its QoS has too few fields")
    _, reliability, durability, history = fields[:4]
    keeps, _, depth = history.partition(",")
    try:
        qos = dds_qos(
            reliable=_number(reliability, int(kind == RouteKind.PUBLISHER)) == 1,
            latched=_number(durability, 0) == 1,
            keep_all=_number(keeps, 0) == 1,
            depth=_number(depth, 1),
        )
    except ValueError:
        raise TokenError(token, "a field of its QoS is no number") from None
    return qos, type_hash_of(fields[4] if len(fields) == 5 else "")


def _number(text: str, default: int) -> int:
    if not text:
        return default
    if not (text.lstrip("-").isascii() and text.lstrip("-").isdigit() and len(text) <= 11):
        raise ValueError(text)
    return int(text)


def dds_qos(*, reliable: bool, latched: bool, keep_all: bool, depth: int) -> QoSProfile:
    """Make a profile of what DDS says; a depth that is not set is 1 there."""
    history = HistoryPolicy.KEEP_ALL if keep_all else HistoryPolicy.KEEP_LAST
    return QoSProfile(
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
        history=history,
        depth=min(max(depth, 1), _DEPTH_MAX) if not keep_all else 0,
    )


def type_hash_of(user_data: str) -> str:
    """Return the hash in the user data of a DDS end; empty without, as before Iron."""
    for pair in user_data.split(";"):
        if pair.startswith(_TYPE_HASH):
            found = pair.removeprefix(_TYPE_HASH)
            return found if _HASH_TEXT.fullmatch(found) else ""
    return ""


def route_ends(route: Route) -> tuple[RouteEnd, ...]:
    """Return what a route stands for: itself, or the parts of an action."""
    if route.kind in {RouteKind.ACTION_SERVER, RouteKind.ACTION_CLIENT}:
        return _action_ends(route)
    kind = EndpointKind(route.kind.value)
    qos = route.qos or qos_profile_services_default
    return (RouteEnd(kind, route.name, route.type_name, route.type_hash, qos),)


def _action_ends(route: Route) -> tuple[RouteEnd, ...]:
    is_server = route.kind is RouteKind.ACTION_SERVER
    asked = EndpointKind.SERVICE if is_server else EndpointKind.CLIENT
    told = EndpointKind.PUBLISHER if is_server else EndpointKind.SUBSCRIPTION
    services, status = qos_profile_services_default, qos_profile_action_status_default
    name = route.type_name
    parts = (
        (asked, _SEND_GOAL, name + _OF_GOALS, services),
        (asked, "cancel_goal", "action_msgs/srv/CancelGoal", services),
        (asked, "get_result", f"{name}_GetResult", services),
        (told, "feedback", f"{name}_FeedbackMessage", QoSProfile(depth=10)),
        (told, "status", "action_msgs/msg/GoalStatusArray", status),
    )
    return tuple(
        RouteEnd(kind, action_part(route.name, part), type_name, "", qos)
        for kind, part, type_name, qos in parts
    )


def place_of(kind: EndpointKind, name: str) -> Place | None:
    """Return kind and name by which bridges know an end; None: another part of its action does."""
    found = split_action_part(name)
    if found is None:
        return RouteKind(kind.value), name
    action, part = found
    return (_OF_ACTION[kind], action) if part == _SEND_GOAL and kind in _OF_ACTION else None


def announcement(end: EndpointToken) -> str | None:
    """Return the token by which bridges make a route to an end of ours; None: it needs none.

    Of an action they expect one for all parts, which its send_goal brings. Of a subscription they
    are told by `subscription_announcement`, once they have a publisher of its topic.
    """
    place = place_of(end.kind, end.name)
    if place is None or end.kind is EndpointKind.SUBSCRIPTION:
        return None
    kind, name = place
    is_of_action = kind in _OF_ACTION.values()
    type_name = end.type_name.removesuffix(_OF_GOALS) if is_of_action else end.type_name
    head = _head(end.node.zid, kind, name, type_name)
    if end.kind in {EndpointKind.SERVICE, EndpointKind.CLIENT}:
        return head
    return f"{head}/{_qos_text(end.qos, end.type_hash)}"


def subscription_announcement(
    zid: str, topic: str, type_name: str, type_hash: str, qos: QoSProfile
) -> str | None:
    """Return the token of a session's subscriptions of a topic; None: a part of an action.

    A bridge reads a topic from DDS as soon as Zenoh has a subscriber of it, but only until the last
    session that it was told of has left. What it was told of before it has a publisher, it reads
    with the QoS of the subscription, which that publisher may not match: so it is told of what it
    has, and with the QoS of the publisher.
    """
    if place_of(EndpointKind.SUBSCRIPTION, topic) is None:
        return None
    head = _head(zid, RouteKind.SUBSCRIPTION, topic, type_name)
    return f"{head}/{_qos_text(qos, type_hash)}"


def _head(zid: str, kind: RouteKind, name: str, type_name: str) -> str:
    mangled = (bridge_key(name).replace("/", _SLASH), type_name.replace("/", _SLASH))
    return "/".join(("@", zid, _MARK, kind, *mangled))


def _qos_text(qos: QoSProfile, type_hash: str) -> str:
    """Write a profile, and the hash, which DDS nodes since Iron look for."""
    reliable = int(qos.reliability is not ReliabilityPolicy.BEST_EFFORT)
    latched = int(qos.durability is DurabilityPolicy.TRANSIENT_LOCAL)
    keep_all = qos.history is HistoryPolicy.KEEP_ALL
    depth = -1 if keep_all else min(qos.depth or DEPTH_DEFAULT, _DEPTH_MAX)
    told = f":{_TYPE_HASH}{type_hash};" if type_hash.startswith(_HASH) else ""
    return f":{reliable}:{latched}:{int(keep_all)},{depth}{told}"


def request_number(attachment: bytes | None) -> Attachment | None:
    """Read who asks, and its number, of what a bridge attaches to a request; None without.

    Raises:
        AttachmentError: It is something else.
    """
    if attachment is None:
        return None
    if len(attachment) != _QUERY_BYTES or not attachment.startswith(_QUERY_MARK):
        raise AttachmentError("it is no request's of a bridge")
    order = "<" if attachment[-1] else ">"
    (sequence,) = struct.unpack_from(f"{order}Q", attachment, 11)
    client = attachment[3:11]
    return Attachment(sequence, 0, client + bytes(GID_BYTES - len(client)))
