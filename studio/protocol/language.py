"""What the studio answers to an editor's questions about a text.

Offsets and columns count UTF-16 code units of the text as an editor holds it: no byte order mark,
every line break one LF. Offsets are from 0, lines and columns from 1.
"""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from studio.description.language.questions import Completions, Meaning, Outline, References
from studio.protocol.message import OFFSET_LIMIT, Command, Event


class OutlineAnswer(Event):
    """Answer to `get_outline`."""

    type: Literal["outline"] = "outline"
    request: int
    outline: Outline


class MeaningAnswer(Event):
    """Answer to `look_up`; None: nothing known is there."""

    type: Literal["meaning"] = "meaning"
    request: int
    meaning: Meaning | None


class ReferencesAnswer(Event):
    """Answer to `get_references`."""

    type: Literal["references"] = "references"
    request: int
    references: References


class CompletionsAnswer(Event):
    """Answer to `complete`."""

    type: Literal["completions"] = "completions"
    request: int
    completions: Completions


class PlaceCommand(Command):
    """A question about a place in a file's text, as in `get_text` and `texts_changed`.

    `offset` counts UTF-16 code units from 0: no byte order mark, every line break one LF.
    """

    file: str = Field(max_length=4096)
    offset: int = Field(ge=0, le=OFFSET_LIMIT)


class LookUp(PlaceCommand):
    """Ask for the meaning at a place: its value in the run, and where it is defined."""

    type: Literal["look_up"] = "look_up"


class GetReferences(PlaceCommand):
    """Ask for all places that use the name at a place."""

    type: Literal["get_references"] = "get_references"


class Complete(PlaceCommand):
    """Ask for the completions at a place."""

    type: Literal["complete"] = "complete"


class GetOutline(Command):
    """Ask for what the files of the robot define: includes, macros, properties, args."""

    type: Literal["get_outline"] = "get_outline"
