from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import RosNameError
from studio.ros.names import (
    action_part,
    as_namespace,
    check_full_name,
    check_namespace,
    check_node_name,
    check_package_name,
    check_topic_name,
    expand,
    full_type_name,
    is_hidden,
    node_path,
    split_action_part,
    split_type_name,
)


@pytest.mark.parametrize(
    ("name", "namespace", "full"),
    [
        ("chatter", "/", "/chatter"),
        ("chatter", "/robot1", "/robot1/chatter"),
        ("a/b", "/robot1", "/robot1/a/b"),
        ("/chatter", "/robot1", "/chatter"),
        ("~", "/robot1", "/robot1/talker"),
        ("~/status", "/", "/talker/status"),
        ("{node}/x", "/robot1", "/robot1/talker/x"),
        ("{ns}/x", "/robot1", "/robot1/x"),
        ("{ns}/x", "/", "/x"),
        ("~/{node}", "/", "/talker/talker"),
    ],
)
def test_a_short_name_becomes_a_full_one(name: str, namespace: str, full: str):
    assert expand(name, namespace, "talker") == full


@pytest.mark.parametrize(
    "name",
    ["", "a//b", "a/", "/", "1a", "a/1b", "~a", "a~", "a b", "é", "a*", "{who}/x", "{", "a" * 248],
)
def test_a_topic_name_that_rcl_refuses_is_refused(name: str):
    with pytest.raises(RosNameError, match="cannot be used in ROS 2"):
        check_topic_name(name)


@pytest.mark.parametrize("name", ["", "a/b", "1a", "a-b", "a" * 256, "ä"])
def test_a_node_name_that_rcl_refuses_is_refused(name: str):
    with pytest.raises(RosNameError):
        check_node_name(name)


@pytest.mark.parametrize("namespace", ["", "a", "/a/", "//", "/1", "/a b"])
def test_a_namespace_that_rcl_refuses_is_refused(namespace: str):
    with pytest.raises(RosNameError):
        check_namespace(namespace)


def test_a_namespace_may_be_given_without_its_slash():
    assert (as_namespace(""), as_namespace("a"), as_namespace("/a")) == ("/", "/a", "/a")


def test_a_name_names_itself_in_the_sentence_cut_where_it_is_long():
    with pytest.raises(RosNameError) as caught:
        check_full_name("x" * 10_000)
    assert "begins" in str(caught.value) or "longer" in str(caught.value)
    assert len(str(caught.value)) < 400


def test_a_part_of_an_action_is_named_after_both():
    assert action_part("/turn", "feedback") == "/turn/_action/feedback"
    assert split_action_part("/turn/_action/feedback") == ("/turn", "feedback")


@pytest.mark.parametrize(
    "name", ["/turn", "/turn/_hidden", "/_action/status", "/turn/_action", "/turn/_action/"]
)
def test_another_name_is_no_part_of_an_action(name: str):
    assert split_action_part(name) is None


def test_hidden_names_have_a_part_with_an_underscore_in_front():
    assert is_hidden("/turn/_action/feedback")
    assert not is_hidden("/turn_left/x_")


@pytest.mark.parametrize(("namespace", "path"), [("/", "/talker"), ("/a/b", "/a/b/talker")])
def test_a_path_of_a_node_is_joined(namespace: str, path: str):
    assert node_path(namespace, "talker") == path


@pytest.mark.parametrize(
    "name",
    ["std_msgs/msg/String", "a/srv/T_Request", "a/srv/T_Event", "a/action/T_SendGoal_Response",
     "a/action/T_FeedbackMessage"],
)  # fmt: skip
def test_types_and_their_parts_have_three_part_names(name: str):
    assert "/".join(split_type_name(name)) == name


@pytest.mark.parametrize(
    "name",
    ["String", "std_msgs/String", "a/msg/b", "a/msg/T_Request", "a/srv/T_Goal", "A/msg/T",
     "a/idl/T", "a/msg/T/U", "a__b/msg/T", "a_/msg/T", "a/msg/T\n"],
)  # fmt: skip
def test_what_is_no_type_name_is_refused(name: str):
    with pytest.raises(RosNameError):
        split_type_name(name)


def test_users_may_leave_out_the_kind_or_write_dots():
    assert full_type_name("std_msgs/String") == "std_msgs/msg/String"
    assert full_type_name("std_srvs.srv.Empty") == "std_srvs/srv/Empty"
    assert full_type_name("std_srvs/Empty", "srv") == "std_srvs/srv/Empty"


@pytest.mark.parametrize(
    ("typed", "said"),
    [
        ("radio/srv/GetSong.srv", "a type has no .srv at its end, write radio/srv/GetSong"),
        ("std_msgs/String.msg", "a type has no .msg at its end, write std_msgs/msg/String"),
        ("GetSong.srv", "a type has no .srv at its end, write package/srv/GetSong"),
        ("std_msgs/string", "the first a capital"),
        ("Std/String", "lower case"),
        ("String", "a type is named package/msg/Type"),
    ],
)
def test_what_names_no_type_is_quoted_as_it_was_typed(typed: str, said: str):
    with pytest.raises(RosNameError) as caught:
        full_type_name(typed)
    assert str(caught.value).startswith(f'"{typed}" cannot be used in ROS 2: ')
    assert said in str(caught.value)


def test_packages_are_lower_case():
    assert check_package_name("std_msgs") == "std_msgs"
    with pytest.raises(RosNameError):
        check_package_name("Std")


PARTS = st.from_regex(r"[A-Za-z_][A-Za-z0-9_]{0,8}", fullmatch=True)


@given(st.lists(PARTS, min_size=1, max_size=4), st.lists(PARTS, max_size=3), PARTS)
def test_what_was_expanded_expands_to_itself(name: list[str], space: list[str], node: str):
    namespace = "/" + "/".join(space)
    full = expand("/".join(name), namespace, node)
    assert expand(full, "/elsewhere", node) == full
    assert full.startswith(namespace)


@given(st.text(max_size=60))
def test_any_text_is_expanded_or_refused_by_name(text: str):
    try:
        full = expand(text, "/ns", "node")
    except RosNameError:
        return
    assert check_full_name(full) == full
