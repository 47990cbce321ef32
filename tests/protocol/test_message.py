"""What the door lets in: bounds of what a browser may say."""

from __future__ import annotations

import json
from typing import Any

import pytest
from pydantic import ValidationError

from studio.protocol.message import type_of
from studio.server.commands import COMMAND_ADAPTER

LOOK_UP = {"type": "look_up", "file": "/r.xacro"}
EDIT = {"type": "edit_text", "file": "/r.xacro"}
GOOD_NAMES = ["arm", "ur type", "größe", "a" * 200]
BAD_NAMES = ["", "a\0b", "a" * 201]


def naming(name: str) -> list[dict[str, Any]]:
    """Every command that gives an argument a value."""
    return [
        {"type": "open_path", "path": "/r.xacro", "arguments": {name: "1"}},
        {"type": "set_argument", "name": name, "value": "1"},
        {"type": "set_arguments", "values": {name: None}},
    ]


@pytest.mark.parametrize("command", [one for name in GOOD_NAMES for one in naming(name)])
def test_any_name_of_an_argument_is_taken(command: dict[str, Any]):
    assert type_of(type(COMMAND_ADAPTER.validate_json(json.dumps(command)))) == command["type"]


@pytest.mark.parametrize("command", [one for name in BAD_NAMES for one in naming(name)])
def test_what_no_argument_is_called_is_refused(command: dict[str, Any]):
    with pytest.raises(ValidationError):
        COMMAND_ADAPTER.validate_json(json.dumps(command))


@pytest.mark.parametrize(
    "command",
    [
        {**LOOK_UP, "offset": 10**30},
        {**LOOK_UP, "offset": -1},
        {**EDIT, "version": 10**30, "changes": [{"start": 0, "end": 0, "text": ""}]},
        {**EDIT, "version": 1, "changes": [{"start": 0, "end": 10**30, "text": ""}]},
        {**EDIT, "version": 1, "changes": [{"start": 10**30, "end": 10**30, "text": ""}]},
    ],
)
def test_a_place_that_no_text_has_is_refused(command: dict[str, Any]):
    with pytest.raises(ValidationError, match=r"(less|greater) than or equal"):
        COMMAND_ADAPTER.validate_json(json.dumps(command))
