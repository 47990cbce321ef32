from __future__ import annotations

from typing import TYPE_CHECKING

from studio.packages.sources.package_source import PackageSource

if TYPE_CHECKING:
    from pathlib import Path


def test_a_module_is_found_from_each_folder_that_packages_may_lie_in(tmp_path: Path):
    for name in ("p/__init__.py", "p/a.py", "src/p/b.py", "lib/p/c.py"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("")
    (tmp_path / "setup.py").write_text("setup(package_dir={'': 'lib'})")
    source = PackageSource(tmp_path)
    assert source.module("p.a") == ("", "p/a.py")
    assert source.module("p") == ("", "p/__init__.py")
    assert source.module("p.b") == ("src", "src/p/b.py")
    assert source.module("p.c") == ("lib", "lib/p/c.py")
    assert source.module("p.gone") is None


def test_a_file_that_leads_outside_is_not_of_the_package(tmp_path: Path):
    folder = tmp_path / "pkg"
    folder.mkdir()
    (tmp_path / "other.py").write_text("")
    (folder / "link.py").symlink_to(tmp_path / "other.py")
    source = PackageSource(folder)
    for name in ("link.py", "../other.py", str(tmp_path / "other.py"), "a\0", "x" * 5_000, ""):
        assert not source.has(name)


def test_scripts_are_those_of_both_files(tmp_path: Path):
    (tmp_path / "setup.cfg").write_text("[options.entry_points]\nconsole_scripts = b = p.b:main\n")
    (tmp_path / "setup.py").write_text("setup(entry_points={'console_scripts': ['a = p.a:main']})")
    source = PackageSource(tmp_path)
    assert [one.name for one in source.scripts] == ["a", "b"]
    found = source.script("b")
    assert found is not None
    assert found.source.file == str(tmp_path / "setup.cfg")


def test_a_file_that_is_too_large_is_not_read(tmp_path: Path):
    (tmp_path / "setup.py").write_text("#" * 2_000_000)
    assert PackageSource(tmp_path).setup is None
