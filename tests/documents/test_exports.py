"""The robot for other programs: what they read is the robot that is open here, edits included."""

from __future__ import annotations

import asyncio
import io
import zipfile
from typing import TYPE_CHECKING

import pytest

from studio.errors import CommandError
from studio.protocol.texts import GetUrdf
from tests.support.open_documents import engine, opened
from tests.support.packages import write_package
from tests.support.yourdfpy_poses import loaded_by_yourdfpy

if TYPE_CHECKING:
    from pathlib import Path

    from studio.documents.exports import Download


TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n"
ARM = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="$(find tool)/tool.xacro"/>
  <xacro:property name="reach" value="0.4"/>
  <link name="base"><visual><geometry>
    <mesh filename="package://arm/meshes/a.obj"/></geometry></visual></link>
  <link name="tip"><visual><geometry>
    <mesh filename="package://tool/a.obj" scale="2 2 2"/></geometry></visual></link>
  <joint name="hold" type="fixed"><parent link="base"/><child link="tip"/>
    <origin xyz="${reach} 0 0"/></joint>
</robot>
"""


@pytest.fixture
def arm(tmp_path: Path) -> Path:
    files = {
        "urdf/arm.urdf.xacro": ARM,
        "meshes/a.obj": f"mtllib a.mtl\n{TRIANGLE}",
        "meshes/a.mtl": "newmtl red\nKd 1 0 0\n",
    }
    package = write_package(tmp_path / "ws/src/arm", files=files)
    write_package(
        tmp_path / "ws/src/tool", files={"tool.xacro": "<robot/>", "a.obj": TRIANGLE, "b": ""}
    )
    return package / "urdf/arm.urdf.xacro"


def whole(download: Download) -> bytes:
    return b"".join(download.chunks)


def unpacked(download: Download, folder: Path) -> set[str]:
    """Unpack a downloaded zip; the names in it."""
    with zipfile.ZipFile(io.BytesIO(whole(download))) as archive:
        archive.extractall(folder)
        return set(archive.namelist())


def test_a_urdf_with_paths_and_one_with_copies_are_read_by_another_program(
    arm: Path, tmp_path: Path
):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, arm)
            await document.edits.edit_site(ear.site("reach")["id"], "0.5", "")
            plain = await document.exports.urdf("package")
            assert (plain.name, whole(plain)) == ("arm.urdf", (await document.urdf.text()).encode())
            copied = await document.exports.urdf("copied")
            assert unpacked(copied, tmp_path / "out") == {
                "arm/arm.urdf",
                "arm/meshes/arm/meshes/a.obj",
                "arm/meshes/arm/meshes/a.mtl",
                "arm/meshes/tool/a.obj",
            }
            (tmp_path / "out/absolute.urdf").write_bytes(
                whole(await document.exports.urdf("absolute"))
            )

    asyncio.run(run())
    for name in ("arm/arm.urdf", "absolute.urdf"):
        assert loaded_by_yourdfpy(tmp_path / "out" / name, "hold") == ([0.5, 0, 0], 2)


def test_the_packages_hold_the_edits_and_open_as_the_same_robot(arm: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, arm)
            await document.edits.edit_site(ear.site("reach")["id"], "0.5", "")
            alone = await document.exports.package(all_used=False)
            assert alone.name == "arm.zip"
            assert unpacked(alone, tmp_path / "alone") == {
                "arm/package.xml",
                "arm/urdf/arm.urdf.xacro",
                "arm/meshes/a.obj",
                "arm/meshes/a.mtl",
            }
            text = (tmp_path / "alone/arm/urdf/arm.urdf.xacro").read_text()
            assert text == ARM.replace("0.4", "0.5")
            assert arm.read_text() == ARM
            zipped = tmp_path / "all.zip"
            zipped.write_bytes(whole(await document.exports.package(all_used=True)))
            again, _ = await opened(made, zipped)
            assert (again.entry.name, again.has_unsaved) == (arm.name, False)
            assert (await again.urdf.text()) == (await document.urdf.text())

    asyncio.run(run())


def test_a_file_in_no_package_is_packed_with_what_it_read(tmp_path: Path):
    folder = tmp_path / "loose"
    folder.mkdir()
    include = '<robot name="a"><xacro:include filename="parts/b.xacro"/><link name="a"/></robot>'
    entry = folder / 'r"ü🤖.xacro'
    entry.write_text(
        include.replace("<robot", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"')
    )
    (folder / "parts").mkdir()
    (folder / "parts/b.xacro").write_text("<robot/>")
    (folder / "other.txt").write_text("not the robot's")

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, entry)
            packed = await document.exports.package(all_used=False)
            assert unpacked(packed, tmp_path / "out") == {
                'r"ü🤖/r"ü🤖.xacro',
                'r"ü🤖/parts/b.xacro',
            }

    asyncio.run(run())


def test_a_robot_that_never_was_is_not_exported(tmp_path: Path):
    entry = tmp_path / "a.urdf"
    entry.write_text("no robot")

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, entry)
            with pytest.raises(CommandError, match="mend its problems"):
                await document.exports.urdf("package")
            with pytest.raises(CommandError, match="mend its problems"):
                await document.exports.page(dark=True)

    asyncio.run(run())


def test_the_page_holds_the_robot_as_it_is_posed(arm: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, arm)
            page = await document.exports.page(dark=False)
            text = whole(page).decode()
            assert page.name == "arm.html"
            assert "<title>arm</title>" in text
            assert "default-src 'none'" in text
            assert "__VISER_EMBED_DATA__" in text
            await made.execute(GetUrdf(document=document.id), ear)  # the view lives on

    asyncio.run(run())
