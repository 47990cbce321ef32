"""Pictures of the 3D view, compared as an eye does."""

from __future__ import annotations

import io
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image

_SEEN_LEVELS = 16
"""Of 255, in any colour: less is how one machine rounds differently from another."""
_SEEN_SHARE = 5e-4
"""Of all pixels: fewer are an edge that the camera, coming to rest, left by a hair."""


def differing(first: bytes, second: bytes) -> np.ndarray:
    """Which pixels of two PNGs an eye could tell apart, [H, W] bool; all if the sizes differ."""
    if first == second:
        return np.zeros((1, 1), bool)
    one, other = (_levels(png) for png in (first, second))
    if one.shape != other.shape:
        return np.ones((1, 1), bool)
    return np.any(abs(one - other) > _SEEN_LEVELS, axis=2, keepdims=False)


def look_the_same(first: bytes, second: bytes) -> bool:
    """Whether no part of one picture looks different in the other."""
    return bool(differing(first, second).mean() < _SEEN_SHARE)


def difference_words(first: bytes, second: bytes) -> str:
    """How much differs, where, and where both pictures were put to be looked at."""
    folder = Path(tempfile.mkdtemp(prefix="studio-pictures-"))
    (folder / "first.png").write_bytes(first)
    (folder / "second.png").write_bytes(second)
    marks = differing(first, second)
    sizes = " and ".join("x".join(map(str, _levels(png).shape[1::-1])) for png in (first, second))
    rows, columns = (np.flatnonzero(marks.any(axis=axis)) for axis in (1, 0))
    place = f"x {columns[[0, -1]]}, y {rows[[0, -1]]}" if rows.size else "nowhere"
    return f"{marks.mean():.2%} of the pixels differ, at {place}; {sizes} pixels, in {folder}"


def _levels(png: bytes) -> np.ndarray:
    with Image.open(io.BytesIO(png)) as image:
        return np.asarray(image.convert("RGB"), np.int16)
