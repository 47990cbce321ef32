"""The join address as a QR code, for a projector and for a terminal."""

from __future__ import annotations

import io
from functools import lru_cache


@lru_cache(maxsize=4)
def qr_svg(address: str) -> str:
    """Return the code as an SVG picture, dark on white with the quiet zone that readers need."""
    import segno  # noqa: PLC0415 - only who shares needs it

    drawn = io.BytesIO()
    code = segno.make(address, error="m", micro=False)
    code.save(drawn, kind="svg", border=4, dark="#000", light="#fff", omitsize=True, xmldecl=False)
    return drawn.getvalue().decode().strip()


def qr_lines(address: str) -> str:
    """Return the code in half blocks, for a terminal whose ground is dark or light."""
    import segno  # noqa: PLC0415 - only who shares needs it

    drawn = io.StringIO()
    segno.make(address, error="l", micro=False).terminal(drawn, border=2, compact=True)
    return drawn.getvalue()
