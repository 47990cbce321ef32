from __future__ import annotations

import io
from typing import TYPE_CHECKING

import pytest

from tests.support.command_line import studio
from tests.support.wire import free_endpoint

if TYPE_CHECKING:
    from pathlib import Path

STRING_HASH = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"


@pytest.fixture(autouse=True)
def own_data(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("STUDIO_DATA_DIR", str(tmp_path / "data"))
    monkeypatch.chdir(tmp_path)


def package_at(folder: Path, name: str, **texts: str) -> Path:
    package = folder / name
    (package / "msg").mkdir(parents=True)
    (package / "package.xml").write_text(f"<package><name>{name}</name></package>")
    for kind, text in texts.items():
        (package / "msg" / f"{kind}.msg").write_text(text)
    return package


def test_t5_pose_is_shown_with_nested_fields_indented():
    assert studio("interface", "show", "geometry_msgs/msg/Pose").out == (
        "# A representation of pose in free space, composed of position and orientation.\n\n"
        "Point position\n\tfloat64 x\n\tfloat64 y\n\tfloat64 z\n"
        "Quaternion orientation\n\tfloat64 x 0\n\tfloat64 y 0\n\tfloat64 z 0\n\tfloat64 w 1\n"
    )


def test_t5_a_short_name_and_that_of_a_service_are_shown_too():
    assert studio("interface", "show", "std_msgs/msg/String").out == "string data\n"
    lines = studio("interface", "show", "example_interfaces/srv/AddTwoInts").out.splitlines()
    assert [line for line in lines if line and not line.startswith("#")] == [
        "int64 a",
        "int64 b",
        "---",
        "int64 sum",
    ]


@pytest.mark.parametrize(
    "package",
    [
        "std_msgs",
        "sensor_msgs",
        "geometry_msgs",
        "nav_msgs",
        "action_msgs",
        "builtin_interfaces",
    ],
)
def test_t6_every_type_of_a_usual_package_is_listed(package: str):
    listed = studio("interface", "package", package).out.split()
    assert listed
    assert set(listed) < set(studio("interface", "list").out.split())
    assert package in studio("interface", "packages").out.split()


def test_the_distribution_is_that_of_the_environment(monkeypatch: pytest.MonkeyPatch):
    shown = "variance"
    assert shown in studio("interface", "show", "sensor_msgs/msg/Range").out
    monkeypatch.setenv("ROS_DISTRO", "humble")
    assert shown not in studio("interface", "show", "sensor_msgs/msg/Range").out
    other = studio("interface", "show", "sensor_msgs/msg/Range", "--distro", "jazzy")
    assert shown in other.out


def test_t5_the_type_may_be_piped_in(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("sys.stdin", io.StringIO("std_msgs/msg/String\n"))
    assert studio("interface", "show", "-").out == "string data\n"
    monkeypatch.setattr("sys.stdin", io.StringIO("std_msgs/msg/String\n"))
    assert studio("interface", "hash", "-").out == f"{STRING_HASH}\n"
    ran = studio("interface", "show", "-", "--interfaces", "-")
    assert ran.code == 2
    assert "Standard input is read once" in ran.err


def test_kinds_are_listed_alone_on_demand():
    out = studio("interface", "list", "-a").out
    assert out.startswith("Actions:\n")
    assert "Messages:" not in out
    assert "/srv/" not in out


def test_proto_is_a_value_to_fill_in():
    out = studio("interface", "proto", "geometry_msgs/msg/Point").out
    assert out == '"x: 0.0\ny: 0.0\nz: 0.0\n"\n'
    bare = studio("interface", "proto", "example_interfaces/srv/AddTwoInts", "--no-quotes").out
    assert bare == "a: 0\nb: 0\n"


def test_t11_a_package_of_ones_own_is_used_without_a_build(tmp_path: Path):
    package = package_at(tmp_path / "far", "own_interfaces", Telemetry="# Of a robot.\nfloat32 v\n")
    named = studio(
        "interface", "show", "own_interfaces/msg/Telemetry", "--interfaces", str(package)
    )
    assert named.out == "# Of a robot.\nfloat32 v\n"
    file = package / "msg" / "Telemetry.msg"
    alone = studio("interface", "show", "own_interfaces/msg/Telemetry", "--interfaces", str(file))
    assert alone.out == named.out
    plain = studio("interface", "show", "own_interfaces/msg/Telemetry", "--no-comments",
                   "--package-path", str(tmp_path / "far"))  # fmt: skip
    assert plain.out == "float32 v\n"


def test_the_workspace_that_the_command_runs_in_is_opened(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    package_at(tmp_path / "ws" / "src", "own_interfaces", Twin="geometry_msgs/Point[2] ends\n")
    monkeypatch.chdir(tmp_path / "ws")
    shown = studio("interface", "show", "own_interfaces/msg/Twin").out
    assert shown == "geometry_msgs/Point[2] ends\n\tfloat64 x\n\tfloat64 y\n\tfloat64 z\n"


@pytest.mark.parametrize(
    "words",
    [
        ("show", "no_such/msg/Type"),
        ("show", "nonsense"),
        ("package", "no_such"),
        ("proto", "std_msgs/msg/string"),
        ("hash", "no_such/action/Type", "--interfaces", "-"),
        ("list", "--distro", "noetic"),
        ("list", "--interfaces", "nowhere"),
    ],
)
def test_a_mistake_is_one_sentence(words: tuple[str, ...], monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("ZENOH_CONFIG_OVERRIDE", f'connect/endpoints=["{free_endpoint()}"]')
    monkeypatch.setattr("sys.stdin", io.StringIO("MSG: own_interfaces/Twin\nstring data\n"))
    ran = studio("interface", *words)
    assert ran.code == 2
    assert ran.err.startswith("studio: ")
    assert ran.err.count("\n") == 1


def test_a_faulty_text_is_told_with_file_line_and_mend_and_the_others_stay(tmp_path: Path):
    package = package_at(
        tmp_path / "src", "own_interfaces", Good="float32 v\n", Bad="float32 v\nfloat w\n"
    )
    bad = package / "msg" / "Bad.msg"
    told = f'{bad}:2: "float" is no type: write float32 or float64.\n'
    for words in (("list",), ("package", "own_interfaces")):
        for named in ((), ("--interfaces", str(package))):
            ran = studio("interface", *words, *named)
            assert (ran.code, ran.err) == (0, f"WARNING: {told}")
            assert "own_interfaces/msg/Good" in ran.out
            assert "own_interfaces/msg/Bad" not in ran.out
    shown = studio("interface", "show", "own_interfaces/msg/Good")
    assert (shown.code, shown.out, shown.err) == (0, "float32 v\n", "")
    endpoint = free_endpoint()
    for words in (
        ("interface", "show", "own_interfaces/msg/Bad"),
        ("topic", "pub", "--once", "/x", "own_interfaces/msg/Bad", "{}", "--router", "auto"),
    ):
        ran = studio(*words, "--connect", endpoint)
        assert (ran.code, ran.err) == (
            2,
            f'studio: The type "own_interfaces/msg/Bad" cannot be used: {told}',
        )


def test_a_file_whose_name_names_no_type_is_told_with_a_better_one(tmp_path: Path):
    package = package_at(tmp_path / "src", "own_interfaces", Good="float32 v\n")
    (package / "msg" / "battery_level.msg").write_text("float32 v\n")
    listed = studio("interface", "package", "own_interfaces")
    assert "battery_level.msg: its name defines no type" in listed.err
    shown = studio("interface", "show", "own_interfaces/msg/BatteryLevel")
    assert shown.code == 2
    assert "call it BatteryLevel.msg" in shown.err
