"""Many solids of one kind as one node: one mesh, drawn once for each place."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np
from viser import _messages

from studio.scene.node import Node
from studio.scene.unit_meshes import unit_mesh

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.displays.drawing import Solids


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
    """One node for all; none when there are none."""
    if len(shape.positions) == 0:
        return {}
    mesh = unit_mesh(shape.kind)
    whole, each = _opacities(shape)
    props: dict[str, Any] = {
        "lod": "off",
        "wireframe": False,
        "opacity": whole if whole < 1 else None,
        "flat_shading": False,
        "side": "front",
        "material": "standard",
        "cast_shadow": False,
        "receive_shadow": False,
        "scale": 1.0,
    }
    flowing: dict[str, NDArray[Any]] = {
        "batched_wxyzs": np.ascontiguousarray(shape.wxyz, np.float32),
        "batched_positions": np.ascontiguousarray(shape.positions, np.float32),
        "batched_scales": np.ascontiguousarray(shape.scales, np.float32),
        "batched_colors": linear(np.ascontiguousarray(shape.colors, np.uint8)),
    }
    if each is None:
        props["batched_opacities"] = None
    else:
        flowing["batched_opacities"] = np.ascontiguousarray(each, np.float32)
    arrays: dict[str, NDArray[Any]] = {"vertices": mesh.vertices, "faces": mesh.faces}
    made = Node(
        _messages.BatchedMeshesMessage,
        props,
        content=f"{shape.kind}/{each is None}",
        arrays=arrays,
        stream=stream,
        flowing=flowing,
    )
    return {"many": made}


def _opacities(shape: Solids) -> tuple[float, NDArray[np.float32] | None]:
    """One for all, and one for each where they differ: those cost the page a mesh made anew."""
    if not isinstance(shape.opacities, np.ndarray):
        return float(shape.opacities), None
    first = float(shape.opacities[0])
    return (first, None) if (shape.opacities == first).all() else (1.0, shape.opacities)
