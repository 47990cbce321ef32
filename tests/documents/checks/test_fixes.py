"""Fixes carried out on real documents: one step each, refused when their text is gone."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.errors import CommandError, ReadOnlyTextError, StaleTextError
from studio.problems import Fix, Problem, Replacement, Severity
from studio.protocol.edits import ApplyFix
from tests.support.asked import ask_document
from tests.support.open_documents import engine, opened

if TYPE_CHECKING:
    from pathlib import Path

    from studio.documents.document import Document


CART = """<robot name="cart">
  <link name="base"/>
  <link name="wheel"/>
  <joint name="turn" type="fixed"><parent link="base"/><child link="wheel"/></joint>
</robot>
"""


@pytest.fixture
def cart(tmp_path: Path) -> Path:
    file = tmp_path / "cart" / "cart.urdf"
    file.parent.mkdir()
    file.write_text(CART)
    return file


def found(file: Path, before: str, text: str, severity: Severity = Severity.WARNING) -> Problem:
    """A finding whose fix writes `text` where `before` stands first."""
    start = CART.index(before)
    edit = Replacement(str(file), start, start + len(before), before, text)
    fix = Fix(f"Write {text}", "edit", edits=(edit,))
    return Problem(severity, "odd", f"{before} is odd: write {text}.", fix=fix)


async def mend(document: Document, problem: Problem) -> None:
    label = problem.fix.label if problem.fix else ""
    await document.fixes.apply(problem.code, problem.sentence, label)


def test_a_fix_is_one_step_that_bears_its_label(cart: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, cart)
            problem = found(cart, '"wheel"', '"front"')
            child = CART.index('link="wheel"')
            more = Replacement(str(cart), child, child + 12, 'link="wheel"', 'link="front"')
            assert problem.fix is not None
            fix = Fix("Rename it", "edit", edits=(*problem.fix.edits, more))
            document.findings.replace(
                "test", [Problem(problem.severity, "odd", "A sentence.", fix=fix)]
            )
            command = ApplyFix(code="odd", sentence="A sentence.", label="Rename it")
            await ask_document(document, command, ear)
            assert list(document.model.robot.links) == ["base", "front"]
            assert ear.last("history")["undo"] == ["Rename it"]
            await document.edits.undo()
            assert document.sources.text(str(cart)) == CART.encode()

    asyncio.run(run())


def test_a_fix_of_what_is_no_longer_found_or_stands_elsewhere_is_refused(
    cart: Path, tmp_path: Path
):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, cart)
            problem = found(cart, '"wheel"', '"front"')
            with pytest.raises(CommandError, match="no longer found"):
                await mend(document, problem)
            document.findings.replace("test", [problem])
            stale = found(cart, "<link", "<!-- a --><link")
            document.findings.replace("other", [stale])
            await mend(document, stale)
            with pytest.raises(StaleTextError):
                await mend(document, problem)
            assert document.sources.undo_labels == ("Write <!-- a --><link",)

    asyncio.run(run())


def test_all_errors_and_warnings_are_mended_in_one_step_and_notes_are_left(
    cart: Path, tmp_path: Path
):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, cart)
            problems = [
                found(cart, '"cart"', '"dray"'),
                found(cart, '"turn"', '"spin"', Severity.ERROR),
                found(cart, '"fixed"', '"floating"', Severity.INFO),
            ]
            document.findings.replace("test", problems)
            await document.fixes.apply_all()
            expected = CART.replace("cart", "dray").replace("turn", "spin")
            assert document.sources.text(str(cart)).decode() == expected
            assert document.sources.undo_labels == ("Mend all",)
            document.findings.replace("test", ())
            with pytest.raises(CommandError, match="Nothing that is found has a fix"):
                await document.fixes.apply_all()

    asyncio.run(run())


def test_a_file_that_may_only_be_read_is_not_mended(cart: Path, tmp_path: Path):
    async def run() -> None:
        aside = tmp_path / "aside"
        aside.mkdir()
        async with engine(tmp_path / "data", aside) as made:
            document, _ = await opened(made, cart)
            document.findings.replace("test", [found(aside / "other.xacro", '"wheel"', '"front"')])
            with pytest.raises(ReadOnlyTextError):
                await mend(document, document.findings.all()[0])

    asyncio.run(run())
