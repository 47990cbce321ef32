"""Permissions of routes and of viser's messages; those of commands are in their registry.

Nobody may do what is in no table.
"""

from __future__ import annotations

from typing import Final

from studio.protocol.commands import Permission, Scope
from studio.protocol.roles import Role

ROUTES: Final = {
    "/": Permission("page", Role.GUEST),
    "/d/{document}": Permission("page", Role.GUEST),
    "/d/{document}/viser/": Permission("scene_page", Role.GUEST, Scope.DOCUMENT),
    "/d/{document}/viser": Permission("scene", Role.GUEST, Scope.DOCUMENT),
    "/control": Permission("control", Role.GUEST),
    "/data": Permission("data", Role.GUEST, Scope.ROS),
    "/bulk": Permission("bulk", Role.GUEST, Scope.ROS),
    "/api/health": Permission("health", Role.GUEST),
    "/api/openapi.json": Permission("openapi", Role.GUEST),
    "/api/documents": Permission("documents", Role.GUEST),
    "/api/documents/{document}/urdf": Permission("get_urdf", Role.GUEST, Scope.DOCUMENT),
    "/api/documents/{document}/export/urdf": Permission(
        "export_urdf", Role.PRESENTER, Scope.DOCUMENT
    ),
    "/api/documents/{document}/export/package": Permission(
        "export_package", Role.PRESENTER, Scope.DOCUMENT
    ),
    "/api/documents/{document}/export/page": Permission("export_page", Role.GUEST, Scope.DOCUMENT),
    "/api/documents/{document}/export/series": Permission(
        "export_series", Role.GUEST, Scope.DOCUMENT
    ),
    "/api/bags/{bag}/{file}": Permission("download_bag", Role.PRESENTER),
    "/api/copies": Permission("download_copies", Role.HELPER),
    "/api/commands": Permission("command", Role.GUEST),
    "/api/log-out": Permission("log_everybody_out", Role.PRESENTER),
    "/api/uploads": Permission("upload", Role.PRESENTER),
}
"""Of every route that needs a role. `command` is for any role; each command has its own."""

PUBLIC_ROUTES: Final = frozenset({"/a/{tree}/{path:path}", "/favicon.ico", "/join", "/health"})
"""The files of the page, the same for everyone, the form by which others join, and, of a relay,
that it runs."""

VISER: Final = {
    "ViewerCameraMessage": Permission("viser:ViewerCameraMessage", Role.GUEST, Scope.DOCUMENT),
    **{
        name: Permission(f"viser:{name}", Role.STUDENT, Scope.DOCUMENT, needs_control=True)
        for name in (
            "SceneNodeClickMessage",
            "SceneNodeDragMessage",
            "ScenePointerMessage",
            "TransformControlsDragStartMessage",
            "TransformControlsUpdateMessage",
            "TransformControlsDragEndMessage",
            "GetRenderResponseMessage",
        )
    },
}
"""Of every message of viser's page that is accepted."""
