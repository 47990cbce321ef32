"""What the studio answers an editor that asks about a text.

Offsets and columns count UTF-16 code units of the text as an editor holds it: no byte order mark,
every line break one LF. Offsets are from 0, lines and columns from 1.
"""

from __future__ import annotations

from typing import Literal

from studio.description.language.questions import Completions, Meaning, Outline, References
from studio.engine.message import Message


class OutlineAnswer(Message):
    """Answer to `get_outline`."""

    type: Literal["outline"] = "outline"
    request: int
    outline: Outline


class MeaningAnswer(Message):
    """Answer to `look_up`; None: nothing that is known stands there."""

    type: Literal["meaning"] = "meaning"
    request: int
    meaning: Meaning | None


class ReferencesAnswer(Message):
    """Answer to `get_references`."""

    type: Literal["references"] = "references"
    request: int
    references: References


class CompletionsAnswer(Message):
    """Answer to `complete`."""

    type: Literal["completions"] = "completions"
    request: int
    completions: Completions
