from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.displays.vectors import AccelDisplay, TwistDisplay
from tests.support.display_messages import TYPES, point, received
from tests.support.drawn import shapes_of

if TYPE_CHECKING:
    from studio.displays.vectors import VectorDisplay


@pytest.mark.parametrize(("kind", "field"), [(TwistDisplay, "twist"), (AccelDisplay, "accel")])
def test_small_values_can_be_shown_and_zero_is_not(kind: type[VectorDisplay], field: str):
    display = kind(TYPES, {"Hide Small Values": False})
    fields = {field: {"linear": point(0.01, 0.0, 0.0)}}
    display.take(received(kind.TOPICS[0].types[0], fields))
    assert set(shapes_of(display.draw(0))) == {"straight"}
    assert display.statuses() == ()
