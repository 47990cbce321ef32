from __future__ import annotations

import asyncio
import os
from typing import TYPE_CHECKING, TypeVar

import pytest

from studio.errors import MeshError, PackageError, WorkerTimeoutError
from studio.robot.meshes.files import MeshFiles
from studio.robot.meshes.library import MeshLibrary
from studio.robot.meshes.loaded_mesh import MeshCache, pack_mesh, unpack_mesh
from studio.robot.meshes.reading import read_mesh
from studio.robot.requests import MeshAnswer, MeshFault, MeshRequest
from studio.robot.worker_client import mesh_pool
from tests.support.meshes import TETRAHEDRON, dae, diffuse, png, stl, texture_effect
from tests.support.open_documents import until

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Hashable
    from pathlib import Path

    from studio.workers import WorkerPool

Answer = TypeVar("Answer")
IMAGE = '<image id="i"><init_from>paint.png</init_from></image>'


class CountingPool:
    """A real pool that counts what it is asked."""

    def __init__(self, pool: WorkerPool) -> None:
        self._pool = pool
        self.asked: list[MeshRequest] = []

    async def ask(
        self, request: object, answer: type[Answer], timeout_s: float, owner: Hashable = None
    ) -> Answer:
        assert isinstance(request, MeshRequest)
        self.asked.append(request)
        return await self._pool.ask(request, answer, timeout_s, owner)


def with_library(folder: Path, use: Callable[[MeshLibrary, CountingPool], Awaitable[None]]) -> None:
    """Run `use` with a library over one real worker."""

    async def run() -> None:
        pool = mesh_pool(1)
        counting = CountingPool(pool)
        try:
            await use(MeshLibrary(folder, counting), counting)  # type: ignore[arg-type]
        finally:
            await pool.close()

    asyncio.run(run())


def test_a_mesh_comes_through_the_worker_as_it_was_read(tmp_path: Path):
    path = tmp_path / "a.dae"
    path.write_text(dae(effect=diffuse("<color>1 0 0 1</color>")))
    expected = read_mesh(MeshFiles(path))

    async def use(library: MeshLibrary, _: CountingPool) -> None:
        mesh = await library.load(path)
        assert mesh.vertices.tolist() == expected.vertices.tolist()
        assert mesh.faces.tolist() == expected.faces.tolist()
        assert (mesh.glb, mesh.digest) == (expected.glb, expected.digest)
        assert mesh.bounds_m == expected.bounds_m
        assert not mesh.vertices.flags.writeable

    with_library(tmp_path / "cache", use)


def test_many_askers_at_once_and_equal_files_share_one_load(tmp_path: Path):
    paths = [tmp_path / name for name in ("a.stl", "b.stl")]
    for path in paths:
        path.write_bytes(stl())

    async def use(library: MeshLibrary, pool: CountingPool) -> None:
        meshes = await asyncio.gather(*(library.load(path) for path in paths * 20))
        assert len({id(mesh) for mesh in meshes}) == 1
        assert len(pool.asked) == 1

    with_library(tmp_path / "cache", use)


def test_a_second_library_finds_the_mesh_on_disk(tmp_path: Path):
    path = tmp_path / "a.stl"
    path.write_bytes(stl())

    async def use(library: MeshLibrary, pool: CountingPool) -> None:
        first = await library.load(path)
        second = await MeshLibrary(tmp_path / "cache", pool).load(path)  # type: ignore[arg-type]
        assert second.digest == first.digest
        assert len(pool.asked) == 1

    with_library(tmp_path / "cache", use)


def test_a_file_that_changed_is_loaded_anew(tmp_path: Path):
    path = tmp_path / "a.stl"
    path.write_bytes(stl())

    async def use(library: MeshLibrary, _: CountingPool) -> None:
        before = await library.load(path)
        path.write_bytes(stl(TETRAHEDRON * 3))
        after = await library.load(path)
        assert after.digest != before.digest
        assert after.bounds_m[1] == (3, 3, 3)

    with_library(tmp_path / "cache", use)


def test_a_texture_that_changed_comes_or_goes_loads_the_mesh_anew(tmp_path: Path):
    path = tmp_path / "a.dae"
    path.write_text(dae(effect=texture_effect(), images=IMAGE))

    async def use(library: MeshLibrary, pool: CountingPool) -> None:
        assert (await library.load(path)).problems
        (tmp_path / "paint.png").write_bytes(png())
        assert png() in (await library.load(path)).glb
        (tmp_path / "paint.png").write_bytes(png((3, 3)))
        assert png((3, 3)) in (await library.load(path)).glb
        assert png((3, 3)) in (await library.load(path)).glb
        assert len(pool.asked) == 3

    with_library(tmp_path / "cache", use)


def test_a_broken_mesh_is_an_error_and_the_worker_goes_on(tmp_path: Path):
    (tmp_path / "bad.dae").write_text("<COLLADA>")
    (tmp_path / "good.stl").write_bytes(stl())

    async def use(library: MeshLibrary, pool: CountingPool) -> None:
        for _ in range(2):
            with pytest.raises(MeshError, match="not well-formed"):
                await library.load(tmp_path / "bad.dae")
        assert len((await library.load(tmp_path / "good.stl")).faces) == 4
        assert len(pool.asked) == 3

    with_library(tmp_path / "cache", use)


def test_what_may_not_be_read_is_not_read(tmp_path: Path):
    (tmp_path / "in").mkdir()
    (tmp_path / "out.stl").write_bytes(stl())
    (tmp_path / "in" / "link.stl").symlink_to(tmp_path / "out.stl")
    os.mkfifo(tmp_path / "in" / "pipe.stl")

    async def use(library: MeshLibrary, pool: CountingPool) -> None:
        for name in ("../out.stl", "link.stl", "pipe.stl", "gone.stl"):
            with pytest.raises(PackageError):
                await library.load(tmp_path / "in" / name, [tmp_path / "in"])
        assert not pool.asked

    with_library(tmp_path / "cache", use)


def test_an_unknown_format_is_said(tmp_path: Path):
    (tmp_path / "a.step").write_bytes(b"x")

    async def use(library: MeshLibrary, _: CountingPool) -> None:
        with pytest.raises(MeshError, match=r'"\.step" is no mesh format'):
            await library.load(tmp_path / "a.step")

    with_library(tmp_path / "cache", use)


def test_a_cache_that_cannot_be_written_only_costs_time(tmp_path: Path):
    path, blocked = tmp_path / "a.stl", tmp_path / "cache"
    path.write_bytes(stl())
    blocked.write_text("a file where the folder should be")

    async def use(library: MeshLibrary, _: CountingPool) -> None:
        assert len((await library.load(path)).faces) == 4

    with_library(blocked, use)


def test_one_asker_who_gives_up_ends_it_for_nobody_else(tmp_path: Path):
    path = tmp_path / "a.stl"
    path.write_bytes(stl())

    async def use(library: MeshLibrary, _: CountingPool) -> None:
        impatient = asyncio.create_task(library.load(path))
        patient = asyncio.create_task(library.load(path))
        await asyncio.sleep(0)
        impatient.cancel()
        assert len((await patient).faces) == 4

    with_library(tmp_path / "cache", use)


def test_a_broken_cache_file_is_replaced(tmp_path: Path):
    path, cache = tmp_path / "a.stl", tmp_path / "cache"
    path.write_bytes(stl())

    async def use(library: MeshLibrary, pool: CountingPool) -> None:
        await library.load(path)
        (stored,) = cache.iterdir()
        stored.write_bytes(stored.read_bytes()[:-5])
        again = await MeshLibrary(cache, pool).load(path)  # type: ignore[arg-type]
        assert len(again.faces) == 4
        assert len(pool.asked) == 2

    with_library(cache, use)


def test_a_worker_that_answers_too_late_is_replaced(tmp_path: Path):
    path = tmp_path / "a.stl"
    path.write_bytes(stl())
    # Takes longer than a busy machine takes to look at the time.
    large = tmp_path / "large.obj"
    corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
    large.write_text(corners + "f 1 2 3\nf 1 2 3 4\n" * 100_000)

    async def run() -> None:
        pool = mesh_pool(1)
        rest = ((str(tmp_path),), str(tmp_path))
        try:
            with pytest.raises(WorkerTimeoutError):
                await pool.ask(MeshRequest(str(large), *rest), object, 0.0)
            answer = await pool.ask(MeshRequest(str(path), *rest), object, 30.0)
            assert isinstance(answer, MeshAnswer)
            missing = MeshRequest(str(tmp_path / "b.stl"), *rest)
            assert isinstance(await pool.ask(missing, object, 30.0), MeshFault)
        finally:
            await pool.close()

    asyncio.run(run())


def test_a_mesh_that_takes_long_keeps_no_other_robots_mesh_waiting_nor_its_own(tmp_path: Path):
    robots = [tmp_path / name for name in ("slow", "other")]
    for robot in robots:
        robot.mkdir()
        (robot / "quick.stl").write_bytes(stl(TETRAHEDRON * (2 + robots.index(robot))))
    corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
    (robots[0] / "slow.obj").write_text(corners + "f 1 2 3\nf 1 2 3 4\n" * 1_000_000)

    async def use(library: MeshLibrary, pool: CountingPool) -> None:
        slow = asyncio.create_task(library.load(robots[0] / "slow.obj"))
        await until(lambda: bool(pool.asked))
        for robot in robots:
            assert len((await library.load(robot / "quick.stl")).faces) == 4
        assert not slow.done()
        slow.cancel()

    with_library(tmp_path / "cache", use)


@pytest.mark.parametrize("cut", [0, 5, 20, 100, -1])
def test_a_blob_that_is_cut_off_is_refused(tmp_path: Path, cut: int):
    (tmp_path / "a.stl").write_bytes(stl())
    blob = pack_mesh(read_mesh(MeshFiles(tmp_path / "a.stl")), {"/x": "y"})
    assert unpack_mesh(blob)[1] == {"/x": "y"}
    with pytest.raises(ValueError, match=r"cached mesh|truncated"):
        unpack_mesh(blob[:cut])


def test_the_cache_drops_what_was_unused_for_longest(tmp_path: Path):
    (tmp_path / "a.stl").write_bytes(stl())
    mesh = read_mesh(MeshFiles(tmp_path / "a.stl"))
    blob = pack_mesh(mesh, {})
    cache = MeshCache(tmp_path / "cache", limit_bytes=2 * len(blob))
    for age, name in enumerate(("new", "middle", "old")):
        assert cache.write(name, blob)
        used = 1_000_000 - age
        os.utime(next((tmp_path / "cache").glob(f"{name}*")), (used, used))
    cache.trim()
    assert cache.read("old") is None
    assert cache.read("new") is not None
    assert cache.read("middle") is not None


def test_the_cache_is_trimmed_once_after_the_last_of_several_meshes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    trimmed: list[int] = []
    count = MeshCache.trim

    def trim(cache: MeshCache) -> None:
        trimmed.append(len(list(cache.folder.iterdir())))
        count(cache)

    monkeypatch.setattr(MeshCache, "trim", trim)
    paths = [tmp_path / f"{number}.stl" for number in range(4)]
    for number, path in enumerate(paths):
        path.write_bytes(stl() + bytes(number))  # another content each

    async def use(library: MeshLibrary, _: CountingPool) -> None:
        await asyncio.gather(*map(library.load, paths))
        await until(lambda: bool(trimmed))

    with_library(tmp_path / "cache", use)
    assert trimmed == [4]
