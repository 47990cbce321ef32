"""Names that mean something to HTML, to a shell or to a header: everywhere they are only names."""

from __future__ import annotations

import asyncio
import io
import zipfile
from typing import TYPE_CHECKING
from urllib.parse import unquote
from xml.etree import ElementTree as ET
from xml.sax.saxutils import quoteattr

import pytest

from studio.protocol.robot import SetJoints
from studio.protocol.saving import Save
from studio.server.api import disposition
from tests.support.open_documents import engine, opened
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path


NAMES = (
    "<img src=x onerror=alert(1)>",
    "</script><script>alert(2)</script>",
    """a"b'c`d""",
    "🤖 größe",
    "a/b/../c",
    "%2e%2e%2f",
    "; rm -rf ~ #",
    "constructor",
    "__proto__",
)
FOLDER = "ü \"q' <b>🤖"


def robot() -> str:
    links = "".join(
        f"<link name={quoteattr(name)}><visual><geometry>"
        f'<box size="${{größe}} 1 1"/></geometry></visual></link>\n'
        for name in ("base", *NAMES)
    )
    joints = "".join(
        f'<joint name={quoteattr(name)} type="revolute"><parent link="base"/>'
        f'<child link={quoteattr(name)}/><axis xyz="0 0 1"/>'
        '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>\n'
        for name in NAMES
    )
    return (
        f'<robot name={quoteattr(NAMES[1])} xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
        f'<xacro:property name="größe" value="0.2"/>\n{links}{joints}</robot>\n'
    )


@pytest.fixture
def entry(tmp_path: Path) -> Path:
    files = {f"{FOLDER}/{FOLDER}.urdf.xacro": robot()}
    return write_package(tmp_path / "odd", files=files) / f"{FOLDER}/{FOLDER}.urdf.xacro"


def test_a_robot_of_awkward_names_is_drawn_moved_edited_and_saved(entry: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, entry)
            assert list(document.model.robot.links) == ["base", *NAMES]
            wish = SetJoints(document=document.id, positions=dict.fromkeys(NAMES, 0.5))
            await made.execute(wish, ear)
            assert document.model.joints.by_name() == dict.fromkeys(NAMES, 0.5)
            await document.edits.edit_site(ear.site("größe")["id"], "0.3", "")
            await made.execute(Save(document=document.id), ear)
            assert entry.read_text() == robot().replace('"0.2"', '"0.3"')

    asyncio.run(run())


def test_its_exports_hold_the_names_as_text_and_bear_a_plain_name(entry: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, entry)
            urdf = await document.exports.urdf("package")
            root = ET.fromstring(b"".join(urdf.chunks))
            assert [one.get("name") for one in root.iter("link")] == ["base", *NAMES]
            packed = await document.exports.package(all_used=False)
            with zipfile.ZipFile(io.BytesIO(b"".join(packed.chunks))) as archive:
                assert f"odd/{FOLDER}/{FOLDER}.urdf.xacro" in archive.namelist()
            page = await document.exports.page(dark=True)
            written = b"".join(page.chunks)
            assert b"</script><script>alert(2)" not in written
            assert b"<img src=x" not in written
            for one in (urdf, packed, page):
                header = disposition(one.name)
                assert header.isascii()
                assert "/" not in unquote(header)

    asyncio.run(run())
