from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.errors import TypeDescriptionError
from studio.ros.types.library import TypeLibrary
from studio.ros.types.type_descriptions import describe_type, learn, owner_of, type_sources

if TYPE_CHECKING:
    from studio.ros.types.classes import MessageValue

PEER = TypeLibrary("jazzy")
PEER.add_texts(
    {
        "my_pkg/msg/Inner": "# Of the peer.\nint32 FIRST=1\nfloat32[3] values # three\n",
        "my_pkg/msg/Outer": "std_msgs/Header header\nInner[] inner\nchar c\nstring<=5 s\n",
        "my_pkg/msg/Nothing": "",
        "my_pkg/srv/Ask": "Inner inner\n---\nbool good\n",
        "my_pkg/action/Go": "Inner inner\n---\n---\nfloat32 done\n",
    }
)


def asked(name: str) -> dict[str, tuple[str, MessageValue]]:
    return {name: (PEER.hash_of(name), describe_type(PEER, name))}


def test_a_message_and_what_it_is_made_of_is_learned():
    library = TypeLibrary("jazzy")
    assert learn(library, "my_pkg/msg/Outer", asked("my_pkg/msg/Outer")) == [
        "my_pkg/msg/Inner",
        "my_pkg/msg/Outer",
    ]
    assert library.hash_of("my_pkg/msg/Outer") == PEER.hash_of("my_pkg/msg/Outer")
    value = library.message("my_pkg/msg/Outer")(s="abc")
    assert (value.s, value.inner) == ("abc", [])
    assert learn(library, "my_pkg/msg/Outer", asked("my_pkg/msg/Outer")) == []


def test_an_empty_message_and_a_service_are_learned():
    library = TypeLibrary("jazzy")
    assert learn(library, "my_pkg/msg/Nothing", asked("my_pkg/msg/Nothing"))
    assert learn(library, "my_pkg/srv/Ask", asked("my_pkg/srv/Ask")) == [
        "my_pkg/msg/Inner",
        "my_pkg/srv/Ask",
    ]
    assert library.service("my_pkg/srv/Ask").type_hash == PEER.hash_of("my_pkg/srv/Ask")


def test_a_service_is_learned_from_the_topic_of_its_events():
    library = TypeLibrary("jazzy")
    name = "my_pkg/srv/Ask_Event"
    assert learn(library, name, asked(name)) == ["my_pkg/msg/Inner", "my_pkg/srv/Ask"]
    assert library.hash_of("my_pkg/srv/Ask") == PEER.hash_of("my_pkg/srv/Ask")


def test_an_action_is_learned_from_its_three_parts():
    library = TypeLibrary("jazzy")
    go = "my_pkg/action/Go"
    parts = [f"{go}_{part}" for part in ("SendGoal", "GetResult", "FeedbackMessage")]
    questions = {name: one for part in parts for name, one in asked(part).items()}
    assert learn(library, go, questions) == ["my_pkg/action/Go", "my_pkg/msg/Inner"]
    assert library.action(go).type_hash == PEER.hash_of(go)
    with pytest.raises(TypeDescriptionError):
        learn(TypeLibrary("jazzy"), go, asked(parts[0]))


def test_texts_of_the_node_are_kept_where_they_say_the_same():
    library = TypeLibrary("jazzy")
    name = "my_pkg/msg/Outer"
    learn(library, name, asked(name), type_sources(PEER, name))
    assert library.text_of("my_pkg/msg/Inner") == PEER.text_of("my_pkg/msg/Inner")
    assert library.message("my_pkg/msg/Inner").FIRST == 1


@pytest.mark.parametrize("text", ["int32 other\n", "((", "float32[4] values\n", "x" * 2_000_000])
def test_a_text_that_says_otherwise_is_passed_over(text: str):
    library = TypeLibrary("jazzy")
    given = type_sources(PEER, "my_pkg/msg/Inner")
    given[0].raw_file_contents = text
    learn(library, "my_pkg/msg/Inner", asked("my_pkg/msg/Inner"), given)
    assert library.text_of("my_pkg/msg/Inner") == "float32[3] values\n"


def test_a_peer_changes_no_type_that_is_known():
    library = TypeLibrary("jazzy")
    library.add_texts({"my_pkg/msg/Inner": "int8 mine\n"})
    with pytest.raises(TypeDescriptionError, match="known here in another form"):
        learn(library, "my_pkg/msg/Outer", asked("my_pkg/msg/Outer"))
    assert library.text_of("my_pkg/msg/Inner") == "int8 mine\n"
    assert "my_pkg/msg/Outer" not in library.names()


def test_a_wrong_hash_teaches_nothing():
    library = TypeLibrary("jazzy")
    name = "my_pkg/msg/Inner"
    with pytest.raises(TypeDescriptionError, match="its hash is"):
        learn(library, name, {name: ("RIHS01_" + "0" * 64, describe_type(PEER, name))})
    assert name not in library.names()


def test_sources_are_those_of_all_parts_with_what_they_are():
    told = {one.type_name: one.encoding for one in type_sources(PEER, "my_pkg/srv/Ask")}
    assert told["my_pkg/srv/Ask"] == "srv"
    assert told["my_pkg/msg/Inner"] == "msg"
    assert "float64 x" in type_sources(PEER, "geometry_msgs/msg/Point")[0].raw_file_contents


def test_parts_belong_to_the_text_that_defines_them():
    assert owner_of("my_pkg/srv/Ask_Request") == "my_pkg/srv/Ask"
    assert owner_of("my_pkg/action/Go_SendGoal_Response") == "my_pkg/action/Go"
    assert owner_of("my_pkg/msg/Inner") == "my_pkg/msg/Inner"
