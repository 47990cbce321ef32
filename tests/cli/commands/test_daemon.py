from __future__ import annotations

import pytest

from tests.support.command_line import studio


@pytest.mark.parametrize(
    ("verb", "said"),
    [
        ("start", "No daemon is needed"),
        ("stop", "There is no daemon to stop"),
        ("status", "The daemon is not running"),
    ],
)
def test_n7_there_is_no_daemon_which_is_said(verb: str, said: str):
    """Any line may say where the others are, also one that asks nobody."""
    ran = studio("daemon", verb, "--connect", "tcp/127.0.0.1:1", "--domain", "3", "--router", "off")
    assert ran.code == 0
    assert ran.out.startswith(said)
