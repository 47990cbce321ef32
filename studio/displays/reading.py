"""Reading: fields of messages that are not those which a display knows are told as such."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from studio.errors import DisplayMessageError

if TYPE_CHECKING:
    from collections.abc import Generator


@contextmanager
def reading(type_name: str) -> Generator[None]:
    """Read fields within.

    Raises:
        DisplayMessageError: A field is not there, or of another kind: somebody's own text of the
            type says other than the one of ROS.
    """
    try:
        yield
    except (AttributeError, TypeError, ValueError, IndexError) as error:
        reason = (
            f"it is known here with other fields than ROS gives it ({error}): take back the text "
            "that says so"
        )
        raise DisplayMessageError(type_name, reason) from error
