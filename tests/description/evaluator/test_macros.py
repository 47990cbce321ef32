"""Parameters of macros, read as stock reads them, and macros found by name."""

# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false
from __future__ import annotations

import xacro
from hypothesis import given
from hypothesis import strategies as st

from studio.description.evaluator.macros import Macro, MacroTable
from studio.description.syntax.params import Default, read_parameters
from studio.description.syntax.source_tree import parse_source

BODY = parse_source("a.xacro", b"<a/>").root
words = st.text(alphabet="ab*^|:='\" ${}().1", max_size=24)


def read_by_stock(text: str) -> tuple[list[str], dict[str, Default]]:
    names: list[str] = []
    defaults: dict[str, Default] = {}
    while text.strip():
        name, default, text = xacro.parse_macro_arg(text)
        names.append(name)
        if default is not None:
            defaults[name] = Default(default[0] is not None, default[1])
    return names, defaults


@given(words)
def test_parameters_are_read_as_xacro_reads_them(text: str):
    assert read_parameters(text) == read_by_stock(text)


def test_each_form_of_a_parameter():
    names, defaults = read_parameters("a b:=1 c='x y' d:=^ e:=^|${f + 1} *g **h")
    assert names == ["a", "b", "c", "d", "e", "*g", "**h"]
    assert defaults == {
        "b": Default(forward=False, text="1"),
        "c": Default(forward=False, text="'x y'"),
        "d": Default(forward=True, text=None),
        "e": Default(forward=True, text="${f + 1}"),
    }


def test_a_table_looks_into_its_parents_and_namespaces():
    outer, namespace = MacroTable(), MacroTable()
    outer.put("ns", namespace)
    namespace.put("m", Macro("m", BODY))
    inner = MacroTable(outer)
    assert inner.find("ns") is namespace
    assert inner.own("ns") is None
    assert list(inner.all_names()) == ["ns.m"]
    assert inner.find("m") is None
