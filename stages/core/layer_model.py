"""Hold the extremes of all layers under all masks, and bring frames to their size."""

from typing import NamedTuple

import numpy as np

RIDGE = 1e-9


class Model(NamedTuple):
    """Hold K extremes of J layers under R masks of D coordinates.

    Displacement ``i = l * K + k`` is extreme k under mask l; the solver's point holds the weights
    (R * J) and then the coefficients (K).

    Attributes
    ----------
    basis : (D, K) float array, extremes less the neutral [balanced]
    layer : (K,) int array, the layer of each extreme
    masks : (R, D) float array, one at every coordinate in sum
    lips : (N,) int array, entries of the solver's point that closed lips pull; none without bias
    closed_lips : (N,) float array, where they pull them
    lip_share : (D,) float array, the lips' mask; zero without bias
    lip_gram : (R * K, R * K) float array, as `gram`, each coordinate by its `lip_share`
    pairs : (N, 2) int array, masks that overlap, each with itself too
    gram : (R * K, R * K) float array, ``(M_l B)'(M_m B)``
    scale : float, mean of the Gram matrix's diagonal where it is not zero
    span : (R * K, R * K) float array, inverse of the Gram matrix plus a slight ridge
    first, second : (R * K,) int array, where a displacement's weight and coefficient stand
    group : (R * J + K,) int array, the simplex of each entry of the solver's point
    mask_group : (R * K,) int array, the mask of each displacement
    shares : (R * J,) float array, of each layer in the mean squared extremes under a mask
    gap_row : (R * K,) float array, the lips' gap by displacements, over the root mean square of
        the extremes' gaps; zero where no gaps are known
    """

    basis: np.ndarray
    layer: np.ndarray
    masks: np.ndarray
    lips: np.ndarray
    closed_lips: np.ndarray
    lip_share: np.ndarray
    lip_gram: np.ndarray
    pairs: np.ndarray
    gram: np.ndarray
    scale: float
    span: np.ndarray
    first: np.ndarray
    second: np.ndarray
    group: np.ndarray
    mask_group: np.ndarray
    shares: np.ndarray
    gap_row: np.ndarray

    @property
    def sizes(self) -> tuple[int, int, int]:
        """Return the numbers of masks, layers and extremes."""
        return len(self.masks), int(self.layer.max()) + 1, len(self.layer)


class Quadratic(NamedTuple):
    """Hold one frame's data term ``energy - 2 linear'u + u' gram u``.

    Attributes
    ----------
    energy : float, the frame's squared length
    linear : (R * K,) float array
    gram : (R * K, R * K) float array
    span : float, the least data term of any u at all
    """

    energy: float
    linear: np.ndarray
    gram: np.ndarray
    span: float


def _check(basis, layer, masks, gaps, lip_mask, speech_layer, closed):
    """Refuse arrays that do not fit together."""
    if basis.ndim != 2 or layer.shape != basis.shape[1:] or masks.shape[1:] != basis.shape[:1]:
        raise ValueError(
            f"expected basis (D, K), layer (K,) and masks (R, D), got {basis.shape}, {layer.shape}"
            f" and {masks.shape}"
        )
    if not (np.isfinite(basis).all() and np.isfinite(masks).all()):
        raise ValueError(f"basis {basis.shape} and masks {masks.shape} must be finite")
    if not len(layer) or not np.array_equal(np.unique(layer), np.arange(layer.max() + 1)):
        raise ValueError(f"layers must be numbered from 0 with none left out, got {layer}")
    if (masks < 0.0).any() or np.abs(masks.sum(axis=0) - 1.0).max(initial=0.0) > 1e-6:
        raise ValueError(f"masks {masks.shape} must be at least zero and sum to one everywhere")
    bias = (lip_mask, speech_layer, closed)
    if bias != (-1, -1, -1) and not (
        0 <= lip_mask < len(masks) and 0 <= closed < len(layer) and layer[closed] == speech_layer
    ):
        raise ValueError(
            f"lip_mask, speech_layer and closed {bias} must be all -1, or one of {len(masks)} masks"
            f" and an extreme of that layer"
        )
    if gaps.shape != layer.shape or not ((gaps >= 0.0) & (gaps < np.inf)).all():
        raise ValueError(f"gaps {gaps.shape} must be those of {len(layer)} extremes, at least zero")
    if gaps.any() and lip_mask < 0:
        raise ValueError(f"gaps up to {gaps.max()} need a lip mask")


def _gram(basis, masks, pairs, share=1.0):
    """Return ``(M_l B)' share (M_m B)`` over coordinates, zero where masks do not overlap."""
    count = basis.shape[1]
    gram = np.zeros((len(masks) * count, len(masks) * count))
    for a, b in pairs:
        product = masks[a] * masks[b] * share
        both = np.flatnonzero(product)
        block = (basis[both] * product[both, None]).T @ basis[both]
        gram[a * count : (a + 1) * count, b * count : (b + 1) * count] = 0.5 * (block + block.T)
    return gram


def _lip_bias(layer, regions, lip_mask, speech_layer, closed):
    """Return which entries of the solver's point closed lips pull, and where to."""
    layers = int(layer.max()) + 1
    if lip_mask < 0:
        return np.zeros(0, np.int64), np.zeros(0)
    spoken = np.flatnonzero(layer == speech_layer)
    places = np.append(lip_mask * layers + np.arange(layers), regions * layers + spoken)
    return places, np.append(np.arange(layers) == speech_layer, spoken == closed).astype(float)


def build(
    basis: np.ndarray,
    layer: np.ndarray,
    masks: np.ndarray,
    lip_mask: int = -1,
    speech_layer: int = -1,
    closed: int = -1,
    gaps: np.ndarray | None = None,
) -> Model:
    """Precompute everything that does not depend on a frame (Kholgade 2011, eq. 4).

    Parameters
    ----------
    basis : (D, K) float array, extremes less the neutral [balanced]
    layer : (K,) int array, the layer of each extreme, numbered from 0
    masks : (R, D) float array, at least zero, one at every coordinate in sum
    lip_mask, speech_layer, closed : int
        the mask and layer of the lip bias and the index of its extreme /m/; all -1 for none
    gaps : (K,) float array, how far the lips of each extreme stand apart, zero where closed; None
        = not known

    Raises
    ------
    ValueError
        if the arrays do not fit together, a layer has no extreme, or masks do not sum to one
    """
    basis, masks = np.array(basis, float), np.array(masks, float)
    layer = np.array(layer, np.int64)
    gaps = np.zeros(len(layer)) if gaps is None else np.array(gaps, float)
    _check(basis, layer, masks, gaps, lip_mask, speech_layer, closed)
    regions, layers, count = len(masks), int(layer.max()) + 1, len(layer)
    pairs = np.ascontiguousarray(np.argwhere((masks @ masks.T) > 0.0), np.int64)
    gram = _gram(basis, masks, pairs)
    diagonal = np.diag(gram)
    if not diagonal.any():
        raise ValueError(f"basis {basis.shape}: no extreme differs from the neutral")
    lip_share = masks[lip_mask] if lip_mask >= 0 else np.zeros(len(basis))
    scale = float(diagonal[diagonal > 0.0].mean())
    mask_group = np.repeat(np.arange(regions), count)
    return Model(
        basis,
        layer,
        masks,
        *_lip_bias(layer, regions, lip_mask, speech_layer, closed),
        lip_share,
        _gram(basis, masks, pairs, lip_share),
        pairs,
        gram,
        scale,
        np.linalg.inv(gram + RIDGE * scale * np.eye(len(gram))),
        mask_group * layers + np.tile(layer, regions),
        regions * layers + np.tile(np.arange(count), regions),
        np.concatenate([np.repeat(np.arange(regions), layers), regions + layer]),
        mask_group,
        _shares(diagonal.reshape(regions, count), layer),
        _gap_row(gaps, regions, lip_mask),
    )


def _gap_row(gaps, regions, lip_mask):
    """Return the gap of the lips by displacements, in units of its root mean square."""
    found = np.zeros((regions, len(gaps)))
    if gaps.any():
        found[lip_mask] = gaps / np.sqrt(np.mean(gaps**2))
    return found.ravel()


def _shares(squares, layer):
    """Return the share of each layer in what moves under each mask; even where nothing does."""
    layers = int(layer.max()) + 1
    means = np.stack([squares[:, layer == j].mean(axis=1) for j in range(layers)], axis=1)
    total = means.sum(axis=1, keepdims=True)
    return np.where(total > 0.0, means / np.where(total > 0.0, total, 1.0), 1.0 / layers).ravel()


def project(model: Model, frame: np.ndarray) -> Quadratic | None:
    """Return a frame's data term over its observed coordinates; None if less than half are.

    Parameters
    ----------
    model : see `Model`
    frame : (D,) float array, less the neutral [balanced]; NaN = not observed

    Raises
    ------
    ValueError
        if the frame is of another size or not finite where it is observed
    """
    frame = np.asarray(frame, float)
    if frame.shape != model.basis.shape[:1] or np.isinf(frame).any():
        raise ValueError(
            f"expected a finite frame {model.basis.shape[:1]}, got {frame.shape}"
            f" with {np.isinf(frame).sum()} infinite values"
        )
    missing = np.isnan(frame)
    if 2 * np.count_nonzero(missing) > len(frame):
        return None
    known = np.where(missing, 0.0, frame)
    linear = ((model.masks * known) @ model.basis).ravel()
    energy = float(known @ known)
    if not missing.any():
        gram = model.gram
        spanned = model.span @ linear
    else:
        gram = model.gram - _gram(model.basis[missing], model.masks[:, missing], model.pairs)
        spanned = np.linalg.solve(gram + RIDGE * model.scale * np.eye(len(gram)), linear)
    span = data(Quadratic(energy, linear, gram, 0.0), spanned)
    return Quadratic(energy, linear, gram, max(span, 0.0))


def under_lips(model: Model, frame: np.ndarray) -> Quadratic:
    """Return the part of a frame's data term that lies under the lips' mask, its span left out.

    Parameters
    ----------
    model : see `Model`
    frame : (D,) float array, as `project` takes it
    """
    missing = np.isnan(frame)
    known = np.where(missing, 0.0, frame) * model.lip_share
    gram = model.lip_gram
    if missing.any():
        share = model.lip_share[missing]
        gram = gram - _gram(model.basis[missing], model.masks[:, missing], model.pairs, share)
    energy = float(known @ np.where(missing, 0.0, frame))
    return Quadratic(energy, ((model.masks * known) @ model.basis).ravel(), gram, 0.0)


def data(quadratic: Quadratic, displacements: np.ndarray) -> float:
    """Return the data term of displacements u (R * K,)."""
    curved = quadratic.gram @ displacements - 2.0 * quadratic.linear
    return float(quadratic.energy + displacements @ curved)


def outside(model: Model, quadratic: Quadratic, point: np.ndarray) -> float:
    """Return how far the frame lies outside the simplices, given the solver's point (R * J + K,).

    The root of its squared distance from what the point composes to, less that from the span.
    """
    u = point[model.first] * point[model.second]
    return float(np.sqrt(max(data(quadratic, u) - quadratic.span, 0.0)))
