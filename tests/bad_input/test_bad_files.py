"""Bad files: one clear sentence that names the file, nothing run, and the studio lives on."""

from __future__ import annotations

import asyncio
import zipfile
from typing import TYPE_CHECKING, NamedTuple

import pytest

from studio.errors import StudioError, UnsafeArchiveError
from tests.support.open_documents import engine, opened
from tests.support.packages import write_package
from tests.support.sweep import some_of

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine, Iterator
    from pathlib import Path

    from studio.documents.engine import Engine


XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
LAMBDA = "(lambda: [c for c in ().__class__.__base__.__subclasses__()])()"


def robot(body: str) -> str:
    return f'<robot name="r" {XACRO}>{body}<link name="base"/></robot>'


def value_of(expression: str) -> str:
    return robot(f'<xacro:property name="x" value="{expression}"/><link name="a${{x}}"/>')


BAD: dict[str, str | bytes] = {
    "empty": "",
    "binary": bytes(range(256)) * 8,
    "utf-16": robot("").encode("utf-16"),
    "missing include": robot('<xacro:include filename="not_there.xacro"/>'),
    "unknown package": robot('<xacro:include filename="$(find nowhere)/a.xacro"/>'),
    "include of a file outside": robot('<xacro:include filename="/etc/passwd"/>'),
    "include of a device": robot('<xacro:include filename="/dev/zero"/>'),
    "self-include": robot('<xacro:include filename="bad.urdf.xacro"/>'),
    "endless recursion": robot('<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/>'),
    "doubling recursion": robot(
        '<xacro:macro name="m" params="n"><xacro:if value="${n > 0}">'
        '<xacro:m n="${n - 1}"/><xacro:m n="${n - 1}"/></xacro:if></xacro:macro>'
        '<xacro:m n="40"/>'
    ),
    "lists that double": robot(
        '<xacro:property name="p0" value="${[1]}"/>'
        + "".join(f'<xacro:property name="p{n + 1}" value="${{[p{n}, p{n}]}}"/>' for n in range(40))
        + '<link name="${len(str(p40))}"/>'
    ),
    "a pattern as separators": value_of("${xacro.tokenize('a' * 40, sep='x]|(?:a|a)*b|[y')}"),
    "half a character": value_of("${'\\ud800'}"),
    "numbers of one hash": value_of(
        "${[python.set([i * (2**61 - 1) for i in range(9000)]) for j in range(9000)]}"
    ),
    "tower of powers": value_of("${9**9**9}"),
    "huge text": value_of("${'a' * 10**11}"),
    "lambda": value_of(f"${{{LAMBDA}}}"),
    "dunder": value_of("${().__class__}"),
    "eval of a property": robot(
        '<xacro:property name="x" value="open(\'/etc/passwd\').read()"/><link name="$(eval ${x})"/>'
    ),
    "yaml of a file outside": value_of("${xacro.load_yaml('/etc/passwd')}"),
    "xml bomb": '<!DOCTYPE r [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;&a;">]>'
    f'<robot name="&b;" {XACRO}><link name="base"/></robot>',
    "external entity": '<!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/passwd">]>'
    f'<robot name="&x;" {XACRO}><link name="base"/></robot>',
    "yaml bomb": value_of("${xacro.load_yaml('bomb.yaml')}"),
    "yaml tag that computes": value_of("${xacro.load_yaml('tag.yaml')}"),
}
BESIDE = {
    "bomb.yaml": "a: &a [x,x,x,x,x,x,x,x,x]\n"
    + "".join(
        f"{new}: &{new} [{','.join([f'*{old}'] * 9)}]\n"
        for old, new in zip("abcdefghi", "bcdefghij", strict=True)
    ),
    "tag.yaml": f'x: !radians "{LAMBDA}"\n',
}
GOOD = robot('<xacro:property name="length" value="1"/><link name="l${length}"/>')


class RunningEngine(NamedTuple):
    """An engine on a loop that stands between tests."""

    made: Engine
    run: Callable[[Coroutine[None, None, None]], None]


@pytest.fixture(scope="module")
def one_engine(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningEngine]:
    """One for all bad files: each is the next file of the one before."""
    with asyncio.Runner() as runner:
        opening = engine(tmp_path_factory.mktemp("engine") / "data")
        made = runner.run(opening.__aenter__())
        try:
            yield RunningEngine(made, runner.run)
        finally:
            runner.run(opening.__aexit__(None, None, None))


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A package with the files beside the bad one."""
    files = {f"urdf/{name}": text for name, text in BESIDE.items()}
    return write_package(tmp_path / "bad", files=files)


@pytest.mark.parametrize("case", some_of(BAD))
def test_a_bad_file_is_one_sentence_and_the_next_file_opens(
    case: str, package: Path, one_engine: RunningEngine
):
    bad = package / "urdf" / "bad.urdf.xacro"
    content = BAD[case]
    bad.write_bytes(content if isinstance(content, bytes) else content.encode())
    good = package / "urdf" / "good.urdf.xacro"
    good.write_text(GOOD)

    async def run() -> None:
        document, ear = await opened(one_engine.made, bad)
        assert document.last_run.phase == "failed"
        (problem,) = ear.last("problems")["problems"]
        assert problem["severity"] == "error"
        assert problem["place"]["file"].startswith(str(package))
        assert problem["sentence"].strip().endswith((".", ")", "?"))
        assert "root:" not in problem["sentence"]
        assert "Traceback" not in problem["sentence"]
        await one_engine.made.close_document(document, discard=True)
        after, _ = await opened(one_engine.made, good)
        assert list(after.model.robot.links) == ["l1", "base"]
        await one_engine.made.close_document(after, discard=True)

    one_engine.run(run())


def test_a_file_that_was_cut_off_is_drawn_as_far_as_it_goes(package: Path, tmp_path: Path):
    file = package / "urdf" / "cut.urdf.xacro"
    file.write_text('<robot name="r"><link name="base"')

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, file)
            assert list(document.model.robot.links) == ["base"]
            assert "error" in {one["severity"] for one in ear.last("problems")["problems"]}

    asyncio.run(run())


def test_a_file_that_goes_bad_while_open_keeps_its_model(package: Path, tmp_path: Path):
    file = package / "urdf" / "good.urdf.xacro"
    file.write_text(GOOD)

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, file)
            length = ear.site("length")["id"]
            for text in ("${9**9**9}", "${().__class__}", "${nothing}", "${'a' * 10**11}"):
                await document.edits.edit_site(length, text, "")
                assert document.last_run.failed
                assert ear.last("problems")["showing_last_good"]
                assert list(document.model.robot.links) == ["l1", "base"]
            await document.edits.edit_site(length, "2", "")
            assert list(document.model.robot.links) == ["l2", "base"]

    asyncio.run(run())


def test_a_urdf_that_is_xacro_is_expanded(package: Path, tmp_path: Path):
    file = package / "urdf" / "r.urdf"
    file.write_text(robot('<xacro:property name="n" value="2"/><link name="l${n}"/>'))

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, file)
            assert "l2" in document.model.robot.links

    asyncio.run(run())


def test_a_robot_without_a_name_is_drawn_with_a_problem(package: Path, tmp_path: Path):
    file = package / "urdf" / "r.urdf"
    file.write_text('<robot><link name="base"/></robot>')

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, file)
            assert list(document.model.robot.links) == ["base"]

    asyncio.run(run())


DRACO = (
    b'{"asset":{"version":"2.0"},"extensionsRequired":["KHR_draco_mesh_compression"],'
    b'"extensionsUsed":["KHR_draco_mesh_compression"]}'
)
MESHES = {
    "missing.stl": None,
    "broken.stl": b"solid nothing\nfacet normal 0 0",
    "broken.dae": b"<COLLADA><library_geometries>",
    "draco.gltf": DRACO,
    "../../outside.stl": None,
    "/etc/passwd": None,
}


@pytest.mark.parametrize("name", MESHES)
def test_a_bad_mesh_is_a_problem_at_its_link_and_the_robot_is_drawn(
    name: str, package: Path, tmp_path: Path
):
    content = MESHES[name]
    if content is not None:
        (package / "urdf" / name).write_bytes(content)
    file = package / "urdf" / "r.urdf"
    file.write_text(
        '<robot name="r">\n<link name="base">'
        f'<visual><geometry><mesh filename="{name}"/></geometry></visual></link></robot>'
    )

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, file)
            assert list(document.model.robot.links) == ["base"]
            problems = ear.last("problems")["problems"]
            (problem,) = [one for one in problems if one["code"] == "mesh"]
            assert name.rsplit("/", 1)[-1] in problem["sentence"]
            assert problem["place"]["line"] == 2
            assert document.scene.missing_meshes() == set()

    asyncio.run(run())


def test_a_zip_that_would_write_outside_is_refused(tmp_path: Path):
    bad = tmp_path / "bad.zip"
    with zipfile.ZipFile(bad, "w") as archive:
        archive.writestr("../escaped.txt", "x")

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            with pytest.raises(UnsafeArchiveError) as caught:
                await made.open_path(bad, {})
            assert "bad.zip" in str(caught.value)

    asyncio.run(run())
    assert not (tmp_path / "escaped.txt").exists()
    assert not list((tmp_path / "data").rglob("escaped.txt"))


def test_a_zip_of_endless_zeros_is_refused(tmp_path: Path):
    bad = tmp_path / "zeros.zip"
    with (
        zipfile.ZipFile(bad, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive,
        archive.open("zeros.bin", "w", force_zip64=True) as member,
    ):
        for _ in range(1200):
            member.write(bytes(1 << 20))

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            with pytest.raises(StudioError) as caught:
                await made.open_path(bad, {})
            assert "zeros.zip" in str(caught.value)

    asyncio.run(run())
    assert sum(one.stat().st_size for one in (tmp_path / "data").rglob("*")) < 1 << 28
