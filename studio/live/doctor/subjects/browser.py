"""The browser that asks: one that draws by software is slow with large scenes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.live.doctor.seen import Looked, short
from studio.protocol.doctor import Concern, Finding

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.live.doctor.seen import Seen
    from studio.protocol.doctor import SubjectName

SUBJECT: Final[SubjectName] = "browser"


def looked_at(seen: Seen) -> Looked | None:
    """What draws the 3D view."""
    if seen.browser is None or not seen.browser.renderer:
        return None
    return Looked(1, short(seen.browser.renderer))


def findings(seen: Seen) -> Iterator[Finding]:
    """Find a browser without a graphics card."""
    if seen.browser is not None and seen.browser.draws_by_software:
        yield Finding(
            code="software-drawing",
            level="note",
            subject=SUBJECT,
            sentence=(
                "This browser draws 3D by software, so large scenes move slowly: switch on "
                "hardware acceleration in its settings, or use another browser."
            ),
            evidence=(short(seen.browser.renderer) or "the browser does not name its renderer",),
            about=(Concern(kind="graphics", name=""),),
        )
