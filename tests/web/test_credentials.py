from __future__ import annotations

import os
import stat
import sys
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.engine.roles import Role
from studio.errors import DataFolderError
from studio.web.credentials import Credentials, cookie_key, new_token

if TYPE_CHECKING:
    from pathlib import Path

CREDENTIALS = Credentials("secret", b"k" * 32)
DAY_S = 24 * 3600.0


def test_each_proof_is_of_one_role_and_no_other():
    proofs = {CREDENTIALS.token_of(role) for role in Role}
    proofs |= {CREDENTIALS.cookie_of(role) for role in Role}
    assert len(proofs) == 4
    for role in Role:
        assert CREDENTIALS.role_of_token(CREDENTIALS.token_of(role) or "") is role
        assert CREDENTIALS.role_of_cookie(CREDENTIALS.cookie_of(role)) is role
        assert CREDENTIALS.role_of_cookie(CREDENTIALS.token_of(role) or "") is None
        assert CREDENTIALS.role_of_token(CREDENTIALS.cookie_of(role)) is None


@given(st.text())
def test_nothing_else_proves_a_role(given_text: str):
    proofs = {CREDENTIALS.token_of(role) for role in Role}
    if given_text not in proofs:
        assert CREDENTIALS.role_of_token(given_text) is None
    assert CREDENTIALS.role_of_cookie(given_text) is None


@pytest.mark.parametrize("given_text", ["", "None", "\0"])
def test_without_a_token_no_token_proves_anything(given_text: str):
    assert Credentials(None, b"k" * 32).role_of_token(given_text) is None


def test_tokens_are_long_and_new_each_time():
    assert len({new_token() for _ in range(100)}) == 100
    assert min(len(new_token()) for _ in range(100)) >= 32


def test_secrets_are_not_shown():
    assert "secret" not in repr(CREDENTIALS)


def test_the_cookie_key_is_kept_for_a_day_and_private(tmp_path: Path):
    key = cookie_key(tmp_path, now_s=0)
    file = tmp_path / "cookie.key"
    os.utime(file, (DAY_S, DAY_S))
    assert cookie_key(tmp_path, now_s=DAY_S + 1) == key
    assert cookie_key(tmp_path, now_s=2 * DAY_S + 1) != key
    if sys.platform != "win32":
        assert stat.S_IMODE(file.stat().st_mode) == 0o600
    assert [one.name for one in tmp_path.iterdir()] == ["cookie.key"]


@pytest.mark.parametrize("content", [b"", b"short", b"x" * 33])
def test_a_broken_key_is_made_anew(tmp_path: Path, content: bytes):
    file = tmp_path / "cookie.key"
    file.write_bytes(content)
    key = cookie_key(tmp_path, now_s=file.stat().st_mtime)
    assert len(key) == 32
    assert key != content


def test_a_data_folder_that_cannot_be_written_is_a_sentence(tmp_path: Path):
    (tmp_path / "cookie.key").mkdir()
    with pytest.raises(DataFolderError, match="choose --data-dir"):
        cookie_key(tmp_path, now_s=0)
