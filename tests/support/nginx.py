"""A real nginx in front of a studio, with TLS and a path."""

from __future__ import annotations

import shutil
import socket
import subprocess
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from tests.support.apt import install_by_apt
from tests.support.studio_page import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from tests.support.certificates import Certificates

_SBIN = "/usr/sbin/nginx"
_HOW_TO = "These tests need nginx: `apt install nginx-light`."
_MAIN = """
daemon off;
pid {folder}/nginx.pid;
error_log {folder}/error.log;
events {{}}
http {{
  access_log {folder}/access.log;
  client_body_temp_path {folder}/body;
  proxy_temp_path {folder}/proxy;
  fastcgi_temp_path {folder}/fastcgi;
  uwsgi_temp_path {folder}/uwsgi;
  scgi_temp_path {folder}/scgi;
  include {folder}/site.conf;
}}
"""
_SITE = """
map $http_upgrade $connection_upgrade {{ default upgrade; '' ''; }}
server {{
  listen 127.0.0.1:{tls_port} ssl;
  ssl_certificate {certificate};
  ssl_certificate_key {key};
  client_max_body_size 1g;
  location {path} {{
    proxy_pass http://127.0.0.1:{port}{kept};
    proxy_http_version 1.1;
    proxy_set_header Upgrade $http_upgrade;
    proxy_set_header Connection $connection_upgrade;
    proxy_set_header Host $http_host;
    proxy_set_header X-Forwarded-For $proxy_add_x_forwarded_for;
    proxy_set_header X-Forwarded-Proto $scheme;
    proxy_read_timeout 1h;
  }}
}}
server {{
  listen 127.0.0.1:{plain_port};
  location / {{ proxy_pass http://127.0.0.1:{port}; proxy_http_version 1.1; }}
}}
"""
"""The first server is as the README says; the second is one that the studio was not told of."""


class NoNginxError(Exception):
    """There is no nginx, and none could be installed."""


@cache
def ensure_nginx() -> Path:
    """Find nginx, or install it.

    Raises:
        NoNginxError: Neither could be done.
    """
    for install in (False, True):
        if install:
            install_by_apt("nginx-light", "nginx")
        if found := shutil.which("nginx") or shutil.which(_SBIN):
            return Path(found)
    raise NoNginxError(_HOW_TO)


class Nginx:
    """Where it listens: with TLS, and without anything."""

    def __init__(self, tls_port: int, plain_port: int, folder: Path) -> None:
        self.tls_port, self.plain_port, self._folder = tls_port, plain_port, folder

    @property
    def log(self) -> str:
        """What it was asked for."""
        return (self._folder / "access.log").read_text()


def free_port() -> int:
    """A port that nobody listens on now."""
    with socket.socket() as asked:
        asked.bind(("127.0.0.1", 0))
        return int(asked.getsockname()[1])


@contextmanager
def running_nginx(
    folder: Path,
    port: int,
    tls_port: int,
    certificates: Certificates,
    path: str = "/",
    *,
    strips: bool = False,
) -> Generator[Nginx]:
    """Run nginx until the block ends.

    Args:
        folder: For its files.
        port: Of the studio.
        tls_port: Where it listens itself.
        certificates: Of the server.
        path: Below which the studio is.
        strips: Whether the studio sees addresses without that path.
    """
    made = Nginx(tls_port, free_port(), folder)
    site = _SITE.format(
        tls_port=tls_port,
        plain_port=made.plain_port,
        certificate=certificates.certificate,
        key=certificates.key,
        path=path,
        port=port,
        kept="/" if strips else "",
    )
    with serving_nginx(folder, site, tls_port, made.plain_port):
        yield made


@contextmanager
def serving_nginx(folder: Path, site: str, *ports: int) -> Generator[None]:
    """Run nginx with what stands within `http`, once it listens at all ports of it."""
    folder.mkdir()
    (folder / "nginx.conf").write_text(_MAIN.format(folder=folder))
    (folder / "site.conf").write_text(site)
    with (folder / "stderr").open("w") as errors:
        process = subprocess.Popen(
            [ensure_nginx(), "-p", folder, "-c", folder / "nginx.conf"], stderr=errors
        )
    try:
        wait_until(
            "nginx to listen, or to end",
            lambda: process.poll() is not None or all(map(_listens, ports)),
        )
        assert process.poll() is None, (folder / "stderr").read_text()
        yield
    finally:
        process.terminate()
        process.wait(20)


def _listens(port: int) -> bool:
    with socket.socket() as asking:
        return asking.connect_ex(("127.0.0.1", port)) == 0
