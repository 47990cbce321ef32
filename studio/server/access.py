"""Permissions of routes and of viser's messages; those of commands are in their registry.

Nobody may do what is in no table.
"""

from __future__ import annotations

from typing import Final

from studio.protocol.commands import Permission, Scope
from studio.protocol.roles import Role

ROUTES: Final = {
    "/": Permission("page", Role.VIEWER),
    "/d/{document}": Permission("page", Role.VIEWER),
    "/d/{document}/viser/": Permission("scene_page", Role.VIEWER, Scope.DOCUMENT),
    "/d/{document}/viser": Permission("scene", Role.VIEWER, Scope.DOCUMENT),
    "/control": Permission("control", Role.VIEWER),
    "/data": Permission("data", Role.VIEWER, Scope.ROS),
    "/bulk": Permission("bulk", Role.VIEWER, Scope.ROS),
    "/api/health": Permission("health", Role.VIEWER),
    "/api/openapi.json": Permission("openapi", Role.VIEWER),
    "/api/documents": Permission("documents", Role.VIEWER),
    "/api/documents/{document}/urdf": Permission("get_urdf", Role.VIEWER, Scope.DOCUMENT),
    "/api/documents/{document}/export/urdf": Permission(
        "export_urdf", Role.PRESENTER, Scope.DOCUMENT
    ),
    "/api/documents/{document}/export/package": Permission(
        "export_package", Role.PRESENTER, Scope.DOCUMENT
    ),
    "/api/documents/{document}/export/page": Permission("export_page", Role.VIEWER, Scope.DOCUMENT),
    "/api/commands": Permission("command", Role.VIEWER),
    "/api/log-out": Permission("log_everybody_out", Role.PRESENTER),
    "/api/uploads": Permission("upload", Role.PRESENTER),
}
"""Of every route that needs a role. `command` is for any role; each command has its own."""

PUBLIC_ROUTES: Final = frozenset({"/a/{tree}/{path:path}", "/favicon.ico"})
"""Routes without secrets: the files of the page, the same for everyone."""

VISER: Final = {
    "ViewerCameraMessage": Permission("viser:ViewerCameraMessage", Role.VIEWER, Scope.DOCUMENT),
    **{
        name: Permission(f"viser:{name}", Role.PRESENTER, Scope.DOCUMENT)
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
