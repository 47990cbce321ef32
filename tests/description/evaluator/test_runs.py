"""Broken texts that never gave a robot are drawn as far as they go; else the last one stays."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.session import Session, open_session
from studio.description.values import Edit, EditRequest, Expansion, Failure, OpenRequest
from studio.problems import Severity
from tests.support.descriptions import XMLNS, policy_for, robot, write

if TYPE_CHECKING:
    from pathlib import Path

BROKEN = f"""<robot name="r" {XMLNS}><xacro:property name="p" value="2"/>
<link name="a">
<link name="${{p}}"/>
</robot>"""
WHOLE = BROKEN.replace('<link name="a">', '<link name="a"/>')


def opened(file: Path) -> tuple[Session, Expansion | Failure]:
    session, answer = open_session(OpenRequest(str(file), {}, policy_for(file.parent), {}))
    assert session is not None
    return session, answer


def test_a_first_text_that_is_broken_is_drawn_with_its_faults_as_errors(tmp_path: Path):
    _, answer = opened(write(tmp_path, {"a.xacro": BROKEN}))
    assert isinstance(answer, Expansion)
    assert answer.is_recovered
    assert answer.part_order == ("link:a", "link:2")
    (problem,) = answer.warnings
    assert (problem.severity, problem.code) == (Severity.ERROR, "xml-open-element")
    assert problem.place is not None
    assert (problem.place.line, problem.place.column) == (2, 1)
    assert problem.fix is not None
    assert answer.changed_sites == ()


def test_a_text_that_is_mended_gives_its_sites_and_only_what_changed(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": BROKEN})
    session, _ = opened(file)
    at = BROKEN.index('<link name="a">') + len('<link name="a"')
    answer = session.answer(EditRequest((Edit(str(file), at, at, b"/"),)))
    assert isinstance(answer, Expansion)
    assert not answer.is_recovered
    assert answer.warnings == ()
    assert answer.part_order is None
    assert answer.changed_parts == ()
    assert answer.site_order
    assert {site.id for site in answer.changed_sites} == set(answer.site_order)


def test_after_a_good_run_a_broken_text_is_a_failure_with_all_its_faults(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": WHOLE})
    session, _ = opened(file)
    data = file.read_bytes()
    cuts = [data.index(b'/>\n<link name="$'), data.index(b"</robot>")]
    edits = (Edit(str(file), cuts[1], len(data), b""), Edit(str(file), cuts[0], cuts[0] + 1, b""))
    answer = session.answer(EditRequest(edits))
    assert isinstance(answer, Failure)
    assert [one.code for one in answer.problems] == ["xml-open-element"] * 2
    assert all(one.fix for one in answer.problems)


def test_a_broken_file_that_is_included_is_told_with_the_way_to_it(tmp_path: Path):
    file = write(
        tmp_path,
        {
            "a.xacro": robot('<xacro:include filename="b.xacro"/><link name="a"/>'),
            "b.xacro": BROKEN,
        },
    )
    _, answer = opened(file)
    assert isinstance(answer, Expansion)
    assert answer.part_order == ("link:a", "link:2", "link:a#2")
    (problem,) = answer.warnings
    assert problem.place is not None
    assert problem.place.file.endswith("b.xacro")
    assert [place.file for place in problem.include_chain] == [str(file)]


def test_what_is_broken_and_cannot_be_run_is_a_failure_with_its_faults(tmp_path: Path):
    text = BROKEN.replace("${p}", "${nothing}")
    _, answer = opened(write(tmp_path, {"a.xacro": text}))
    assert isinstance(answer, Failure)
    assert [one.code for one in answer.problems] == ["xml-open-element"]
