"""Checks of a package.xml: is it XML, has it what every package has, are its tags tags."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from studio.packages.lint.checked import ERROR, INFO, WARNING, edit, found, meant
from studio.packages.sources.package_xml import DEPENDENCY_TAGS, TAGS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.packages.lint.checked import CheckedPackage
    from studio.packages.sources.package_xml import PackageXml
    from studio.problems import Problem

_UNOPENED: Final = re.compile(
    rb"(?m)^[ \t]*(?:<(?P<open>[a-z_]+)>)?[ \t]*<?(?P<text>[A-Za-z][\w.-]*)/(?P<tag>[a-z_]+)>"
)
_STRAY: Final = re.compile(rb"</?(?:pre|code|p|br|div|span)\s*/?>")
_SPACED: Final = re.compile(
    rb"<(/?)((?:buildtool|build|exec|test|doc|run|build export|buildtool export)[ -]depend|"
    rb"member[ -]of[ -]group|build[ -]type|group[ -]depend)>"
)
_TEXT_OF_NAME: Final = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.+-]*")


def findings(checked: CheckedPackage) -> Iterator[Problem]:
    """Yield what is wrong with the file as a text, then what is wrong with its elements."""
    manifest = checked.source.manifest
    if not manifest.source.data:
        yield found(ERROR, "package-xml-unreadable", "package.xml cannot be read.", manifest.source)
        return
    broken = list(_broken(manifest))
    yield from broken
    if manifest.fault and not broken:
        at = manifest.source.offset(manifest.fault_line)
        sentence = f"package.xml is no XML from this line on: {manifest.fault}."
        yield found(ERROR, "package-xml-broken", sentence, manifest.source, at)
    if not manifest.fault:
        yield from _lacking(manifest)
    yield from _elements(manifest)


def _broken(manifest: PackageXml) -> Iterator[Problem]:
    source = manifest.source
    for one in _STRAY.finditer(source.data) if manifest.fault else ():
        tag = one[0].decode()
        sentence = f"{tag} is of a web page, not of package.xml: take it out."
        mend = edit(f"Remove {tag}", source.without_lines(one.start(), one.end()))
        yield found(ERROR, "package-xml-stray-tag", sentence, source, one.start(), mend)
    for one in _SPACED.finditer(source.data):
        wrong = one[2].decode()
        right = re.sub(r"[ -]", "_", wrong)
        yield found(
            ERROR,
            "package-xml-spaced-tag",
            f"<{one[1].decode()}{wrong}> is written with an underscore: <{right}>.",
            source,
            one.start(),
            edit(f"Write {right}", source.replaced(one.start(2), one.end(2), right)),
        )
    for one in _UNOPENED.finditer(source.data):
        tag, opened = one["tag"].decode(), (one["open"] or one["tag"]).decode()
        if tag in TAGS and tag == opened:
            start = one.start() + _blanks(one[0])
            yield _unopened(manifest, start, one.end(), one["text"].decode(), tag)


def _blanks(text: bytes) -> int:
    return len(text) - len(text.lstrip(b" \t"))


def _unopened(manifest: PackageXml, start: int, end: int, text: str, tag: str) -> Problem:
    source = manifest.source
    right = f"<{tag}>{text}</{tag}>"
    return found(
        ERROR,
        "package-xml-unopened-tag",
        f"{source.slice(start, end)} is half a tag: {right} is meant.",
        source,
        start,
        edit(f"Write {right}", source.replaced(start, end, right)),
    )


def _lacking(manifest: PackageXml) -> Iterator[Problem]:
    for tag in ("name", "version", "description", "maintainer", "license"):
        rows = manifest.of(tag)
        if not rows:
            yield found(
                ERROR,
                "package-xml-lacks",
                f"package.xml has no <{tag}>, which every package must have.",
                manifest.source,
            )
        for one in rows:
            if "TODO" in one.text or "todo.todo" in one.attributes.get("email", ""):
                yield found(
                    INFO,
                    "package-xml-todo",
                    f"<{tag}> is still as the package was made: say it before others get it.",
                    manifest.source,
                    one.start,
                )
            elif not one.text:
                sentence = f"<{tag}> is empty."
                yield found(ERROR, "package-xml-lacks", sentence, manifest.source, one.start)
    for one in manifest.of("maintainer"):
        if "@" not in one.attributes.get("email", ""):
            sentence = 'The <maintainer> has no e-mail address: <maintainer email="me@home.org">.'
            yield found(ERROR, "package-xml-maintainer", sentence, manifest.source, one.start)
    version = next(iter(manifest.of("version")), None)
    if version and not re.fullmatch(r"\d+\.\d+\.\d+", version.text):
        sentence = f'"{version.text}" is no version: three numbers are meant, 0.1.0.'
        yield found(ERROR, "package-xml-version", sentence, manifest.source, version.start)


def _elements(manifest: PackageXml) -> Iterator[Problem]:
    source = manifest.source
    for one in manifest.elements:
        if one.parents != ("package",):
            continue
        if one.tag not in TAGS:
            right = meant(one.tag, TAGS, 0.75)
            text = source.slice(one.start, one.end)
            mend = None
            if right and one.text and not one.attributes and text.startswith(f"<{one.tag}>"):
                whole = f"<{right}>{source.slice(one.inner_start, one.inner_end)}</{right}>"
                mend = edit(f"Write {right}", source.replaced(one.start, one.end, whole))
            hint = f": <{right}> is meant" if right else ""
            sentence = f"<{one.tag}> is no tag of package.xml{hint}."
            yield found(WARNING, "package-xml-unknown-tag", sentence, source, one.start, mend)
        elif one.tag in DEPENDENCY_TAGS and not _TEXT_OF_NAME.fullmatch(one.text):
            right = one.text.strip("/ \t\r\n<>\"'")
            mend = None
            if _TEXT_OF_NAME.fullmatch(right):
                mend = edit(
                    f"Write {right}", source.replaced(one.inner_start, one.inner_end, right)
                )
            sentence = f'<{one.tag}> names "{one.text}", which is no name of a package.'
            yield found(ERROR, "package-xml-bad-name", sentence, source, one.start, mend)
    yield from _repeated(manifest)


def _repeated(manifest: PackageXml) -> Iterator[Problem]:
    seen: set[tuple[str, str]] = set()
    for one in manifest.dependencies():
        if (one.tag, one.text) in seen:
            sentence = f"<{one.tag}>{one.text}</{one.tag}> stands here a second time."
            mend = edit("Remove it", manifest.source.without_lines(one.start, one.end))
            yield found(WARNING, "package-xml-repeated", sentence, manifest.source, one.start, mend)
        seen.add((one.tag, one.text))


WHY: Final = {
    "package-xml-unreadable": {
        "en": "colcon knows a package by its package.xml.",
        "de": "colcon erkennt ein Paket an seiner package.xml.",
    },
    "package-xml-broken": {
        "en": "colcon passes over a package whose package.xml is no XML, or stops there.",
        "de": "colcon übergeht ein Paket, dessen package.xml kein XML ist, oder bricht dort ab.",
    },
    "package-xml-stray-tag": {
        "en": "Tags that came along when a text was copied from a page make the file no XML.",
        "de": "Tags, die beim Kopieren aus einer Webseite mitkamen, machen die Datei unlesbar.",
    },
    "package-xml-spaced-tag": {
        "en": "XML takes the part behind a blank for an attribute, so the file cannot be read.",
        "de": "Was hinter einem Leerzeichen steht, ist für XML ein Attribut: Die Datei ist nicht "
        "lesbar.",
    },
    "package-xml-unopened-tag": {
        "en": "Each element begins with <tag> and ends with </tag>; half of it breaks the file.",
        "de": "Jedes Element beginnt mit <tag> und endet mit </tag>; ein halbes macht die Datei "
        "unlesbar.",
    },
    "package-xml-lacks": {
        "en": "Name, version, description, maintainer and license must be there; colcon and rosdep "
        "refuse the package without them.",
        "de": "Name, Version, Beschreibung, Betreuer und Lizenz müssen da sein; sonst weisen "
        "colcon und rosdep das Paket ab.",
    },
    "package-xml-todo": {
        "en": "Nothing fails, but nobody may use a package whose license is not said.",
        "de": "Nichts schlägt fehl, aber ohne Lizenz darf niemand das Paket verwenden.",
    },
    "package-xml-maintainer": {
        "en": "The maintainer's e-mail address must be an attribute of the tag.",
        "de": "Die E-Mail-Adresse des Betreuers muss als Attribut im Tag stehen.",
    },
    "package-xml-version": {
        "en": "A version has three numbers with dots between them; others are refused.",
        "de": "Eine Version besteht aus drei Zahlen mit Punkten; andere werden abgewiesen.",
    },
    "package-xml-unknown-tag": {
        "en": "What stands in a tag that nobody knows has no effect: a dependency is not seen.",
        "de": "Was in einem unbekannten Tag steht, wirkt nicht: Eine Abhängigkeit wird nicht "
        "gesehen.",
    },
    "package-xml-bad-name": {
        "en": "rosdep and colcon look for a package of exactly that name, and find none.",
        "de": "rosdep und colcon suchen genau diesen Namen und finden kein Paket.",
    },
    "package-xml-repeated": {
        "en": "ROS's own check of package.xml refuses the same dependency twice.",
        "de": "Die Prüfung von ROS weist dieselbe Abhängigkeit zweimal ab.",
    },
}
"""By code and language: why a finding matters, as the page explains it."""
