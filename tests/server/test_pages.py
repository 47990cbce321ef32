from __future__ import annotations

import re
from typing import TYPE_CHECKING

from studio.protocol.roles import Role

if TYPE_CHECKING:
    from tests.support.web_server import RunningWeb


def directives(policy: str) -> dict[str, str]:
    """The content policy by directive."""
    parts = (part.strip().partition(" ") for part in policy.split(";"))
    return {name: value for name, _, value in parts}


def test_the_page_runs_its_own_files_and_what_carries_this_answers_nonce(web: RunningWeb):
    with web.client(Role.GUEST) as client:
        answer, again = client.get("/d/small"), client.get("/d/small")
    policy = directives(answer.headers["content-security-policy"])
    (nonce,) = re.findall(r'nonce="([^"]+)"', answer.text)
    assert nonce not in again.text
    assert policy["script-src"] == f"'self' 'nonce-{nonce}'"
    assert "{{" not in answer.text
    assert answer.headers["cache-control"] == "no-store"
    assert policy["default-src"] == "'self'"
    assert policy["style-src"] == "'self' 'unsafe-inline'"
    assert policy["img-src"] == "'self' data: blob:"
    assert policy["worker-src"] == "'self' blob:"
    assert policy["frame-ancestors"] == "'self'"
    assert policy["object-src"] == "'none'"


def test_visers_page_has_a_policy_of_its_own_and_reaches_no_other_host(web: RunningWeb):
    with web.client(Role.GUEST) as client:
        answer = client.get("/d/small/viser/")
    assert answer.headers["content-type"].startswith("text/html")
    assert answer.headers["cache-control"] == "no-store"
    assert "/viser/studio3d.js" in answer.text
    policy = directives(answer.headers["content-security-policy"])
    assert policy["connect-src"] == "'self' blob: data:"
    assert {"'unsafe-inline'", "'unsafe-eval'", "blob:"} <= set(policy["script-src"].split())
    assert policy["frame-ancestors"] == "'self'"
    assert "http" not in answer.headers["content-security-policy"]


def test_our_plain_pages_run_no_script(web: RunningWeb):
    with web.client(headers={"accept": "text/html"}) as client:
        policy = directives(client.get("/").headers["content-security-policy"])
    assert policy["default-src"] == "'none'"
    assert "script-src" not in policy
