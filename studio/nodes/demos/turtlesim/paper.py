"""Paper: what the turtles have drawn on the ground, pixel by pixel."""

from __future__ import annotations

import math

import numpy as np

from studio.nodes.demos.turtlesim.turtle import FIELD_M, Pen

SIZE_PX = 500
_PIXELS_BY_M = (SIZE_PX - 1) / FIELD_M


class Paper:
    """Square of `SIZE_PX` pixels; what nobody drew on shows the background."""

    def __init__(self) -> None:
        self._colors = np.zeros((SIZE_PX, SIZE_PX, 3), dtype=np.uint8)
        self._drawn = np.zeros((SIZE_PX, SIZE_PX), dtype=np.bool_)

    def clear(self) -> None:
        """Wipe all lines."""
        self._drawn[:] = False

    def draw(self, start: tuple[float, float], end: tuple[float, float], pen: Pen) -> None:
        """Draw a straight line between two places, in metres, with round ends."""
        if not pen.is_down or pen.width_px <= 0:
            return
        first, last = _pixel(start), _pixel(end)
        steps = max(1, math.ceil(math.dist(first, last)))
        for column, row in np.linspace(first, last, steps + 1):
            self._dot(round(float(column)), round(float(row)), pen)

    def color_at(self, x: float, y: float) -> tuple[int, int, int] | None:
        """Give the colour that was drawn at a place in metres; None for the background."""
        column, row = (round(value) for value in _pixel((x, y)))
        if not self._drawn[row, column]:
            return None
        red, green, blue = self._colors[row, column].tolist()
        return red, green, blue

    def picture(self, background: tuple[int, int, int]) -> np.ndarray:
        """Give the ground as it looks, shape (SIZE_PX, SIZE_PX, 3), uint8, top row first."""
        return np.where(self._drawn[..., None], self._colors, np.array(background, dtype=np.uint8))

    def _dot(self, column: int, row: int, pen: Pen) -> None:
        low, high = (pen.width_px - 1) // 2, pen.width_px // 2
        rows = slice(max(row - low, 0), row + high + 1)
        columns = slice(max(column - low, 0), column + high + 1)
        self._colors[rows, columns] = pen.color
        self._drawn[rows, columns] = True


def _pixel(place: tuple[float, float]) -> tuple[float, float]:
    """Column and row of a place in metres: y points up, rows go down."""
    return place[0] * _PIXELS_BY_M, (FIELD_M - place[1]) * _PIXELS_BY_M
