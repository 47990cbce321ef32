"""The robot worker's process: reads meshes, validates URDFs. `python -m studio.robot.worker`."""

from __future__ import annotations

import os
import sys

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # workers run side by side, small arrays each

from pathlib import Path
from typing import Final, assert_never

from studio.errors import MeshError, PackageError, UnreadableFileError
from studio.robot.meshes.files import MeshFiles
from studio.robot.meshes.loaded_mesh import MeshCache, pack_mesh
from studio.robot.meshes.reading import read_mesh, read_textured
from studio.robot.requests import (
    CODEC,
    CheckAnswer,
    CheckRequest,
    MeshAnswer,
    MeshFault,
    MeshRequest,
)
from studio.settings import ROBOT_MEMORY_BYTES
from studio.worker_process import serve

_LEFT_OUT: Final = ("networkx", "scipy", "shapely")
"""What trimesh imports where it is there, for geometry that no request asks for. Without it
yourdfpy is imported in less than half of the time."""
_INLINE_BYTES = 64 << 10
"""Up to this size the pipe is as quick as the file."""


def handle(request: MeshRequest | CheckRequest) -> MeshAnswer | MeshFault | CheckAnswer:
    """Answer one request; whatever is wrong with a user's file is an answer too."""
    match request:
        case MeshRequest():
            return _read(request)
        case CheckRequest():
            from studio.robot.urdf_check import check_urdf  # noqa: PLC0415 - takes long

            return check_urdf(request.urdf)
        case _:
            assert_never(request)


def _read(request: MeshRequest) -> MeshAnswer | MeshFault:
    path = Path(request.path)
    try:
        files = MeshFiles(path, map(Path, request.roots))
        mesh = read_textured(files, request.shape) if request.shape else read_mesh(files)
    except MeshError as error:
        return MeshFault("MeshError", error.uri, error.reason)
    except UnreadableFileError as error:
        return MeshFault("UnreadableFileError", error.path, error.reason)
    except PackageError:
        return MeshFault("OutsideRootsError", request.path, "")
    blob, cache = pack_mesh(mesh, files.references), MeshCache(Path(request.cache_folder))
    name = cache.name(path, files.digest, request.shape)
    stored = cache.write(name, blob)
    return MeshAnswer(name, b"" if stored and len(blob) > _INLINE_BYTES else blob)


if __name__ == "__main__":
    for package in _LEFT_OUT:
        sys.modules[package] = None  # pyright: ignore[reportArgumentType] - as if not installed
    serve(CODEC, handle, ROBOT_MEMORY_BYTES)
