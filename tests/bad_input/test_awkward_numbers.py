"""Numbers that are none, typed wherever a number is typed: told, never drawn, never a crash."""

from __future__ import annotations

import asyncio
import json
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from studio.protocol import Command
from tests.support.open_documents import Ear, engine, opened
from tests.support.packages import write_package
from tests.support.sweep import some_of

if TYPE_CHECKING:
    from pathlib import Path

    from studio.documents.document import Document


MAST = """<robot name="mast" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="c" value="${xacro.load_yaml('$(find mast)/c.yaml')}"/>
  <xacro:property name="reach" value="0.4"/>
  <link name="base"><visual><geometry><box size="1 1 ${c['depth']}"/></geometry></visual></link>
  <link name="tip"/>
  <joint name="turn" type="revolute"><parent link="base"/><child link="tip"/>
    <origin xyz="0 0 ${reach}"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
</robot>
"""
NONE_OF_THEM_NUMBERS = ("nan", "1e999", "-inf", "0x10", "1,5", "1_000", "1e", "--1")

NUMBERS_TO_YAML = {("depth", "0x10"), ("depth", "1_000")}


@pytest.fixture
def mast(tmp_path: Path) -> Path:
    files = {"mast.urdf.xacro": MAST, "c.yaml": "depth: 2.0\n"}
    return write_package(tmp_path / "mast", files=files) / "mast.urdf.xacro"


def sentences(ear: Ear) -> str:
    return " ".join(one["sentence"] for one in ear.last("problems")["problems"])


def assert_drawn(document: Document) -> None:
    """Every pose that is sent to a page is a place."""
    model = document.model
    assert np.isfinite(model.kinematics.wxyz_xyz(model.joints.values)).all()


@pytest.mark.parametrize("text", some_of(NONE_OF_THEM_NUMBERS))
@pytest.mark.parametrize("site", ["reach", "depth"])
def test_typed_into_a_property_or_a_yaml_value_it_is_told_and_undone(
    text: str, site: str, mast: Path, tmp_path: Path
):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            await document.edits.edit_site(ear.site(site)["id"], text, "")
            if (site, text) not in NUMBERS_TO_YAML:
                assert "write" in sentences(ear), sentences(ear)
            assert_drawn(document)
            json.dumps(ear.events, allow_nan=False)  # else no browser could read them
            await document.edits.undo()
            assert ear.last("problems")["problems"] == []
            assert not document.has_unsaved

    asyncio.run(run())


@pytest.mark.parametrize("text", some_of(NONE_OF_THEM_NUMBERS))
def test_written_in_the_source_it_is_told_at_its_line(text: str, mast: Path, tmp_path: Path):
    mast.write_text(MAST.replace('upper="1"', f'upper="{text}"'))

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            lines = [one["place"]["line"] for one in ear.last("problems")["problems"]]
            assert 8 in lines or 6 in lines, ear.last("problems")
            assert_drawn(document)

    asyncio.run(run())


@pytest.mark.parametrize("number", ["NaN", "1e999", "-Infinity", '"0x10"', "null"])
def test_a_joint_is_not_sent_there(number: str):
    wish = f'{{"type": "set_joints", "document": "d", "positions": {{"turn": {number}}}}}'
    adapter: TypeAdapter[Any] = TypeAdapter(Command)
    with pytest.raises(ValidationError):
        adapter.validate_json(wish)
