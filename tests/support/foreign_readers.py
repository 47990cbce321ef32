# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false, reportUnknownArgumentType=false
"""How xacro and PyYAML themselves read a text: what our own readers are measured against."""

from __future__ import annotations

from typing import TYPE_CHECKING

import xacro
import yaml

if TYPE_CHECKING:
    from collections.abc import Sequence


class _Untagged(yaml.CBaseLoader):
    """Reads every scalar as text and every tag as if it were not there."""


def _untagged(loader: _Untagged, _tag: str, node: yaml.Node) -> object:
    if isinstance(node, yaml.ScalarNode):
        return loader.construct_scalar(node)
    if isinstance(node, yaml.SequenceNode):
        return loader.construct_sequence(node, deep=True)
    assert isinstance(node, yaml.MappingNode)
    return loader.construct_mapping(node, deep=True)


_Untagged.add_multi_constructor("!", _untagged)


def defaults_by_xacro(params: str) -> dict[str, str]:
    """The defaults of a macro's `params` as xacro cuts them out."""
    found: dict[str, str] = {}
    while params.strip():
        name, value, params = xacro.parse_macro_arg(params)
        if value is not None and value[1] is not None:
            found[str(name)] = str(value[1])
    return found


def yaml_value_at(text: bytes | str, path: Sequence[str | int]) -> object:
    """The scalar at a key path of a document, as text.

    Raises:
        yaml.YAMLError: The text is no YAML.
    """
    value = yaml.load(text, _Untagged)
    for part in path:
        value = value[part]
    return value
