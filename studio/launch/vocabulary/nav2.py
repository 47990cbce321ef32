"""The helpers of nav2_common.launch that rewrite files: RewrittenYaml and ReplaceString."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, cast

import yaml

from studio.errors import SubstitutionFailure
from studio.launch.vocabulary.parameters import DEPTH_MAX, VALUES_MAX, read_text
from studio.launch.vocabulary.substitutions import value_of_yaml
from studio.launch.vocabulary.temporary import written
from studio.launch.vocabulary.texts import SomeText, Substitution, is_unknown, perform, to_texts

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from studio.launch.vocabulary.conditions import Condition
    from studio.launch.vocabulary.context import LaunchContext

_PARAMETERS: Final = "ros__parameters"


class RewrittenYaml(Substitution):
    """A file of parameters with other values; its text is the path of the file that is made.

    Args:
        source_file: The file.
        param_rewrites: New values, by a parameter's name or by its whole path, its levels parted
            by dots. A path with `ros__parameters` in it that the file has not is added.
        root_key: A level put around the whole file, such as a namespace; empty: none.
        key_rewrites: New names of keys, at all levels.
        convert_types: Whether a new value that is a number's text becomes a number; `true` and
            `false` become bools in any case.
    """

    def __init__(
        self,
        source_file: SomeText,
        param_rewrites: Mapping[Any, Any],
        root_key: SomeText | None = None,
        key_rewrites: Mapping[Any, Any] | None = None,
        convert_types: bool = False,
        **_: Any,
    ) -> None:
        super().__init__()
        self.source_file = to_texts(source_file)
        self.param_rewrites, self.key_rewrites = dict(param_rewrites), dict(key_rewrites or {})
        self.root_key, self.convert_types = root_key, convert_types

    def perform(self, context: LaunchContext) -> str:
        path = perform(context, self.source_file)
        if is_unknown(path):
            return path
        values = _performed(context, self.param_rewrites)
        keys = _performed(context, self.key_rewrites)
        tree = _Rewriting(values, keys, self._value).whole(_tree_of(path))
        root = "" if self.root_key is None else perform(context, self.root_key)
        if root:
            tree = {root: tree}
        text = yaml.safe_dump(tree, allow_unicode=True, sort_keys=False)
        return written(text, Path(path).name, path)

    def _value(self, text: str) -> Any:
        if self.convert_types:
            try:
                return float(text) if "." in text else int(text)
            except ValueError:
                pass
        return {"true": True, "false": False}.get(text.lower(), text)

    def describe(self) -> str:
        return f"{''.join(one.describe() for one in self.source_file)}, rewritten"


class ReplaceString(Substitution):
    """A file in whose text words are replaced; its text is the path of the file that is made."""

    def __init__(
        self,
        source_file: SomeText,
        replacements: Mapping[Any, Any],
        condition: Condition | None = None,
    ) -> None:
        super().__init__()
        self.source_file, self.replacements = to_texts(source_file), dict(replacements)
        self.condition = condition

    def perform(self, context: LaunchContext) -> str:
        path = perform(context, self.source_file)
        if is_unknown(path) or not (self.condition is None or self.condition.evaluate(context)):
            return path
        text = read_text(path)
        for word, other in _performed(context, self.replacements).items():
            text = text.replace(word, other)
        return written(text, Path(path).name, path)

    def describe(self) -> str:
        return f"{''.join(one.describe() for one in self.source_file)}, with words replaced"


def _performed(context: LaunchContext, values: Mapping[Any, Any]) -> dict[str, str]:
    return {perform(context, name): _text(context, value) for name, value in values.items()}


def _text(context: LaunchContext, value: Any) -> str:
    return str(value) if isinstance(value, bool | int | float) else perform(context, value)


def _tree_of(path: str) -> dict[Any, Any]:
    try:
        tree = value_of_yaml(read_text(path))
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        reason = " ".join(str(error).split())
        raise SubstitutionFailure(f"{path} is no YAML: {reason}") from None
    if not isinstance(tree, dict):
        raise SubstitutionFailure(f"{path} is no file of parameters: its nodes are missing")
    return cast("dict[Any, Any]", tree)


class _Rewriting:
    """Rewrites a tree; aliases of YAML may make it larger than its file, so it has limits."""

    def __init__(
        self, values: dict[str, str], keys: dict[str, str], value: Callable[[str], Any]
    ) -> None:
        self._values, self._keys, self._value = values, keys, value
        self._found: set[str] = set()
        self._count = 0

    def whole(self, tree: dict[Any, Any]) -> dict[Any, Any]:
        made = self._level(tree, "", 0)
        for path, text in self._values.items():
            if path not in self._found and _PARAMETERS in path.split("."):
                _put(made, path.split("."), self._value(text))
        return made

    def _level(self, tree: dict[Any, Any], above: str, depth: int) -> dict[Any, Any]:
        self._count += len(tree)
        if depth > DEPTH_MAX or self._count > VALUES_MAX:
            raise SubstitutionFailure(
                f"a file of parameters is deeper than {DEPTH_MAX} levels or has more than "
                f"{VALUES_MAX} values: give fewer"
            )
        made: dict[Any, Any] = {}
        for key, value in tree.items():
            path = f"{above}{key}"
            name = self._keys.get(str(key), key)
            if isinstance(value, dict):
                below = cast("dict[Any, Any]", value)
                made[name] = self._level(below, f"{path}.", depth + 1)
            else:
                made[name] = self._leaf(path, str(key), value)
        return made

    def _leaf(self, path: str, key: str, value: Any) -> Any:
        self._found.add(path)
        text = self._values.get(path, self._values.get(key))
        return value if text is None else self._value(text)


def _put(tree: dict[Any, Any], levels: list[str], value: Any) -> None:
    for name in levels[:-1]:
        below = tree.setdefault(name, {})
        if not isinstance(below, dict):
            return
        tree = cast("dict[Any, Any]", below)
    tree[levels[-1]] = value
