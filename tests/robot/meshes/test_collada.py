from __future__ import annotations

import time
from typing import TYPE_CHECKING

import numpy as np
import pytest

from studio.errors import MeshError
from studio.robot.meshes.files import MeshFiles
from studio.robot.meshes.reading import read_mesh
from tests.support.meshes import (
    area_m2,
    bmp,
    corners,
    dae,
    diffuse,
    glb_document,
    png,
    read,
    sentences,
    size_m,
    texture_effect,
)
from tests.support.trimesh_sizes import size_by_trimesh

if TYPE_CHECKING:
    from pathlib import Path

if TYPE_CHECKING:
    from pathlib import Path

IMAGE = '<image id="i"><init_from>paint.png</init_from></image>'
SHOWN = '<instance_geometry url="#g"/>'


def test_a_square_is_two_triangles(tmp_path: Path):
    mesh = read(tmp_path / "a.dae", dae())
    assert corners(mesh) == {(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)}
    assert len(mesh.faces) == 2


def test_the_unit_is_applied(tmp_path: Path):
    mesh = read(tmp_path / "a.dae", dae(asset='<unit name="inch" meter="0.0254"/>'))
    assert size_m(mesh) == pytest.approx([0.0254, 0.0254, 0])


def test_up_axis_is_ignored_as_rviz_does(tmp_path: Path):
    turned = read(tmp_path / "a.dae", dae(asset="<up_axis>Y_UP</up_axis>"))
    assert size_m(turned) == [1, 1, 0]


@pytest.mark.parametrize("unit", ["0", "-1", "nan", "inf", "one"])
def test_an_impossible_unit_is_said(tmp_path: Path, unit: str):
    with pytest.raises(MeshError, match=f'its unit is "{unit}" metres long'):
        read(tmp_path / "a.dae", dae(asset=f'<unit meter="{unit}"/>'))


def test_transforms_of_a_node_multiply_in_their_order(tmp_path: Path):
    node = "<translate>1 0 0</translate><rotate>0 0 1 90</rotate><scale>2 1 1</scale>"
    mesh = read(tmp_path / "a.dae", dae(node=node))
    assert corners(mesh) == {(1, 0, 0), (1, 2, 0), (0, 2, 0), (0, 0, 0)}


def test_a_matrix_is_written_by_rows(tmp_path: Path):
    node = "<matrix>1 0 0 5 0 1 0 6 0 0 1 7 0 0 0 1</matrix>"
    assert (5, 6, 7) in corners(read(tmp_path / "a.dae", dae(node=node)))


def test_a_mirrored_node_keeps_its_outside(tmp_path: Path):
    mesh = read(tmp_path / "a.dae", dae(node="<scale>-1 1 1</scale>"))
    a, b, c = mesh.vertices[mesh.faces[0]]
    assert np.cross(b - a, c - a)[2] > 0


def test_nodes_in_nodes_and_used_nodes_are_placed(tmp_path: Path):
    scene = (
        f'<node><translate>0 0 1</translate><node id="x"><translate>1 0 0</translate>{SHOWN}</node>'
        '<node><translate>0 0 5</translate><instance_node url="#x"/></node></node>'
    )
    assert {(1, 0, 1), (1, 0, 6)} < corners(read(tmp_path / "a.dae", dae(scene=scene)))


def test_a_document_without_a_scene_shows_everything(tmp_path: Path):
    text = dae()
    start, end = text.index("<library_visual_scenes>"), text.index("<scene>")
    assert len(read(tmp_path / "a.dae", text[:start] + text[end:]).faces) == 2


@pytest.mark.parametrize(
    ("primitive", "faces"),
    [
        ("<polylist count='1'>{}<vcount>4</vcount><p>0 1 2 3</p></polylist>", 2),
        ("<polylist count='2'>{}<vcount>3 3</vcount><p>0 1 2 0 2 3</p></polylist>", 2),
        ("<polygons count='1'>{}<p>0 1 2 3</p></polygons>", 2),
        ("<trifans count='1'>{}<p>0 1 2 3</p></trifans>", 2),
        ("<tristrips count='1'>{}<p>0 1 3 2</p></tristrips>", 2),
        ("<triangles count='2'>{}<p> 0 1\n2\t0 2  3 </p></triangles>", 2),
    ],
)
def test_every_kind_of_polygon_covers_the_square_once(tmp_path: Path, primitive: str, faces: int):
    source = '<input semantic="VERTEX" source="#v" offset="0"/>'
    mesh = read(tmp_path / "a.dae", dae(primitive=primitive.format(source)))
    assert len(mesh.faces) == faces
    assert area_m2(mesh.vertices, mesh.faces) == pytest.approx(1)
    a, b, c = np.moveaxis(mesh.vertices[mesh.faces], 1, 0)
    assert (np.cross(b - a, c - a)[:, 2] > 0).all()


def test_a_mesh_without_material_leaves_the_colour_to_the_urdf(tmp_path: Path):
    assert read(tmp_path / "a.dae", dae()).glb == b""


def test_a_colour_becomes_linear_in_the_glb(tmp_path: Path):
    mesh = read(tmp_path / "a.dae", dae(effect=diffuse("<color>1 0.5 0 1</color>")))
    (material,) = glb_document(mesh.glb)["materials"]
    factor = material["pbrMetallicRoughness"]["baseColorFactor"]
    assert factor == pytest.approx([1, 0.2140, 0, 1], abs=1e-3)
    assert material["doubleSided"]


@pytest.mark.parametrize(
    ("transparent", "alpha"),
    [
        ("<transparent><color>1 1 1 1</color></transparent>", 1.0),
        (
            "<transparent><color>1 1 1 1</color></transparent>"
            "<transparency><float>0.25</float></transparency>",
            0.25,
        ),
        (
            '<transparent opaque="RGB_ZERO"><color>1 1 1 1</color></transparent>'
            "<transparency><float>0.25</float></transparency>",
            0.75,
        ),
        (
            "<transparent><color>1 1 1 1</color></transparent>"
            "<transparency><float>0</float></transparency>",
            1.0,
        ),
    ],
)
def test_transparency_is_read_and_the_invisible_is_shown(
    tmp_path: Path, transparent: str, alpha: float
):
    effect = diffuse("<color>1 0 0 1</color>", also=transparent)
    (material,) = glb_document(read(tmp_path / "a.dae", dae(effect=effect)).glb)["materials"]
    assert material["pbrMetallicRoughness"]["baseColorFactor"][3] == pytest.approx(alpha)


def test_a_texture_is_inside_the_glb(tmp_path: Path):
    (tmp_path / "paint.png").write_bytes(png())
    mesh = read(tmp_path / "a.dae", dae(effect=texture_effect(), images=IMAGE))
    assert not mesh.problems
    document = glb_document(mesh.glb)
    assert (
        document["images"] == [{"bufferView": 3, "mimeType": "image/png"}]
        or len(document["images"]) == 1
    )
    assert png() in mesh.glb
    assert "TEXCOORD_0" in document["meshes"][0]["primitives"][0]["attributes"]


def test_an_image_that_browsers_do_not_know_becomes_png(tmp_path: Path):
    (tmp_path / "paint.png").write_bytes(bmp())
    mesh = read(tmp_path / "a.dae", dae(effect=texture_effect(), images=IMAGE))
    assert b"\x89PNG" in mesh.glb


def test_a_foreign_absolute_path_is_looked_for_beside_the_mesh(tmp_path: Path):
    (tmp_path / "paint.png").write_bytes(png())
    image = IMAGE.replace("paint.png", r"C:\Users\me\paint.png")
    assert png() in read(tmp_path / "a.dae", dae(effect=texture_effect(), images=image)).glb


def test_a_missing_texture_is_grey_and_said(tmp_path: Path):
    mesh = read(tmp_path / "a.dae", dae(effect=texture_effect(), images=IMAGE))
    assert 'it refers to "paint.png"' in sentences(mesh)[0]
    assert "images" not in glb_document(mesh.glb)


@pytest.mark.parametrize(
    "data", [b"", b"no image", png()[:20], png(told=(60000, 60000)), png(told=(9000, 9000))]
)
def test_a_broken_or_huge_texture_is_left_out_and_said(tmp_path: Path, data: bytes):
    (tmp_path / "paint.png").write_bytes(data)
    mesh = read(tmp_path / "a.dae", dae(effect=texture_effect(), images=IMAGE))
    assert "images" not in glb_document(mesh.glb)
    assert "paint.png" in sentences(mesh)[0]


@pytest.mark.parametrize(
    "uri", ["../secret.png", "/etc/hostname", "http://127.0.0.1:1/a.png", "file:///etc/hostname"]
)
def test_nothing_is_read_outside_the_roots(tmp_path: Path, uri: str):
    (tmp_path / "secret.png").write_bytes(png())
    (tmp_path / "in").mkdir()
    image = IMAGE.replace("paint.png", uri)
    mesh = read(tmp_path / "in" / "a.dae", dae(effect=texture_effect(), images=image))
    assert "images" not in glb_document(mesh.glb)
    assert mesh.problems


def test_a_texture_in_another_folder_is_read_below_a_served_root(tmp_path: Path):
    (tmp_path / "paint.png").write_bytes(png())
    (tmp_path / "in").mkdir()
    text = dae(effect=texture_effect(), images=IMAGE.replace("paint", "../paint"))
    assert png() in read(tmp_path / "in" / "a.dae", text, tmp_path).glb


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "not well-formed"),
        (dae()[:-30], "not well-formed"),
        ("<x/>", "its root is <x>"),
        (dae().replace("1 1 0 0 1 0<", "1 1 0 0 one 0<"), "holds what is no number"),
        (dae().replace("<p>0 0", "<p>9 0"), "points at row 9 of a list with 4 rows"),
        (dae().replace("<p>0 0", "<p>-1 0"), "points at row"),
        (dae().replace("<p>0 0", "<p>0.5 0"), "no whole number"),
        (dae().replace('offset="1"', 'offset="99999"'), "the offset 99999"),
        (dae().replace('source="#p"', 'source="#q"'), '"q" does not exist'),
        (dae().replace('stride="3"', 'stride="0"'), "the stride 0"),
        (dae(node="<matrix>1 2 3</matrix>"), "has not 16 finite numbers"),
        (dae(node="<scale>nan 1 1</scale>"), "has not 3 finite numbers"),
        (dae(scene='<node id="x"><instance_node url="#x"/></node>'), "without end"),
        (dae(scene="<node/>"), "no triangle"),
        ('<!DOCTYPE a [<!ENTITY b "c">]>' + dae().partition("?>")[2], "entity"),
    ],
)
def test_each_broken_document_says_what_is_wrong(tmp_path: Path, text: str, said: str):
    with pytest.raises(MeshError) as raised:
        read(tmp_path / "a.dae", text)
    assert said in str(raised.value)
    assert str(tmp_path / "a.dae") in str(raised.value)


def test_nodes_that_double_at_every_level_are_refused_in_time(tmp_path: Path):
    levels = "".join(
        f'<node id="n{n}"><instance_node url="#n{n + 1}"/><instance_node url="#n{n + 1}"/></node>'
        for n in range(60)
    )
    scene = f'{levels}<node id="n60">{SHOWN}</node>'
    start = time.thread_time()
    with pytest.raises(MeshError, match="without end"):
        read(tmp_path / "a.dae", dae(scene=scene))
    assert time.thread_time() - start < 10


@pytest.mark.corpus
def test_every_real_collada_is_as_large_as_trimesh_says_times_its_unit(corpus: Path):
    compared = 0
    for path in sorted(corpus.rglob("*.dae")):
        mesh = read_mesh(MeshFiles(path, (corpus,)))
        theirs = size_by_trimesh(path)
        if theirs is None:
            continue
        size, triangles = theirs
        assert len(mesh.faces) == triangles, path
        np.testing.assert_allclose(size_m(mesh), size, rtol=1e-5, atol=1e-6, err_msg=str(path))
        compared += 1
    assert compared > 40


@pytest.mark.corpus
def test_the_camera_of_turtlebot3_is_thirteen_centimetres_wide(corpus: Path):
    path = next(corpus.rglob("r200.dae"))
    assert size_m(read_mesh(MeshFiles(path))) == pytest.approx([0.130, 0.020, 0.006], abs=5e-4)


@pytest.mark.parametrize(("before", "behind"), [("\n", ""), ("\ufeff \r\n", "\n"), ("", "\n\0\0")])
def test_a_blank_line_before_the_declaration_and_nuls_at_the_end_are_passed_over(
    tmp_path: Path, before: str, behind: str
):
    text = dae()
    declared = text if text.startswith("<?xml") else f'<?xml version="1.0"?>\n{text}'
    assert len(read(tmp_path / "a.dae", before + declared + behind).faces) == 2


def test_a_document_in_utf_16_keeps_its_last_byte(tmp_path: Path):
    text = '<?xml version="1.0" encoding="utf-16"?>\n' + dae().partition("?>")[2].strip() + "\n"
    file = tmp_path / "a.dae"
    file.write_bytes(text.encode("utf-16"))
    assert len(read_mesh(MeshFiles(file)).faces) == 2
