from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from studio.documents.meshes import MeshLoading, mesh_problem
from studio.errors import PackageNotFoundError
from studio.robot.meshes.library import MeshLibrary
from studio.robot.worker_client import mesh_pool

if TYPE_CHECKING:
    from pathlib import Path

    from studio.robot.meshes.loaded_mesh import LoadedMesh

TRIANGLE = """solid t
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 1 0
endloop
endfacet
endsolid t
"""


class Told:
    """What a loading told of, and the loading itself."""

    def __init__(self, folder: Path) -> None:
        self.pool = mesh_pool(1)
        self.arrived: dict[str, LoadedMesh | None] = {}
        self.counts: list[tuple[int, int]] = []
        self.resolved: list[str] = []
        self.folder = folder
        library = MeshLibrary(folder / "cache", self.pool)
        self.loading = MeshLoading(library, self._resolve, self._arrive, self._count)

    def _resolve(self, uri: str) -> tuple[Path, tuple[Path, ...]]:
        self.resolved.append(uri)
        return self.folder / uri, (self.folder,)

    def _arrive(self, uri: str, mesh: LoadedMesh | None) -> None:
        self.arrived[uri] = mesh

    def _count(self, done: int, total: int) -> None:
        self.counts.append((done, total))

    async def close(self) -> None:
        await self.loading.close()
        await self.pool.close()


def test_each_mesh_arrives_once_and_a_missing_one_is_a_problem(tmp_path: Path):
    (tmp_path / "a.stl").write_text(TRIANGLE)

    async def run() -> Told:
        told = Told(tmp_path)
        told.loading.want(["a.stl", "b.stl", "a.stl"])
        await told.loading.settled()
        await told.close()
        return told

    told = asyncio.run(run())
    assert told.arrived["a.stl"] is not None
    assert told.arrived["b.stl"] is None
    assert list(told.loading.problems) == ["b.stl"]
    assert told.counts[0] == (0, 2)
    assert told.counts[-1] == (2, 2)


def test_problems_of_meshes_that_nobody_names_are_forgotten(tmp_path: Path):
    async def run() -> Told:
        told = Told(tmp_path)
        told.loading.want(["b.stl"])
        await told.loading.settled()
        told.loading.forget(["other.stl"])
        await told.close()
        return told

    assert asyncio.run(run()).loading.problems == {}


def test_a_missing_package_is_told_of_the_mesh_that_names_it():
    problem = mesh_problem("package://no_such/m.stl", PackageNotFoundError("no_such", "/r/a.urdf"))
    assert problem.sentence.startswith('Mesh package://no_such/m.stl: package "no_such" was not')
    assert problem.fix is not None
    assert problem.fix.target == "no_such"
    textured = mesh_problem(
        "textured-box:package://p/i.png", PackageNotFoundError("p", "/r/a.urdf")
    )
    assert textured.sentence.startswith("Texture package://p/i.png: ")
