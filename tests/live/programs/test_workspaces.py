"""What the opened folders hold, asked as a page asks; packages made and taken back."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any, Literal

import pytest

from studio.errors import CommandError, NotRunnableError
from studio.protocol.workspaces import (
    AddToPackage,
    CreatePackage,
    GetWorkspaces,
    MendPackage,
    UndoPackageEdit,
)
from tests.support.run_studio import run_studio, workspace

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from tests.support.run_studio import RunStudio


async def told(studio: RunStudio, holds: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
    """Ask until it is read, and holds; the answer."""
    async with asyncio.timeout(60):
        while True:
            answer = await studio.ask(GetWorkspaces())
            if not answer["is_reading"] and holds(answer):
                return answer
            await asyncio.sleep(0.05)


def names(answer: dict[str, Any]) -> list[str]:
    return [one["name"] for ws in answer["workspaces"] for one in ws["packages"]]


def build_files(folder: Path) -> list[bytes]:
    return [(folder / name).read_bytes() for name in ("setup.py", "package.xml")]


def test_a_workspace_is_told_with_what_may_run(tmp_path: Path):
    async def run() -> None:
        ws = workspace(tmp_path / "ws")
        async with run_studio(tmp_path / "data", ws) as studio:
            answer = await told(studio, bool)
            assert answer["run_folders"] == [str(ws)]
            (package,) = answer["workspaces"][0]["packages"]
            assert package["name"] == "talk"
            assert package["may_run"]
            assert [one["name"] for one in package["executables"]] == ["speaker"]
            assert package["launch_files"][0]["file"].endswith("hall.launch.py")

    asyncio.run(run())


def test_what_is_written_elsewhere_is_told_anew(tmp_path: Path):
    async def run() -> None:
        ws = workspace(tmp_path / "ws")
        async with run_studio(tmp_path / "data", ws) as studio:
            await told(studio, bool)
            workspace(ws / "src" / "more")
            answer = await told(studio, lambda one: len(names(one)) == 2)
            assert names(answer) == ["talk", "talk"]

    asyncio.run(run())


def test_a_package_is_made_told_and_taken_back(tmp_path: Path):
    async def run() -> None:
        ws = workspace(tmp_path / "ws")
        async with run_studio(tmp_path / "data", ws) as studio:
            made = await studio.ask(CreatePackage(folder=str(ws), name="fresh", node_name="begin"))
            assert made["opened"] == str(ws / "src/fresh/fresh/begin.py")
            assert names(await told(studio, lambda one: "fresh" in names(one)))
            await studio.ask(UndoPackageEdit(edit=made["edit"]))
            assert not (ws / "src/fresh").exists()
            assert await told(studio, lambda one: "fresh" not in names(one))
            with pytest.raises(CommandError, match="cannot be taken back"):
                await studio.ask(UndoPackageEdit(edit=made["edit"]))

    asyncio.run(run())


def test_an_edit_is_not_taken_back_once_a_file_was_changed(tmp_path: Path):
    async def run() -> None:
        ws = workspace(tmp_path / "ws")
        async with run_studio(tmp_path / "data", ws) as studio:
            made = await studio.ask(CreatePackage(folder=str(ws), name="fresh", node_name="begin"))
            node = ws / "src/fresh/fresh/begin.py"
            node.write_text("# mine\n")
            with pytest.raises(CommandError, match="changed since"):
                await studio.ask(UndoPackageEdit(edit=made["edit"]))
            assert node.read_text() == "# mine\n"

    asyncio.run(run())


def test_no_package_is_made_elsewhere(tmp_path: Path):
    async def run() -> None:
        ws = workspace(tmp_path / "ws")
        for folders in ((), (ws / "src" / "talk",)):
            async with run_studio(tmp_path / "data", *folders) as studio:
                with pytest.raises(NotRunnableError, match="--allow-run"):
                    await studio.ask(CreatePackage(folder=str(ws), name="fresh"))
                assert not (ws / "src/fresh").exists()

    asyncio.run(run())


def test_a_finding_is_told_mended_and_its_mend_is_taken_back(tmp_path: Path):
    async def run() -> None:
        ws = workspace(tmp_path / "ws")
        manifest = ws / "src/talk/package.xml"
        without = manifest.read_text().replace("  <depend>std_msgs</depend>\n", "")
        manifest.write_text(without)
        async with run_studio(tmp_path / "data", ws) as studio:
            answer = await told(studio, lambda one: bool(one["workspaces"][0]["problems"]))
            problems = answer["workspaces"][0]["problems"]
            (problem,) = (one for one in problems if "std_msgs" in one["sentence"])
            named = {"code": problem["code"], "sentence": problem["sentence"]}
            mend = MendPackage(**named, label=problem["fix"]["label"])
            made = await studio.ask(mend)
            assert "std_msgs" in manifest.read_text()
            await told(
                studio,
                lambda one: all(
                    "std_msgs" not in each["sentence"] for each in one["workspaces"][0]["problems"]
                ),
            )
            await studio.ask(UndoPackageEdit(edit=made["edit"]))
            assert manifest.read_text() == without
            with pytest.raises(CommandError, match="no longer found"):
                await studio.ask(MendPackage(code="x", sentence="x", label="x"))

    asyncio.run(run())


@pytest.mark.parametrize(
    ("what", "name", "file"),
    [
        ("node", "extra", "talk/extra.py"),
        ("launch_file", "both", "launch/both.launch.py"),
    ],
)
def test_something_is_added_to_a_package_with_what_its_build_needs(
    tmp_path: Path, what: Literal["node", "launch_file"], name: str, file: str
):
    async def run() -> None:
        ws = workspace(tmp_path / "ws")
        folder = ws / "src/talk"
        before = build_files(folder)
        async with run_studio(tmp_path / "data", ws) as studio:
            add = AddToPackage(package=str(folder), what=what, name=name, template="publisher")
            made = await studio.ask(add)
            assert made["opened"] == str(folder / file)
            assert build_files(folder) != before
            await studio.ask(UndoPackageEdit(edit=made["edit"]))
            assert not (folder / file).exists()
            assert build_files(folder) == before

    asyncio.run(run())


def test_packages_for_interfaces_and_for_a_robot_are_made(tmp_path: Path):
    async def run() -> None:
        ws = workspace(tmp_path / "ws")
        async with run_studio(tmp_path / "data", ws) as studio:
            made = {"folder": str(ws), "build_type": "ament_cmake"}
            for name, contents in (("talk_interfaces", "interfaces"), ("talk_desc", "description")):
                wanted = {**made, "name": name, "contents": contents}
                await studio.ask(CreatePackage.model_validate(wanted))
            folder = ws / "src/talk_interfaces"
            text = "string words\n---\nbool heard\n"
            add = AddToPackage(package=str(folder), what="service", name="Say", text=text)
            await studio.ask(add)
            assert (folder / "srv/Say.srv").read_text() == text
            assert '"srv/Say.srv"' in (folder / "CMakeLists.txt").read_text()
            answer = await told(studio, lambda one: len(names(one)) == 3)
            assert set(names(answer)) == {"talk", "talk_interfaces", "talk_desc"}

    asyncio.run(run())
