from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import RosNameError
from studio.ros.tokens import DataKey, dds_type, parse_key, ros_type, whatever_type_key

STRING_HASH = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
TYPES = {
    "std_msgs/msg/String": "std_msgs::msg::dds_::String_",
    "example_interfaces/srv/AddTwoInts": "example_interfaces::srv::dds_::AddTwoInts_",
    "a/action/T_SendGoal": "a::action::dds_::T_SendGoal_",
    "a/action/T_GetResult": "a::action::dds_::T_GetResult_",
    "a/action/T_FeedbackMessage": "a::action::dds_::T_FeedbackMessage_",
}
KEYS = {
    DataKey(0, "/robot1/chatter", "std_msgs/msg/String", STRING_HASH):
        f"0/robot1/chatter/std_msgs::msg::dds_::String_/{STRING_HASH}",
    DataKey(42, "/add", "example_interfaces/srv/AddTwoInts", "TypeHashNotSupported"):
        "42/add/example_interfaces::srv::dds_::AddTwoInts_/TypeHashNotSupported",
}  # fmt: skip


@pytest.mark.parametrize("name", TYPES)
def test_a_type_is_written_as_dds_does_and_read_back(name: str):
    assert dds_type(name) == TYPES[name]
    assert ros_type(TYPES[name]) == name


@pytest.mark.parametrize("key", KEYS)
def test_a_key_is_written_as_rmw_zenoh_does_and_read_back(key: DataKey):
    assert str(key) == KEYS[key]
    assert parse_key(KEYS[key]) == key


@pytest.mark.parametrize(
    "key",
    ["", "0", "0/a", "0/a/b", "x/a/std_msgs::msg::dds_::String_/h",
     "-1/a/std_msgs::msg::dds_::String_/h", "4294967296/a/std_msgs::msg::dds_::String_/h",
     "0/a//b/std_msgs::msg::dds_::String_/h", "0/a/std_msgs::msg::String/h", "0/a/dds_::_/h",
     "0/chatter/std_msgs::msg::dds_::String_/h/@adv/pub/1/2/_"],
)  # fmt: skip
def test_what_is_no_data_key_is_refused(key: str):
    with pytest.raises(RosNameError):
        parse_key(key)


def test_one_can_listen_whatever_the_type():
    assert whatever_type_key(3, "/a/b") == "3/a/b/*/*"


PART = st.from_regex(r"[A-Za-z_][A-Za-z0-9_]{0,8}", fullmatch=True)


@given(st.integers(0, 232), st.lists(PART, min_size=1, max_size=4), st.sampled_from([*TYPES]))
def test_any_key_survives(domain: int, parts: list[str], type_name: str):
    key = DataKey(domain, "/" + "/".join(parts), type_name, STRING_HASH)
    assert parse_key(str(key)) == key


@given(st.text(alphabet="0aA_/:@%. dds", max_size=60))
def test_any_text_is_a_key_or_refused_by_name(text: str):
    try:
        key = parse_key(text)
    except RosNameError:
        return
    assert parse_key(str(key)) == key
