from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING

import pytest

from studio.errors import NotMadeError
from studio.packages.received_texts import drop_untitled, new_untitled, untitled_number

if TYPE_CHECKING:
    from pathlib import Path

ROBOT = '<robot name="r">\r\n  <link name="a"/>\r\n</robot>'


def test_a_text_is_kept_as_it_was_pasted(tmp_path: Path):
    file = new_untitled(tmp_path, "\ufeff" + ROBOT)
    assert file.read_bytes() == ROBOT.encode()
    assert untitled_number(file, tmp_path) == 1


def test_a_broken_robot_is_kept_too(tmp_path: Path):
    broken = '<robot name="r"><link name="a">'
    assert new_untitled(tmp_path, broken).read_text() == broken


def test_parts_of_a_robot_get_a_robot_around_them(tmp_path: Path):
    parts = '<?xml version="1.0"?>\n<link name="a"/>\n<xacro:property name="b" value="1"/>'
    text = new_untitled(tmp_path, parts).read_text()
    assert text.startswith('<?xml version="1.0"?>\n<robot name="untitled" xmlns:xacro=')
    assert text.count("<?xml") == 1
    assert text.endswith("</robot>\n")


@pytest.mark.parametrize("text", ["", "hello", "<html><p>link</p></html>", "<sdf/>", "robot"])
def test_a_text_that_is_no_robot_is_refused_and_leaves_nothing(tmp_path: Path, text: str):
    with pytest.raises(NotMadeError, match="no robot description"):
        new_untitled(tmp_path, text)
    assert list(tmp_path.iterdir()) == []


def test_many_at_once_get_names_of_their_own(tmp_path: Path):
    with ThreadPoolExecutor(8) as pool:
        asked = [pool.submit(new_untitled, tmp_path, ROBOT) for _ in range(24)]
        files = [one.result() for one in asked]
    assert {untitled_number(one, tmp_path) for one in files} == set(range(1, 25))


def test_a_number_that_became_free_is_used_again(tmp_path: Path):
    first, second = new_untitled(tmp_path, ROBOT), new_untitled(tmp_path, ROBOT)
    drop_untitled(first, tmp_path)
    assert not first.parent.exists()
    assert second.exists()
    assert new_untitled(tmp_path, ROBOT) == first


def test_only_untitled_texts_are_dropped(tmp_path: Path):
    own = tmp_path / "untitled-1" / "untitled-1.urdf.xacro"
    own.parent.mkdir()
    own.write_text(ROBOT)
    drop_untitled(own, tmp_path)
    assert own.exists()
    assert untitled_number(own, tmp_path) is None


def test_half_a_sign_of_a_clipboard_does_no_harm(tmp_path: Path):
    file = new_untitled(tmp_path, '<robot name="\ud83e"/>')
    assert file.read_bytes() == b'<robot name="?"/>'


def test_a_data_folder_that_cannot_take_it_is_said(tmp_path: Path):
    (tmp_path / "untitled").write_text("a file")
    with pytest.raises(NotMadeError, match="the data folder cannot take it"):
        new_untitled(tmp_path, ROBOT)


@pytest.mark.parametrize("rest", [" " * 900_000, "<?xml" * 180_000, "\n<?xml " * 120_000])
def test_a_paste_that_goes_on_and_on_takes_no_longer_for_it(tmp_path: Path, rest: str):
    text = f"<link/>{rest}"
    assert text in new_untitled(tmp_path, text).read_text()


def test_a_declaration_below_the_first_line_goes_too(tmp_path: Path):
    text = new_untitled(tmp_path, '\n <?xml version="1.0"?> \n<link name="a"/>').read_text()
    assert text.count("<?xml") == 1
    assert '\n<link name="a"/>\n' in text
