"""Try the head motion of markers and of film points on a face that moves: `--data FOLDER`.

`python -m bench.head_motion_trial --data FOLDER`, the folder as in `rig_take`. The actor's markers
(all 102, and the 60 landmarks of brows, eyes, nose, jaw line and outer lips) follow the recorded
track; a head of known motion carries them, with a noise of 0.3 mm. Mean errors of the rotation in
degrees: clean, with 5 % of the cells missing, with two rigid markers swapped for a second, and
with both. The oracle knows how far each marker moves on the face and which cells are swapped, and
fits to as many of the stillest as give the least error. In 2-D the points are seen by a camera
(weak perspective, perspective from 0.6 m, and a head that hardly turns away from it); the error is
that of the angle in the picture.
"""

import argparse
import sys

import numpy as np

from bench import rig_take
from stages.core import head_motion, planar_motion, quaternions, rigid_motion

RATE, STEP = 60, 2
CLIP = 900  # frames of the track: 15 s
NOISE, MISSING, SEED = 0.3, 0.05, 3
# distance of the camera [mm], and share of the turning out of the picture
VIEWS = {
    "3-D": (None, 1.0),
    "2-D, weak perspective": (np.inf, 1.0),
    "2-D, perspective": (600.0, 1.0),
    "2-D, facing the camera": (600.0, 0.2),
}
LANDMARKS = 60
OUTER_EYES = 36, 45
CASES = {"clean": (False, False), "5 % missing": (True, False), "2 swapped": (False, True)}
CASES["both"] = (True, True)


def main() -> None:
    """Print a table for each set of markers and each clip."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", required=True, help="folder of the two rigs and the track")
    folder = parser.parse_args().data
    names, track = rig_take.track(folder)
    actor = rig_take.actor(folder, names)
    widest = _widest(track[:, names.index("jawOpen")])
    clips = {"the whole take": track, "15 s of wide jaw": track[widest : widest + CLIP]}
    worst = {}
    for count in (rig_take.MARKERS, LANDMARKS):
        for clip, weights in clips.items():
            _say(f"\n{count} markers, {clip}")
            neutral, face = _face(actor, weights[::STEP], count)
            for view, (distance, turning) in VIEWS.items():
                turn, shift = _head(len(face), turning)
                measured = _carried(face, turn, shift, NOISE / _unit(actor))
                camera = None if distance is None else distance / _unit(actor)
                ratio = _table(view, (neutral, face, turn), measured, camera)
                worst[view] = max(worst.get(view, 0), ratio)
    for view, ratio in worst.items():
        _say(f"\n{view}: the default's error is at most {ratio:.2f} times the oracle's")


def _table(view, take, measured, distance):
    """Print the errors in every case, return the largest ratio of default and oracle."""
    ratios = []
    for case, damage in CASES.items():
        cells = _damaged(*take[:2], measured, *damage)
        errors = _in_space(*take, *cells) if distance is None else _seen(*take, *cells, distance)
        if case == "clean":
            heads = "".join(f"{name:>25}" for name in errors)
            _say(f"{view:24}{heads}{'default / oracle':>25}")
        default = errors["rigidity" if distance is None else "clip_deviation"]
        ratios.append(default / errors["oracle"])
        values = "".join(f"{value:25.3f}" for value in (*errors.values(), ratios[-1]))
        _say(f"  {case:22}{values}")
    return max(ratios)


def _widest(opening):
    """Return the first frame of the clip in which the jaw is open most."""
    sums = np.concatenate([[0], np.cumsum(opening)])
    return int(np.argmax(sums[CLIP:] - sums[:-CLIP]))


def _unit(actor):
    """Return the face unit [mm]."""
    first, second = actor.neutral[list(OUTER_EYES)]
    return float(np.linalg.norm(first - second))


def _face(actor, weights, count):
    """Return neutral (P, 3) and frames (T, P, 3) of the markers [face units]."""
    neutral, deltas = actor.neutral[:count], actor.deltas[:, :count]
    origin = actor.neutral[list(OUTER_EYES)].mean(axis=0)
    face = neutral + np.tensordot(weights, deltas, axes=1)
    return (neutral - origin) / _unit(actor), (face - origin) / _unit(actor)


def _head(count, turning):
    """Return rotations (T, 3, 3) and shifts (T, 3) of a lively head that starts at the neutral."""
    time = np.arange(count)[:, None] * STEP / RATE
    waves = ((0.15, 0.31), (0.10, 0.83), (0.03, 2.3))
    turns = sum(
        size * np.sin(2 * np.pi * rate * time + number * np.arange(3))
        for number, (size, rate) in enumerate(waves, 1)
    )
    shift = 0.3 * np.sin(0.7 * time + np.arange(3))
    return _rotations((turns - turns[0]) * [turning, turning, 1.0]), shift - shift[0]


def _carried(face, turn, shift, noise):
    """Return the frames (T, P, 3) on the head, measured with noise."""
    noisy = face + np.random.default_rng(SEED).normal(0, noise, face.shape)
    return noisy @ turn.transpose(0, 2, 1) + shift[:, None]


def _rotations(vectors):
    """Return the rotations (T, 3, 3) about vectors (T, 3) by their lengths [rad]."""
    angle = np.linalg.norm(vectors, axis=1)[:, None, None]
    x, y, z = (vectors / np.fmax(angle[:, 0], 1e-12)).T
    zero = np.zeros_like(x)
    cross = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=1).reshape(-1, 3, 3)
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * (cross @ cross)


def _damaged(neutral, face, measured, missing, swapped):
    """Return the damaged markers, and the same with the swapped cells left out for the oracle."""
    damaged, honest = measured.copy(), measured.copy()
    if swapped:
        stillest = np.argsort(_motion(neutral, face), kind="stable")
        pair, start = stillest[[0, 5]], len(face) // 3
        part = slice(start, start + RATE // STEP)
        damaged[part, pair] = measured[part, pair[::-1]]
        honest[part, pair] = np.nan
    if missing:
        lost = np.random.default_rng(SEED).random(face.shape[:2]) < MISSING
        damaged[lost] = honest[lost] = np.nan
    return damaged, honest


def _motion(neutral, face):
    """Return each marker's root mean square motion on the face (P,)."""
    return np.sqrt(np.mean(np.sum((face - neutral) ** 2, axis=2), axis=0))


def _stillest(neutral, face, error_of):
    """Return the least error over the numbers of stillest markers, `error_of(chosen)`."""
    ordered = np.sort(_motion(neutral, face))
    tried = [error_of(_motion(neutral, face) <= ordered[k]) for k in range(4, len(neutral) // 2, 2)]
    # with too few of them, damaged frames cannot be told
    return float(np.nanmin(tried))


def _in_space(neutral, face, turn, damaged, honest):
    """Return the error of every method in space."""
    errors = {
        name: _degrees(head_motion.solve(damaged, neutral, name)[0], turn)
        for name in head_motion.METHODS
    }
    errors["oracle"] = _stillest(
        neutral,
        face,
        lambda chosen: _degrees(rigid_motion.fit(honest, neutral, chosen * 1.0)[0], turn),
    )
    return errors


def _degrees(found, turn):
    """Return the mean angle between rotations (T, 3, 3)."""
    between = quaternions.from_matrices(found.transpose(0, 2, 1) @ turn)
    return float(np.degrees(np.mean(2 * np.arcsin(np.linalg.norm(between[:, :3], axis=1)))))


def _seen(neutral, face, turn, damaged, honest, distance):
    """Return the error of the planar fits of a camera's points."""
    neutral_2d, damaged, honest = (
        _project(points, distance) for points in (neutral, damaged, honest)
    )
    true = planar_motion.decompose(turn[:, :2, :2])[0]

    def error(points, deviation):
        linear, _ = planar_motion.fit(points, neutral_2d, deviation)
        return float(np.degrees(np.nanmean(np.abs(planar_motion.decompose(linear)[0] - true))))

    even = np.ones(len(neutral))
    deviation = planar_motion.clip_deviation(damaged, neutral_2d, even, SEED)
    errors = {"even": error(damaged, 0.1 * even), "clip_deviation": error(damaged, deviation)}
    rigid, loose = planar_motion.FLOOR, 100.0
    errors["oracle"] = _stillest(
        neutral, face, lambda chosen: error(honest, np.where(chosen, rigid, loose))
    )
    return errors


def _project(points, distance):
    """Return what a camera at a distance [face units] in front of the face sees."""
    return points[..., :2] / (1 - points[..., 2:] / distance)


def _say(line):
    """Print a line."""
    sys.stdout.write(line + "\n")


if __name__ == "__main__":
    main()
