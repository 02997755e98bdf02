# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact arithmetic below the proofs, against solutions that are known."""

from fractions import Fraction

import numpy as np

from cordon import rational, simplex


def exact(values):
    return [Fraction(int(v), 3) for v in values]


def times(A, x):
    return rational.product(A, x)


def test_solutions_of_few_and_of_all_variables():
    rng = np.random.default_rng(0)
    for _ in range(200):
        m, n = int(rng.integers(1, 5)), int(rng.integers(1, 7))
        A = [exact(row) for row in rng.integers(-3, 4, (m, n))]
        x = exact(rng.integers(-3, 4, n))
        r = times(A, x)
        weights = rng.random(n) + 0.1
        few = rational.correction(A, r, list(weights))
        assert few is not None and times(A, few) == r
        assert sum(v != 0 for v in few) <= m
        spread = rational.spread(A, r, [Fraction(float(w)) for w in weights])
        assert spread is not None and times(A, spread) == r
    assert rational.correction([[Fraction(1)], [Fraction(2)]], exact([3, 3]), [1.0]) is None
    assert rational.spread([[Fraction(0)]], exact([3]), [Fraction(1)]) is None
    # what has no weight stays 0, and most weight comes first
    assert rational.correction([exact([3, 3])], exact([3]), [0.0, 1.0]) == exact([0, 3])
    assert rational.correction([exact([3, 3])], exact([3]), [2.0, 0.5]) == exact([3, 0])


def test_the_simplex_method_finds_what_there_is():
    rng = np.random.default_rng(1)
    found, none = 0, 0
    for seed in range(400):
        m, n = int(rng.integers(1, 5)), int(rng.integers(1, 7))
        lower = [None if v == 3 else -Fraction(int(v)) for v in rng.integers(0, 4, n)]
        upper = [None if v == 3 else Fraction(int(v)) for v in rng.integers(0, 4, n)]
        A = [exact(row) for row in rng.integers(-3, 4, (m, n))]
        if seed % 2:  # a corner, or near one
            x = [(low if v else high) or Fraction(0)
                 for low, high, v in zip(lower, upper, rng.random(n) < 0.5)]
            r = times(A, x)
        else:
            r = exact(rng.integers(-9, 10, m))
        solution = simplex.solution_within(A, r, lower, upper)
        if solution is not None:
            found += 1
            assert times(A, solution) == r
            assert all((low is None or low <= v) and (high is None or v <= high)
                       for low, v, high in zip(lower, solution, upper))
        else:
            none += 1
            assert seed % 2 == 0 and not has_corner(A, r, lower, upper)
    assert found > 200 and none > 50


def has_corner(A, r, lower, upper):
    """By the library, of which this is the constrained zonotope {Gx : A x = r}."""
    import cordon as co
    free = [Fraction(50) if v is None else v for v in upper], \
        [Fraction(-50) if v is None else v for v in lower]
    middle = [(a + b) / 2 for a, b in zip(*free)]
    radius = [(a - b) / 2 for a, b in zip(*free)]
    rows = 3 * np.array([[float(v * s) for v, s in zip(row, radius)] for row in A])
    left = 3 * np.array([float(a - b) for a, b in zip(r, times(A, middle))])
    X = co.constrained_zonotope([0], np.ones((1, len(radius))), rows, left)
    return not X.is_empty().yes


def test_large_programs_are_not_begun():
    A = [[Fraction(1)] * 60 for _ in range(60)]
    assert simplex.solution_within(A, [Fraction(1)] * 60, [None] * 60, [None] * 60) is None


def test_doubles_are_the_numbers_that_they_are():
    assert rational.vector(np.array([0.1, -2.0])) == [Fraction(0.1), Fraction(-2)]
    assert rational.matrix(np.array([[1, 2], [3, 4]])) == [[1, 2], [3, 4]]
    assert rational.transposed([[1, 2, 3]], 3) == [[1], [2], [3]]
    assert rational.transposed([], 2) == [[], []]
