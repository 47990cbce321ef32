"""Who may do what: `may` is the one question that every lane asks.

What is asked for has a name: a command its `type`, a route the name in `ROUTES`, a message on
viser's websocket `viser:<MessageType>`. The commands' permissions are those of their registry. What
has no permission, nobody may do.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.documents.engine import COMMANDS
from studio.errors import NotAllowedError
from studio.protocol.commands import Permission, Scope
from studio.protocol.roles import Role

if TYPE_CHECKING:
    from studio.protocol.roles import Person

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
"""Of every route that needs a role. `command` opens the door; each command is asked again."""

PUBLIC_ROUTES: Final = frozenset({"/a/{tree}/{path:path}", "/favicon.ico"})
"""Routes without secrets: the files of the page, the same for everyone."""

_VISER: Final = (
    Permission("viser:ViewerCameraMessage", Role.VIEWER, Scope.DOCUMENT),
    *(
        Permission(f"viser:{name}", Role.PRESENTER, Scope.DOCUMENT)
        for name in (
            "SceneNodeClickMessage",
            "SceneNodeDragMessage",
            "ScenePointerMessage",
            "TransformControlsDragStartMessage",
            "TransformControlsUpdateMessage",
            "TransformControlsDragEndMessage",
            "GetRenderResponseMessage",
        )
    ),
)
_PERMISSIONS: Final = {
    one.name: one for one in (*ROUTES.values(), *_VISER, *(each.permission for each in COMMANDS))
}


def may(person: Person | None, name: str, document: str = "") -> bool:
    """Whether somebody may do this; nobody (None) may do nothing.

    Args:
        person: Who asks.
        name: What for.
        document: Id of the document that it concerns, if it does.
    """
    del document  # every presenter owns every document
    permission = _PERMISSIONS.get(name)
    return person is not None and permission is not None and permission.allows(person.role)


def demand(person: Person | None, name: str, document: str = "") -> None:
    """Pass, or refuse.

    Raises:
        NotAllowedError: `may` says no.
    """
    if not may(person, name, document):
        raise NotAllowedError(person.role if person else "stranger", name)
