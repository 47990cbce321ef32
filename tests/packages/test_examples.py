from __future__ import annotations

from typing import TYPE_CHECKING

from studio.packages.examples import examples

if TYPE_CHECKING:
    from pathlib import Path


def test_every_shipped_model_says_in_one_line_what_it_shows(models: Path):
    found = examples(models)
    assert {one.package for one in found} == {
        one.parent.name for one in models.glob("*/package.xml")
    }
    for one in found:
        assert one.text.endswith(".")
        assert "\n" not in one.text
        assert 20 < len(one.text) < 120


def test_a_page_has_a_picture_of_each_in_both_themes(models: Path):
    pictures = models.parent / "frontend_assets" / "pictures"
    robots = [one.robot for one in examples(models)]
    for name in (*robots, "new-blank", "new-rover", "new-arm"):
        for theme in ("dark", "light"):
            assert (pictures / f"{name}-{theme}.webp").is_file()
