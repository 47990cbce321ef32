# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportAttributeAccessIssue=false
"""What trimesh makes of a mesh file: size and triangles, its units applied by hand."""

from __future__ import annotations

import logging
import re
from typing import TYPE_CHECKING, Any

import trimesh

if TYPE_CHECKING:
    from pathlib import Path

_UNIT = re.compile(rb"<unit[^>]*\bmeter=\"([^\"]+)\"")


def size_by_trimesh(path: Path) -> tuple[list[float], int] | None:
    """Edges of the bounding box in metres, and the number of triangles shown.

    None where it finds nothing to show, as in some files that RViz does show.
    """
    logging.getLogger("trimesh").setLevel(logging.CRITICAL)
    scene: Any = trimesh.load_scene(path)
    if scene.extents is None:
        return None
    unit = _UNIT.search(path.read_bytes()) if path.suffix.lower() == ".dae" else None
    metres = float(unit[1]) if unit else 1.0
    shown = [scene.geometry[scene.graph[node][1]] for node in scene.graph.nodes_geometry]
    return (scene.extents * metres).tolist(), sum(len(one.faces) for one in shown)
