"""The pages without scripts, and the studio's page with its two blanks filled."""

from __future__ import annotations

import secrets
from html import escape
from string import Template
from typing import TYPE_CHECKING

from starlette.responses import HTMLResponse

from studio.server.policy import PLAIN_PAGE_POLICY, page_policy

if TYPE_CHECKING:
    from studio.server.assets import Tree

_PLAIN = Template("""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
$refresh<title>$title - Robot description studio</title>
<style>
:root { color-scheme: light dark; }
body { margin: 0; min-height: 100vh; display: grid; place-items: center;
  font: 16px/1.5 system-ui, sans-serif; background: light-dark(#eef1f5, #15181d);
  color: light-dark(#1c2430, #dfe5ee); }
main { max-width: 34rem; margin: 1rem; padding: 2rem 2.25rem; border-radius: 12px;
  background: light-dark(#fff, #1e232b); box-shadow: 0 1px 3px rgb(0 0 0 / 20%); }
h1 { margin: 0 0 .5rem; font-size: 1.3rem; }
p { margin: .5rem 0 0; }
a { color: light-dark(#1560c8, #7db1ff); }
</style>
</head>
<body><main><h1>$title</h1>$body</main></body>
</html>
""")


def _plain_page(title: str, body: str, status: int, refresh: str = "") -> HTMLResponse:
    """Fill the plain page; `body` and `refresh` are markup."""
    text = _PLAIN.substitute(title=escape(title), body=body, refresh=refresh)
    headers = {"content-security-policy": PLAIN_PAGE_POLICY, "cache-control": "no-store"}
    return HTMLResponse(text, status, headers)


def no_access_page(*, spent: bool) -> HTMLResponse:
    """Return the page without a role; `spent`: the token in the address is not valid."""
    why = (
        "<p>The key in this address is no longer valid: the studio was started anew since.</p>"
        if spent
        else "<p>This studio is open to those who have its address.</p>"
    )
    body = (
        f"{why}<p>Open the address that the studio prints when it starts: a line "
        "<code>Studio: http://…?token=…</code> in its terminal.</p>"
    )
    return _plain_page("This studio needs its key", body, 403)


def not_found_page() -> HTMLResponse:
    """Return the page for an unknown address, which is not repeated on it."""
    body = (
        "<p>This robot is not open here. It may have been closed, or the studio was started anew "
        'since.</p><p><a href="/">Go to the open robot</a></p>'
    )
    return _plain_page("Nothing is open under this address", body, 404)


def trouble_page(sentence: str, status: int) -> HTMLResponse:
    """Return the page for any other error."""
    body = f'<p>{escape(sentence)}</p><p><a href="/">Go to the open robot</a></p>'
    return _plain_page("This did not work", body, status)


def return_page(address: str) -> HTMLResponse:
    """Goes to `address` at once, as a step of our own page: then the strict cookie comes along."""
    link = escape(address, quote=True)
    response = _plain_page(
        "One moment",
        f'<p><a href="{link}">Go to the studio</a></p>',
        200,
        refresh=f'<meta http-equiv="refresh" content="0;url={link}">\n',
    )
    response.headers["referrer-policy"] = "same-origin"
    return response


def studio_page(tree: Tree) -> HTMLResponse:
    """Return the page: `{{base}}` is where its files are, `{{nonce}}` is for its import map."""
    nonce = secrets.token_urlsafe(16)
    text = tree.index.replace("{{base}}", tree.base).replace("{{nonce}}", nonce)
    headers = {"content-security-policy": page_policy(nonce), "cache-control": "no-store"}
    return HTMLResponse(text, 200, headers)
