"""Frames: named and not there, with two authors, in a circle, or in trees that nothing connects."""

from __future__ import annotations

import shlex
from collections import Counter, defaultdict
from typing import TYPE_CHECKING, Final

from studio.displays.catalogue import displays_of_type
from studio.live.doctor.seen import Looked, listed, short
from studio.protocol.doctor import Concern, Finding, Talk
from studio.tf.transforms import plain_name

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.live.doctor.seen import Heard, HeardFrames, HeardTopic, Seen
    from studio.protocol.doctor import Level, SubjectName
    from studio.tf.transforms import Kind, Notice

SUBJECT: Final[SubjectName] = "frames"
_HEARD_S: Final = 1.0
"""Before that, a frame that is not known may just not have come yet."""
_OF_NOTICES: Final[dict[Kind, tuple[str, Level]]] = {
    "circle": ("frame-circle", "error"),
    "own_parent": ("frame-circle", "error"),
    "other_parent": ("two-parents", "warn"),
    "too_old": ("tf-too-old", "warn"),
    "time_jumped": ("time-jumped", "note"),
    "moved": ("frame-moved", "note"),
}
_NOWHERE: Final = frozenset({"sensor_msgs/msg/JointState", "sensor_msgs/msg/Joy"})
"""Their header has a stamp, and mostly no frame."""
_BAD: Final = ("bad-transform", "warn")


def looked_at(seen: Seen) -> Looked | None:
    """The frames, and their trees."""
    if seen.heard is None:
        return None
    frames = seen.heard.frames
    trees = len(frames.roots)
    told = "1 tree" if trees == 1 else f"{trees} trees"
    return Looked(len(frames.reports) + frames.more, told if trees else "")


def findings(seen: Seen) -> Iterator[Finding]:
    """Find frames that are not as they should be."""
    if seen.heard is None:
        return
    frames = seen.heard.frames
    links = seen.document.links if seen.document else frozenset[str]()
    yield from _missing(seen.heard, links)
    yield from _two_authors(frames)
    yield from _of_notices(frames)
    yield from _trees(frames)


def _missing(heard: Heard, links: frozenset[str]) -> Iterator[Finding]:
    """Frames that headers of data name, and that no transform names nor the robot has."""
    frames = heard.frames
    if heard.listened_s < _HEARD_S or frames.more:
        return
    known = {one.frame for one in frames.reports} | links
    by_frame: dict[str, list[str]] = defaultdict(list)
    for one in heard.topics.values():
        if one.header is not None and is_placed(one.type_name, one.topic):
            by_frame[plain_name(one.header.frame)].append(one.topic)
    for frame, topics in by_frame.items():
        if frame in known:
            continue
        about = tuple(Concern(kind="topic", name=one) for one in topics[:3])
        if not frame:
            yield Finding(
                code="frame-unnamed",
                level="warn",
                subject=SUBJECT,
                sentence=(
                    f"{listed(topics)}: no frame is named in the header, so nobody knows where "
                    "it belongs."
                ),
                evidence=tuple(_header_of(heard.topics[one]) for one in topics[:8]),
                about=about,
            )
            continue
        yield Finding(
            code="frame-missing",
            level="warn",
            subject=SUBJECT,
            sentence=(
                f"The frame {short(frame)}, which the header of {listed(topics)} names, is in no "
                "transform: publish one that leads there."
            ),
            evidence=(
                f"{len(known)} frames are known" + (f": {listed(sorted(known))}" if known else ""),
            ),
            line=(
                "ros2 run tf2_ros static_transform_publisher --frame-id base_link "
                f"--child-frame-id {shlex.quote(short(frame))}"
            ),
            about=(*about, Concern(kind="frame", name=frame)),
            talk=Talk(
                sources=(), name=short(frame), targets=tuple(map(short, topics[:6])), meets=False
            ),
        )


def _header_of(topic: HeardTopic) -> str:
    sender = topic.header.sender if topic.header else ""
    by = f" by {short(sender)}" if sender else ""
    return f'{short(topic.topic)}: {short(topic.type_name)}{by} with frame_id ""'


def is_placed(type_name: str, topic: str) -> bool:
    """Whether messages of a type are drawn somewhere, so that their frame matters."""
    return type_name not in _NOWHERE and any(displays_of_type(type_name, topic))


def _two_authors(frames: HeardFrames) -> Iterator[Finding]:
    both: dict[tuple[str, ...], list[str]] = defaultdict(list)
    for one in frames.reports:
        authors = tuple(sorted({name for name in one.publishers if name}))
        if len(authors) > 1:
            both[authors].append(one.frame)
    for authors, names in both.items():
        yield Finding(
            code="two-authors",
            level="warn",
            subject=SUBJECT,
            sentence=(
                f"{listed(authors)} publish the transform of {listed(names)}: it jumps between "
                "them. Keep one."
            ),
            evidence=tuple(f"{short(one)}: by {listed(authors)}" for one in names[:8]),
            about=tuple(Concern(kind="frame", name=one) for one in names[:3]),
            talk=Talk(
                sources=tuple(map(short, authors[:6])), name=short(names[0]), targets=(), meets=True
            ),
        )


def _of_notices(frames: HeardFrames) -> Iterator[Finding]:
    """What the buffer left out, a finding for each kind and frame."""
    groups: dict[tuple[str, str], list[Notice]] = defaultdict(list)
    for one in frames.notices:
        code, _ = _OF_NOTICES.get(one.kind, _BAD)
        groups[code, one.child].append(one)
    for (code, child), same in groups.items():
        _, level = _OF_NOTICES.get(same[-1].kind, _BAD)
        yield Finding(
            code=code,
            level=level,
            subject=SUBJECT,
            sentence=short(same[-1].sentence, 500),
            evidence=tuple(
                f"from {short(one.publisher)}: {short(one.child)} in {short(one.parent)}"
                for one in same[:8]
            ),
            about=(
                Concern(kind="frame", name=child) if child else Concern(kind="topic", name="/tf"),
            ),
        )


def _trees(frames: HeardFrames) -> Iterator[Finding]:
    if len(frames.roots) < 2:
        return
    count, sizes = len(frames.roots), Counter(one.root for one in frames.reports)
    yield Finding(
        code="several-trees",
        level="warn",
        subject=SUBJECT,
        sentence=(
            f"Frames are in {count} trees that no transform connects, with the roots "
            f"{listed(frames.roots)}: what is in one cannot be drawn in another."
        ),
        evidence=tuple(f"{short(one)}: frames {sizes[one]}" for one in frames.roots[:8]),
        about=tuple(Concern(kind="frame", name=one) for one in frames.roots[:3]),
    )
