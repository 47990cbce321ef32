"""YAML as command lines and files carry it: no tags of Python, no references, every letter kept."""

from __future__ import annotations

import sys
from typing import Any

import yaml

YAML_CHARACTERS_MAX = 10_000_000
_QUOTED_CHARACTERS_MAX = 60
_RARE_LINE_ENDS = frozenset("\r\x85\u2028\u2029\ufeff")


def read_yaml(text: str, source: str = "") -> Any:  # noqa: ANN401
    """Read one document of YAML; empty is None.

    `source` names the text in errors, such as a file; without one, its beginning is quoted.

    Raises:
        ValueError: It is no YAML, or too long; half a sentence has what, where and why.
    """
    if len(text) > YAML_CHARACTERS_MAX:
        raise ValueError(f"more than {YAML_CHARACTERS_MAX} characters were given")
    try:
        return yaml.load(text, Loader=_Loader)
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        named = source or _quoted(text)
        raise ValueError(f"{named} is no YAML ({_reason(error)})") from None


def _quoted(text: str) -> str:
    """Quote the first line of a text that has some letters."""
    line = text.strip().partition("\n")[0].rstrip()
    shown = line if len(line) <= _QUOTED_CHARACTERS_MAX else f"{line[:_QUOTED_CHARACTERS_MAX]}..."
    return f"'{shown}'"


def _reason(error: Exception) -> str:
    """Return what is wrong, and where in the text, without PyYAML's own name of the text."""
    if isinstance(error, RecursionError):
        return "it is nested too deeply"
    if isinstance(error, yaml.reader.ReaderError):
        return f"the letter at place {error.position + 1} is none that YAML allows"
    text = str(error)
    if isinstance(error, yaml.MarkedYAMLError):
        mark = error.problem_mark or error.context_mark
        problem = error.problem or error.context or "it cannot be read"
        text = f"line {mark.line + 1}, column {mark.column + 1}: {problem}" if mark else problem
    return " ".join(text.replace("'<stream end>'", "the end").split())


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
        """Choose how a text is written; plain where that keeps every letter."""
        style = '"' if _RARE_LINE_ENDS.intersection(text) else None
        return yaml.ScalarNode("tag:yaml.org,2002:str", text, style=style)


_Dumper.add_representer(str, _Dumper.represent_text)


class _Loader(yaml.SafeLoader):
    """YAML without references: they make a short text as large as one likes."""

    def compose_node(self, parent: Any, index: Any) -> Any:  # noqa: ANN401
        if self.check_event(yaml.events.AliasEvent):  # pyright: ignore[reportUnknownMemberType]
            raise yaml.YAMLError("references such as *name are not taken")
        return super().compose_node(parent, index)
