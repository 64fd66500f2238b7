import json
from fractions import Fraction

import av
import numpy as np
import pytest

from stages import cli, sync_audio
from stages.files import sync

RATE = 16000


def speech(seconds, seed):
    """Bursts of noise, four a second, with pauses: no two seeds are alike."""
    rng = np.random.default_rng(seed)
    syllables = rng.random(round(seconds * 4) + 2) * (rng.random(round(seconds * 4) + 2) < 0.7)
    count = round(seconds * RATE)
    envelope = np.interp(np.arange(count) / RATE * 4, np.arange(len(syllables)), syllables)
    return 0.2 * envelope * np.convolve(rng.standard_normal(count), np.ones(4) / 2, "same")


def add_sound(container, stream, samples, start_s=0.0):
    for first in range(0, len(samples), 1024):
        values = samples[None, first : first + 1024]
        frame = av.AudioFrame.from_ndarray((values * 32767).astype(np.int16), "s16", "mono")
        frame.sample_rate, frame.time_base = RATE, Fraction(1, RATE)
        frame.pts = first + round(start_s * RATE)
        container.mux(stream.encode(frame))
    container.mux(stream.encode())


def write_wav(path, samples):
    with av.open(str(path), "w") as container:
        add_sound(container, container.add_stream("pcm_s16le", rate=RATE, layout="mono"), samples)
    return path


def write_film(path, samples, sound_start_s):
    with av.open(str(path), "w") as container:
        video = container.add_stream("libx264", rate=10)
        video.width, video.height, video.pix_fmt = 64, 48, "yuv420p"
        audio = container.add_stream("aac", rate=RATE, layout="mono")
        for number in range(60):
            picture = av.VideoFrame.from_ndarray(np.zeros((48, 64, 3), np.uint8), format="rgb24")
            picture.pts, picture.time_base = number, Fraction(1, 10)
            container.mux(video.encode(picture))
        container.mux(video.encode())
        add_sound(container, audio, samples, sound_start_s)
    return path


def run(folder, video, sound, offset_s=""):
    flags = {"video": video, "sound": sound, "offset-s": offset_s, "sync": folder / "sync.json"}
    sync_audio.main([part for flag, value in flags.items() for part in (f"--{flag}", str(value))])
    return json.loads((folder / "sync.json").read_text())


def test_a_film_whose_sound_starts_late(tmp_path):
    whole = speech(8, 1)
    # the mocap system starts 1.2 s after the sound of the film, which starts 0.3 s after the film
    film = write_film(tmp_path / "film.mp4", whole[: 6 * RATE], 0.3)
    mocap = write_wav(tmp_path / "mocap.wav", whole[round(1.2 * RATE) :])
    found = run(tmp_path, film, mocap)
    assert abs(found.pop("offset_s") - 1.5) < 1e-3
    assert found.pop("confidence") > 0.6
    assert found == {
        "drift_ppm": 0.0,
        "drift_error_ppm": None,
        "method": "gcc_phat",
        "refused": False,
        "reason": "",
    }
    before = (tmp_path / "sync.json").read_bytes()
    assert abs(sync.read(tmp_path / "sync.json").offset_s - 1.5) < 1e-3
    run(tmp_path, film, mocap)
    assert (tmp_path / "sync.json").read_bytes() == before


@pytest.mark.parametrize(
    ("samples", "reason"),
    [
        (speech(6, 2), "no common sound found"),
        (np.zeros(6 * RATE), "the mocap's sound is silent"),
        (speech(0.5, 1), "the mocap's sound is too short: 0.50 s"),
    ],
)
def test_a_refusal_is_a_result(tmp_path, samples, reason):
    film = write_wav(tmp_path / "film.wav", speech(6, 1))
    found = run(tmp_path, film, write_wav(tmp_path / "mocap.wav", samples))
    assert (found["refused"], found["reason"]) == (True, reason)
    assert found["offset_s"] is None
    assert found["drift_ppm"] is None
    with pytest.raises(ValueError, match=reason):
        sync.read(tmp_path / "sync.json")


def test_an_offset_that_is_given_is_taken_without_listening(tmp_path):
    found = run(tmp_path, tmp_path / "no film", tmp_path / "no sound", " -0.75 ")
    assert found == {
        "offset_s": -0.75,
        "drift_ppm": 0.0,
        "drift_error_ppm": None,
        "confidence": 1.0,
        "method": "given",
        "refused": False,
        "reason": "",
    }


def test_errors_are_one_line_and_leave_no_file(tmp_path, monkeypatch, capsys):
    sound = write_wav(tmp_path / "a.wav", speech(2, 1))
    text = tmp_path / "text.mp4"
    text.write_text("no film")
    for video, offset, message in (
        (text, "", f"error: {text}: its sound cannot be decoded"),
        (tmp_path / "none.mp4", "", "none.mp4: no such sound"),
        (sound, "soon", "error: --offset-s: expected seconds, found 'soon'"),
        (sound, "inf", "error: --offset-s: expected seconds, found 'inf'"),
    ):
        argv = ["sync_audio", "--video", video, "--sound", sound, "--offset-s", offset]
        monkeypatch.setattr("sys.argv", [str(part) for part in (*argv, "--sync", tmp_path / "s")])
        with pytest.raises(SystemExit) as stop:
            cli.run_stage(sync_audio.main)
        assert stop.value.code == 1
        said = capsys.readouterr().err
        assert message in said
        assert said.count("\n") == 1
    assert not (tmp_path / "s").exists()
