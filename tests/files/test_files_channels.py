import numpy as np
import pytest

from stages.files import channels, errors

NAMES = ["face.jawOpen", "face.eyeBlink_L", "mouth.smile", "eyes.smile"]


def read(tmp_path, text, low=0.0, high=1.0):
    path = tmp_path / "channels.tsv"
    path.write_text(text.replace(",", "\t"))
    return channels.read(path, NAMES, low, high)


def test_without_a_table_nothing_is_asked():
    made = channels.read("", NAMES, -np.inf, np.inf)
    assert made.names == NAMES
    for values, expected in (
        (made.gain, 1),
        (made.offset, 0),
        (made.low, -np.inf),
        (made.high, np.inf),
        (made.strength, 1),
    ):
        np.testing.assert_array_equal(values, np.full(4, expected))
    assert made.keep == [""] * 4


def test_rows_name_shapes_with_or_without_their_mask(tmp_path):
    text = "shape,gain,offset,low,high,smoothing,keep\n"
    text += "jawOpen,2,-0.5,,1.5,0.25,closure\nface.eyeBlink_L,,,,,0,blink\nsmile,3,,-1,,,\n"
    made = read(tmp_path, text)
    np.testing.assert_array_equal(made.gain, [2, 1, 3, 3])
    np.testing.assert_array_equal(made.offset, [-0.5, 0, 0, 0])
    np.testing.assert_array_equal(made.low, [0, 0, -1, -1])
    np.testing.assert_array_equal(made.high, [1.5, 1, 1, 1])
    np.testing.assert_array_equal(made.strength, [0.25, 0, 1, 1])
    assert made.keep == ["closure", "blink", "", ""]


def test_every_column_but_the_shape_may_be_missing(tmp_path):
    made = read(tmp_path, "shape\njawOpen\n")
    np.testing.assert_array_equal(made.gain, np.ones(4))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("shape\njawOpne\n", "line 2, column shape: the rig has no shape 'jawOpne'"),
        ("shape\njawOpen\nface.jawOpen\n", "line 3, column shape: face.jawOpen stands in line 2"),
        ("shape,low,high\njawOpen,1,0.5\n", "line 2, column low: low 1 is above high 0.5"),
        ("shape,high\njawOpen,-1\n", "line 2, column high: low 0 is above high -1"),
        ("shape,gain\njawOpen,inf\n", "line 2, column gain: 'inf' is not a number"),
        ("shape,gain\njawOpen,much\n", "line 2, column gain: 'much' is not a number"),
        ("shape,smoothing\njawOpen,-1\n", "line 2, column smoothing: '-1' is negative"),
        ("shape,keep\njawOpen,wink\n", "line 2, column keep: 'wink' is none of blink, closure"),
        ("shape,limit\njawOpen,1\n", "unknown column 'limit'"),
        ("gain\n1\n", "column 'shape' is missing"),
    ],
)
def test_a_bad_cell_is_named(tmp_path, text, message):
    with pytest.raises(errors.InputError, match="channels.tsv") as raised:
        read(tmp_path, text)
    assert message in str(raised.value)


def test_a_missing_table_is_named(tmp_path):
    with pytest.raises(errors.InputError, match="no such table"):
        channels.read(tmp_path / "none.tsv", NAMES, 0, 1)
