"""The second opinion on a URDF is told as problems, and nowhere else."""

from __future__ import annotations

import pytest

from studio.robot.urdf_check import check_urdf


@pytest.mark.parametrize(
    "body",
    [
        '<link name="a"/><link name="b"/>',
        '<link name="a"/><joint name="j" type="odd"><parent link="a"/><child link="a"/></joint>',
    ],
)
def test_nothing_is_written_on_the_terminal(
    body: str, caplog: pytest.LogCaptureFixture, capfd: pytest.CaptureFixture[str]
):
    check_urdf(f'<robot name="r">{body}</robot>')
    assert caplog.records == []
    assert capfd.readouterr() == ("", "")


def test_a_broken_rule_names_the_joint_that_breaks_it():
    ends = '<parent link="a"/><child link="{}"/><limit effort="1" velocity="1"/>'
    joints = "".join(
        f'<joint name="to_{one}" type="revolute">{ends.format(one)}</joint>' for one in "bc"
    )
    found = check_urdf(
        f'<robot name="r"><link name="a"/><link name="b"/><link name="c"/>{joints}</robot>'
    )
    assert {one.parts for one in found.problems} == {("joint:to_b",), ("joint:to_c",)}
    assert all(one.sentence.startswith('Joint "to_') for one in found.problems)
