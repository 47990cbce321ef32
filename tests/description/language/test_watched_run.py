"""What is seen of a run that is watched."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.description.evaluator.source_store import SourceStore
from studio.description.faults import Fault
from studio.description.language.subject import printed
from studio.description.language.watched_run import CALLS_KEPT, VALUES_KEPT, WatchedRun
from studio.packages.roots import ServedRoots
from tests.support.descriptions import canonical, expand, policy_for, robot, write

if TYPE_CHECKING:
    from pathlib import Path

    from studio.description.language.watched_run import Trace


def watched(folder: Path, files: dict[str, str]) -> Trace:
    entry = write(folder, dict(files))
    store = SourceStore(ServedRoots([folder]), {})
    return WatchedRun(store, policy_for(folder), {}).trace(str(entry))


def values(trace: Trace) -> dict[str, list[str]]:
    """What each text came to, by element and text."""
    return {
        f"{element.tag} {text}": [printed(one.value) for one in seen]
        for (element, _, text), seen in trace.seen.evaluated.items()
    }


def test_a_watched_run_gives_what_any_run_gives(tmp_path: Path):
    body = """<xacro:property name="a" value="${1 + 1}"/>
      <xacro:macro name="m" params="n *b"><link name="${n}"><xacro:insert_block name="b"/></link>
      </xacro:macro><xacro:m n="x${a}"><visual/></xacro:m>"""
    trace = watched(tmp_path, {"a.xacro": robot(body)})
    assert canonical(trace.root) == canonical(expand(tmp_path / "a.xacro"))


def test_each_text_is_seen_with_each_of_its_values(tmp_path: Path):
    body = """<xacro:property name="a" value="${1 + 1}"/>
      <xacro:macro name="m" params="n k:=${a * 2}"><link name="${n}_${k}"/></xacro:macro>
      <xacro:m n="x"/><xacro:m n="y" k="${a}"/>"""
    seen = values(watched(tmp_path, {"a.xacro": robot(body)}))
    assert seen["xacro:property 1 + 1"] == ["2"]
    assert seen["link n"] == ["x", "y"]
    assert seen["link k"] == ["4", "2"]
    assert seen["xacro:m a * 2"] == ["4"], "a default is evaluated where the macro is called"


def test_only_the_first_values_and_calls_are_kept_and_all_calls_counted(tmp_path: Path):
    calls = "".join(f'<xacro:m n="{n}"/>' for n in range(CALLS_KEPT + 5))
    body = f'<xacro:macro name="m" params="n"><link name="l${{n}}"/></xacro:macro>{calls}'
    trace = watched(tmp_path, {"a.xacro": robot(body)})
    assert len(values(trace)["link n"]) == VALUES_KEPT
    ((macro, kept),) = trace.seen.calls.items()
    assert (len(kept), trace.seen.call_counts[macro]) == (CALLS_KEPT, CALLS_KEPT + 5)


def test_includes_know_what_they_stand_in_also_after_one_that_failed(tmp_path: Path):
    files = {
        "a.xacro": robot(
            '<xacro:include filename="bad.xacro" optional="true"/>'
            '<xacro:include filename="b.xacro"/><xacro:include filename="c.xacro"/>'
        ),
        "b.xacro": robot('<xacro:include filename="c.xacro" ns="n"/>'),
        "c.xacro": robot(""),
        "bad.xacro": robot('<xacro:include filename="c.xacro"/><xacro:include filename="lost"/>'),
    }
    includes = watched(tmp_path, files).seen.includes
    told = [(one.file.rpartition("/")[2], one.inside) for one in includes]
    assert told[-3:] == [("b.xacro", -1), ("c.xacro", len(told) - 3), ("c.xacro", -1)]


def test_a_run_that_fails_is_no_trace(tmp_path: Path):
    with pytest.raises(Fault):
        watched(tmp_path, {"a.xacro": robot('<link name="${lost}"/>')})
