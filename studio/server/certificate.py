"""A certificate that the studio makes for itself, for a class without one of a public authority."""

from __future__ import annotations

import ipaddress
import ssl
from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING, Final

from studio.errors import DataFolderError, SettingsError
from studio.files import write_whole

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from cryptography.x509 import Certificate, GeneralName

_LIFE: Final = timedelta(days=365)
_RENEWED_BEFORE: Final = timedelta(days=14)
_CLOCKS_APART: Final = timedelta(days=1)


def own_certificate(folder: Path, names: Sequence[str]) -> tuple[Path, Path]:
    """Return the files of certificate and key, made anew when they are old or lack a name.

    Args:
        folder: Where they are kept; only the owner may read the key.
        names: Host names and addresses under which browsers come.

    Raises:
        DataFolderError: They cannot be written.
    """
    certificate, key = folder / "tls.crt", folder / "tls.key"
    if not (_is_good(certificate, names) and _is_pair(certificate, key)):
        made, secret = _make(names)
        try:
            write_whole(key, secret, mode=0o600)
            write_whole(certificate, made)
        except OSError as error:
            raise DataFolderError(str(folder), error.strerror or "not writable") from error
    return certificate, key


def fingerprint(certificate: Path) -> str:
    """Return the SHA-256 fingerprint as browsers show it: pairs of digits with colons.

    Raises:
        SettingsError: It is no certificate.
    """
    from cryptography.hazmat.primitives.hashes import SHA256  # noqa: PLC0415 - takes its time

    found = _read(certificate)
    if found is None:
        raise SettingsError(f"{certificate} is no certificate in PEM: choose another --tls-cert.")
    return found.fingerprint(SHA256()).hex(":").upper()


def check_pair(certificate: Path, key: Path) -> None:
    """Pass if these files can be served with.

    Raises:
        SettingsError: One cannot be read, or they do not belong together.
    """
    try:
        ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER).load_cert_chain(certificate, key)
    except (OSError, ssl.SSLError) as error:
        reason = error.strerror or str(error)
        raise SettingsError(
            f"The studio cannot use the certificate {certificate} with the key {key} ({reason}): "
            "check --tls-cert and --tls-key."
        ) from error


def _is_pair(certificate: Path, key: Path) -> bool:
    try:
        check_pair(certificate, key)
    except SettingsError:
        return False
    return True


def _is_good(certificate: Path, names: Sequence[str]) -> bool:
    from cryptography import x509  # noqa: PLC0415

    found = _read(certificate)
    if found is None or found.not_valid_after_utc - datetime.now(UTC) < _RENEWED_BEFORE:
        return False
    try:
        extension = found.extensions.get_extension_for_class(x509.SubjectAlternativeName)
    except x509.ExtensionNotFound:
        return False
    return set(_general_names(names)) <= set(extension.value)


def _read(certificate: Path) -> Certificate | None:
    from cryptography import x509  # noqa: PLC0415

    try:
        return x509.load_pem_x509_certificate(certificate.read_bytes())
    except (OSError, ValueError):
        return None


def _make(names: Sequence[str]) -> tuple[bytes, bytes]:
    """Return a certificate and its key in PEM: P-256, signed by itself, for servers only."""
    from cryptography import x509  # noqa: PLC0415
    from cryptography.hazmat.primitives import hashes, serialization  # noqa: PLC0415
    from cryptography.hazmat.primitives.asymmetric import ec  # noqa: PLC0415
    from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID  # noqa: PLC0415

    key = ec.generate_private_key(ec.SECP256R1())
    name = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, "Robot description studio")])
    now = datetime.now(UTC)
    made = (
        x509.CertificateBuilder()
        .subject_name(name)
        .issuer_name(name)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - _CLOCKS_APART)
        .not_valid_after(now + _LIFE)
        .add_extension(x509.SubjectAlternativeName(_general_names(names)), critical=False)
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(x509.ExtendedKeyUsage([ExtendedKeyUsageOID.SERVER_AUTH]), critical=False)
        .sign(key, hashes.SHA256())
    )
    secret = key.private_bytes(
        serialization.Encoding.PEM,
        serialization.PrivateFormat.PKCS8,
        serialization.NoEncryption(),
    )
    return made.public_bytes(serialization.Encoding.PEM), secret


def _general_names(names: Sequence[str]) -> list[GeneralName]:
    from cryptography import x509  # noqa: PLC0415

    found: list[GeneralName] = []
    for name in dict.fromkeys(names):
        try:
            found.append(x509.IPAddress(ipaddress.ip_address(name)))
        except ValueError:
            found.append(x509.DNSName(name))
    return found
