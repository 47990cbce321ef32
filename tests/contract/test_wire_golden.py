"""The wire against golden files, which were written from the specification without the studio."""

from __future__ import annotations

import json
from functools import cache
from typing import Any

import pytest

from studio.ros.attachment import Attachment, unpack
from studio.ros.cdr import Codec
from studio.ros.duration import Duration
from studio.ros.profiles import PROFILES
from studio.ros.qos import QoSProfile
from studio.ros.tokens import (
    DataKey,
    EndpointKind,
    EndpointToken,
    NodeToken,
    gid_of,
    parse_key,
    parse_token,
)
from studio.ros.types.convert import from_dict, to_dict
from studio.ros.types.library import TypeLibrary
from tests.support.golden_wire import FOLDER, golden_text

Json = dict[str, Any]
DISTROS = sorted(path.stem for path in FOLDER.glob("*.json"))


@cache
def golden(distro: str) -> Json:
    return json.loads((FOLDER / f"{distro}.json").read_text(encoding="utf-8"))


@cache
def library(distro: str) -> TypeLibrary:
    return TypeLibrary(distro)


def cases(part: str) -> list[Any]:
    return [
        pytest.param(distro, case, id=f"{distro}-{number}")
        for distro in DISTROS
        for number, case in enumerate(golden(distro)[part])
    ]


def test_every_profile_has_its_golden_file():
    assert set(DISTROS) == PROFILES.keys()


@pytest.mark.parametrize("distro", DISTROS)
def test_the_golden_files_are_what_the_script_writes(distro: str):
    assert (FOLDER / f"{distro}.json").read_text(encoding="utf-8") == golden_text(distro)


def test_what_others_printed_is_in_the_golden_files():
    talker = "@ros2_lv/2/8b20917502ee955ac4476e0266340d5c/0/10/MP/%/%/talker/%chatter/"
    text = "std_msgs::msg::dds_::String_/RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503"
    assert any(case["token"].startswith(talker + text) for case in golden("jazzy")["tokens"])
    assert golden("jazzy")["keys"][1]["key"].startswith(f"0/robot1/chatter/{text}")
    added = golden("kilted")["hashes"]["example_interfaces/srv/AddTwoInts"]
    assert added == "RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a"


@pytest.mark.parametrize("distro", DISTROS)
def test_every_hash_is_the_golden_one(distro: str):
    hashes = golden(distro)["hashes"]
    assert {name: library(distro).hash_of(name) for name in hashes} == hashes


@pytest.mark.parametrize(("distro", "case"), cases("keys"))
def test_a_key_is_the_golden_one_and_reads_back(distro: str, case: Json):
    type_hash = PROFILES[distro].type_hash(library(distro).hash_of(case["type"]))
    key = DataKey(case["domain"], case["name"], case["type"], type_hash)
    assert str(key) == case["key"]
    assert parse_key(case["key"]) == key


@pytest.mark.parametrize(("distro", "case"), cases("tokens"))
def test_a_token_and_its_gid_are_the_golden_ones_and_read_back(distro: str, case: Json):
    token = token_of(distro, case)
    assert str(token) == case["token"]
    assert gid_of(case["token"]).hex() == case["gid"]
    assert str(parse_token(case["token"])) == case["token"]
    assert type(parse_token(case["token"])) is type(token)


@pytest.mark.parametrize(("distro", "case"), cases("attachments"))
def test_an_attachment_is_the_golden_one_and_reads_back(distro: str, case: Json):
    attachment = Attachment(case["sequence"], case["source_time_ns"], bytes.fromhex(case["gid"]))
    assert attachment.pack().hex() == case["bytes"]
    assert unpack(bytes.fromhex(case["bytes"])) == attachment
    assert distro in PROFILES


@pytest.mark.parametrize(("distro", "case"), cases("cdr"))
def test_the_bytes_of_a_message_are_the_golden_ones_and_read_back(distro: str, case: Json):
    kind = library(distro).message(case["type"])
    value, codec = from_dict(kind, case["value"]), Codec(kind)
    assert codec.encode(value).hex() == case["little"]
    assert codec.encode(value, little_endian=False).hex() == case["big"]
    for data in (case["little"], case["big"]):
        assert codec.decode(bytes.fromhex(data)) == value
        assert to_dict(codec.decode(bytes.fromhex(data))) == to_dict(value)


def token_of(distro: str, case: Json) -> NodeToken | EndpointToken:
    node = NodeToken(**case["node"])
    if case["kind"] == "NN":
        return node
    type_hash = PROFILES[distro].type_hash(library(distro).hash_of(case["type"]))
    return EndpointToken(
        node, case["eid"], EndpointKind(case["kind"]), case["topic"], case["type"], type_hash,
        qos_of(case["qos"]), tuple(case.get("extra", ())),
    )  # fmt: skip


def qos_of(case: Json) -> QoSProfile:
    spans = {"lifespan_ns": "lifespan", "deadline_ns": "deadline"}
    spans["lease_ns"] = "liveliness_lease_duration"
    given: Json = {
        spans.get(name, name): Duration(nanoseconds=value) if name in spans else value
        for name, value in case.items()
    }
    return QoSProfile(**given)
