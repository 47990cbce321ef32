"""After patches a full run looks at what they made: what differs is corrected, told and logged."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.evaluator.evaluation import Evaluation
from studio.description.faults import Fault
from studio.description.patching.propagation import Propagation
from studio.description.session import Session, open_session
from studio.description.values import (
    PATCH_DIFFERED,
    Edit,
    EditRequest,
    Expansion,
    Failure,
    OpenRequest,
    VerifyRequest,
)
from tests.support.descriptions import policy_for, robot, write

if TYPE_CHECKING:
    from pathlib import Path

    import pytest

    from studio.description.evaluator.output_tree import OutputElement

BODY = (
    '<xacro:property name="r" value="0.1"/>'
    '<link name="a"><inertial><mass value="${r}"/></inertial></link>'
)


def opened(folder: Path) -> tuple[Session, Path]:
    file = write(folder, {"a.xacro": robot(BODY)})
    session, answer = open_session(OpenRequest(str(file), {}, policy_for(folder), {}))
    assert session is not None
    assert isinstance(answer, Expansion)
    return session, file


def edit(session: Session, file: Path, new: str) -> Expansion:
    start = file.read_bytes().index(b"0.1")
    answer = session.answer(EditRequest((Edit(str(file), start, start + 3, new.encode()),)))
    assert isinstance(answer, Expansion)
    assert answer.is_patch
    return answer


def test_patches_that_are_right_are_no_news(tmp_path: Path):
    session, file = opened(tmp_path)
    edit(session, file, "0.25")
    answer = session.answer(VerifyRequest())
    assert isinstance(answer, Expansion)
    assert answer.is_patch
    assert (answer.changed_parts, answer.changed_sites, answer.warnings) == ((), (), ())


def test_a_wrong_patch_is_corrected_told_and_logged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
):
    session, file = opened(tmp_path)
    right = Propagation.write

    def wrong(self: Propagation, element: OutputElement, name: str, text: str) -> None:
        right(self, element, name, text + "9")

    monkeypatch.setattr(Propagation, "write", wrong)
    assert '"0.259"' in edit(session, file, "0.25").changed_parts[0].xml
    answer = session.answer(VerifyRequest())
    assert isinstance(answer, Expansion)
    assert not answer.is_patch
    assert [(part.key, '"0.25"' in part.xml) for part in answer.changed_parts] == [("link:a", True)]
    assert [problem.code for problem in answer.warnings] == [PATCH_DIFFERED]
    assert "link:a" in caplog.text


def test_a_failure_that_patches_hid_says_that_the_robot_shown_is_theirs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
):
    session, file = opened(tmp_path)
    edit(session, file, "0.25")

    def failing(_: Evaluation, entry: str) -> OutputElement:
        raise Fault("undefined-property", f"{entry} has no robot.")

    monkeypatch.setattr(Evaluation, "run", failing)
    answer = session.answer(VerifyRequest())
    assert isinstance(answer, Failure)
    assert answer.problem.code == "undefined-property"
    assert answer.problem.sentence.startswith(f"{file} has no robot. A quick edit hid this;")
    assert "A quick edit hid this" in caplog.text


def test_without_patches_it_is_an_ordinary_run(tmp_path: Path):
    session, file = opened(tmp_path)
    broken = session.answer(EditRequest((Edit(str(file), 0, 0, b"<"),)))
    assert isinstance(broken, Failure)
    assert session.answer(VerifyRequest()) == broken
