"""The graph of a run, walked from what came out to the source and back."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.evaluator.graph import Argument, Cell, Role, YamlValue, behind
from tests.support.descriptions import evaluation_of, policy_for, robot, write

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from studio.description.evaluator.evaluation import Evaluation
    from studio.description.evaluator.graph import Readable, Record
    from studio.description.evaluator.output_tree import OutputElement

BODY = """
<xacro:arg name="size" default="2"/>
<xacro:property name="limits" value="${xacro.load_yaml('l.yaml')}"/>
<xacro:property name="radius" value="${$(arg size) * limits.scale}"/>
<xacro:property name="unread" value="${radius}"/>
<xacro:macro name="ball" params="r:=1 *extra">
  <sphere radius="${r}"><xacro:insert_block name="extra"/></sphere>
</xacro:macro>
<xacro:ball r="${radius}"><origin xyz="0 0 ${radius / 2}" rpy="0 0 0"/></xacro:ball>
<xacro:if value="${radius > 1}"><big/></xacro:if>
"""


def expanded(folder: Path) -> tuple[Evaluation, OutputElement]:
    file = write(folder, {"r.xacro": robot(BODY), "l.yaml": "scale: 3\nother: 4\n"})
    evaluation = evaluation_of(policy_for(folder))
    return evaluation, evaluation.run(str(file))


def names(found: list[Readable]) -> set[str]:
    """What was read: names of properties and args, keys of YAML."""
    said: set[str] = set()
    for one in found:
        match one:
            case Cell() | Argument():
                said.add(one.name)
            case YamlValue():
                said.add(".".join(map(str, one.path)))
            case _:
                pass
    return said


def ahead(start: Readable) -> Iterator[Record]:
    """All records that depend on something, the nearest first, each once."""
    seen: set[Record] = set()
    front = [start]
    while front:
        readers = dict.fromkeys(reader for one in front for reader in one.readers)
        found = [one for one in readers if one not in seen]
        seen.update(found)
        yield from found
        front = [made for one in found if (made := one.made) is not None]


def test_an_attribute_leads_back_through_properties_to_args_and_yaml_keys(tmp_path: Path):
    _, root = expanded(tmp_path)
    sphere = next(root.elements())
    found = list(behind(sphere.makers["radius"]))
    assert names(found) == {"r", "radius", "size", "limits", "scale"}
    assert names(found[:1]) == {"r"}


def test_a_property_leads_on_to_every_attribute_and_condition_made_of_it(tmp_path: Path):
    evaluation, root = expanded(tmp_path)
    sphere = next(root.elements())
    (binding,) = (one for one in evaluation.bindings.values() if one.name == "radius")
    (cell,) = binding.holders
    sinks = [record.sink for record in ahead(cell)]
    elements = [one for sink in sinks if isinstance(sink, list) for one in sink]
    assert sphere in elements
    assert next(sphere.elements()) in elements
    assert Role.CONDITION in sinks


def test_a_block_shares_the_record_of_its_first_evaluation(tmp_path: Path):
    _, root = expanded(tmp_path)
    origin = next(next(root.elements()).elements())
    made = origin.makers["xyz"].sink
    assert isinstance(made, list)
    assert len(made) == 2
    assert "rpy" not in origin.makers


def test_whatever_a_record_read_was_evaluated_before_it(tmp_path: Path):
    evaluation, _ = expanded(tmp_path)
    for binding in evaluation.bindings.values():
        for holder in binding.holders:
            for record in ahead(holder):
                made = [getattr(read, "record", None) for read in record.reads]
                assert all(one.order < record.order for one in made if one is not None)
