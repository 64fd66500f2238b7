"""Try the search for mistaken markers and gap filling on takes with known truth: `--data FOLDER`.

`python -m bench.marker_trial --data FOLDER`, the folder as in `rig_take`. The take: 102 markers of
the actor, linear or not, moved by the recorded track brought from 30 to 120 Hz, with head motion
and noise. Faults: neighbours that are exchanged for half a second to a second, offsets of 5 to
25 mm for half a second to three seconds, and such jumps of 1 to 60 frames. Counted are cells, a
marker on a frame. Gaps: 200 for each length; errors are root mean squares in mm.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from bench import nonlinear_actor, rig_take
from stages.core import face_alignment, marker_faults, marker_gaps
from stages.files import marker_file

FRAMES, SEED = 8000, 1
NOISES_MM = (0.1, 0.3, 0.5)
GAPS, GAP_FRAMES, GAP_NOISE_MM = 200, (5, 15, 30, 60), 0.2
REAL, REAL_UNIT_MM = "blenderface/Subject_01.csv", 187.5
REAL_FAULTS, SEEDS = {"swap": 1, "offset": 2, "jump": 5}, 6
RATE, RECORDED = 120, 30
FAULTS = {"swap": 10, "offset": 30, "jump": 120}
LENGTHS = {"swap": (60, 120), "offset": (60, 360), "jump": (1, 60)}


def main():
    """Print what is found and what is filled."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", required=True, help="folder of the actor's rig and the track")
    folder = parser.parse_args().data
    takes = {kind: clean_take(folder, SEED, kind)[:FRAMES] for kind in ("linear", "not linear")}
    _say(f"Faults among {FRAMES} frames of 102 markers, cells")
    _say("actor        noise  on a clean take  planted  found  falsely  exchanged back")
    for kind, truth in takes.items():
        for noise in NOISES_MM:
            _say(f"{kind:12} {noise:5} " + _search(truth, noise, SEED, FAULTS))
    _say(f"\nGaps, noise {GAP_NOISE_MM} mm: error of linear, cubic, import_markers [mm]")
    for kind, truth in takes.items():
        for length in GAP_FRAMES:
            errors = " ".join(f"{error:7.2f}" for error in _fill(truth, length))
            _say(f"{kind:12} {length:3} frames {errors}")
    if (Path(folder) / REAL).is_file():
        _real(Path(folder) / REAL)


def _real(path):
    """Print what is found in a sound real take, and after planting faults."""
    points = marker_file.read(path).points * REAL_UNIT_MM
    points = points[np.isfinite(points).all(axis=(1, 2))]
    _say(f"\n{REAL}, {points.shape[0]} frames of {points.shape[1]} markers, cells")
    _say("faults from   on the clean take  planted  found  falsely  exchanged back")
    for seed in range(SEEDS):
        _say(f"seed {seed:2}            " + _search(points, 0.0, seed, REAL_FAULTS))


def _search(truth, noise, seed, counts):
    """Return a line of the table of faults."""
    rng = np.random.default_rng(seed)
    clean = truth + noise * rng.standard_normal(truth.shape)
    alarms = _flagged(_find(clean), truth.shape[:2])
    take, cells = plant(truth, rng, noise, counts)
    faults = _find(take)
    flagged, planted = _flagged(faults, truth.shape[:2]), np.any(list(cells.values()), axis=0)
    back = np.zeros_like(planted)
    for fault in faults:
        if fault.partner >= 0:
            back[fault.first : fault.last + 1, fault.marker] = True
    found = (flagged & planted).sum() / planted.sum()
    false = (flagged & ~planted).sum() / flagged.sum()
    share = (back & cells["swap"]).sum() / cells["swap"].sum()
    return f"{alarms.sum():16d} {planted.sum():8d} {found:6.3f} {false:8.3f} {share:15.3f}"


def _find(points):
    """Return the faults of a take."""
    points = points.astype(np.float32)
    return marker_faults.find(face_alignment.to_face(points, face_alignment.align(points)))


def _flagged(faults, shape):
    """Return the cells (T, P) of faults."""
    flagged = np.zeros(shape, bool)
    for fault in faults:
        flagged[fault.first : fault.last + 1, fault.marker] = True
    return flagged


def _fill(truth, length):
    """Return the errors of linear and cubic interpolation and of ours on gaps of a length [mm]."""
    rng = np.random.default_rng(SEED)
    take = (truth + GAP_NOISE_MM * rng.standard_normal(truth.shape)).astype(np.float32)
    gappy, gaps = take.copy(), []
    for _ in range(GAPS):
        marker, first = int(rng.integers(take.shape[1])), int(rng.integers(30, len(take) - 100))
        around = slice(first - 10, first + length + 10)
        if np.isfinite(gappy[around, marker]).all():
            gappy[first : first + length, marker] = np.nan
            gaps.append((marker, first))
    motion = face_alignment.align(gappy)
    face = marker_gaps.fill(face_alignment.to_face(gappy, motion), length)
    ours = face_alignment.from_face(face, motion)
    squares = []
    for marker, first in gaps:
        frames = np.arange(first, first + length)
        known = np.array([first - 2, first - 1, first + length, first + length + 1])
        # the cubic through two frames on either side, by Lagrange's formula
        weights = [
            np.prod([(frames - k) / (j - k) for k in known if k != j], axis=0) for j in known
        ]
        share = ((frames - known[1]) / (length + 1))[:, None]
        line = (1 - share) * take[known[1], marker] + share * take[known[2], marker]
        made = (line, np.stack(weights, axis=1) @ take[known, marker], ours[frames, marker])
        squares.append([((path - truth[frames, marker]) ** 2).sum(axis=1).mean() for path in made])
    return np.sqrt(np.mean(squares, axis=0))


def clean_take(folder, seed, kind="linear"):
    """Return the markers (T, P, 3) [mm] of the whole track, with head motion, without noise."""
    names, track = rig_take.track(folder)
    actor = rig_take.actor(folder, names)
    track = upsample(track, RATE // RECORDED)
    if kind == "linear":
        face = actor.neutral + (track @ rig_take.deltas_of(actor)).reshape(len(track), -1, 3)
    else:
        face = nonlinear_actor.move(nonlinear_actor.make(actor, names), track)
    rotation, translation = head_motion(len(face), seed)
    centre = actor.neutral.mean(axis=0) - [0, 0, 90]
    return np.einsum("tij,tpj->tpi", rotation, face - centre) + translation[:, None] + centre


def upsample(track, factor):
    """Return a track with frames between its own, on Catmull and Rom's cubics."""
    padded = np.concatenate([track[:1], track, track[-1:], track[-1:]])
    before, start, end, after = padded[:-3], padded[1:-2], padded[2:-1], padded[3:]
    parts = []
    for step in range(factor):
        u = step / factor
        slope = (end - before) / 2
        bend = before - 2.5 * start + 2 * end - after / 2
        twist = 1.5 * (start - end) + (after - before) / 2
        parts.append(start + u * (slope + u * (bend + u * twist)))
    return np.stack(parts, axis=1).reshape(-1, track.shape[1])


def head_motion(count, seed):
    """Return rotations (T, 3, 3) and translations (T, 3) of nods, shakes and sways."""
    rng = np.random.default_rng(seed)
    time = np.arange(count)[:, None] / RATE
    speeds = rng.uniform(0.1, 1.5, (6, 5))
    phases = rng.uniform(0, 2 * np.pi, (6, 5))
    waves = np.sin(2 * np.pi * speeds * time[:, None] + phases) / (0.5 + speeds)
    waves = waves.sum(axis=2)
    angles, translation = 0.08 * waves[:, :3], 8.0 * waves[:, 3:]
    # a quick nod every few seconds
    angles[:, 0] += 0.2 * np.sin(2 * np.pi * 2.5 * time[:, 0]) * (np.sin(0.9 * time[:, 0]) > 0.8)
    cos, sin, none, one = np.cos(angles), np.sin(angles), np.zeros(count), np.ones(count)
    about_x = [one, none, none, none, cos[:, 0], -sin[:, 0], none, sin[:, 0], cos[:, 0]]
    about_y = [cos[:, 1], none, sin[:, 1], none, one, none, -sin[:, 1], none, cos[:, 1]]
    about_z = [cos[:, 2], -sin[:, 2], none, sin[:, 2], cos[:, 2], none, none, none, one]
    turns = [np.stack(rows, axis=1).reshape(-1, 3, 3) for rows in (about_x, about_y, about_z)]
    return turns[2] @ turns[1] @ turns[0], translation


def plant(points, rng, noise, counts):
    """Return the take with noise and faults, and the cells (T, P) that each kind of fault has."""
    count, markers, _ = points.shape
    take = points + noise * rng.standard_normal(points.shape)
    taken = np.zeros((count, markers), bool)
    cells = {kind: np.zeros((count, markers), bool) for kind in ("jump", "swap", "offset")}
    median = np.median(points - points.mean(axis=1, keepdims=True), axis=0)
    for kind, number in counts.items():
        for _ in range(number):
            length = int(rng.integers(*LENGTHS[kind]))
            first, marker = int(rng.integers(count - length)), int(rng.integers(markers))
            frames = slice(first, first + length)
            wanted = [marker]
            if kind == "swap":
                distance = np.linalg.norm(median - median[marker], axis=1)
                near = np.where(distance > 5, distance, np.inf).argsort()[:6]
                wanted = [marker, int(rng.choice(near))]
            around = slice(max(first - 30, 0), first + length + 30)
            if taken[around][:, wanted].any():
                continue
            taken[frames, wanted] = True
            cells[kind][frames, wanted] = True
            if kind == "swap":
                take[frames, wanted] = take[frames, wanted[::-1]]
            else:
                away = rng.standard_normal(3)
                away *= rng.uniform(5, 25) / np.linalg.norm(away)
                take[frames, marker] += away
    return take, cells


def _say(line):
    """Print a line."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
