"""Undo and redo: a stack of steps, each a list of splices and changed arguments.

Edits of one gesture (one drag, one round of typing) are one step; a gesture that ends where it
began leaves none. `KeptSources` is what outlasts the process: edited texts, arguments and steps.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

from studio.description.values import Edit

_SHOWN_LENGTH = 40
_STEPS_KEPT = 1000


@dataclass(frozen=True, slots=True)
class Splice:
    """At byte `start` of a file, `new` replaced `old`."""

    file: str
    start: int
    old: bytes
    new: bytes

    def forward(self) -> Edit:
        """Return the edit that does it."""
        return Edit(self.file, self.start, self.start + len(self.old), self.new)

    def backward(self) -> Edit:
        """Return the edit that takes it back."""
        return Edit(self.file, self.start, self.start + len(self.new), self.old)

    def then(self, later: Splice) -> Splice | None:
        """Return both as one, when the later one touched nothing but what this one wrote."""
        begin = later.start - self.start
        end = begin + len(later.old)
        if self.file != later.file or not 0 <= begin <= end <= len(self.new):
            return None
        return replace(self, new=self.new[:begin] + later.new + self.new[end:])


@dataclass(frozen=True, slots=True)
class ArgumentChange:
    """A change of an argument passed as `name:=value`; None: not passed."""

    name: str
    old: str | None
    new: str | None


@dataclass(frozen=True)
class Step:
    """One entry of the undo list; `is_value`: its bytes are a whole value, worth showing."""

    name: str
    splices: tuple[Splice, ...] = ()
    arguments: tuple[ArgumentChange, ...] = ()
    gesture: str = ""
    is_value: bool = True

    @cached_property
    def label(self) -> str:
        """The line in the undo list, e.g. `wheel_radius 0.1 → 0.12`."""
        texts = self._texts()
        if texts is None or max(map(len, texts)) > _SHOWN_LENGTH:
            return self.name
        old, new = (text or "(empty)" for text in texts)
        return f"{self.name} {old} → {new}"

    def _texts(self) -> tuple[str, str] | None:
        """Return the one value that changed, before and after."""
        if len(self.arguments) == 1 and not self.splices:
            return (self.arguments[0].old or "", self.arguments[0].new or "")
        if self.arguments or len(self.splices) != 1 or not self.is_value:
            return None
        (splice,) = self.splices
        return (splice.old.decode("utf-8", "replace"), splice.new.decode("utf-8", "replace"))

    @property
    def is_nothing(self) -> bool:
        """Whether it ends where it began."""
        kept = all(change.old == change.new for change in self.arguments)
        return kept and all(splice.old == splice.new for splice in self.splices)

    def with_later(self, later: Step) -> Step:
        """Return this step and a later one of the same gesture, as one."""
        splices = list(self.splices)
        for splice in later.splices:
            joined = splices[-1].then(splice) if splices else None
            splices[-1:] = [joined] if joined else [*splices[-1:], splice]
        return replace(
            self,
            splices=tuple(one for one in splices if one.old != one.new),
            arguments=_joined(self.arguments, later.arguments),
            is_value=self.is_value and later.is_value,
        )


def _joined(
    first: tuple[ArgumentChange, ...], later: tuple[ArgumentChange, ...]
) -> tuple[ArgumentChange, ...]:
    """Both, each name once: from what it was to what it is."""
    known = {change.name: change for change in first}
    for change in later:
        before = known.get(change.name)
        known[change.name] = replace(change, old=before.old) if before else change
    return tuple(known.values())


@dataclass(frozen=True, slots=True)
class Change:
    """What an undo or redo did. `arguments` are all of them, None when unchanged."""

    label: str
    edits: tuple[Edit, ...] = ()
    arguments: dict[str, str] | None = None

    def then(self, later: Change) -> Change:
        """Return both as one, under the later one's name."""
        arguments = self.arguments if later.arguments is None else later.arguments
        return Change(later.label, self.edits + later.edits, arguments)


@dataclass(slots=True)
class UndoStack:
    """The steps done and those taken back, newest last in both."""

    done: list[Step] = field(default_factory=list[Step])
    undone: list[Step] = field(default_factory=list[Step])
    _gesture: str = ""
    """The gesture that still grows the newest step."""

    def push(self, step: Step) -> None:
        """Add a step; it grows the newest one when both are of the same gesture."""
        newest = self.done.pop().with_later(step) if self._grows_by(step) else step
        self.undone.clear()
        if newest.is_nothing:
            self._gesture = ""
            return
        self.done.append(newest)
        del self.done[:-_STEPS_KEPT]
        self._gesture = step.gesture

    def _grows_by(self, step: Step) -> bool:
        is_same = bool(step.gesture) and step.gesture == self._gesture and bool(self.done)
        return is_same and _can_grow(self.done[-1], step)

    def undo(self) -> Step | None:
        """Move the newest step to those taken back; None when there is none."""
        self.end_gesture()
        if not self.done:
            return None
        self.undone.append(self.done.pop())
        return self.undone[-1]

    def redo(self) -> Step | None:
        """Move the last step taken back to those done; None when there is none."""
        self.end_gesture()
        if not self.undone:
            return None
        self.done.append(self.undone.pop())
        return self.done[-1]

    def files(self) -> frozenset[str]:
        """Return every file that a step changed or would change."""
        steps = (*self.done, *self.undone)
        return frozenset(splice.file for step in steps for splice in step.splices)

    def end_gesture(self) -> None:
        """Make the next edit a new step, even of the same gesture."""
        self._gesture = ""


def _can_grow(newest: Step, step: Step) -> bool:
    """Arguments of other names are another step."""
    names = {change.name for change in newest.arguments}, {c.name for c in step.arguments}
    return not all(names) or names[0] == names[1]


@dataclass(frozen=True, slots=True)
class KeptText:
    """One file: as it was read from disk, and as it is edited."""

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
    """Return the steps that take those done back, in the order in which they do."""
    return [
        replace(step, splices=tuple(_reversed(one) for one in reversed(step.splices)))
        for step in reversed(done)
    ]


def _reversed(splice: Splice) -> Splice:
    return Splice(splice.file, splice.start, splice.new, splice.old)
