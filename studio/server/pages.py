"""The pages without scripts, and the studio's page with its two blanks filled."""

from __future__ import annotations

import secrets
from dataclasses import dataclass
from html import escape
from string import Template
from typing import TYPE_CHECKING

from starlette.responses import HTMLResponse

from studio.protocol.classroom import NAME_MAX, PASSWORD_MAX
from studio.server.policy import PLAIN_PAGE_POLICY, page_policy

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.server.assets import Tree

_PLAIN = Template("""<!doctype html>
<html lang="$language">
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
form { display: grid; gap: .9rem; margin-top: 1.1rem; }
label { display: grid; gap: .25rem; font-weight: 600; font-size: .95rem; }
small { font-weight: 400; color: light-dark(#586273, #9aa5b5); }
input { font: inherit; padding: .6rem .75rem; border-radius: 8px; min-width: 0;
  border: 1px solid light-dark(#b6bfcc, #47505e); background: light-dark(#fff, #15181d);
  color: inherit; }
input[name=code] { font: 600 1.5rem/1.2 ui-monospace, monospace; letter-spacing: .25em;
  text-transform: uppercase; }
button { font: inherit; font-weight: 600; padding: .7rem; border: 0; border-radius: 8px;
  color: #fff; background: #1560c8; cursor: pointer; }
:is(input, button, a):focus-visible { outline: 3px solid light-dark(#1560c8, #7db1ff);
  outline-offset: 2px; }
.trouble { padding: .6rem .8rem; border-radius: 8px; background: light-dark(#fdeaea, #45262a);
  color: light-dark(#8d1b1b, #ffc9c9); }
</style>
</head>
<body><main><h1>$title</h1>$body</main></body>
</html>
""")


def _plain_page(
    title: str, body: str, status: int, refresh: str = "", language: str = "en"
) -> HTMLResponse:
    """Fill the plain page; `body` and `refresh` are markup."""
    text = _PLAIN.substitute(title=escape(title), body=body, refresh=refresh, language=language)
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


def not_found_page(root: str = "") -> HTMLResponse:
    """Return the page for an unknown address, which is not repeated on it."""
    body = (
        "<p>This robot is not open here. It may have been closed, or the studio was started anew "
        f'since.</p><p><a href="{root}/">Go to the open robot</a></p>'
    )
    return _plain_page("Nothing is open under this address", body, 404)


@dataclass(frozen=True, slots=True)
class Form:
    """What is in the form to join.

    Attributes:
        has_code: The code came with a link and need not be typed.
        code: As it was typed.
        name: As it was typed.
        trouble: Why it was refused, as `NotJoiningError.why`; empty: it was not.
    """

    has_code: bool = False
    code: str = ""
    name: str = ""
    trouble: str = ""
    asks_name: bool = True
    """Whether there is a field for the name; a relay asks for the code first."""


def join_page(
    form: Form, words: Mapping[str, str], language: str, *, needs_password: bool
) -> HTMLResponse:
    """Return the form by which others join; what was typed is in it again.

    Args:
        form: What is in it.
        words: The texts of the page, those of the form as `join.<name>`.
        language: Which language they are in.
        needs_password: Whether a password is asked for.
    """

    def word(name: str) -> str:
        return escape(words.get(f"join.{name}", name), quote=True)

    fields: list[str] = []
    if form.trouble:
        said = word(f"trouble.{form.trouble}")
        fields.append(f'<p class="trouble" role="alert">{said}</p>')
    if not form.has_code:
        fields.append(
            f"<label>{word('code')} <small>{word('code.hint')}</small>"
            '<input name="code" required maxlength="32" autocomplete="off" '
            f'autocapitalize="characters" spellcheck="false" value="{escape(form.code)}"></label>'
        )
    if form.asks_name:
        fields.append(
            f"<label>{word('name')} <small>{word('name.hint')}</small>"
            f'<input name="name" required maxlength="{NAME_MAX}" autocomplete="nickname" '
            f'value="{escape(form.name)}"></label>'
        )
    if needs_password:
        fields.append(
            f'<label>{word("password")}<input name="password" type="password" required '
            f'maxlength="{PASSWORD_MAX}" autocomplete="off"></label>'
        )
    body = (
        f'<form method="post">{"".join(fields)}<button>{word("join")}</button></form>'
        f"<p><small>{word('kept') if form.asks_name else ''}</small></p>"
    )
    # A form that was filled in wrongly is an answer like another: a browser reports no error.
    status = 429 if form.trouble == "tries" else 200
    title = words.get("join.title", "")
    response = _plain_page(title, body, status, language=language)
    response.headers["content-security-policy"] = f"{PLAIN_PAGE_POLICY}; form-action 'self'"
    return response


def waiting_page() -> HTMLResponse:
    """Return a relay's page of a room that may come; it looks again by itself."""
    body = "<p>The class is not here at the moment. This page looks for it every few seconds.</p>"
    refresh = '<meta http-equiv="refresh" content="3">\n'
    return _plain_page("The class is on its way", body, 503, refresh)


def trouble_page(sentence: str, status: int, root: str = "") -> HTMLResponse:
    """Return the page for any other error."""
    body = f'<p>{escape(sentence)}</p><p><a href="{root}/">Go to the open robot</a></p>'
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


def studio_page(tree: Tree, root: str = "") -> HTMLResponse:
    """Return the page: `{{base}}` is where its files are, `{{nonce}}` is for its import map.

    `root`, which it finds as `{{root}}`, is the path below which the studio is reached.
    """
    nonce = secrets.token_urlsafe(16)
    text = tree.index.replace("{{base}}", root + tree.base).replace("{{nonce}}", nonce)
    text = text.replace("{{root}}", root)
    headers = {"content-security-policy": page_policy(nonce), "cache-control": "no-store"}
    return HTMLResponse(text, 200, headers)
