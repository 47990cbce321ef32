from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.web_server import RunningWeb, running_web

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

INDEX = """<!doctype html><script type="importmap" nonce="{{nonce}}">{}</script>
<script type="module" src="{{base}}app/main.js"></script>"""


@pytest.fixture(scope="session")
def assets_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("assets")
    for name, text in {
        "index.html": INDEX,
        "app/main.js": "export const answer = 42;\n" * 50,
        "styles/app.css": "body { margin: 0 }",
        "workers/data.js": "// hears",
        "workers/probe.js": "// looks",
        "tools/secret.js": "not served",
        ".hidden.js": "not served",
        "notes.py": "not served",
    }.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    (folder.parent / "outside.js").write_text("outside")
    return folder


@pytest.fixture(scope="module")
def web(assets_folder: Path) -> Iterator[RunningWeb]:
    with running_web(assets_folder) as running:
        yield running
