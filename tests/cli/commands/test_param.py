from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.ros.messages import message
from tests.support.command_line import studio
from tests.support.demos import node_at, running_demo

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path


@pytest.fixture(scope="module", autouse=True)
def nodes(endpoint: str) -> Generator[None]:
    with (
        running_demo(endpoint, "turtlesim_node") as turtles,
        running_demo(endpoint, "parameter_node") as parameters,
    ):
        turtles.wait_for("Spawning turtle")
        parameters.wait_for("Max velocity")
        yield


def test_p1_parameters_are_listed_of_all_nodes_and_of_one(endpoint: str):
    at = ("--connect", endpoint)
    out = studio("param", "list", *at).out
    assert out.startswith("/parameter_node:\n  max_velocity\n  robot_name\n")
    assert "/turtlesim:\n  background_b\n  background_g\n  background_r\n" in out
    one = studio("param", "list", "/turtlesim", "--param-type", *at).out
    assert one.startswith("  background_b (type: integer)\n")


def test_q1_a_node_of_another_distribution_is_said_to_be_one(endpoint: str):
    at = ("--connect", endpoint, "--distro", "humble")
    for words in (("get", "/turtlesim", "background_r"), ("list",)):
        ran = studio("param", *words, *at)
        assert ran.code in {0, 2}
        assert ran.err.startswith("WARNING: Others have rcl_interfaces/srv/")
        assert ran.err.count("WARNING: ") == 1
        assert "choose --distro jazzy" in ran.err


def test_p1_a_colour_is_set_and_read_back(endpoint: str):
    at = ("--connect", endpoint)
    ran = studio("param", "set", "/turtlesim", "background_r", "150", *at)
    assert (ran.code, ran.out) == (0, "Set parameter successful\n")
    assert studio("param", "get", "/turtlesim", "background_r", *at).out == (
        "Integer value is: 150\n"
    )
    hidden = studio("param", "get", "/turtlesim", "background_r", "--hide-type", *at)
    assert hidden.out == "150\n", hidden.err


def test_p2_negative_numbers_are_values(endpoint: str):
    at = ("--connect", endpoint)
    ran = studio("param", "set", "/turtlesim", "background_g", "-1.5", *at)
    assert ran.code == 1
    assert "double was given" in ran.err
    ran = studio("param", "set", "/turtlesim", "background_g", "-1", *at)
    assert ran.code == 1
    assert ran.err.startswith("Setting parameter failed: ")


def test_p2_a_rejected_set_shows_the_reason(endpoint: str):
    ran = studio("param", "set", "/parameter_node", "max_velocity", "fast", "--connect", endpoint)
    assert ran.code == 1
    assert ran.err.startswith("Setting parameter failed: ")
    assert "string was given" in ran.err


def test_p1_a_dump_is_loaded_again(endpoint: str, tmp_path: Path):
    at = ("--connect", endpoint)
    out = studio("param", "dump", "/turtlesim", *at).out
    assert out.startswith("/turtlesim:\n  ros__parameters:\n    background_b: 255\n")
    file = tmp_path / "own.yaml"
    file.write_text("/turtlesim:\n  ros__parameters:\n    background_b: 12\n")
    ran = studio("param", "load", "/turtlesim", str(file), *at)
    assert (ran.code, ran.out) == (0, "Set parameter background_b successful\n")
    assert studio("param", "get", "/turtlesim", "background_b", "--hide-type", *at).out == "12\n"
    studio("param", "dump", "/turtlesim", "--output-dir", str(tmp_path), *at)
    assert "background_b: 12\n" in (tmp_path / "turtlesim.yaml").read_text()


def test_p1_parameters_are_listed_by_what_their_names_begin_with(endpoint: str):
    at = ("--connect", endpoint)
    out = studio("param", "list", "/turtlesim", "--filter", ".*_[gr]$", *at).out
    assert out == "  background_g\n  background_r\n"
    ran = studio("param", "list", "--filter", "[", *at)
    assert ran.code == 2
    assert "is no regular expression" in ran.err


def test_p2_a_parameter_that_keeps_its_type_is_not_deleted(endpoint: str):
    ran = studio("param", "delete", "/turtlesim", "background_r", "--connect", endpoint)
    assert (ran.code, ran.out) == (1, "")
    assert ran.err.startswith("Deleting parameter failed: ")


def test_p2_a_parameter_of_any_type_is_deleted(endpoint: str):
    descriptor = message("rcl_interfaces/msg/ParameterDescriptor")(dynamic_typing=True)
    with node_at(endpoint, "free") as node:
        node.declare_parameter("spare", 3, descriptor)
        ran = studio("param", "delete", "/free", "spare", "--connect", endpoint)
        assert (ran.code, ran.out) == (0, "Deleted parameter successfully\n")
        assert not node.has_parameter("spare")


def test_p1_a_parameter_is_described(endpoint: str):
    out = studio("param", "describe", "/turtlesim", "background_b", "--connect", endpoint).out
    assert out.startswith("Parameter name: background_b\n  Type: integer\n")
    assert "  Constraints:\n    Min value: 0\n    Max value: 255\n" in out


@pytest.mark.parametrize(
    "words",
    [
        ("get", "/nope", "x"),
        ("set", "/nope", "x", "1"),
        ("list", "/nope"),
        ("dump", "/nope"),
        ("get", "/turtlesim", "no_such"),
        ("set", "/turtlesim", "no_such", "1"),
        ("delete", "/turtlesim", "no_such"),
        ("delete", "/nope", "x"),
    ],
)
def test_what_is_not_there_ends_with_1(endpoint: str, words: tuple[str, ...]):
    ran = studio("param", *words, "--connect", endpoint)
    assert (ran.code, ran.out) == (1, "")
    assert ran.err.count("\n") == 1


@pytest.mark.parametrize("text", ["[", "a: 1", "/turtlesim: {ros__parameters: 3}", "- 1"])
def test_a_broken_file_is_one_sentence(endpoint: str, tmp_path: Path, text: str):
    file = tmp_path / "broken.yaml"
    file.write_text(text)
    ran = studio("param", "load", "/turtlesim", str(file), "--connect", endpoint)
    assert ran.code == 2
    assert str(file) in ran.err
    assert studio("param", "load", "/turtlesim", "none.yaml", "--connect", endpoint).code == 2
