"""Who may do what: one table and one function for every lane.

A deed is named by the lane it comes through: a control command by its `type`, a route by
`ROUTE_DEEDS`, a message on viser's websocket by `viser:<MessageType>`. What the table does not
name, nobody may do.
"""

from __future__ import annotations

from typing import Final

from studio.errors import NotAllowedError
from studio.protocol.roles import Role

ROUTE_DEEDS: Final = {
    "/": "page",
    "/d/{document}": "page",
    "/d/{document}/viser/": "scene_page",
    "/d/{document}/viser": "scene",
    "/control": "control",
    "/data": "data",
    "/bulk": "bulk",
    "/api/health": "health",
    "/api/openapi.json": "openapi",
    "/api/documents": "documents",
    "/api/documents/{document}/urdf": "get_urdf",
    "/api/documents/{document}/export/urdf": "export_urdf",
    "/api/documents/{document}/export/package": "export_package",
    "/api/documents/{document}/export/page": "export_page",
    "/api/commands": "command",
    "/api/log-out": "log_everybody_out",
    "/api/uploads": "upload",
}
"""Deed of every route that needs a role. `command` opens the door; each command is asked again."""

PUBLIC_ROUTES: Final = frozenset({"/a/{tree}/{path:path}", "/favicon.ico"})
"""Routes without secrets: the files of the page, the same for everyone."""

_LOOK: Final = frozenset(
    {
        "page",
        "scene_page",
        "scene",
        "control",
        "data",
        "bulk",
        "health",
        "openapi",
        "documents",
        "command",
        "watch",
        "get_urdf",
        "export_page",
        "get_urdf_changes",
        "find_texts",
        "get_text",
        "get_origin",
        "get_outline",
        "look_up",
        "get_references",
        "get_effects",
        "get_frames",
        "get_masses",
        "get_display_kinds",
        "get_topics",
        "list_topics",
        "get_topic_ends",
        "get_topic_rates",
        "get_tf",
        "follow_frame",
        "get_interface",
        "list_interfaces",
        "get_log",
        "get_graph",
        "get_node",
        "get_managed",
        "get_lessons",
        "get_demos",
        "get_demo_output",
        "get_demo_code",
        "get_diagnostics",
        "get_services",
        "get_actions",
        "read_values",
        "follow_deeds",
        "get_goal_statuses",
        "get_parameter_nodes",
        "get_parameters",
        "dump_parameters",
        "follow_parameters",
        "viser:ViewerCameraMessage",
    }
)
_CONTROL: Final = frozenset(
    {
        "open_path",
        "close_document",
        "list_folder",
        "edit_site",
        "reset_site",
        "apply_fix",
        "mend_all",
        "set_argument",
        "get_arguments",
        "set_arguments",
        "get_collisions",
        "resolve_collisions",
        "get_link",
        "open_link",
        "upload",
        "log_everybody_out",
        "list_recent",
        "open_recent",
        "forget_recent",
        "list_examples",
        "open_example",
        "list_places",
        "new_robot",
        "new_untitled",
        "save_as",
        "undo",
        "redo",
        "undo_to",
        "export_urdf",
        "export_package",
        "get_changes",
        "save",
        "save_copy",
        "discard_restored",
        "forget_work",
        "reload",
        "set_joints",
        "zero_joints",
        "randomize_joints",
        "animate_joints",
        "set_display",
        "add_display",
        "remove_display",
        "duplicate_display",
        "arrange_display",
        "switch_displays",
        "set_display_topic",
        "set_display_property",
        "set_fixed_frame",
        "apply_pose",
        "save_pose",
        "rename_pose",
        "delete_pose",
        "choose_package",
        "connect_wire",
        "examine_wire",
        "add_interfaces",
        "change_state",
        "disconnect_wire",
        "set_joint_source",
        "publish_robot",
        "publish_joints",
        "find_wire_robots",
        "open_from_wire",
        "call_service",
        "cancel_call",
        "send_goal",
        "cancel_goal",
        "publish",
        "stop_publishing",
        "drive",
        "start_demo",
        "stop_demo",
        "press_key",
        "set_parameter",
        "load_parameters",
        "edit_text",
        "get_renaming",
        "rename",
        "replace_texts",
        "complete",
        "save_variant",
        "apply_variant",
        "update_variant",
        "rename_variant",
        "delete_variant",
        "compare_variants",
        "viser:SceneNodeClickMessage",
        "viser:SceneNodeDragMessage",
        "viser:ScenePointerMessage",
        "viser:TransformControlsDragStartMessage",
        "viser:TransformControlsUpdateMessage",
        "viser:TransformControlsDragEndMessage",
        "viser:GetRenderResponseMessage",
    }
)
_ALLOWED: Final = {Role.VIEWER: _LOOK, Role.PRESENTER: _LOOK | _CONTROL}


def may(role: Role | None, deed: str) -> bool:
    """Whether this role may do this; nobody (None) may do nothing."""
    return role is not None and deed in _ALLOWED[role]


def demand(role: Role | None, deed: str) -> None:
    """Pass, or refuse.

    Raises:
        NotAllowedError: `may` says no.
    """
    if not may(role, deed):
        raise NotAllowedError(role or "stranger", deed)
