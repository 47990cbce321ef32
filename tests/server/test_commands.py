"""What the door takes of a command's text."""

from __future__ import annotations

import pytest

from studio.documents.engine import COMMANDS
from studio.errors import CommandError
from studio.protocol.commands import COMMAND_LIMIT_BYTES
from studio.protocol.publishing import Drive
from studio.server.commands import parse_command

DRIVE = Drive(topic="/cmd_vel", x=1.0).model_dump_json().encode()


def test_a_command_is_taken_up_to_its_own_limit():
    bytes_max = COMMANDS[Drive].limits.bytes_max
    assert parse_command(DRIVE.ljust(bytes_max)) == parse_command(DRIVE)
    with pytest.raises(CommandError, match=f"Drive of more than {bytes_max} bytes is not taken"):
        parse_command(DRIVE.ljust(bytes_max + 1))


def test_no_command_is_read_beyond_the_limit_of_all():
    with pytest.raises(CommandError, match=f"more than {COMMAND_LIMIT_BYTES} bytes is not read"):
        parse_command(DRIVE.ljust(COMMAND_LIMIT_BYTES + 1))
