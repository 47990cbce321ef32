"""The demo of interactive markers, run as a process of its own."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from studio.ros.interactive_markers import InteractiveMarkerClient
from studio.ros.interactive_markers.names import FeedbackEvent, Mode
from tests.support.demos import node_at, running_demo
from tests.support.interactive_markers import feedback_of
from tests.support.studio_page import wait_until

if TYPE_CHECKING:
    from collections.abc import Callable

pytestmark = pytest.mark.network


def test_it_shows_every_mode_hears_clicks_and_has_the_last_word(endpoint: str):
    markers: dict[str, Any] = {}
    with running_demo(endpoint, "basic_controls") as demo, node_at(endpoint) as node:
        client = InteractiveMarkerClient(node)
        client.set_initialize_callback(
            lambda answer: markers.update({one.name: one for one in answer.markers})
        )
        client.set_update_callback(
            lambda update: markers.update({one.name: one for one in update.poses})
        )
        client.connect("/basic_controls")

        def until(what: str, holds: Callable[[], bool]) -> None:
            def worked() -> bool:
                client.update()
                return holds()

            wait_until(what, worked)

        until("all markers", lambda: len(markers) == 12)
        modes = {control.interaction_mode for one in markers.values() for control in one.controls}
        assert modes == {int(mode) for mode in Mode}
        assert markers["moving"].header.frame_id == "moving_frame"
        entries = markers["simple_6dof"].menu_entries
        assert [(one.title, one.parent_id) for one in entries][-2:] == [
            ("Entry in the submenu", 3),
            ("[x] With a box", 0),
        ]
        types = node.wire.types
        client.publish_feedback(feedback_of(types, "button", FeedbackEvent.BUTTON_CLICK))
        demo.wait_for("button clicked")
        moved = feedback_of(types, "chess_piece", FeedbackEvent.POSE_UPDATE, (0.05, 0.55, 0.0))
        client.publish_feedback(moved)
        until("the snap", lambda: abs(markers["chess_piece"].pose.position.x - 0.2) < 1e-6)
        assert markers["chess_piece"].pose.position.y == pytest.approx(0.6)
