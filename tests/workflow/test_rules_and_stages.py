"""A rule and its stage say the same things by the same names."""

import importlib
import re
from pathlib import Path

import pytest

PROJECT = Path(__file__).parents[2]
RULES = {
    name: body
    for path in (PROJECT / "workflow" / "rules").glob("*.smk")
    for name, body in re.findall(r"^rule (\w+):\n(.*?)(?=^\S|\Z)", path.read_text(), re.M | re.S)
}
PLACE = r"--([\w-]+)[ =]\{(?:input|output|params|wildcards)\.(\w+)(?::q)?\}"


def test_every_stage_has_a_rule_of_its_name():
    stages = {path.stem for path in (PROJECT / "stages").glob("*.py")}
    # the report is written when the run has ended, whether it succeeded or not
    assert stages - {"__init__", "cli", "write_report"} == set(RULES)


@pytest.mark.parametrize("name", RULES)
def test_flags_are_the_rules_names(name):
    body = RULES[name]
    assert f'"python -m stages.{name}"' in body
    assert f'code=code_of("{name}")' in body
    given = re.findall(PLACE, body)
    assert [flag for flag, _ in given] == [source.replace("_", "-") for _, source in given]
    actions = importlib.import_module(f"stages.{name}").build_parser()._actions
    required = {action.option_strings[0][2:] for action in actions if action.required}
    known = {option[2:] for action in actions for option in action.option_strings}
    assert required <= {flag for flag, _ in given} <= known
