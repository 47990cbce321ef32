from __future__ import annotations

import json
from itertools import product
from typing import TYPE_CHECKING

import pytest
from fastapi import FastAPI
from websockets.exceptions import InvalidStatus

from studio.documents.engine import COMMANDS
from studio.protocol.commands import may
from studio.protocol.roles import Role, Visitor
from studio.scene import SUBPROTOCOL
from studio.server.access import PUBLIC_ROUTES, ROUTES
from studio.server.api import Api, Exports, HandedIn, LogOut, WrittenBags
from studio.server.assets import Assets
from studio.server.cookies import Cookies
from studio.server.credentials import Credentials
from studio.server.front import Front
from studio.server.joining import Joining
from studio.server.origin import KnownHosts
from studio.server.site import Site
from studio.server.uploads import Uploads
from tests.support.small_engine import BAG, URDF, SmallEngine

if TYPE_CHECKING:
    from pathlib import Path

    from studio.protocol import Command
    from studio.protocol.commands import Permission
    from tests.support.web_server import RunningWeb

SOCKETS = {"/data", "/control", "/d/{document}/viser"}
POSTS = {"/api/commands", "/api/uploads", "/api/log-out"}
STREAMS = {"/bulk"}
"""They belong to a websocket, and are walked where they are tested."""


def test_every_route_is_in_the_table_and_the_table_names_no_other(assets_folder: Path):
    app = FastAPI(openapi_url=None, docs_url=None, redoc_url=None)
    engine = SmallEngine()
    front, classroom = Front(KnownHosts.of("127.0.0.1"), 1), engine.classroom
    credentials = Credentials("token", b"")
    # As a relay, which has a route more.
    Site(engine, Assets(assets_folder), "session", "", tuple).add_to(app)
    app.include_router(Api(engine, "session").router())
    app.include_router(Exports(engine).router())
    app.include_router(HandedIn(engine).router())
    app.include_router(WrittenBags(engine).router())
    app.include_router(Uploads(engine).router())
    app.include_router(LogOut(credentials, classroom).router())
    app.include_router(
        Joining(classroom, Cookies(credentials, classroom, front), front, lambda _: {}).router()
    )
    found = {path for route in app.routes for path in _paths(route)}
    assert found | {"/api/openapi.json"} == ROUTES.keys() | PUBLIC_ROUTES


def _paths(route: object) -> set[str]:
    """The paths of a route, or of the router that was included in its place."""
    router = getattr(route, "original_router", None)
    return {getattr(one, "path", "") for one in (router.routes if router else [route])}


@pytest.mark.parametrize("path", sorted(ROUTES.keys() - SOCKETS - POSTS - STREAMS))
def test_every_route_answers_each_role_as_the_table_says(web: RunningWeb, path: str):
    for role in Role:
        with web.client(role) as client:
            answer = client.get(path.format(document="small", bag="bag", file="bag_0.mcap"))
            assert (answer.status_code < 400) == may(Visitor(role), ROUTES[path])
    with web.client() as client:
        assert (
            client.get(path.format(document="small", bag="bag", file="bag_0.mcap")).status_code
            == 403
        )


def test_a_file_of_a_bag_is_given_out_whole_or_in_part_and_no_other_file_is(web: RunningWeb):
    with web.client(Role.PRESENTER) as client:
        whole = client.get("/api/bags/bag/bag_0.mcap")
        assert (whole.status_code, whole.content) == (200, BAG)
        assert whole.headers["content-disposition"] == 'attachment; filename="bag_0.mcap"'
        part = client.get("/api/bags/bag/bag_0.mcap", headers={"range": "bytes=10-19"})
        assert (part.status_code, part.content) == (206, BAG[10:20])
        web.engine.written.add(web.engine.bags_folder / "bag")
        assert "being written" in client.get("/api/bags/bag/bag_0.mcap").text
        web.engine.written.clear()
        (web.engine.bags_folder / "secret").write_text("")
        (web.engine.bags_folder / "bag" / "link").unlink(missing_ok=True)
        (web.engine.bags_folder / "bag" / "link").symlink_to("/etc/hostname")
        for path in (
            "bag/none",
            "../bag_0.mcap",
            "bag/..%2f..%2fsecret",
            "..%2fbags/bag",
            "bag/link",
            "bag/%00",
            f"bag/{'x' * 300}",
        ):
            assert client.get(f"/api/bags/{path}").status_code in {404, 409}


@pytest.mark.parametrize("path", sorted(SOCKETS))
def test_every_websocket_opens_for_each_role_as_the_table_says(web: RunningWeb, path: str):
    for role in Role:
        assert may(Visitor(role), ROUTES[path])
        address = path.format(document="small", bag="bag", file="bag_0.mcap")
        with web.websocket(address, role, subprotocols=(SUBPROTOCOL,)) as lane:
            assert lane.response is not None


FIELDS: dict[str, object] = {
    **dict.fromkeys(("path", "part", "site", "text", "name", "value", "folder"), "x"),
    **dict.fromkeys(("file", "link", "new_name", "code", "sentence", "label", "key"), "x"),
    "values": {"x": "1"},
    "keep": "mine",
    "position": 0,
    "of": 0,
    "version": 0,
    "offset": 0,
    "count": 1,
    **dict.fromkeys(("seconds", "begin_s", "end_s", "at_s", "rate"), 1.0),
    "playing": True,
    **dict.fromkeys(("bins", "columns"), 1),
    "replacement": "x",
    "changes": [{"start": 0, "end": 0, "text": "x"}],
    "positions": {},
    "eye": [0, 0, 0],
    "target": [0, 0, 0],
    "running": True,
    "display": "grid",
    "template": "rover",
    "source": "sliders",
    **dict.fromkeys(("kind", "topic", "frame"), "x"),
    "enabled": True,
    "texts": {"x": "x"},
    "topics": ["/x"],
    "service_type": "x/srv/X",
    "operation": 1,
    "node": "/x",
    "transition": 1,
    **dict.fromkeys(("action_type", "message_type", "type_name"), "x/msg/X"),
    "used_by": "topic",
    "operations": "calls",
    "demo": "talker",
    **dict.fromkeys(("lesson", "panel"), "x"),
    "subject": "graph",
    "pressed": "up",
    **dict.fromkeys(("person", "line", "endpoint"), "x"),
    "remark": "x",
    **dict.fromkeys(("leading", "following"), True),
    "role": "student",
    **dict.fromkeys(("tool", "view", "group"), "x"),
    **dict.fromkeys(("x", "y"), 0.0),
    "marker": 0,
    "action": "press",
    "paused": False,
    "displays": ("d1",),
    **dict.fromkeys(("nodes", "items", "bookmarks"), ()),
    **dict.fromkeys(("package", "executable"), "x"),
    **dict.fromkeys(("run", "process", "edit"), 1),
    "on": True,
    "what": "node",
}
"""A value for each field that a command needs."""


@pytest.mark.parametrize("kind", COMMANDS.messages)
def test_every_command_by_rest_is_asked_of_the_same_table(web: RunningWeb, kind: type[Command]):
    needed = (field for field, of in kind.model_fields.items() if of.is_required())
    command = {field: FIELDS[field] for field in needed}
    name: str = kind.model_fields["type"].default
    command |= {"type": name, "document": "small"}
    web.engine.go_on.set()
    for holder, role in product((Role.PRESENTER, Role.HELPER, Role.STUDENT), Role):
        with web.in_control(holder), web.client(role) as client:
            answer = client.post("/api/commands", content=json.dumps(command))
        kind_of_refusal = answer.json().get("kind")
        assert answer.status_code != 422, answer.text
        expected = refusal_of(role, COMMANDS[kind].permission, has_control=role is holder)
        assert (kind_of_refusal if answer.status_code == 403 else None) == expected


def refusal_of(role: Role, permission: Permission, *, has_control: bool) -> str | None:
    """The error by which a command is refused; None: it is carried out."""
    order = [Role.GUEST, Role.STUDENT, Role.HELPER, Role.PRESENTER]
    if order.index(role) < order.index(permission.role):
        return "NotAllowedError"
    return "NotInControlError" if permission.needs_control and not has_control else None


def test_the_root_leads_to_the_default_document(web: RunningWeb):
    with web.client(Role.GUEST) as client:
        answer = client.get("/")
        assert (answer.status_code, answer.headers["location"]) == (303, "/d/small")


def test_the_root_is_the_page_while_nothing_is_open(web: RunningWeb):
    web.engine.default_document = None
    try:
        with web.client(Role.GUEST) as client:
            answer = client.get("/")
            assert answer.status_code == 200
            assert 'src="/a/' in answer.text
    finally:
        web.engine.default_document = "small"


@pytest.mark.parametrize("path", ["/d/gone", "/d/%3Cscript%3E", "/d/gone/viser/", "/no/such"])
def test_an_unknown_address_says_so_and_links_home(web: RunningWeb, path: str):
    with web.client(Role.GUEST, {"accept": "text/html"}) as client:
        answer = client.get(path)
        assert answer.status_code == 404
        assert '<a href="/">' in answer.text
        assert "<script" not in answer.text
    with web.client(Role.GUEST) as client:
        assert client.get(path).json()["reason"]


def test_a_websocket_behind_which_nothing_is_does_not_open(web: RunningWeb):
    with pytest.raises(InvalidStatus) as refused, web.websocket("/d/gone/viser"):
        pass
    assert refused.value.response.status_code == 404


def test_the_urdf_comes_as_a_file(web: RunningWeb):
    with web.client(Role.GUEST) as client:
        answer = client.get("/api/documents/small/urdf")
        assert answer.text == URDF
        assert answer.headers["content-type"] == "application/xml"
        assert answer.headers["content-disposition"] == 'attachment; filename="robot.urdf"'
        gone = client.get("/api/documents/gone/urdf")
        assert (gone.status_code, gone.json()["kind"]) == (404, "UnknownDocumentError")


def test_a_command_by_rest_brings_its_events(web: RunningWeb):
    with web.client(Role.PRESENTER) as client:
        command = '{"type": "get_urdf", "document": "small", "request": 5}'
        assert client.post("/api/commands", content=command).json() == {
            "events": [
                {"type": "urdf", "request": 5, "text": URDF},
                {"type": "done", "request": 5},
            ]
        }
        refused = client.post("/api/commands", content='{"type": "save", "document": "small"}')
        assert (refused.status_code, refused.json()["kind"]) == (409, "SaveConflictError")


@pytest.mark.parametrize("body", ["", "{}", '{"type":"no"}', "[" * 10_000, "x" * (2 << 20)])
def test_a_malformed_command_by_rest_is_a_sentence(web: RunningWeb, body: str):
    with web.client(Role.PRESENTER) as client:
        answer = client.post("/api/commands", content=body)
        assert (answer.status_code, answer.json()["kind"]) == (422, "CommandError")


def test_the_documents_are_listed(web: RunningWeb):
    with web.client(Role.GUEST) as client:
        assert client.get("/api/documents").json()["documents"][0]["id"] == "small"
    assert not web.engine.listeners


def test_no_page_of_the_framework_is_there(web: RunningWeb):
    with web.client(Role.PRESENTER) as client:
        for path in ("/docs", "/redoc", "/openapi.json", "/docs/oauth2-redirect"):
            assert client.get(path).status_code == 404
