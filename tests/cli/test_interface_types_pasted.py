from __future__ import annotations

import io

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.cli.interface_types import CHARACTERS_MAX, pasted_texts
from studio.errors import SettingsError
from tests.support.command_line import studio

RULE = "=" * 80
PASTED = f"""\
MSG: own_interfaces/Telemetry
# Of a robot.
float32 voltage
own_interfaces/Cell[] cells
{RULE}
MSG: own_interfaces/msg/Cell
float32 voltage
{RULE}
SRV: own_interfaces/Ask
string what
---
bool known
"""


def test_each_text_is_named_by_the_line_above_it():
    assert pasted_texts(io.StringIO(PASTED)) == {
        "own_interfaces/msg/Telemetry":
            "# Of a robot.\nfloat32 voltage\nown_interfaces/Cell[] cells\n",
        "own_interfaces/msg/Cell": "float32 voltage\n",
        "own_interfaces/srv/Ask": "string what\n---\nbool known\n",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "nothing came"),
        ("float32 x\n", '"float32 x" comes first'),
        ("MSG: Telemetry\n", "a type is named"),
        ("MSG: own/nested/msg/Telemetry\n", "a type is named"),
        (" " * (CHARACTERS_MAX + 1), "characters came"),
    ],
)
def test_a_text_without_a_name_is_refused(text: str, said: str):
    with pytest.raises(SettingsError, match=said):
        pasted_texts(io.StringIO(text))


def test_t11_a_pasted_type_is_usable_at_once_and_its_hash_is_shown(
    monkeypatch: pytest.MonkeyPatch,
):
    monkeypatch.setattr("sys.stdin", io.StringIO("MSG: own_interfaces/Twin\nstring data\n"))
    ran = studio("interface", "hash", "own_interfaces/msg/Twin", "--interfaces", "-")
    assert ran.code == 0, ran.err
    assert len(ran.out) == len("RIHS01_\n") + 64
    monkeypatch.setattr("sys.stdin", io.StringIO(PASTED))
    shown = studio("interface", "show", "own_interfaces/Telemetry", "--interfaces", "-").out
    assert shown == (
        "# Of a robot.\nfloat32 voltage\nown_interfaces/Cell[] cells\n\tfloat32 voltage\n"
    )


@given(st.text() | st.from_regex(r"(MSG: \S+\n|=+\n|float32 x\n|---\n)*"))
def test_any_text_is_types_by_name_or_one_sentence(text: str):
    said = ""
    try:
        assert pasted_texts(io.StringIO(text))
    except SettingsError as error:
        said = str(error)
    assert said == "" or said.startswith("--interfaces -: ")
