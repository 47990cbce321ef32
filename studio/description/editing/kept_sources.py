"""The edits of a document as they outlast the process: texts, arguments and the undo list."""

from __future__ import annotations

from dataclasses import dataclass, replace

from studio.description.editing.undo import Splice, Step


@dataclass(frozen=True, slots=True)
class KeptText:
    """One file: as the disk had it when it was read, and as it is edited."""

    file: str
    disk: bytes
    now: bytes


@dataclass(frozen=True, slots=True)
class KeptSources:
    """Texts that are edited or that a step names, the arguments, and the steps, newest last."""

    texts: tuple[KeptText, ...]
    arguments: dict[str, str]
    done: tuple[Step, ...] = ()
    undone: tuple[Step, ...] = ()

    @property
    def unsaved_files(self) -> tuple[str, ...]:
        """The files whose edits no disk has."""
        return tuple(one.file for one in self.texts if one.disk != one.now)

    @property
    def size_bytes(self) -> int:
        """About how long it is in a file."""
        splices = (one for step in (*self.done, *self.undone) for one in step.splices)
        texts = sum(len(one.disk) + len(one.now) for one in self.texts)
        return texts + sum(len(one.old) + len(one.new) for one in splices)

    def sound(self) -> KeptSources:
        """This, without its steps where they do not fit the texts any more."""
        fits = self._fits(_reversed_steps(self.done)) and self._fits(list(reversed(self.undone)))
        return self if fits else replace(self, done=(), undone=())

    def _fits(self, steps: list[Step]) -> bool:
        """Whether steps can be done one after the other on the texts as they are."""
        texts = {one.file: bytearray(one.now) for one in self.texts}
        for splice in (splice for step in steps for splice in step.splices):
            text, end = texts.get(splice.file), splice.start + len(splice.old)
            if text is None or splice.start < 0 or bytes(text[splice.start : end]) != splice.old:
                return False
            text[splice.start : end] = splice.new
        return True


def _reversed_steps(done: tuple[Step, ...]) -> list[Step]:
    """The steps that take those done back, in the order in which they do."""
    return [
        replace(step, splices=tuple(_reversed(one) for one in reversed(step.splices)))
        for step in reversed(done)
    ]


def _reversed(splice: Splice) -> Splice:
    return Splice(splice.file, splice.start, splice.new, splice.old)
