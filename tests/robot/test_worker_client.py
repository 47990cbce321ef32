from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from studio.problems import Severity
from studio.robot.worker_client import UrdfValidator

if TYPE_CHECKING:
    from studio.robot.worker_client import CheckAnswer

GOOD = """<robot name="r"><link name="a"/><link name="b"/>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/>
<limit lower="0" upper="1" effort="1" velocity="1"/></joint></robot>"""
CAPSULE = "<visual><geometry><capsule/></geometry></visual>"


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
    good, unnamed, garbage, entity, capsule, rootless, prefixed, again = check(
        GOOD,
        GOOD.replace(' name="r"', ""),
        "no xml",
        '<!DOCTYPE r [<!ENTITY e SYSTEM "file:///etc/hostname">]><robot name="&e;"/>',
        f'<robot name="r"><link name="a">{CAPSULE}</link></robot>',
        '<robot name="r"/>',
        '<robot name="r"><a:b/><link name="a" x:y="1"/></robot>',
        GOOD,
    )
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


def test_a_rule_of_urdf_that_is_broken_is_a_problem():
    (answer,) = check(GOOD.replace(' velocity="1"', ""))
    assert answer.links == ("a", "b")
    assert [one.code for one in answer.problems] == ["urdf-rule"]
