"""Texts that run a relay with the options that were given: for systemd, for compose, for nginx."""

from __future__ import annotations

import json
import re
import shlex
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal
from urllib.parse import urlsplit

import studio
from studio.server.ports import bracketed, page_address
from studio.server.relays.keys import listening_endpoint
from studio.settings import (
    ANY_HOST,
    ANY_HOSTS,
    DEFAULT_HOST,
    DEFAULT_PORT,
    LOOPBACK_HOSTS,
    TlsChoice,
)

if TYPE_CHECKING:
    from studio.settings import Settings

_HOST_THERE: Final = "relay.example.org"
"""In the place of a name that was not given."""
_STATE: Final = "/var/lib/"
_SUBNET: Final = "192.168.203"
_PACKAGE: Final = f"robot-description-studio=={studio.__version__}"
_PRIVILEGED_PORTS: Final = 1024


def printed(
    kind: Literal["systemd", "compose", "nginx"], settings: Settings, listen: str, name: str
) -> str:
    """Return a text that runs this relay, which says first what to do with it.

    Args:
        kind: For which program.
        settings: What the command line decided of the page; an empty data folder is the usual one.
        listen: Where studios dial in.
        name: By which studios and browsers find the machine; may be empty.

    Raises:
        StudioError: `listen` is no encrypted endpoint.
    """
    return {"systemd": _systemd, "compose": _compose, "nginx": _nginx}[kind](settings, listen, name)


def _words(settings: Settings, listen: str, name: str) -> list[str]:
    """Return the words of the command that have these settings."""
    words = ["studio", "relay", "--port", str(_port(settings)), "--listen", listen]
    words += ["--host", settings.host] if settings.host != DEFAULT_HOST else []
    words += ["--name", name] if name else []
    words += ["--public-url", settings.public_url] if settings.public_url else []
    if settings.base_path != urlsplit(settings.public_url).path.rstrip("/"):
        words += ["--base-path", settings.base_path or "/"]
    for one in sorted(settings.proxies):
        words += ["--trusted-proxy", one]
    if files := _files(settings):
        words += ["--tls-cert", files[0].as_posix(), "--tls-key", files[1].as_posix()]
    elif settings.tls:
        words += ["--tls", "self"]
    return words + (["--data-dir", _data(settings)] if _data(settings) else [])


def _port(settings: Settings) -> int:
    """Return the port: who is told where it is needs one that stays the same."""
    return settings.port or DEFAULT_PORT


def _files(settings: Settings) -> tuple[Path, Path] | None:
    """Return certificate and key that were given."""
    tls = settings.tls
    return (tls.certificate, tls.key) if tls and tls.certificate and tls.key else None


def _data(settings: Settings) -> str:
    """Return the data folder that was given, or an empty text."""
    return settings.data_folder.as_posix() if settings.data_folder.parts else ""


def _lacks(kind: str, settings: Settings, listen: str, name: str) -> str:
    """Return a comment about options without which nobody would come, or an empty text."""
    is_loopback = settings.host in LOOPBACK_HOSTS
    is_found = settings.public_url or name or kind == "systemd"
    if (settings.public_url and settings.proxies) or (is_found and not is_loopback):
        return ""
    name = name or _HOST_THERE
    seen = replace(
        settings,
        host=ANY_HOST if is_loopback else settings.host,
        tls=settings.tls or TlsChoice(),
    )
    public = settings.public_url or f"https://{bracketed(name)}{settings.base_path}/"
    proxied = replace(
        settings, public_url=public, proxies=settings.proxies or frozenset({DEFAULT_HOST})
    )
    lines = [
        "#",
        "# As it is, nobody else finds the page. Print this anew with the name of this machine,",
        f"#   {shlex.join([*_words(seen, listen, name), '--print', kind])}",
        "# or for a proxy before it, as `--print nginx` has it:",
        f"#   {shlex.join([*_words(proxied, listen, ''), '--print', kind])}",
    ]
    return "".join(f"{line}\n" for line in lines)


# systemd

_UNIT: Final = """\
# Of `studio relay`, for /etc/systemd/system/studio-relay.service. Before:
#   python3 -m venv /opt/studio && /opt/studio/bin/pip install {package}
{before}# Then:
#   systemctl daemon-reload && systemctl enable --now studio-relay
# It prints its key and the line for studios; to see them:
#   journalctl -u studio-relay -o cat
{lacks}
[Unit]
Description=Relay of robot description studios
Wants=network-online.target
After=network-online.target
StartLimitIntervalSec=0

[Service]
Type=exec
ExecStart=/opt/studio/bin/studio {words}
Restart=always
RestartSec=2
LimitNOFILE=65536
UMask=0077
{user}
NoNewPrivileges=yes
CapabilityBoundingSet={capabilities}
AmbientCapabilities={capabilities}
ProtectSystem=strict
ProtectHome={home}
PrivateTmp=yes
PrivateDevices=yes
ProtectProc=invisible
ProtectClock=yes
ProtectHostname=yes
ProtectKernelLogs=yes
ProtectKernelModules=yes
ProtectKernelTunables=yes
ProtectControlGroups=yes
RestrictAddressFamilies=AF_UNIX AF_INET AF_INET6 AF_NETLINK
RestrictNamespaces=yes
RestrictRealtime=yes
RestrictSUIDSGID=yes
LockPersonality=yes
SystemCallArchitectures=native
SystemCallFilter=@system-service

[Install]
WantedBy=multi-user.target
"""


def _systemd(settings: Settings, listen: str, name: str) -> str:
    data, files, before = _data(settings) or f"{_STATE}studio-relay", _files(settings), ""
    made = replace(settings, data_folder=Path(data))
    if data.startswith(_STATE):
        folder = _unit_word(data.removeprefix(_STATE))
        user = ["DynamicUser=yes", f"StateDirectory={folder}", "StateDirectoryMode=0700"]
    else:
        user = ["User=studio-relay", f"ReadWritePaths={_unit_word(data)}"]
        before = (
            "#   useradd --system studio-relay\n"
            f"#   install -d -o studio-relay -m 700 {shlex.quote(data)}\n"
        )
    if files:  # systemd hands them over: only root may read the key
        for one, path in zip(("cert.pem", "key.pem"), files, strict=True):
            user.append(f"LoadCredential={_unit_word(f'{one}:{path.as_posix()}')}")
        made = replace(made, tls=TlsChoice(Path("\0/cert.pem"), Path("\0/key.pem")))
        before += "#   Have whatever renews the certificate do `systemctl restart studio-relay`.\n"
    words = (_unit_word(one.replace("$", "$$")) for one in _words(made, listen, name)[1:])
    ports = (_port(settings), listening_endpoint(listen).port)
    return _UNIT.format(
        package=_PACKAGE,
        before=before,
        lacks=_lacks("systemd", settings, listen, name),
        words=" ".join(words).replace("\0", "${CREDENTIALS_DIRECTORY}"),
        user="\n".join(user),
        capabilities="CAP_NET_BIND_SERVICE" if min(ports) < _PRIVILEGED_PORTS else "",
        home="read-only" if data.startswith(("/home/", "/root/")) else "yes",
    )


def _unit_word(word: str) -> str:
    """Return a word as a unit has it."""
    word = word.replace("%", "%%")
    plain = re.fullmatch(r"[^\s\"'\\;]+", word)
    return word if plain else json.dumps(word, ensure_ascii=False)


# compose

_COMPOSE: Final = """\
# Of `studio relay`, for a file compose.yaml in a folder of its own. Then:
#   docker compose up --detach --build
# It prints its key and the line for studios; to see them:
#   docker compose logs relay
{lacks}
services:
  relay:
    build:
      dockerfile_inline: |
        FROM python:3.13-slim
        RUN pip install --no-cache-dir {package}
        RUN useradd --uid 1000 studio && install -d -o studio -m 700 /data
        USER studio
    command: {command}
    ports:
      - {page}
      - {dialled}
    volumes:
{volumes}
    ulimits:
      nofile: 65536
    healthcheck:
      test: {test}
      interval: 30s
      timeout: 5s
      start_period: 30s
    restart: unless-stopped
    init: true
    cap_drop: [ALL]
    security_opt: ["no-new-privileges:true"]
{networks}"""
_VOLUME: Final = "volumes:\n  data:\n"
_NETWORK: Final = f"""\
# By this address the proxy of this machine is seen from within.
networks:
  default:
    ipam:
      config:
        - subnet: {_SUBNET}.0/24
          gateway: {_SUBNET}.1
"""


def _compose(settings: Settings, listen: str, name: str) -> str:
    endpoint = listening_endpoint(listen)
    port, data, files = _port(settings), _data(settings), _files(settings)
    here = settings.proxies & LOOPBACK_HOSTS
    # Whoever comes by another address than a proxy's must not pass for it.
    seen = DEFAULT_HOST if here or settings.host in LOOPBACK_HOSTS else settings.host
    mounts = [f"{data or 'data'}:/data"]
    made = replace(
        settings,
        host=ANY_HOST,
        data_folder=Path("/data"),
        proxies=(settings.proxies - here) | frozenset({f"{_SUBNET}.1"} if here else ()),
    )
    if files:
        mounts += [f"{files[0]}:/tls/cert.pem:ro", f"{files[1]}:/tls/key.pem:ro"]
        made = replace(made, tls=TlsChoice(Path("/tls/cert.pem"), Path("/tls/key.pem")))
    words = _words(made, f"tls/{ANY_HOST}:{endpoint.port}", name)
    checked = page_address(DEFAULT_HOST, port, tls=settings.tls is not None) + "health"
    asks = "import ssl, urllib.request as r; "
    asks += f"r.urlopen('{checked}', timeout=4, context=ssl._create_unverified_context())"
    lacks = _lacks("compose", settings, listen, name)
    if data or files:
        told = "files and folders" if data and files else "folder" if data else "files"
        lacks = f"# User 1000 needs to be let into the {told} of this machine named below.\n{lacks}"
    return _COMPOSE.format(
        lacks=lacks,
        package=_PACKAGE,
        command=_compose_list(words),
        page=json.dumps(_publish(seen, port)),
        dialled=json.dumps(_publish(endpoint.host, endpoint.port)),
        volumes="\n".join(f"      - {json.dumps(_compose_text(one))}" for one in mounts),
        test=_compose_list(["CMD", "python", "-c", asks]),
        networks=("" if data else _VOLUME) + (_NETWORK if here else ""),
    )


def _publish(host: str, port: int) -> str:
    shown = "" if host in ANY_HOSTS else f"{bracketed(host)}:"
    return f"{shown}{port}:{port}"


def _compose_text(text: str) -> str:
    return text.replace("$", "$$")


def _compose_list(words: list[str]) -> str:
    return json.dumps([_compose_text(one) for one in words], ensure_ascii=False)


# nginx

_SITE: Final = """\
# Of `studio relay`, for /etc/nginx/conf.d/studio-relay.conf. On this machine, run
#   {command}
{told}#
# Studios dial in at port {dialled} by TLS of the relay's own, which nginx must not end: leave that
# port open beside nginx. An nginx on a machine of its own can pass it through, outside of `http`:
#   stream {{ server {{ listen {dialled}; proxy_pass RELAY:{dialled}; proxy_timeout 1h; }} }}
# Each page has up to four connections, and nginx two for each: for 1000 pages, nginx.conf needs
#   worker_rlimit_nofile 65536; events {{ worker_connections 16384; }}
map $http_upgrade $studio_connection {{ default upgrade; '' ''; }}

server {{
  listen {listen} ssl;
  listen [::]:{listen} ssl;
  server_name {host};
  ssl_certificate /etc/letsencrypt/live/{host}/fullchain.pem;
  ssl_certificate_key /etc/letsencrypt/live/{host}/privkey.pem;
  client_max_body_size 16m;

  proxy_http_version 1.1;
  proxy_set_header Upgrade $http_upgrade;
  proxy_set_header Connection $studio_connection;
  proxy_set_header Host $http_host;
  proxy_set_header X-Forwarded-For $proxy_add_x_forwarded_for;
  proxy_set_header X-Forwarded-Proto $scheme;
  proxy_set_header X-Forwarded-Host $http_host;
  proxy_read_timeout 1h;
  proxy_send_timeout 1h;

  location {base}/ {{
    proxy_pass {upstream};
  }}
  location ~ ^{pattern}/[^/]+/bulk$ {{
    proxy_pass {upstream};
    proxy_buffering off;
  }}
}}
"""


def _nginx(settings: Settings, listen: str, name: str) -> str:
    told: list[str] = []
    public, host = settings.public_url, settings.host
    if not public.startswith("https://"):
        there = urlsplit(public).netloc or bracketed(name) or _HOST_THERE
        public = f"https://{there}{settings.base_path}/"
        told.append(f"--public-url is needed: {public} stands for the address that people open.")
    if not settings.proxies:
        told.append("--trusted-proxy is needed: else all who come by nginx have one address.")
    if host not in LOOPBACK_HOSTS and not settings.proxies - LOOPBACK_HOSTS:
        told.append(f"--host {host} is left out: else people come around nginx, too.")
        host = DEFAULT_HOST
    parts = urlsplit(public)
    made = replace(
        settings,
        host=host,
        public_url=public,
        base_path=parts.path.rstrip("/"),
        proxies=settings.proxies or frozenset({DEFAULT_HOST}),
    )
    words = _words(made, listen, "" if name == parts.hostname else name)
    return _SITE.format(
        command=shlex.join(words),
        told="".join(f"# {one}\n" for one in told),
        dialled=listening_endpoint(listen).port,
        listen=parts.port or 443,
        host=bracketed(parts.hostname or _HOST_THERE),
        base=made.base_path,
        pattern=re.escape(made.base_path),
        upstream=page_address(host, _port(settings), tls=settings.tls is not None).rstrip("/"),
    )
