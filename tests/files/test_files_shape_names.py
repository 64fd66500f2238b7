from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stages.files import errors, shape_names

PATH = Path(__file__).parents[2] / "stages" / "tables" / "shape_names.tsv"
TABLE = shape_names.read(PATH)
SPELLED = [(shape, part) for shape in TABLE for parts in shape.spellings.values() for part in parts]


def test_the_set_is_whole_and_symmetric():
    by_name = {shape.name: shape for shape in TABLE}
    assert len(by_name) == len(TABLE) == 52
    assert sum(bool(shape.spellings["mediapipe"]) for shape in TABLE) == 51
    assert sum(len(shape.spellings["ict"]) for shape in TABLE) == 53
    opposite = {"left": "right", "right": "left", "middle": "middle"}
    for shape in TABLE:
        assert by_name[shape.mirror].mirror == shape.name
        assert by_name[shape.mirror].side == opposite[shape.side]
    assert by_name["mouthClose"].kind == "corrective_of:jawOpen"
    # the order of Live Link Face, where right comes before left for the jaw and the mouth
    order = [shape.spellings["livelink"][0] for shape in TABLE]
    assert order[15:18] == ["JawRight", "JawLeft", "JawOpen"]
    assert order.index("MouthRight") == order.index("MouthLeft") - 1


@given(st.sampled_from(SPELLED), st.sampled_from([str, str.upper, str.lower]))
def test_every_spelling_finds_its_shape(spelled, change):
    shape, part = spelled
    assert shape.name in shape_names.names_of(TABLE, change(part))
    if part not in shape.spellings["vrm"]:
        assert shape_names.names_of(TABLE, change(part)) == [shape.name]


def test_shared_and_unknown_spellings_have_no_single_shape():
    assert shape_names.names_of(TABLE, "lookUp") == ["eyeLookUpLeft", "eyeLookUpRight"]
    assert shape_names.names_of(TABLE, "earWiggle") == []
    assert shape_names.names_of(TABLE, "_neutral") == []


@pytest.mark.parametrize(
    ("available", "found"),
    [
        (["browInnerUp_R", "jawOpen", "browInnerUp_L"], ["browInnerUp_L", "browInnerUp_R"]),
        (["BrowInnerUp", "jawOpen"], ["BrowInnerUp"]),
        (["brow_inner_up", "browInnerUp_L"], ["brow_inner_up"]),
        (["jawOpen"], []),
    ],
)
def test_a_rig_may_spell_as_it_likes(available, found):
    shape = next(shape for shape in TABLE if shape.name == "browInnerUp")
    assert shape_names.spelt(shape, available) == found


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("\tmiddle\t", "\tcentre\t", "line 16, column side: 'centre'"),
        ("corrective_of:jawOpen", "corrective_of:chin", "line 20, column kind"),
        ("\t0\t1\t", "\t1\t0\t", "line 2: low 1 is not below high 0"),
        ("\t0\t1\t", "\tnone\t1\t", "line 2, column low: 'none'"),
        ("EyeWideRight", "", None),
    ],
)
def test_faults_have_a_place(tmp_path, old, new, fault):
    path = tmp_path / "names.tsv"
    path.write_text(PATH.read_text().replace(old, new, 1))
    if fault is None:
        assert shape_names.read(path)[13].spellings["livelink"] == ()
        return
    with pytest.raises(errors.InputError, match=fault):
        shape_names.read(path)
