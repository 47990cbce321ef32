from __future__ import annotations

import json
from pathlib import Path

import pytest

from studio.documents.check_run import CheckedFile, exit_code, report_json, report_lines
from studio.problems import Fix, MacroCall, Place, Problem, Severity

HERE = Path("/here")
WRONG = Problem(
    Severity.ERROR,
    "cycle",
    "The joints go round.",
    Place("/here/a.xacro", 3, 5),
    macro_stack=(MacroCall("wheel", Place("/here/b.xacro", 7, 1)),),
    fix=Fix("Cut one", "edit"),
)
NOTE = Problem(Severity.INFO, "unused-arg", "Nothing reads “ü”.")
EMPTY = Problem(Severity.ERROR, "file-empty", "The file is empty.", Place("/here/e.urdf", 1, 1))
GOOD, BAD = CheckedFile(HERE / "g.urdf", (NOTE,)), CheckedFile(HERE / "a.xacro", (WRONG,))
UNREAD = CheckedFile(HERE / "e.urdf", (EMPTY,))


def test_a_finding_is_a_line_that_editors_understand_with_its_calls_and_its_fix():
    assert list(report_lines([BAD, GOOD], HERE)) == [
        "a.xacro:3:5: error: The joints go round.",
        "    in wheel, called at /here/b.xacro:7:1",
        "    fix: Cut one",
        "g.urdf: note: Nothing reads “ü”.",
        "2 files checked: 1 error, 1 note.",
    ]
    assert list(report_lines([CheckedFile(HERE, ())], HERE)) == ["1 file checked: nothing found."]


def test_what_two_robots_share_is_told_once():
    other = CheckedFile(HERE / "c.xacro", (WRONG,))
    assert list(report_lines([BAD, other], HERE))[-1] == "2 files checked: 1 error."
    assert len(json.loads(report_json([BAD, other, GOOD, GOOD]))) == 2


def test_json_has_one_object_for_each_finding():
    assert json.loads(report_json([BAD, GOOD])) == [
        {
            "severity": "error",
            "code": "cycle",
            "message": "The joints go round.",
            "file": "/here/a.xacro",
            "line": 3,
            "column": 5,
            "fix": "Cut one",
        },
        {
            "severity": "info",
            "code": "unused-arg",
            "message": "Nothing reads “ü”.",
            "file": "/here/g.urdf",
            "line": None,
            "column": None,
            "fix": None,
        },
    ]


@pytest.mark.parametrize(
    ("files", "code"),
    [([GOOD], 0), ([GOOD, BAD], 1), ([UNREAD], 2), ([UNREAD, GOOD], 1), ([UNREAD, BAD], 1)],
)
def test_the_exit_code_says_how_bad_it_is(files: list[CheckedFile], code: int):
    assert exit_code(files) == code


def test_what_robots_share_under_other_prefixes_is_told_of_the_first_of_them():
    def wheels(robot: str, *prefixes: str) -> CheckedFile:
        found = [
            Problem(
                Severity.ERROR,
                "bad-mass",
                f'Link "{one}wheel" weighs nothing.',
                Place("/here/wheel.xacro", 2, 1),
                parts=(f"link:{one}wheel",),
            )
            for one in prefixes
        ]
        return CheckedFile(HERE / robot, tuple(found))

    files = [wheels("a.xacro", "left_", "right_"), wheels("b.xacro", "front_")]
    lines = list(report_lines(files, HERE))
    assert [line.partition('"')[2].partition('"')[0] for line in lines[:-1]] == [
        "left_wheel",
        "right_wheel",
    ]
    assert lines[-1] == "2 files checked: 2 errors."
