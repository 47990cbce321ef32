"""YAML as command lines and files carry it: no tags of Python, no references, every letter kept."""

from __future__ import annotations

import sys
from typing import Any

import yaml

YAML_CHARACTERS_MAX = 10_000_000
_RARE_LINE_ENDS = frozenset("\r\x85\u2028\u2029\ufeff")


def read_yaml(text: str) -> Any:  # noqa: ANN401
    """Read one document of YAML; empty is None.

    Raises:
        ValueError: It is no YAML, or too long; half a sentence says why.
    """
    if len(text) > YAML_CHARACTERS_MAX:
        raise ValueError(f"more than {YAML_CHARACTERS_MAX} characters were given")
    try:
        return yaml.load(text, Loader=_Loader)
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        said = " ".join(str(error).split())
        raise ValueError(f"the text is no YAML ({said})") from None


def write_yaml(value: object, *, flow: bool = False) -> str:
    """Write plain values, the order of their keys kept and no line folded."""
    return yaml.dump(
        value,
        Dumper=_Dumper,
        allow_unicode=True,
        sort_keys=False,
        default_flow_style=flow,
        width=sys.maxsize,
    )


class _Dumper(yaml.SafeDumper):
    """YAML that reads back: texts with rare ends of lines are quoted with escapes."""

    def represent_text(self, text: str) -> yaml.ScalarNode:
        """Choose how a text is written; the plain way where that keeps every letter."""
        style = '"' if _RARE_LINE_ENDS.intersection(text) else None
        return yaml.ScalarNode("tag:yaml.org,2002:str", text, style=style)


_Dumper.add_representer(str, _Dumper.represent_text)


class _Loader(yaml.SafeLoader):
    """YAML without references: they make a short text as large as one likes."""

    def compose_node(self, parent: Any, index: Any) -> Any:  # noqa: ANN401
        if self.check_event(yaml.events.AliasEvent):  # pyright: ignore[reportUnknownMemberType]
            raise yaml.YAMLError("references such as *name are not taken")
        return super().compose_node(parent, index)
