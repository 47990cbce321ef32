from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.documents.copies.folder import (
    FILES_MAX,
    TEXTS_MAX_BYTES,
    Original,
    location_of,
    make_folder,
    size_of,
)
from studio.errors import CommandError, OutsideRootsError
from studio.packages.workspace import open_location

if TYPE_CHECKING:
    from pathlib import Path

URDF = b'<robot name="r"><link name="base"/></robot>'


def original(
    tmp_path: Path, texts: dict[str, bytes], beside: tuple[int, int] = (0, 0)
) -> tuple[Original, Path]:
    """A description of a file and these beside it, and where its copy is to be."""
    folder = tmp_path / "robot"
    folder.mkdir(exist_ok=True)
    entry = folder / "r.urdf"
    entry.write_bytes(URDF)
    (tmp_path / "data").mkdir(exist_ok=True)
    found = open_location(entry, (), tmp_path / "data", {})
    paths = {str(folder / name): text for name, text in {"r.urdf": URDF, **texts}.items()}
    (tmp_path / "copies").mkdir(exist_ok=True)
    return Original(entry, paths, (), found, beside), tmp_path / "copies" / "ada" / "r"


@pytest.mark.parametrize(
    ("texts", "beside"),
    [
        ({f"{number}.xacro": b"" for number in range(FILES_MAX)}, (0, 0)),
        ({"large.xacro": bytes(TEXTS_MAX_BYTES + 1 - len(URDF))}, (0, 0)),
        ({}, (FILES_MAX, 0)),
        ({}, (0, TEXTS_MAX_BYTES + 1 - len(URDF))),
    ],
    ids=["files", "bytes", "files beside", "bytes beside"],
)
def test_one_more_than_a_person_may_have_is_refused_and_nothing_written(
    tmp_path: Path, texts: dict[str, bytes], beside: tuple[int, int]
):
    copied, folder = original(tmp_path, texts, beside)
    with pytest.raises(CommandError, match="200 files of 2 MB at most"):
        make_folder(copied, folder)
    assert list((tmp_path / "copies").iterdir()) == []


def test_as_many_as_a_person_may_have_are_copied_and_counted(tmp_path: Path):
    texts = {f"{number}.xacro": b"" for number in range(FILES_MAX - 2)}
    texts["large.xacro"] = bytes(TEXTS_MAX_BYTES - len(URDF))
    copied, folder = original(tmp_path, texts)
    assert make_folder(copied, folder) == ("src/files/r.urdf", ())
    assert size_of(folder.parent) == (FILES_MAX, TEXTS_MAX_BYTES)


def test_a_link_in_its_folder_is_neither_counted_nor_read(tmp_path: Path):
    secret = tmp_path / "secret.xacro"
    secret.write_bytes(bytes(5_000))
    copied, folder = original(tmp_path, {})
    entry, meshes = make_folder(copied, folder)
    link = folder / "src" / "files" / "link.xacro"
    link.symlink_to(secret)
    assert size_of(folder.parent) == (1, len(URDF))
    served = location_of(folder, entry, meshes, tmp_path / "data").served
    assert served.read(folder / entry, 1_000) == URDF
    for path in (link, secret, folder / "src" / ".." / ".." / ".." / ".." / "secret.xacro"):
        with pytest.raises(OutsideRootsError):
            served.read(path, 10_000)
