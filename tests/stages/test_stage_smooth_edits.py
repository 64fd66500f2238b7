"""Hand edits, cuts and timecodes of a take."""

from fractions import Fraction

import numpy as np
import pytest
from small_take import SmallTake

from stages import assemble_rig, smooth_weights
from stages.files import errors, rig, weights


@pytest.fixture
def take(tmp_path):
    made = SmallTake(tmp_path)
    assemble_rig.main(made.rig_options())
    return made


def smoothed(take, **options):
    smooth_weights.main(take.weights_options(**options))
    names = rig.read_any(take.folder / "rig.npz").names
    return names, weights.read(take.folder / "weights.parquet", names)


def edit(take, text, name="anna.csv"):
    path = take.folder / name
    path.write_text(text)
    return str(path)


def test_edits_replace_their_cells_and_nothing_else(take):
    names, solved = smoothed(take)
    plain = names[1].partition(".")[2]
    first = edit(take, f"frame,{names[0]},{plain}\n3,2.5,\n4,,-1\n")
    second = edit(take, f"frame\t{names[0]}\thead.scale\n3\t7\t1.5\n", "ben.tsv")
    _, edited = smoothed(take, edits=[first, second])
    expected = solved.shapes.copy()
    expected[3, 0], expected[4, 1] = 7, -1
    np.testing.assert_array_equal(edited.shapes, expected)
    assert edited.scale[3] == 1.5
    np.testing.assert_array_equal(np.delete(edited.scale, 3), np.delete(solved.scale, 3))


def test_a_copy_of_the_curves_gives_them_back_whatever_is_solved(take):
    smoothed(take)
    kept = edit(take, (take.folder / "weights.csv").read_text())
    wanted = (take.folder / "weights.csv").read_bytes()
    names = rig.read_any(take.folder / "rig.npz").names
    (take.folder / "channels.tsv").write_text(f"shape\tgain\n{names[0]}\t3\n")
    smoothed(take, channels=str(take.folder / "channels.tsv"), edits=[kept])
    assert (take.folder / "weights.csv").read_bytes() == wanted


@pytest.mark.parametrize(
    ("text", "name", "message"),
    [
        ("frame,nose\n1,0\n", "a.csv", "line 1: 'nose' is no curve of the take: use a name of"),
        ("frame,head.scale\n999,1\n", "a.csv", "line 2, column frame: there is no frame 999"),
        ("frame,head.scale\n1,1\n1,2\n", "a.csv", "line 3: frame 1 stands in line 2 already"),
        ("frame,head.scale\n1,much\n", "a.csv", "line 2, column head.scale: 'much' is not a num"),
        ("frame,head.scale\n", "a.txt", "edits are .tsv or .csv files"),
        ("head.scale\n1\n", "a.csv", "column 'frame' is missing"),
    ],
)
def test_faults_of_edits_are_named(take, text, name, message):
    with pytest.raises(errors.InputError, match=message):
        smoothed(take, edits=[edit(take, text, name)])


def test_a_cut_delivers_its_frames_under_their_own_numbers(take):
    _, whole = smoothed(take)
    _, part = smoothed(take, first="5", last="9", handles="2")
    assert part.frame.tolist() == list(range(3, 12))
    np.testing.assert_array_equal(part.shapes, whole.shapes[3:12])
    _, faster = smoothed(take, first="5", last="9", rate="60")
    assert faster.frame.tolist() == list(range(10, 19))


def test_the_timecode_of_the_first_frame_follows_the_cut(take):
    _, read = smoothed(take, first="4", start="00:00:59:28")
    assert read.first_timecode == "00:01:00:02"
    assert read.midnight_s == 59 + Fraction(28, 30)
    _, faster = smoothed(take, first="4", start="00:00:59:28", rate="60")
    assert faster.first_timecode == "00:01:00:02"
    _, none = smoothed(take)
    assert (none.first_timecode, none.midnight_s) == ("", 0)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"first": "900"}, "lie outside the take: the take ends with frame"),
        ({"first": "9", "last": "2"}, "the last frame 2 comes before the first 9"),
        ({"start": "00:00:00:30"}, "beyond 23:59:59:29: correct start_timecode"),
        ({"start": "00:01:00;04"}, "drop-frame timecode exists at 29.97"),
    ],
)
def test_faults_of_cuts_are_named(take, options, message):
    with pytest.raises(errors.InputError, match=message):
        smoothed(take, **options)
