from __future__ import annotations

import stat
from typing import TYPE_CHECKING

import pytest
from cryptography import x509

from studio.errors import SettingsError
from studio.server.certificate import check_pair, fingerprint, own_certificate

if TYPE_CHECKING:
    from pathlib import Path

NAMES = ["127.0.0.1", "::1", "robots.local"]


def test_it_is_made_once_and_its_key_is_its_owners_alone(tmp_path: Path):
    certificate, key = own_certificate(tmp_path, NAMES)
    assert stat.S_IMODE(key.stat().st_mode) == 0o600
    check_pair(certificate, key)
    before = certificate.read_bytes()
    assert own_certificate(tmp_path, NAMES[:2]) == (certificate, key)
    assert certificate.read_bytes() == before
    assert len(fingerprint(certificate).split(":")) == 32


def test_it_is_made_anew_for_another_name_and_when_it_is_broken(tmp_path: Path):
    certificate, key = own_certificate(tmp_path, NAMES)
    before = certificate.read_bytes()
    own_certificate(tmp_path, [*NAMES, "203.0.113.5"])
    renewed = certificate.read_bytes()
    assert renewed != before
    certificate.write_text("no certificate")
    own_certificate(tmp_path, NAMES)
    check_pair(certificate, key)


def test_it_names_all_by_which_browsers_come(tmp_path: Path):
    certificate, _ = own_certificate(tmp_path, NAMES)
    names = x509.load_pem_x509_certificate(certificate.read_bytes()).extensions
    found = names.get_extension_for_class(x509.SubjectAlternativeName).value
    named = [str(one.value) for one in found]
    assert named == NAMES


def test_files_that_do_not_belong_together_are_refused_in_one_sentence(tmp_path: Path):
    (tmp_path / "one").mkdir()
    (tmp_path / "other").mkdir()
    certificate, _ = own_certificate(tmp_path / "one", NAMES)
    _, key = own_certificate(tmp_path / "other", NAMES)
    with pytest.raises(SettingsError, match="--tls-cert and --tls-key"):
        check_pair(certificate, key)
    with pytest.raises(SettingsError, match="--tls-cert and --tls-key"):
        check_pair(tmp_path / "none.pem", key)
    with pytest.raises(SettingsError, match="no certificate"):
        fingerprint(key)
