"""Laws that hold for every format: what is broken is an error of ours, never anything else."""

from __future__ import annotations

import contextlib
import json
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.errors import MeshError, OutsideRootsError, UnreadableFileError
from studio.robot.meshes.files import MeshFiles
from studio.robot.meshes.reading import read_mesh
from tests.support.meshes import (
    corners,
    dae,
    diffuse,
    glb,
    gltf,
    read,
    size_m,
    stl,
    stl_text,
    texture_effect,
)

PLY = (
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
)
SAMPLES = {
    "binary.stl": stl(),
    "text.stl": stl_text().encode(),
    "plain.dae": dae(effect=diffuse("<color>1 0 0 1</color>")).encode(),
    "textured.dae": dae(
        effect=texture_effect(), images='<image id="i"><init_from>a.png</init_from></image>'
    ).encode(),
    "a.glb": glb(gltf()),
    "a.gltf": json.dumps(gltf(buffers=[{"uri": "data:,xxxx", "byteLength": 44}])).encode(),
    "a.obj": b"v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\n",
    "a.ply": PLY.encode(),
}


@settings(max_examples=400, deadline=None)
@given(
    st.sampled_from(sorted(SAMPLES)),
    st.lists(st.tuples(st.integers(0, 3000), st.integers(0, 4), st.binary(max_size=6)), max_size=4),
)
def test_a_damaged_file_is_a_mesh_or_a_mesh_error(name: str, damages: list[tuple[int, int, bytes]]):
    data = SAMPLES[name]
    for at, length, new in damages:
        start = at % (len(data) + 1)
        data = data[:start] + new + data[start + length :]
    with TemporaryDirectory() as folder, contextlib.suppress(MeshError):
        mesh = read(Path(folder) / name, data)
        assert len(mesh.faces) > 0
        assert int(mesh.faces.max()) < len(mesh.vertices)


@pytest.mark.parametrize("name", [name for name in SAMPLES if name != "a.gltf"])
def test_an_upper_case_suffix_is_read_too(tmp_path: Path, name: str):
    assert len(read(tmp_path / name.upper(), SAMPLES[name]).faces) > 0


def test_a_file_outside_the_roots_is_not_read(tmp_path: Path):
    (tmp_path / "in").mkdir()
    (tmp_path / "a.stl").write_bytes(stl())
    with pytest.raises(OutsideRootsError):
        MeshFiles(tmp_path / "in" / ".." / "a.stl", [tmp_path / "in"])


def test_a_file_that_is_not_there_is_said(tmp_path: Path):
    with pytest.raises(UnreadableFileError):
        MeshFiles(tmp_path / "a.stl")


def test_surfaces_of_one_appearance_are_one_draw_call(tmp_path: Path):
    effect = diffuse("<color>1 0 0 1</color>")
    twice = "<triangles material='m' count='1'>{0}<p>{1}</p></triangles>"
    source = '<input semantic="VERTEX" source="#v" offset="0"/>'
    primitive = twice.format(source, "0 1 2") + twice.format(source, "0 2 3")
    mesh = read(tmp_path / "a.dae", dae(effect=effect, primitive=primitive))
    assert mesh.glb.count(b'"POSITION"') == 1
    assert len(mesh.faces) == 2


def test_a_glb_that_was_written_reads_back_as_the_same_mesh(tmp_path: Path):
    first = read(tmp_path / "a.dae", SAMPLES["plain.dae"])
    again = read(tmp_path / "b.glb", first.glb)
    assert corners(again) == corners(first)
    assert size_m(again) == size_m(first)
    assert again.glb == first.glb


@pytest.mark.corpus
def test_every_real_mesh_is_read(corpus: Path):
    suffixes = {".stl", ".dae", ".obj", ".ply", ".glb"}
    paths = [path for path in sorted(corpus.rglob("*")) if path.suffix.lower() in suffixes]
    for path in paths:
        mesh = read_mesh(MeshFiles(path, (corpus,)))
        assert len(mesh.faces) > 0, path
        assert max(size_m(mesh)) < 1000, path  # some are in millimetres and scaled by the URDF
    assert len(paths) > 90


LFS_POINTER = (
    "version https://git-lfs.github.com/spec/v1\n"
    "oid sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393\n"
    "size 12345\n"
)


@pytest.mark.parametrize("name", ["a.stl", "a.dae", "a.obj", "a.glb", "a.ply"])
def test_a_git_lfs_pointer_is_said_to_be_one(tmp_path: Path, name: str):
    (tmp_path / name).write_text(LFS_POINTER)
    with pytest.raises(MeshError, match='run "git lfs pull"'):
        read_mesh(MeshFiles(tmp_path / name))
