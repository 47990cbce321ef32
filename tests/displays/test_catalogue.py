import re

import pytest

from studio.displays.catalogue import DISPLAYS, display_of_kind, displays_of_type, drawn_types
from studio.displays.display import Display
from studio.errors import DisplayError
from tests.support.display_messages import TYPES

SENTENCE = re.compile(r"[A-Z].*[.]")


def test_each_display_has_a_name_of_its_own():
    kinds = [one.KIND for one in DISPLAYS]
    assert len(set(kinds)) == len(kinds)


@pytest.mark.parametrize("kind", [one.KIND for one in DISPLAYS])
def test_a_display_is_found_by_rvizs_name_with_and_without_its_package(kind: str):
    assert kind == display_of_kind(kind).KIND
    assert kind == display_of_kind(f"rviz_default_plugins/{kind}").KIND


def test_a_name_of_no_display_is_refused_with_those_there_are():
    with pytest.raises(
        DisplayError, match=r'no display "Hologram" here: choose one of .*Path.*\.$'
    ):
        display_of_kind("Hologram")


def test_a_display_is_found_by_the_messages_that_it_draws():
    assert [one.KIND for one in displays_of_type("nav_msgs/msg/Path")] == ["Path"]
    assert displays_of_type("std_msgs/msg/String") == ()
    assert "geometry_msgs/msg/PoseStamped" in drawn_types()


@pytest.mark.parametrize("display", DISPLAYS, ids=lambda one: one.KIND)
def test_its_messages_are_known_and_its_properties_are_told_in_sentences(display: type[Display]):
    for topic in display.TOPICS:
        assert all(TYPES.message(name) for name in topic.types)
    assert SENTENCE.fullmatch(display.DOC)
    for one in display.PROPERTIES:
        assert SENTENCE.fullmatch(one.doc), one.name
        assert one.checked(one.default) == one.default
        assert one.kind == "choice" or not one.choices


@pytest.mark.parametrize("display", DISPLAYS, ids=lambda one: one.KIND)
def test_what_makes_a_property_count_is_another_that_can_take_those_values(display: type[Display]):
    known = {one.name: one for one in display.PROPERTIES}
    assert len(known) == len(display.PROPERTIES)
    for one in display.PROPERTIES:
        if one.when is not None:
            name, values = one.when
            assert all(known[name].checked(value) == value for value in values)


@pytest.mark.parametrize("display", DISPLAYS, ids=lambda one: one.KIND)
def test_a_display_draws_nothing_before_its_first_message(display: type[Display]):
    if display.TOPICS:
        assert not display(TYPES).draw(0)
