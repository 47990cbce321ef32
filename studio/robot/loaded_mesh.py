"""A mesh as it is drawn: triangles in metres, and a whole GLB when it has looks of its own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from studio.problems import Problem
    from studio.robot.values import Vector3


@dataclass(frozen=True, slots=True, eq=False)
class LoadedMesh:
    """One mesh file, whole and flattened; compare by `digest`. Arrays are read-only.

    Units are applied (COLLADA `<unit>`), `up_axis` is ignored as RViz does, and the `scale` of
    the URDF is not applied: it belongs to the node that draws the mesh.
    """

    digest: str
    """Hex digest of the file and of every file it refers to: equal means drawn the same."""
    vertices: NDArray[np.float32]
    """Shape (N, 3), metres, split at creases: smooth normals computed from the faces look right."""
    faces: NDArray[np.uint32]
    """Shape (M, 3), M > 0, indices into `vertices`."""
    glb: bytes
    """The same triangles with the mesh's own materials, textures and vertex colours; nothing is
    fetched to draw it. Empty when the mesh has no colour of its own (all STL): then the URDF
    material colours it."""
    bounds_m: tuple[Vector3, Vector3]
    """Least and greatest corner."""
    problems: tuple[Problem, ...] = ()
    """What was drawn without, e.g. a missing texture; warnings."""
