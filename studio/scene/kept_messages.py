"""The messages of a view that still count, numbered in order: what a page misses, and no more.

Which message replaces which is as in viser's buffer, but for two things that the studio does at the
origin beside it (`studio.scene.graph`): a node that is made anew loses what was said of the earlier
one of its name, and the message that made a node holds its properties as they are now.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, TypeAlias, cast

from studio.scene.opened_frames import removal_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.scene.opened_frames import Fields, Message

Entity: TypeAlias = tuple[str, str]
"""Kind and id of a thing that messages make, change and remove; of a node its name."""
_SCENE: Final = "scene"


class KeptMessages:
    """Numbers messages as they come and keeps those that no later one has replaced."""

    def __init__(self) -> None:
        self.newest = 0
        """Number of the message that came last."""
        self._messages: dict[int, Message] = {}  # by number, ascending
        self._number_of: dict[str, int] = {}
        self._about: dict[Entity, set[str]] = {}
        """Keys of what was said of each thing, beside what made or removed it."""
        self._removals: dict[int, None] = {}

    def __len__(self) -> int:
        return len(self._messages)

    @property
    def removals(self) -> int:
        """How many removed nodes it still tells of."""
        return len(self._removals)

    def add(self, message: Message) -> None:
        """Keep one more, as the newest."""
        self.newest += 1
        slot = message.slot
        old = self._number_of.get(slot.key)
        if old is not None and slot.phase == "update_simple":  # most messages are
            del self._messages[old]
            self._messages[self.newest] = message
            self._number_of[slot.key] = self.newest
            return
        if slot.entity is not None and not self._make_way(slot.entity, message):
            return
        if old is not None and slot.key in self._number_of:
            self._drop(old)
        self._keep(self.newest, message)

    def _make_way(self, entity: Entity, message: Message) -> bool:
        """Let the others about a thing agree with a new one; False: it does not count."""
        phase = message.slot.phase
        if phase == "remove" or (phase == "create" and entity[0] == _SCENE):
            for old in self.about(entity):
                if old.slot.phase is not None:
                    self._drop(self.number_of(old))
        elif phase in ("update_dict", "update_simple"):
            made = self._made(entity)
            if made is not None and made.slot.phase == "remove":
                return False  # who comes later would draw a node that others do not have
            if made is not None and phase == "update_dict":
                _update(made, message)
        return True

    def since(self, number: int) -> list[Message]:
        """Return what still counts of what is newer than that, oldest first; all for -1."""
        if number < 0:
            return [m for m in self._messages.values() if m.slot.phase != "remove"]
        missed: list[Message] = []
        for at in reversed(self._messages):
            if at <= number:
                break
            missed.append(self._messages[at])
        missed.reverse()
        return missed

    def forget_removals(self, number: int) -> None:
        """Forget what was removed by messages up to that number, which every page has."""
        while self._removals and (first := next(iter(self._removals))) <= number:
            entity = self._messages[first].slot.entity
            assert entity is not None
            for message in self.about(entity):
                self._drop(self.number_of(message))
            self._drop(first)

    def renew(self, messages: Iterable[Message]) -> None:
        """Take the whole state anew, as new messages about what differs from the state of now."""
        state = KeptMessages()
        for message in messages:
            state.add(message)
        renewal = _Renewal(self, state)
        for held in (self._messages, self._number_of, self._about, self._removals):
            held.clear()
        for number in sorted(renewal.kept):
            self._keep(number, renewal.kept[number])
        for message in renewal.sent:
            self.newest += 1
            self._keep(self.newest, message)

    def same(self, message: Message) -> int | None:
        """Return the number of the message of this key that says the same; None: there is none."""
        number = self._number_of.get(message.slot.key)
        if number is None or self._messages[number].kind != message.kind:
            return None
        return number if self._messages[number].says_the_same(message) else None

    def number_of(self, message: Message) -> int:
        """Return the number of the message of this key, which there is."""
        return self._number_of[message.slot.key]

    def made(self) -> dict[Entity, Message]:
        """Return the messages that made the nodes that are there, oldest first."""
        return {
            m.slot.entity: m
            for m in self._messages.values()
            if m.slot.phase == "create" and m.slot.entity is not None
        }

    def about(self, entity: Entity) -> list[Message]:
        """Return what was said of a node beside what made it, oldest first."""
        numbers = sorted(self._number_of[key] for key in self._about.get(entity, ()))
        return [self._messages[number] for number in numbers]

    def numbered(self) -> dict[int, Message]:
        """Return all of them by their numbers, oldest first."""
        return self._messages

    def _keep(self, number: int, message: Message) -> None:
        slot = message.slot
        self._messages[number] = message
        self._number_of[slot.key] = number
        if slot.phase == "remove":
            self._removals[number] = None
        elif slot.phase != "create" and slot.entity is not None:
            self._about.setdefault(slot.entity, set()).add(slot.key)

    def _drop(self, number: int) -> None:
        slot = self._messages.pop(number).slot
        self._removals.pop(number, None)
        del self._number_of[slot.key]
        if slot.entity is not None and (about := self._about.get(slot.entity)) is not None:
            about.discard(slot.key)
            if not about:
                del self._about[slot.entity]

    def _made(self, entity: Entity) -> Message | None:
        """Return what made or removed it."""
        number = self._number_of.get(f"{entity[0]}:{entity[1]}:create-or-remove")
        return None if number is None else self._messages[number]


class _Renewal:
    """What stays of an old state and what is to be sent, so that pages of it have the new one."""

    def __init__(self, old: KeptMessages, new: KeptMessages) -> None:
        self._old, self._new = old, new
        self.kept: dict[int, Message] = {}
        """By the numbers that they have."""
        self.sent: list[Message] = []
        """What gets a new number, in order."""
        self._made_before = old.made()
        self._anew: set[Entity] = set()
        """What is made anew: all that is said of it is sent."""
        self._staying: dict[str, int] = {}
        """Numbers of updates of what is not made anew, by key."""
        self._remove(new.made())
        for message in new.numbered().values():
            self._take(message)

    def _remove(self, made: dict[Entity, Message]) -> None:
        gone = {e: m for e, m in self._made_before.items() if e not in made and e[0] == _SCENE}
        self.sent += [removal_of(create) for create in reversed(gone.values())]
        # A page removes a node with all that is below it.
        names = {name for _, name in gone}
        self._anew = {e for e in made if e[0] == _SCENE and _is_below(e[1], names)}
        for number, message in self._old.numbered().items():
            if message.slot.phase == "remove" and message.slot.entity not in made:
                self.kept[number] = message

    def _take(self, message: Message) -> None:
        slot = message.slot
        if slot.phase == "remove":
            return
        if slot.phase == "create" and slot.entity is not None:
            self._take_create(slot.entity, message)
            return
        at = None if slot.entity in self._anew else self._old.same(message)
        if slot.phase == "update_dict" and slot.entity in self._made_before:
            at = self._staying.get(slot.key)
        if at is None:
            self.sent.append(message)
        else:
            self.kept[at] = message

    def _take_create(self, entity: Entity, message: Message) -> None:
        before = self._made_before.get(entity)
        staying = self._updates_that_stay(entity)
        about = self._new.about(entity)
        props: set[str] = set()
        for update in about:
            if update.slot.phase == "update_dict" and update.slot.key not in staying:
                props |= update.fields()["updates"].keys()
        if (
            before is None
            or entity in self._anew
            or not self._has_all_of(about, entity)
            or not _differs_in_props_alone(before, message, props)
        ):
            self._anew.add(entity)
            self.sent.append(message)
            return
        self._staying |= staying
        self.kept[self._old.number_of(before)] = message
        said = {update.slot.key for update in about}
        for old in self._old.about(entity):
            if old.slot.key not in said:
                self.kept[self._old.number_of(old)] = old

    def _updates_that_stay(self, entity: Entity) -> dict[str, int]:
        """Return the numbers of updates that need not be sent, by key.

        All after the first that is sent are sent: of two for one property the later one counts.
        """
        staying: dict[str, int] = {}
        last = -1
        for update in self._new.about(entity):
            if update.slot.phase == "update_dict":
                at = self._old.same(update)
                if at is None or at < last:
                    break
                staying[update.slot.key] = last = at
        return staying

    def _has_all_of(self, about: list[Message], entity: Entity) -> bool:
        """Whether nothing is missing that was said of it and cannot be taken back."""
        said = {message.slot.key for message in about}
        return all(
            message.slot.key in said
            for message in self._old.about(entity)
            if message.slot.phase != "update_dict"
        )


def _differs_in_props_alone(before: Message, message: Message, props: set[str]) -> bool:
    """Whether two messages that made a node are the same but for some of these properties."""
    if before.kind != message.kind:
        return False
    if before.says_the_same(message):
        return True
    was, now = dict(before.fields()), dict(message.fields())
    props_were, props_are = was.pop("props", None), now.pop("props", None)
    if was != now or not isinstance(props_were, dict) or not isinstance(props_are, dict):
        return False
    old, new = cast("Fields", props_were), cast("Fields", props_are)
    return old.keys() == new.keys() and all(
        name in props or old[name] == value for name, value in new.items()
    )


def _is_below(name: str, others: set[str]) -> bool:
    """Whether a node is below one of those."""
    parts = name.split("/")
    return any("/".join(parts[:count]) in others for count in range(1, len(parts)))


def _update(made: Message, update: Message) -> None:
    """Let the message that made a node hold it as it is now."""
    props, updates = made.fields().get("props"), update.fields().get("updates")
    if isinstance(props, dict) and isinstance(updates, dict):
        cast("Fields", props).update(cast("Fields", updates))
