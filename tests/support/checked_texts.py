"""Texts of a description, checked, and mended by what the checks offer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.editing.edits import apart, apply, edits_of
from studio.description.session import open_session
from studio.description.values import Checked, CheckQuery, Failure, OpenRequest
from tests.support.descriptions import policy_for, robot, write

if TYPE_CHECKING:
    from pathlib import Path

    from studio.problems import Problem


def checked(folder: Path, body: str, **more: str) -> tuple[Problem, ...]:
    """What is found in a robot with this body, in lines of its own; `more` are further files."""
    files = {"r.xacro": robot(f"\n{body}\n")} | {f"{n}.xacro": text for n, text in more.items()}
    file = write(folder, dict(files))
    request = OpenRequest(str(file), {}, policy_for(folder), {})
    session, answer = open_session(request)
    assert session is not None
    if isinstance(answer, Failure):
        return answer.problems or (answer.problem,)
    reply = session.query(CheckQuery())
    assert isinstance(reply, Checked), reply
    return reply.problems


def mended(folder: Path, problems: tuple[Problem, ...]) -> str:
    """The body of the robot after all that is found was mended."""
    data = (folder / "r.xacro").read_bytes()
    fixes = [one.fix.edits for one in problems if one.fix]
    text = apply(data, edits_of(apart(fixes), lambda _: data)).decode()
    return text[text.index("\n") + 1 : text.rindex("\n")]
