"""A take that is faster or slower than the performance: weights, cut, edits, preview and sound."""

from fractions import Fraction

import av
import numpy as np
import pytest
import scipy.spatial.transform
from small_take import FRAMES, RATE, SmallTake, words

from stages import assemble_rig, bake_mesh, render_preview, retime_sound, smooth_weights
from stages.core import preview
from stages.files import errors, film_writer, rig, series, sound, weights

TONE_HZ, SOUND_HZ = 440, 24000


@pytest.fixture
def take(tmp_path):
    made = SmallTake(tmp_path)
    assemble_rig.main(made.rig_options())
    return made


def at(take, tempo, **options):
    smooth_weights.main([*take.weights_options(**options), "--tempo", tempo])
    names = rig.read_any(take.folder / "rig.npz").names
    return names, weights.read(take.folder / "weights.parquet", names)


@pytest.mark.parametrize("tempo", ["2", "0.5", "1.25", "24/25"])
@pytest.mark.parametrize("rate", ["film", "24000/1001"])
def test_the_performance_passes_at_the_tempo(take, tempo, rate):
    names, read = at(take, tempo, rate=rate)
    assert read.rate == (RATE if rate == "film" else Fraction(rate))
    wanted = read.time_s * float(Fraction(tempo))
    source = np.arange(FRAMES) / float(RATE)
    assert wanted[-1] <= source[-1] + 1e-9
    assert wanted[-1] + float(Fraction(tempo) / read.rate) > source[-1]
    for column, name in enumerate(names):
        expected = np.interp(wanted, source, take.weights[name])
        np.testing.assert_allclose(read.shapes[:, column], expected, atol=1e-6)
    turns = scipy.spatial.transform.Rotation.from_quat(take.turns)
    inside = np.minimum(wanted, source[-1])
    expected = scipy.spatial.transform.Slerp(source, turns)(inside)
    found = scipy.spatial.transform.Rotation.from_quat(read.rotation)
    assert (found * expected.inv()).magnitude().max() < 1e-5
    meta = series.read(take.folder / "weights.parquet", "weights").meta
    assert Fraction(meta["tempo"]) == Fraction(tempo)


def test_a_sinusoid_lands_on_its_time(take):
    """The performance's third second is the take's second and a half at tempo two."""
    names = rig.read_any(take.folder / "rig.npz").names
    frames = np.arange(600)
    time = frames / 120
    columns = {name: 0.5 + 0.4 * np.sin(2 * np.pi * 1.5 * time) for name in names}
    columns["confidence"] = np.ones(600)
    series.write(take.folder / "slow.parquet", "predicted", frames, time, columns, Fraction(120))
    for smoothing in ("none", "multiresolution"):
        _, read = at(
            take, "2", solution="slow.parquet", rate="60", head="none", smoothing=smoothing
        )
        expected = 0.5 + 0.4 * np.sin(2 * np.pi * 3.0 * read.time_s)
        inner = slice(20, -20)
        wrong = np.abs(read.shapes[:, 0] - expected)[inner]
        assert wrong.max() < (1e-6 if smoothing == "none" else 0.02)


def test_at_tempo_one_the_bytes_are_the_same(take):
    smooth_weights.main(take.weights_options())
    before = (take.folder / "weights.parquet").read_bytes()
    at(take, "1")
    assert (take.folder / "weights.parquet").read_bytes() == before


def test_a_cut_counts_the_films_frames_and_edits_the_takes(take):
    """Frames 10 to 18 of the film are 5 to 9 of the take at tempo two."""
    table = take.folder / "edits.csv"
    names, _ = at(take, "2")
    table.write_text(f"frame,{names[0]}\n6,0.25\n")
    _, read = at(take, "2", first="10", last="18", handles="2", edits=[str(table)])
    np.testing.assert_array_equal(read.frame, np.arange(4, 11))
    assert read.shapes[2, 0] == 0.25
    expected = take.weights[names[0]][2 * read.frame]
    np.testing.assert_allclose(np.delete(read.shapes[:, 0] - expected, 2), 0, atol=1e-6)
    with pytest.raises(errors.InputError, match="the take ends with frame 22"):
        at(take, "2", first=str(FRAMES + 10))
    table.write_text(f"frame,{names[0]}\n{FRAMES - 1},0.25\n")
    with pytest.raises(errors.InputError, match=f"there is no frame {FRAMES - 1}"):
        at(take, "2", edits=[str(table)])


def test_timecode_runs_on_from_the_first_picture(take):
    _, read = at(take, "2", first="20", start="01:00:00:00")
    assert read.first_timecode == "01:00:00:10"


def test_other_tempos_are_refused(take):
    with pytest.raises(errors.InputError, match="--tempo: 'fast' is no tempo"):
        at(take, "fast")


def write_film(take):
    """Write a film that grows brighter, with a tone in its second half."""
    time = np.arange(int(FRAMES / 30 * SOUND_HZ)) / SOUND_HZ
    tone = 0.5 * np.sin(2 * np.pi * TONE_HZ * time) * (time > FRAMES / 60)
    path = take.folder / "tone.wav"
    with av.open(str(path), "w") as container:
        stream = container.add_stream("pcm_s16le", rate=SOUND_HZ, layout="mono")
        whole = (tone[None] * 32767).astype(np.int16)
        frame = av.AudioFrame.from_ndarray(whole, format="s16", layout="mono")
        frame.sample_rate = SOUND_HZ
        container.mux(stream.encode(frame))
        container.mux(stream.encode())
    frames = [(n / 30, np.full((96, 128, 3), 20 + 3 * n, np.uint8)) for n in range(FRAMES)]
    film_writer.write(take.folder / "film.mp4", frames, (128, 96), Fraction(30), path)


@pytest.mark.parametrize("tempo", [Fraction(3, 4), Fraction(5, 2)])
def test_the_preview_keeps_picture_character_and_sound_together(take, tempo):
    write_film(take)
    at(take, str(tempo))
    bake_mesh.main(take.bake_options())
    (take.folder / "points.tsv").write_text("contour\tkind\tcount\n")
    (take.folder / "regions.tsv").write_text("region\tpoint\tweight\n")
    files = {"video": "film.mp4", "point-set": "points.tsv", "regions": "regions.tsv"}
    files |= {"exr": "mesh.exr", "json": "mesh.json", "rig": "rig.npz", "preview": "preview.mp4"}
    paths = {flag: f"{take.folder}/{name}" for flag, name in files.items()}
    named = paths | {"shot": "talk", "character": "face", "tempo": str(tempo)}
    render_preview.main(words(named))
    with av.open(str(take.folder / "preview.mp4")) as container:
        shown = [(f.time, f.to_ndarray(format="rgb24")) for f in container.decode(video=0)]
    times = np.array([time for time, _ in shown])
    np.testing.assert_allclose(times, np.arange(FRAMES) / 30 / float(tempo), atol=1e-3)
    left = [picture[: preview.HEIGHT, :100].mean() for _, picture in shown]
    np.testing.assert_allclose(left, 20 + 3 * np.arange(FRAMES), atol=6)
    samples, _ = sound.read(take.folder / "preview.mp4", SOUND_HZ)
    length = FRAMES / 30 / float(tempo)
    assert len(samples) / SOUND_HZ == pytest.approx(length, abs=0.1)
    loud = np.flatnonzero(np.abs(samples) > 0.2)
    assert loud[0] / SOUND_HZ == pytest.approx(length / 2, abs=0.05)


def test_the_sound_beside_the_take(take):
    write_film(take)
    for name in ("sound.wav", "sound.flac"):
        paths = {"sound": f"{take.folder}/film.mp4", "retimed": f"{take.folder}/{name}"}
        retime_sound.main(words(paths | {"tempo": "1.6"}))
        samples, start = sound.read(take.folder / name, SOUND_HZ)
        assert start == 0
        # the film's sound ends on a whole packet
        assert len(samples) / SOUND_HZ == pytest.approx(FRAMES / 30 / 1.6, abs=0.05)
        power = np.abs(np.fft.rfft(samples * np.hanning(len(samples))))
        pitch = np.fft.rfftfreq(len(samples), 1 / SOUND_HZ)[np.argmax(power)]
        assert pitch == pytest.approx(TONE_HZ, rel=0.01)
