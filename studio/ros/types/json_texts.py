"""Messages and plain values as JSON for a page: nothing that its numbers cannot hold is lost."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any, Final, cast

from studio.ros.types.plain import Brevity, to_dict

if TYPE_CHECKING:
    from studio.ros.types.classes import MessageValue

_EXACT_MAX: Final = 2**53
"""From here on numbers of JavaScript leave out whole ones."""
_LENGTHS: Final = (10_000, 1_000, 100, 10)
"""Of arrays and texts, tried in turn."""


def to_json(message: MessageValue, characters_max: int) -> str:
    """Write a message in about so many characters at most; long arrays and texts end with `...`."""
    written = ""
    # Two letters are the least that an item takes: what cannot fit is not even tried.
    for length in [one for one in _LENGTHS if 2 * one <= characters_max] or _LENGTHS[-1:]:
        written = plain_json(to_dict(message, Brevity(length_max=length)))
        if len(written) <= characters_max:
            break
    return written


def plain_json(value: object) -> str:
    """Write plain values; large whole numbers, nan, infinities and bytes become texts."""
    return json.dumps(_readable(value), allow_nan=False, separators=(",", ":"))


def _readable(value: object) -> object:
    if isinstance(value, dict):
        items = cast("dict[object, object]", value).items()
        return {str(key): _readable(one) for key, one in items}
    if isinstance(value, (list, tuple)):
        return [_readable(one) for one in cast("list[object]", value)]
    if isinstance(value, bool) or value is None or isinstance(value, str):
        return value
    return _number(value)


def _number(value: Any) -> object:  # noqa: ANN401 - what YAML makes of a word
    if isinstance(value, int):
        return value if abs(value) <= _EXACT_MAX else str(value)
    if isinstance(value, float):
        return value if math.isfinite(value) else str(value)
    if isinstance(value, bytes):
        return value.decode("latin-1")
    return str(value)
