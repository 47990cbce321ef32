"""The texts run a relay: each is taken by who it is for, and its command by our own parser."""

from __future__ import annotations

import argparse
import configparser
import json
import re
import shlex
import shutil
import ssl
import subprocess
from contextlib import contextmanager
from typing import TYPE_CHECKING, NamedTuple

import pytest
import yaml
from websockets.exceptions import InvalidStatus

import studio
from studio.cli.commands import relay
from studio.cli.serving import page_settings
from studio.errors import SettingsError
from studio.server.ports import page_address
from studio.server.relays.prints import printed
from studio.settings import DEFAULT_PORT
from tests.support.certificates import make_certificates
from tests.support.classmates import Classmate
from tests.support.nginx import free_port, serving_nginx
from tests.support.relay import RunningRelay, running_relay
from tests.support.server import running_studio
from tests.support.studio_page import wait_until

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterator
    from pathlib import Path
    from typing import Any, Literal

    from studio.settings import Settings

OPTIONS: tuple[list[str], ...] = (
    [],
    ["--host", "0.0.0.0", "--name", "relay.example.org", "--tls", "self"],
    ["--public-url", "https://robots.example.org/class/", "--trusted-proxy", "127.0.0.1"],
    ["--host", "192.0.2.7", "--port", "443", "--tls-cert", "/a b.pem", "--tls-key", "/k.pem"],
    ["--data-dir", "/srv/100% of $it", "--listen", "tls/[2001:db8::1]:7449", "--base-path", "/x"],
    ["--data-dir", "/var/lib/relays/one", "--name", "::1", "--host", "::"],
    ["--trusted-proxy", "192.0.2.9", "--host", "0.0.0.0", "--public-url", "https://a.example/"],
)  # fmt: skip


def read(words: list[str]) -> tuple[argparse.Namespace, Settings]:
    parser = argparse.ArgumentParser(exit_on_error=False)
    relay.add(parser)
    options = parser.parse_args(words)
    return options, page_settings(options, keeps=False)


def text_of(kind: Literal["systemd", "compose", "nginx"], words: list[str]) -> str:
    options, settings = read(words)
    return printed(kind, settings, options.listen, options.name)


def unit_of(words: list[str]) -> tuple[str, configparser.ConfigParser]:
    text = text_of("systemd", words)
    unit = configparser.ConfigParser(strict=False, interpolation=None, delimiters="=")
    unit.optionxform = str  # type: ignore[method-assign,assignment]
    unit.read_string(text)
    return text, unit


def started_words(unit: configparser.ConfigParser) -> list[str]:
    words = shlex.split(unit["Service"]["ExecStart"])
    return [one.replace("%%", "%").replace("$$", "$") for one in words]


@pytest.mark.parametrize("words", OPTIONS)
def test_a_unit_runs_the_relay_that_was_asked_for(words: list[str]):
    options, settings = read(words)
    _, unit = unit_of(words)
    program, command, *rest = started_words(unit)
    assert (program, command) == ("/opt/studio/bin/studio", "relay")
    started, page = read(rest)
    assert (started.listen, started.name) == (options.listen, options.name)
    assert (page.host, page.port) == (settings.host, settings.port or DEFAULT_PORT)
    assert (page.public_url, page.base_path) == (settings.public_url, settings.base_path)
    assert (page.proxies, page.tls is None) == (settings.proxies, settings.tls is None)
    service = unit["Service"]
    if options.data_dir:
        assert page.data_folder == options.data_dir
    else:
        assert page.data_folder.as_posix() == f"/var/lib/{service['StateDirectory']}"
    assert service["LimitNOFILE"] == "65536"
    assert service["Restart"] == "always"
    assert service["NoNewPrivileges"] == "yes"
    assert ("User" in service) != (service.get("DynamicUser") == "yes")
    assert unit["Unit"]["After"] == "network-online.target"


@pytest.mark.parametrize("words", OPTIONS)
def test_systemd_takes_the_unit(words: list[str], tmp_path: Path):
    analyze = shutil.which("systemd-analyze")
    if analyze is None:
        pytest.skip("there is no systemd-analyze here")
    unit = tmp_path / "studio-relay.service"
    unit.write_text(text_of("systemd", words).replace("/opt/studio/bin/studio", "/bin/true"))
    ran = subprocess.run(
        [analyze, "verify", "--man=no", unit], capture_output=True, text=True, check=False
    )
    assert unit.stem not in ran.stderr, ran.stderr
    assert ran.returncode == 0, ran.stderr


def test_a_unit_hands_a_certificate_over_whose_key_only_root_reads():
    text, unit = unit_of(["--tls-cert", "/etc/a.pem", "--tls-key", "/etc/k.pem", "--port", "443"])
    assert "LoadCredential=cert.pem:/etc/a.pem\nLoadCredential=key.pem:/etc/k.pem\n" in text
    started, _ = read(shlex.split(unit["Service"]["ExecStart"])[2:])
    assert str(started.tls_key) == "${CREDENTIALS_DIRECTORY}/key.pem"
    assert unit["Service"]["AmbientCapabilities"] == "CAP_NET_BIND_SERVICE"


def composed(words: list[str]) -> tuple[dict[str, Any], argparse.Namespace, Settings]:
    whole: dict[str, Any] = yaml.safe_load(text_of("compose", words))
    program, command, *rest = (
        one.replace("$$", "$") for one in whole["services"]["relay"]["command"]
    )
    assert (program, command) == ("studio", "relay")
    return whole, *read(rest)


@pytest.mark.parametrize("words", OPTIONS)
def test_a_compose_file_runs_the_relay_that_was_asked_for(words: list[str]):
    options, settings = read(words)
    whole, started, page = composed(words)
    one = whole["services"]["relay"]
    port = settings.port or DEFAULT_PORT
    assert (page.host, page.port) == ("0.0.0.0", port)
    assert (page.public_url, page.base_path) == (settings.public_url, settings.base_path)
    dialled = options.listen.rpartition(":")[2]
    assert started.listen == f"tls/0.0.0.0:{dialled}"
    assert [entry.rsplit(":", 2)[-2:] for entry in one["ports"]] == [[str(port)] * 2, [dialled] * 2]
    made = one["build"]["dockerfile_inline"]
    assert made.startswith("FROM python:3.13-slim\n")
    assert f"robot-description-studio=={studio.__version__}\n" in made
    assert one["ulimits"]["nofile"] == 65536
    assert one["restart"] == "unless-stopped"
    *_, code = one["healthcheck"]["test"]
    compile(code, "healthcheck", "exec")
    asked = page_address("127.0.0.1", port, tls=settings.tls is not None)
    assert f"'{asked}health'" in code
    data, *_ = one["volumes"]
    folder = options.data_dir.as_posix().replace("$", "$$") if options.data_dir else "data"
    assert data == f"{folder}:/data"
    assert ("volumes" in whole) == (options.data_dir is None)


def test_a_container_knows_the_proxy_of_its_machine_by_the_gateway_and_is_reached_by_it_alone():
    words = [
        "--host",
        "0.0.0.0",
        "--trusted-proxy",
        "127.0.0.1",
        "--public-url",
        "https://a.example",
    ]
    whole, _, page = composed(words)
    (network,) = whole["networks"]["default"]["ipam"]["config"]
    assert page.proxies == {network["gateway"]}
    assert whole["services"]["relay"]["ports"][0] == f"127.0.0.1:{DEFAULT_PORT}:{DEFAULT_PORT}"


@pytest.mark.parametrize("kind", ["systemd", "compose"])
def test_where_nobody_would_find_the_page_the_text_says_what_to_type(
    kind: Literal["systemd", "compose"],
):
    whole = text_of(kind, ["--listen", "tls/0.0.0.0:7449"])
    told = re.findall(r"^#   (studio relay .*)$", whole, re.MULTILINE)
    assert len(told) == 2
    for line in told:
        words = shlex.split(line)[2:]
        options, _ = read(words)
        assert (options.printed, options.listen) == (kind, "tls/0.0.0.0:7449")
        assert "nobody else finds" not in text_of(kind, words)


def command_of(nginx: str) -> list[str]:
    """The command that it wants to be run, from its options on."""
    (line,) = re.findall(r"^#   (studio relay .*)$", nginx, re.MULTILINE)
    return shlex.split(line)[2:]


@pytest.mark.parametrize("words", OPTIONS)
def test_nginx_is_told_which_relay_stands_behind_it(words: list[str]):
    options, settings = read(words)
    text = text_of("nginx", words)
    started, page = read(command_of(text))
    assert started.listen == options.listen
    assert page.public_url.startswith("https://")
    assert page.proxies
    assert page.base_path == settings.base_path
    assert page.data_folder == settings.data_folder
    assert f"location {settings.base_path}/ {{" in text
    for told in ("--public-url is needed", "--trusted-proxy is needed", "is left out"):
        lacks = {
            "--public-url is needed": not settings.public_url,
            "--trusted-proxy is needed": not settings.proxies,
            "is left out": page.host != settings.host,
        }
        assert (told in text) == lacks[told], told


@pytest.mark.parametrize("kind", ["systemd", "compose", "nginx"])
def test_no_text_is_of_a_relay_that_is_not_encrypted(kind: Literal["systemd", "compose", "nginx"]):
    with pytest.raises(SettingsError, match="encrypted endpoint"):
        text_of(kind, ["--listen", "tcp/0.0.0.0:7448"])


def wait_for_match(pattern: str, said: Callable[[], str]) -> str:
    found: list[str] = []

    def is_found() -> bool:
        found[:] = re.findall(pattern, said(), re.MULTILINE)
        return bool(found)

    wait_until(pattern, is_found)
    return found[0]


class Behind(NamedTuple):
    """A relay behind the nginx of its own text."""

    relay: RunningRelay
    address: str
    context: ssl.SSLContext

    @contextmanager
    def browser(self, room: str = "") -> Generator[Classmate]:
        """Somebody who comes through nginx."""
        made = Classmate(self.address + room, self.context)
        try:
            yield made
        finally:
            made.close()


@pytest.fixture(scope="module", params=["", "class/"], ids=["at the top", "below a path"])
def behind(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Behind]:
    folder = tmp_path_factory.mktemp("behind")
    certificates = make_certificates(folder)
    seen, port, dialled = free_port(), free_port(), free_port()
    address = f"https://localhost:{seen}/{request.param}"
    words = ["--public-url", address, "--port", str(port), "--listen", f"tls/127.0.0.1:{dialled}"]
    site = text_of("nginx", words)
    run = command_of(site)
    site = re.sub(r"(?<=ssl_certificate )\S+(?=;)", str(certificates.certificate), site)
    site = re.sub(r"(?<=ssl_certificate_key )\S+(?=;)", str(certificates.key), site)
    site = site.replace(f"listen [::]:{seen} ssl;", "").replace(
        f"listen {seen} ssl;", f"listen 127.0.0.1:{seen} ssl;"
    )
    with (
        running_relay(run, folder / "data") as started,
        serving_nginx(folder / "nginx", site, seen),
    ):
        yield Behind(started, address, ssl.create_default_context(cafile=certificates.authority))


@pytest.mark.network
def test_health_and_metrics_come_through_nginx_and_metrics_want_the_key(behind: Behind):
    assert behind.relay.address == behind.address
    with behind.browser() as asking:
        healthy = asking.client.get("/health")
        assert (healthy.status_code, healthy.text) == (200, "ok\n")
        refused = asking.client.get("/metrics")
        assert refused.status_code == 401
        assert behind.relay.key not in refused.text
        for given in (f"Bearer {behind.relay.key[:-1]}", "Bearer x", behind.relay.key):
            wrong = asking.client.get("/metrics", headers={"authorization": given})
            assert wrong.status_code == 401
        right = {"authorization": f"Bearer {behind.relay.key}"}
        told = asking.client.get("/metrics", headers=right)
        assert told.status_code == 200
        assert "studio_relay_rooms 0\n" in told.text


@pytest.mark.network
def test_a_websocket_reaches_the_relay_which_refuses_it_while_no_studio_is_there(behind: Behind):
    with behind.browser("0123456789abcdef/") as early:
        assert early.client.get("/").status_code == 503
        with pytest.raises(InvalidStatus) as refused, early.lane():
            pass
        # As a plain request it would be answered by a page.
        assert refused.value.response.status_code == 403


@pytest.mark.network
def test_a_student_joins_a_room_through_nginx_and_all_lanes_are_there(
    behind: Behind, tmp_path: Path
):
    words = ["demo", "--share", "--host", "127.0.0.1", "--via", behind.relay.line]
    with running_studio(words, tmp_path / "data") as origin:
        code = origin.class_code
        with behind.browser() as asking:
            right = {"authorization": f"Bearer {behind.relay.key}"}
            told = wait_for_match(
                r'^studio_relay_origin_up\{room="(\w+)"\} 1.0$',
                lambda: asking.client.get("/metrics", headers=right).text,
            )
        with behind.browser(f"{told}/") as ada:
            assert ada.join("Ada", code).status_code == 303
            with ada.lane() as lane:
                assert lane.until("you", name="Ada")["role"] == "student"
            with ada.websocket("/data") as data:
                data.send(json.dumps({"type": "ask_bulk"}))
                key = json.loads(data.recv(timeout=60))["key"]
                with ada.client.stream("GET", f"/bulk?key={key}") as bulk:
                    assert bulk.status_code == 200
                    data.close()
                    assert bulk.read() == b""
