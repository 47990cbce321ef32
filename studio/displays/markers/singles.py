"""Texts and meshes of markers, which are a shape each."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from studio.displays.drawing import MeshFile, Text
from studio.displays.markers.colours import alphas_of, colors_of
from studio.displays.markers.kinds import Kind

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.displays.drawing import Rgb, Shape, Xyz
    from studio.displays.markers.table import Rows


def singles_of(markers: Rows) -> dict[str, Shape]:
    """Texts and meshes by name."""
    shapes: dict[str, Shape] = dict(_texts(markers.of_types(Kind.TEXT)))
    shapes.update(_meshes(markers.of_types(Kind.MESH)))
    return shapes


def _texts(markers: Rows) -> Iterator[tuple[str, Text]]:
    """Words as high as scale.z, centred on the marker; how it is turned means nothing."""
    heights_m: list[float] = np.abs(markers.scales[:, 2]).tolist()
    rows: list[int] = markers.rows.tolist()
    for row, words, (xyz, rgb, opacity), height_m in zip(
        rows, markers.words, _looks(markers), heights_m, strict=True
    ):
        if height_m and opacity and words.strip():
            yield f"text-{row}", Text(words, xyz, height_m, rgb, opacity)


def _meshes(markers: Rows) -> Iterator[tuple[str, MeshFile]]:
    """Meshes in the marker's colour, or in their own; alpha counts for both.

    RViz takes a colour of all zeros for none where the mesh has its own.
    """
    for at, (xyz, rgb, opacity) in enumerate(_looks(markers)):
        own = bool(markers.embedded[at])
        shown = 1.0 if own and not markers.rgba[at].any() else opacity
        if shown and markers.scales[at].all():
            x, y, z = markers.scales[at].tolist()
            w, i, j, k = markers.rotations_wxyz[at].tolist()
            colour = None if own else rgb
            mesh = MeshFile(markers.words[at], (x, y, z), colour, shown, xyz, (w, i, j, k))
            yield f"mesh-{int(markers.rows[at])}", mesh


def _looks(markers: Rows) -> Iterator[tuple[Xyz, Rgb, float]]:
    """Where each is, its colour and its opacity."""
    positions: list[list[float]] = markers.positions.tolist()
    colors: list[list[int]] = colors_of(markers.rgba).tolist()
    alphas: list[int] = alphas_of(markers.rgba).tolist()
    for (x, y, z), (red, green, blue), alpha in zip(positions, colors, alphas, strict=True):
        yield (x, y, z), (red, green, blue), alpha / 255
