"""The page, the scripts and the parser speak of the same models."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

from studio.documents.engine import COMMANDS
from studio.protocol.message import all_events
from studio.server.commands import COMMAND_ADAPTER, EVENT_ADAPTER
from studio.server.schema import openapi, target, wire_schemas, wire_types

if TYPE_CHECKING:
    from pydantic import BaseModel

KINDS: list[type[BaseModel]] = [
    *COMMANDS.messages,
    *sorted(all_events(), key=lambda kind: kind.__name__),
]


def test_the_types_of_the_page_are_fresh():
    assert target().read_text(encoding="utf-8") == wire_types(), (
        "run: python -m studio.server.schema"
    )


@pytest.fixture(scope="module")
def page_types() -> str:
    return wire_types()


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_is_told_apart_by_its_type_and_has_its_interface(
    kind: type[BaseModel], page_types: str
):
    name, discriminator = kind.__name__, kind.model_fields["type"].default
    found = re.search(rf"export interface {name} {{(.*?)\n}}", page_types, re.DOTALL)
    assert found
    assert f'  type: "{discriminator}";' in found[1]
    fields = set(re.findall(r"^  (\w+)\??:", found[1], re.MULTILINE))
    assert fields == kind.model_fields.keys()


def test_openapi_holds_the_same_schemas():
    held = openapi([])["components"]["schemas"]
    assert held == wire_schemas()
    assert held["Command"]["discriminator"]["propertyName"] == "type"
    assert len(held["Command"]["oneOf"]) == len(COMMANDS.messages)
    assert len(held["Event"]["oneOf"]) == len(all_events())


def test_no_two_kinds_share_a_type():
    for adapter in (COMMAND_ADAPTER, EVENT_ADAPTER):
        mapping = adapter.json_schema()["discriminator"]["mapping"]
        assert len(set(mapping.values())) == len(mapping)


def test_every_reference_of_the_schemas_leads_somewhere():
    schemas = wire_schemas()
    assert set(re.findall(r"#/components/schemas/([\w-]+)", str(schemas))) <= schemas.keys()
