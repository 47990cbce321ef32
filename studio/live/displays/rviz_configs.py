"""RvizConfigs: `.rviz` files of a document, to its displays and back."""

from __future__ import annotations

import asyncio
import os
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from msgspec import structs

from studio.debounce import Debouncer
from studio.errors import CommandError, NotAllowedError, RvizConfigError
from studio.live.displays.config_files import ConfigFiles, digest_of
from studio.live.displays.display_file import KeptDisplays
from studio.live.displays.display_list import DisplaySpec, Listening
from studio.protocol.commands import Commands, Limits, OnCopies, Scope
from studio.protocol.listeners import LastSent
from studio.protocol.roles import Role
from studio.protocol.rviz_configs import (
    CloseRvizConfig,
    ForgetRvizFile,
    GetRvizText,
    GetRvizView,
    ListRvizFiles,
    LossView,
    OpenRvizFile,
    OpenRvizText,
    RvizConfigOpened,
    RvizConfigState,
    RvizFiles,
    RvizFileSaved,
    RvizText,
    RvizView,
    SaveRvizFile,
    SetViewOptions,
    UndoRvizConfig,
    ViewValues,
)
from studio.rviz.config_text import write_tree

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from studio.live.displays.config_files import ConfigFolders
    from studio.live.displays.display_file import OpenedConfig
    from studio.live.displays.document_displays import DocumentDisplays
    from studio.protocol import Event
    from studio.protocol.listeners import Audience, Listener
    from studio.rviz.config import RvizConfig
    from studio.rviz.config_displays import ConfigDisplay, Loss
    from studio.rviz.views import ViewSpec

_QUIET_S: Final = 0.3
_AS_IT_IS: Final = GetRvizText()


class RvizConfigs:
    """Opens and saves `.rviz` files; what fails leaves all as it was.

    Args:
        displays: Those of the document.
        folders: Where files are.
        data_folder: Remembers which were opened.
        audience: Is sent which file is open, and whether it is changed.
    """

    def __init__(
        self,
        displays: DocumentDisplays,
        folders: ConfigFolders,
        data_folder: Path,
        audience: Audience,
    ) -> None:
        self._displays = displays
        self._files = ConfigFiles(folders, data_folder, lambda: displays.config)
        self._state = LastSent[RvizConfigState](audience)
        self._before: KeptDisplays | None = None
        self._after: KeptDisplays | None = None
        self._page = ""
        self._turn = asyncio.Lock()
        """One file is opened, saved or closed after the other."""
        self._checking = Debouncer(self._check, _QUIET_S)
        displays.on_change = self._checking.trigger

    def events(self) -> Iterable[Event]:
        """Yield the events for a new page."""
        config = self._displays.config
        name, path = ("", "") if config is None else (config.name, config.path)
        unchecked = RvizConfigState(name=name, path=path, changed=False, rviz1=False, undo=False)
        yield self._state.event or unchecked
        if self._state.event is None and config is not None:
            self._checking.trigger()

    async def open_path(self, path: Path) -> RvizConfigOpened:
        """Show a file that the command line names, wherever it is; it may be saved there, too.

        Raises:
            RvizConfigError: It cannot be read, or is no such file.
        """

        def read() -> tuple[str, str]:
            try:
                return path.read_bytes().decode("utf-8"), os.path.realpath(path)
            except (OSError, UnicodeDecodeError) as error:
                raise RvizConfigError(str(error), name=str(path)) from error

        text, self._files.named = await asyncio.to_thread(read)
        opened = await self._open(text, path.name, self._files.named)
        self._page = opened.page
        return opened

    async def open_file(self, command: OpenRvizFile, who: Listener) -> RvizConfigOpened:
        """Show a file below the folders that may be read, or that the command line named.

        Raises:
            NotAllowedError: Only presenters read files.
            PackageError: It is no such file, or cannot be read.
            RvizConfigError: It is no such file.
        """
        if not who.role.includes(Role.PRESENTER):
            raise NotAllowedError(who.role, "open a file of this machine")
        data, path = await asyncio.to_thread(self._files.read, command.path)
        try:
            text = data.decode("utf-8")
        except UnicodeDecodeError as error:
            raise RvizConfigError("it is no text in UTF-8", name=path.name) from error
        return await self._open(text, path.name, str(path), command.request)

    async def open_text(self, command: OpenRvizText) -> RvizConfigOpened:
        """Show a file that a browser has.

        Raises:
            RvizConfigError: It is no such file.
        """
        return await self._open(command.text, command.name, "", command.request)

    async def view(self, command: GetRvizView, who: Listener) -> RvizView:
        """Return the view of the file and, to the first presenter who asks, its page settings."""
        page = ""
        if who.role.includes(Role.PRESENTER):
            page, self._page = self._page, ""
        config = self._displays.config
        view = config and await asyncio.to_thread(_view_of, config.rest)
        return RvizView(request=command.request, view=view, page=page)

    async def text(self, command: GetRvizText) -> RvizText:
        """Return the text of a file with all that is shown."""
        text = await self._written(command)
        return RvizText(request=command.request, name=self._name, text=text)

    async def save(self, command: SaveRvizFile) -> RvizFileSaved:
        """Write a file with all that is shown.

        Raises:
            CommandError: No path is given, and no file was opened.
            PackageError: It leads out of the folders that may be written.
            NotSavedError: The disk refuses it.
        """
        async with self._turn:
            path = await asyncio.to_thread(self._files.target, command.path)
            text = await self._written(command)
            write = partial(self._files.write, path, text, replace=command.replace)
            lost = await asyncio.to_thread(write)
            if not lost:
                await self._take_saved(text, path)
        return RvizFileSaved(
            request=command.request,
            path=str(path),
            is_there=lost != "",
            changed=lost == "changes",
        )

    async def undo(self, _: UndoRvizConfig) -> None:
        """Show what was shown before the last file.

        Raises:
            CommandError: Something was changed since.
        """
        async with self._turn:
            before = self._before
            if before is None or self._displays.kept != self._after:
                raise CommandError("What was shown before cannot be brought back any more.")
            self._before = self._after = None
            self._displays.replace_all(before)
            await self._checked_now()
        await self._displays.connect_if_needed()

    async def close_config(self, _: CloseRvizConfig) -> None:
        """Forget the file; what is shown stays."""
        async with self._turn:
            self._displays.keep_beside(config=None)
            await self._checked_now()

    def set_options(self, command: SetViewOptions) -> None:
        """Change background or frame rate."""
        changes: dict[str, Any] = {}
        if command.background is not None:
            changes["background"] = command.background.lower()
        if command.frame_rate is not None:
            changes["frame_rate"] = command.frame_rate
        self._displays.keep_beside(**changes)

    async def files(self, command: ListRvizFiles | ForgetRvizFile) -> RvizFiles:
        """Return the files opened lately, and those of the robot's packages."""
        if isinstance(command, ForgetRvizFile):
            self._files.forget(command.path)
        files, folder = await asyncio.to_thread(self._files.listed)
        return RvizFiles(request=command.request, files=files, folder=folder)

    async def close(self) -> None:
        """Work no more."""
        await self._checking.close()

    async def _open(self, text: str, name: str, path: str, request: int = 0) -> RvizConfigOpened:
        try:
            config, losses = await asyncio.to_thread(_read_text, text)
        except RvizConfigError as error:
            raise RvizConfigError(error.reason, error.line, name) from error
        async with self._turn:
            kept = _kept_of(config, self._files.opened_as(name, path, text))
            kept = await asyncio.to_thread(_as_clean, kept)
            before = self._displays.kept
            self._displays.replace_all(kept)
            self._before, self._after = before, self._displays.kept
            if path:
                self._files.note(path, name)
            await self._checked_now()
        await self._displays.connect_if_needed()
        return _opened(config, losses, name, request)

    @property
    def _name(self) -> str:
        config = self._displays.config
        return config.name if config else self._files.proposed_name

    async def _written(self, asked: GetRvizText | SaveRvizFile = _AS_IT_IS) -> str:
        kept, root = self._displays.kept, self._displays.fixed_frame_in_use
        return await asyncio.to_thread(_text_of, kept, root, asked)

    async def _take_saved(self, text: str, path: Path) -> None:
        """From now on this is the file that is open."""
        config, _ = await asyncio.to_thread(_read_text, text)
        read = self._files.opened_as(path.name, str(path), text)
        opened = _opened_of(config, structs.replace(read, digest=digest_of(text)))
        shown = [(one.kind, one.name) for one in self._displays.kept.displays]
        if shown == [(one.kind, one.name) for one in config.displays]:
            self._displays.set_entries([one.entry for one in config.displays])
        self._displays.views.note_saved(config.views)
        self._displays.tools.note_saved(config.tools)
        self._displays.keep_beside(config=opened)
        self._files.note(str(path), path.name)
        await self._checked_now()

    async def _checked_now(self) -> None:
        self._checking.cancel()
        await self._check()

    async def _check(self) -> None:
        """Send which file is open, and whether saving would change it."""
        kept = self._displays.kept
        config = kept.config
        changed = False
        if config is not None:
            text = await self._written()
            changed = config.digest != digest_of(text)
        undo = self._before is not None and self._displays.kept == self._after
        if not undo:
            self._before = self._after = None
        self._state.send(
            RvizConfigState(
                name=config.name if config else "",
                path=config.path if config else "",
                changed=changed,
                rviz1=await asyncio.to_thread(_is_of_rviz1, kept),
                undo=undo,
            )
        )


_RATE: Final = Limits(per_second=5)
"""Each reads or writes a whole file."""
COMMANDS: Final = Commands[RvizConfigs](Scope.DOCUMENT)
COMMANDS.controller(
    OpenRvizFile,
    lambda configs, c, who: configs.open_file(c, who),
    limits=_RATE,
    on_copies=OnCopies.REFUSED,
)
COMMANDS.controller(
    OpenRvizText,
    lambda configs, c, _: configs.open_text(c),
    limits=_RATE,
    on_copies=OnCopies.REFUSED,
)
COMMANDS.viewer(GetRvizView, lambda configs, c, who: configs.view(c, who), limits=_RATE)
COMMANDS.viewer(GetRvizText, lambda configs, c, _: configs.text(c), limits=_RATE)
COMMANDS.presenter(SaveRvizFile, lambda configs, c, _: configs.save(c))
COMMANDS.controller(
    UndoRvizConfig, lambda configs, c, _: configs.undo(c), on_copies=OnCopies.REFUSED
)
COMMANDS.controller(CloseRvizConfig, lambda configs, c, _: configs.close_config(c))
COMMANDS.controller(SetViewOptions, lambda configs, c, _: configs.set_options(c))
COMMANDS.presenter(ListRvizFiles, lambda configs, c, _: configs.files(c))
COMMANDS.presenter(ForgetRvizFile, lambda configs, c, _: configs.files(c))


def _read_text(text: str) -> tuple[RvizConfig, tuple[Loss, ...]]:
    from studio.rviz.config import read_config  # noqa: PLC0415 - imports all displays

    return read_config(text)


def _view_of(rest: dict[str, Any]) -> ViewValues | None:
    from studio.rviz.config import current_view  # noqa: PLC0415 - imports all displays

    return _view_values(current_view(rest))


def _view_values(view: ViewSpec | None) -> ViewValues | None:
    return view and ViewValues(kind=view.kind, name=view.name, values=dict(view.values))


def _is_of_rviz1(kept: KeptDisplays) -> bool:
    from studio.rviz.config import is_of_rviz1  # noqa: PLC0415 - imports all displays

    return kept.config is not None and is_of_rviz1(_config_of(kept, None))


def _text_of(kept: KeptDisplays, root: str, asked: GetRvizText | SaveRvizFile) -> str:
    from studio.rviz.config import for_rviz2, tree_of  # noqa: PLC0415 - imports all displays
    from studio.rviz.config_page import PAGE, page_entry  # noqa: PLC0415
    from studio.rviz.config_values import entry_at  # noqa: PLC0415

    config = replace(_config_of(kept, asked.view), root=root)
    tree = tree_of(for_rviz2(config) if asked.rviz2 else config)
    if asked.page:
        tree |= {PAGE: page_entry(asked.page, entry_at(tree, PAGE))}
    return write_tree(tree)


def _config_of(kept: KeptDisplays, view: ViewValues | None) -> RvizConfig:
    from studio.rviz.config import RvizConfig  # noqa: PLC0415 - imports all displays
    from studio.rviz.tools import default_tools  # noqa: PLC0415
    from studio.rviz.views import ViewSpec  # noqa: PLC0415

    config = kept.config
    seen = None if view is None else ViewSpec(view.kind, view.name, view.values).checked()
    return RvizConfig(
        displays=tuple(map(_config_display, kept.displays)),
        groups={} if config is None else config.groups,
        groups_off=kept.groups_off,
        groups_empty={} if config is None else config.groups_empty,
        fixed_frame=kept.fixed_frame,
        background=kept.background,
        frame_rate=kept.frame_rate,
        tools=kept.tools or (() if config is not None else default_tools()),
        views=kept.views,
        view=seen,
        rest={} if config is None else config.rest,
    )


def _as_clean(kept: KeptDisplays) -> KeptDisplays:
    """Return it with its file noted as it is written without a change."""
    assert kept.config is not None
    digest = digest_of(_text_of(kept, "", _AS_IT_IS))
    return structs.replace(kept, config=structs.replace(kept.config, digest=digest))


def _config_display(spec: DisplaySpec) -> ConfigDisplay:
    from studio.rviz.config_displays import ConfigDisplay  # noqa: PLC0415 - imports all displays

    listening = spec.listening
    return ConfigDisplay(
        spec.kind,
        spec.name,
        spec.enabled,
        spec.group,
        spec.topic,
        listening.reliable,
        listening.latched,
        listening.depth,
        spec.values,
        spec.entry,
    )


def _kept_of(config: RvizConfig, opened: OpenedConfig) -> KeptDisplays:
    """Return what a document keeps of a file."""
    return KeptDisplays(
        displays=tuple(map(_spec_of, config.displays)),
        groups_off=config.groups_off,
        fixed_frame=config.fixed_frame,
        background=config.background,
        frame_rate=config.frame_rate,
        tools=config.tools,
        views=config.views,
        config=_opened_of(config, opened),
    )


def _opened_of(config: RvizConfig, opened: OpenedConfig) -> OpenedConfig:
    """Return it with what of the file the displays do not say."""
    groups, empty = dict(config.groups), dict(config.groups_empty)
    return structs.replace(opened, groups=groups, groups_empty=empty, rest=config.rest)


def _spec_of(one: ConfigDisplay) -> DisplaySpec:
    return DisplaySpec(
        "",
        one.kind,
        one.name,
        one.topic,
        one.enabled,
        one.group,
        Listening(one.reliable, one.latched, one.depth),
        one.values,
        one.entry,
    )


def _opened(
    config: RvizConfig, losses: tuple[Loss, ...], name: str, request: int
) -> RvizConfigOpened:
    from studio.rviz.config_page import page_of  # noqa: PLC0415 - imports all displays

    return RvizConfigOpened(
        request=request,
        name=name,
        displays=sum("/" not in one.kind for one in config.displays),
        tools=len(config.tools),
        views=len(config.views),
        losses=tuple(LossView(reason=one.reason, what=one.what, names=one.names) for one in losses),
        view=_view_values(config.view),
        page=page_of(config.rest),
    )
