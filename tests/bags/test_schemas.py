"""Types as bags define them: what is sound is used, and what is hostile costs its own topics."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.bags.blocks import Definition
from studio.bags.schemas import PARTS_MAX, SCHEMA_BYTES_MAX, types_of
from tests.support.bags import BEGIN_NS, STRING, Told, string_cdr, write_mcap
from tests.support.patience import Stopwatch
from tests.support.read_bags import read_bag

if TYPE_CHECKING:
    from pathlib import Path

RULE = "=" * 80
NAME = "strange_msgs/msg/Strange"
HOSTILE = {
    "huge": ("int32 a\n" + "#" * SCHEMA_BYTES_MAX, "its schema has more than 1000000 bytes"),
    "larger than a record may be": ("int32 a\n" + "#" * 3_000_000, "its schema has more than"),
    "many parts": (
        "int32 a\n" + f"{RULE}\nMSG: p/A\nint32 a\n" * (PARTS_MAX + 1),
        f"its schema has more than {PARTS_MAX} parts",
    ),
    "deep": (
        "strange_msgs/T0 a\n"
        + "".join(f"{RULE}\nMSG: strange_msgs/T{n}\nT{n + 1} a\n" for n in range(400))
        + f"{RULE}\nMSG: strange_msgs/T400\nint32 a\n",
        "deeper than",
    ),
    "ten times more on each level": (
        "strange_msgs/T0 a\n"
        + "".join(
            f"{RULE}\nMSG: strange_msgs/T{n}\n" + "".join(f"T{n + 1} a{k}\n" for k in range(10))
            for n in range(20)
        )
        + f"{RULE}\nMSG: strange_msgs/T20\nint32 a\n",
        "values",
    ),
    "array of any size": ("float64[4000000000] a\n", "values"),
    "part of itself": ("Strange again\n", "part of itself"),
    "part of its part": (
        f"strange_msgs/Other a\n{RULE}\nMSG: strange_msgs/Other\nstrange_msgs/Strange b\n",
        "part of itself",
    ),
    "unknown part": ("nobody_msgs/Nobody a\n", "nobody_msgs/msg/Nobody"),
    "no text": ("\x00\x01\x02\ufffd\ufffd int32 = = [[", "strange_msgs/msg/Strange"),
    "XML": ("<message><field name='a'/></message>", "strange_msgs/msg/Strange"),
}


@pytest.mark.parametrize("kind", HOSTILE)
def test_a_hostile_schema_costs_its_own_topic_and_no_time(tmp_path: Path, kind: str):
    text, said = HOSTILE[kind]
    told = [Told("/strange", 0, "a", NAME), Told("/sound", 1, "b")]
    file = write_mcap(tmp_path / "bag.mcap", told, schemas={NAME: text})
    watch = Stopwatch()
    found = read_bag(file, tmp_path / "kept")
    assert watch.s < 5
    assert said in found.topics["/strange"].trouble
    assert found.topics["/sound"].trouble == ""
    assert found.messages[1] == ("/sound", BEGIN_NS + 1, string_cdr("b"))
    assert len(found.messages) == 2
    assert not found.troubles


@settings(max_examples=30)
@given(st.text(max_size=300), st.sampled_from(["ros2msg", "ros2idl", "jsonschema", ""]))
def test_whatever_a_schema_says_other_types_are_sound(text: str, encoding: str):
    definitions = [
        Definition(NAME, encoding, text),
        Definition("sound_msgs/msg/Sound", "ros2msg", "int32 a\n"),
    ]
    types = types_of(definitions, "jazzy")
    assert isinstance(types.trouble(NAME), str)
    assert types.trouble("sound_msgs/msg/Sound") == ""
    assert types.trouble("std_msgs/msg/String") == ""


def test_the_parts_of_a_schema_are_types_of_their_own():
    text = (
        "std_msgs/Header header\nstrange_msgs/Inner[] inner\n"
        f"{RULE}\nMSG: strange_msgs/Inner\nfloat64 x\n"
        f"{RULE}\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
        f"{RULE}\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
    )
    types = types_of([Definition(NAME, "ros2msg", text.replace("\n", "\r\n"))], "humble")
    assert types.trouble(NAME) == ""
    assert types.trouble("strange_msgs/msg/Inner") == ""
    inner = types.library.find("strange_msgs/msg/Inner")
    assert [one.name for one in inner.fields] == ["x"]


def test_of_two_definitions_of_a_type_the_first_counts():
    definitions = [
        Definition(NAME, "ros2msg", "int32 first\n"),
        Definition(NAME, "ros2msg", "int32 second\n"),
    ]
    found = types_of(definitions, "jazzy").library.find(NAME)
    assert [one.name for one in found.fields] == ["first"]


def test_a_type_that_no_file_defines_is_that_of_the_studio():
    types = types_of([Definition("std_msgs/msg/String", "", "")], "an unknown distro")
    assert types.trouble("std_msgs/msg/String") == ""
    assert "cannot be used" in types.trouble("nobody_msgs/msg/Nobody")
    assert types.trouble("no name at all") != ""
    assert types.library.text_of("std_msgs/msg/String") != STRING
