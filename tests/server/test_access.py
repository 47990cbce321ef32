from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import pytest
from viser import _messages as viser_messages  # pyright: ignore[reportPrivateUsage]

from studio.documents.engine import COMMANDS as REGISTRY
from studio.errors import NotAllowedError, NotInControlError
from studio.protocol.commands import demand, may
from studio.protocol.roles import Role, Visitor
from studio.scene import VIEWER_MESSAGES
from studio.server.access import PUBLIC_ROUTES, ROUTES, VISER

if TYPE_CHECKING:
    from collections.abc import Iterator

COMMANDS = {entry.permission.name: entry.permission for entry in REGISTRY}
PRESENTER, VIEWER = Visitor(Role.PRESENTER), Visitor(Role.GUEST)
VIEWER_COMMANDS = {
    *("get_managed", "get_diagnostics"),
    *("get_lesson_text", "open_lesson", "close_lesson", "saw_panel"),
    *("get_lessons", "get_demos", "get_demo_output", "get_demo_code"),
    *("watch", "get_urdf", "get_text", "get_origin", "get_effects"),
    *("get_outline", "look_up", "get_references"),
    *("get_frames", "get_masses", "get_display_kinds", "get_topics", "get_tf"),
    *("follow_frame", "get_view_kinds", "get_tool_kinds", "get_scene_time"),
    *("pick_items", "describe_items"),
    *("examine_system", "get_doctor_report"),
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
    *("list_topics", "get_topic_ends", "get_time_marks", "get_time_ticks", "get_series"),
    *("set_name", "follow"),
    *("get_rviz_text", "get_rviz_view"),
}
"""What everybody may who sees the page."""
STUDENT_COMMANDS = {
    *("ask_control", "return_control", "raise_hand", "stop_robot", "open_copy"),
    *("get_node_access", "get_my_graph"),
}
HELPER_COMMANDS = {"get_lesson_table", "give_control", "take_control", "lower_hand", "send_back"}
PRESENTER_COMMANDS = {
    *("start_class", "pause_class", "end_class", "set_class", "renew_code"),
    *("start_nodes", "stop_nodes", "add_relay", "remove_relay"),
    *("set_member_role", "remove_member", "readmit_member"),
    *("save_lesson", "delete_lesson", "read_lesson"),
    *("lead", "gather_all", "show_view", "show_focus", "show_copy"),
    *("open_path", "close_document", "list_folder", "get_arguments", "open_link", "forget_work"),
    "open_bag",
    *("list_recent", "forget_recent", "list_examples", "list_places", "open_recent"),
    *("open_example", "new_robot", "new_untitled", "save_as", "save_copy", "choose_package"),
    *("discard_restored", "add_interfaces", "start_demo", "stop_demo"),
    *("connect_wire", "examine_wire", "disconnect_wire", "find_wire_robots", "open_from_wire"),
    *("save_rviz_file", "list_rviz_files", "forget_rviz_file"),
    *("plan_launch", "cancel_plan", "start_launch", "start_node", "stop_run", "start_run_again"),
    *("restart_process", "end_process", "run_again_on_save", "forget_run", "get_runs"),
    *("get_run_output", "get_workspaces", "create_package", "add_to_package"),
    *("undo_package_edit", "mend_package"),
    *("start_recording", "stop_recording", "save_past", "cut_bag", "stop_writing", "list_bags"),
}
"""What reaches beyond the robot that is shared: files, processes, connections, people."""
ROLES = (Role.GUEST, Role.STUDENT, Role.HELPER, Role.PRESENTER)
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


class Somebody(NamedTuple):
    """A person of a role, who has control or has not."""

    role: Role
    has_control: bool
    person: str = "somebody"

    def controls(self, document: str) -> bool:
        del document
        return self.has_control

    def sees(self, document: str) -> bool:
        del document
        return True


PEOPLE = [Somebody(role, has_control) for role in ROLES for has_control in (False, True)]


def may_who(command: str) -> set[Somebody]:
    """Who may send a command, by the lists above: what is in none needs control."""
    for commands, least in (
        (VIEWER_COMMANDS, Role.GUEST),
        (STUDENT_COMMANDS, Role.STUDENT),
        (HELPER_COMMANDS, Role.HELPER),
        (PRESENTER_COMMANDS, Role.PRESENTER),
    ):
        if command in commands:
            return {one for one in PEOPLE if one.role in ROLES[ROLES.index(least) :]}
    return {one for one in PEOPLE if one.has_control and one.role is not Role.GUEST}


@pytest.mark.parametrize("command", sorted(COMMANDS))
def test_every_command_is_for_whom_the_lists_say(command: str):
    assert {one for one in PEOPLE if may(one, COMMANDS[command])} == may_who(command)
    assert not may(None, COMMANDS[command])


def test_the_lists_name_only_commands_that_there_are():
    listed = VIEWER_COMMANDS | STUDENT_COMMANDS | HELPER_COMMANDS | PRESENTER_COMMANDS
    assert listed <= COMMANDS.keys()


@pytest.mark.parametrize("message", sorted(set(all_viser_messages())))
def test_of_visers_messages_all_send_the_camera_who_has_control_more_and_nobody_opens_a_tunnel(
    message: str,
):
    found = {one for one in PEOPLE if may(one, VISER.get(message))}
    in_control = {one for one in PEOPLE if one.has_control and one.role is not Role.GUEST}
    if message in VIEWER_MESSAGES:
        assert found == set(PEOPLE)
    else:
        assert found == (in_control if message in CLIENT_MESSAGES else set())


def test_the_table_names_no_message_that_viser_does_not_have():
    assert set(all_viser_messages()) >= CLIENT_MESSAGES


@pytest.mark.parametrize("name", ["", "unknown route", "Save", "save ", "viser:", "viser:save"])
def test_what_no_table_names_nobody_may(name: str):
    found = [table.get(name) for table in (ROUTES, VISER, COMMANDS)]
    assert not any(may(Visitor(role), one) for role in Role for one in found)
    with pytest.raises(NotAllowedError, match="A presenter may not do this: ask the presenter"):
        demand(PRESENTER, ROUTES.get(name))


def test_a_refusal_says_who_may_not_do_what():
    with pytest.raises(NotAllowedError, match="A guest may not edit site: ask the presenter"):
        demand(VIEWER, COMMANDS["edit_site"])
    with pytest.raises(NotInControlError, match="Only who has control may edit site: ask for it"):
        demand(Somebody(Role.STUDENT, has_control=False), COMMANDS["edit_site"])
    with pytest.raises(NotInControlError, match="may edit site: take it back first"):
        demand(Somebody(Role.PRESENTER, has_control=False), COMMANDS["edit_site"])
    demand(PRESENTER, COMMANDS["edit_site"])


def test_a_public_route_needs_no_permission():
    assert not PUBLIC_ROUTES & ROUTES.keys()
