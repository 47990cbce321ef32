"""Credentials: the certificate by which a session is admitted, as keys of Zenoh's configuration."""

from __future__ import annotations

import base64
import json
from dataclasses import dataclass
from typing import Final

_TLS: Final = "transport/link/tls"


@dataclass(frozen=True, slots=True)
class Credentials:
    """A certificate with its key, and the authority that signed those of the other end, in PEM."""

    authority: str
    certificate: str
    key: str

    def of_session(self) -> dict[str, str]:
        """Return keys and JSON5 for who connects; also of `ZENOH_CONFIG_OVERRIDE`.

        The router is known by its authority, so its address may be any.
        """
        return {
            **self._own("connect"),
            f"{_TLS}/enable_mtls": "true",
            f"{_TLS}/verify_name_on_connect": "false",
        }

    def of_router(self) -> dict[str, str]:
        """Return keys and JSON5 for who listens: only who has a certificate is let in."""
        return {**self._own("listen"), f"{_TLS}/enable_mtls": "true"}

    def _own(self, end: str) -> dict[str, str]:
        return {
            f"{_TLS}/root_ca_certificate_base64": _encoded(self.authority),
            f"{_TLS}/{end}_certificate_base64": _encoded(self.certificate),
            f"{_TLS}/{end}_private_key_base64": _encoded(self.key),
        }


def _encoded(pem: str) -> str:
    return json.dumps(base64.b64encode(pem.encode()).decode())
