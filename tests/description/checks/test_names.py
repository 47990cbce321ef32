from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.editing.edits import apply, edits_of
from studio.description.session import open_session
from studio.description.values import Checked, CheckQuery, OpenRequest
from studio.problems import Severity
from tests.support.checked_texts import checked
from tests.support.descriptions import policy_for, write

if TYPE_CHECKING:
    from pathlib import Path

RED, BLUE = ('<color rgba="1 0 0 1"/>', '<color rgba="0 0 1 1"/>')


def material(look: str) -> str:
    return f'<material name="paint">{look}</material>'


def test_a_robot_without_a_name_is_named_after_its_file(tmp_path: Path):
    text = "<robot>\n<link name='a'/></robot>"
    file = write(tmp_path, {"rover.urdf.xacro": text})
    session, _ = open_session(OpenRequest(str(file), {}, policy_for(tmp_path), {}))
    assert session is not None
    reply = session.query(CheckQuery())
    assert isinstance(reply, Checked)
    (problem,) = reply.problems
    assert (problem.code, problem.severity) == ("no-robot-name", Severity.WARNING)
    assert problem.fix is not None
    mended = apply(text.encode(), edits_of(problem.fix.edits, lambda _: text.encode()))
    assert mended.decode() == text.replace("<robot>", '<robot name="rover">')


def test_two_looks_of_one_material_are_noted_and_a_repeat_is_not(tmp_path: Path):
    link = '<link name="a"/>'
    assert checked(tmp_path, material(RED) + material(RED) + link) == ()
    (problem,) = checked(tmp_path, f"{material(RED)}\n{material(BLUE)}{material(BLUE)}{link}")
    assert (problem.code, problem.severity) == ("duplicate-material", Severity.INFO)
    assert "line 2" in problem.sentence
    assert problem.parts == ()
    assert problem.place is not None
    assert problem.place.line == 3
