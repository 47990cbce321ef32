"""From a parsed command to the document's method that carries it out."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

from studio.engine import messages as m
from studio.engine.listeners import tell

if TYPE_CHECKING:
    from studio.engine.document import Document
    from studio.engine.listeners import Listener


async def carry_out(document: Document, command: m.Command, listener: Listener) -> None:  # noqa: C901, PLR0912, PLR0915 - one arm a command
    """Carry out one command of a document; returns when it is done.

    Raises:
        StudioError: It cannot be done; the document is as before.
    """
    match command:
        case m.EditSite():
            await document.edit_site(command.site, command.text, command.gesture)
        case m.ResetSite():
            await document.reset_site(command.site)
        case m.SetArgument():
            await document.set_argument(command.name, command.value)
        case m.SetArguments():
            await document.set_arguments(command.values)
        case m.GetCollisions():
            tell(listener, document.disk.answer(command))
        case m.ResolveCollisions():
            await document.resolve_collisions(command.file, command.keep)
        case m.Undo():
            await document.undo()
        case m.Redo():
            await document.redo()
        case m.Save():
            await document.save()
        case m.Reload():
            await document.reload()
        case m.ChoosePackage():
            await document.choose_package(command.name, command.folder)
        case m.SetJoints():
            document.motion.set(command.positions)
        case m.ZeroJoints():
            document.motion.zero()
        case m.RandomizeJoints():
            document.motion.randomize()
        case m.AnimateJoints():
            document.motion.animate(running=command.running)
        case m.SetDisplay():
            document.set_display(command.display, command.name, value=command.value)
        case m.GetUrdf():
            tell(listener, m.Urdf(request=command.request, text=document.urdf()))
        case m.GetText():
            tell(listener, document.texts.answer(command, listener.role))
        case m.GetOrigin():
            tell(listener, await document.origins.origin(command, listener))
        case m.GetEffects():
            tell(listener, await document.origins.effects(command, listener))
        case m.GetOutline():
            tell(listener, await document.language.outline(command, listener))
        case m.LookUp():
            tell(listener, await document.language.look_up(command, listener))
        case m.GetReferences():
            tell(listener, await document.language.references(command, listener))
        case m.Complete():
            tell(listener, await document.language.complete(command, listener))
        case m.EditText():
            await document.edit_text(command)
        case m.SaveVariant() | m.UpdateVariant():
            tell(listener, document.variants.save(command))
        case m.ApplyVariant():
            tell(listener, await document.variants.apply(command))
        case m.RenameVariant():
            document.variants.rename(command)
        case m.DeleteVariant():
            document.variants.delete(command.name)
        case m.CompareVariants():
            document.variants.compare(command.sides)
        case (
            m.GetArguments()
            | m.GetLink()
            | m.OpenLink()
            | m.OpenPath()
            | m.CloseDocument()
            | m.ListFolder()
            | m.Watch()
        ):
            raise TypeError(f"{command.type} is the engine's own command")
        case _:
            assert_never(command)
