"""What a mesh file names: materials and images, directly or by one another, all beside it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.packages.packing import companions
from studio.packages.roots import ServedRoots

if TYPE_CHECKING:
    from pathlib import Path


def names(folder: Path, mesh: str) -> set[str]:
    found = companions(folder / mesh, ServedRoots([folder.parent]))
    return {one.relative_to(folder).as_posix() for one in found}


def test_a_wavefront_mesh_names_its_materials_and_these_their_images(tmp_path: Path):
    (tmp_path / "m").mkdir()
    (tmp_path / "m/a.obj").write_text("mtllib my mat.mtl\nv 0 0 0\n")
    (tmp_path / "m/my mat.mtl").write_text("newmtl x\nmap_Kd tex/red.png\nbump -bm 2 n.png\n")
    (tmp_path / "m/tex").mkdir()
    (tmp_path / "m/tex/red.png").write_bytes(b"")
    (tmp_path / "m/n.png").write_bytes(b"")
    assert names(tmp_path / "m", "a.obj") == {"my mat.mtl", "tex/red.png", "n.png"}


def test_a_collada_mesh_names_its_images(tmp_path: Path):
    text = "<init_from> a%20b.png </init_from><init_from><ref>c.png</ref></init_from>"
    (tmp_path / "a.dae").write_text(text)
    for name in ("a b.png", "c.png"):
        (tmp_path / name).write_bytes(b"")
    assert names(tmp_path, "a.dae") == {"a b.png", "c.png"}


def test_a_gltf_mesh_names_its_buffers(tmp_path: Path):
    (tmp_path / "a.gltf").write_text('{"buffers": [{"uri": "a.bin"}, {"uri": "data:x;base64,"}]}')
    (tmp_path / "a.bin").write_bytes(b"")
    assert names(tmp_path, "a.gltf") == {"a.bin"}


def test_what_is_missing_elsewhere_or_the_mesh_itself_is_left_out(tmp_path: Path):
    (tmp_path / "m").mkdir()
    (tmp_path / "secret.mtl").write_text("")
    (tmp_path / "m/b.mtl").write_text("map_Kd a.obj")
    (tmp_path / "m/a.obj").write_text(
        "mtllib ../secret.mtl\nmtllib /etc/passwd\nmtllib no.mtl\nmtllib b.mtl\nmtllib a\0b\n"
    )
    assert names(tmp_path / "m", "a.obj") == {"b.mtl"}
    assert names(tmp_path / "m", "none.obj") == set()


@pytest.mark.parametrize(
    ("mesh", "data"),
    [
        ("a.obj", b"\n" * 300_000),
        ("a.obj", b"mtllib " + b"x " * 1_000_000),
        ("a.obj", b"mtllib x\n" * 500_000),
        ("a.dae", b"<init_from>" + b" " * 300_000),
        ("a.dae", b"<init_from>" * 100_000),
        ("a.gltf", b'"uri" ' + b" " * 300_000),
    ],
)
def test_a_mesh_that_goes_on_and_on_takes_no_longer_for_it(tmp_path: Path, mesh: str, data: bytes):
    (tmp_path / mesh).write_bytes(data)
    assert names(tmp_path, mesh) == set()
