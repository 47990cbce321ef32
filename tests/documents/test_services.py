from __future__ import annotations

import ast
import asyncio
import os
import subprocess
import sys
from contextlib import asynccontextmanager
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from studio.description.values import Checked, CheckQuery
from studio.documents.document import Document
from studio.documents.services import Services
from studio.packages.workspace import open_location
from studio.robot.meshes.library import MeshLibrary
from studio.robot.worker_client import mesh_pool
from studio.settings import Settings, mesh_worker_count
from tests.support.checked import inertial, joint, link, robot
from tests.support.meshes import stl
from tests.support.open_documents import until

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, Awaitable, Callable, Hashable

    from studio.workers import WorkerPool

Answer = TypeVar("Answer")
MESH = '<visual><geometry><mesh filename="arm.stl"/></geometry></visual>'
REVERSED = '<limit lower="1" upper="-1" effort="1" velocity="1"/>'
FAULTY = robot(
    link("base", MESH, inertial(1, 1, 1, 1)),
    joint("revolute", "arm", REVERSED),
    link("arm", inertial(1, 1, 1, 1)),
)


class HeldPool:
    """A real pool that hands a request on when it is let."""

    def __init__(self, pool: WorkerPool, let: Callable[[], Awaitable[None]]) -> None:
        self._pool, self._let = pool, let

    async def ask(
        self, request: object, answer: type[Answer], timeout_s: float, owner: Hashable = None
    ) -> Answer:
        await self._let()
        return await self._pool.ask(request, answer, timeout_s, owner)


@asynccontextmanager
async def opening(
    folder: Path, let: Callable[[], Awaitable[None]], patience_s: float = 60.0
) -> AsyncGenerator[Document]:
    """A faulty robot with a mesh that comes when it is let; its checks wait for no quiet time."""
    (folder / "arm.stl").write_bytes(stl())
    file = folder / "arm.urdf"
    file.write_text(FAULTY)
    settings = Settings(data_folder=folder / "data")
    services, pool = Services(settings), mesh_pool(1)
    services.quiet_s, services.patience_s = 0.0, patience_s
    services.meshes = MeshLibrary(folder / "meshes", HeldPool(pool, let))  # type: ignore[arg-type]
    await services.start()
    document = Document("arm", open_location(file, (), settings.data_folder, {}), {}, services)
    try:
        document.start()
        yield document
    finally:
        await document.close()
        await asyncio.gather(services.close(), pool.close())


def told(document: Document) -> set[str]:
    return {one.code for one in document.findings.all()}


def running(module: str) -> int:
    """How many processes of this one run a module (Linux)."""
    tasks = Path(f"/proc/{os.getpid()}/task").glob("*/children")
    children = [child for task in tasks for child in task.read_text().split()]
    lines = [Path(f"/proc/{child}/cmdline").read_bytes() for child in children]
    return sum(module.encode() in line for line in lines)


def test_checks_and_the_next_spare_worker_begin_after_the_last_mesh(tmp_path: Path):
    async def run() -> None:
        asked, come = asyncio.Event(), asyncio.Event()

        async def let() -> None:
            asked.set()
            await come.wait()

        of_others = running("studio.description.worker"), running("studio.robot.worker")
        async with opening(tmp_path, let) as document:
            await asked.wait()
            for _ in range(20):  # there is time enough for all of it
                reply = await document.runs.answer(CheckQuery(), Checked, document.checks)
                assert reply.problems is not None
                await asyncio.sleep(0.02)
            assert "reversed-limits" not in told(document)
            described, meshes = of_others[0] + 1, of_others[1] + mesh_worker_count()
            assert running("studio.description.worker") <= described  # its own: no spare yet
            assert running("studio.robot.worker") <= meshes  # nobody validates
            come.set()
            await until(lambda: "reversed-limits" in told(document))
            await until(lambda: running("studio.description.worker") > described)
            await until(lambda: running("studio.robot.worker") > meshes)

    asyncio.run(run())


def test_a_mesh_that_does_not_come_keeps_the_checks_waiting_for_so_long_only(tmp_path: Path):
    async def run() -> None:
        async def let() -> None:
            await asyncio.Event().wait()

        async with opening(tmp_path, let, patience_s=0.1) as document:
            await until(lambda: "reversed-limits" in told(document))

    asyncio.run(run())


def test_who_comes_while_a_robot_without_displays_opens_waits_for_no_import_of_them(
    tmp_path: Path,
):
    file = tmp_path / "arm.urdf"
    file.write_text(FAULTY)
    code = f"""
import asyncio, sys
from pathlib import Path
from studio.documents.engine import Engine
from studio.settings import Settings, mesh_worker_count
from tests.support.open_documents import Ear

async def run():
    made = Engine(Settings(data_folder=Path({str(tmp_path / "data")!r})))
    document = made.document(await made.open_path(Path({str(file)!r}), {{}}))
    document.attach(Ear())
    print("studio.live.displays.drawing_room" in sys.modules)
    await made.close()

asyncio.run(run())
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


STUDIO = Path(__file__).parents[2] / "studio"
IMPORTED_IN_THREADS = {"studio.live.connection.link", "studio.live.connection.report"}


def _imported_at_first_use() -> set[str]:
    """What functions of rooms that work on the loop import when they are called."""
    found: set[str] = set()
    for room in ("documents", "live", "displays", "scene", "ros"):
        for file in (STUDIO / room).rglob("*.py"):
            for one in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
                if isinstance(one, ast.FunctionDef | ast.AsyncFunctionDef):
                    inner = (two for two in ast.walk(one) if isinstance(two, ast.ImportFrom))
                    found |= {two.module for two in inner if two.module}
    return {one for one in found if one.startswith("studio.")}


def test_once_a_robot_is_open_nothing_is_left_to_import_on_the_loop(tmp_path: Path):
    entry = tmp_path / "r.urdf"
    entry.write_text(robot(link("base")))
    program = f"""
import asyncio, sys
from pathlib import Path
from tests.support.open_documents import engine, opened, until

async def run():
    async with engine(Path({str(tmp_path / "data")!r})) as made:
        await opened(made, Path({str(entry)!r}))
        await until(lambda: {_imported_at_first_use() - IMPORTED_IN_THREADS!r} <= set(sys.modules))

asyncio.run(run())
"""
    subprocess.run([sys.executable, "-c", program], check=True, cwd=STUDIO.parent, timeout=240)
