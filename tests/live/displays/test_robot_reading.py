"""Descriptions of others, read by a real worker."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from studio.description.client import DescriptionWorker
from studio.description.values import ReadPolicy
from studio.live.displays.robot_reading import RobotReader

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine

    from studio.live.displays.robot_reading import DescribedRobot


@dataclass
class Files:
    """A file is named by its path, and these folders may be read."""

    folder: Path

    @property
    def policy(self) -> ReadPolicy:
        return ReadPolicy((str(self.folder),), {}, {})

    def resolve_uri(self, uri: str) -> Path:
        return Path(uri)


def read(
    folder: Path,
    ask: Callable[[RobotReader], Coroutine[None, None, DescribedRobot]],
    readable: Path | None = None,
) -> DescribedRobot:
    async def run() -> DescribedRobot:
        reader = RobotReader(DescriptionWorker, Files(readable or folder), folder / "nowhere")
        try:
            return await ask(reader)
        finally:
            await reader.close()

    return asyncio.run(run())


def test_a_text_becomes_a_robot(tmp_path: Path):
    text = "<robot name='r'><link name='a'/><link name='ü'/></robot>"
    second = read(tmp_path, lambda reader: reader.read_text(text))
    assert (list(second.robot.links), second.fault) == (["a", "ü"], "")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("<robot><link", "robot_description:1:8: A <link> has no name"),
        ("<html/>", "<html>"),
        ("<!DOCTYPE r [<!ENTITY a 'b'>]><robot><link name='&a;'/></robot>", "entit"),
        ("<a>" * 3000, "nested"),
        (
            "<robot xmlns:xacro='http://www.ros.org/wiki/xacro'>"
            "<xacro:include filename='../secret.xacro'/></robot>",
            "outside",
        ),
    ],
)
def test_what_is_wrong_with_a_text_is_said(text: str, said: str, tmp_path: Path):
    (tmp_path / "secret.xacro").write_text("<robot><link name='secret'/></robot>")
    second = read(tmp_path, lambda reader: reader.read_text(text))
    assert said in second.fault
    assert str(tmp_path / "nowhere") not in second.fault
    assert "secret" not in second.robot.links


def test_a_file_is_read_under_the_rules_of_its_place(tmp_path: Path):
    file = tmp_path / "r.urdf"
    file.write_text("<robot name='r'><link name='a'/></robot>")

    def robot_where(readable: Path) -> DescribedRobot:
        return read(tmp_path, lambda reader: reader.read_file(str(file)), readable)

    assert list(robot_where(tmp_path).robot.links) == ["a"]
    assert "outside" in robot_where(tmp_path / "other").fault
