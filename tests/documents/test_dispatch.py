"""Every command finds the method that carries it out."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, get_args

import pytest

from studio import protocol as m
from studio.documents.dispatch import WORK, carry_out
from studio.live.connection.robots import EngineWireCommand
from tests.support.open_documents import engine, opened

if TYPE_CHECKING:
    from pathlib import Path

OF_THE_ENGINE = {
    *(m.Watch, m.OpenPath, m.CloseDocument, m.ListFolder),
    *(m.GetArguments, m.GetLink, m.OpenLink),
    m.ForgetWork,
    *get_args(m.LibraryCommand),
    *get_args(EngineWireCommand),
    *get_args(m.BridgeCommand),
}


def test_each_command_is_of_a_document_or_of_the_engine_never_both():
    commands = set(get_args(get_args(m.Command)[0]))
    assert commands - set(WORK) == OF_THE_ENGINE
    assert set(WORK) <= commands


def test_a_command_of_the_engine_is_no_work_for_a_document(tmp_path: Path):
    async def run() -> None:
        file = tmp_path / "r.urdf"
        file.write_text('<robot name="r"><link name="a"/></robot>')
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, file)
            with pytest.raises(TypeError, match="list_folder is the engine's own"):
                await carry_out(document, m.ListFolder(), ear)
            await carry_out(document, m.GetUrdf(request=7), ear)
            assert ear.last("urdf")["request"] == 7

    asyncio.run(run())
