"""Units of attributes and of names; the table of widgets shows them at work."""

from __future__ import annotations

import pytest

from studio.description.sites import widgets as quantities
from studio.description.sites.widgets import (
    Quantity,
    Sweep,
    in_unit,
    quantity_of,
    quantity_of_attribute,
    quantity_of_name,
)


@pytest.mark.parametrize(
    ("path", "attribute", "quantity"),
    [
        ("link/inertial/mass", "value", quantities.MASS),
        ("joint/limit", "lower", quantities.ANGLE),
        ("joint:prismatic/limit", "lower", quantities.POSITION),
        ("joint:prismatic/limit", "velocity", quantities.LINEAR_SPEED),
        ("joint/origin", "rpy", quantities.ANGLE),
        ("link/visual/geometry/mesh", "filename", None),
        ("gazebo/plugin", "value", None),
    ],
)
def test_an_attribute_of_urdf_has_its_unit(path: str, attribute: str, quantity: Quantity | None):
    assert quantity_of_attribute(path, attribute) is quantity


@pytest.mark.parametrize(
    ("name", "quantity"),
    [
        ("wheel_radius", quantities.LENGTH),
        ("radius_scale", quantities.POSITIVE),
        ("limits.elbow.max_position", quantities.ANGLE),
        ("kinematics.mass.whatever", quantities.MASS),
        ("BASE_MASS", quantities.MASS),
        ("description", None),
        ("", None),
        ("pi", quantities.CONSTANT),
    ],
)
def test_the_last_telling_word_of_a_name_decides(name: str, quantity: Quantity | None):
    assert quantity_of_name(name) is quantity


def test_use_refines_what_a_name_leaves_open_and_nothing_else():
    assert quantity_of("offset", (("joint/origin", "rpy"),)) is quantities.ANGLE
    assert quantity_of("mass", (("joint/origin", "rpy"),)) is quantities.MASS
    assert quantity_of("what", (("gazebo", "x"),)) is quantities.UNKNOWN


def test_a_unit_from_a_comment_replaces_the_guessed_one():
    assert in_unit(quantities.LENGTH, "mm") == Quantity("mm", Sweep.POSITIVE)
    assert in_unit(quantities.ANGLE, "deg") == quantities.DEGREES
    assert in_unit(quantities.ANGULAR_SPEED, "deg") == Quantity("deg/s", Sweep.POSITIVE)
    assert in_unit(quantities.ANGLE, "m") == Quantity("m", Sweep.FREE)
    assert in_unit(quantities.MASS, "") is quantities.MASS
