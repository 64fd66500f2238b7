import re
from pathlib import Path

import pytest
import yaml

from stages import train_tracker
from stages.core import key_shape_selection, key_weights
from stages.files import region_settings, rig

PROJECT = Path(__file__).parents[2]
SCHEMAS = {
    path.stem: yaml.safe_load(path.read_text())
    for path in sorted((PROJECT / "workflow/schemas").glob("*.yaml"))
}


@pytest.mark.parametrize("name", SCHEMAS)
def test_every_setting_is_described_in_the_same_words(name):
    readme = (PROJECT / "config/README.md").read_text()
    schema = SCHEMAS[name]
    assert schema["additionalProperties"] is False
    section = readme.split(f"## {name}.", 1)[1].split("\n## ", 1)[0]
    for column, rule in schema["properties"].items():
        assert re.search(rf"\| `{column}`[^|]*\| {re.escape(rule['description'])} \|", section)
        for choice in rule.get("enum", []):
            assert name == "config" or f"`{choice}`" in section


def test_choices_and_defaults_are_those_of_the_code():
    rows = SCHEMAS["region_settings"]["properties"]
    assert rows["method"]["enum"] == list(key_shape_selection.SELECTORS)
    assert rows["solve"]["enum"] == list(key_weights.SOLVES)
    defaults = {name: rows[name].get("default", "") for name in region_settings.DEFAULTS}
    assert defaults == region_settings.DEFAULTS
    units = SCHEMAS["characters"]["properties"]["unit"]["enum"]
    assert sorted(units) == sorted(rig.METRES)
    parser = train_tracker.build_parser()
    (method,) = [a for a in parser._actions if a.dest == "method"]
    assert list(method.choices) == SCHEMAS["config"]["properties"]["tracker_method"]["enum"]
