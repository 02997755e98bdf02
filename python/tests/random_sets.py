# SPDX-License-Identifier: GPL-3.0-or-later
"""Sets of all representations at random: bounded or not, empty, flat, badly scaled."""

import numpy as np

import cordon as co
from cordon import _cordon

INSTALLED = _cordon.components("backend")
SHAPES = ("box", "zonotope", "constrained_zonotope", "line_zonotope", "strip", "plain",
          "ellipsoid", "outward", "polytope", "operations")


def numbers(rng, *shape):
    """Small integers or any numbers, now and then with zeros."""
    whole = rng.random() < 0.3
    made = rng.integers(-3, 4, shape).astype(float) if whole else rng.normal(size=shape)
    return made * (rng.random(shape) < 0.85)


def scales(rng, n):
    """Units of the coordinates: all 1, or far apart."""
    return np.ones(n) if rng.random() < 0.7 else 10.0 ** rng.integers(-6, 7, n)


def box(rng, n):
    c, r = numbers(rng, n), np.abs(numbers(rng, n))
    lower, upper = c - r, c + r
    free = rng.random(n) < 0.15
    lower[free], upper[free] = -np.inf, np.inf
    return co.interval(lower, upper)


def zonotope(rng, n):
    s = scales(rng, n)
    c = s * numbers(rng, n)
    return co.zonotope(c, s[:, None] * numbers(rng, n, int(rng.integers(0, n + 4))))


def constraints(rng, m, g, columns):
    """Rows with a solution, or (now and then) with none."""
    A = numbers(rng, m, columns)
    inside = rng.uniform(-1, 1, columns) * (0.9 if rng.random() < 0.8 else 1.0)
    b = A @ inside
    if m and rng.random() < 0.25:
        b[0] = 1.5 * np.abs(A[0, columns - g:]).sum() + rng.random()
    return A, b


def constrained_zonotope(rng, n):
    g = int(rng.integers(1, n + 5))
    A, b = constraints(rng, int(rng.integers(0, 3)), g, g)
    s = scales(rng, n)
    return co.constrained_zonotope(s * numbers(rng, n), s[:, None] * numbers(rng, n, g), A, b)


def line_zonotope(rng, n):
    g, lines = int(rng.integers(0, n + 3)), int(rng.integers(0, 3))
    A, b = constraints(rng, int(rng.integers(0, 3)), g, lines + g)
    s = scales(rng, n)
    return co.line_zonotope(s * numbers(rng, n), s[:, None] * numbers(rng, n, lines),
                            s[:, None] * numbers(rng, n, g), A[:, :lines], A[:, lines:], b)


def strip(rng, n):
    return co.strip(numbers(rng, n), float(rng.normal()), float(abs(rng.normal())))


def plain(rng, n):
    name = INSTALLED[int(rng.integers(len(INSTALLED)))]
    made = [lambda: co.empty(n, name), lambda: co.point(numbers(rng, n), name),
            lambda: co.space(n, "line_zonotope"), lambda: co.space(n, "interval")]
    return made[int(rng.integers(len(made)))]() if n <= 4 else co.point(numbers(rng, n))


def ellipsoid(rng, n):
    X = zonotope(rng, n).as_("ellipsoid", criterion=("trace", "volume")[int(rng.integers(2))])
    return X if rng.random() < 0.3 else numbers(rng, n, n) @ X + zonotope(rng, n)


def outward(rng, n):
    X = (box, zonotope, constrained_zonotope)[int(rng.integers(3))](rng, n)
    name = X.representation
    return numbers(rng, n, n) @ X.as_(name, rounding="outward")


def polytope(rng, n):
    n = min(n, 3)
    H = np.vstack([numbers(rng, int(rng.integers(0, 4)), n), np.eye(n), -np.eye(n)])
    h = np.abs(numbers(rng, len(H))) + (0.5 if rng.random() < 0.8 else -0.5)
    names = [name for name in ("polytope", "constrained_zonotope", "line_zonotope")
             if name in INSTALLED]
    return co.polytope(H, h, names[int(rng.integers(len(names)))])


def operations(rng, n):
    X, Y = constrained_zonotope(rng, n), zonotope(rng, n)
    made = [lambda: X & Y, lambda: numbers(rng, n, n) @ X + Y, lambda: X.convex_hull(Y),
            lambda: X.reduce(n + 2, 1), lambda: Y & X, lambda: X.as_("line_zonotope") & X]
    return made[int(rng.integers(len(made)))]()


def of(seed):
    """A set, and the numbers that it was made of go on."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 7))
    return globals()[SHAPES[seed % len(SHAPES)]](rng, n), rng
