"""Displays of the 3D view that show nothing, or not all: their own remarks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.live.doctor.seen import Looked, short
from studio.protocol.doctor import Concern, Finding

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.live.doctor.seen import Seen
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
            about=(Concern(kind="display", name=""),),
        )
    for display in document.displays:
        for remark in display.state.remarks if display.state else ():
            if remark.level == "ok":
                continue
            yield Finding(
                code="display",
                level=remark.level,
                subject=SUBJECT,
                sentence=f"{short(display.name)}: {short(remark.sentence, 500)}",
                evidence=(remark.reason,) if remark.reason else (),
                mend=remark.mend,
                about=(Concern(kind="display", name=display.id),),
            )
