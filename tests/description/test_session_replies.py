"""Questions are answered from the last good run, whatever the texts have become since."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.origins.origin_values import PartOrigin, PartOriginQuery
from studio.description.session import Session, open_session
from studio.description.values import EditRequest, Expansion, Failure, NoReply, OpenRequest
from tests.support.descriptions import policy_for, robot, write
from tests.support.edits import replacement

if TYPE_CHECKING:
    from pathlib import Path

GOOD = robot('<xacro:macro name="m" params="n"><link name="${n}"/></xacro:macro><xacro:m n="a"/>')


def opened(file: Path) -> Session:
    session, answer = open_session(OpenRequest(str(file), {}, policy_for(file.parent), {}))
    assert session is not None
    assert isinstance(answer, Expansion | Failure)
    return session


def test_a_question_on_a_broken_text_is_answered_from_the_last_good_run(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": GOOD})
    session = opened(file)
    broken = session.answer(EditRequest((replacement(file, "<link", "<<link"),)))
    assert isinstance(broken, Failure)
    reply = session.query(PartOriginQuery("link:a"))
    assert isinstance(reply, PartOrigin)
    assert [call.macro for call in reply.calls] == ["m"]
    assert reply.place.file == str(file)


def test_a_part_that_is_not_there_is_told_in_a_sentence(tmp_path: Path):
    session = opened(write(tmp_path, {"a.xacro": GOOD}))
    reply = session.query(PartOriginQuery("link:b"))
    assert isinstance(reply, NoReply)
    assert '"link:b"' in reply.sentence


def test_before_the_first_good_run_there_is_no_answer(tmp_path: Path):
    session = opened(write(tmp_path, {"a.xacro": robot("<xacro:nothing/>")}))
    reply = session.query(PartOriginQuery("link:a"))
    assert isinstance(reply, NoReply)
    assert "mend its problems" in reply.sentence
