# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false
"""YAML files as plain Python values: bounded in size and depth, xacro's units applied."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Any, Final, cast

import yaml

from studio.description.faults import Fault, Refusal
from studio.problems import Place

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

EXPANDED_LIMIT: Final = 100_000
"""Values of a document with every alias counted where it stands."""
DEPTH_LIMIT: Final = 64
"""Values inside values; the deepest file of the corpus has 9."""
_SEPARATORS_LIMIT: Final = 50_000
"""Commas, colons and lines; the largest file of the corpus has 1,000."""
_BRACKETS: Final = re.compile(rb"[\[\]{}]")
_COMPACT: Final = re.compile(rb"(?:[-?:][ \t]+){65}")
_DIGITS_LIMIT: Final = 24
"""Of a whole number, its sign and separators too; more than 64 bits have."""
UNITS: Final = {
    "!radians": 1.0,
    "!degrees": math.pi / 180.0,
    "!meters": 1.0,
    "!millimeters": 0.001,
    "!foot": 0.3048,
    "!inches": 0.0254,
}
"""xacro's tags and what one of each is in rad or m."""


def scalar_of(text: str, tag: str, evaluate: Callable[[str], Any]) -> Any:  # noqa: ANN401
    """Return the value of one plain scalar without blanks, as in a file.

    Raises:
        Fault: Its tag asks for a number, and it is none.
        Refusal: It is a whole number that no file may have.
        LookupError: The tag is none of xacro's.
    """
    if tag:
        return float(evaluate(text)) * UNITS[tag]
    base = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    node = yaml.compose(text, Loader=base)
    if isinstance(node, yaml.ScalarNode):
        _check_number(node.tag, node.value)
    return yaml.load(text, Loader=base)


def read_yaml(path: str, data: bytes, evaluate: Callable[[str], Any]) -> Any:  # noqa: ANN401
    """Return the values of a YAML file as plain Python.

    Args:
        path: Named in errors.
        data: The file.
        evaluate: For the text behind `!degrees` and its like.

    Raises:
        Fault: It is no YAML, with its place.
        Refusal: Its aliases would expand without bound.
    """
    _refuse_bulk(data)
    try:
        return _construct(data.decode("utf-8"), evaluate)
    except yaml.YAMLError as error:
        raise _located(path, error) from None
    except UnicodeDecodeError:
        raise Fault("yaml-malformed", f"{path} is not UTF-8: save it as UTF-8.") from None
    except (OverflowError, RecursionError, ValueError) as error:
        raise Fault("yaml-malformed", f"{path} is no YAML that can be read: {error}.") from None


def check_aliases(data: bytes) -> None:
    """Check that the aliases of a YAML text do not expand without bound; ignore errors.

    Raises:
        Refusal: They do.
    """
    _refuse_bulk(data)
    base = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        node = yaml.compose(data, Loader=base)
    except (yaml.YAMLError, RecursionError, ValueError):
        return
    _count(node, {}, set())


def is_bulky(data: bytes) -> bool:
    """Whether a file has more values than are read."""
    return sum(map(data.count, (b",", b":", b"\n"))) > _SEPARATORS_LIMIT


def _refuse_bulk(data: bytes) -> None:
    """Refuse what would take long to parse, before it is."""
    if is_bulky(data):
        raise Refusal("yaml-too-large", "A YAML file holds more values than any robot needs.")
    depth = 0
    for bracket in _BRACKETS.finditer(data):
        depth += 1 if bracket[0] in b"[{" else -1
        if depth > 4 * DEPTH_LIMIT:
            raise _too_deep()
    if _COMPACT.search(data):
        raise _too_deep()


def _too_deep() -> Refusal:
    return Refusal("yaml-too-deep", f"A YAML file nests values deeper than {DEPTH_LIMIT}.")


def _construct(text: str, evaluate: Callable[[str], Any]) -> Any:  # noqa: ANN401
    base = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    loader = type("_UnitLoader", (base,), {})(text)
    for tag, size in UNITS.items():
        loader.add_constructor(tag, _unit_constructor(size, evaluate))
    try:
        node = loader.get_single_node()
        if node is None:
            return None
        _count(node, {}, set())
        return loader.construct_document(node)
    finally:
        loader.dispose()


def _unit_constructor(size: float, evaluate: Callable[[str], Any]) -> Callable[[Any, Any], float]:
    def construct(loader: Any, node: Any) -> float:  # noqa: ANN401
        return float(evaluate(loader.construct_scalar(node))) * size

    return construct


def _count(node: Any, counted: dict[int, int], inside: set[int]) -> int:  # noqa: ANN401
    """Values below a node, aliases counted each time.

    Raises:
        Refusal: More than EXPANDED_LIMIT, deeper than DEPTH_LIMIT, or a node that contains itself.
    """
    key = id(node)
    if key in counted:
        return counted[key]
    if key in inside:
        raise Refusal("yaml-bomb", "A YAML file has an anchor that contains itself.")
    if len(inside) > DEPTH_LIMIT:
        raise _too_deep()
    if isinstance(node, yaml.ScalarNode):
        _check_number(node.tag, node.value)
    inside.add(key)
    total = 1 + sum(_count(child, counted, inside) for child in _children(node))
    inside.discard(key)
    if total > EXPANDED_LIMIT:
        raise Refusal("yaml-bomb", "The aliases of a YAML file expand to too many values.")
    counted[key] = total
    return total


def _check_number(tag: str, text: str) -> None:
    """Refuse whole numbers that take long to read, or that all have the same hash."""
    is_long = len(text) > _DIGITS_LIMIT and not text.lstrip("+-").startswith("0b")
    if tag == "tag:yaml.org,2002:int" and (is_long or len(text) > 4 * _DIGITS_LIMIT):
        raise Refusal("value-too-large", "A YAML file holds a whole number that is too large.")


def _children(node: Any) -> Iterator[Any]:  # noqa: ANN401
    if isinstance(node, yaml.MappingNode):
        return (one for pair in cast("list[tuple[Any, Any]]", node.value) for one in pair)
    if isinstance(node, yaml.SequenceNode):
        return iter(cast("list[Any]", node.value))
    return iter(())


def _located(path: str, error: yaml.YAMLError) -> Fault:
    mark = getattr(error, "problem_mark", None)
    reason = getattr(error, "problem", None) or str(error)
    fault = Fault("yaml-malformed", f"The YAML is not valid here: {reason}.")
    fault.place = Place(path, mark.line + 1, mark.column + 1) if mark else Place(path)
    return fault
