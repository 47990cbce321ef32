"""The variants of an open document: kept beside its file, applied in one step, compared."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from studio.debounce import Throttle
from studio.description.editing.undo import Change
from studio.description.editing.variants import VARIANT_LIMIT, read_variants, write_variants
from studio.documents.file_watch import FileWatch
from studio.documents.side_file import ItemKind, NamedItems
from studio.errors import CommandError
from studio.protocol.commands import Commands, Scope
from studio.protocol.listeners import LastSent
from studio.protocol.variants import (
    ApplyVariant,
    CompareVariants,
    DeleteVariant,
    RenameVariant,
    SaveVariant,
    Side,
    UpdateVariant,
    VariantApplied,
    Variants,
    VariantSaved,
    VariantText,
    VariantView,
    shown,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from studio.description.editing.variants import Variant
    from studio.description.values import Edit
    from studio.documents.edits import Edits
    from studio.documents.variants.comparison import VariantComparison
    from studio.documents.variants.recipes import Recipe, RecipeBook
    from studio.documents.workspace import Workspace
    from studio.protocol import Event
    from studio.protocol.listeners import Audience


_FIRST_S: Final = 0.02
"""The edit that gave cause goes out first."""
_PAUSE_S: Final = 0.15
"""Between two updates during a drag: a table that changes faster cannot be read."""
_TEXTS_SHOWN: Final = 50
_SHELF: Final = ItemKind("variant", read_variants, write_variants)


class NamedVariants:
    """Knows the variant that the robot is in, and carries out the commands about variants.

    Args:
        workspace: The texts.
        edits: Runs the edits of a variant that is applied.
        book: Makes the recipes of states.
        comparison: Compares two of them.
        audience: Is sent the variants.
    """

    def __init__(
        self,
        workspace: Workspace,
        edits: Edits,
        book: RecipeBook,
        comparison: VariantComparison,
        audience: Audience,
    ) -> None:
        self._sources, self._edits = workspace.sources, edits
        self._book, self._comparison = book, comparison
        self._shelf = NamedItems(workspace.entry, workspace.served, _SHELF)
        self._active, self._modified = "", False
        self._steps = 0
        self._sent = LastSent[Variants](audience)
        self._watch = FileWatch(self._changed_on_disk)
        self._watch.watch({str(self._shelf.path)})
        self._throttle = Throttle(self._refresh, first_s=_FIRST_S, pause_s=_PAUSE_S)

    def events(self) -> Iterable[Event]:
        """Yield the events for a new page."""
        yield self._list()
        yield self._comparison.latest

    def trigger(self) -> None:
        """Compare soon, and not too often: something may have changed."""
        self._throttle.trigger()

    async def close(self) -> None:
        """End what runs for it."""
        await self._throttle.close()
        await asyncio.gather(self._watch.close(), self._comparison.close())

    async def save(self, command: SaveVariant | UpdateVariant) -> VariantSaved:
        """Keep the present state, as a new variant or in one that there is.

        Raises:
            CommandError: The name is taken, empty or unknown, or there are too many.
            VariantsFileError: The file as it is cannot be read.
            NotSavedError: It cannot be written.
        """
        await self._book.read()
        present = self._book.present()
        if isinstance(command, SaveVariant):
            name = self._shelf.free_name(command.name)
            if len(self._shelf.items) >= VARIANT_LIMIT:
                raise CommandError(f"There are {VARIANT_LIMIT} variants: delete one first.")
            made = self._book.as_variant(name, command.note.strip(), present)
            self._put((*self._shelf.items, made))
        else:
            known = self._shelf.find(command.name)
            made = self._book.as_variant(known.name, known.note, present)
            self._replace(known.name, made)
        self._active = made.name
        self._send()
        left_out = tuple(
            f"{file} has unsaved edits beside its values; a variant does not hold them."
            for file in present.edited_otherwise
        )
        return VariantSaved(request=command.request, left_out=left_out)

    async def apply(self, command: ApplyVariant) -> VariantApplied:
        """Change the robot to a variant, or to its saved state, as one undo step.

        Raises:
            CommandError: There is no such variant.
        """
        if command.name:
            await self._book.read([self._shelf.find(command.name)])
            variant = self._shelf.find(command.name)
            wanted = self._book.of_variant(variant).arguments
            edits, left_out = self._book.edits_to(variant)
            label = f"Variant {variant.name}"
        else:
            wanted, label = self._book.saved().arguments, "As in the file"
            edits, left_out = self._book.edits_to_saved(), ()
        self._active = command.name
        change = self._step(label, wanted, edits)
        if edits or change.arguments is not None:
            await self._edits.follow(change)
        await self._find_active()
        self._send()
        return VariantApplied(request=command.request, left_out=left_out)

    def rename(self, command: RenameVariant) -> None:
        """Give a variant another name and note; errors as for `save`."""
        known = self._shelf.find(command.name)
        name = known.name
        if command.new_name.strip() != name:
            name = self._shelf.free_name(command.new_name)
        self._replace(known.name, replace(known, name=name, note=command.note.strip()))
        if self._active == known.name:
            self._active = name
        self._comparison.rename(known.name, name)
        self._send()

    def delete(self, name: str) -> None:
        """Forget a variant; errors as for `save`."""
        known = self._shelf.find(name)
        self._put([one for one in self._shelf.items if one.name != known.name])
        if self._active == name:
            self._active = ""
        self._send()

    def compare(self, sides: tuple[Side, Side] | None) -> None:
        """Compare two states from now on, or none.

        Raises:
            CommandError: They are the same, or one of them is unknown.
        """
        for side in sides or ():
            if side.kind == "variant":
                self._shelf.find(side.name)
        self._comparison.choose(sides)
        self.trigger()

    def _step(self, label: str, wanted: dict[str, str], edits: Sequence[Edit]) -> Change:
        """Do it to the sources, arguments and texts as one step; what is to be run then."""
        sources, now = self._sources, self._sources.arguments
        self._steps += 1
        gesture = f"variant {self._steps}"
        values = {
            name: wanted.get(name)
            for name in sorted(now.keys() | wanted.keys())
            if now.get(name) != wanted.get(name)
        }
        if values:
            sources.set_arguments(values, label, gesture)
        for edit in edits:
            sources.edit(edit, label, gesture, is_value=False)
        return Change(label, tuple(edits), sources.arguments if values else None)

    def _put(self, variants: Sequence[Variant]) -> None:
        self._shelf.put(variants)
        self.trigger()

    def _replace(self, name: str, new: Variant) -> None:
        self._put([new if one.name == name else one for one in self._shelf.items])

    async def _changed_on_disk(self, files: set[str]) -> None:
        if str(self._shelf.path) in files:
            self._shelf.refresh()
        if files & self._comparison.files:
            self._comparison.remake()
        self.trigger()

    async def _refresh(self) -> None:
        await self._find_active()
        self._send()
        await self._comparison.follow(self._present, self._recipe_of)
        self._watch.watch({str(self._shelf.path), *self._comparison.files})

    async def _present(self) -> Recipe:
        await self._book.read(self._shelf.items)
        return self._book.present()

    def _recipe_of(self, side: Side) -> Recipe | None:
        if side.kind == "saved":
            return self._book.saved()
        known = next((one for one in self._shelf.items if one.name == side.name), None)
        return self._book.of_variant(known) if known else None

    async def _find_active(self) -> None:
        """Find out which variant the robot is."""
        if self._shelf.items:
            await self._book.read(self._shelf.items)
        names = {one.name: one for one in self._shelf.items}
        if self._active not in names:
            self._active = ""
        if not names:
            self._modified = not self._book.is_saved
            return
        present = self._book.present()
        is_pure = not present.edited_otherwise
        known = self._book.of_variant(names[self._active]) if self._active else self._book.saved()
        if is_pure and present == known:
            self._modified = False
            return
        same = (name for name, one in names.items() if self._book.of_variant(one) == present)
        now = "" if self._book.is_saved else next(same, None)
        self._modified = now is None
        if now is not None:
            self._active = now

    def _list(self) -> Variants:
        shelf = self._shelf
        return Variants(
            variants=tuple(map(_view, shelf.items)),
            active=self._active,
            modified=self._modified,
            path=str(shelf.path),
            only_here=shelf.only_here,
            trouble=shelf.trouble,
        )

    def _send(self) -> None:
        self._sent.send(self._list())


COMMANDS: Final = Commands[NamedVariants](Scope.DOCUMENT)
COMMANDS.controller(SaveVariant, lambda variants, c, _: variants.save(c))
COMMANDS.controller(UpdateVariant, lambda variants, c, _: variants.save(c))
COMMANDS.controller(ApplyVariant, lambda variants, c, _: variants.apply(c))
COMMANDS.controller(RenameVariant, lambda variants, c, _: variants.rename(c))
COMMANDS.controller(DeleteVariant, lambda variants, c, _: variants.delete(c.name))
COMMANDS.controller(CompareVariants, lambda variants, c, _: variants.compare(c.sides))


def _view(variant: Variant) -> VariantView:
    texts = list(variant.texts.items())[:_TEXTS_SHOWN]
    return VariantView(
        name=variant.name,
        note=variant.note,
        arguments={
            name: None if value is None else shown(value)
            for name, value in variant.arguments.items()
        },
        texts=tuple(
            VariantText(file=name.file, name=shown(str(name)), text=shown(text))
            for name, text in texts
        ),
    )
