from __future__ import annotations

import pytest

from studio.problems import Severity
from tests.support.checked import checked, codes, joint, link, mended, problem_of, robot


def joined(kind: str) -> str:
    return robot(link("base"), link("arm"), joint(kind, "arm"))


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("continous", "continuous"),
        ("Fixed", "fixed"),
        ("revolut", "revolute"),
        ("hinge", "revolute"),
        ("Slider", "prismatic"),
    ],
)
def test_a_type_that_is_nearly_one_is_mended_by_a_click(written: str, meant: str):
    problem = problem_of(checked(joined(written)), "joint-type")
    assert problem.severity is Severity.ERROR
    assert f'"{written}"' in problem.sentence
    assert f'did you mean "{meant}"?' in problem.sentence
    assert problem.parts == ("joint:arm",)
    after = mended(joined(written), "joint-type")
    assert f'type="{meant}"' in after
    assert "joint-type" not in codes(after)


@pytest.mark.parametrize(("written", "said"), [("ball", 'is of type "ball"'), ("", "has no type")])
def test_of_any_other_type_those_that_there_are_are_named(written: str, said: str):
    problem = problem_of(checked(joined(written)), "joint-type")
    assert said in problem.sentence
    assert "URDF knows fixed, revolute" in problem.sentence
    assert problem.fix is None


@pytest.mark.parametrize("written", ["fixed", " fixed ", "continuous", "floating", "planar"])
def test_types_of_urdf_are_left_alone(written: str):
    assert "joint-type" not in codes(joined(written))
