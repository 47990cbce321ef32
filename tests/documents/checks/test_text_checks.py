"""Findings of texts and robot on real documents: told when it is quiet, mended, gone again."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from studio.description.editing.sources import Change
from studio.description.values import Edit
from studio.documents.checks.text_checks import merged
from studio.problems import Fix, Problem, Severity
from tests.support.broken_snippet import PRINTED
from tests.support.open_documents import engine, opened

if TYPE_CHECKING:
    from pathlib import Path

    from studio.documents.document import Document


def found(document: Document) -> list[str]:
    return [problem.code for problem in document.findings.all()]


def test_row_d4_the_printed_snippet_gives_three_findings_and_is_mended_and_drawn(tmp_path: Path):
    async def run() -> None:
        file = tmp_path / "snippet.urdf"
        file.write_text(PRINTED)
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, file)
            await document.checks.settled()
            assert list(document.model.robot.links) == ["base link"]
            named = [one for one in document.findings.all() if one.fix and one.fix.edits]
            assert [(one.code, one.place and one.place.line) for one in named] == [
                ("xml-open-element", 14),
                ("dangling-parent", 10),
                ("dangling-child", 11),
            ]
            assert 'did you mean "base link"?' in named[1].sentence
            assert '"wheel_link"' in named[2].sentence
            await document.fixes.apply_all()
            assert list(document.model.robot.links) == ["base_link", "wheel_link"]
            assert document.model.robot.joints["joint1"].parent == "base_link"
            await document.checks.settled()
            assert not {"xml-open-element", "dangling-parent", "dangling-child"} & {
                *found(document)
            }
            await document.edits.undo()
            assert document.sources.text(str(file)).decode() == PRINTED

    asyncio.run(run())


def test_row_d4_each_finding_is_mended_by_a_click_of_its_own(tmp_path: Path):
    async def run() -> None:
        file = tmp_path / "snippet.urdf"
        file.write_text(PRINTED)
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, file)
            for _ in range(3):
                await document.checks.settled()
                one = next(p for p in document.findings.all() if p.fix and p.fix.action == "edit")
                assert one.fix is not None
                await document.fixes.apply(one.code, one.sentence, one.fix.label)
            assert list(document.model.robot.joints) == ["joint1"]
            assert len(document.sources.undo_labels) == 3

    asyncio.run(run())


def test_broken_texts_are_checked_while_the_last_good_robot_stays(tmp_path: Path):
    async def run() -> None:
        file = tmp_path / "r.urdf"
        file.write_text('<robot name="r"><link name="a"/></robot>')
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, file)
            broken = b'<joint name="j" type="fixed"><parent link="b"/><child link="a"/></joint>'
            edit = Edit(str(file), 32, 40, broken)
            document.sources.edit(edit, "Edit", is_value=False)
            await document.edits.follow(Change("Edit", (edit,)))
            assert document.last_run.failed
            await document.checks.settled()
            assert found(document)[:2] == ["xml-open-element", "dangling-parent"]
            assert list(document.model.robot.links) == ["a"]
            await document.edits.undo()
            await document.checks.settled()
            assert not document.last_run.failed
            assert "dangling-parent" not in found(document)

    asyncio.run(run())


def test_a_fact_that_both_tell_is_told_once_with_its_fix():
    fix = Fix("Write it", "edit")
    plain = Problem(Severity.WARNING, "dangling-child", "a", parts=("joint:j",))
    better = Problem(Severity.WARNING, "dangling-child", "b", fix=fix, parts=("joint:j",))
    note = Problem(Severity.INFO, "unused-arg", "c")
    assert merged([plain], [better, note]) == (better, note)
    assert merged([], [better, note]) == (note,)
    assert merged([plain], [note]) == (plain, note)


def test_names_that_are_there_twice_are_told_once_and_mended(tmp_path: Path):
    ends = '<parent link="{}"/><child link="{}"/>'
    joints = (ends.format("a", "b"), ends.format("b", "c"))
    body = "".join(f'<joint name="j" type="fixed">{one}</joint>' for one in joints)
    links = "".join(f'<link name="{name}"/>' for name in "aabc")

    async def run() -> None:
        file = tmp_path / "r.urdf"
        file.write_text(f'<robot name="r">{links}{body}</robot>')
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, file)
            await document.checks.settled()
            codes = found(document)
            assert [codes.count(one) for one in ("duplicate-link", "duplicate-joint")] == [1, 1]
            await document.fixes.apply_all()
            await document.checks.settled()
            assert not {"duplicate-link", "duplicate-joint"} & {*found(document)}
            assert list(document.model.robot.links) == ["a", "a_2", "b", "c"]
            assert list(document.model.robot.joints) == ["j", "j_2"]

    asyncio.run(run())


def test_a_rule_that_yourdfpy_finds_broken_has_the_place_of_the_joint(tmp_path: Path):
    text = (
        '<robot name="r">\n<link name="a"/>\n<link name="b"/>\n'
        '<joint name="j" type="revolute"><parent link="a"/><child link="b"/>'
        '<limit effort="1" velocity="1"/></joint>\n</robot>'
    )

    async def run() -> None:
        file = tmp_path / "r.urdf"
        file.write_text(text)
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, file)
            await document.checks.settled()
            rules = [one for one in document.findings.all() if one.code == "urdf-rule"]
            assert {one.place and one.place.line for one in rules} == {4}

    asyncio.run(run())
