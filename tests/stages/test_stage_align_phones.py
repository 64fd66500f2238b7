import itertools
import json
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
import pytest

from data_example.generator import spoken
from stages import align_phones, cli
from stages.core import word_agreement
from stages.files import errors, phones, sound

VISEMES = Path(__file__).parents[2] / "stages" / "tables" / "visemes.tsv"
RATE = spoken.RATE
START_S, LENGTH_S, SOUND_LATE_S = 0.4, 2.4, 0.5
SENTENCE = [p for p in spoken.moved(spoken.phones()["sadness"], START_S) if p.word]
WORDS = [word for word, _ in itertools.groupby(phone.word for phone in SENTENCE)]


def add_sound(container, stream, samples, start_s=0.0):
    for first in range(0, len(samples), 1024):
        values = np.round(samples[None, first : first + 1024] * 32767).astype(np.int16)
        frame = av.AudioFrame.from_ndarray(values, "s16", "mono")
        frame.sample_rate, frame.time_base = RATE, Fraction(1, RATE)
        frame.pts = first + round(start_s * RATE)
        container.mux(stream.encode(frame))
    container.mux(stream.encode())


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with the sound, a film whose sound starts late, the words and their phones."""
    made = tmp_path_factory.mktemp("take")
    samples = spoken.voice({"sadness": START_S} | dict.fromkeys(spoken.VOICED[:3], 99.0), 110.0)
    samples = samples[: round(LENGTH_S * RATE)]
    for name, values in (("take.wav", samples), ("silent.wav", np.zeros(RATE))):
        with av.open(str(made / name), "w") as container:
            stream = container.add_stream("pcm_s16le", rate=RATE, layout="mono")
            add_sound(container, stream, values)
    with av.open(str(made / "take.mp4"), "w") as container:
        video = container.add_stream("libx264", rate=10)
        video.width, video.height, video.pix_fmt = 64, 48, "yuv420p"
        stream = container.add_stream("aac", rate=RATE, layout="mono")
        for _ in range(30):
            picture = av.VideoFrame.from_ndarray(np.zeros((48, 64, 3), np.uint8), format="rgb24")
            container.mux(video.encode(picture))
        container.mux(video.encode())
        add_sound(container, stream, samples, SOUND_LATE_S)
    (made / "take.txt").write_text(" ".join(WORDS).capitalize() + ".\n", encoding="utf-8")
    return made


def run(folder, out, **flags):
    options = ["--visemes", str(VISEMES), "--phones-out", str(out)]
    for flag, name in flags.items():
        options += [f"--{flag}", *([str(folder / name)] if name else [])]
    align_phones.main(options)
    return phones.read(out)


def starts(rows):
    return np.array([row.start_s for row in rows if row.word])


def test_a_transcript_becomes_phones(folder, tmp_path):
    rows = run(folder, tmp_path / "p.parquet", transcript="take.txt", sound="take.wav", phones="")
    words = [word for word, _ in itertools.groupby(row.word for row in rows if row.word)]
    assert words == [word.lower() for word in WORDS]
    firsts = [next(own).start for _, own in itertools.groupby(SENTENCE, lambda p: p.word)]
    found = [next(o).start_s for w, o in itertools.groupby(rows, lambda r: r.word) if w]
    assert np.abs(np.subtract(found, firsts)).mean() < 0.03
    assert {row.viseme for row in rows if row.phone == "pau"} == {"pau"}
    assert all(row.viseme and row.score <= 0 for row in rows)
    run(folder, tmp_path / "again.parquet", transcript="take.txt", sound="take.wav")
    assert (tmp_path / "again.parquet").read_bytes() == (tmp_path / "p.parquet").read_bytes()


def test_times_are_the_films(folder, tmp_path):
    alone = run(folder, tmp_path / "a.parquet", transcript="take.txt", sound="take.wav")
    filmed = run(folder, tmp_path / "f.parquet", transcript="take.txt", sound="take.mp4")
    late = starts(filmed) - starts(alone)
    assert np.median(late) == pytest.approx(SOUND_LATE_S, abs=0.011)
    sync = {"offset_s": -0.7, "drift_ppm": 100.0, "refused": False, "reason": ""}
    sync |= {"method": "given", "confidence": 1.0}
    (folder / "sync.json").write_text(json.dumps(sync), encoding="utf-8")
    moved = run(
        folder, tmp_path / "m.parquet", transcript="take.txt", sound="take.wav", sync="sync.json"
    )
    np.testing.assert_allclose(starts(moved), starts(alone) * 1.0001 - 0.7, atol=1e-9)


def test_known_phones_and_mouth_shapes_move_with_the_sound(folder, tmp_path):
    (folder / "cues.tsv").write_text("0.00\tX\n0.5\tB\n2.00\tX\n", encoding="utf-8")
    rows = run(folder, tmp_path / "p.parquet", phones="cues.tsv", sound="take.mp4")
    assert [(row.phone, row.viseme) for row in rows] == [("", "rhubarb_X"), ("", "rhubarb_B")]
    _, start_s = sound.read(folder / "take.mp4", RATE)
    assert start_s == pytest.approx(SOUND_LATE_S, abs=0.07)  # AAC puts a block of silence before
    assert [row.start_s for row in rows] == pytest.approx([start_s, start_s + 0.5])
    rows = run(folder, tmp_path / "p.parquet", phones="cues.tsv")
    assert [row.start_s for row in rows] == [0.0, 0.5]
    (folder / "late.tsv").write_text("0.00\tX\n0.5\tB\n9.00\tX\n", encoding="utf-8")
    with pytest.raises(errors.InputError, match=r"late\.tsv: .*ends at 9\.00 s, but .* 2\.40 s"):
        run(folder, tmp_path / "p.parquet", phones="late.tsv", sound="take.wav")


def test_known_times_of_words_are_kept(folder, tmp_path):
    spans = [(list(own), word) for word, own in itertools.groupby(SENTENCE, lambda p: p.word)]
    lines = [f"{own[0].start * 25000:.0f} {own[-1].end * 25000:.0f} {w}\n" for own, w in spans]
    (folder / "take.align").write_text("".join(lines), encoding="utf-8")
    rows = run(folder, tmp_path / "p.parquet", words="take.align", sound="take.wav")
    firsts = [next(o).start_s for w, o in itertools.groupby(rows, lambda r: r.word) if w]
    np.testing.assert_allclose(firsts, [own[0].start for own, _ in spans], atol=3e-5)
    (folder / "late.align").write_text("0 2500 boy\n2500 90000 who\n", encoding="utf-8")
    with pytest.raises(errors.InputError, match=r"late\.align: .*ends at 3\.60 s"):
        run(folder, tmp_path / "p.parquet", words="late.align", sound="take.wav")


def test_unknown_words_are_all_named(folder, tmp_path):
    (folder / "odd.txt").write_text("She has no xyzzy of 7 xyzzy\n", encoding="utf-8")
    message = r"odd\.txt: the dictionary lacks 'xyzzy', '7': spell them as words"
    with pytest.raises(errors.InputError, match=message):
        run(folder, tmp_path / "p.parquet", transcript="odd.txt", sound="take.wav")
    assert not (tmp_path / "p.parquet").exists()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("Please bring the red boat to the harbor", "other words are spoken|find no place"),
        ("The old man gave his dog bread", "other words are spoken|find no place"),
        (" ".join([*WORDS, "and then he went away with all of his friends"] * 3), "find no place"),
    ],
)
def test_other_words_are_refused(folder, tmp_path, text, message):
    (folder / "other.txt").write_text(text, encoding="utf-8")
    with pytest.raises(errors.InputError, match=rf"other\.txt: .*({message}).*give the words"):
        run(folder, tmp_path / "p.parquet", transcript="other.txt", sound="take.wav")


def test_words_in_doubt_are_said(folder, tmp_path, caplog, monkeypatch):
    flags = {"transcript": "take.txt", "sound": "take.wav"}
    with caplog.at_level("WARNING", logger=cli.logger.name):
        run(folder, tmp_path / "p.parquet", **flags)
        assert not caplog.text
        monkeypatch.setattr(word_agreement, "DOUBTFUL", -0.1)
        run(folder, tmp_path / "p.parquet", **flags)
    assert f"take.txt: words in doubt, '{' '.join(WORDS).lower()}' at 0." in caplog.text


def test_what_lacks_is_named(folder, tmp_path):
    out = tmp_path / "p.parquet"
    with pytest.raises(errors.InputError, match=r"take\.txt: the shot has no sound"):
        run(folder, out, transcript="take.txt")
    with pytest.raises(errors.InputError, match="neither phones nor words nor a transcript"):
        run(folder, out, sound="take.wav")
    with pytest.raises(errors.InputError, match=r"silent\.wav: the sound is silent"):
        run(folder, out, transcript="take.txt", sound="silent.wav")
    with pytest.raises(ValueError, match="--sound takes one file, got 2"):
        sounds = [str(folder / "take.wav")] * 2
        align_phones.main(["--visemes", str(VISEMES), "--phones-out", str(out), "--sound", *sounds])
    refused = {"offset_s": None, "drift_ppm": None, "refused": True, "reason": "too quiet"}
    (folder / "refused.json").write_text(json.dumps(refused), encoding="utf-8")
    with pytest.raises(errors.InputError, match=r"refused\.json: .*too quiet"):
        run(folder, out, transcript="take.txt", sound="take.wav", sync="refused.json")
