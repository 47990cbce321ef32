# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportAttributeAccessIssue=false
"""PLY to one surface, by trimesh: the one door to it, opened only for a PLY (half a second)."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

import numpy as np
import trimesh
from trimesh.visual import ColorVisuals

from studio.robot.meshes.surfaces import Surface

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.robot.meshes.files import MeshFiles


def read_ply(files: MeshFiles) -> list[Surface]:
    """Return the faces with the vertices' colours; normals are made again.

    Raises:
        MeshError: No PLY, cut off, or a face points beyond its vertices.
    """
    if not files.data.startswith(b"ply"):
        raise files.fault("it is no PLY: its first word is not ply.")
    try:
        mesh = trimesh.load_mesh(io.BytesIO(files.data), file_type="ply", process=False)
    except Exception as error:  # trimesh raises whatever a broken file leads it to
        raise files.fault(f"it is no PLY that can be read ({error}).") from error
    faces = np.asarray(mesh.faces, dtype=np.int64).reshape(-1, 3)
    vertices = np.asarray(mesh.vertices, dtype=np.float64).reshape(-1, 3)
    files.count_triangles(len(faces))
    if faces.size and (int(faces.max()) >= len(vertices) or int(faces.min()) < 0):
        raise files.fault("its faces point beyond its vertices.")
    corners = faces.ravel()
    with np.errstate(over="ignore"):  # beyond float32 is infinite, and not drawn
        positions = vertices.astype(np.float32)[corners]
    return [Surface(positions, colors=_colors(mesh, corners))]


def _colors(mesh: trimesh.Trimesh, corners: NDArray[np.int64]) -> NDArray[np.uint8] | None:
    visual = mesh.visual
    if not isinstance(visual, ColorVisuals):
        return None
    if visual.kind == "vertex":
        return np.asarray(visual.vertex_colors, dtype=np.uint8)[corners]
    if visual.kind == "face":
        return np.repeat(np.asarray(visual.face_colors, dtype=np.uint8), 3, axis=0)
    return None
