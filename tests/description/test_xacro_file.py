from __future__ import annotations

from pathlib import Path

import pytest

from studio.description import ReadPolicy, XacroFile
from studio.errors import ExpansionError, StaleEditError
from tests.support.descriptions import robot, write

WHEEL = (
    '<xacro:arg name="side" default="left"/><xacro:property name="r" value="0.1"/>'
    '<link name="$(arg side)"><visual><geometry><sphere radius="${r}"/></geometry></visual></link>'
)
MODELS = Path(__file__).resolve().parents[2] / "models"


def opened(folder: Path, body: str = WHEEL) -> XacroFile:
    return XacroFile(write(folder, {"a.xacro": robot(body)}))


def site_of(file: XacroFile, name: str) -> str:
    return next(site.id for site in file.sites if site.name == name)


def test_an_edit_changes_the_robot_and_not_the_disk(tmp_path: Path):
    file = opened(tmp_path)
    change = file.edit(site_of(file, "r"), "0.25")
    assert change.is_patch
    assert [part.key for part in change.changed_parts] == ["link:left"]
    assert 'radius="0.25"' in file.urdf
    assert 'value="0.1"' in (tmp_path / "a.xacro").read_text()
    assert file.unsaved_files == (str(tmp_path / "a.xacro"),)


def test_what_is_saved_is_what_the_disk_has(tmp_path: Path):
    file = opened(tmp_path)
    file.edit(site_of(file, "r"), "0.25")
    assert file.save() == (str(tmp_path / "a.xacro"),)
    assert not file.unsaved_files
    assert XacroFile(tmp_path / "a.xacro").urdf == file.urdf


def test_sites_stand_where_edits_before_them_moved_them(tmp_path: Path):
    file = opened(tmp_path)
    side = next(site for site in file.sites if site.name == "side")
    file.edit(side.id, "hind_left")
    r = next(site for site in file.sites if site.name == "r")
    file.save()
    data = (tmp_path / "a.xacro").read_bytes()
    assert data[r.span.start : r.span.end] == b"0.1"


def test_an_argument_is_passed_and_taken_back(tmp_path: Path):
    file = opened(tmp_path)
    file.set_argument("side", "right")
    assert [part.key for part in file.parts] == ["link:right"]
    assert file.arguments == {"side": "right"}
    file.set_argument("side", None)
    assert [part.key for part in file.parts] == ["link:left"]


def test_a_robot_outlives_an_edit_that_leaves_none_and_is_mended_by_the_next(tmp_path: Path):
    file = opened(tmp_path)
    before = file.urdf
    with pytest.raises(ExpansionError, match="nothing_is_called_so"):
        file.edit(site_of(file, "r"), "${nothing_is_called_so}")
    assert file.urdf == before
    file.edit(site_of(file, "r"), "0.5")
    assert 'radius="0.5"' in file.urdf


@pytest.mark.parametrize("body", ["<link", '<link name="${nothing}"/>', "<link></joint>"])
def test_a_file_without_a_robot_says_where_its_mistake_is(tmp_path: Path, body: str):
    with pytest.raises(ExpansionError) as raised:
        opened(tmp_path, body)
    assert raised.value.problem.place is not None
    assert raised.value.problem.place.file == str(tmp_path / "a.xacro")


def test_an_unknown_site_is_refused(tmp_path: Path):
    with pytest.raises(StaleEditError):
        opened(tmp_path).edit("nothing", "1")


def test_a_file_finds_its_own_package_and_reads_nothing_beside_it(tmp_path: Path):
    write(
        tmp_path,
        {
            "p/package.xml": "<package><name>p_description</name></package>",
            "p/urdf/a.xacro": robot('<xacro:include filename="$(find p_description)/b.xacro"/>'),
            "p/b.xacro": robot(WHEEL),
            "p/urdf/c.xacro": robot('<xacro:include filename="../../secret.xacro"/>'),
            "secret.xacro": robot(WHEEL),
        },
    )
    assert [part.key for part in XacroFile(tmp_path / "p/urdf/a.xacro").parts] == ["link:left"]
    with pytest.raises(ExpansionError):
        XacroFile(tmp_path / "p/urdf/c.xacro")
    wider = ReadPolicy((str(tmp_path),), {}, {})
    assert XacroFile(tmp_path / "p/urdf/c.xacro", policy=wider).parts


def test_a_shipped_robot_opens_with_no_more_than_its_path():
    file = XacroFile(MODELS / "rover_description" / "urdf" / "rover.urdf.xacro")
    assert 'name="base_link"' in file.urdf
    assert not file.warnings
