"""Messages that have a problem mended by its fix."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from studio.protocol.message import Command


class ApplyFix(Command):
    """Make the edits of a problem's fix as one undo step; refused when it is no longer found.

    The three say which problem is meant, as `problems` told it.
    """

    type: Literal["apply_fix"] = "apply_fix"
    code: str = Field(max_length=100)
    sentence: str = Field(max_length=4096)
    label: str = Field(max_length=1000)


class MendAll(Command):
    """Make the edits of every error's and every warning's fix as one undo step.

    Of two that want the same place, the first one's; notes (severity `info`) are left as they are.
    """

    type: Literal["mend_all"] = "mend_all"
