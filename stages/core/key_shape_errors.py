"""What a set of key shapes would cost on frames that it was chosen from, and on others."""

import numpy as np

from stages.core import key_shape_candidates, key_shape_selection, pca

TRAINING, HELD_OUT = "training", "held_out"


def blocks(shots, frames, folds):
    """Cut every shot into equal blocks of time and deal them to folds.

    Parameters
    ----------
    shots : (T,) array
        Name of each frame's shot; the frames of a shot stand together.
    frames : (T,) int array
    folds : int

    Returns
    -------
    (T,) int array
        Fold of each frame; a fold holds two blocks of each shot.
    """
    number = np.empty(len(frames), int)
    for shot in dict.fromkeys(shots):
        rows = np.flatnonzero(np.asarray(shots) == shot)
        order = np.argsort(np.argsort(np.asarray(frames)[rows], kind="stable"))
        number[rows] = order * 2 * folds // len(rows) % folds
    return number


def curve(candidates, fold, method, counts, solve):
    """Choose on all folds but one and measure on both parts, for every fold and count.

    Parameters
    ----------
    candidates : key_shape_candidates.Candidates
        Its locks are left aside: they are the artist's, not the method's.
    fold : (T,) int array
    method : str
        See `key_shape_selection`.
    counts : sequence of int
    solve : callable
        ``(frames, shapes, neutral) -> key_weights.Solution``.

    Returns
    -------
    list of (count, split, rms) tuples
        Root mean square over the frames of all folds [feature unit]; a count that some fold
        cannot fill is left out.
    """
    parts = [_part(candidates, fold, number) for number in np.unique(fold)]
    fewest = min(len(training.frames) for training, _ in parts)
    counts = [count for count in counts if count <= fewest]
    choices = [_choices(training, counts, method) for training, _ in parts]
    rows = []
    for chosen in zip(*choices, strict=True):
        count = round(np.mean([len(frames) for frames in chosen]))
        squares: dict[str, list[np.ndarray]] = {TRAINING: [], HELD_OUT: []}
        for (training, held_out), key_frames in zip(parts, chosen, strict=True):
            shapes = training.frames[key_frames]
            for split, frames in ((TRAINING, training.frames), (HELD_OUT, held_out)):
                squares[split].append(solve(frames, shapes, candidates.neutral).residual ** 2)
        rows += [(count, split, rms(np.concatenate(part))) for split, part in squares.items()]
    return rows


def _choices(candidates, counts, method):
    """Return the frames chosen for every count; once where the data fix the count."""
    if method == key_shape_selection.FIXED_BY_DATA:
        counts = counts[:1]
    if method in key_shape_selection.NESTED:
        largest = key_shape_selection.choose(candidates, max(counts), method)
        return [[choice.frame for choice in largest[:count]] for count in counts]
    return [
        [choice.frame for choice in key_shape_selection.choose(candidates, count, method)]
        for count in counts
    ]


def rms(squares):
    """Return the root of the mean of squared distances."""
    return float(np.sqrt(np.mean(squares)))


def _part(candidates, fold, number):
    """Return the candidates outside one fold, and the usable frames (T', D) within it."""
    kept = (fold != number) & np.isfinite(candidates.frames).all(axis=1)
    inside = (fold == number) & candidates.eligible
    frames = candidates.frames[kept & candidates.eligible]
    training = key_shape_candidates.Candidates(
        frames,
        candidates.neutral,
        pca.fit(frames),
        np.ones(len(frames), bool),
        seed=candidates.seed,
    )
    return training, candidates.frames[inside]
