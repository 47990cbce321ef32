from __future__ import annotations

from studio.classroom.qr_code import qr_lines, qr_svg

ADDRESS = "https://robots.example/class/join?code=aB3-xyz"


def test_the_picture_stands_alone_and_holds_nothing_but_shapes():
    picture = qr_svg(ADDRESS)
    assert picture.startswith('<svg xmlns="http://www.w3.org/2000/svg"')
    assert "script" not in picture
    assert ADDRESS not in picture
    assert picture != qr_svg(ADDRESS + "x")


def test_a_terminal_shows_it_in_half_blocks():
    lines = qr_lines(ADDRESS).splitlines()
    assert len(lines) > 10
    assert len({len(line) for line in lines}) == 1
    assert set("".join(lines)) <= set(" ▀▄█")
