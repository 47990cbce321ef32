from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from viser import _messages as viser_messages  # pyright: ignore[reportPrivateUsage]

from studio.documents.engine import COMMANDS as REGISTRY
from studio.errors import NotAllowedError
from studio.protocol.commands import demand, may
from studio.protocol.roles import Role, Visitor
from studio.scene import VIEWER_MESSAGES
from studio.server.access import PUBLIC_ROUTES, ROUTES, VISER

if TYPE_CHECKING:
    from collections.abc import Iterator

COMMANDS = {entry.permission.name: entry.permission for entry in REGISTRY}
PRESENTER, VIEWER = Visitor(Role.PRESENTER), Visitor(Role.VIEWER)
VIEWER_COMMANDS = {
    *("get_managed", "get_diagnostics"),
    *("get_lessons", "get_demos", "get_demo_output", "get_demo_code"),
    *("watch", "get_urdf", "get_text", "get_origin", "get_effects"),
    *("get_outline", "look_up", "get_references"),
    *("get_frames", "get_masses", "get_display_kinds", "get_topics", "get_tf"),
    "follow_frame",
    "get_topic_rates",
    *("get_services", "get_actions", "read_values", "follow_operations", "get_goal_statuses"),
    "follow_changes",
    *("get_parameter_nodes", "get_parameters", "dump_parameters", "follow_parameters"),
    *(
        "find_texts",
        "get_urdf_changes",
        "get_interface",
        "list_interfaces",
        "get_log",
        "get_graph",
        "get_node",
    ),
    *("list_topics", "get_topic_ends"),
}
CLIENT_MESSAGES = {
    "ViewerCameraMessage",
    "SceneNodeClickMessage",
    "SceneNodeDragMessage",
    "ScenePointerMessage",
    "TransformControlsDragStartMessage",
    "TransformControlsUpdateMessage",
    "TransformControlsDragEndMessage",
    "GetRenderResponseMessage",
}


def all_viser_messages() -> Iterator[str]:
    waiting: list[type] = [viser_messages.Message]
    while waiting:
        kind = waiting.pop()
        waiting.extend(kind.__subclasses__())
        yield kind.__name__


@pytest.mark.parametrize("command", sorted(COMMANDS))
def test_the_presenter_may_every_command_and_a_viewer_only_look(command: str):
    assert may(PRESENTER, COMMANDS[command])
    assert may(VIEWER, COMMANDS[command]) == (command in VIEWER_COMMANDS)
    assert not may(None, COMMANDS[command])


@pytest.mark.parametrize("message", sorted(set(all_viser_messages())))
def test_of_visers_messages_a_viewer_sends_the_camera_and_nobody_opens_a_tunnel(message: str):
    assert may(PRESENTER, VISER.get(message)) == (message in CLIENT_MESSAGES)
    assert may(VIEWER, VISER.get(message)) == (message in VIEWER_MESSAGES)


def test_the_table_names_no_message_that_viser_does_not_have():
    assert set(all_viser_messages()) >= CLIENT_MESSAGES


@pytest.mark.parametrize("name", ["", "unknown route", "Save", "save ", "viser:", "viser:save"])
def test_what_no_table_names_nobody_may(name: str):
    found = [table.get(name) for table in (ROUTES, VISER, COMMANDS)]
    assert not any(may(Visitor(role), one) for role in Role for one in found)
    with pytest.raises(NotAllowedError, match="A presenter may not do this: ask the presenter"):
        demand(PRESENTER, ROUTES.get(name))


def test_a_refusal_says_who_may_not_do_what():
    with pytest.raises(NotAllowedError, match="A viewer may not edit site: ask the presenter"):
        demand(VIEWER, COMMANDS["edit_site"])
    demand(PRESENTER, COMMANDS["edit_site"])


def test_a_public_route_needs_no_permission():
    assert not PUBLIC_ROUTES & ROUTES.keys()
