"""Descriptions of others, read by a real worker."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.description.client import DescriptionWorker
from studio.description.values import ReadPolicy
from studio.documents.edit_loop import Target
from studio.live.displays.robot_reading import RobotReader

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine
    from pathlib import Path

    from studio.documents.states.second_robot import SecondRobot


def read(
    folder: Path, ask: Callable[[RobotReader], Coroutine[None, None, SecondRobot]]
) -> SecondRobot:
    async def run() -> SecondRobot:
        reader = RobotReader(DescriptionWorker, folder / "nowhere")
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


def test_a_file_is_read_under_the_rules_of_its_target(tmp_path: Path):
    file = tmp_path / "r.urdf"
    file.write_text("<robot name='r'><link name='a'/></robot>")
    inside = Target(str(file), ReadPolicy((str(tmp_path),), {}, {}))
    assert list(read(tmp_path, lambda reader: reader.read_file(inside)).robot.links) == ["a"]
    beside = Target(str(file), ReadPolicy((str(tmp_path / "other"),), {}, {}))
    assert "outside" in read(tmp_path, lambda reader: reader.read_file(beside)).fault
