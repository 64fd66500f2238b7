"""Make the marker takes: C3D, film with the markers on the face, two sounds, words and phones."""

from typing import NamedTuple

import cv2
import numpy as np
from scipy import signal
from scipy.spatial import transform

from data_example.generator import (
    actor,
    c3d,
    film,
    marker_cues,
    marker_takes,
    marker_truth,
    markers,
    mia,
    params,
    render,
    shots,
    skin,
    sound,
    sound_file,
    spoken,
    text_grid,
    truth,
)

NOISE_MM = 0.15
STEP_MM = 0.05
# the mocap system's axes: x to Mia's left, y behind her, z up; her head sits over its origin
SEAT = np.array([35.0, -140.0, 1180.0])
# other widths than multiples of 32 make x264 forget to be deterministic
PICTURE = 384
DOT_MM = 1.6
CRF, SOUND_BITS = "27", 40000
# how far a marker may stand behind what is seen there and still be seen [mm]
BEHIND_MM = 3.0


class Played(NamedTuple):
    """A take at some times.

    expression : (T, N) float array, columns params.NAMES
    quaternion : (T, 4) float array, head rotation x, y, z, w
    translation : (T, 3) float array [mm]
    """

    expression: np.ndarray
    quaternion: np.ndarray
    translation: np.ndarray


def play_at(take, times):
    """Return a take at times on the clock of the notes."""
    return Played(marker_takes.expression(take, times), *marker_takes.head(take, times))


def true_markers(body, glued, table):
    """Return the markers without head motion, (T, 102, 3) [mm], and their normals."""
    pairs = [markers.still(body, glued, params.from_row(row)) for row in table]
    return np.stack([p for p, _ in pairs]), np.stack([n for _, n in pairs])


def measured(take, world, seed):
    """Return what the mocap system makes of the markers: noise, gaps and faults, (T, 102, 3)."""
    rng = np.random.default_rng(seed)
    result = world + NOISE_MM * rng.standard_normal(world.shape)
    index = {name: i for i, name in enumerate(markers.NAMES)}
    for kind, names, first, count, by in marker_takes.faults(take):
        rows, columns = slice(first, first + count), [index[name] for name in names]
        if kind == "swap":
            result[rows, columns] = result[rows, columns[::-1]]
        else:
            result[rows, columns] += by
    for name, first, count in marker_takes.gaps(take):
        result[first : first + count, index[name]] = np.nan
    return result


def in_system(points):
    """Return points in the mocap system's axes [mm]."""
    return np.stack([points[..., 0], -points[..., 2], points[..., 1]], axis=-1) + SEAT


def write_markers(path, take, played, body, glued, rate, seed):
    """Write the C3D of a take that is played at the markers' rate."""
    turns = transform.Rotation.from_quat(played.quaternion).as_matrix()
    points, _ = true_markers(body, glued, played.expression)
    seen = measured(take, markers.moved(points, turns, played.translation), seed)
    names = [markers.PREFIX + name for name in markers.NAMES]
    c3d.write(path, names, in_system(seen), rate, STEP_MM, "")


def _dots(picture, depth, world, normal):
    """Return a picture with the markers that the camera sees, as shining balls."""
    places = render.project(world)
    at = np.clip(np.floor(places * render.SAMPLES).astype(int), 0, np.array(depth.shape[::-1]) - 1)
    distance = -render.to_camera(world)[:, 2]
    seen = (distance < depth[at[:, 1], at[:, 0]] + BEHIND_MM) & (normal[:, 2] > 0.05)
    key = render.KEY / np.linalg.norm(render.KEY)
    shine = np.clip(0.62 + 0.38 * (normal @ key), 0.35, 1.0)
    radius = render.FOCAL * DOT_MM / distance
    result = picture.copy()
    for number in np.flatnonzero(seen):
        left, top = np.floor(places[number]).astype(int) - 4
        window = (slice(max(top, 0), top + 9), slice(max(left, 0), left + 9))
        y, x = np.mgrid[window] + 0.5
        off = np.hypot(x - places[number, 0], y - places[number, 1]) / radius[number]
        # a ball is darker towards its rim
        tone = shine[number] * (1 - 0.45 * np.clip(off, 0, 1) ** 2)
        cover = np.clip((1 - off) * radius[number] + 0.5, 0, 1)
        result[window] += cover[..., None] * (tone[..., None] - result[window])
    return result


def pictures(played, glued, seed):
    """Yield the 8-bit pictures of a film that is played at its rate."""
    woman = mia.build()
    atlas = mia.paint(woman)
    turns = transform.Rotation.from_quat(played.quaternion).as_matrix()
    translation = played.translation
    empty = render.backdrop()
    for frame, row in enumerate(played.expression):
        p = params.from_row(row)
        still = actor.pose(woman, p)
        ambient = actor.shade(woman, still, p)
        vertices = actor.move(woman, mia.proportioned(still), turns[frame], translation[frame])
        picture, depth = render.picture(woman, atlas, vertices, ambient, empty)
        points, normal = markers.still(woman.skin, glued, p)
        world = markers.moved(points[None], turns[frame, None], translation[frame, None])[0]
        picture = _dots(picture, depth, world, normal @ turns[frame].T)
        small = cv2.resize(picture, (PICTURE, PICTURE), interpolation=cv2.INTER_AREA)
        yield film.noisy(small, seed, frame)


def film_sound(dry, seed=71):
    """Return the camera's sound: a bright microphone in a live room, (S,) at sound.RATE.

    Parameters
    ----------
    dry : (N,) float array, the voice at spoken.RATE
    seed : int
    """
    rng = np.random.default_rng(seed)
    up = signal.resample_poly(dry, sound.RATE, spoken.RATE)
    bright = signal.sosfilt(signal.butter(2, 140, "high", fs=sound.RATE, output="sos"), up)
    bright = bright + 0.5 * signal.sosfilt(
        signal.butter(1, 2500, "high", fs=sound.RATE, output="sos"), up
    )
    tail = np.arange(round(0.25 * sound.RATE))
    room = rng.standard_normal(len(tail)) * np.exp(-tail / (0.06 * sound.RATE))
    echo = signal.fftconvolve(bright, room)[: len(bright)] / np.sqrt((room**2).sum())
    noise = signal.lfilter([0.05], [1, -0.95], rng.standard_normal(len(bright)))
    mixed = 0.55 * bright + 0.16 * echo + 0.012 * noise
    return mixed.astype(np.float32)


def system_sound(take, seed=72):
    """Return the mocap system's sound: a dull microphone with hum and hiss, (S,) at spoken.RATE."""
    rng = np.random.default_rng(seed)
    dry = _voice(take.offset_s, take.frames / marker_takes.RATE)
    dull = signal.sosfilt(signal.butter(2, 3400, fs=spoken.RATE, output="sos"), dry)
    t = np.arange(len(dull)) / spoken.RATE
    hum = np.sin(2 * np.pi * 50 * t) + 0.4 * np.sin(2 * np.pi * 150 * t + 1)
    hiss = rng.standard_normal(len(dull))
    return (0.06 * dull + 0.0004 * hum + 0.0003 * hiss).astype(np.float32)


def _voice(start_s, duration_s):
    """Return the voice from a time on the film's clock, (S,) at spoken.RATE."""
    starts = {name: at - start_s for name, at in marker_cues.SENTENCES.items()}
    return spoken.voice(starts, duration_s)


def write_words(folder, name, take):
    """Write what is said, and the phones on the clock of the mocap system's sound."""
    phones = spoken.moved(take.phones, -take.offset_s)
    said = [word for word, _, _ in spoken.words(phones) if word]
    (folder / f"{name}.txt").write_text(" ".join(said) + "\n", encoding="utf-8")
    duration = take.frames / marker_takes.RATE
    (folder / f"{name}.TextGrid").write_text(text_grid.text(phones, duration), encoding="utf-8")


def write_all(folder, names=tuple(marker_takes.TAKES)):
    """Write the marker takes under the example's folder."""
    here = folder / "capture"
    here.mkdir(parents=True, exist_ok=True)
    (folder / "truth").mkdir(exist_ok=True)
    body = skin.build()
    glued = markers.glue(body)
    for seed, (name, direct) in enumerate(marker_takes.TAKES.items()):
        if name not in names:
            continue
        take = direct()
        played = play_at(take, marker_takes.marker_times(take))
        path = here / f"{name}.c3d"
        write_markers(path, take, played, body, glued, marker_takes.RATE, 60 + seed)
        truth.save(folder / "truth" / f"{name}.npz", marker_truth.of_take(name, body, glued))
        if take.duration_s:
            write_words(here, name, take)
            sound_file.write(here / f"{name}.flac", system_sound(take), spoken.RATE)
            shown = play_at(take, np.arange(round(take.duration_s * shots.RATE)) / shots.RATE)
            heard = film_sound(_voice(0.0, take.duration_s))
            path = here / f"{name}.mp4"
            film.write(path, pictures(shown, glued, 80 + seed), heard, CRF, SOUND_BITS)
