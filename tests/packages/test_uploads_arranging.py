from __future__ import annotations

from pathlib import Path

from studio.packages.uploads import arrange

MESH = "package://my_robot/meshes/base.stl"


def write(folder: Path, files: dict[str, str]) -> None:
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def names(folder: Path) -> set[str]:
    return {one.relative_to(folder).as_posix() for one in folder.rglob("*") if one.is_file()}


def test_meshes_dropped_beside_a_robot_go_where_its_package_is_looked_for(tmp_path: Path):
    write(tmp_path, {"r.urdf": f'<mesh filename="{MESH}"/>', "base.stl": "", "arm.stl": ""})
    assert arrange(tmp_path) == {"my_robot": Path("my_robot")}
    assert names(tmp_path) == {"r.urdf", "my_robot/meshes/base.stl", "arm.stl"}


def test_a_folder_under_another_name_stands_for_the_package(tmp_path: Path):
    before = {"my_robot-main/urdf/r.urdf": f'"{MESH}"', "my_robot-main/meshes/base.stl": ""}
    write(tmp_path, before)
    assert arrange(tmp_path) == {"my_robot": Path("my_robot-main")}
    assert names(tmp_path) == set(before)


def test_a_package_with_its_manifest_is_left_as_it_is(tmp_path: Path):
    files = {
        "p/package.xml": "<package><name>my_robot</name></package>",
        "p/r.urdf": f'"{MESH}"',
        "p/base.stl": "",
    }
    write(tmp_path, files)
    assert arrange(tmp_path) == {}
    assert names(tmp_path) == set(files)


def test_a_missing_mesh_makes_no_package(tmp_path: Path):
    write(tmp_path, {"r.urdf": f'<mesh filename="{MESH}"/>'})
    assert arrange(tmp_path) == {}
    assert names(tmp_path) == {"r.urdf"}


def test_relative_names_are_found_beside_the_description(tmp_path: Path):
    write(tmp_path, {"r.urdf": '<mesh filename="../meshes/a.stl"/>', "a.stl": ""})
    write(tmp_path, {"inner/q.urdf": '<mesh filename="meshes/b.stl"/>', "b.stl": ""})
    assert arrange(tmp_path) == {}
    assert names(tmp_path) == {"r.urdf", "a.stl", "inner/q.urdf", "inner/meshes/b.stl"}


def test_included_files_go_into_the_package_that_is_asked_for(tmp_path: Path):
    include = '<xacro:include filename="$(find my_robot)/urdf/wheel.xacro"/>'
    write(tmp_path, {"r.urdf.xacro": include, "wheel.xacro": "<robot/>"})
    assert arrange(tmp_path) == {"my_robot": Path("my_robot")}
    assert names(tmp_path) == {"r.urdf.xacro", "my_robot/urdf/wheel.xacro"}


def test_of_two_files_of_one_name_none_is_guessed(tmp_path: Path):
    files = {"r.urdf": '<mesh filename="m/base.stl"/>', "a/base.stl": "1", "b/base.stl": "2"}
    write(tmp_path, files)
    assert arrange(tmp_path) == {}
    assert names(tmp_path) == set(files)


def test_nothing_leaves_the_folder(tmp_path: Path):
    inside = tmp_path / "inside"
    write(tmp_path, {"outside.stl": ""})
    hostile = [
        "package://../x/outside.stl",
        "package://my_robot/../../outside.stl",
        "package://..//outside.stl",
        "package://my_robot//etc/outside.stl",
    ]
    text = "".join(f'<mesh filename="{one}"/>' for one in hostile)
    write(inside, {"r.urdf": f'{text}<mesh filename="../../outside.stl"/>', "outside.stl": ""})
    arrange(inside)
    assert names(tmp_path) - {f"inside/{one}" for one in names(inside)} == {"outside.stl"}
    assert "r.urdf" in names(inside)
