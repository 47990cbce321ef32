from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from tests.support.checked import link, robot
from tests.support.meshes import TETRAHEDRON, stl
from tests.support.open_documents import engine, opened, until

if TYPE_CHECKING:
    from pathlib import Path

    from studio.documents.document import Document
    from studio.problems import Problem


def shape(kind: str, uri: str) -> str:
    return f'<{kind}><geometry><mesh filename="{uri}"/></geometry></{kind}>'


def written(folder: Path, *shapes: str) -> Path:
    meshes = folder / "robots" / "meshes"
    meshes.mkdir(parents=True)
    (meshes / "Base.STL").write_bytes(stl(TETRAHEDRON))
    path = folder / "robots" / "arm.urdf"
    path.write_text(robot(link("base", *shapes)))
    return path


def missing(document: Document) -> list[Problem]:
    return [one for one in document.findings.all() if one.code == "mesh"]


@pytest.mark.parametrize("kinds", [("visual",), ("collision",), ("visual", "collision")])
def test_one_click_writes_the_name_that_was_meant_and_the_mesh_is_there(
    tmp_path: Path, kinds: tuple[str, ...]
):
    path = written(tmp_path, *(shape(kind, "meshes/base.stl") for kind in kinds))
    before = path.read_text()

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, path)
            await document.robot_checks.settled()
            (one,) = missing(document)
            assert one.sentence.endswith(': did you mean "Base.STL"?')
            assert one.fix is not None
            await document.fixes.apply(one.code, one.sentence, one.fix.label)
            now = document.sources.text(str(path)).decode()
            assert now == before.replace("meshes/base.stl", "meshes/Base.STL")
            await until(lambda: not missing(document))
            await document.edits.undo()
            await until(lambda: any(one.fix for one in missing(document)))

    asyncio.run(run())


def test_a_name_that_is_worked_out_is_told_and_not_written_over(tmp_path: Path):
    path = written(tmp_path, shape("visual", "meshes/${n}.stl"))
    text = path.read_text().replace("<robot ", '<robot xmlns:xacro="http://ros.org/wiki/xacro" ', 1)
    head, _, tail = text.partition(">")
    prop = '<xacro:property name="n" value="base"/>'
    xacro = path.with_suffix(".xacro")
    xacro.write_text(f"{head}>{prop}{tail}")

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, xacro)
            await document.robot_checks.settled()
            (one,) = missing(document)
            assert 'did you mean "Base.STL"?' in one.sentence
            assert one.fix is None

    asyncio.run(run())


def test_behind_the_folder_of_a_package_the_name_alone_is_written(tmp_path: Path):
    uri = "file://$(find arm_description)/meshes/base.stl"
    path = written(tmp_path, shape("visual", uri)).rename(tmp_path / "robots" / "arm.xacro")
    manifest = "<package><name>arm_description</name><version>1.0.0</version></package>"
    path.with_name("package.xml").write_text(manifest)

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, path)
            await document.robot_checks.settled()
            (one,) = missing(document)
            assert one.fix is not None
            await document.fixes.apply(one.code, one.sentence, one.fix.label)
            assert (
                uri.replace("base", "Base").replace(".stl", ".STL")
                in document.sources.text(str(path)).decode()
            )
            await until(lambda: not missing(document))

    asyncio.run(run())
