"""Why a display shows nothing: one sentence, and one click that mends it where one does."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.errors import ExtrapolationError, UnconnectedFramesError, UnknownFrameError
from studio.protocol.displays import Mend, Remark

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.displays.display import Status
    from studio.errors import FrameError
    from studio.live.displays.display_list import DisplaySpec
    from studio.live.topics.request import StateKind, SubscriptionState

_REASONS: Final[dict[StateKind, str]] = {"refused": "not_heard", "other_form": "other_hash"}
_SHOWN_MAX: Final = 6
_FRAMES_MAX: Final = 3
"""So many frames are named: a robot has many links, and other faults matter, too."""


@dataclass(frozen=True, slots=True)
class Facts:
    """What is known of a display that may show nothing.

    Attributes:
        spec: Its settings.
        topic: State of its subscription.
        shown: Whether it and the groups around it are switched on.
        hidden_by: The outermost of these groups that is not.
        types: Message types that it shows; empty: it subscribes to no topic.
        fitting_kind: The display that shows what is published on the topic; empty: none.
        instead: A published topic that would fit; empty: there is none.
        received: Number of messages received.
        silent_s: Time since the last one, when that is longer than usual.
        frames: Why parts of the drawing have no pose.
        frame: A fixed frame in which the first of them would have a pose; empty: none.
        stamp_zero: Whether messages have no stamp.
        statuses: Reported by the display itself.
        draws: Whether any of it is on screen.
        waits: Whether a message waits for its transforms.
    """

    spec: DisplaySpec
    topic: SubscriptionState
    shown: bool = True
    hidden_by: str = ""
    types: tuple[str, ...] = ()
    fitting_kind: str = ""
    instead: str = ""
    received: int = 0
    silent_s: float | None = None
    frames: tuple[FrameError, ...] = ()
    frame: str = ""
    stamp_zero: bool = False
    statuses: tuple[Status, ...] = ()
    draws: bool = False
    waits: bool = False


def remarks_on(facts: Facts) -> tuple[Remark, ...]:
    """Return the remarks to show, the most pressing first; one of level "ok" when all is well."""
    found = list(_remarks(facts))[:_SHOWN_MAX]
    if not found and facts.shown and not facts.waits:
        return (_well(facts),)
    return tuple(found)


def _well(facts: Facts) -> Remark:
    """Return the remark of a display without problems."""
    if facts.draws:
        return Remark(level="ok", reason="", sentence="Shown.")
    if facts.received:
        what = f"Messages come on {facts.spec.topic}, and there is nothing in them to draw."
    else:
        what = "There is nothing to draw."
    return _warn("empty", what)


def _remarks(facts: Facts) -> Iterator[Remark]:
    if not facts.shown:
        yield from _hidden(facts)
        return
    if facts.types and (silence := _silence(facts)):
        yield silence
        if facts.received == 0:
            return
    for error in facts.frames[:_FRAMES_MAX]:
        yield _remark_on_frame(error, facts.frame)
    if (more := len(facts.frames) - _FRAMES_MAX) > 0:
        yield _error("no_frame", f"{more:,} more of its frames have no place in the fixed frame.")
    if facts.stamp_zero:
        yield _warn(
            "stamp_zero",
            "Messages come with the time 0, so they are drawn where their frame is now: "
            "have the publisher stamp them.",
        )
    for status in facts.statuses:
        yield _own_remark(facts, status)


def _own_remark(facts: Facts, status: Status) -> Remark:
    mend = _of_property(facts.spec, *status.mend) if status.mend else None
    if status.reason == "not_connected_frame" and facts.frame:
        mend = _drawn_in(facts.frame)
    return Remark(
        level=status.level, reason=status.reason or "", sentence=status.sentence, mend=mend
    )


def _hidden(facts: Facts) -> Iterator[Remark]:
    if not facts.spec.enabled:
        return
    group = facts.hidden_by
    yield _warn(
        "group_off",
        f'The group "{group}" is hidden as a whole.',
        Mend(
            label=f"Show {group}",
            command={"type": "switch_displays", "group": group, "enabled": True},
        ),
    )


def _silence(facts: Facts) -> Remark | None:
    """Why no message comes, or none that can be shown."""
    spec, state = facts.spec, facts.topic
    if not spec.topic:
        sentence = f"{spec.kind} listens to no topic yet: choose one."
        return _warn("no_topic", sentence, _other_topic(facts))
    if state.kind == "receiving":
        return _no_message(facts)
    if state.kind == "other_type":
        return _other_type(facts)
    mend = None
    if state.kind == "not_connected":
        mend = Mend(label="Connect", command={"type": "connect_wire"})
    elif state.kind == "no_publisher":
        mend = _other_topic(facts)
        if facts.received > 0 and state.is_live:
            gone = (
                f"Nobody publishes {spec.topic} any more: what came last stays until somebody does."
            )
            return _warn("no_publisher", gone, mend)
    return _error(_REASONS.get(state.kind, state.kind), state.sentence, mend)


def _other_topic(facts: Facts) -> Mend | None:
    """Listen to one that is there."""
    if not facts.instead:
        return None
    return Mend(
        label=f"Listen to {facts.instead}",
        command={
            "type": "set_display_topic",
            "display": facts.spec.id,
            "topic": facts.instead,
        },
    )


def _other_type(facts: Facts) -> Remark:
    spec, published = facts.spec, ", ".join(facts.topic.types)
    sentence = f"{spec.topic} is published as {published}, and {spec.kind} shows {facts.types[0]}."
    if not facts.fitting_kind:
        return _error("other_type", f"{sentence} Choose another topic.")
    command: dict[str, bool | int | float | str] = {
        "type": "add_display",
        "kind": facts.fitting_kind,
        "topic": spec.topic,
    }
    return _error(
        "other_type", sentence, Mend(label=f"Add a {facts.fitting_kind} for it", command=command)
    )


def _no_message(facts: Facts) -> Remark | None:
    if facts.received == 0:
        return _warn("no_message", f"No message has come on {facts.spec.topic} yet.")
    if facts.silent_s is not None:
        return _warn(
            "silent", f"The last message on {facts.spec.topic} came {facts.silent_s:.0f} s ago."
        )
    return None


def _remark_on_frame(error: FrameError, frame: str) -> Remark:
    if isinstance(error, UnconnectedFramesError) and error.nearest:
        return _error("not_connected_frame", str(error), _drawn_in(error.nearest))
    mend = _drawn_in(frame) if frame else None
    if isinstance(error, ExtrapolationError):
        return _error("stamp_out_of_buffer", str(error), mend)
    if isinstance(error, UnknownFrameError) and not error.frame:
        return _error(
            "no_frame_id",
            "Messages come without a frame: have the publisher fill in frame_id of their header.",
        )
    return _error("no_frame", str(error), mend)


def _drawn_in(frame: str) -> Mend:
    return Mend(
        label=f"Draw everything in {frame}", command={"type": "set_fixed_frame", "frame": frame}
    )


def _of_property(spec: DisplaySpec, name: str, value: bool | float | str) -> Mend:  # noqa: FBT001
    return Mend(
        label=_label(name, value),
        command={
            "type": "set_display_property",
            "display": spec.id,
            "name": name,
            "value": value,
        },
    )


def _label(name: str, value: bool | float | str) -> str:  # noqa: FBT001
    if isinstance(value, bool):
        return f"Switch {'on' if value else 'off'} {name}"
    if value == "":
        return f"Clear {name}"
    return f"Set {name} to {value:g}" if isinstance(value, float) else f"Set {name} to {value}"


def _warn(reason: str, sentence: str, mend: Mend | None = None) -> Remark:
    return Remark(level="warn", reason=reason, sentence=sentence, mend=mend)


def _error(reason: str, sentence: str, mend: Mend | None = None) -> Remark:
    return Remark(level="error", reason=reason, sentence=sentence, mend=mend)
