import numpy as np
import pytest

from stages.files import channels, errors, pairs

SHAPES = ["face.jawOpen", "face.smileLeft", "face.blink"]
FRAMES = {"rom": range(100), "talk": range(10, 20)}


@pytest.fixture
def read(tmp_path):
    """Return a function that writes tables, name by name, and reads them."""

    def written(**tables):
        paths = []
        for name, text in tables.items():
            animator, _, suffix = name.rpartition("_")
            paths.append(tmp_path / f"{animator}.{suffix}")
            paths[-1].write_text(text.replace(" ", "\t") if suffix == "tsv" else text)
        return pairs.read(paths, FRAMES, ["theirs"], channels.read("", SHAPES, 0.0, 1.0))

    return written


def test_tabs_and_commas_blanks_and_columns_in_any_order(read):
    found = read(
        ann_tsv="shot frame blink jawOpen\nrom 3  0.5\ntalk 12 1 0\n",
        bob_csv="jawOpen,shot,frame\n0.25,rom,3\n,talk,19\n",
    )
    assert [(p.animator, p.shot, p.frame, p.line) for p in found] == [
        ("ann", "rom", 3, 2),
        ("ann", "talk", 12, 3),
        ("bob", "rom", 3, 2),
        ("bob", "talk", 19, 3),
    ]
    expected = [[0.5, 0, 0], [0, 0, 1], [0.25, 0, 0], [0, 0, 0]]
    np.testing.assert_array_equal([p.weights for p in found], expected)


def test_a_header_alone_and_other_actors_rows_hold_no_pairs(read):
    assert read(ann_tsv="shot frame jawOpen\n") == []
    assert read(ann_tsv="shot frame jawOpen\ntheirs 5000 1\n") == []


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("shot frame jawOpen\nnone 3 1\n", "line 2, column shot: 'none' is none of rom, talk"),
        ("shot frame jawOpen\nrom 3 1\ntalk 3 1\n", "line 3, column frame: talk has frames 10 to"),
        ("shot frame jawOpen\nrom 3.5 1\n", "line 2, column frame: '3.5' is not a whole number"),
        ("shot frame jawOpen\nrom -3 1\n", "line 2, column frame: '-3' is not a whole number"),
        ("shot frame jawOpne\nrom 3 1\n", "line 1: the rig has no shape 'jawOpne', .* jawOpen"),
        ("shot frame face.jawOpen\nrom 3 1\n", "line 1: the rig has no shape 'face.jawOpen'"),
        ("shot frame jawOpen\nrom 3 1.2\n", "line 2, column jawOpen: 1.2 is not within 0 and 1"),
        ("shot frame jawOpen\nrom 3 -0.1\n", "line 2, column jawOpen: -0.1 is not within"),
        ("shot frame jawOpen\nrom 3 wide\n", "line 2, column jawOpen: 'wide' is not a number"),
        ("shot frame jawOpen\nrom 3 nan\n", "line 2, column jawOpen: 'nan' is not a number"),
        ("shot frame jawOpen\nrom 3 1\nrom 3 0\n", "line 3: frame 3 of rom stands in line 2"),
        ("shot frame jawOpen jawOpen\nrom 3 1 1\n", "column 'jawOpen' stands twice"),
        ("frame jawOpen\n3 1\n", "column 'shot' is missing"),
        ("shot frame jawOpen\nrom 3\n", "line 2 has 2 cells, the header has 3"),
        ("", "is empty"),
    ],
)
def test_faults_are_named(read, text, message):
    with pytest.raises(errors.InputError, match="ann.tsv: .*" + message):
        read(ann_tsv=text)


def test_commas_in_a_table_of_tabs_are_explained(read):
    with pytest.raises(errors.InputError, match=r"ann.tsv: line 1: .*tabs part columns"):
        read(ann_tsv="shot,frame,jawOpen\nrom,3,1\n")


def test_one_animator_has_one_file(read):
    with pytest.raises(errors.InputError, match=r"ann.csv: .*ann.tsv is of the same animator"):
        read(ann_tsv="shot frame\n", ann_csv="shot,frame\n")


def test_files_of_another_kind_or_none_are_refused(tmp_path):
    limits = channels.read("", SHAPES, 0.0, 1.0)
    for name, message in (("ann.txt", "are .tsv or .csv"), ("gone.tsv", "no such table")):
        with pytest.raises(errors.InputError, match=f"{name}: .*{message}"):
            pairs.read([tmp_path / name], FRAMES, [], limits)
    (tmp_path / "ann.tsv").write_bytes(b"shot\tframe\tjaw\xff\n")
    with pytest.raises(errors.InputError, match="no UTF-8"):
        pairs.read([tmp_path / "ann.tsv"], FRAMES, [], limits)
