"""Values of YAML files: as xacro has them, every read noted, nothing shared."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest

from studio.description.expressions import HELPERS, compile_expression
from studio.description.faults import Fault, Refusal
from studio.description.run_record import YamlReads
from studio.description.yaml_values import Reader, check_aliases, read_yaml, wrap

if TYPE_CHECKING:
    from studio.description.run_record import Input, KeyPath

TEXT = b"arm:\n  links: [{length: 0.5}, {length: 0.7}]\n  name: left\nmass: 3\n"


def load(data: bytes) -> Any:  # noqa: ANN401 - whatever the file holds
    return read_yaml("c.yaml", data, float)


class Noted:
    """A document and the key paths that were read of it."""

    def __init__(self, data: bytes = TEXT) -> None:
        self.reads = YamlReads("c.yaml", data)
        self.noted: list[Input] = []
        self.root = wrap(load(data), Reader(self.reads, self.noted.append), ())

    @property
    def paths(self) -> list[KeyPath]:
        return [path for path, value in self.reads.values.items() if value in self.noted]


def test_a_read_is_noted_with_its_key_path():
    document = Noted()
    assert document.root.arm.links[1].length == 0.7
    assert document.paths == [
        ("arm",),
        ("arm", "links"),
        ("arm", "links", 1),
        ("arm", "links", 1, "length"),
    ]


@pytest.mark.parametrize(
    "text",
    [
        "root['arm']['name']",
        "root.get('arm').get('name')",
        "dict(root.arm)['name']",
        "[value for key, value in root.arm.items() if key == 'name'][0]",
        "list(root.arm.values())[1]",
    ],
)
def test_whatever_way_a_value_is_read_it_is_noted(text: str):
    document = Noted()
    names = {**HELPERS, "__steps": iter, "root": document.root, "dict": dict, "list": list}
    assert eval(compile_expression(text).code, names) == "left"
    assert ("arm", "name") in document.paths


def test_negative_indices_and_loops_note_where_an_item_stands():
    document = Noted()
    assert document.root.arm.links[-1].length == 0.7
    assert [link.length for link in document.root.arm.links] == [0.5, 0.7]
    assert ("arm", "links", 0, "length") in document.paths
    assert ("arm", "links", 1, "length") in document.paths


def test_printing_reads_everything_below():
    document = Noted()
    assert str(document.root.arm).startswith("{'links': [{'length': 0.5}")
    assert document.reads.whole == {("arm",)}


def test_what_is_read_is_a_copy():
    document = Noted()
    taken = document.root.arm.links
    taken.pop(0)
    taken[0]["length"] = 9
    taken.append(1)
    assert [link.length for link in document.root.arm.links] == [0.5, 0.7]


def test_a_missing_key_says_so():
    with pytest.raises(AttributeError, match='no key "leg"'):
        _ = Noted().root.leg


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("!degrees 180", math.pi),
        ("!radians 1.5", 1.5),
        ("!millimeters 250", 0.25),
        ("!meters 2", 2.0),
        ("!foot 1", 0.3048),
        ("!inches 10", 0.254),
    ],
)
def test_units_are_converted_to_metres_and_radians(text: str, value: float):
    assert load(f"k: {text}".encode())["k"] == pytest.approx(value)


def test_an_empty_file_is_nothing():
    assert load(b"# only a comment\n") is None


def test_a_mistake_is_said_with_its_place():
    with pytest.raises(Fault) as fault:
        load(b"a: 1\nb: [1,\nc: 2}\n")
    assert fault.value.code == "yaml-malformed"
    assert fault.value.place is not None
    assert fault.value.place.line == 3


@pytest.mark.parametrize("data", [b"k: \xff", b"a: 1\n---\nb: 2\n", b"k: !unknown 1"])
def test_what_is_no_yaml_of_ours_is_a_fault(data: bytes):
    with pytest.raises(Fault, match=r"YAML|UTF-8"):
        load(data)


def bomb(levels: int) -> bytes:
    lines = ["a0: &a0 [x]"]
    lines += [f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]" for n in range(1, levels)]
    return "\n".join(lines).encode()


@pytest.mark.parametrize("data", [bomb(9), b"a: &a [*a]", b"[" * 200 + b"]" * 200])
def test_a_text_that_expands_without_bound_is_refused(data: bytes):
    with pytest.raises(Refusal):
        load(data)
    with pytest.raises(Refusal):
        check_aliases(data)


def test_aliases_within_bounds_are_values():
    assert load(bomb(3))["a1"] == [["x"]] * 9
