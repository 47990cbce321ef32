"""Group states out of an SRDF, expanded by the same worker as a robot description."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.description.poses import group_states
from studio.description.session import Session
from studio.description.values import Expansion, OpenRequest, ReadPolicy

if TYPE_CHECKING:
    from pathlib import Path

SRDF = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="prefix" default=""/>
  <group name="all"><joint name="$(arg prefix)a"/></group>
  <group_state name="up" group="all">
    <joint name="$(arg prefix)a" value="${pi / 2}"/>
    <joint name="float" value="0 0 0 0 0 0 1"/>
    <joint name="odd" value="nan"/>
  </group_state>
  <group_state name=" " group="all"><joint name="a" value="0"/></group_state>
  <group_state name="empty" group="all"/>
  <disable_collisions link1="x" link2="y"/>
</robot>
"""


def run(path: Path, arguments: dict[str, str]) -> Expansion:
    policy = ReadPolicy((str(path.parent),), {}, {})
    answer = Session(OpenRequest(str(path), arguments, policy, {})).run()
    assert isinstance(answer, Expansion)
    return answer


def test_states_have_their_group_place_and_numbers(tmp_path: Path):
    path = tmp_path / "arm.srdf.xacro"
    path.write_text(SRDF)
    (found,) = group_states(run(path, {"prefix": "left_"}))
    assert (found.name, found.group) == ("up", "all")
    assert found.positions == {"left_a": pytest.approx(1.5707963)}
    assert found.unread == ("float", "odd")
    assert (found.file, found.line) == (str(path), 4)


def test_a_robot_has_none(tmp_path: Path):
    path = tmp_path / "arm.urdf"
    path.write_text('<robot name="arm"><link name="group_state"/></robot>')
    assert list(group_states(run(path, {}))) == []
