"""Many solids of one kind as one node or few: one mesh, drawn once for each place."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np
from viser import _messages

from studio.scene.node import Node
from studio.scene.unit_meshes import unit_mesh

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.displays.drawing import Solids


_LEVELS: Final = 32
"""Of opacity."""


def _linear_levels() -> NDArray[np.uint8]:
    shown = np.arange(256) / 255
    linear = np.where(shown <= 0.04045, shown / 12.92, ((shown + 0.055) / 1.055) ** 2.4)
    return np.round(linear * 255).astype(np.uint8)


LINEAR_LEVELS: Final = _linear_levels()
"""sRGB to amounts of light, both 0 to 255: what viser's page takes for colours of many solids."""


def linear(colors: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Colours as amounts of light."""
    return LINEAR_LEVELS[colors]


def many_of(shape: Solids, stream: str) -> dict[str, Node]:
    """A node for each opacity that is there, in steps of 1/32; what cannot be seen is not drawn.

    viser's page could take an opacity for each, but would then make its mesh anew with each
    message, and never give back what the one before took of the graphics processor.
    """
    if len(shape.positions) == 0:
        return {}
    with np.errstate(invalid="ignore"):
        levels = np.clip(np.rint(np.multiply(shape.opacities, _LEVELS)), 0, _LEVELS)
    nodes: dict[str, Node] = {}
    for level in np.unique(levels[levels > 0]).tolist():
        which = None if levels.ndim == 0 or (levels == level).all() else levels == level
        name = "many" if level == _LEVELS else f"many-{level:.0f}"
        nodes[name] = _many(shape, which, level / _LEVELS, stream)
    return nodes


def _many(shape: Solids, which: NDArray[np.bool_] | None, opacity: float, stream: str) -> Node:
    mesh = unit_mesh(shape.kind)
    props: dict[str, Any] = {
        "lod": "off",
        "wireframe": False,
        "opacity": opacity if opacity < 1 else None,
        "flat_shading": False,
        "side": "front",
        "material": "standard",
        "cast_shadow": False,
        "receive_shadow": False,
        "batched_opacities": None,
        "scale": 1.0,
    }
    one_color = shape.colors.ndim == 1
    flowing: dict[str, NDArray[Any]] = {
        "batched_wxyzs": _rows(shape.wxyz, which),
        "batched_positions": _rows(shape.positions, which),
        "batched_scales": _rows(shape.scales, which),
        "batched_colors": linear(shape.colors if one_color else _colors(shape.colors, which)),
    }
    arrays: dict[str, NDArray[Any]] = {"vertices": mesh.vertices, "faces": mesh.faces}
    return Node(
        _messages.BatchedMeshesMessage,
        props,
        content=shape.kind,
        arrays=arrays,
        stream=stream,
        flowing=flowing,
    )


def _rows(values: NDArray[np.float32], which: NDArray[np.bool_] | None) -> NDArray[np.float32]:
    return np.ascontiguousarray(values if which is None else values[which], np.float32)


def _colors(values: NDArray[np.uint8], which: NDArray[np.bool_] | None) -> NDArray[np.uint8]:
    return np.ascontiguousarray(values if which is None else values[which])
