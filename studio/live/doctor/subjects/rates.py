"""Rates: sensors that are silent, and topics that come more seldom than they did."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.live.doctor.seen import NAMED_MAX, Looked, short, shown_nodes
from studio.protocol.doctor import Concern, Finding, Talk
from studio.ros.qos import DurabilityPolicy

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.live.doctor.seen import HeardTopic, Seen, System
    from studio.protocol.doctor import SubjectName

SUBJECT: Final[SubjectName] = "rates"
_NEVER_HEARD_S: Final = 2.5
"""A sensor that is published has said something by then."""
_SENSORS: Final = frozenset({"sensor_msgs"})
_STREAMS: Final = frozenset(
    {"nav_msgs/msg/Odometry", "tf2_msgs/msg/TFMessage", "rosgraph_msgs/msg/Clock"}
)
_SELDOM: Final = frozenset(
    {"sensor_msgs/msg/CameraInfo", "sensor_msgs/msg/JoyFeedback", "sensor_msgs/msg/Joy"}
)


def looked_at(seen: Seen) -> Looked | None:
    """The topics that were listened to, and for how long."""
    if seen.heard is None:
        return None
    more = f", {seen.heard.left_out} more not" if seen.heard.left_out else ""
    return Looked(len(seen.heard.topics), f"listened for {seen.heard.listened_s:.0f} s{more}")


def findings(seen: Seen) -> Iterator[Finding]:
    """Find topics that do not come as they should."""
    if seen.heard is None or seen.system is None:
        return
    for one in seen.heard.topics.values():
        yield from _of_topic(one, seen.system)


def _is_sensor(type_name: str) -> bool:
    """Whether messages of a type come all the time."""
    is_stream = type_name.partition("/")[0] in _SENSORS or type_name in _STREAMS
    return is_stream and type_name not in _SELDOM


def _of_topic(topic: HeardTopic, system: System) -> Iterator[Finding]:
    pace, name = topic.pace, short(topic.topic)
    if pace is None:
        return
    if topic.samples == 0:
        if _is_sensor(topic.type_name) and topic.listened_s >= _NEVER_HEARD_S:
            yield _silent(
                topic,
                system,
                f"{name} has a publisher, and nothing came in {topic.listened_s:.0f} s: look "
                "whether its driver runs and has its device.",
            )
    elif pace.is_silent and pace.silent_s is not None:
        yield _silent(
            topic,
            system,
            f"Nothing has come on {name} for {pace.silent_s:.0f} s, and it came "
            f"{pace.usual_hz:.3g} times a second before.",
        )
    elif pace.is_slow:
        yield Finding(
            code="slow-topic",
            level="warn",
            subject=SUBJECT,
            sentence=(
                f"{name} comes {pace.recent_hz:.3g} times a second, and came {pace.usual_hz:.3g} "
                "times until a moment ago: its node or the network is busy."
            ),
            evidence=(
                f"{pace.usual_hz:.4g} Hz is usual, {pace.recent_hz:.4g} Hz of late",
                f"{topic.samples} samples came in {topic.listened_s:.0f} s",
            ),
            line=f"ros2 topic hz {name}",
            about=(Concern(kind="topic", name=topic.topic),),
        )


def _silent(topic: HeardTopic, system: System, sentence: str) -> Finding:
    ends = system.topics.get(topic.topic)
    senders = ends.senders if ends else ()
    receivers = ends.receivers if ends else ()
    offers = [
        f"{short(one.node.path)} publishes {short(one.type_name)}" for one in senders[:NAMED_MAX]
    ]
    latched = any(one.qos.durability is DurabilityPolicy.TRANSIENT_LOCAL for one in senders)
    return Finding(
        code="silent-topic",
        level="note" if latched else "warn",
        subject=SUBJECT,
        sentence=sentence,
        evidence=(*offers, f"{topic.samples} samples came in {topic.listened_s:.0f} s"),
        line=f"ros2 topic hz {short(topic.topic)}",
        about=(Concern(kind="topic", name=topic.topic),),
        talk=Talk(
            sources=shown_nodes(senders),
            name=short(topic.topic),
            targets=shown_nodes(receivers),
            meets=False,
        ),
    )
