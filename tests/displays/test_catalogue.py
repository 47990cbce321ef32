import re
import struct
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rosbags.typesys import Stores, get_typestore

from studio.displays.catalogue import DISPLAYS, display_of_kind, displays_of_type
from studio.displays.display import Display, Received
from studio.displays.robot_model import RobotModelDisplay
from studio.errors import DisplayError, StudioError
from studio.ros.cdr import codec_of
from studio.ros.types.classes import MessageValue, definition_of
from studio.ros.types.convert import from_dict
from tests.support.display_messages import NOW_NS, STAMP, TYPES, encoded
from tests.support.display_samples import SAMPLES, Sample, headed
from tests.support.drawn import assert_drawable, plain
from tests.support.posed import Posed, seen_arm
from tests.support.ros_values import values_of

REPOSITORY = Path(__file__).resolve().parents[2]
SENTENCE = re.compile(r"[A-Z0-9].*[.]", re.DOTALL)


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
    assert displays_of_type("std_msgs/msg/String", "/chatter") == ()
    [of_descriptions] = displays_of_type("std_msgs/msg/String", "/r1/robot_description")
    assert of_descriptions.KIND == "RobotModel"


@pytest.mark.parametrize("display", DISPLAYS, ids=lambda one: one.KIND)
def test_its_messages_are_known_and_its_properties_are_told_in_sentences(display: type[Display]):
    for topic in display.TOPICS:
        assert all(TYPES.message(name) for name in topic.types)
    assert SENTENCE.fullmatch(display.DOC)
    for one in display.PROPERTIES:
        assert SENTENCE.fullmatch(one.doc), one.name
        assert one.checked(one.default) == one.default
        assert one.kind in ("choice", "topic", "text") or not one.choices


@pytest.mark.parametrize("display", DISPLAYS, ids=lambda one: one.KIND)
def test_its_icon_is_one_of_the_pages(display: type[Display]):
    assets = REPOSITORY / "frontend_assets"
    icons = (assets / "vendor/icons.js").read_text(encoding="utf-8")
    of_panel = assets / "panels" / display.ICON / "panel.json"
    has_shapes = of_panel.is_file() and '"icon": [' in of_panel.read_text(encoding="utf-8")
    assert has_shapes or re.search(rf"[{{,]{display.ICON}:\[", icons)


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


@pytest.mark.parametrize("display", DISPLAYS, ids=lambda one: one.KIND)
def test_every_display_has_a_sample_of_all_its_types(display: type[Display]):
    of_kind = [one for one in SAMPLES if one.kind == display.KIND]
    assert of_kind
    if display.TOPICS:
        assert {one.type_name for one in of_kind} == set(display.TOPICS[0].types)


def drawn_from(sample: Sample, *, little: bool) -> object:
    """What is drawn of a sample, as plain values; of a robot its description, as it was read."""
    made = display_of_kind(sample.kind)(TYPES, sample.values)
    made.stand(Posed(seen_arm()))
    role_of = {role.topic(sample.topic): role.name for role in made.roles()}
    for topic, (type_name, fields) in sample.messages().items():
        cdr = encoded(type_name, headed(type_name, fields, sample.frame, STAMP), little=little)
        made.take(Received(type_name, cdr, NOW_NS), role_of[topic])
    if isinstance(made, RobotModelDisplay):
        return made.description
    return {
        path: {name: plain(shape) for name, shape in placed.shapes.items()}
        for path, placed in made.draw(NOW_NS).items()
    }


@pytest.mark.parametrize("sample", [one for one in SAMPLES if one.type_name], ids=lambda s: s.name)
def test_messages_of_both_byte_orders_are_drawn_the_same(sample: Sample):
    little = drawn_from(sample, little=True)
    assert little
    assert little == drawn_from(sample, little=False)


OTHERS = get_typestore(Stores.ROS2_JAZZY)


def assert_same(theirs: Any, ours: Any) -> None:  # noqa: ANN401 - of any field
    """Fields of rosbags' messages have the values that the sample says, also where it is silent."""
    if isinstance(ours, MessageValue):
        for field in definition_of(ours).fields:
            assert_same(getattr(theirs, field.name), getattr(ours, field.name))
    elif hasattr(theirs, "dtype") or not hasattr(ours, "append"):
        assert_same_value(theirs, ours)
    else:
        assert len(theirs) == len(ours)
        for one, other in zip(theirs, ours, strict=True):
            assert_same(one, other)


def assert_same_value(theirs: Any, ours: Any) -> None:  # noqa: ANN401 - of any field
    if isinstance(ours, str | bytes | bytearray):
        assert (theirs if isinstance(ours, str) else bytes(theirs)) == ours
    else:  # many are of 32 bits
        np.testing.assert_allclose(theirs, ours, rtol=1e-6)


@pytest.mark.parametrize("sample", [one for one in SAMPLES if one.type_name], ids=lambda s: s.name)
def test_the_bytes_of_samples_are_messages_for_rosbags_with_the_same_values(sample: Sample):
    """What is drawn from them is so drawn from what others write."""
    for type_name, fields in sample.messages().values():
        if type_name in OTHERS.types:
            headed_fields = headed(type_name, fields, sample.frame, STAMP)
            theirs = OTHERS.deserialize_cdr(encoded(type_name, headed_fields), type_name)
            assert_same(theirs, from_dict(TYPES.message(type_name), headed_fields))


ODD_NUMBERS = [float("nan"), float("inf"), float("-inf"), 1e308, -1e308, 5e-324, 0.0, -1.0]


@pytest.mark.parametrize("display", DISPLAYS, ids=lambda one: one.KIND)
@settings(max_examples=15, deadline=None)
@given(data=st.data())
def test_whatever_comes_is_drawn_with_finite_numbers_or_told(
    display: type[Display], data: st.DataObject
):
    """Messages of any values, with numbers anywhere that cannot be drawn, and any properties."""
    settings_of = {one.name: data.draw(st.sampled_from([*one.choices, one.default]))
                   for one in display.PROPERTIES if one.kind == "choice"}  # fmt: skip
    switches = {one.name: data.draw(st.booleans())
                for one in display.PROPERTIES if one.kind == "switch"}  # fmt: skip
    made = display(TYPES, settings_of | switches)
    for topic in display.TOPICS:
        name = data.draw(st.sampled_from(topic.types))
        codec = codec_of(TYPES.message(name))
        raw = bytearray(codec.encode(data.draw(values_of(TYPES.message(name)))))
        for _ in range(data.draw(st.integers(0, 3))):
            at = 4 + 8 * data.draw(st.integers(0, max(0, (len(raw) - 12) // 8)))
            raw[at : at + 8] = struct.pack("<d", data.draw(st.sampled_from(ODD_NUMBERS)))
        with suppress(StudioError):
            made.take(Received(name, bytes(raw), NOW_NS), topic.name)
        assert_drawable(made.draw(NOW_NS))
        assert all(SENTENCE.fullmatch(one.sentence) for one in made.statuses())
