from __future__ import annotations

import pytest

from studio.problems import Severity
from tests.support.checked import checked, codes, joint, link, mended, problem_of, robot, without

BOTH = 'effort="1" velocity="1"'


def joined(kind: str, inner: str = "") -> str:
    return robot(link("base"), link("arm"), joint(kind, "arm", inner))


@pytest.mark.parametrize(
    ("kind", "inner", "code"),
    [
        ("revolute", "", "missing-limit"),
        ("prismatic", '<axis xyz="0 0 1"/>', "missing-limit"),
        ("revolute", f'<limit lower="1" upper="-1" {BOTH}/>', "reversed-limits"),
        ("prismatic", f'<limit lower="0.1" upper="0" {BOTH}/>', "reversed-limits"),
        ("revolute", f'<limit lower="0.5" {BOTH}/>', "reversed-limits"),
        ("prismatic", f"<limit {BOTH}/>", "equal-limits"),
        ("revolute", '<limit lower="-1" upper="1" velocity="1"/>', "limit-without-effort"),
        ("continuous", '<limit effort="1"/>', "limit-without-velocity"),
        ("fixed", '<limit effort="1"/>', "limit-without-velocity"),
        ("continuous", '<axis xyz="0 0 0"/>', "zero-axis"),
        ("planar", '<axis xyz="0 0 0"/>', "zero-axis"),
    ],
)
def test_a_joint_that_cannot_work_is_found(kind: str, inner: str, code: str):
    assert codes(joined(kind, inner)) == [code]
    problem = problem_of(checked(joined(kind, inner)), code)
    assert 'oint "arm"' in problem.sentence
    assert problem.parts == ("joint:arm",)
    assert problem.place is not None
    assert problem.place.line == 4


@pytest.mark.parametrize(
    ("kind", "inner"),
    [
        ("revolute", f'<limit lower="-1" upper="1" {BOTH}/>'),
        ("revolute", '<limit lower="-1" upper="1" effort="0" velocity="0"/>'),
        ("continuous", ""),
        ("continuous", f"<limit {BOTH}/>"),
        ("continuous", f'<limit lower="1" upper="-1" {BOTH}/>'),
        ("fixed", '<axis xyz="0 0 0"/>'),
        ("floating", '<axis xyz="0 0 0"/>'),
        ("continuous", '<axis xyz="0 0 1e-9"/>'),
    ],
)
def test_a_joint_that_works_is_left_alone(kind: str, inner: str):
    assert not codes(joined(kind, inner))


def test_a_limit_that_cannot_be_read_is_not_a_missing_one():
    assert not codes(joined("revolute", '<limit lower="x" upper="1" effort="1" velocity="1"/>'))


def test_what_ros_rejects_is_an_error_and_what_it_takes_is_none():
    assert problem_of(checked(joined("revolute")), "missing-limit").severity is Severity.ERROR
    stuck = checked(joined("revolute", f"<limit {BOTH}/>"))
    assert problem_of(stuck, "equal-limits").severity is Severity.WARNING


@pytest.mark.parametrize(
    ("kind", "inner", "after"),
    [
        ("revolute", f"<limit upper='-1' lower='1' {BOTH}/>", "<limit upper='1' lower='-1'"),
        ("revolute", f'<limit lower="0.50" {BOTH}/>', '<limit upper="0.50" lower="0"'),
        ("prismatic", f'<limit upper="-0.10" {BOTH}/>', '<limit lower="-0.10" upper="0"'),
    ],
)
def test_reversed_limits_are_swapped_as_they_are_written(kind: str, inner: str, after: str):
    text = mended(joined(kind, inner), "reversed-limits")
    assert after in text
    assert not codes(text)


@pytest.mark.parametrize(
    ("kind", "inner", "code"),
    [
        ("revolute", "", "missing-limit"),
        ("prismatic", "", "missing-limit"),
        ("revolute", '<limit lower="-1" upper="1" velocity="1"/>', "limit-without-effort"),
        ("fixed", '<limit effort="1"/>', "limit-without-velocity"),
        ("revolute", f'<axis xyz="0 0 0"/><limit lower="-1" upper="1" {BOTH}/>', "zero-axis"),
    ],
)
def test_one_click_mends_a_joint(kind: str, inner: str, code: str):
    assert not codes(mended(joined(kind, inner), code))


def test_a_limit_of_two_missing_numbers_is_two_findings_that_are_mended_one_after_the_other():
    one = joined("revolute", '<limit lower="-1" upper="1"/>')
    assert codes(one) == ["limit-without-effort", "limit-without-velocity"]
    one = mended(one, "limit-without-effort")
    assert without(codes(one), "limit-without-velocity") == []
    assert not codes(mended(one, "limit-without-velocity"))
