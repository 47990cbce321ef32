"""The wire against what nodes of a real ROS 2 Jazzy declared and sent, as it was recorded."""

from __future__ import annotations

import json
import os
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from studio.ros.attachment import unpack
from studio.ros.cdr import Codec
from studio.ros.tokens import EndpointKind, EndpointToken, gid_of, parse_key, parse_token
from studio.ros.types.library import TypeLibrary

Line = dict[str, Any]
LIBRARY = TypeLibrary("jazzy")
ADD = "example_interfaces/srv/AddTwoInts"


@pytest.fixture(scope="module")
def golden() -> Path:
    named = os.environ.get("STUDIO_ROS2_PEER")
    if not named:
        pytest.skip("STUDIO_ROS2_PEER names no folder of a real ROS 2")
    return Path(named) / "golden"


@cache
def sessions(golden: Path) -> dict[str, list[Line]]:
    """What each recorded session of rmw_zenoh_cpp said, by the name of its file."""
    return {path.name: lines_of(path) for path in sorted(golden.glob("rmw_*/*.jsonl"))}


def lines_of(path: Path) -> list[Line]:
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def said(golden: Path, what: str) -> list[Line]:
    return [line for lines in sessions(golden).values() for line in lines if is_a(line, what)]


def is_a(line: Line, what: str) -> bool:
    return line.get("what") == what


def test_every_hash_is_the_one_that_a_real_ros_computes(golden: Path):
    hashes = json.loads((golden / "type_hashes_jazzy.json").read_text(encoding="utf-8"))
    assert len(hashes) > 300
    assert {name: LIBRARY.hash_of(name) for name in hashes} == hashes


def test_every_token_reads_and_is_written_again_byte_by_byte(golden: Path):
    tokens = {line["key"] for line in said(golden, "token")}
    assert len(tokens) > 500
    assert {str(parse_token(token)) for token in tokens} == tokens


def test_tokens_of_another_implementation_read_too(golden: Path):
    """Hiroz writes out values that are the defaults, which rmw_zenoh_cpp leaves empty."""
    [path] = golden.glob("hiroz_*.jsonl")
    tokens = [line["key"] for line in lines_of(path) if is_a(line, "token")]
    assert len([parse_token(token) for token in tokens]) > 30


def test_every_hash_in_a_token_is_ours(golden: Path):
    ends = [parse_token(line["key"]) for line in said(golden, "token")]
    told = {(end.type_name, end.type_hash) for end in ends if isinstance(end, EndpointToken)}
    assert len(told) > 15
    assert told == {(name, LIBRARY.hash_of(name)) for name, _ in told}


def test_every_key_reads_and_is_written_again(golden: Path):
    keys = {line["key"] for line in said(golden, "sample")}
    assert {str(parse_key(key)) for key in keys} == keys


def test_every_attachment_reads_and_is_written_again(golden: Path):
    for line in said(golden, "sample"):
        data = bytes.fromhex(line["attachment"])
        assert unpack(data).pack() == data


def test_every_sample_names_the_publisher_whose_token_was_declared(golden: Path):
    """A GID is the hash of a token: so it is with rmw_zenoh_cpp."""
    count = 0
    for name, lines in sessions(golden).items():
        publishers = {
            (gid_of(line["key"]), token.name, token.type_name)
            for line in lines
            if is_a(line, "token") and isinstance(token := parse_token(line["key"]), EndpointToken)
            if token.kind is EndpointKind.PUBLISHER
        }
        for line in lines:
            if is_a(line, "sample"):
                key = parse_key(line["key"])
                gid = unpack(bytes.fromhex(line["attachment"])).gid
                assert (gid, key.name, key.type_name) in publishers, name
                count += 1
    assert count > 500


def test_numbers_count_the_samples_of_each_publisher_from_one(golden: Path):
    for name, lines in sessions(golden).items():
        counted: dict[bytes, list[int]] = {}
        for line in lines:
            if is_a(line, "sample"):
                told = unpack(bytes.fromhex(line["attachment"]))
                counted.setdefault(told.gid, []).append(told.sequence)
        for numbers in counted.values():
            assert numbers == list(range(numbers[0], numbers[0] + len(numbers))), name


def test_every_payload_reads_and_keeps_its_length_when_it_is_written_again(golden: Path):
    """Bytes between fields may differ: real nodes leave there what their memory held."""
    for line in said(golden, "sample"):
        codec = Codec(LIBRARY.message(parse_key(line["key"]).type_name))
        payload = bytes.fromhex(line["payload"])
        message = codec.decode(payload)
        again = codec.encode(message)
        assert (len(again), again[:4]) == (len(payload), payload[:4])
        assert codec.decode(again) == message


def test_a_cached_publisher_shows_itself_below_the_key_of_its_topic(golden: Path):
    for name, lines in sessions(golden).items():
        tokens = [parse_token(line["key"]) for line in lines if is_a(line, "token")]
        keys = {
            f"{end.node.domain}{end.name}"
            for end in tokens
            if isinstance(end, EndpointToken) and end.qos.durability.name == "TRANSIENT_LOCAL"
        }
        shown = {
            parse_key(line["key"].partition("/@adv/")[0])
            for line in lines
            if is_a(line, "adv_token")
        }
        assert {f"{key.domain}{key.name}" for key in shown} <= keys, name


def test_a_reply_repeats_the_number_and_gid_of_its_request(golden: Path):
    [(_, lines)] = [one for one in sessions(golden).items() if "service_reply" in one[0]]
    request, reply = lines
    kind = LIBRARY.service(ADD)
    asked = Codec(kind.Request).decode(bytes.fromhex(request["request_payload"]))
    answered = Codec(kind.Response).decode(bytes.fromhex(reply["payload"]))
    assert (asked.a, asked.b, answered.sum) == (20, 22, 42)
    sent = unpack(bytes.fromhex(request["request_attachment"]))
    came = unpack(bytes.fromhex(reply["attachment"]))
    assert (came.sequence, came.gid) == (sent.sequence, sent.gid)
    assert str(parse_key(reply["key"])) == reply["key"] == request["request_key"]
