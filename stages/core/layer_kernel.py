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
    reference[:] = -1
    for i in range(len(point)):
        best = reference[group[i]]
        if best < 0 or point[i] > point[best]:
            reference[group[i]] = i


@numba.njit(cache=True)
def _factorise(matrix, size):
    """Replace the lower triangle by its Cholesky factor; say if it was positive definite."""
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
    return True


@numba.njit(cache=True)
def _substitute(matrix, size, vector):
    """Solve with a Cholesky factor, in place."""
    for i in range(size):
        total = vector[i]
        for k in range(i):
            total -= matrix[i, k] * vector[k]
        vector[i] = total / matrix[i, i]
    for i in range(size - 1, -1, -1):
        total = vector[i]
        for k in range(i + 1, size):
            total -= matrix[k, i] * vector[k]
        vector[i] = total / matrix[i, i]


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
        i = members[p]
        base = reference[group[i]]
        vector[p] = gradient[base] - gradient[i]
        for q in range(p + 1):
            j = members[q]
            other = reference[group[j]]
            reduced[p, q] = (
                hessian[i, j] - hessian[i, other] - hessian[base, j] + hessian[base, other]
            )
        reduced[p, p] += ridge
    if not _factorise(reduced, size):
        return False
    _substitute(reduced, size, vector)
    for p in range(size):
        step[members[p]] = vector[p]
        step[reference[group[members[p]]]] -= vector[p]
    return True


@numba.njit(cache=True)
def _advance(hessian, gradient, point, free, step):
    """Go along a step until an entry is zero, which is then no longer free; return the length."""
    length, blocker = 1.0, -1
    for i in range(len(point)):
        if step[i] < 0.0 and point[i] + length * step[i] < 0.0:
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
    """Free the entry of each simplex (or of all) that promises most; return how many."""
    best = np.full(len(reference), -1)
    gain = np.full(len(reference), tolerance)
    for i in range(len(free)):
        j = group[i]
        promise = gradient[reference[j]] - gradient[i]
        if not free[i] and promise > gain[j]:
            gain[j], best[j] = promise, i
    count, top = 0, np.argmax(gain)
    for j in range(len(reference)):
        if best[j] >= 0 and (j == top or not single):
            free[best[j]] = True
            count += 1
    return count


@numba.njit(cache=True)
def minimise_quadratic(hessian, gradient, group, point, tolerance, ridge):
    """Minimise ``gradient'd + d' hessian d / 2`` over simplices, point + d; both in place.

    Primal active set from the zeros of the point; say if the quadratic was convex on the way.
    """
    free = point > 0.0
    step = np.empty(len(point))
    reference = np.empty(group.max() + 1, np.int64)
    single = False
    for _ in range(ROUNDS):
        _references(point, group, reference)
        if not _newton_step(hessian, gradient, group, reference, free, ridge, step):
            return False
        length, blocker = _advance(hessian, gradient, point, free, step)
        single = single or length == 0.0
        if blocker >= 0:
            continue
        _references(point, group, reference)
        if _release(gradient, group, reference, free, tolerance, single) == 0:
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
def _gauss_newton(gram, pairs, first, point, count, hessian):
    """Fill in twice ``J' gram J``, where J is the derivative of u by the point."""
    hessian[:] = 0.0
    weights = len(point) - count
    layers = weights * count // len(first)
    values, wide, rows = point[weights:], np.empty(count), np.empty((weights, count))
    for p in range(len(pairs)):
        start, other = pairs[p, 0] * count, pairs[p, 1] * count
        rows[:] = 0.0
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


@numba.njit(cache=True)
def _gradient(slope, pull, target, first, second, point):
    """Return the gradient by the point, given that by the displacements."""
    gradient = 2.0 * pull * (point - target)
    for i in range(len(first)):
        gradient[first[i]] += slope[i] * point[second[i]]
        gradient[second[i]] += slope[i] * point[first[i]]
    return gradient


@numba.njit(cache=True)
def _cubic_root(c, low, high):
    """Return the root of an ascending ``c1 + 2 c2 t + 3 c3 t^2 + 4 c4 t^3`` by bisection."""
    for _ in range(60):
        middle = 0.5 * (low + high)
        if c[1] + middle * (2.0 * c[2] + middle * (3.0 * c[3] + middle * 4.0 * c[4])) < 0.0:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


@numba.njit(cache=True)
def _lowest(c):
    """Return where in 0..1 the quartic with coefficients c (5,) is lowest."""
    ends = np.array([0.0, 1.0, 1.0, 1.0])
    root = 9.0 * c[3] * c[3] - 24.0 * c[4] * c[2]
    if root > 0.0:
        half = -3.0 * c[3] - np.copysign(np.sqrt(root), c[3])
        near = half / (12.0 * c[4]) if c[4] != 0.0 else 1.0
        far = 2.0 * c[2] / half if half != 0.0 else 1.0
        ends[1], ends[2] = max(0.0, min(near, far, 1.0)), max(0.0, min(max(near, far), 1.0))
    best, value = 1.0, c[1] + c[2] + c[3] + c[4]
    for s in range(3):
        root = _cubic_root(c, ends[s], ends[s + 1])
        height = root * (c[1] + root * (c[2] + root * (c[3] + root * c[4])))
        if height < value:
            best, value = root, height
    return best


@numba.njit(cache=True)
def _quartic(gram, pairs, slope, pull, target, first, second, point, step, count):
    """Return the coefficients of the objective along a step."""
    once = point[first] * step[second] + step[first] * point[second]
    twice = step[first] * step[second]
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
    count = len(point) - second[0]
    hessian, full = np.empty((len(point), len(point))), np.empty((len(point), len(point)))
    for _ in range(ROUNDS):
        shape = point[first] * point[second]
        product = _times(gram, pairs, shape, count)
        value = np.sum((product - 2.0 * linear) * shape) + np.sum(pull * (point - target) ** 2)
        slope = 2.0 * (product - linear)
        gradient = _gradient(slope, pull, target, first, second, point)
        _gauss_newton(gram, pairs, first, point, count, hessian)
        for i in range(len(point)):
            hessian[i, i] += 2.0 * pull[i]
        full[:] = hessian
        for i in range(len(first)):
            full[first[i], second[i]] += slope[i]
            full[second[i], first[i]] += slope[i]
        trial = point.copy()
        if not minimise_quadratic(full, gradient.copy(), group, trial, tolerance, ridge):
            trial = point.copy()
            minimise_quadratic(hessian, gradient.copy(), group, trial, tolerance, ridge)
        step = trial - point
        if np.sum(gradient * step) > -tolerance:
            break
        c = _quartic(gram, pairs, slope, pull, target, first, second, point, step, count)
        length = _lowest(c)
        point[:] = trial if length == 1.0 else point + length * step
    return value
