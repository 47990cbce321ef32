from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import ParameterFileError
from studio.ros.parameters.files import read_all_parameters, read_parameters, write_parameters
from studio.ros.parameters.parameter import Parameter


def as_dict(*parameters: Parameter) -> dict[str, Parameter]:
    return {parameter.name: parameter for parameter in parameters}


def values(text: str, node: str) -> dict[str, object]:
    return {one.name: one.value for one in read_parameters(text, node)}


def test_a_dump_looks_as_ros2_param_dump_prints_it():
    parameters = as_dict(
        Parameter("robot_name", value="turtlebot"),
        Parameter("max_velocity", value=1.0),
        Parameter("use_sim_time", value=False),
        Parameter("wheels.radius", value=0.1),
        Parameter("wheels.names", value=["left", "right"]),
        Parameter("unset"),
    )
    assert write_parameters("/parameter_node", parameters) == (
        "/parameter_node:\n"
        "  ros__parameters:\n"
        "    max_velocity: 1.0\n"
        "    robot_name: turtlebot\n"
        "    use_sim_time: false\n"
        "    wheels:\n"
        "      names:\n"
        "      - left\n"
        "      - right\n"
        "      radius: 0.1\n"
    )


NAMES = st.lists(st.sampled_from(["a", "b", "b_c", "1"]), min_size=1, max_size=3).map(".".join)
VALUES = st.one_of(
    st.booleans(),
    st.integers(-(2**63), 2**63 - 1),
    st.floats(allow_nan=False),
    st.text(max_size=6),
    st.binary(min_size=1, max_size=4),
    st.lists(st.text(max_size=4), min_size=1, max_size=3),
)


@given(st.dictionaries(NAMES, VALUES, max_size=6))
def test_what_is_dumped_is_loaded_again(given_values: dict[str, object]):
    parameters = {name: Parameter(name, value=one) for name, one in given_values.items()}
    read = as_dict(*read_parameters(write_parameters("/ns/node", parameters), "/ns/node"))
    assert read == parameters


@pytest.mark.parametrize(
    "key",
    ["/ns/node", "ns/node", "/**", "/*/node", "/ns/*", "/**/node", "/ns/**", "/**/**/**/**/node"],
)
def test_a_name_in_a_file_means_the_node(key: str):
    assert values(f"{key}:\n  ros__parameters:\n    a: 1\n", "/ns/node") == {"a": 1}


@pytest.mark.parametrize("key", ["/node", "/*", "/ns/node/x", "/other/**", "/**/ns"])
def test_a_name_in_a_file_means_another_node(key: str):
    assert values(f"{key}:\n  ros__parameters:\n    a: 1\n", "/ns/node") == {}


def test_names_may_stand_in_levels_and_what_comes_later_counts():
    text = (
        "/**:\n  ros__parameters:\n    a: 1\n    b.c: 2\n"
        "ns:\n  node:\n    ros__parameters:\n      a: 3\n"
    )
    assert values(text, "/ns/node") == {"a": 3, "b.c": 2}


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("- 1", "names of nodes are expected"),
        ("a: [", "no YAML"),
        ("/n:\n  a: 1", "/n/a needs a ros__parameters"),
        ("/n:\n  ros__parameters: 3", "holds 3, no parameters"),
        ("/n:\n  ros__parameters:\n    a: null", "a has no value"),
        ("/n:\n  ros__parameters:\n    a: [1, x]", "one kind"),
        ("/n:\n  ros__parameters:\n    a: 2024-01-01", "one kind"),
        ("/n:\n  ros__parameters: " + "{a: " * 70 + "1" + "}" * 70, "deeper than 64"),
        ("{/n: " + "{a: " * 70 + "1" + "}" * 71, "deeper than 64"),
    ],
)
def test_a_file_that_is_wrong_says_where(text: str, reason: str):
    with pytest.raises(ParameterFileError, match=reason) as raised:
        read_parameters(text, "/n", "params.yaml")
    assert str(raised.value).startswith("params.yaml: ")


ALL = """\
/one: {ros__parameters: {count: 3}}
/ns: {two: {ros__parameters: {words: [a, b]}}}
/**: {ros__parameters: {count: 9, all: true}}
"""


@pytest.mark.parametrize(
    ("wildcards", "values"),
    [
        (False, {"count": 3, "words": ["a", "b"]}),
        (True, {"count": 3, "all": True, "words": ["a", "b"]}),
    ],
)
def test_a_file_is_read_for_nodes_of_any_name(*, wildcards: bool, values: dict[str, object]):
    found = read_all_parameters(ALL, "all.yaml", wildcards=wildcards)
    assert {one.name: one.value for one in found} == values
