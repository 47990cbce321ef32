from __future__ import annotations

import os
import stat
import sys
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import DataFolderError, UnsafeKeyError
from studio.protocol.roles import Role
from studio.server.credentials import Credentials, cookie_key, new_token

if TYPE_CHECKING:
    from pathlib import Path

PROVEN = (Role.PRESENTER, Role.GUEST)
CREDENTIALS = Credentials("secret", b"k" * 32)
DAY_S = 24 * 3600.0


def test_each_proof_is_of_one_role_and_no_other():
    proofs = {CREDENTIALS.token_of(role) for role in PROVEN}
    proofs |= {CREDENTIALS.cookie_of(role) for role in PROVEN}
    assert len(proofs) == 4
    for role in PROVEN:
        assert CREDENTIALS.role_of_token(CREDENTIALS.token_of(role)) is role
        visitor = CREDENTIALS.visitor_of_cookie(CREDENTIALS.cookie_of(role))
        assert visitor is not None
        assert visitor.role is role
        assert CREDENTIALS.visitor_of_cookie(CREDENTIALS.token_of(role)) is None
        assert CREDENTIALS.role_of_token(CREDENTIALS.cookie_of(role)) is None


def test_roles_of_the_class_are_proven_by_no_token_and_by_no_cookie_of_a_role():
    for role in set(Role) - set(PROVEN):
        assert CREDENTIALS.role_of_token(CREDENTIALS.token_of(role)) is None
        assert CREDENTIALS.visitor_of_cookie(CREDENTIALS.cookie_of(role)) is None


@given(st.text())
def test_nothing_else_proves_a_role(given_text: str):
    proofs = {CREDENTIALS.token_of(role) for role in PROVEN}
    if given_text not in proofs:
        assert CREDENTIALS.role_of_token(given_text) is None
    assert CREDENTIALS.visitor_of_cookie(given_text) is None


@pytest.mark.parametrize("given_text", ["", "None", "\0"])
def test_without_a_token_no_token_proves_anything(given_text: str):
    assert Credentials("", b"k" * 32).role_of_token(given_text) is None


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


@pytest.mark.parametrize("hours", [-23, -1, 0, 23])
def test_the_cookie_key_is_kept_though_the_clock_was_set_forth_or_back(tmp_path: Path, hours: int):
    key = cookie_key(tmp_path, now_s=0)
    written_s = (tmp_path / "cookie.key").stat().st_mtime
    assert cookie_key(tmp_path, written_s + hours * 3600) == key


def test_no_cookie_key_is_kept_that_seems_to_be_of_a_far_future(tmp_path: Path):
    key = cookie_key(tmp_path, now_s=0)
    written_s = (tmp_path / "cookie.key").stat().st_mtime
    assert cookie_key(tmp_path, written_s - DAY_S - 1) != key


@pytest.mark.parametrize("content", [b"", b"short", b"x" * 33])
def test_a_broken_key_is_made_anew(tmp_path: Path, content: bytes):
    file = tmp_path / "cookie.key"
    file.write_bytes(content)
    file.chmod(0o600)
    key = cookie_key(tmp_path, now_s=file.stat().st_mtime)
    assert len(key) == 32
    assert key != content


posix = pytest.mark.skipif(sys.platform == "win32", reason="files have an owner and a mode")


@posix
@pytest.mark.parametrize("mode", [0o640, 0o604, 0o660, 0o602])
def test_a_key_that_others_can_read_or_write_is_refused(tmp_path: Path, mode: int):
    cookie_key(tmp_path, now_s=0)
    (tmp_path / "cookie.key").chmod(mode)
    with pytest.raises(UnsafeKeyError, match="by other users"):
        cookie_key(tmp_path, now_s=0)


@posix
@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="root gives files away")
def test_a_key_of_another_user_is_refused(tmp_path: Path):
    cookie_key(tmp_path, now_s=0)
    os.chown(tmp_path / "cookie.key", 12345, -1)
    with pytest.raises(UnsafeKeyError, match="belongs to another user"):
        cookie_key(tmp_path, now_s=0)


@posix
def test_a_key_is_written_into_no_file_that_somebody_laid_in_its_way(tmp_path: Path):
    theirs = tmp_path / "theirs"
    theirs.write_bytes(b"")
    (tmp_path / f"cookie.key.{os.getpid()}").symlink_to(theirs)
    cookie_key(tmp_path, now_s=0)
    assert theirs.read_bytes() == b""
    (tmp_path / "cookie.key").unlink()
    (tmp_path / "cookie.key").symlink_to(theirs)
    with pytest.raises(DataFolderError):
        cookie_key(tmp_path, now_s=0)


def test_a_code_is_good_for_one():
    credentials = Credentials("secret", b"k" * 32)
    code = credentials.new_code()
    assert credentials.redeem("") is None
    assert credentials.redeem(code) is Role.PRESENTER
    assert credentials.redeem(code) is None


def test_revoking_ends_all_cookies_also_after_a_restart(tmp_path: Path):
    credentials = Credentials("secret", cookie_key(tmp_path, now_s=0), tmp_path)
    cookies = [credentials.cookie_of(role) for role in Role]
    credentials.revoke()
    written_s = (tmp_path / "cookie.key").stat().st_mtime
    again = Credentials("other", cookie_key(tmp_path, written_s), tmp_path)
    for cookie in cookies:
        assert credentials.visitor_of_cookie(cookie) is None
        assert again.visitor_of_cookie(cookie) is None
    assert again.visitor_of_cookie(credentials.cookie_of(Role.GUEST)) is not None


def test_a_data_folder_that_cannot_be_written_is_a_sentence(tmp_path: Path):
    (tmp_path / "cookie.key").mkdir()
    with pytest.raises(DataFolderError, match="choose --data-dir"):
        cookie_key(tmp_path, now_s=0)
