"""A certificate authority and a server's certificate for 127.0.0.1, made anew for each test."""

from __future__ import annotations

import subprocess
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

_KEY = ("-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes")
_DAYS = ("-days", "2")
_OF_AUTHORITY = "basicConstraints=critical,CA:TRUE"
_OF_SERVER = "subjectAltName=IP:127.0.0.1,DNS:localhost"


@dataclass(frozen=True, slots=True)
class Certificates:
    """Where the files lie, as PEM."""

    authority: Path
    key: Path
    certificate: Path


def make_certificates(folder: Path, name: str = "robot") -> Certificates:
    """An authority that has signed one certificate."""
    made = Certificates(
        folder / f"{name}-ca.pem", folder / f"{name}-key.pem", folder / f"{name}.pem"
    )
    authority_key = folder / f"{name}-ca-key.pem"
    _openssl(
        *("req", "-x509", *_KEY, *_DAYS, "-subj", f"/CN={name} authority"),
        *("-addext", _OF_AUTHORITY, "-keyout", authority_key, "-out", made.authority),
    )
    _openssl(
        *("req", "-x509", *_KEY, *_DAYS, "-subj", f"/CN={name}", "-addext", _OF_SERVER),
        *("-addext", "basicConstraints=critical,CA:FALSE"),
        *("-CA", made.authority, "-CAkey", authority_key),
        *("-keyout", made.key, "-out", made.certificate),
    )
    return made


def _openssl(*words: str | Path) -> None:
    subprocess.run(["openssl", *words], check=True, capture_output=True)
