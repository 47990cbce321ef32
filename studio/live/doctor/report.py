"""The report: an examination as one HTML file, to be sent to somebody who helps.

It loads nothing and runs nothing, and every text of others is escaped. Home folders are left out
of it, for their names are those of persons.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from datetime import datetime
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal, TypeAlias, cast, get_args

from studio.live.doctor.seen import short
from studio.protocol.doctor import Level
from studio.settings import repository_or_wheel

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from studio.live.doctor.examination import Examination
    from studio.live.doctor.seen import Seen
    from studio.protocol.doctor import Finding, SubjectView, Talk

_HOMES: Final = re.compile(r"(?:/home|/Users|[A-Za-z]:\\Users)[/\\][^/\\\s\"'<>:]+")
Language: TypeAlias = Literal["en", "de"]
_FACTS: Final = {
    "router": "Router",
    "domain": "Domain",
    "distribution": "Distribution",
    "nodes": "Nodes",
    "bridges": "DDS",
}
"""In German as in English."""
_TITLE: Final[dict[Language, str]] = {
    "en": "Report of the Doctor",
    "de": "Bericht des Doktors",
}
_PRIVATE: Final[dict[Language, str]] = {
    "en": "This report holds names of nodes, topics and files of the robot, and no names or "
    "addresses of persons.",
    "de": "Dieser Bericht enthält Namen von Nodes, Topics und Dateien des Roboters, aber keine "
    "Namen oder Adressen von Personen.",
}
_LEVELS: Final[tuple[Level, ...]] = get_args(Level)
_SIGNS: Final[dict[Level, str]] = {"error": "✖", "warn": "▲", "note": "●"}
_POLICY: Final = "default-src 'none'; style-src 'unsafe-inline'"
_STYLE: Final = """
:root { color-scheme: light dark; --text: #1f2430; --quiet: #5d6675; --ground: #fff;
  --raised: #f4f6f9; --line: #d5dae3; --error: #b3261e; --warn: #8a5a00; --note: #2457b3;
  --well: #1b6e3c; }
@media (prefers-color-scheme: dark) { :root { --text: #e6e9ef; --quiet: #a3adbd; --ground: #15181e;
  --raised: #1e232c; --line: #384152; --error: #ff8a80; --warn: #f2b950; --note: #8ab4ff;
  --well: #6fd19a; } }
body { margin: 0 auto; max-width: 62rem; padding: 1.5rem; background: var(--ground);
  color: var(--text); font: 15px/1.5 system-ui, sans-serif; overflow-wrap: anywhere; }
h1 { font-size: 1.5rem; margin: 0; } h2 { font-size: 1.1rem; margin: 2rem 0 .5rem; }
h3 { font-size: 1rem; margin: 0; }
.quiet { color: var(--quiet); } .error { color: var(--error); } .warn { color: var(--warn); }
.note { color: var(--note); } .well { color: var(--well); }
article { border: 1px solid var(--line); border-left: 4px solid currentColor; border-radius: 6px;
  background: var(--raised); padding: .7rem 1rem; margin: .6rem 0; }
article > * { color: var(--text); } article p { margin: .3rem 0; }
code { font: 13px/1.4 ui-monospace, monospace; } pre { margin: .3rem 0; white-space: pre-wrap; }
.talk { display: flex; flex-wrap: wrap; gap: .4rem; align-items: center; margin: .4rem 0; }
.talk span { border: 1px solid var(--line); border-radius: 5px; padding: .1rem .5rem; }
.talk .nobody { border-style: dashed; color: var(--quiet); } .talk i { font-style: normal; }
table { border-collapse: collapse; width: 100%; } td, th { text-align: left; padding: .25rem .6rem;
  border-bottom: 1px solid var(--line); vertical-align: top; }
@media print { body { max-width: none; padding: 0; } article { break-inside: avoid; } }
"""


@dataclass(frozen=True, slots=True)
class About:
    """What a report is about.

    Attributes:
        language: Of its words.
        facts: What was examined, by the name of the fact: `router`, `domain` and so on.
        made: When, as it is shown.
    """

    language: Language
    facts: tuple[tuple[str, str], ...]
    made: str


def report_of(seen: Seen, found: Examination, language: Language) -> str:
    """Write the report of what was just seen and found."""
    words = words_of(repository_or_wheel("frontend_assets"), language)
    made = datetime.now().astimezone().strftime("%Y-%m-%d %H:%M:%S %Z")
    return report_html(found, About(language, facts_of(seen), made), words)


def facts_of(seen: Seen) -> tuple[tuple[str, str], ...]:
    """Return what was examined, by the names of its facts."""
    if seen.system is not None:
        place = (seen.system.endpoint, seen.system.domain, seen.system.profile.distro)
    elif seen.place is not None:
        place = (seen.place.endpoint, seen.place.domain, seen.place.distro)
    else:
        return ()
    router, domain, distro = place
    facts = [("router", router), ("domain", str(domain)), ("distribution", distro)]
    if seen.system is not None:
        facts.append(("nodes", str(len(seen.system.others))))
        bridges = [f"{short(one.name)} {one.version}".strip() for one in seen.system.bridges[:8]]
        facts += [("bridges", ", ".join(bridges))] if bridges else []
    return tuple(facts)


def words_of(assets: Path, language: Language) -> dict[str, str]:
    """Return the words of the Doctor's panel, which the report shares.

    Args:
        assets: Folder of the page.
        language: One of its two.
    """
    file = assets / "panels" / "doctor" / "panel.json"
    content: object = json.loads(file.read_text(encoding="utf-8"))
    words = cast("dict[str, dict[str, dict[str, str]]]", content)["words"]
    return words[language]


def report_html(examination: Examination, about: About, words: Mapping[str, str]) -> str:
    """Write the report."""
    parts = [
        "<!doctype html>",
        f'<html lang="{about.language}"><head><meta charset="utf-8">',
        f'<meta http-equiv="Content-Security-Policy" content="{_POLICY}">',
        '<meta name="viewport" content="width=device-width">',
        f"<title>{_TITLE[about.language]}</title><style>{_STYLE}</style></head><body>",
        f"<h1>{_TITLE[about.language]}</h1>",
        f'<p class="quiet">{_text(about.made)}</p>',
        _table(tuple((_FACTS[name], value) for name, value in about.facts)),
        *_findings(examination, words),
        f"<h2>{_text(words['doctor.looked'])}</h2>",
        _subjects(examination.subjects, words),
        f'<p class="quiet">{_text(_PRIVATE[about.language])}</p></body></html>',
    ]
    return "\n".join(parts) + "\n"


def without_homes(text: str) -> str:
    """Return a text in which home folders are `~`: their names are those of persons."""
    home = str(Path.home())
    if len(home) > 1:
        text = text.replace(home, "~")
    return _HOMES.sub("~", text)


def _findings(examination: Examination, words: Mapping[str, str]) -> Iterator[str]:
    if not any(one.level != "note" for one in examination.findings):
        yield f'<h2 class="well">✔ {_text(words["doctor.well"])}</h2>'
    for level in _LEVELS:
        of_level = [one for one in examination.findings if one.level == level]
        if of_level:
            title = words[f"doctor.level.{level}"]
            yield f'<h2 class="{level}">{_SIGNS[level]} {_text(title)} ({len(of_level)})</h2>'
            yield from (_finding(one, words) for one in of_level)
    if examination.more:
        more = words["doctor.more"].replace("{count}", str(examination.more))
        yield f'<p class="quiet">{_text(more)}</p>'


def _finding(finding: Finding, words: Mapping[str, str]) -> str:
    title = words.get(f"doctor.code.{finding.code}", finding.code)
    why = words.get(f"doctor.why.{finding.code}", "")
    lines = "\n".join(_text(one) for one in finding.evidence)
    return "".join(
        (
            f'<article class="{finding.level}"><h3>{_text(title)}</h3>',
            f"<p>{_text(finding.sentence)}</p>",
            _talk(finding.talk, words) if finding.talk else "",
            f'<p class="quiet">{_text(why)}</p>' if why else "",
            f"<pre><code>{lines}</code></pre>" if lines else "",
            f"<pre><code>$ {_text(finding.line)}</code></pre>" if finding.line else "",
            "</article>",
        )
    )


def _talk(talk: Talk, words: Mapping[str, str]) -> str:
    nobody = f'<span class="nobody">{_text(words["doctor.nobody"])}</span>'
    sources = "".join(f"<span>{_text(one)}</span>" for one in talk.sources) or nobody
    targets = "".join(f"<span>{_text(one)}</span>" for one in talk.targets) or nobody
    arrow = "<i>→</i>" if talk.meets else '<i class="error">⇸</i>'
    middle = f"<span><code>{_text(talk.name)}</code></span>"
    return f'<div class="talk">{sources}{arrow}{middle}{arrow}{targets}</div>'


def _subjects(subjects: tuple[SubjectView, ...], words: Mapping[str, str]) -> str:
    rows: list[tuple[str, str]] = []
    for one in subjects:
        state = words[f"doctor.state.{one.state}"]
        count = f"{one.count}" if one.state != "not_examined" else ""
        told = " · ".join(part for part in (state, count, one.detail) if part)
        rows.append((words[f"doctor.subject.{one.subject}"], told))
    return _table(tuple(rows))


def _table(rows: tuple[tuple[str, str], ...]) -> str:
    cells = (f"<tr><th>{_text(name)}</th><td>{_text(value)}</td></tr>" for name, value in rows)
    return f"<table>{''.join(cells)}</table>"


def _text(text: str) -> str:
    return escape(without_homes(text))
