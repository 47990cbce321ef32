"""What array fields take: numbers become numpy arrays of the field's type, others lists."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from studio.errors import MessageValueError
from studio.ros.types.definitions import FieldType, Shape

if TYPE_CHECKING:
    from numpy.typing import NDArray

Keep = Callable[[Any], Any]
_DTYPES = {"bool": np.bool_, "byte": np.uint8, "char": np.uint8}
_KINDS_TAKEN = {"b": "b", "i": "iu", "u": "iu", "f": "fiu"}


def dtype_of(base: str) -> np.dtype[Any]:
    """Give the numpy type of a numeric base type."""
    return np.dtype(_DTYPES.get(base, base))


def keeper(where: str, kind: FieldType) -> Keep:
    """Make what turns a given value into the one that an array field keeps.

    It raises MessageValueError, which names `where`, for what does not fit.
    """
    return _number_keeper(where, kind) if kind.numeric else _list_keeper(where, kind)


def check_count(where: str, kind: FieldType, count: int) -> None:
    """Refuse a wrong number of values.

    Raises:
        MessageValueError: An array has another length, or a bounded sequence too many.
    """
    if kind.shape is Shape.ARRAY and count != kind.count:
        raise MessageValueError(where, f"{kind.count} values are needed, {count} were given")
    if kind.shape is Shape.BOUNDED and count > kind.count:
        raise MessageValueError(where, f"at most {kind.count} values fit, {count} were given")


def _number_keeper(where: str, kind: FieldType) -> Keep:
    dtype = dtype_of(kind.base)
    counted = kind.shape is not Shape.SEQUENCE
    array_type = np.ndarray

    def keep(value: Any) -> NDArray[Any]:  # noqa: ANN401
        if not (
            type(value) is array_type
            and value.dtype == dtype
            and value.ndim == 1
            and value.flags.c_contiguous
        ):
            value = _as_array(where, kind, value, dtype)
        if counted:
            check_count(where, kind, len(value))
        return value

    return keep


def _as_array(where: str, kind: FieldType, value: object, dtype: np.dtype[Any]) -> NDArray[Any]:
    if isinstance(value, (bytes, bytearray, memoryview)) and dtype.itemsize == 1:
        return np.frombuffer(cast("bytes", value), dtype=dtype)
    if isinstance(value, (str, dict, bytes)) or not isinstance(value, Iterable):
        raise MessageValueError(where, f"{said(value)} is no list of {kind.base}")
    found = _given_array(where, kind, cast("Iterable[object]", value))
    if found.size and (found.ndim != 1 or found.dtype.kind not in _KINDS_TAKEN[dtype.kind]):
        raise MessageValueError(where, f"{said(value)} is no list of {kind.base}")
    if found.ndim != 1:
        found = found.reshape(-1)
    _check_range(where, kind, found, dtype)
    with np.errstate(over="ignore"):
        return np.ascontiguousarray(found.astype(dtype))


def _given_array(where: str, kind: FieldType, value: Iterable[object]) -> NDArray[Any]:
    try:
        return np.asarray(cast("Any", value) if isinstance(value, np.ndarray) else list(value))
    except (ValueError, TypeError, OverflowError):
        raise MessageValueError(where, f"{said(value)} is no list of {kind.base}") from None


def _check_range(where: str, kind: FieldType, found: NDArray[Any], dtype: np.dtype[Any]) -> None:
    if not found.size or dtype.kind not in "iu":
        return
    limits = np.iinfo(dtype)
    if int(found.min()) < limits.min or int(found.max()) > limits.max:
        raise MessageValueError(
            where, f"{kind.base} goes from {limits.min} to {limits.max}, a value does not fit"
        )


def _list_keeper(where: str, kind: FieldType) -> Keep:
    counted = kind.shape is not Shape.SEQUENCE

    def keep(value: Any) -> list[object]:  # noqa: ANN401
        if type(value) is not list:
            if isinstance(value, (str, bytes, dict)) or not isinstance(value, Iterable):
                raise MessageValueError(where, f"{said(value)} is no list of {kind.base}")
            value = list(cast("Iterable[object]", value))
        kept = cast("list[object]", value)
        if counted:
            check_count(where, kind, len(kept))
        return kept

    return keep


def said(value: Any) -> str:  # noqa: ANN401  # of any type, known in part or not
    """Show a value within a sentence, cut where it is long."""
    try:
        shown = repr(value)
    except ValueError:
        # Python writes no number of more than 4300 digits.
        return "a number too long to show"
    return shown if len(shown) <= 60 else f"{shown[:57]}..."
