from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from studio.documents.checks.mesh_checks import HiddenMeshes
from studio.robot.meshes.library import MeshLibrary
from studio.robot.worker_client import mesh_pool
from tests.support.checked import link, robot
from tests.support.meshes import TETRAHEDRON, stl
from tests.support.open_documents import engine, opened

if TYPE_CHECKING:
    from pathlib import Path


def test_a_mesh_is_measured_once_and_again_when_it_is_another(tmp_path: Path):
    folder = tmp_path / "robots"
    folder.mkdir()
    path = folder / "arm.urdf"
    path.write_text(robot(link("base")))
    mesh = folder / "m.stl"

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, path)
            pool = mesh_pool(1)
            hidden = HiddenMeshes(document.workspace, MeshLibrary(tmp_path / "cache", pool))
            assert await hidden.read(["m.stl"])
            assert "m.stl" in hidden.problems["m.stl"].sentence
            assert not await hidden.read(["m.stl"])
            mesh.write_bytes(stl(TETRAHEDRON))
            assert await hidden.read(["m.stl"])
            assert not hidden.problems
            before = hidden.bounds["m.stl"]
            assert not await hidden.read(["m.stl"])
            mesh.write_bytes(stl(TETRAHEDRON * 3) + b"behind")
            assert await hidden.read(["m.stl"])
            assert hidden.bounds["m.stl"] != before
            assert await hidden.read([])
            assert not hidden.bounds
            await pool.close()

    asyncio.run(run())


def test_a_mesh_outside_the_served_folders_is_not_read(tmp_path: Path):
    folder = tmp_path / "robots"
    folder.mkdir()
    path = folder / "arm.urdf"
    path.write_text(robot(link("base")))
    (tmp_path / "secret.stl").write_bytes(stl(TETRAHEDRON))

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, path)
            pool = mesh_pool(1)
            hidden = HiddenMeshes(document.workspace, MeshLibrary(tmp_path / "cache", pool))
            uris = ["../secret.stl", str(tmp_path / "secret.stl"), "http://127.0.0.1/m.stl"]
            await hidden.read(uris)
            assert not hidden.bounds
            assert set(hidden.problems) == set(uris)
            await pool.close()

    asyncio.run(run())
