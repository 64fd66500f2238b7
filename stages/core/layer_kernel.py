"""Minimise over products of simplices, compiled: quadratics, and the quadratic of a product.

A point z holds the mask weights (R * J) and then the coefficients (K). Displacement i = l * K + k
is ``u_i = z[first[i]] * z[second[i]]``, a mask's weight of a layer times a coefficient, and

    f(z) = energy - 2 linear'u + u' gram u + sum_i pull_i (z_i - target_i)^2.

Numba's cache looks at a function's own file only, so no kernel calls one of another file.
"""

import numba
import numpy as np

ROUNDS = 200


@numba.njit(cache=True)
def _references(point, group, reference):
    """Find the largest entry of each simplex: the one that gives what the others take."""
    for i in range(len(reference)):
        reference[i] = -1
    for i in range(len(point)):
        best = reference[group[i]]
        if best < 0 or point[i] > point[best]:
            reference[group[i]] = i


@numba.njit(cache=True)
def _solve_definite(matrix, size, vector):
    """Solve by Cholesky's factors, in place; say if the matrix was positive definite."""
    for j in range(size):
        for k in range(j):
            factor = matrix[j, k]
            if factor != 0.0:
                for i in range(j, size):
                    matrix[i, j] -= matrix[i, k] * factor
        if not matrix[j, j] > 0.0:
            return False
        root = np.sqrt(matrix[j, j])
        for i in range(j, size):
            matrix[i, j] /= root
    for i in range(size):
        for k in range(i):
            vector[i] -= matrix[i, k] * vector[k]
        vector[i] /= matrix[i, i]
    for i in range(size - 1, -1, -1):
        for k in range(i + 1, size):
            vector[i] -= matrix[k, i] * vector[k]
        vector[i] /= matrix[i, i]
    return True


@numba.njit(cache=True)
def _newton_step(hessian, gradient, group, reference, free, ridge, step):
    """Minimise the quadratic over the free entries, sums kept; say if it was convex there."""
    members = np.empty(len(free), np.int64)
    size = 0
    for i in range(len(free)):
        step[i] = 0.0
        if free[i] and i != reference[group[i]]:
            members[size] = i
            size += 1
    reduced, vector = np.empty((size, size)), np.empty(size)
    for p in range(size):
        i, base = members[p], reference[group[members[p]]]
        vector[p] = gradient[base] - gradient[i]
        for q in range(p + 1):
            j, other = members[q], reference[group[members[q]]]
            reduced[p, q] = hessian[i, j] - hessian[i, other]
            reduced[p, q] += hessian[base, other] - hessian[base, j]
        reduced[p, p] += ridge
    if not _solve_definite(reduced, size, vector):
        return False
    for p in range(size):
        step[members[p]] = vector[p]
        step[reference[group[members[p]]]] -= vector[p]
    return True


@numba.njit(cache=True)
def _advance(hessian, gradient, point, free, step):
    """Go along a step until an entry is zero, which is then no longer free; return the length."""
    length, blocker = 1.0, -1
    for i in range(len(point)):
        if point[i] + length * step[i] < 0.0:
            length, blocker = -point[i] / step[i], i
    for i in range(len(point)):
        if step[i] != 0.0:
            change = length * step[i]
            point[i] = max(point[i] + change, 0.0)
            for j in range(len(point)):
                gradient[j] += hessian[i, j] * change
    if blocker >= 0:
        point[blocker] = 0.0
        free[blocker] = False
    return length, blocker


@numba.njit(cache=True)
def _release(gradient, group, reference, free, tolerance, single):
    """Free the entry of each simplex, or of all, that promises most; say if there was any."""
    best, gain = np.empty(len(reference), np.int64), np.empty(len(reference))
    for j in range(len(reference)):
        best[j], gain[j] = -1, tolerance
    for i in range(len(free)):
        promise = gradient[reference[group[i]]] - gradient[i]
        j = 0 if single else group[i]
        if not free[i] and promise > gain[j]:
            gain[j], best[j] = promise, i
    for j in range(len(reference)):
        if best[j] >= 0:
            free[best[j]] = True
    return best.max() >= 0


@numba.njit(cache=True)
def minimise_quadratic(hessian, gradient, group, point, tolerance, ridge):
    """Minimise ``gradient'd + d' hessian d / 2`` over simplices, point + d; both in place.

    Primal active set from the zeros of the point; say if the quadratic was convex on the way.
    """
    free, step = np.empty(len(point), np.bool_), np.empty(len(point))
    simplices, single = 0, False
    for i in range(len(point)):
        free[i] = point[i] > 0.0
        simplices = max(simplices, group[i] + 1)
    reference = np.empty(simplices, np.int64)
    for _ in range(ROUNDS):
        _references(point, group, reference)
        if not _newton_step(hessian, gradient, group, reference, free, ridge, step):
            return False
        length, blocker = _advance(hessian, gradient, point, free, step)
        single = single or length == 0.0
        if blocker >= 0:
            continue
        _references(point, group, reference)
        if not _release(gradient, group, reference, free, tolerance, single):
            return True
    return True


@numba.njit(cache=True)
def _times(gram, pairs, vector, count):
    """Multiply by the Gram matrix, which is zero outside the pairs of masks that overlap."""
    product = np.zeros(len(vector))
    for p in range(len(pairs)):
        start, other = pairs[p, 0] * count, pairs[p, 1] * count
        for j in range(other, other + count):
            if vector[j] != 0.0:
                for i in range(start, start + count):
                    product[i] += gram[j, i] * vector[j]
    return product


@numba.njit(cache=True)
def _gauss_newton(gram, pairs, first, point, count):
    """Return twice ``J' gram J``, where J is the derivative of u by the point."""
    weights = len(point) - count
    layers = weights * count // len(first)
    hessian, values, wide = np.zeros((len(point), len(point))), point[weights:], np.empty(count)
    for p in range(len(pairs)):
        start, other = pairs[p, 0] * count, pairs[p, 1] * count
        rows = np.zeros((weights, count))
        for j in range(count):
            wide[j] = 2.0 * point[first[other + j]]
        for k in range(count):
            block, weight = gram[start + k, other : other + count], first[start + k]
            target, row = hessian[weights + k, weights:], rows[weight]
            scale, value = point[weight], 2.0 * values[k]
            if scale != 0.0:
                for j in range(count):
                    target[j] += scale * wide[j] * block[j]
            if value != 0.0:
                for j in range(count):
                    row[j] += value * block[j]
        for weight in range(pairs[p, 0] * layers, (pairs[p, 0] + 1) * layers):
            target, row = hessian[weight, weights:], rows[weight]
            for j in range(count):
                hessian[weight, first[other + j]] += row[j] * values[j]
                target[j] += 0.5 * row[j] * wide[j]
    for weight in range(weights):
        for j in range(weights, len(point)):
            hessian[j, weight] = hessian[weight, j]
    return hessian


@numba.njit(cache=True)
def _second_order(hessian, pull, slope, first, second):
    """Add the pulls to a Gauss-Newton matrix, and return the Hessian with all its terms."""
    for i in range(len(pull)):
        hessian[i, i] += 2.0 * pull[i]
    full = hessian.copy()
    for i in range(len(first)):
        full[first[i], second[i]] += slope[i]
        full[second[i], first[i]] += slope[i]
    return full


@numba.njit(cache=True)
def _slopes(gram, pairs, linear, pull, target, first, second, point, slope, gradient):
    """Fill in the gradients by displacements and by the point; return f less the energy."""
    moved = np.empty(len(first))
    for i in range(len(first)):
        moved[i] = point[first[i]] * point[second[i]]
    product = _times(gram, pairs, moved, len(point) - second[0])
    value = 0.0
    for i in range(len(point)):
        away = point[i] - target[i]
        gradient[i] = 2.0 * pull[i] * away
        value += pull[i] * away * away
    for i in range(len(first)):
        value += (product[i] - 2.0 * linear[i]) * moved[i]
        slope[i] = 2.0 * (product[i] - linear[i])
        gradient[first[i]] += slope[i] * point[second[i]]
        gradient[second[i]] += slope[i] * point[first[i]]
    return value


@numba.njit(cache=True)
def _lowest(c):
    """Return where in 0..1 the quartic with coefficients c (5,) is lowest.

    Its slope is monotone between the roots of its curvature; there, bisection finds where it rises.
    """
    near, far = 1.0, 1.0
    root = 9.0 * c[3] * c[3] - 24.0 * c[4] * c[2]
    if root > 0.0:
        half = -3.0 * c[3] - (np.sqrt(root) if c[3] >= 0.0 else -np.sqrt(root))
        near = half / (12.0 * c[4]) if c[4] != 0.0 else 1.0
        far = 2.0 * c[2] / half if half != 0.0 else 1.0
    near, far = max(0.0, min(near, 1.0)), max(0.0, min(far, 1.0))
    best, value = 1.0, c[1] + c[2] + c[3] + c[4]
    ends = (0.0, min(near, far), max(near, far), 1.0)
    for s in range(3):
        low, high = ends[s], ends[s + 1]
        for _ in range(60):
            t = 0.5 * (low + high)
            if c[1] + t * (2.0 * c[2] + t * (3.0 * c[3] + t * 4.0 * c[4])) < 0.0:
                low = t
            else:
                high = t
        height = high * (c[1] + high * (c[2] + high * (c[3] + high * c[4])))
        if height < value:
            best, value = high, height
    return best


@numba.njit(cache=True)
def _quartic(gram, pairs, slope, pull, target, first, second, point, step):
    """Return the coefficients of the objective along a step."""
    once, twice = np.empty(len(first)), np.empty(len(first))
    for i in range(len(first)):
        by_weight, by_coefficient = step[first[i]], step[second[i]]
        once[i] = point[first[i]] * by_coefficient + by_weight * point[second[i]]
        twice[i] = by_weight * by_coefficient
    count = len(point) - second[0]
    product, square = _times(gram, pairs, once, count), _times(gram, pairs, twice, count)
    c = np.zeros(5)
    for i in range(len(once)):
        c[1] += slope[i] * once[i]
        c[2] += once[i] * product[i] + slope[i] * twice[i]
        c[3] += 2.0 * once[i] * square[i]
        c[4] += twice[i] * square[i]
    for i in range(len(point)):
        c[1] += 2.0 * pull[i] * (point[i] - target[i]) * step[i]
        c[2] += pull[i] * step[i] * step[i]
    return c


@numba.njit(cache=True)
def descend(gram, pairs, linear, pull, target, first, second, group, point, tolerance, ridge):
    """Minimise f from a point, in place, by feasible SQP; return f less the energy.

    Each round minimises the second-order model over the simplices (Gauss-Newton where the full one
    is not convex) and goes to the lowest place on the way there.
    """
    size, count = len(point), len(point) - second[0]
    slope, gradient, step = np.empty(len(first)), np.empty(size), np.empty(size)
    for _ in range(ROUNDS):
        value = _slopes(gram, pairs, linear, pull, target, first, second, point, slope, gradient)
        hessian = _gauss_newton(gram, pairs, first, point, count)
        full = _second_order(hessian, pull, slope, first, second)
        trial = point.copy()
        if not minimise_quadratic(full, gradient.copy(), group, trial, tolerance, ridge):
            trial = point.copy()
            minimise_quadratic(hessian, gradient.copy(), group, trial, tolerance, ridge)
        promise = 0.0
        for i in range(size):
            step[i] = trial[i] - point[i]
            promise -= gradient[i] * step[i]
        if promise < tolerance:
            break
        c = _quartic(gram, pairs, slope, pull, target, first, second, point, step)
        length = _lowest(c)
        for i in range(size):
            point[i] = trial[i] if length == 1.0 else point[i] + length * step[i]
    return value
