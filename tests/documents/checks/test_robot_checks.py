from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from tests.support.checked import box, inertial, joint, link, robot
from tests.support.meshes import TETRAHEDRON, stl
from tests.support.open_documents import engine, opened, until

if TYPE_CHECKING:
    from pathlib import Path

    from studio.documents.document import Document
    from studio.problems import Problem

REVERSED = '<limit lower="1" upper="-1" effort="1" velocity="1"/>'
STUCK = robot(
    link("foot"),
    link("base", inertial(1, 0.01, 0.01, 0.01), box("visual", "0.2 0.2 0.2")),
    joint("fixed", "base", parent="foot"),
    link("arm", inertial(1, -1, 1, 1), box("collision", "0.2 0.2 0.2")),
    joint("revolute", "arm", REVERSED),
)


def written(folder: Path, text: str) -> Path:
    path = folder / "robots" / "arm.urdf"
    path.parent.mkdir(exist_ok=True)
    path.write_text(text)
    return path


def found(document: Document, code: str) -> list[Problem]:
    return [one for one in document.findings.all() if one.code == code]


def test_what_is_wrong_with_a_robot_is_told_where_it_stands(tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, written(tmp_path, STUCK))
            await document.robot_checks.settled()
            (limits,), (moments,) = (
                found(document, code) for code in ("reversed-limits", "bad-inertia")
            )
            assert limits.place is not None
            assert limits.place.line == 6
            assert limits.parts == ("joint:arm",)
            assert moments.fix is not None
            told = {one["code"] for one in ear.last("problems")["problems"]}
            assert {"reversed-limits", "bad-inertia"} <= told

    asyncio.run(run())


def test_one_click_mends_and_what_is_mended_is_gone(tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, written(tmp_path, STUCK))
            await document.robot_checks.settled()
            for code in ("reversed-limits", "bad-inertia"):
                (problem,) = found(document, code)
                assert problem.fix is not None
                await document.fixes.apply(code, problem.sentence, problem.fix.label)
                await document.robot_checks.settled()
                assert not found(document, code)
            limit = document.model.robot.joints["arm"].limit
            assert limit is not None
            assert (limit.lower, limit.upper) == (-1, 1)
            await document.edits.undo()
            await document.robot_checks.settled()
            assert found(document, "bad-inertia")

    asyncio.run(run())


def test_while_the_text_is_broken_what_was_found_last_stands(tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            path = written(tmp_path, STUCK)
            document, _ = await opened(made, path)
            await document.robot_checks.settled()
            path.write_text(STUCK.replace("</robot>", ""))
            await until(lambda: document.last_run.failed)
            await document.robot_checks.settled()
            assert found(document, "reversed-limits")

    asyncio.run(run())


def test_a_collision_mesh_is_looked_for_though_nobody_sees_it(tmp_path: Path):
    mesh = '<collision><geometry><mesh filename="arm.stl"/></geometry></collision>'
    text = robot(link("base", mesh, box("visual", "0.2 0.2 0.2")))

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            path = written(tmp_path, text)
            document, _ = await opened(made, path)
            await document.robot_checks.settled()
            (missing,) = found(document, "mesh")
            assert "arm.stl" in missing.sentence
            assert missing.parts == ("link:base",)
            (path.parent / "arm.stl").write_bytes(stl(TETRAHEDRON * 2))
            document.robot_checks.trigger()
            await document.robot_checks.settled()
            assert not found(document, "mesh")
            (size,) = found(document, "collision-size")
            assert "larger" in size.sentence

    asyncio.run(run())


def test_a_document_that_is_closed_is_looked_at_no_more(tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, written(tmp_path, STUCK))
            document.robot_checks.trigger()
            del made.documents[document.id]
            await document.close()
            await document.robot_checks.settled()
            assert not found(document, "reversed-limits")

    asyncio.run(run())


def test_a_mesh_that_is_missing_twice_is_told_once(tmp_path: Path):
    shape = '<geometry><mesh filename="package://nowhere/arm.stl"/></geometry>'
    text = robot(link("base", f"<visual>{shape}</visual><collision>{shape}</collision>"))

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, written(tmp_path, text))
            await document.robot_checks.settled()
            (missing,) = found(document, "mesh")
            assert missing.fix is not None
            assert missing.fix.target == "nowhere"

    asyncio.run(run())


def test_there_is_nothing_to_mend_in_our_own_models(models: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            for path in sorted(models.glob("*/urdf/*.urdf.xacro")):
                document, _ = await opened(made, path)
                await document.robot_checks.settled()
                assert not document.findings.all(), path.name

    asyncio.run(run())
