# SPDX-License-Identifier: GPL-3.0-or-later
"""Constructors, operations, questions and measures against numbers computed by hand."""

import math

import numpy as np
import pytest

import cordon as co

EPS = 1e-12
Z = co.zonotope([1, 2], [[1, 0.5], [0, 1]])
BOX = co.interval([-1, -2], [2, 3])
HALF = co.interval([-1, -np.inf], [2, np.inf])
SEGMENT = co.constrained_zonotope([0, 0], np.eye(2), [[1, 1]], [1])  # from (0, 1) to (1, 0)
BAND = co.line_zonotope([0, 0], [[1], [1]], [[0], [1]])  # |y - x| ≤ 1
STRIP = co.strip([1, 1], 2, 0.5)  # |x + y - 2| ≤ 0.5
POINT = co.point([3, 4])
SPACE = co.space(2)
EMPTY = co.empty(2)
H, h = np.array([[1, 0], [0, 1], [-1, -1]]), np.array([1, 1, 1])
TRIANGLE = co.polytope(H, h, "constrained_zonotope")  # (1, 1), (1, -2), (-2, 1)
GIVEN = co.zonotope([0, 0], np.eye(2)).as_("ellipsoid")  # as it was given
BALL = GIVEN.reduce(1)  # the ball of radius √2
ALL = {"Z": Z, "BOX": BOX, "HALF": HALF, "SEGMENT": SEGMENT, "BAND": BAND, "STRIP": STRIP,
       "POINT": POINT, "SPACE": SPACE, "EMPTY": EMPTY, "TRIANGLE": TRIANGLE, "GIVEN": GIVEN,
       "BALL": BALL}
BOUNDED = [name for name in ALL if name not in ("HALF", "BAND", "STRIP", "SPACE", "EMPTY")]

HULLS = {
    "Z": ([-0.5, 1], [2.5, 3]), "BOX": ([-1, -2], [2, 3]),
    "HALF": ([-1, -math.inf], [2, math.inf]), "SEGMENT": ([0, 0], [1, 1]),
    "BAND": ([-math.inf] * 2, [math.inf] * 2), "STRIP": ([-math.inf] * 2, [math.inf] * 2),
    "POINT": ([3, 4], [3, 4]), "SPACE": ([-math.inf] * 2, [math.inf] * 2),
    "TRIANGLE": ([-2, -2], [1, 1]), "GIVEN": ([-1, -1], [1, 1]),
    "BALL": ([-math.sqrt(2)] * 2, [math.sqrt(2)] * 2),
}
#: Points of the sets, and points outside of them.
POINTS = {
    "Z": ([[1, 2], [2.4, 2.9], [-0.4, 1.1]], [[2.6, 2], [2.4, 1.1], [-0.4, 2.9]]),
    "BOX": ([[2, 3], [-1, -2], [0, 0]], [[2.1, 0], [0, -2.1]]),
    "HALF": ([[2, 1e9], [-1, -1e9]], [[2.1, 0], [-1.1, 5]]),
    "SEGMENT": ([[0.5, 0.5], [0.25, 0.75]], [[0.5, 0.51], [1.1, -0.1], [0, 0]]),
    "BAND": ([[1e6, 1e6], [-5, -4.5]], [[0, 1.1], [3, 1]]),
    "STRIP": ([[1, 1], [-7, 9.4], [2.4, 0]], [[0, 0], [2, 2], [-7, 9.6]]),
    "POINT": ([[3, 4]], [[3, 4.000001], [0, 0]]),
    "SPACE": ([[0, 0], [1e9, -1e9]], []),
    "EMPTY": ([], [[0, 0], [1, 1]]),
    "TRIANGLE": ([[0, 0], [0.9, 0.9], [0.9, -1.8]], [[1.1, 0], [-1, -1], [0, -1.1]]),
    "GIVEN": ([[0.9, 0.9]], [[1.1, 0]]),
    "BALL": ([[0.9, 0.9], [1.3, 0]], [[1.1, 1.1], [1.5, 0]]),
}


@pytest.mark.parametrize("name", HULLS)
def test_hulls(name):
    hull = ALL[name].hull()
    np.testing.assert_allclose(hull.lower, HULLS[name][0], atol=EPS)
    np.testing.assert_allclose(hull.upper, HULLS[name][1], atol=EPS)
    assert (hull.lower <= np.array(HULLS[name][0])).all()  # never less than the set
    assert (hull.upper >= np.array(HULLS[name][1])).all() or name == "BALL"
    np.testing.assert_array_equal(hull.widths, hull.upper - hull.lower)
    assert len(hull.proofs) == 4
    for value, proof in zip((hull.upper[0], -hull.lower[0], hull.upper[1], -hull.lower[1]),
                            hull.proofs):
        if name == "BALL" or math.isinf(value):
            assert proof is None
        else:
            assert proof is not None and proof.check() and proof.statement.bound == value


def test_the_hull_of_nothing():
    for name in ("line_zonotope", "zonotope", "interval", "constrained_zonotope", "ellipsoid"):
        hull = co.empty(2, name).hull()
        assert (hull.lower > hull.upper).all()


@pytest.mark.parametrize("name", POINTS)
def test_points(name):
    X = ALL[name]
    for x in POINTS[name][0]:
        answer = X.contains(x)
        assert answer.yes and not answer.no and not answer.unknown, (x, answer)
        assert not (-X).contains(-np.array(x)).no
        assert not (X + [1, 2]).contains(np.add(x, [1, 2])).no
    for x in POINTS[name][1]:
        answer = X.contains(x)
        assert answer.no and not answer.yes, (x, answer)


def test_what_sets_are():
    sizes = {name: X.sizes for name, X in ALL.items()}
    assert sizes["Z"] == {"generators": 2, "lines": 0, "constraints": 0}
    assert sizes["HALF"] == {"generators": 1, "lines": 1, "constraints": 0}
    assert sizes["SEGMENT"] == {"generators": 2, "lines": 0, "constraints": 1}
    assert sizes["BAND"] == {"generators": 1, "lines": 1, "constraints": 0}
    assert [X.representation for X in ALL.values()] == [
        "zonotope", "interval", "interval", "constrained_zonotope", "line_zonotope",
        "line_zonotope", "zonotope", "line_zonotope", "line_zonotope", "constrained_zonotope",
        "ellipsoid", "ellipsoid"]
    assert all(X.dim == 2 for X in ALL.values())
    assert [name for name, X in ALL.items() if X.claim == "outer"] == ["BALL"]
    assert str(Z) == "zonotope in R^2: 2 generators (exact)"
    assert repr(Z) == "<zonotope in R^2: 2 generators (exact)>"


def test_emptiness_and_bounds():
    for name, X in ALL.items():
        assert X.is_empty() == ("yes" if name == "EMPTY" else "no"), name
        unbounded = name in ("HALF", "BAND", "STRIP", "SPACE")
        assert X.is_bounded() == ("no" if unbounded else "yes"), name
    for b, status in ((2.1, "yes"), (1.9, "no"), (-2.1, "yes")):
        X = co.constrained_zonotope([0, 0], np.eye(2), [[1, 1]], [b])
        assert X.is_empty() == status and X.is_empty().certificate.check()


SUPPORTS = [("Z", [1, 0], 2.5), ("Z", [1, 1], 5.5), ("Z", [-1, 2], 5.5), ("BOX", [1, -1], 4),
            ("HALF", [-2, 0], 2), ("HALF", [0, 1], math.inf), ("SEGMENT", [2, 1], 2),
            ("SEGMENT", [1, 1], 1), ("SEGMENT", [-1, -1], -1), ("BAND", [-1, 1], 1),
            ("BAND", [1, 0], math.inf), ("STRIP", [1, 1], 2.5), ("STRIP", [-2, -2], -3),
            ("POINT", [1, -1], -1), ("SPACE", [1, 0], math.inf), ("SPACE", [0, 0], 0),
            ("EMPTY", [1, 0], -math.inf), ("TRIANGLE", [-1, 0], 2), ("TRIANGLE", [1, 1], 2),
            ("GIVEN", [1, 1], 2), ("BALL", [1, 1], 2), ("BALL", [3, 4], 5 * math.sqrt(2))]


@pytest.mark.parametrize("name, d, value", SUPPORTS)
def test_supports(name, d, value):
    found = ALL[name].support(d)
    assert found.value == value if math.isinf(value) else abs(found.value - value) < EPS
    assert found.value >= value or name == "BALL"
    if math.isinf(value):
        assert found.at is None
    else:
        assert abs(np.dot(d, found.at) - value) < 1e-9
        assert not ALL[name].contains(found.at * (1 - 1e-9) + 1e-9 * inner_point(name)).no


def inner_point(name):
    return np.array(POINTS[name][0][0], dtype=float)


VERTICES = {
    "Z": [[-0.5, 1], [1.5, 1], [2.5, 3], [0.5, 3]], "BOX": [[-1, -2], [2, -2], [2, 3], [-1, 3]],
    "SEGMENT": [[0, 1], [1, 0]], "POINT": [[3, 4]], "EMPTY": np.zeros((0, 2)),
    "TRIANGLE": [[1, -2], [1, 1], [-2, 1]], "GIVEN": [[-1, -1], [1, -1], [1, 1], [-1, 1]],
}


@pytest.mark.parametrize("name", VERTICES)
def test_vertices(name):
    found, wanted = ALL[name].vertices(), np.array(VERTICES[name], dtype=float)
    assert found.shape == wanted.shape and found.flags.c_contiguous
    order = np.lexsort(found.T), np.lexsort(wanted.T)
    np.testing.assert_allclose(found[order[0]], wanted[order[1]], atol=EPS)
    if len(found) > 2:  # counter-clockwise
        edges = np.roll(found, -1, 0) - found
        after = np.roll(edges, -1, 0)
        turns = edges[:, 0] * after[:, 1] - edges[:, 1] * after[:, 0]
        assert (turns > 0).all()


def test_vertices_that_there_are_none_of():
    for name in ("HALF", "BAND", "STRIP", "SPACE", "BALL"):
        with pytest.raises(co.Error, match="vertices") as found:
            ALL[name].vertices()
        assert found.value.code == "unsupported"
    cube = co.interval([0, 0, 0], [1, 1, 1]).vertices()
    wanted = [(a, b, c) for a in (0, 1) for b in (0, 1) for c in (0, 1)]
    assert sorted(map(tuple, np.abs(np.round(cube, 12)))) == wanted


def test_volumes():
    volumes = {"Z": 4, "BOX": 15, "TRIANGLE": 4.5, "GIVEN": 4, "BALL": 2 * math.pi, "POINT": 0,
               "EMPTY": 0, "SEGMENT": 0}
    for name, X in ALL.items():
        found = X.volume()
        if name not in volumes:
            assert found.value == math.inf
            continue
        assert found.value >= volumes[name] * (1 - EPS)
        if found.exact:
            assert abs(found.value - volumes[name]) <= 1e-7 * (1 + volumes[name]), name
    assert all(ALL[name].volume().exact for name in ("Z", "BOX", "BALL", "POINT", "EMPTY"))
    G = np.random.default_rng(2).normal(size=(3, 3))
    assert abs(co.zonotope([0] * 3, G).volume().value - 8 * abs(np.linalg.det(G))) < 1e-9


def test_gauges():
    for X, x, value in ((co.zonotope([0, 0], np.eye(2)), [0.5, 0.25], 0.5),
                        (TRIANGLE, [1.5, 1.5], 1.5), (TRIANGLE, [-0.75, -0.75], 1.5),
                        (BAND, [1, 1], 0), (BALL, [0, 3], 3 / math.sqrt(2)),
                        (BOX, [0, 0], 0)):
        lower, upper = X.gauge(x)
        assert lower <= value * (1 + EPS) and upper >= value * (1 - EPS)
        if value > 0:
            assert upper - lower < 1e-8
    with pytest.raises(co.Error, match="holds 0") as found:
        POINT.gauge([1, 1])
    assert found.value.code == "unsupported"


def corners(name):
    return np.array(VERTICES[name], dtype=float)


def supports_of(points, directions):
    return (np.atleast_2d(points) @ directions.T).max(0)


DIRECTIONS = np.array([[math.cos(a), math.sin(a)] for a in np.linspace(0, 2 * math.pi, 33)])
#: Of the representations whose operation is exact.
EXACT = ("Z", "SEGMENT", "TRIANGLE")


def compare(X, points, exact, where=DIRECTIONS):
    """Support values are those of the points, or larger ones where the operation encloses only."""
    wanted = supports_of(points, where)
    found = np.array([X.support(d).value for d in where])
    assert (found >= wanted - EPS).all()
    if exact:
        np.testing.assert_allclose(found, wanted, atol=1e-10)
        assert X.claim == "exact"
    else:
        assert X.claim == "outer"


@pytest.mark.parametrize("name", VERTICES)
def test_maps_and_sums(name):
    if name == "EMPTY":
        pytest.skip("nothing is mapped to nothing below")
    X, V, A, t = ALL[name], corners(name), np.array([[0, 2], [-1, 1]]), np.array([1, -3])
    exact = X.representation not in ("interval", "ellipsoid")
    compare(A @ X, V @ A.T, exact)
    compare(X.affine_map(A, t), V @ A.T + t, exact)
    compare(2 * X, 2 * V, X.representation != "ellipsoid")
    compare(X * -0.5, -0.5 * V, X.representation != "ellipsoid")
    compare(-X, -V, X.representation != "ellipsoid")
    for Y in (X + t, t + X, X - (-t), X + t.tolist()):
        compare(Y, V + t, X.representation != "ellipsoid")
    W = np.array([[1, 1], [1, -1], [-1, 1], [-1, -1]])
    both = (V[:, None] + W[None]).reshape(-1, 2)
    compare(X + co.interval([-1, -1], [1, 1]), both, X.representation != "ellipsoid")
    projected = np.array([[1, 1]]) @ X
    assert projected.dim == 1 and abs(projected.support([1]).value - V.sum(1).max()) < EPS


def test_maps_of_nothing_and_of_lines():
    A = np.array([[1, 2], [3, 4]])
    assert (A @ EMPTY).is_empty().yes and (EMPTY + [1, 1]).is_empty().yes
    assert (EMPTY + Z).is_empty().yes and (Z + co.empty(2, "zonotope")).is_empty().yes
    assert abs((np.array([[-1, 1]]) @ BAND).support([1]).value - 1) < EPS
    assert abs((BAND + SEGMENT).support([-1, 1]).value - 2) < EPS
    assert (np.array([[1, 0]]) @ BAND).is_bounded().no
    assert (np.zeros((2, 2)) @ SPACE).contains([0, 0]).yes
    assert (0 * STRIP).contains([1, 0]).no


@pytest.mark.parametrize("name", ["SEGMENT", "TRIANGLE", "BAND", "STRIP", "SPACE"])
def test_exact_intersections(name):
    X = ALL[name]
    inside, outside = POINTS[name]
    for Y in (X & Z, X.intersect(np.eye(2), Z)):
        assert Y.claim == "exact" and Y.representation == X.representation
        for x in [*inside, *outside, *POINTS["Z"][0], *POINTS["Z"][1]]:
            both = X.contains(x), Z.contains(x)
            wanted = "yes" if all(a.yes for a in both) else "no" if any(a.no for a in both) else "?"
            assert Y.contains(x) == wanted, x
    left = X.intersect([[1, 0]], co.interval([0.3], [0.4]))
    assert left.support([1, 0]).value <= 0.4 + EPS and left.support([-1, 0]).value <= -0.3 + EPS


def test_intersections_by_hand():
    left = BOX & co.interval([0, 0], [5, 1])
    np.testing.assert_allclose(left.hull()[:2], ([0, 0], [2, 1]), atol=EPS)
    assert left.claim == "exact"
    assert (BOX & co.interval([3, 0], [4, 1])).is_empty().yes
    X = TRIANGLE.correct([[1, 1]], [0.5], co.interval([-0.5], [0.5]))  # 0 ≤ x + y ≤ 1
    np.testing.assert_allclose(X.hull()[:2], ([-1, -1], [1, 1]), atol=1e-10)
    assert X.contains([0.9, -0.8]).yes and X.contains([0.6, 0.6]).no
    Y = TRIANGLE.intersect([[1, 1]], co.interval([0], [1]))
    for x in ([0.9, -0.8], [0.6, 0.6], [0, 0.5], [-0.3, 0]):
        assert X.contains(x) == Y.contains(x).status
    assert TRIANGLE.correct([[1, 0]], [5], co.interval([-1], [1])).is_empty().yes
    # zonotopes and ellipsoids enclose: no point of the result is lost
    for name in ("Z", "GIVEN", "BALL"):
        cut = ALL[name].correct([[1, 0]], [0.5], co.interval([-0.5], [0.5]))
        assert cut.claim == "outer"
        for x in POINTS[name][0]:
            assert not (0 <= x[0] <= 1) or cut.contains(x).yes


def test_products_and_hulls_of_two():
    X = TRIANGLE.product(co.interval([5], [6]))
    assert X.dim == 3 and X.representation == "constrained_zonotope"
    np.testing.assert_allclose(X.hull()[:2], ([-2, -2, 5], [1, 1, 6]), atol=1e-10)
    assert X.contains([0.9, 0.9, 5.5]).yes and X.contains([1.1, 0.9, 5.5]).no
    both = SEGMENT.convex_hull(POINT)
    compare(both, np.vstack([corners("SEGMENT"), corners("POINT")]), True)
    compare(Z.convex_hull(POINT), np.vstack([corners("Z"), corners("POINT")]), False)
    box = BOX.convex_hull(co.interval([5, 5], [6, 6]))
    np.testing.assert_allclose(box.hull()[:2], ([-1, -2], [6, 6]), atol=EPS)
    assert SEGMENT.convex_hull(co.empty(2)).contains([0.5, 0.5]).yes


def test_reductions():
    rng = np.random.default_rng(3)
    G = rng.normal(size=(3, 20))
    X = co.zonotope([0, 0, 0], G)
    for count in (3, 7, 12, 20, 30):
        Y = X.reduce(count)
        assert Y.sizes["generators"] <= count and Y.claim == ("outer" if count < 20 else "exact")
        for d in rng.normal(size=(20, 3)):
            assert Y.support(d).value >= np.abs(d @ G).sum() - 1e-9
    C = co.constrained_zonotope([0, 0], rng.normal(size=(2, 8)), rng.normal(size=(3, 8)), [0, 0, 0])
    D = C.reduce(6, 1)
    assert D.sizes["constraints"] <= 1 and D.sizes["generators"] <= 6
    for d in DIRECTIONS:
        assert D.support(d).value >= C.support(d).value - 1e-9
    assert C.reduce(constraints=2).sizes["constraints"] == 2


def test_subsets_and_disjoint_sets():
    yes = [("SEGMENT", "BOX"), ("POINT", "SPACE"), ("TRIANGLE", "SPACE"), ("GIVEN", "BOX"),
           ("EMPTY", "Z"), ("EMPTY", "EMPTY"), ("BAND", "SPACE"), ("POINT", "POINT"), ("Z", "Z")]
    no = [("Z", "BOX"), ("BOX", "Z"), ("SPACE", "Z"), ("POINT", "BOX"), ("TRIANGLE", "GIVEN"),
          ("HALF", "BOX"), ("Z", "EMPTY"), ("SEGMENT", "POINT")]
    for names, status in [(pair, "yes") for pair in yes] + [(pair, "no") for pair in no]:
        X, Y = (ALL[name] for name in names)
        answer = X.is_subset(Y)
        assert answer == status, (names, answer)
        assert answer.certificate is None or answer.certificate.check()
    apart = [("POINT", "BOX"), ("POINT", "STRIP"), ("POINT", "SEGMENT"), ("EMPTY", "SPACE"),
             ("BALL", "POINT"), ("TRIANGLE", "POINT")]
    meet = [("Z", "BOX"), ("BAND", "STRIP"), ("SEGMENT", "TRIANGLE"), ("SPACE", "POINT"),
            ("HALF", "BAND"), ("GIVEN", "Z")]
    for names, status in [(pair, "yes") for pair in apart] + [(pair, "no") for pair in meet]:
        X, Y = (ALL[name] for name in names)
        for answer in (X.is_disjoint(Y), Y.is_disjoint(X)):
            assert answer == status, (names, answer)
            assert answer.certificate is None or answer.certificate.check()
