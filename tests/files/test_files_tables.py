import subprocess
import sys
import textwrap

import numpy as np
import pytest

from stages.files import delimited, errors, labels, point_set, regions, show, source_code

SCHEMA = """
key: [shot]
type: object
additionalProperties: false
required: [shot, session]
properties:
  shot: {description: name of the take, pattern: "^[A-Za-z0-9][A-Za-z0-9_-]*$"}
  session: {description: its session}
  basis: {description: yes or no, enum: ["yes", "no"], default: "no"}
"""


def write(path, text):
    path.write_text(textwrap.dedent(text))
    return path


@pytest.mark.parametrize(
    ("table", "fault"),
    [
        ("shot\tsession\n0010\ta\n0010\tb\n", r"line 3: shot 0010 stands on line 2 already"),
        ("shot\tsession\tcolour\n", r"unknown column 'colour'.*shot, session, basis"),
        ("shot\n", r"column 'session' is missing"),
        ("shot\tsession\nx\n", r"line 2 has 1 cells, the header has 2"),
        ("shot\tsession\n../x\ta\n", r"line 2, column shot: '../x' does not fit.*name of the take"),
        ("shot\tsession\nx\t\n", r"line 2, column session: the cell is blank"),
        ("shot\tsession\tbasis\nx\ta\tmaybe\n", r"line 2, column basis: 'maybe' does not fit"),
        ("shot\tshot\tsession\n", r"column 'shot' stands twice"),
        ("", r"is empty"),
    ],
)
def test_a_faulty_table_is_named_with_its_place(tmp_path, table, fault):
    path = write(tmp_path / "shots.tsv", table)
    with pytest.raises(errors.InputError, match=rf"shots\.tsv: .*{fault}"):
        show.read(path, write(tmp_path / "schema.yaml", SCHEMA))


def test_cells_stay_text_and_blanks_take_defaults(tmp_path):
    path = write(
        tmp_path / "shots.tsv", "\ufeffshot\tsession\tbasis\n\n0010\t s1 \t\n0011\ts1\tyes\n"
    )
    rows = show.read(path, write(tmp_path / "schema.yaml", SCHEMA))
    assert rows[0].cells == {"shot": "0010", "session": "s1", "basis": "no"}
    assert (rows[1].line, rows[1].cells["basis"]) == (4, "yes")


def test_a_reference_to_nothing_is_named(tmp_path):
    path = write(tmp_path / "cast.tsv", "shot\tsession\na\ts1, s2\n")
    rows = show.read(path, write(tmp_path / "schema.yaml", SCHEMA))
    with pytest.raises(errors.InputError, match=r"line 2, column session: 's2' is not in sessions"):
        show.check_references(path, rows, "session", ["s1"], "sessions.tsv")


def test_no_utf8_and_no_number_are_named(tmp_path):
    path = tmp_path / "a.csv"
    path.write_bytes("frame\nä\n".encode("latin-1"))
    with pytest.raises(errors.InputError, match="no UTF-8 text at byte 6"):
        delimited.read(path, ["frame"])
    path.write_text("frame\nnan\n")
    (row,) = delimited.read(path, ["frame"])
    with pytest.raises(errors.InputError, match="line 2, column frame: 'nan' is not a number"):
        delimited.number(path, row, "frame")
    with pytest.raises(errors.InputError, match="not a whole number"):
        delimited.whole_number(path, row, "frame")


@pytest.mark.parametrize(
    ("text", "pattern"),
    [
        ('a\tb\n1\t2\n"3\t4\n5\t6\n', "line 3: a quotation mark is not closed on its line"),
        ("a\tb\n1\t" + 200_000 * "x" + "\n", "line 2: field larger than field limit"),
    ],
    ids=["open quotation", "endless cell"],
)
def test_cells_without_an_end_are_named_with_their_line(tmp_path, text, pattern):
    with pytest.raises(errors.InputError, match=pattern):
        delimited.read(write(tmp_path / "a.tsv", text), ["a", "b"])


CONTOURS = "contour\tkind\tcount\nlips\tclosed\t8\nbrow\topen\t\npupil\tpoint\t1\n"
LABELS = """frame,point,x_px,y_px,corner
5,lips_01,2,0,
5,lips_00,0,0,1
5,lips_02,2,2,1
5,brow_00,1,1,
5,brow_01,3,1,
5,pupil,7,7,
"""


def test_labels_come_in_the_order_of_their_numbers(tmp_path):
    contours = point_set.read(write(tmp_path / "points.tsv", CONTOURS))
    found = labels.read(write(tmp_path / "labels.csv", LABELS), contours)[5]
    np.testing.assert_array_equal(found["lips"].points, [[0, 0], [2, 0], [2, 2]])
    assert found["lips"].corners == (0, 2)
    np.testing.assert_array_equal(found["pupil"].points, [[7, 7]])


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        (("5,pupil,7,7,\n", ""), "frame 5: contour pupil is missing"),
        (("5,pupil", "5,nose"), "line 7: point nose belongs to no contour"),
        (("2,2,1", "2,2,"), None),
        (("0,0,1", "0,0,"), None),
        (("lips_02", "lips_01"), "line 4: frame 5 has lips_01 twice"),
        (("7,7", "7,x"), "line 7, column y_px: 'x' is not a number"),
        (("5,brow_01,3,1,\n", ""), "frame 5: contour brow has only one point"),
    ],
)
def test_faulty_labels_are_named(tmp_path, change, fault):
    contours = point_set.read(write(tmp_path / "points.tsv", CONTOURS))
    path = write(tmp_path / "labels.csv", LABELS.replace(*change))
    if fault is None:
        assert labels.read(path, contours)[5]["lips"].corners
        return
    with pytest.raises(errors.InputError, match=rf"labels\.csv: {fault}"):
        labels.read(path, contours)


def test_a_closed_contour_without_a_corner_is_refused(tmp_path):
    contours = point_set.read(write(tmp_path / "points.tsv", CONTOURS))
    path = write(tmp_path / "labels.csv", LABELS.replace(",1\n", ",\n"))
    with pytest.raises(errors.InputError, match="frame 5: closed contour lips has no corner"):
        labels.read(path, contours)


def test_regions_take_contours_and_single_points(tmp_path):
    text = "region\tpoint\tweight\nmouth\tlips_00\t0.5\nmouth\tlips\t\neyes\tpupil\t2\n"
    path = write(tmp_path / "regions.tsv", text)
    found = regions.read(path)
    points = ["lips_00", "lips_01", "pupil"]
    indices, weights = regions.select(path, found, "mouth", points)
    np.testing.assert_array_equal(indices, [0, 1])
    np.testing.assert_array_equal(weights, [0.5, 1])
    with pytest.raises(errors.InputError, match="no point or contour of the face is called pupil"):
        regions.select(path, found, "eyes", points[:2])


STAGES = sorted(
    path.stem
    for path in source_code.PACKAGE_FOLDER.glob("*.py")
    if "run_stage(main)" in path.read_text() and path.stem != "cli"
)


@pytest.mark.parametrize("stage", STAGES)
def test_the_digest_covers_what_python_really_imports(stage):
    probe = (
        "import sys, importlib; importlib.import_module(sys.argv[1]);"
        "print(' '.join(sorted(m for m in sys.modules if m.startswith('stages.'))))"
    )
    run = [sys.executable, "-c", probe, f"stages.{stage}"]
    imported = subprocess.run(run, capture_output=True, text=True, check=True).stdout.split()
    reached = set(source_code.modules_reached(f"stages.{stage}"))
    assert reached == set(imported) - {"stages.core", "stages.files"}


def test_the_digest_ignores_comments_and_sees_code(tmp_path, monkeypatch):
    package = tmp_path / "stages"
    (package / "core").mkdir(parents=True)
    (package / "__init__.py").touch()
    (package / "core" / "__init__.py").touch()
    (package / "a.py").write_text("from stages.core import b\nX = 1\n")
    monkeypatch.setattr(source_code, "PACKAGE_FOLDER", package)

    def digest(text):
        (package / "core" / "b.py").write_text(text)
        source_code.parsed.cache_clear()
        return source_code.digest("stages.a")

    first = digest('"""Say."""\ndef f(x):\n    """Do."""\n    return x + 1\n')
    assert digest('"""Else."""\n\n\ndef f(x):  # why\n    return x + 1\n') == first
    assert digest("def f(x):\n    return x + 2\n") != first
