import pytest

from studio.displays.display import reading_fields
from studio.errors import DisplayMessageError


def test_a_field_that_is_not_there_is_told_with_what_to_do():
    sentence = (
        r"The a_msgs/msg/A cannot be drawn: .*no attribute 'real_thing'.*: take back the text"
    )
    with pytest.raises(DisplayMessageError, match=sentence), reading_fields("a_msgs/msg/A"):
        _ = object().real_thing  # type: ignore[attr-defined]


def test_what_is_refused_within_stays_as_it_is():
    refused = DisplayMessageError("A", "it is odd")
    with pytest.raises(DisplayMessageError) as caught, reading_fields("a_msgs/msg/A"):
        raise refused
    assert caught.value is refused
