"""The exporter is byte-equal to the `xacro` command, and our evaluator equal to both."""

from __future__ import annotations

import subprocess
import time
from typing import TYPE_CHECKING, NamedTuple

import pytest

from studio.description.evaluator.source_store import SourceStore
from studio.description.evaluator.stock_xacro import expand_root, export_urdf
from studio.description.expressions.bounds import Limits
from studio.description.faults import Fault
from studio.description.session import open_session
from studio.description.values import Expansion, Failure, OpenRequest
from studio.errors import ExpansionError, RefusedError
from studio.packages.roots import ServedRoots
from tests.support.descriptions import (
    canonical,
    canonical_xml,
    evaluation_of,
    policy_for,
    robot,
    write,
)
from tests.support.stock_command import StockCommand

if TYPE_CHECKING:
    from pathlib import Path

    from studio.description.values import ReadPolicy

EXPANDED_AT_LEAST = 460
"""Of the 521 xacro files of the corpus stock expands 464 without arguments."""


class Expanded(NamedTuple):
    """The corpus as bare stock xacro sees it: file to text, None where it fails."""

    policy: ReadPolicy
    texts: dict[str, str | None]


@pytest.fixture(scope="module")
def expanded(corpus: Path, tmp_path_factory: pytest.TempPathFactory) -> Expanded:
    policy = policy_for(corpus)
    command = StockCommand(tmp_path_factory.mktemp("stock"), policy.packages)
    files = [str(path) for path in sorted(corpus.rglob("*")) if is_description(path)]
    return Expanded(policy, command.batch(files))


def is_description(path: Path) -> bool:
    if path.suffix not in {".xacro", ".urdf"} or not path.is_file():
        return False
    return b"xacro" in path.read_bytes()


@pytest.mark.corpus
def test_our_evaluator_equals_stock_on_every_file_of_the_corpus(expanded: Expanded):
    different: list[str] = []
    for file, text in expanded.texts.items():
        if text is None:
            continue
        try:
            ours = canonical(evaluation_of(expanded.policy).run(file))
        except Fault as fault:
            different.append(f"{file}: {fault.place}: {fault.sentence}")
        else:
            if ours != canonical_xml(text):
                different.append(f"{file}: another tree")
    assert not different, "\n".join(different)
    assert sum(text is not None for text in expanded.texts.values()) > EXPANDED_AT_LEAST


@pytest.mark.corpus
def test_what_stock_cannot_expand_gets_a_sentence_and_a_place(expanded: Expanded):
    failed = [file for file, text in expanded.texts.items() if text is None]
    faults = {file: fault for file in failed if (fault := fault_in(file, expanded.policy))}
    vague = [file for file, fault in faults.items() if not (fault.place and fault.place.line)]
    assert not vague
    assert len(faults) > 50, f"stock fails on {len(failed)} files, we on {len(faults)}"


def fault_in(file: str, policy: ReadPolicy) -> Fault | None:
    try:
        evaluation_of(policy).run(file)
    except Fault as fault:
        return fault
    return None


@pytest.mark.corpus
def test_the_exporter_is_byte_equal_to_the_command_on_the_corpus(expanded: Expanded):
    different = [
        file
        for file, text in expanded.texts.items()
        if text is not None and export_urdf(file, {}, expanded.policy) != text
    ]
    assert not different


@pytest.mark.corpus
def test_the_ur_with_its_arguments_is_equal(corpus: Path, tmp_path: Path):
    file = next(corpus.glob("UniversalRobots+*/urdf/ur.urdf.xacro"))
    given = {"ur_type": "ur10e", "name": "ur"}
    policy = policy_for(corpus)
    printed = StockCommand(tmp_path, policy.packages).run(
        str(file), *(f"{name}:={value}" for name, value in given.items())
    )
    assert export_urdf(str(file), given, policy) == printed
    assert canonical(evaluation_of(policy, given).run(str(file))) == canonical_xml(printed)


def test_the_banner_holds_the_name_as_given(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    body = (
        '<!-- kept --><xacro:property name="a" value="1"/><link b="${a}" a="&lt;x&gt;"/>\n\n'
        "<text>t ${a}</text><!-- gone --><xacro:if value='1'><y/></xacro:if>"
    )
    write(tmp_path, {"sub/a--b.xacro": robot(body)})
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scratch").mkdir()
    command = StockCommand(tmp_path / "scratch", {})
    for name in ("sub/a--b.xacro", str(tmp_path / "sub" / "a--b.xacro")):
        assert export_urdf(name, {}, policy_for(tmp_path)) == command.run(name)


def test_edited_texts_are_exported(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": robot("<x/>")})
    overlay = {str(file): robot("<y/>").encode()}
    assert "<y/>" in export_urdf(str(file), {}, policy_for(tmp_path), overlay)


def test_what_the_command_refuses_the_exporter_refuses_with_a_sentence(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": robot("<xacro:nope/>")})
    (tmp_path / "scratch").mkdir()
    with pytest.raises(subprocess.CalledProcessError):
        StockCommand(tmp_path / "scratch", {}).run(str(file))
    with pytest.raises(ExpansionError, match=r"a\.xacro:1:\d+: There is no macro \"nope\""):
        export_urdf(str(file), {}, policy_for(tmp_path))


def test_a_failed_run_leaves_nothing_behind_for_the_next(tmp_path: Path):
    policy = policy_for(tmp_path)
    bad = write(tmp_path, {"bad.xacro": robot('<xacro:macro name="m"/><x v="${1/0}"/>')})
    good = write(tmp_path, {"good.xacro": robot('<x v="$(eval 1 + 1)"/>')})
    before = export_urdf(str(good), {}, policy)
    with pytest.raises(ExpansionError):
        export_urdf(str(bad), {}, policy)
    assert export_urdf(str(good), {}, policy) == before


def test_the_fallback_gives_the_root_alone(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": robot('<link name="${1+1}"/>')})
    store = SourceStore(ServedRoots([tmp_path]), {})
    assert expand_root(str(file), {}, policy_for(tmp_path), store) == (
        '<robot name="r"><link name="2"/></robot>'
    )


def recursive(depth: int, inside: int = 0) -> str:
    """A macro that calls itself, each time inside so many elements."""
    call = '<xacro:if value="${n > 0}"><link name="l${n}"/><xacro:m n="${n - 1}"/></xacro:if>'
    wrapped = "<a>" * inside + call + "</a>" * inside
    return robot(f'<xacro:macro name="m" params="n">{wrapped}</xacro:macro><xacro:m n="{depth}"/>')


def test_macros_call_themselves_as_deeply_as_in_stock_xacro(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": recursive(247)})
    assert export_urdf(str(file), {}, policy_for(tmp_path)).count("<link") == 247
    request = OpenRequest(str(file), {}, policy_for(tmp_path), {})
    _, opened = open_session(request)
    assert isinstance(opened, Expansion)
    assert len(opened.changed_parts) == 247


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (recursive(5_000), "macro-recursion"),
        (recursive(200, inside=10), "xml-too-deep"),
        (recursive(340, inside=200), "xml-too-deep"),
    ],
)
def test_what_is_nested_too_deeply_is_refused_by_both(text: str, code: str, tmp_path: Path):
    file = write(tmp_path, {"a.xacro": text})
    with pytest.raises(RefusedError) as refused:
        export_urdf(str(file), {}, policy_for(tmp_path))
    _, answer = open_session(OpenRequest(str(file), {}, policy_for(tmp_path), {}))
    assert isinstance(answer, Failure)
    assert (refused.value.problem.code, answer.problem.code) == (code, code)
    assert refused.value.problem.sentence == answer.problem.sentence


def test_macros_that_double_are_refused_for_what_the_evaluator_refuses_them(tmp_path: Path):
    levels = "".join(
        f'<xacro:macro name="m{n}"><xacro:m{n + 1}/><xacro:m{n + 1}/></xacro:macro>'
        for n in range(40)
    )
    last = '<xacro:macro name="m40"><link name="l"/></xacro:macro>'
    file = write(tmp_path, {"a.xacro": robot(f"{levels}{last}<xacro:m0/>")})
    began_s = time.thread_time()
    with pytest.raises(RefusedError):
        export_urdf(str(file), {}, policy_for(tmp_path))
    assert time.thread_time() - began_s < 2 * Limits().seconds
