"""Values of YAML files: as xacro has them, every read noted, nothing shared."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from studio.description.evaluator.graph import YamlReads
from studio.description.evaluator.yaml_values import Reader, wrap
from studio.description.expressions.expressions import HELPERS, compile_expression
from studio.description.syntax.yaml_reading import read_yaml

if TYPE_CHECKING:
    from studio.description.evaluator.graph import Input
    from studio.description.syntax.yaml_spans import KeyPath

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
