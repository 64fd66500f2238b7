"""Make the session `play`: films and C3D on one clock, words, labels and truth."""

import numpy as np

from data_example.generator import (
    capture,
    film,
    labels,
    landmarks,
    markers,
    play,
    play_truth,
    shots,
    skin,
    sound,
    spoken,
    truth,
)

CRF, SOUND_BITS = "28", 40000
# the extremes of `faces` whose pictures a person labelled, and pictures of the vignette with her
# head turned
LABELLED = (
    "emotion_neutral",
    "emotion_ecstasy",
    "emotion_amazement",
    "emotion_fear",
    "emotion_grief",
    "emotion_disgust",
    "emotion_rage",
    "emotion_anticipation",
    "emotion_contempt",
    "speech_m",
    "speech_sh",
    "speech_oo",
    "speech_oh",
    "speech_aa",
    "speech_ee",
    "blink_half",
    "blink_closed",
)
TURNED = (69, 121, 160, 219, 235, 278)
# smaller pictures, smaller errors
NOISE_PX = 0.2
LABEL_SEED, MARKER_SEED, SOUND_SEED, GRAIN_SEED = 33, 64, 74, 84


def labelled(name):
    """Return the labelled pictures of a take."""
    if name == "vignette":
        return TURNED
    at = play.extreme_frames()
    return tuple(sorted(at[extreme] * shots.RATE // play.RATE for extreme in LABELLED))


def label_text(name, neutral_brows):
    """Return the labels of a take as the text of a labels file."""
    shown, seed = play_truth.played(name, shots.RATE), LABEL_SEED + list(play.TAKES).index(name)
    contours = play_truth.drawn(shown, labelled(name), neutral_brows)
    return labels.table(contours, seed, NOISE_PX)


def film_sound(take, seed):
    """Return the sound of a film of the session, (S,) at sound.RATE."""
    duration = take.frames / play.RATE
    if not take.phones:
        return sound.room(duration, seed)
    return capture.film_sound(spoken.voice(take.starts, duration), seed)


def write_all(folder, names=tuple(play.TAKES)):
    """Write the session under the example's folder."""
    here = folder / "play"
    for place in (here, folder / "truth", folder / "labels"):
        place.mkdir(parents=True, exist_ok=True)
    body = skin.build()
    glued, brows = markers.glue(body), landmarks.brows()
    for number, (name, direct) in enumerate(play.TAKES.items()):
        if name not in names:
            continue
        take = direct()
        every = play_truth.played(name, play.RATE)
        path, seed = here / f"{name}.c3d", MARKER_SEED + number
        capture.write_markers(path, take, every, body, glued, play.RATE, seed)
        known = play_truth.of_take(name, body, glued, brows)
        truth.save(folder / "truth" / f"{name}.npz", known)
        if take.phones:
            said = [word for word, _, _ in spoken.words(take.phones) if word]
            (here / f"{name}.txt").write_text(" ".join(said) + "\n", encoding="utf-8")
        text = label_text(name, brows)
        (folder / "labels" / f"{name}.csv").write_text(text, encoding="utf-8")
        pictures = capture.pictures(play_truth.played(name, shots.RATE), glued, GRAIN_SEED + number)
        heard = np.asarray(film_sound(take, SOUND_SEED + number), np.float32)
        film.write(here / f"{name}.mp4", pictures, heard, CRF, SOUND_BITS)
