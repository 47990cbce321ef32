"""`python -m tests.support.golden_wire`: writes `tests/golden/wire/`, one file per distribution.

Written from the specification of rmw_zenoh, REP-2016 and CDR alone. It imports nothing of the
studio, so that a mistake there cannot hide itself here.
"""

from __future__ import annotations

import hashlib
import json
import re
import struct
from pathlib import Path
from typing import Any

import xxhash

from tests.support.golden_cases import ATTACHMENTS, CDR, KEYS, NODE, TOKENS
from tests.support.golden_types import CHANGED, TYPES

FOLDER = Path(__file__).resolve().parents[1] / "golden" / "wire"
_SIZES = {
    "bool": "?", "byte": "B", "char": "B", "int8": "b", "uint8": "B", "int16": "h", "uint16": "H",
    "int32": "i", "uint32": "I", "int64": "q", "uint64": "Q", "float32": "f", "float64": "d",
}  # fmt: skip
_IDS = {
    "int8": 2, "uint8": 3, "char": 3, "int16": 4, "uint16": 5, "int32": 6, "uint32": 7, "int64": 8,
    "uint64": 9, "float32": 10, "float64": 11, "bool": 15, "byte": 16, "string": 17,
}  # fmt: skip
_FIELD = re.compile(r"([\w/]+?)(?:<=(\d+))?(?:\[(<=)?(\d*)\])? (\w+)(?: .*)?")
Json = dict[str, Any]


class Distribution:
    """The messages of one distribution: fields as (name, base, string bound, kind, count)."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.fields: dict[str, list[tuple[str, str, int, str, int]]] = {}
        for type_name, text in (TYPES | CHANGED[name]).items():
            self._take(type_name, text)

    def _take(self, name: str, text: str) -> None:
        parts = text.split("---")
        if "/srv/" in name:
            self._take_service(name, *parts)
        elif "/action/" in name:
            self._take_action(name, *parts)
        else:
            self._message(name, text)

    def _take_service(self, name: str, request: str, response: str) -> None:
        self._message(f"{name}_Request", request)
        self._message(f"{name}_Response", response)
        event = f"service_msgs/ServiceEventInfo info; {name}_Request[<=1] request; "
        self._message(f"{name}_Event", event + f"{name}_Response[<=1] response")
        whole = f"{name}_Request request_message; {name}_Response response_message; "
        self._message(name, whole + f"{name}_Event event_message")

    def _take_action(self, name: str, goal: str, result: str, feedback: str) -> None:
        for part, text in (("Goal", goal), ("Result", result), ("Feedback", feedback)):
            self._message(f"{name}_{part}", text)
        uuid, time = "unique_identifier_msgs/UUID goal_id", "builtin_interfaces/Time stamp"
        sent, got = f"{uuid}; {name}_Goal goal", f"int8 status; {name}_Result result"
        self._take_service(f"{name}_SendGoal", sent, f"bool accepted; {time}")
        self._take_service(f"{name}_GetResult", uuid, got)
        self._message(f"{name}_FeedbackMessage", f"{uuid}; {name}_Feedback feedback")

    def _message(self, name: str, text: str) -> None:
        lines = [line.strip() for line in text.split(";") if line.strip()]
        package = name.partition("/")[0]
        self.fields[name] = [self._field(package, line) for line in lines] or [
            ("structure_needs_at_least_one_member", "uint8", 0, "", 0)
        ]

    def _field(self, package: str, line: str) -> tuple[str, str, int, str, int]:
        found = _FIELD.fullmatch(line)
        assert found, line
        base, bound, bounded, count, name = found.groups()
        if base not in _IDS:
            parts = base.split("/")
            base = (
                base
                if len(parts) == 3
                else "/".join([*(parts[:-1] or [package]), "msg", parts[-1]])
            )
        kind = "" if count is None else "bounded" if bounded else "array" if count else "sequence"
        return name, base, int(bound or 0), kind, int(count or 0)

    def hash_of(self, name: str) -> str:
        """RIHS01 of a message, service or part of an action."""
        found, waiting = {name}, [name]
        while waiting:
            needed = {base for _, base, *_ in self.fields[waiting.pop()] if base not in _IDS}
            waiting += needed - found
            found |= needed
        described = {
            "type_description": self._described(name),
            "referenced_type_descriptions": [
                self._described(one) for one in sorted(found - {name})
            ],
        }
        return "RIHS01_" + hashlib.sha256(json.dumps(described).encode()).hexdigest()

    def _described(self, name: str) -> Json:
        return {"type_name": name, "fields": [self._described_field(*f) for f in self.fields[name]]}

    def _described_field(self, name: str, base: str, bound: int, kind: str, count: int) -> Json:
        more = {"": 0, "array": 48, "bounded": 96, "sequence": 144}[kind]
        nested = base not in _IDS
        described = {
            "type_id": (1 if nested else _IDS[base] + (4 if bound else 0)) + more,
            "capacity": count,
            "string_capacity": bound,
            "nested_type_name": base if nested else "",
        }
        return {"name": name, "type": described}

    def key_hash(self, name: str) -> str:
        """What stands in keys and tokens: Humble knows no hashes."""
        return "TypeHashNotSupported" if self.name == "humble" else self.hash_of(name)

    def cdr(self, name: str, value: Json, order: str) -> bytes:
        """A message in plain CDR, its header of four bytes included."""
        out = bytearray()
        self._write(out, name, value, order)
        return (b"\0\1\0\0" if order == "<" else b"\0\0\0\0") + bytes(out)

    def _write(self, out: bytearray, type_name: str, value: Json, order: str) -> None:
        for name, base, _, kind, count in self.fields[type_name]:
            if not kind:
                self._write_one(out, base, value.get(name, 0), order)
                continue
            items = value[name]
            assert kind != "array" or len(items) == count
            if kind != "array":
                self._write_one(out, "uint32", len(items), order)
            for item in items:
                self._write_one(out, base, item, order)

    def _write_one(self, out: bytearray, base: str, value: Any, order: str) -> None:  # noqa: ANN401
        if base == "string":
            text = value.encode() + b"\0"
            self._write_one(out, "uint32", len(text), order)
            out += text
        elif base in _SIZES:
            packed = struct.pack(order + _SIZES[base], value)
            out += bytes(-len(out) % len(packed)) + packed
        else:
            self._write(out, base, value, order)


def key_of(domain: int, name: str, type_name: str, type_hash: str) -> str:
    """Make a data key."""
    return f"{domain}/{name.strip('/')}/{dds(type_name)}/{type_hash}"


def dds(type_name: str) -> str:
    """`std_msgs/msg/String` as DDS names it."""
    package, kind, base = type_name.split("/")
    return f"{package}::{kind}::dds_::{base}_"


def token_of(case: Json, type_hash: str) -> str:
    """Make a liveliness token of a node or an endpoint."""
    node = NODE | case.get("node", {})
    chunks = ["@ros2_lv", node["domain"], node["zid"], node["nid"]]
    names = [node[part].replace("/", "%") for part in ("enclave", "namespace", "name")]
    if case["kind"] == "NN":
        return "/".join(map(str, [*chunks, node["nid"], "NN", *names]))
    chunks += [case["eid"], case["kind"], *names, case["topic"].replace("/", "%")]
    chunks += [dds(case["type"]), type_hash, case["qos_text"], *case.get("extra", [])]
    return "/".join(map(str, chunks))


def gid_of(token: str) -> str:
    """XXH3-128 of a token: low half, then high half, each little endian; as hex."""
    number = xxhash.xxh3_128_intdigest(token.encode(), seed=0)
    return struct.pack("<QQ", number & (2**64 - 1), number >> 64).hex()


def attachment_of(case: Json) -> str:
    """The 33 bytes of a sample's attachment, as hex."""
    numbers = struct.pack("<qq", case["sequence"], case["source_time_ns"])
    return (numbers + b"\x10" + bytes.fromhex(case["gid"])).hex()


def golden(distro: str) -> Json:
    """Everything that is held against the studio for one distribution."""
    types = Distribution(distro)
    return {
        "distro": distro,
        "hashes": {name: types.hash_of(name) for name in sorted(types.fields)},
        "keys": [_key_case(types, case) for case in KEYS],
        "tokens": [_token_case(types, case) for case in TOKENS],
        "attachments": [case | {"bytes": attachment_of(case)} for case in ATTACHMENTS],
        "cdr": [_cdr_case(types, case) for case in CDR],
    }


def _key_case(types: Distribution, case: Json) -> Json:
    type_hash = types.key_hash(case["type"])
    key = key_of(case["domain"], case["name"], case["type"], type_hash)
    return case | {"type_hash": type_hash, "key": key}


def _token_case(types: Distribution, case: Json) -> Json:
    type_hash = types.key_hash(case["type"]) if "type" in case else ""
    token = token_of(case, type_hash)
    return case | {
        "node": NODE | case.get("node", {}),
        "type_hash": type_hash,
        "token": token,
        "gid": gid_of(token),
    }


def _cdr_case(types: Distribution, case: Json) -> Json:
    little, big = (types.cdr(case["type"], case["value"], order).hex() for order in "<>")
    return case | {"little": little, "big": big}


def golden_text(distro: str) -> str:
    """The golden file of a distribution."""
    return json.dumps(golden(distro), indent=1, ensure_ascii=False) + "\n"


def main() -> None:
    """Write the files anew."""
    for distro in CHANGED:
        (FOLDER / f"{distro}.json").write_text(golden_text(distro), encoding="utf-8")


if __name__ == "__main__":
    main()
