"""Time the solves of rigs with hundreds of shapes: `python -m bench.large_rig`.

A made-up face of 102 markers (306 coordinates) at 120 frames a second for five minutes, moved by
shapes that each reach a part of it, as those of large rigs do; 0.3 mm of noise. Weights are events
of a quarter to one second, 15 % of them at a time. Times are those of one core that does nothing
else. First `bounded` and `clip`: seconds for the take (`clip` is timed on its first part, what it
takes grows with the frames), the largest KKT residual, the root mean square error of the weights.
Then the non-negative solve on a few frames against looped `scipy.optimize.nnls` on the same
problem, ridge included: milliseconds a frame each, what nnls would take for the take, and the
largest relative difference of the objective; for up to 250 shapes the solve in 0..1 against
`scipy.optimize.lsq_linear` likewise.
"""

import argparse
import sys
import time

import numpy as np
from scipy import optimize

from stages.core import equation, frame_least_squares

POINTS, RATE, FRAMES, NOISE_MM, STRENGTH = 102, 120, 36_000, 0.3, 3.0
SHAPES = (46, 250, 946)
# frames on which the references are timed
NNLS_FRAMES, LSQ_LINEAR_FRAMES = {46: 200, 250: 40, 946: 3}, {46: 50, 250: 4}
REACH, SIZE_MM, ACTIVE = (0.12, 0.6), (1.0, 10.0), 0.15


def main() -> None:
    """Print a row for every rig."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=int, default=FRAMES, help="length of the take")
    parser.add_argument("--shapes", type=int, nargs="+", default=SHAPES, help="sizes of the rigs")
    parser.add_argument("--clip-frames", type=int, default=4_000, help="`clip` is timed on these")
    options = parser.parse_args()
    for shapes in options.shapes:
        rng = np.random.default_rng(shapes)
        deltas = rig(shapes, rng)
        weights = motion(options.frames, shapes, rng)
        points = np.tensordot(weights, deltas, axes=1)
        points += NOISE_MM * rng.standard_normal(points.shape)
        _say(f"{shapes} shapes, {options.frames} frames")
        _whole("bounded", points, deltas, weights, options.frames)
        part = slice(options.clip_frames)
        _whole("clip", points[part], deltas, weights[part], options.frames)
        for upper, reference, sample in (
            (np.inf, _nnls, NNLS_FRAMES),
            (1.0, _lsq_linear, LSQ_LINEAR_FRAMES),
        ):
            if shapes in sample:
                chosen = points[len(points) // 2 :][: sample[shapes]]
                _sampled(points, deltas, chosen, upper, reference)


def rig(shapes, rng):
    """Return shapes (K, P, 3) [mm] that each reach a round part of a flat face 2 wide."""
    places, centres = (rng.uniform(-1, 1, (count, 2)) for count in (POINTS, shapes))
    reach, size = (np.exp(rng.uniform(*np.log(span), shapes)) for span in (REACH, SIZE_MM))
    away = (places - centres[:, None]) / reach[:, None, None]
    fall = np.maximum(1 - np.sum(away**2, axis=2), 0) ** 2
    along = rng.standard_normal((shapes, 1, 3))
    along /= np.linalg.norm(along, axis=2, keepdims=True)
    turning = np.einsum("kdj,kpj->kpd", 0.7 * rng.standard_normal((shapes, 3, 2)), away)
    return size[:, None, None] * fall[:, :, None] * (along + turning)


def motion(frames, shapes, rng):
    """Return weights (T, K): raised cosines of 0.25 to 1 s."""
    weights = np.zeros((frames, shapes))
    for shape in range(shapes):
        for first in rng.integers(frames, size=round(ACTIVE * frames / (0.6 * RATE)) + 1):
            length = int(rng.uniform(0.25, 1.0) * RATE)
            event = (1 - np.cos(2 * np.pi * np.arange(length) / length)) * rng.uniform(0.1, 0.5)
            held = weights[first : first + length, shape]
            held[:] = np.maximum(held, event[: len(held)])
    return weights


def _whole(method, points, deltas, weights, frames):
    """Print how long a solve takes, for as many frames as the take has."""
    places = np.random.default_rng(0).standard_normal(deltas.shape[1:])
    start = time.process_time()
    found = equation.solve(
        points + places, places, places, deltas, method, strength=STRENGTH, rate=RATE
    )
    passed = (time.process_time() - start) * frames / len(points)
    error = np.sqrt(np.mean((found.weights - weights) ** 2))
    worst = found.kkt_residual.max()
    _say(f"  {method:12}{passed:8.1f} s   KKT {worst:.1e}   weight RMSE {error:.4f}")


def _sampled(points, deltas, chosen, upper, reference):
    """Print how long a reference takes on some frames, and how near the objectives are."""
    shapes = len(deltas)
    matrix = deltas.reshape(shapes, -1).T
    chosen = chosen.reshape(len(chosen), -1)
    ridge = equation.ridge(matrix)
    start = time.process_time()
    theirs = reference(np.vstack([matrix, np.sqrt(ridge) * np.eye(shapes)]), chosen)
    slow = (time.process_time() - start) / len(chosen)
    # with other frames of the take, since all of a window are solved together
    many = np.concatenate([chosen, points[:1024].reshape(-1, len(matrix))])
    start = time.process_time()
    limits = np.zeros(shapes), np.full(shapes, upper)
    ours, _ = frame_least_squares.solve(matrix, many, *limits, ridge, equation.FRAME_TOLERANCE)
    fast = (time.process_time() - start) / len(many)
    values = [
        np.sum((w @ matrix.T - chosen) ** 2, axis=1) + ridge * np.sum(w**2, axis=1)
        for w in (ours[: len(chosen)], theirs)
    ]
    apart = np.max((values[0] - values[1]) / values[1])
    _say(
        f"  {reference.__name__[1:]:12}{1e3 * slow:8.2f} ms a frame, ours {1e3 * fast:.3f}:"
        f" {slow / fast:.0f} times; all frames {slow * len(points) / 3600:.2f} h;"
        f" objective {apart:+.1e}"
    )


def _nnls(matrix, targets):
    """Return non-negative weights, frame by frame."""
    rest = np.zeros(len(matrix) - targets.shape[1])
    return np.array([optimize.nnls(matrix, np.r_[target, rest])[0] for target in targets])


def _lsq_linear(matrix, targets):
    """Return weights in 0..1, frame by frame."""
    rest = np.zeros(len(matrix) - targets.shape[1])
    return np.array(
        [
            optimize.lsq_linear(matrix, np.r_[target, rest], (0, 1), method="bvls", tol=1e-12).x
            for target in targets
        ]
    )


def _say(line):
    """Print a line."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
