from __future__ import annotations

import asyncio
from importlib.util import find_spec
from typing import TYPE_CHECKING

from studio.problems import Severity
from studio.robot.requests import MeshAnswer, MeshRequest
from studio.robot.urdf_check import check_urdf
from studio.robot.worker import handle
from studio.robot.worker_client import UrdfValidator, robot_worker
from tests.support.xacro_command import expand_by_command

if TYPE_CHECKING:
    from pathlib import Path

    from studio.robot.requests import CheckAnswer

GOOD = """<robot name="r"><link name="a"/><link name="b"/>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/>
<limit lower="0" upper="1" effort="1" velocity="1"/></joint></robot>"""
CAPSULE = "<visual><geometry><capsule/></geometry></visual>"
PLY = """ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
property uchar red
property uchar green
property uchar blue
element face 1
property list uchar int vertex_indices
end_header
0 0 0 255 0 0
1 0 0 0 255 0
0 1 0 0 0 255
3 0 1 2
"""
TEXTS = (
    GOOD,
    GOOD.replace(' name="r"', ""),
    "no xml",
    '<!DOCTYPE r [<!ENTITY e SYSTEM "file:///etc/hostname">]><robot name="&e;"/>',
    f'<robot name="r"><link name="a">{CAPSULE}</link></robot>',
    '<robot name="r"/>',
    '<robot name="r"><a:b/><link name="a" x:y="1"/></robot>',
    GOOD,
)


def check(*texts: str) -> list[CheckAnswer]:
    """What one worker answers to these, in order."""

    async def run() -> list[CheckAnswer]:
        validator = UrdfValidator()
        try:
            return [await validator.check(text) for text in texts]
        finally:
            await validator.close()

    return asyncio.run(run())


def test_yourdfpy_is_asked_in_the_worker_and_answers_plain_values():
    good, unnamed, garbage, entity, capsule, rootless, prefixed, again = check(*TEXTS)
    assert good.links == ("a", "b")
    assert good.actuated_joints == ("j",)
    assert good.base_link == "a"
    assert not good.problems
    assert [one.code for one in unnamed.problems] == ["no-robot-name"]
    assert unnamed.links == ("a", "b")
    assert [one.code for one in garbage.problems] == ["bad-urdf"]
    assert 'entity "e"' in entity.problems[0].sentence
    assert "capsule" in capsule.problems[0].sentence
    assert (rootless.links, rootless.base_link) == ((), "")
    assert prefixed.links == ("a",)
    assert again == good
    assert [one.severity for one in unnamed.problems] == [Severity.ERROR]  # as ROS does not load it
    opinions = [one for answer in (garbage, entity, capsule) for one in answer.problems]
    assert {one.severity for one in opinions} == {Severity.WARNING}


def test_the_worker_does_without_scipy_and_answers_as_a_process_that_has_it(
    models: Path, tmp_path: Path
):
    assert find_spec("scipy")
    rover = models / "rover_description" / "urdf" / "rover.urdf.xacro"
    texts = (*TEXTS, expand_by_command(rover, models, tmp_path))
    assert check(*texts) == [check_urdf(text) for text in texts]
    mesh = tmp_path / "a.ply"
    mesh.write_text(PLY)
    request = MeshRequest(str(mesh), (str(tmp_path),), str(tmp_path / "cache"))
    assert read(request) == handle(request)


def read(request: MeshRequest) -> MeshAnswer:
    """What a worker answers."""

    async def run() -> MeshAnswer:
        worker = robot_worker("mesh")
        try:
            return await worker.ask(request, MeshAnswer, 60)
        finally:
            await worker.close()

    return asyncio.run(run())


def test_a_rule_of_urdf_that_is_broken_is_a_problem():
    (answer,) = check(GOOD.replace(' velocity="1"', ""))
    assert answer.links == ("a", "b")
    assert [one.code for one in answer.problems] == ["urdf-rule"]
