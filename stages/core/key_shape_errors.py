"""What a set of key shapes would cost on frames that it was chosen from, and on others."""

import numpy as np

from stages.core import clustering, key_shape_candidates, key_shape_selection, pca

TRAINING, HELD_OUT = "training", "held_out"
# clusters' centres of mass, which are no frames: what the paper plots
CENTRES = {"clustering_2d_centres": 2, "clustering_3d_centres": 3}
# measured at few counts, unless it is what a region uses
SLOW = "swap_refinement"
_FOLDS = 3
_FRAMES = 240
METHODS = (*key_shape_selection.SELECTORS, *CENTRES)


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


def curves(candidates, shots, frames, counts, few, solve):
    """Measure every method on blocks of time: its `curve`, on at most a few hundred frames.

    Parameters
    ----------
    candidates : key_shape_candidates.Candidates
    shots, frames : (T,) array
        Where each frame stands.
    counts : sequence of int
    few : sequence of int
        The counts of the method that is slow.
    solve : callable
        ``(frames, shapes, neutral) -> key_weights.Solution``.

    Returns
    -------
    list of (method, count, split, rms) tuples
    """
    rows = np.flatnonzero(candidates.eligible)
    rows = rows[:: max(1, len(rows) // _FRAMES)]
    fold = blocks(shots[rows], frames[rows], _FOLDS)
    seen = candidates._replace(
        frames=candidates.frames[rows], eligible=np.ones(len(rows), bool), locked=()
    )
    return [
        (method, *row)
        for method in METHODS
        for row in curve(seen, fold, method, few if method == SLOW else counts, solve)
    ]


def curve(candidates, fold, method, counts, solve):
    """Choose on all folds but one and measure on both parts, for every fold and count.

    Parameters
    ----------
    candidates : key_shape_candidates.Candidates
        Its locks are left aside: they are the artist's, not the method's.
    fold : (T,) int array
    method : str
        One of `METHODS`.
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
    every = [_shapes(training, counts, method) for training, _ in parts]
    rows = []
    for chosen in zip(*every, strict=True):
        count = round(np.mean([len(shapes) for shapes in chosen]))
        squares: dict[str, list[np.ndarray]] = {TRAINING: [], HELD_OUT: []}
        for (training, held_out), shapes in zip(parts, chosen, strict=True):
            for split, frames in ((TRAINING, training.frames), (HELD_OUT, held_out)):
                squares[split].append(solve(frames, shapes, candidates.neutral).residual ** 2)
        rows += [(count, split, rms(np.concatenate(part))) for split, part in squares.items()]
    return rows


def _shapes(candidates, counts, method):
    """Return the key shapes (K, D) of every count; once where the data fix the count."""
    if method in CENTRES:
        return [clustering.centres(candidates, count, CENTRES[method]) for count in counts]
    if method == key_shape_selection.FIXED_BY_DATA:
        counts = counts[:1]
    if method in key_shape_selection.NESTED:
        largest = _chosen(candidates, max(counts), method)
        return [largest[:count] for count in counts]
    return [_chosen(candidates, count, method) for count in counts]


def _chosen(candidates, count, method):
    """Return the shapes (K, D) that a selector takes."""
    choices = key_shape_selection.choose(candidates, count, method)
    return candidates.frames[[choice.frame for choice in choices]]


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
        sigma=candidates.sigma,
    )
    return training, candidates.frames[inside]
