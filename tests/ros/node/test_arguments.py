from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.errors import ParameterFileError, RosArgumentError
from studio.ros.node.arguments import NodeArguments, parse_arguments
from studio.ros.node.logger import LoggingSeverity
from studio.ros.parameters.files import read_overrides
from studio.ros.tokens import NodeToken

if TYPE_CHECKING:
    from pathlib import Path

    from studio.ros.parameters.parameter import Parameter

TALKER = NodeToken(0, "z", 0, "/ns", "talker")


def of_talker(*words: str) -> NodeArguments:
    return parse_arguments(["--ros-args", *words]).of_node("talker")


def overrides_of(arguments: NodeArguments) -> list[Parameter]:
    return read_overrides(arguments.files, arguments.values, "/ns/talker")


def test_words_outside_of_ros_args_are_left():
    words = ["-r", "a", "--ros-args", "-r", "b:=c", "--", "-p", "d"]
    assert parse_arguments(words).rest == ("-r", "a", "-p", "d")


def test_a_node_is_given_another_name_and_namespace():
    said = of_talker("-r", "__node:=bob", "--remap", "__ns:=/there")
    assert (said.node_name, said.namespace) == ("bob", "/there")


@pytest.mark.parametrize(
    ("rule", "name", "expected"),
    [
        ("chatter:=/x", "/ns/chatter", "/x"),
        ("chatter:=x", "/ns/chatter", "/ns/x"),
        ("/ns/chatter:=~/x", "/ns/chatter", "/ns/talker/x"),
        ("chatter:=x", "/chatter", "/chatter"),
        ("talker:chatter:=x", "/ns/chatter", "/ns/x"),
        ("other:chatter:=x", "/ns/chatter", "/ns/chatter"),
    ],
)
def test_topics_are_given_other_names(rule: str, name: str, expected: str):
    assert of_talker("-r", rule).remapped(name, TALKER) == expected


def test_the_first_remapping_that_fits_counts():
    assert of_talker("-r", "a:=b", "-r", "a:=c").remapped("/ns/a", TALKER) == "/ns/b"


def test_parameters_are_read_as_yaml_and_the_last_one_counts():
    said = of_talker("-p", "a:=1", "-p", "talker:b:=[1.5, 2.5]", "-p", "a:=-2", "-p", "other:c:=1")
    assert {one.name: one.value for one in overrides_of(said)} == {
        "a": -2,
        "b": [1.5, 2.5],
    }


def test_files_of_parameters_come_before_single_ones(tmp_path: Path):
    file = tmp_path / "values.yaml"
    file.write_text("/ns/talker:\n  ros__parameters:\n    a: 1\n    b: two\n")
    said = of_talker("--params-file", str(file), "-p", "a:=3")
    assert {one.name: one.value for one in overrides_of(said)} == {"a": 3, "b": "two"}


def test_a_file_of_parameters_that_is_not_there_is_named(tmp_path: Path):
    said = of_talker("--params-file", str(tmp_path / "none.yaml"))
    with pytest.raises(ParameterFileError, match=r"none\.yaml"):
        overrides_of(said)


def test_levels_of_logging_are_read():
    said = parse_arguments(["--ros-args", "--log-level", "debug", "--log-level", "a.b:=WARN"])
    assert said.levels == (("", LoggingSeverity.DEBUG), ("a.b", LoggingSeverity.WARN))


def test_what_changes_nothing_here_is_taken():
    words = ["--ros-args", "-e", "/enclave", "--disable-stdout-logs", "--log-config-file", "x"]
    assert parse_arguments(words).rest == ()


def test_what_is_said_to_a_node_counts_before_what_is_said_to_all():
    own = parse_arguments(["--ros-args", "-r", "a:=own", "-p", "p:=1"])
    all_nodes = parse_arguments(["--ros-args", "-r", "a:=all", "-p", "p:=2"])
    said = own.before(all_nodes).of_node("talker")
    assert said.remapped("/ns/a", TALKER) == "/ns/own"
    assert [one.value for one in overrides_of(said)] == [1]


@pytest.mark.parametrize(
    "words", [["-r", "a"], ["-p", "a=1"], ["-r"], ["--nonsense"], ["--log-level", "loud"]]
)
def test_words_that_ros_does_not_know_are_refused(words: list[str]):
    with pytest.raises(RosArgumentError):
        parse_arguments(["--ros-args", *words])


def test_a_value_that_is_no_yaml_is_told_with_its_argument(tmp_path: Path):
    said = of_talker("-p", "rate:=[1")
    with pytest.raises(RosArgumentError, match=r'"rate:=\[1" is not understood: its value is no Y'):
        overrides_of(said)
    file = tmp_path / "p.yaml"
    file.write_text("a:\n  b: [\n")
    with pytest.raises(ParameterFileError) as caught:
        overrides_of(of_talker("--params-file", str(file)))
    assert str(caught.value).startswith(f"{file}: it is no YAML (line 3, column 1: expected")
