"""Questions about texts as an editor asks them: at the bar `|` of some words."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from studio.description.editing.editor_text import EditorText
from studio.description.language.questions import (
    CompletionQuery,
    Completions,
    LookedUp,
    LookUpQuery,
    Outline,
    OutlineQuery,
    References,
    ReferencesQuery,
)
from studio.description.session import open_session
from studio.description.values import Edit, EditRequest, OpenRequest
from tests.support.corpus import corpus
from tests.support.descriptions import policy_for

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.description.language.questions import Completion, LanguageQuery, Meaning, TextPlace
    from studio.description.requests import Reply


class Editor:
    """An editor of the files below a folder; `entry` is the robot."""

    def __init__(self, root: Path, entry: Path, arguments: Mapping[str, str] | None = None) -> None:
        self.root, self.entry = root, entry
        self.texts: dict[Path, bytes] = {}
        """Texts that differ from the disk."""
        policy = policy_for(root, {"USER": "somebody"})
        request = OpenRequest(str(entry), dict(arguments or {}), policy, {})
        session, self.answer = open_session(request)
        assert session is not None
        self.session = session

    def ask(self, query: LanguageQuery) -> Reply:
        """Any question."""
        return self.session.query(query)

    def type(self, file: Path, start: int, end: int, new: bytes) -> None:
        """Write something in the place of the bytes [start, end) of a file."""
        self.texts[file] = self.text(file)[:start] + new + self.text(file)[end:]
        self.answer = self.session.answer(EditRequest((Edit(str(file), start, end, new),)))

    def text(self, file: Path) -> bytes:
        """A file's bytes as they are edited."""
        return self.texts.get(file, file.read_bytes())

    def offset(self, file: Path, words: str) -> int:
        """The editor's offset of the bar in words that stand in the file."""
        before, bar, behind = words.partition("|")
        assert bar, "the words have no bar"
        editor = EditorText(self.text(file))
        return editor.offset_of(editor.text.index(before + behind) + len(before))

    def meaning(self, file: Path, words: str) -> Meaning:
        """What stands at the bar."""
        found = self.maybe(file, words)
        assert found is not None, f"nothing is known at {words}"
        return found

    def maybe(self, file: Path, words: str) -> Meaning | None:
        """What stands at the bar, if anything."""
        query = LookUpQuery(str(file), self.text(file), self.offset(file, words))
        reply = self.ask(query)
        assert isinstance(reply, LookedUp), reply
        return reply.meaning

    def references(self, file: Path, words: str) -> References:
        """Who names what stands at the bar."""
        query = ReferencesQuery(str(file), self.text(file), self.offset(file, words))
        reply = self.ask(query)
        assert isinstance(reply, References), reply
        return reply

    def completions(self, file: Path, before: str, typed: str) -> Completions:
        """What may be typed after `typed`, when that is written before some words of the file."""
        editor = EditorText(self.text(file))
        at = editor.text.index(before)
        text = editor.text[:at] + typed + editor.text[at:]
        offset = EditorText(text.encode()).offset_of(at + len(typed))
        reply = self.ask(CompletionQuery(str(file), text.encode(), offset))
        assert isinstance(reply, Completions), reply
        return reply

    def outline(self) -> Outline:
        """What the files hold."""
        reply = self.ask(OutlineQuery())
        assert isinstance(reply, Outline), reply
        return reply


def labels(completions: Completions) -> list[str]:
    return [one.label for one in completions.items]


def offered(completions: Completions, label: str) -> Completion:
    """The completion of a label."""
    return next(one for one in completions.items if one.label == label)


def at(place: TextPlace) -> str:
    """A place as `name:line`."""
    return f"{place.file.rpartition('/')[2]}:{place.line}"


def text_at(place: TextPlace) -> str:
    """The words that stand at a place of a file on disk, as an editor shows them."""
    line = EditorText(Path(place.file).read_bytes()).text.split("\n")[place.line - 1]
    units = line.encode("utf-16-le")
    start = 2 * (place.column - 1)
    return units[start : start + 2 * place.length].decode("utf-16-le")


def pr2() -> Editor:
    """The PR2 of the corpus; skips the test without one."""
    root = corpus() / "PR2+pr2_common"
    return Editor(root, root / "pr2_description/robots/pr2.urdf.xacro")
