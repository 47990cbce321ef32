from __future__ import annotations

import math
from typing import Any

import pytest

from studio.displays.display import Limits
from studio.displays.grid_cells import GridCellsDisplay
from tests.support.display_messages import STAMP_NS, TYPES, point, received
from tests.support.drawn import only, said, shapes_of

TYPE = "nav_msgs/msg/GridCells"
SIZE = {"cell_width": 0.5, "cell_height": 1.0}
TWO = [point(0.0, 0.0, 0.0), point(1.0, 2.0, 3.0)]


def display_of(fields: dict[str, Any], little: bool = True) -> GridCellsDisplay:
    display = GridCellsDisplay(TYPES)
    display.take(received(TYPE, {**SIZE, "cells": TWO, **fields}, little=little))
    return display


@pytest.mark.parametrize("little", [True, False])
def test_cells_are_tiles_about_their_middles(little: bool):
    display = display_of({}, little)
    placed = only(display)
    assert (placed.frame, placed.stamp_ns) == ("map", STAMP_NS)
    assert shapes_of(display.draw(0)) == {
        "cells": {
            "shape": "Triangles",
            "vertices": [
                [-0.25, -0.5, 0.0], [0.25, -0.5, 0.0], [0.25, 0.5, 0.0], [-0.25, 0.5, 0.0],
                [0.75, 1.5, 3.0], [1.25, 1.5, 3.0], [1.25, 2.5, 3.0], [0.75, 2.5, 3.0],
            ],
            "faces": [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]],
            "colors": [25, 255, 0],
            "opacity": 1.0,
        }
    }  # fmt: skip


@pytest.mark.parametrize(
    ("fields", "status"),
    [
        ({"cells": []}, ("warn", "empty")),
        ({"cell_width": 0.0}, ("error", "empty")),
        ({"cell_height": math.nan}, ("error", "not_finite")),
        ({"cell_height": math.inf}, ("error", "not_finite")),
        ({"cells": [point(math.nan, 0.0, 0.0)]}, ("error", "not_finite")),
    ],
)
def test_why_nothing_is_seen_is_told(fields: dict[str, Any], status: tuple[str, str]):
    display = display_of(fields)
    assert not display.draw(0)
    assert said(display) == [status]


def test_a_cell_that_cannot_be_drawn_is_left_out():
    display = display_of({"cells": [*TWO, point(1e308, 0.0, 0.0)]})
    assert len(shapes_of(display.draw(0))["cells"]["faces"]) == 4
    assert said(display) == [("warn", "not_finite")]


def test_a_limit_from_outside_is_held():
    display = GridCellsDisplay(TYPES)
    display.limit(Limits(points=1))
    display.take(received(TYPE, {**SIZE, "cells": TWO}))
    assert len(shapes_of(display.draw(0))["cells"]["faces"]) == 2
    assert said(display) == [("ok", "thinned")]
