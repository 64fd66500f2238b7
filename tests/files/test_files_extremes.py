from collections import Counter
from pathlib import Path

import pytest

from stages.files import errors, extremes, visemes

TABLES = Path(__file__).parents[2] / "stages" / "tables"


def test_emotions_are_plutchiks():
    emotions = [e for e in extremes.read(TABLES / "extremes.tsv") if e.layer == "emotion"]
    assert len(emotions) == 1 + 32
    families = Counter(e.family for e in emotions if e.family)
    assert len(families) == 8 and set(families.values()) == {3}
    assert {(e.family, e.degree) for e in emotions if e.family} == {
        (family, degree) for family in families for degree in (1, 2, 3)
    }
    # a family has the name of its medium degree
    assert {e.family for e in emotions if e.degree == 2 and e.name == e.family} == set(families)
    ring = list(families)
    blends = [e.note for e in emotions if not e.family and e.name != "neutral"]
    neighbours = {frozenset(pair) for pair in zip(ring, [*ring[1:], ring[0]], strict=True)}
    assert {frozenset(note.split(" and ")) for note in blends} == neighbours


def test_every_viseme_is_an_extreme_and_lists_its_phones():
    speech = [e for e in extremes.read(TABLES / "extremes.tsv") if e.layer == "speech"]
    assert len(speech) == 12
    table = visemes.read(TABLES / "visemes.tsv", "kholgade2011")
    assert {name for name in table.values() if name} == {e.name for e in speech}
    assert [phone for phone, name in table.items() if not name] == ["spn"]
    for extreme in speech:
        listed = extreme.note.partition(":")[0].split()
        assert listed and {table[phone] for phone in listed} == {extreme.name}


def test_layers_rest_at_extremes_of_the_table():
    known = {(e.layer, e.name) for e in extremes.read(TABLES / "extremes.tsv")}
    assert set(extremes.AT_REST.items()) | {extremes.CLOSED_LIPS} <= known
    assert {layer for layer, _ in known} == set(extremes.LAYERS)
    assert extremes.nearest(extremes.read(TABLES / "extremes.tsv"), "emotion", "angr") == "anger"


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ("mood\tjoy\t\t\t", r"line 2: 'mood' is no layer: write emotion, speech, blink"),
        ("emotion\t\t\t\t", r"line 2: emotion '' stands twice or has no name"),
        ("blink\ta\t\t\t\nblink\ta\t\t\t", r"line 3: blink 'a' stands twice"),
        ("emotion\tjoy\tjoy\t\t", r"line 2: family 'joy' and degree '' do not belong together"),
        ("emotion\tjoy\tjoy\t4\t", r"degree '4' do not belong together: give both"),
    ],
)
def test_a_bad_table_is_named(tmp_path, row, message):
    path = tmp_path / "extremes.tsv"
    path.write_text(f"layer\tname\tfamily\tdegree\tnote\n{row}\n", encoding="utf-8")
    with pytest.raises(errors.InputError, match=rf"extremes\.tsv: .*{message}"):
        extremes.read(path)
