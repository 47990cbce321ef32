"""Meshes for the main process: each content is read once, by a worker, and kept."""

from __future__ import annotations

import asyncio
from collections import OrderedDict
from typing import TYPE_CHECKING, TypeVar

from studio.errors import (
    MeshError,
    OutsideRootsError,
    PackageError,
    StudioError,
    UnreadableFileError,
    WorkerDiedError,
)
from studio.packages.roots import ServedRoots
from studio.robot.meshes.files import content_digest
from studio.robot.meshes.loaded_mesh import MeshCache, unpack_mesh
from studio.robot.requests import MeshAnswer, MeshFault, MeshRequest
from studio.settings import MESH_SIZE_LIMIT_BYTES, MESH_TIMEOUT_S

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine, Hashable, Iterable
    from pathlib import Path

    from studio.robot.meshes.loaded_mesh import LoadedMesh
    from studio.workers import WorkerPool

Value = TypeVar("Value")
_MEMORY_LIMIT_BYTES = 256 << 20


class MeshLibrary:
    """Loads meshes through a pool of workers, at most one load per content at a time.

    Args:
        cache_folder: For loaded meshes, of this library alone or shared with others'.
        pool: Robot workers, see `pool.mesh_pool`.
    """

    def __init__(self, cache_folder: Path, pool: WorkerPool) -> None:
        self._cache, self._pool = MeshCache(cache_folder), pool
        self._memory = _Memory(_MEMORY_LIMIT_BYTES)
        self._loading: dict[Hashable, asyncio.Task[LoadedMesh]] = {}
        self._has_grown = False
        """The cache, since it was trimmed."""

    async def load(self, path: Path, roots: Iterable[Path] = (), shape: str = "") -> LoadedMesh:
        """Load a mesh file, or an image on a primitive.

        Args:
            path: The file, resolved as `uris` does.
            roots: Folders that it and what it refers to may be read from; the file's own folder
                when there are none.
            shape: `box`, `cylinder` or `sphere` to put the image `path` on; empty for a mesh.

        Raises:
            MeshError: It cannot be shown.
            PackageError: It cannot be read.
            WorkerError: The worker fell over it, or took too long.
        """
        folders = tuple(roots) or (path.parent,)
        key = (shape, str(path), *map(str, folders))
        return await self._shared(key, lambda: self._load(path, folders, shape))

    async def _load(self, path: Path, folders: tuple[Path, ...], shape: str) -> LoadedMesh:
        digest = await asyncio.to_thread(_digest_of, path, folders)
        # what a file refers to depends on its folder
        name = self._cache.name(path, digest, shape)
        key = (name, str(path.parent), *map(str, folders))
        return await self._shared(key, lambda: self._load_content(path, folders, shape, name))

    async def _load_content(
        self, path: Path, folders: tuple[Path, ...], shape: str, name: str
    ) -> LoadedMesh:
        known = self._memory.get(name) or await asyncio.to_thread(self._cache.read, name)
        if known is not None and await _holds(known[1], folders):
            self._memory.put(name, known)
            return known[0]
        name, loaded = await self._ask(path, folders, shape)
        self._memory.put(name, loaded)
        self._has_grown = True
        return loaded[0]

    async def _ask(
        self, path: Path, folders: tuple[Path, ...], shape: str
    ) -> tuple[str, tuple[LoadedMesh, dict[str, str]]]:
        """Return the mesh as the worker found it, and the name of that content: it may be newer."""
        roots = tuple(map(str, folders))
        request = MeshRequest(str(path), roots, str(self._cache.folder), shape)
        # the worker reads the next one while this is taken
        answer = await self._pool.ask(request, object, MESH_TIMEOUT_S, folders)
        match answer:
            case MeshFault():
                raise _error(answer)
            case MeshAnswer(name, b""):
                stored = await asyncio.to_thread(self._cache.read, name)
                if stored is None:
                    raise MeshError(str(path), "its cached form vanished: open it again.")
                return name, stored
            case MeshAnswer(name, blob):
                return name, unpack_mesh(blob)
            case _:
                raise WorkerDiedError("mesh", None)

    async def _shared(
        self, key: Hashable, start: Callable[[], Coroutine[None, None, LoadedMesh]]
    ) -> LoadedMesh:
        """Wait for the load of a key, and start it if it does not run."""
        task = self._loading.get(key)
        if task is None:
            task = asyncio.create_task(start())
            self._loading[key] = task
            task.add_done_callback(lambda done: self._finish(key, done))
        return await asyncio.shield(task)  # one caller that gives up must not end it for the others

    def _finish(self, key: Hashable, task: asyncio.Task[LoadedMesh]) -> None:
        del self._loading[key]
        if not task.cancelled():
            task.exception()  # seen, even when every asker gave up
        if not self._loading and self._has_grown:
            self._has_grown = False
            asyncio.get_running_loop().run_in_executor(None, self._cache.trim)


class _Memory:
    """The meshes used last, bounded by their bytes."""

    def __init__(self, limit_bytes: int) -> None:
        self._limit_bytes, self._bytes = limit_bytes, 0
        self._meshes: OrderedDict[str, tuple[LoadedMesh, dict[str, str]]] = OrderedDict()

    def get(self, name: str) -> tuple[LoadedMesh, dict[str, str]] | None:
        found = self._meshes.get(name)
        if found is not None:
            self._meshes.move_to_end(name)
        return found

    def put(self, name: str, loaded: tuple[LoadedMesh, dict[str, str]]) -> None:
        before = self._meshes.pop(name, None)
        self._bytes += _size_bytes(loaded[0]) - (_size_bytes(before[0]) if before else 0)
        self._meshes[name] = loaded
        while self._bytes > self._limit_bytes and len(self._meshes) > 1:
            _, (dropped, _) = self._meshes.popitem(last=False)
            self._bytes -= _size_bytes(dropped)


def _size_bytes(mesh: LoadedMesh) -> int:
    return mesh.vertices.nbytes + mesh.faces.nbytes + len(mesh.glb)


def _digest_of(path: Path, folders: tuple[Path, ...]) -> str:
    return content_digest(ServedRoots(folders).read(path, MESH_SIZE_LIMIT_BYTES))


async def _holds(references: dict[str, str], folders: tuple[Path, ...]) -> bool:
    """Whether the files that a mesh refers to are still those it was loaded with."""
    return not references or await asyncio.to_thread(_all_hold, references, folders)


def _all_hold(references: dict[str, str], folders: tuple[Path, ...]) -> bool:
    return all(_digest_or_empty(file, folders) == digest for file, digest in references.items())


def _digest_or_empty(file: str, folders: tuple[Path, ...]) -> str:
    try:
        return content_digest(ServedRoots(folders).read(file, MESH_SIZE_LIMIT_BYTES))
    except PackageError:
        return ""


def _error(fault: MeshFault) -> StudioError:
    match fault.kind:
        case "UnreadableFileError":
            return UnreadableFileError(fault.subject, fault.reason)
        case "OutsideRootsError":
            return OutsideRootsError(fault.subject)
        case _:
            return MeshError(fault.subject, fault.reason)
