from __future__ import annotations

from studio.packages.sources.setup_cfg import SetupCfg


def test_scripts_have_their_lines_and_bytes():
    lines = b"    a = p.a:main\n\n    # c\n    b = p.b:main\n"
    data = b"[options.entry_points]\nconsole_scripts =\n" + lines
    found = SetupCfg("setup.cfg", data).scripts
    assert [(one.line, one.name, one.place) for one in found] == [
        *((3, "a", "p.a:main"), (6, "b", "p.b:main")),
    ]
    assert [data[one.start : one.end] for one in found] == [b"a = p.a:main", b"b = p.b:main"]
    beside = SetupCfg("setup.cfg", data.replace(b"=\n    a", b"= a")).scripts
    assert [(one.line, one.name) for one in beside] == [(2, "a"), (5, "b")]


def test_a_setup_cfg_without_entry_points_has_no_scripts():
    assert SetupCfg("setup.cfg", b"[develop]\nscript-dir=x\n").scripts == ()
