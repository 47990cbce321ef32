"""Drawings as plain values, to be compared with what is written in a test."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any, cast

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.displays.display import Display
    from studio.displays.drawing import Drawing, Placed, Shape

DIGITS = 5
_OF_DISPLAY = "items"
"""What the display knows its parts by is not seen."""


def plain(shape: Shape) -> dict[str, Any]:
    """What is seen of a shape by its fields, arrays as lists of rounded numbers."""
    seen = (one.name for one in fields(shape) if one.name != _OF_DISPLAY)
    made = {name: _plain(getattr(shape, name)) for name in seen}
    return {"shape": type(shape).__name__, **made}


def shapes_of(drawing: Drawing) -> dict[str, dict[str, Any]]:
    """The shapes of the only group that is drawn."""
    (placed,) = drawing.values()
    return {name: plain(shape) for name, shape in placed.shapes.items()}


_KINDS = {
    **dict.fromkeys(("colors", "pixels", "image", "palette"), np.uint8),
    "faces": np.uint32,
    _OF_DISPLAY: np.intp,
}


def only(display: Display) -> Placed:
    """The only group that a display draws."""
    (placed,) = display.draw(0).values()
    return placed


def said(display: Display) -> list[tuple[str, str | None]]:
    """The level and the reason of all that a display says."""
    return [(one.level, one.reason) for one in display.statuses()]


def assert_drawable(drawing: Drawing) -> None:
    """Every array is of the kind that its shape promises, and of finite numbers."""
    for placed in drawing.values():
        for shape in placed.shapes.values():
            for one in fields(shape):
                _check(one.name, getattr(shape, one.name))


def _check(name: str, value: Any) -> None:  # noqa: ANN401 - a field of a shape
    if not isinstance(value, np.ndarray):
        assert not isinstance(value, float) or np.isfinite(value), name
        return
    array = cast("NDArray[Any]", value)
    assert array.dtype == _KINDS.get(name, np.float32), name
    assert np.isfinite(array).all(), name
    if name == "wxyz":
        np.testing.assert_allclose(np.linalg.norm(array, axis=1), 1.0, atol=1e-5)


def _plain(value: Any) -> object:  # noqa: ANN401 - a field of a shape
    if isinstance(value, np.ndarray):
        array = cast("NDArray[Any]", value).astype(np.float64)
        # Adding 0 makes of -0.0 the zero that one writes.
        return (np.round(array, DIGITS) + 0.0).tolist()
    return round(value, DIGITS) if isinstance(value, float) else value
