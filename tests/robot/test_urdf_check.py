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
