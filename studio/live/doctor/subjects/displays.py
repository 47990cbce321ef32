"""Displays of the 3D view that show nothing, or not all: their own remarks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.live.doctor.seen import NAME_MAX, Looked, listed, short
from studio.protocol.displays import Mend
from studio.protocol.doctor import Concern, Finding

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.live.doctor.seen import Heard, Seen, SeenDocument
    from studio.protocol.displays import DisplayState, Remark
    from studio.protocol.doctor import SubjectName

SUBJECT: Final[SubjectName] = "displays"


def looked_at(seen: Seen) -> Looked | None:
    """The displays."""
    return Looked(len(seen.document.displays), "") if seen.document else None


def findings(seen: Seen) -> Iterator[Finding]:
    """Repeat what displays say of themselves."""
    document = seen.document
    if document is None:
        return
    if document.fixed_trouble:
        yield Finding(
            code="fixed-frame",
            level="error",
            subject=SUBJECT,
            sentence=short(document.fixed_trouble, 500),
            evidence=_frames_there(document, seen.heard),
            mend=_draw_elsewhere(document, seen.heard),
            about=(Concern(kind="display", name=""),),
        )
    for display in document.displays:
        if display.state is None:
            continue
        for remark in display.state.remarks:
            if remark.level == "ok":
                continue
            yield Finding(
                code="display",
                level=remark.level,
                subject=SUBJECT,
                sentence=f"{short(display.name)}: {short(remark.sentence, 500)}",
                evidence=_evidence(remark, display.state),
                mend=remark.mend,
                about=(Concern(kind="display", name=display.id),),
            )


def _evidence(remark: Remark, state: DisplayState) -> tuple[str, ...]:
    received = f"{state.received} messages received"
    return (remark.reason, received) if remark.reason else (received,)


def _frames_there(document: SeenDocument, heard: Heard | None) -> tuple[str, ...]:
    """Say what is chosen, and what there would be."""
    roots = heard.frames.roots if heard else ()
    return (
        f"the fixed frame is {short(document.fixed_frame)}",
        f"the robot's root link is {short(document.root)}"
        if document.root
        else "the robot has no link",
        f"roots of /tf: {listed(roots)}" if roots else "no frame came on /tf",
    )


def _draw_elsewhere(document: SeenDocument, heard: Heard | None) -> Mend | None:
    """Choose the robot's own frame; where that is the one in use, the root of most frames."""
    if document.root and document.root != document.fixed_frame:
        return Mend(
            label=f"Draw everything in {document.root}",
            command={"type": "set_fixed_frame", "frame": ""},
        )
    others = [one for one in (heard.frames.roots if heard else ()) if one != document.fixed_frame]
    if not others or len(others[0]) > NAME_MAX:
        return None
    return Mend(
        label=f"Draw everything in {others[0]}",
        command={"type": "set_fixed_frame", "frame": others[0]},
    )
