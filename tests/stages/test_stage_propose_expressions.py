"""Proposals of extremes: from phones, from what is played, from the eyes."""

import logging
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from layered_actor import EXTREMES_TABLE

from stages import propose_expressions
from stages.files import delimited, errors, expressions, extremes, film_writer, phones, series

STAGES = Path(__file__).parents[2] / "stages"
RATE, FRAMES = 60, 360
MARKERS = [f"M{i}" for i in range(10)]  # the first five lie on the mouth
ANGLE = 2 * np.pi * np.arange(12) / 12
EYES = [f"{eye}_{i:02d}" for eye in ("eye_right", "eye_left") for i in range(12)]
SPOKEN = [
    (0.0, 1.0, "pau", ""), (1.0, 1.2, "m", "ma"), (1.2, 1.5, "aa", "ma"), (1.5, 1.7, "b", "bob"),
    (1.7, 2.0, "aa", "bob"), (2.0, 2.02, "b", "bob"), (2.02, 2.3, "uw", "who"),
    (2.3, 6.0, "pau", ""),
]  # fmt: skip
BLINK = slice(300, 313)


class Actress:
    """A folder with a shot of speech and blinks, and one of joy."""

    def __init__(self, folder):
        self.folder = folder
        rng = np.random.default_rng(0)
        self.shapes = {
            name: np.concatenate([rng.normal(size=(5, 3)), np.zeros((5, 3))])
            for name in ("m", "aa", "oo")
        }
        self.joy = rng.normal(size=(10, 3))
        self.neutral = rng.normal(size=(10, 3))
        self.talk = 0.02 * rng.normal(size=(FRAMES, 10, 3))
        mouth = {"m": "m", "b": "m", "aa": "aa", "uw": "oo"}
        for start, end, phone, _ in SPOKEN:
            if phone in mouth:
                rows = slice(round(start * RATE), round(end * RATE))
                strength = np.sin(np.linspace(0, np.pi, rows.stop - rows.start))
                self.talk[rows] += 0.3 * strength[:, None, None] * self.shapes[mouth[phone]]
        self.opening = np.full(FRAMES, 0.4)
        self.opening[BLINK] = 0.4 * (1 - np.sin(np.linspace(0, np.pi, 13)))
        time = np.linspace(0, 1, FRAMES)[:, None, None]
        self.happy = np.sin(np.pi * time) ** 2 * 0.2 * self.joy
        self.write("talk", self.talk, self.opening)
        self.write("happy", self.happy, np.full(FRAMES, 0.4))
        rows = [phones.Phone(start, end, phone, "", word) for start, end, phone, word in SPOKEN]
        phones.write(folder / "phones.parquet", rows, {}, [])

    def write(self, shot, offsets, opening, film=True):
        """Write the expression of a shot."""
        columns = series.unstack(self.neutral + offsets, MARKERS, "xyz")
        confidence = np.full(FRAMES, 0.9)
        columns["markers.confidence"] = confidence
        meta = {"markers": MARKERS, "marker_neutral": self.neutral.tolist()}
        if film:
            eye = np.stack([np.tile(np.cos(ANGLE), (FRAMES, 1)), opening[:, None] * np.sin(ANGLE)])
            eyes = np.concatenate([np.moveaxis(eye, 0, 2)] * 2, axis=1)
            columns |= series.unstack(eyes, EYES) | {"confidence": confidence}
            meta |= {"points": EYES, "neutral": eyes[0].tolist()}
        frame = np.arange(FRAMES)
        path = self.folder / f"{shot}.parquet"
        series.write(path, "expression", frame, frame / RATE, columns, Fraction(RATE), meta)

    def propose(self, emotions=("-", "joy"), videos=("-", "-"), **changed):
        """Run the stage; return the table's rows as layer, name -> shot, frame."""
        shots = ["talk", "happy"]
        options = {
            "actor": ["eve"],
            "shots": shots,
            "expressions": [self.folder / f"{shot}.parquet" for shot in shots],
            "emotions": emotions,
            "videos": videos,
            "phone-shots": ["talk"],
            "phones": [self.folder / "phones.parquet"],
            "visemes": [STAGES / "tables" / "visemes.tsv"],
            "points": ["markers"],
            "lid-points": [""],
            "extremes": [EXTREMES_TABLE],
            "min-confidence": [0.5],
            "template": [STAGES / "templates" / "expressions.html"],
            "page": [self.folder / "index.html"],
            "table": [self.folder / "expressions.tsv"],
        } | {name.replace("_", "-"): value for name, value in changed.items()}
        line = [word for n, values in options.items() for word in (f"--{n}", *map(str, values))]
        propose_expressions.main(line)
        found = {}
        for row in delimited.read(self.folder / "expressions.tsv", expressions.COLUMNS):
            cells = row.cells
            found[cells["layer"], cells["name"]] = cells["shot"], int(cells["frame"])
        return found

    def page(self):
        """Return the text of the page."""
        return (self.folder / "index.html").read_text()


@pytest.fixture
def actress(tmp_path):
    return Actress(tmp_path)


def closed_in_talk(found):
    """Say whether the frame of closed eyes is the middle of the blink, or beside it."""
    shot, frame = found["blink", "closed"]
    return shot == "talk" and 305 <= frame <= 307


def test_phones_labels_and_eyes_give_proposals(actress):
    found = actress.propose()
    middles = {"m": [66, 96], "aa": [81, 111], "oo": [129]}
    for name, frames in middles.items():
        shot, frame = found["speech", name]
        assert shot == "talk" and min(abs(frame - middle) for middle in frames) <= 1
    assert found["emotion", "joy"] == ("happy", np.linalg.norm(actress.happy, axis=(1, 2)).argmax())
    assert closed_in_talk(found)
    half = actress.opening[found["blink", "half"][1]]
    assert found["blink", "half"][0] == "talk" and abs(half - 0.2) < 0.05
    assert {name for layer, name in found if layer == "blink"} == {"open", "half", "closed"}
    assert ("emotion", "neutral") in found and ("speech", "rest") in found
    page = actress.page()
    assert "most typical of 3" in page and "Not found: serenity, ecstasy" in page


def test_the_table_can_be_copied_as_it_stands(actress):
    found = actress.propose()
    known = extremes.read(EXTREMES_TABLE)
    rows = expressions.read(actress.folder / "expressions.tsv", "eve", ["talk", "happy"], known)
    assert [(row.layer, row.name) for row in rows] == list(found)
    assert len({(row.layer, row.shot, row.frame) for row in rows}) == len(rows)


def test_speech_is_kept_out_of_emotions(actress):
    """The widest mouth of a shot that is labelled may be that of a word."""
    offsets = actress.happy.copy()
    offsets[72:90] += actress.shapes["aa"]
    actress.write("happy", offsets, actress.opening)
    spoken = [actress.folder / "phones.parquet"] * 2
    found = actress.propose(phone_shots=["talk", "happy"], phones=spoken)
    assert found["emotion", "joy"][1] not in range(60, 138)


def test_a_pair_of_lid_markers_shows_blinks_too(actress):
    actress.talk[:, 9] = actress.talk[:, 8] + actress.neutral[8] - actress.neutral[9]
    actress.talk[:, 9, 1] += 0.2 + actress.opening
    actress.happy[:, 9] = actress.happy[:, 8] + actress.neutral[8] - actress.neutral[9]
    actress.happy[:, 9, 1] += 0.6
    for shot in ("talk", "happy"):
        actress.write(shot, getattr(actress, shot), actress.opening, film=False)
    found = actress.propose(lid_points=["M9,M8"])
    assert closed_in_talk(found)
    with pytest.raises(errors.InputError, match="'M9' is no pair.*") as caught:
        actress.propose(lid_points=["M9"])
    assert "--lid-points" in str(caught.value)


def test_without_phones_labels_and_eyes_there_is_the_neutral(actress, caplog):
    for shot in ("talk", "happy"):
        actress.write(shot, getattr(actress, shot), actress.opening, film=False)
    with caplog.at_level(logging.INFO):
        found = actress.propose(emotions=("-", "giddiness"), phone_shots=[], phones=[])
    assert list(found) == [("emotion", "neutral")]
    assert "expression giddiness is no extreme, nothing is proposed for it" in caplog.text
    assert "nothing is proposed for blink: no eyes are seen" in caplog.text


def test_shots_may_lack_a_kind_of_points(actress):
    actress.write("happy", actress.happy, actress.opening, film=False)
    found = actress.propose(points=["both"])
    assert closed_in_talk(found) and found["emotion", "joy"][0] == "happy"


def test_pictures_of_the_film_are_in_the_page(actress):
    pictures = ((i / 12, np.full((48, 64, 3), 3 * i % 255, np.uint8)) for i in range(72))
    film_writer.write(actress.folder / "film.mp4", pictures, (64, 48), Fraction(12))
    actress.propose(videos=(actress.folder / "film.mp4", "-"))
    page = actress.page()
    assert page.count("<img") == page.count("-talk-") > 5
    assert page.count("<svg") == page.count('class="card"')


def test_bad_input_is_one_line(actress):
    for changed, message in (
        ({"emotions": ("joy",)}, "--emotions: give one for each shot"),
        ({"videos": ("-",)}, "--videos: give one for each shot"),
        ({"min_confidence": [0.95]}, "no frame of talk, happy has half of the points and confid"),
        ({"phone_shots": ["other"]}, "--phone-shots: 'other' is none of --shots"),
        ({"phone_shots": []}, "--phones: give one for each of --phone-shots"),
    ):
        with pytest.raises(errors.InputError, match=message):
            actress.propose(**changed)
    actress.write("happy", actress.happy, actress.opening, film=False)
    with pytest.raises(errors.InputError, match=r"happy\.parquet: holds no video points"):
        actress.propose(points=["video"])


def test_the_same_input_gives_the_same_bytes(actress):
    actress.propose()
    first = actress.page()
    actress.propose()
    assert actress.page() == first
