"""Reference frames: what is chosen, what is said of the pairs, and the page and table."""

import csv
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from tuned_actor import FRAMES, SHAPES, TunedActor

from stages import predict_weights, select_references, train_rbf, write_references
from stages.files import errors, film_writer, phones, reference_table

TEMPLATE = Path(__file__).parents[2] / "stages/templates/references.html"
SPOKEN = [(0.2, 0.4, "m", "b_p_m"), (0.8, 1.0, "ow", "ow_oy"), (1.6, 1.7, "b", "b_p_m")]


@pytest.fixture
def actor(tmp_path):
    made = TunedActor(tmp_path)
    rows = [phones.Phone(start, end, phone, viseme) for start, end, phone, viseme in SPOKEN]
    phones.write(tmp_path / "phones.parquet", rows, {}, [])
    return made


def select(actor, *extra, pairs=("ann.tsv",), wanted=20, shots=("rom", "talk"), emotions=None):
    folder = actor.folder
    words = ["--shots", *shots, "--expressions", *(str(folder / f"{s}.parquet") for s in shots)]
    words += ["--emotions", *(emotions or ["-"] * len(shots)), "--points", actor.kind]
    words += ["--pairs", *(str(folder / pair) for pair in pairs), "--rig", str(folder / "rig.npz")]
    words += ["--channels", "", "--wanted", str(wanted), "--min-confidence", "0.5"]
    words += ["--references", str(folder / "references.parquet"), *extra]
    select_references.main(words)
    return reference_table.read(folder / "references.parquet")


def spoken(actor):
    return ["--phone-shots", "talk", "--phones", str(actor.folder / "phones.parquet")]


def test_a_viseme_is_the_middle_of_one_of_its_phones_and_extremes_follow(actor):
    rows, _ = select(actor, *spoken(actor), pairs=(), wanted=16, emotions=["calm", "angry"])
    visemes = {row["viseme"]: row for row in rows if row["source"] == "viseme"}
    assert set(visemes) == {"b_p_m", "ow_oy"}
    assert visemes["ow_oy"]["frame"] == round(0.9 * 120)
    assert visemes["b_p_m"]["frame"] in (round(0.3 * 120), round(1.65 * 120))
    assert {row["emotion"] for row in visemes.values()} == {"angry"}
    kinds = [row["source"] for row in rows]
    assert kinds == sorted(kinds, key=["viseme", "extreme", "coverage"].index)
    assert len(rows) == 16
    assert len({(row["shot"], row["frame"]) for row in rows}) == 16


def test_frames_of_the_scheme_that_find_no_room_are_said(actor, caplog):
    rows, _ = select(actor, *spoken(actor), pairs=(), wanted=8, emotions=["calm", "angry"])
    assert len(rows) == 8
    assert "14 of the 22 frames for visemes and extremes are left out" in caplog.text


def test_pairs_are_counted_and_what_they_reach_is_told(actor):
    rows, header = select(actor, pairs=())
    assert header["pairs"] == 0
    assert header["uncovered"] is None
    assert all(np.isnan(row["leverage"]) and row["source"] == "coverage" for row in rows)
    _, few = select(actor, pairs=("ann.tsv",), shots=("rom",))
    assert few["pairs"] == 60
    # the pairs are spread over the very shot
    assert few["uncovered"] < 0.2
    actor.write_pairs("ann", [("rom", frame, actor.weights["rom"][frame]) for frame in range(9)])
    _, still = select(actor, pairs=("ann.tsv",), shots=("rom",))
    assert still["uncovered"] > 0.5


def test_what_is_tuned_is_not_proposed_again(actor):
    rows, _ = select(actor, wanted=20)
    for row in rows:
        if row["shot"] == "rom":
            assert np.abs(actor.tuned - row["frame"]).min() >= 12


def test_a_marker_that_fell_off_does_not_take_its_shot_out(actor):
    points = actor.moved(actor.weights["talk"])
    points[:, 3] = np.nan
    actor.write_expression("talk", points, np.ones(FRAMES))
    rows, _ = select(actor, pairs=())
    assert {row["shot"] for row in rows} == {"rom", "talk"}


def test_the_next_frames_reach_what_the_pairs_do_not(actor):
    """Jaws never open in the pairs: the first proposal opens them."""
    calm = np.flatnonzero(actor.weights["rom"][:, 0] < 0.15)[::5]
    pairs = [("rom", int(frame), actor.weights["rom"][frame]) for frame in calm]
    actor.write_pairs("ann", pairs)
    rows, _ = select(actor, wanted=3, shots=("rom",))
    assert max(actor.weights["rom"][row["frame"], 0] for row in rows) > 0.8


def write(actor, *extra, videos=("-", "-")):
    folder = actor.folder
    words = ["--actor", "eve", "--character", "clay", "--shots", "rom", "talk"]
    words += ["--expressions", str(folder / "rom.parquet"), str(folder / "talk.parquet")]
    words += ["--references", str(folder / "references.parquet"), "--videos", *map(str, videos)]
    words += [
        "--points",
        actor.kind,
        "--rig",
        str(folder / "rig.npz"),
        "--pair-folder",
        "clay/pairs",
    ]
    words += ["--template", str(TEMPLATE), "--page", str(folder / "page.html")]
    write_references.main([*words, "--table", str(folder / "pairs.tsv"), *extra])
    lines = (folder / "pairs.tsv").read_text().splitlines()
    table = list(csv.DictReader(lines, delimiter="\t"))
    return (folder / "page.html").read_text(), table


def test_the_table_lists_what_is_open_with_weights_to_start_from(actor):
    train_rbf.main(actor.train_words())
    starts = []
    for shot in ("rom", "talk"):
        starts.append(str(actor.folder / f"{shot}_start.parquet"))
        predict_weights.main(actor.predict_words(shot=shot, predicted=starts[-1]))
    rows, _ = select(actor)
    page, table = write(actor, "--starts", *starts)
    wanted = [(row["shot"], row["frame"]) for row in rows if not row["tuned_by"]]
    assert [(row["shot"], int(row["frame"])) for row in table] == wanted
    assert list(table[0]) == ["shot", "frame", *SHAPES]
    given = np.array([[float(row[shape] or 0) for shape in SHAPES] for row in table])
    true = np.array([actor.weights[shot][frame] for shot, frame in wanted])
    assert np.abs(given - true).max() < 0.1
    assert "60</b> pairs so far" in page.replace("\n", " ")
    # what is written can be read back as pairs
    actor.write_pairs("bob", [])
    (actor.folder / "bob.tsv").write_text((actor.folder / "pairs.tsv").read_text())
    _, header = select(actor, pairs=("ann.tsv", "bob.tsv"))
    assert header["pairs"] == 60 + len(table)


def test_pictures_come_from_the_moment_of_the_film(actor):
    """A film whose pictures grow brighter: every picture tells its time."""
    shades = [round(40 + 180 * number / 99) for number in range(100)]
    pictures = [(n / 30, np.full((48, 64, 3), shade, np.uint8)) for n, shade in enumerate(shades)]
    film_writer.write(actor.folder / "talk.mp4", pictures, (64, 48), Fraction(30))
    rows, _ = select(actor, shots=("rom", "talk"))
    page, _ = write(actor, videos=("-", actor.folder / "talk.mp4"))
    assert page.count("<img") == sum(row["shot"] == "talk" for row in rows)
    assert page.count('class="card"') == len(rows)


def test_faults_are_named(actor):
    with pytest.raises(errors.InputError, match="give one for each shot"):
        select(actor, emotions=["calm"])
    actor.write_expression("rom", actor.moved(actor.weights["rom"]), np.zeros(FRAMES))
    with pytest.raises(errors.InputError, match=r"rom\.parquet: 0 of 400 frames have all points"):
        select(actor, shots=("rom",))
