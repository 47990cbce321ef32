import pytest

from studio.displays.display import Received, StillDisplay, TopicRole
from studio.displays.drawing import Placed, Text
from studio.displays.properties import Property
from studio.errors import CdrError, DisplayPropertyError, UnknownTypeError
from studio.ros.cdr import codec_of
from studio.ros.types.library import TypeLibrary

TYPES = TypeLibrary("jazzy")


class Words(StillDisplay):
    KIND = "Words"
    DOC = "Shows a word."
    PROPERTIES = (Property("Word", "text", "hello", "What it says."),)

    def _drawn(self) -> dict[str, Placed]:
        return {"": Placed("map", 0, {"word": Text(str(self.values["Word"]))})}


def test_a_drawing_is_the_same_object_until_a_property_changes():
    words = Words(TYPES)
    first = words.draw(0)
    assert words.draw(1) is first
    words.set("Word", "bye")
    assert words.draw(2)[""].shapes["word"] == Text("bye")


def test_values_given_at_first_are_checked_and_others_are_as_rviz_has_them():
    assert Words(TYPES).values == {"Word": "hello"}
    assert Words(TYPES, {"Word": "there"}).values == {"Word": "there"}
    with pytest.raises(DisplayPropertyError):
        Words(TYPES, {"Colour": "#ff0000"})


def test_a_message_is_read_by_the_type_that_it_names():
    words = Words(TYPES)
    kind = TYPES.message("std_msgs/msg/String")
    cdr = bytes(codec_of(kind).encode(kind(data="hi")))
    assert words.decode(Received("std_msgs/msg/String", cdr, 0)).data == "hi"
    with pytest.raises(CdrError):
        words.decode(Received("std_msgs/msg/String", b"\x00\x01\x00\x00\xff", 0))
    with pytest.raises(UnknownTypeError):
        words.decode(Received("no_msgs/msg/Such", cdr, 0))


@pytest.mark.parametrize(
    ("beside", "main", "topic"),
    [
        ("", "/map", "/map"),
        ("_updates", "/map", "/map_updates"),
        ("/camera_info", "/camera/image_raw", "/camera/camera_info"),
        ("/camera_info", "/image", "/camera_info"),
        ("/camera_info", "/a/image_raw/compressed", "/a/camera_info"),
        ("/camera_info", "/a/image_raw/compressedDepth", "/a/camera_info"),
        ("/robot_description", "/joint_states", "/robot_description"),
    ],
)
def test_a_topic_beside_the_main_one_follows_its_name_or_lies_beside_it(
    beside: str, main: str, topic: str
):
    assert TopicRole("other", (), beside=beside).topic(main) == topic
