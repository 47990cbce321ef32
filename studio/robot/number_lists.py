"""Long lists of numbers in text, as COLLADA holds them, to arrays."""

from __future__ import annotations

import contextlib
import warnings
from typing import TYPE_CHECKING

import msgspec
import numpy as np

if TYPE_CHECKING:
    from collections.abc import Generator

    from numpy.typing import NDArray

_FLOATS = msgspec.json.Decoder(list[float])


def parse_floats(text: str) -> NDArray[np.float64]:
    """Numbers separated by blanks of any kind.

    Most writers put one blank between numbers and write them as JSON does: its decoder takes half
    the time of numpy's.

    Raises:
        ValueError: A word is no number.
    """
    try:
        return np.array(_FLOATS.decode(f"[{text.strip().replace(' ', ',')}]"), dtype=np.float64)
    except (msgspec.DecodeError, UnicodeError):
        with _no_word_skipped():
            return np.fromstring(text, dtype=np.float64, sep=" ")


def parse_integers(text: str) -> NDArray[np.int64]:
    """Whole numbers separated by blanks of any kind.

    Raises:
        ValueError: A word is no whole number.
    """
    with _no_word_skipped():
        return np.fromstring(text, dtype=np.int64, sep=" ")


@contextlib.contextmanager
def _no_word_skipped() -> Generator[None]:
    """Numpy stops at the first word that is no number, and only warns."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)
        try:
            yield
        except DeprecationWarning as error:
            raise ValueError("a word of it is no number") from error
