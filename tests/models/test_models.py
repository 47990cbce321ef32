from __future__ import annotations

import logging
import re
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from tests.support.xacro_command import expand_by_command

MODELS = Path(__file__).resolve().parents[2] / "models"
PACKAGES = sorted(folder.name for folder in MODELS.iterdir() if folder.is_dir())

VARIANTS = {
    "rover_description": [
        (),
        ("arm:=false", "lidar:=none", "cameras:=none"),
        ("colour:=blue", "wheels:=road", "lidar:=puck", "cameras:=mono"),
    ],
    "xacro_robot_description": [(), ("caster:=true",)],
    "r2d2_description": [(), ("stands:=false",)],
    "arm6_description": [(), ("arm_type:=large", "prefix:=left_"), ("gripper:=false",)],
    "quadruped_description": [(), ("colour:=white", "head:=false")],
}

ROVER_TRIANGLES = 10_000


@dataclass(frozen=True)
class Model:
    """One package expanded by the stock command with some arguments."""

    package: Path
    urdf: str

    @property
    def root(self) -> ET.Element:
        return ET.fromstring(self.urdf)

    @property
    def joints(self) -> dict[str, str]:
        return {one.attrib["name"]: one.attrib["type"] for one in self.root.findall("joint")}


def entry_point(package: str) -> Path:
    (entry,) = (MODELS / package / "urdf").glob("*.urdf.xacro")
    return entry


def expand(package: str, scratch: Path, *arguments: str) -> Model:
    urdf = expand_by_command(entry_point(package), MODELS, scratch, *arguments)
    return Model(MODELS / package, urdf)


def mesh_path(uri: str) -> Path:
    assert uri.startswith("package://"), f"{uri} would not be found by RViz"
    return MODELS / uri.removeprefix("package://")


def every_variant() -> list[tuple[str, tuple[str, ...]]]:
    return [(package, arguments) for package in PACKAGES for arguments in VARIANTS[package]]


@pytest.fixture(params=every_variant(), ids=lambda one: " ".join([one[0], *one[1]]))
def model(request: pytest.FixtureRequest, tmp_path: Path) -> Model:
    package, arguments = request.param
    return expand(package, tmp_path, *arguments)


@pytest.fixture
def rover(tmp_path: Path) -> Model:
    return expand("rover_description", tmp_path)


def test_every_link_hangs_on_one_root(model: Model):
    links = {link.attrib["name"] for link in model.root.findall("link")}
    parents = {one.find("child").attrib["link"] for one in model.root.findall("joint")}  # pyright: ignore[reportOptionalMemberAccess]
    assert len(links) == len(model.root.findall("link"))
    assert len(links - parents) == 1
    assert len(model.joints) == len(model.root.findall("joint")) == len(links) - 1


def test_every_mesh_is_in_the_package(model: Model):
    for mesh in model.root.iter("mesh"):
        path = mesh_path(mesh.attrib["filename"])
        assert path.is_file(), f"{path} is missing"
        assert path.is_relative_to(model.package)


def test_every_material_is_defined(model: Model):
    defined = {one.attrib["name"] for one in model.root.findall("material")}
    used = {one.attrib["name"] for one in model.root.iter("material")}
    assert used == defined


def test_every_inertia_is_one_that_a_body_can_have(model: Model):
    for inertial in model.root.iter("inertial"):
        mass = inertial.find("mass")
        inertia = inertial.find("inertia")
        assert mass is not None
        assert inertia is not None
        moment = {name: float(value) for name, value in inertia.attrib.items()}
        tensor = np.array(
            [
                [moment["ixx"], moment["ixy"], moment["ixz"]],
                [moment["ixy"], moment["iyy"], moment["iyz"]],
                [moment["ixz"], moment["iyz"], moment["izz"]],
            ]
        )
        principal = np.linalg.eigvalsh(tensor)
        assert float(mass.attrib["value"]) > 0
        assert principal[0] > 0
        assert principal[0] + principal[1] >= principal[2] * (1 - 1e-9)


def test_every_limited_joint_holds_its_zero_between_its_limits(model: Model):
    for joint in model.root.findall("joint"):
        if joint.attrib["type"] not in {"revolute", "prismatic"}:
            continue
        limit = joint.find("limit")
        assert limit is not None, f"{joint.attrib['name']} has no limit"
        assert float(limit.attrib["lower"]) <= 0 <= float(limit.attrib["upper"])
        assert float(limit.attrib["effort"]) > 0
        assert float(limit.attrib["velocity"]) > 0


def test_yourdfpy_has_nothing_to_say_about_it(
    model: Model, tmp_path: Path, caplog: pytest.LogCaptureFixture
):
    from yourdfpy import URDF  # pyright: ignore[reportMissingTypeStubs]

    file = tmp_path / "robot.urdf"
    file.write_text(model.urdf)
    with caplog.at_level(logging.WARNING):
        robot = URDF.load(str(file), filename_handler=lambda fname: str(mesh_path(fname)))  # pyright: ignore
    assert robot.validate()  # pyright: ignore
    assert not caplog.records


@pytest.mark.parametrize("package", PACKAGES)
def test_a_package_has_what_ros_and_rviz_ask_for(package: str):
    folder = MODELS / package
    manifest = ET.parse(folder / "package.xml").getroot()
    name = entry_point(package).name.removesuffix(".urdf.xacro")
    assert manifest.findtext("name") == package
    assert manifest.findtext("license") == "Apache-2.0"
    assert (manifest.findtext("description") or "").endswith(".")
    assert (folder / "launch" / "display.launch.py").is_file()
    assert (folder / "rviz" / f"{name}.rviz").is_file()
    installed = re.search(r"DIRECTORY ([a-z ]+)\n", (folder / "CMakeLists.txt").read_text())
    assert installed
    assert set(installed[1].split()) == {
        one.name for one in folder.iterdir() if one.is_dir() and one.name != "__pycache__"
    }


@pytest.mark.parametrize("package", PACKAGES)
def test_the_launch_file_offers_what_the_model_takes(package: str):
    launch = (MODELS / package / "launch" / "display.launch.py").read_text()
    declared = set(re.findall(r'^    "(\w+)": \[', launch, re.MULTILINE))
    arguments = re.findall(r'<xacro:arg name="(\w+)" default="([^"]*)"', read(package))
    assert declared
    assert declared <= {name for name, _ in arguments}
    for name, default in arguments:
        if name in declared:
            assert f'"{name}": ["{default}"' in launch


def read(package: str) -> str:
    return entry_point(package).read_text()


def test_the_readme_says_what_each_package_shows():
    readme = (MODELS.parent / "README.md").read_text()
    for package in PACKAGES:
        assert re.search(rf"`{package}`[^\n]{{20,}}", readme), f"README is silent on {package}"


def test_all_packages_are_tried():
    assert set(VARIANTS) == set(PACKAGES)


def test_the_rover_has_more_than_thirty_knobs_each_explained():
    lines = [line for line in read("rover_description").splitlines() if "<xacro:property" in line]
    numbers = [line for line in lines if re.search(r'value="-?[\d.]+"', line)]
    assert len(numbers) >= 30
    for line in numbers:
        assert re.search(r"<!-- \[-?[\d.]+:[\d.]+:[\d.]+\]", line), f"no slider range: {line}"


def test_the_sliders_of_the_rover_hold_the_value_they_start_at():
    pattern = r'name="(\w+)" value="(-?[\d.]+)"/> <!-- \[(-?[\d.]+):([\d.]+):(-?[\d.]+)\]'
    found = re.findall(pattern, read("rover_description"))
    assert found
    for name, value, low, step, high in found:
        assert float(low) <= float(value) <= float(high), name
        steps = (float(high) - float(low)) / float(step)
        assert steps == pytest.approx(round(steps)), f"{name}: the top is no whole step"


def test_the_rover_rises_with_its_wheels(tmp_path: Path):
    source = read("rover_description")
    changed = source.replace(
        'name="wheel_radius" value="0.105"', 'name="wheel_radius" value="0.155"'
    )
    assert changed != source
    package = tmp_path / "rover_description"
    import shutil

    shutil.copytree(MODELS / "rover_description", package)
    (package / "urdf" / "rover.urdf.xacro").write_text(changed)
    before = expand("rover_description", tmp_path)
    after = Model(
        package, expand_by_command(package / "urdf" / "rover.urdf.xacro", tmp_path, tmp_path)
    )
    assert base_height(after) - base_height(before) == pytest.approx(0.05)
    assert tyre_radius(after) - tyre_radius(before) == pytest.approx(0.05)


def base_height(model: Model) -> float:
    joint = model.root.find("joint[@name='base_joint']/origin")
    assert joint is not None
    return float(joint.attrib["xyz"].split()[2])


def tyre_radius(model: Model) -> float:
    tyre = model.root.find("link[@name='front_left_wheel']/visual/geometry/mesh")
    assert tyre is not None
    return float(tyre.attrib["scale"].split()[0])


def test_the_rover_draws_fast_without_a_gpu(rover: Model, tmp_path: Path):
    from yourdfpy import URDF  # pyright: ignore[reportMissingTypeStubs]

    file = tmp_path / "robot.urdf"
    file.write_text(rover.urdf)
    robot = URDF.load(str(file), filename_handler=lambda fname: str(mesh_path(fname)))  # pyright: ignore
    triangles = sum(len(one.faces) for one in robot.scene.geometry.values())  # pyright: ignore
    assert 1_000 < triangles < ROVER_TRIANGLES


def test_the_rover_has_wheels_that_turn_an_arm_with_limits_and_a_gripper_that_mirrors(rover: Model):
    corners = ("front_left", "front_right", "rear_left", "rear_right")
    for corner in corners:
        assert rover.joints[f"{corner}_wheel_joint"] == "continuous"
    for name in ("turret", "shoulder", "elbow", "wrist", "roll"):
        assert rover.joints[f"arm_{name}_joint"] == "revolute"
    mirror = rover.root.find("joint[@name='gripper_mirror_joint']/mimic")
    assert mirror is not None
    assert mirror.attrib["joint"] == "gripper_joint"
    assert rover.joints["gripper_joint"] == "prismatic"


def test_d2_the_course_robot_has_four_wheel_links_on_one_base(tmp_path: Path):
    robot = expand("xacro_robot_description", tmp_path)
    wheels = {name for name, kind in robot.joints.items() if kind == "continuous"}
    assert wheels == {f"{a}_{b}_joint" for a in ("front", "rear") for b in ("left", "right")}
    source = read("xacro_robot_description")
    assert "<xacro:macro" in source
    assert "<xacro:arg" in source
    assert "<xacro:if" in source
    assert 'name="wheel_radius" value="0.2"' in source


def test_d7_the_astromech_has_the_joints_that_the_lesson_moves(tmp_path: Path):
    robot = expand("r2d2_description", tmp_path, "stands:=false")
    assert robot.joints["swivel"] == "continuous"
    assert robot.joints["tilt"] == "revolute"
    assert robot.joints["periscope"] == "prismatic"
    children = {one.find("child").attrib["link"] for one in robot.root.findall("joint")}  # pyright: ignore[reportOptionalMemberAccess]
    assert "axis" not in children, "the lesson broadcasts the pose of `axis` itself"
    tilt = robot.root.find("joint[@name='tilt']/limit")
    periscope = robot.root.find("joint[@name='periscope']/limit")
    assert tilt is not None
    assert periscope is not None
    assert (float(tilt.attrib["lower"]), float(tilt.attrib["upper"])) == (-0.5, 0.0)
    assert float(periscope.attrib["upper"]) == pytest.approx(0.2)


def test_the_arm_takes_its_six_axes_from_yaml(tmp_path: Path):
    small = expand("arm6_description", tmp_path)
    large = expand("arm6_description", tmp_path, "arm_type:=large")
    names = ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")
    assert [small.joints[f"{name}_joint"] for name in names] == ["revolute"] * 6
    assert reach(large) > 1.5 * reach(small)
    limit = small.root.find("joint[@name='shoulder_pan_joint']/limit")
    assert limit is not None
    assert float(limit.attrib["upper"]) == pytest.approx(np.radians(170.0))


def reach(model: Model) -> float:
    origins = [
        model.root.find(f"joint[@name='{one}_joint']/origin") for one in ("elbow", "wrist_1")
    ]
    return sum(float(one.attrib["xyz"].split()[2]) for one in origins if one is not None)


def test_the_arm_brings_each_kind_of_mesh_in_little_space():
    meshes = list((MODELS / "arm6_description" / "meshes").iterdir())
    assert {one.suffix for one in meshes} == {".stl", ".dae", ".glb"}
    assert sum(one.stat().st_size for one in meshes) < 300_000


def test_the_quadruped_stands_on_its_feet(tmp_path: Path):
    robot = expand("quadruped_description", tmp_path)
    legs = [f"{a}_{b}" for a in ("front", "rear") for b in ("left", "right")]
    for leg in legs:
        for name in ("hip", "thigh", "shank"):
            assert robot.joints[f"{leg}_{name}_joint"] == "revolute"
    plates = robot.root.findall("link[@name='base_link']/visual")
    assert sum(one.attrib.get("name", "").startswith("plate_") for one in plates) == 5
    source = read("quadruped_description")
    assert 'ns="size"' in source
