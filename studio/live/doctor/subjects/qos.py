"""QoS: what DDS does not match, or would not though Zenoh carries it; promises nobody watches."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Final

from studio.live.doctor.seen import NAMED_MAX, Looked, Written, short
from studio.protocol.doctor import Concern, Finding, Talk
from studio.ros.qos import DurabilityPolicy, qos_text, why_unmatched

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.live.doctor.seen import Ends, Heard, Seen
    from studio.protocol.doctor import Level, SubjectName
    from studio.ros.graph.endpoints import GraphEndpoint

SUBJECT: Final[SubjectName] = "qos"
_KINDS_MAX: Final = 20
"""Different profiles of one side that are compared."""
_LATE_SHARE: Final = 1.2
"""A message may be so much later than its deadline before that is said."""


def looked_at(seen: Seen) -> Looked | None:
    """The topics with both sides."""
    if seen.system is None:
        return None
    both = sum(bool(one.senders and one.receivers) for one in seen.system.topics.values())
    return Looked(both, "")


def findings(seen: Seen) -> Iterator[Finding]:
    """Find profiles that do not go together, topic by topic."""
    if seen.system is None:
        return
    written = Written()
    announcing = seen.answers.announcing if seen.answers else frozenset[str]()
    for name, ends in seen.system.topics.items():
        if ends.senders and ends.receivers:
            yield from _unmatched(name, ends, written, seen.system.own | announcing)
        if ends.senders:
            yield from _on_the_wire(name, ends, seen.heard)


def _unmatched(
    name: str, ends: Ends, written: Written, announcing: frozenset[str]
) -> Iterator[Finding]:
    is_bridged = any(one.node.bridge for one in (*ends.senders, *ends.receivers))
    met = announcing if is_bridged else frozenset[str]()
    for publisher in _of_each_kind(ends.senders, met):
        for subscription in _of_each_kind(ends.receivers, met):
            if publisher.type_name != subscription.type_name:
                continue
            code = _way(publisher, subscription, announcing)
            if not code:
                continue
            for reason in why_unmatched(publisher.qos, subscription.qos):
                yield written(
                    code, partial(_would_not_match, code, name, reason, publisher, subscription)
                )


def _way(publisher: GraphEndpoint, subscription: GraphEndpoint, announcing: frozenset[str]) -> str:
    """Return the code of profiles that do not match on their way; empty: nothing comes of it.

    There may be no way at all, and of what we subscribe to bridges are told with the profile of
    the publisher on DDS.
    """
    zids = publisher.node.zid, subscription.node.zid
    on_dds = [bool(one.node.bridge) for one in (publisher, subscription)]
    if not any(on_dds):
        return "qos"
    if all(on_dds):
        return "qos-on-dds" if zids[0] == zids[1] else "qos-through-bridge"
    return "qos-through-bridge" if on_dds[1] and zids[0] in announcing else ""


_WAYS: Final[dict[str, tuple[Level, str]]] = {
    "qos": ("warn", "Zenoh carries it, DDS would not."),
    "qos-on-dds": ("error", "both are on DDS, so not a single message comes."),
    "qos-through-bridge": (
        "warn",
        "a bridge to DDS has the profile of the end that it met first, so that it comes or not by "
        "which one was started first. Give both the same.",
    ),
}
"""By the way between two ends: how grave it is, and what becomes of messages."""


def _would_not_match(
    code: str, name: str, reason: str, publisher: GraphEndpoint, subscription: GraphEndpoint
) -> Finding:
    source, target = short(publisher.node.path), short(subscription.node.path)
    level, outcome = _WAYS[code]
    return Finding(
        code=code,
        level=level,
        subject=SUBJECT,
        sentence=f"{short(name)}: {reason} ({source} to {target}); {outcome}",
        evidence=(
            f"{source} offers {_profile(publisher)}",
            f"{target} asks for {_profile(subscription)}",
        ),
        line=f"ros2 topic info -v {short(name)}",
        about=(Concern(kind="topic", name=name),),
        talk=Talk(
            sources=(source,), name=short(name), targets=(target,), meets=code != "qos-on-dds"
        ),
    )


def _on_the_wire(name: str, ends: Ends, heard: Heard | None) -> Iterator[Finding]:
    """What rmw_zenoh does not do of a profile, and what a publisher promised and does not keep."""
    # Nodes on DDS are watched by DDS, and a bridge may slow a topic down.
    kinds = (one for one in _of_each_kind(ends.senders) if not one.node.bridge)
    promised = [one for one in kinds if _promises(one)]
    topic = heard.topics.get(name) if heard else None
    rate_hz = topic.pace.recent_hz if topic and topic.pace else 0.0
    for one in promised[:NAMED_MAX]:
        deadline_s = one.qos.deadline.nanoseconds / 1e9
        if deadline_s and rate_hz and len(ends.senders) == 1 and (
            1 / rate_hz > deadline_s * _LATE_SHARE
        ):  # fmt: skip
            yield Finding(
                code="deadline-missed",
                level="warn",
                subject=SUBJECT,
                sentence=(
                    f"{short(one.node.path)} promises {short(name)} every {deadline_s:g} s at the "
                    f"latest, and it comes every {1 / rate_hz:.3g} s: nobody is told over Zenoh."
                ),
                evidence=(
                    f"{short(one.node.path)} offers {_profile(one)}",
                    f"{rate_hz:.3g} messages a second came",
                ),
                about=(Concern(kind="topic", name=name),),
            )
            return
    if promised:
        what = sorted({policy for one in promised for policy in _promises(one)})
        yield Finding(
            code="qos-not-watched",
            level="note",
            subject=SUBJECT,
            sentence=(
                f"{short(name)} is published with {' and '.join(what)}, which rmw_zenoh passes on "
                "and does not watch: no event comes when it is missed."
            ),
            evidence=tuple(f"{short(one.node.path)}: {_profile(one)}" for one in promised[:8]),
            about=(Concern(kind="topic", name=name),),
        )


def _promises(end: GraphEndpoint) -> list[str]:
    """Return the policies of a publisher that only DDS keeps; /rosout has a lifespan everywhere."""
    qos = end.qos
    found = ["a deadline"] if qos.deadline.nanoseconds else []
    if qos.liveliness_lease_duration.nanoseconds:
        found.append("a liveliness lease")
    is_latched = qos.durability is DurabilityPolicy.TRANSIENT_LOCAL
    if qos.lifespan.nanoseconds and not is_latched:
        found.append("a lifespan")
    return found


def _of_each_kind(
    ends: Iterable[GraphEndpoint], announcing: frozenset[str] = frozenset()
) -> list[GraphEndpoint]:
    """Return one endpoint of each type, profile and way: thousands have the same of /rosout.

    Args:
        ends: All of one side.
        announcing: Sessions that bridges to DDS hear of, which is a way of their own.
    """
    kinds: dict[tuple[str, str, str], GraphEndpoint] = {}
    for one in ends:
        if len(kinds) >= _KINDS_MAX:
            break
        way = one.node.zid if one.node.bridge or one.node.zid in announcing else ""
        kinds.setdefault((one.type_name, qos_text(one.qos), way), one)
    return list(kinds.values())


def _profile(end: GraphEndpoint) -> str:
    qos = end.qos
    words = [
        qos.reliability.name.lower().replace("_", " "),
        qos.durability.name.lower().replace("_", " "),
        f"depth {qos.depth}",
    ]
    spans = ("deadline", qos.deadline), ("lifespan", qos.lifespan), (
        "lease", qos.liveliness_lease_duration,
    )  # fmt: skip
    words += [f"{name} {span.nanoseconds / 1e9:g} s" for name, span in spans if span.nanoseconds]
    return ", ".join(words)
