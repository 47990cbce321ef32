"""Stamps of the future, of the past and of another kind of time, on data and on /tf."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.live.doctor.seen import Looked, listed, short
from studio.live.doctor.subjects.clocks import set_simulated_time
from studio.live.doctor.subjects.frames import is_placed
from studio.protocol.doctor import Concern, Finding
from studio.ros.qos import DurabilityPolicy

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.live.doctor.seen import Header, HeardClock, HeardFrames, HeardTopic, Seen, System
    from studio.protocol.displays import Mend
    from studio.protocol.doctor import SubjectName
    from studio.tf.report import FrameReport

SUBJECT: Final[SubjectName] = "stamps"
_AHEAD_NS: Final = 200_000_000
_OLD_NS: Final = 10_000_000_000
"""So far back reaches tf2's buffer: nothing older can be placed."""
_APART_NS: Final = 60_000_000_000
"""Simulated and wall time are apart by more than this, or it does not matter."""


def looked_at(seen: Seen) -> Looked | None:
    """The topics whose stamps were read, and the frames of TF."""
    if seen.heard is None:
        return None
    stamped = sum(one.header is not None for one in seen.heard.topics.values())
    return Looked(stamped, f"and {len(seen.heard.frames.reports)} frames")


def findings(seen: Seen) -> Iterator[Finding]:
    """Find stamps with which data cannot be placed."""
    if seen.heard is None:
        return
    for one in seen.heard.topics.values():
        if one.header is not None:
            yield from _of_data(one, one.header, seen.heard.clock, seen.system)
    yield from _of_frames(seen.heard.frames, seen.heard.clock)


def _of_data(
    topic: HeardTopic, header: Header, clock: HeardClock | None, system: System | None
) -> Iterator[Finding]:
    name = short(topic.topic)
    who = header.sender or "its sender"
    if header.stamp_ns == 0 and not is_placed(topic.type_name, topic.topic):
        return
    if header.stamp_ns == 0:
        yield _found(
            "stamp-zero",
            topic,
            f"{name} comes with the time 0: it is drawn where its frame is now. Have {short(who)} "
            "stamp its messages.",
            header,
        )
        return
    if clock is not None and abs(clock.now_ns - clock.received_ns) > _APART_NS:
        by_wall = abs(header.stamp_ns - header.sent_ns) < abs(header.stamp_ns - clock.now_ns)
        if by_wall:
            yield _found(
                "stamp-of-wall-time",
                topic,
                f"{name} is stamped with wall time, and /clock says {clock.now_ns / 1e9:.1f} s: "
                f"set use_sim_time of {short(who)} to true.",
                header,
                set_simulated_time(system, header.sender, value=True) if system else None,
            )
            return
        ahead_ns = header.stamp_ns - clock.now_ns - (header.received_ns - clock.received_ns)
    else:
        # By the sender's own clock: that of its machine is another subject.
        ahead_ns = header.stamp_ns - header.sent_ns
    if ahead_ns > _AHEAD_NS:
        yield _found(
            "stamp-future",
            topic,
            f"{name} is stamped {ahead_ns / 1e9:.3g} s in the future by {short(who)}: TF is not "
            "known there yet, so it waits or is dropped.",
            header,
        )
    elif ahead_ns < -_OLD_NS and not _comes_late(topic, system):
        yield _found(
            "stamp-past",
            topic,
            f"{name} is stamped {-ahead_ns / 1e9:.3g} s in the past by {short(who)}: TF is not "
            "kept so long, so it cannot be placed. A recording wants --clock and use_sim_time.",
            header,
        )


def _comes_late(topic: HeardTopic, system: System | None) -> bool:
    """Whether messages may have waited on DDS: a bridge tells only when it passed them on."""
    ends = system.topics.get(topic.topic) if system else None
    return any(
        one.node.bridge and one.qos.durability is DurabilityPolicy.TRANSIENT_LOCAL
        for one in (ends.senders if ends else ())
    )


def _of_frames(frames: HeardFrames, clock: HeardClock | None) -> Iterator[Finding]:
    now_ns = frames.now_ns
    is_simulated = clock is not None and abs(clock.now_ns - clock.received_ns) > _APART_NS
    if is_simulated and clock is not None:
        now_ns = clock.now_ns + (frames.now_ns - clock.received_ns)
    moving = [
        one
        for one in frames.reports
        if one.parent is not None and not one.static and one.newest_ns > 0 and one.state != "stale"
    ]
    ahead = [one for one in moving if one.newest_ns - now_ns > _AHEAD_NS]
    old = [one for one in moving if now_ns - one.newest_ns > _OLD_NS]
    if ahead:
        yield _of_tf("tf-future", "in the future", ahead, now_ns)
    if old:
        yield _of_tf("tf-past", "in the past", old, now_ns)


def _of_tf(code: str, where: str, reports: list[FrameReport], now_ns: int) -> Finding:
    worst = max(reports, key=lambda one: abs(one.newest_ns - now_ns))
    off_s = abs(worst.newest_ns - now_ns) / 1e9
    publishers = dict.fromkeys(name for one in reports for name in one.publishers if name)
    return Finding(
        code=code,
        level="warn",
        subject=SUBJECT,
        sentence=(
            f"Transforms of {listed(one.frame for one in reports)} are stamped up to {off_s:.3g} s "
            f"{where} by {listed(publishers) or 'their sender'}: data and TF do not meet. Compare "
            "clocks and use_sim_time."
        ),
        evidence=tuple(
            f"{short(one.frame)} in {short(one.parent or '')}: "
            f"{(one.newest_ns - now_ns) / 1e9:+.3f} s"
            for one in reports[:8]
        ),
        about=tuple(Concern(kind="frame", name=one.frame) for one in reports[:3]),
    )


def _found(
    code: str, topic: HeardTopic, sentence: str, header: Header, mend: Mend | None = None
) -> Finding:
    return Finding(
        code=code,
        level="warn",
        subject=SUBJECT,
        sentence=sentence,
        evidence=(
            f"stamped {header.stamp_ns / 1e9:.3f} s, sent {header.sent_ns / 1e9:.3f} s, "
            f"received {header.received_ns / 1e9:.3f} s",
        ),
        mend=mend,
        line=f"ros2 topic delay {short(topic.topic)}",
        about=(Concern(kind="topic", name=topic.topic),),
    )
