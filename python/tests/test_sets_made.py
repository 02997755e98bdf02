# SPDX-License-Identifier: GPL-3.0-or-later
"""Representations and constructors; zonotopes computed again by numpy."""

import pickle
import subprocess
import sys

import numpy as np
import pytest
from test_sets import ALL, BOUNDED, EPS, POINTS, Z, H, compare, corners, h

import cordon as co
from cordon import _cordon


def test_other_representations():
    for name in BOUNDED:
        for other in ("interval", "zonotope", "constrained_zonotope", "line_zonotope", "ellipsoid"):
            Y = ALL[name].as_(other)
            assert Y.representation == other
            for x in POINTS[name][0]:
                assert not Y.contains(x).no
    for name in ("HALF", "BAND", "SPACE"):
        for other in ("zonotope", "constrained_zonotope", "ellipsoid"):
            with pytest.raises(co.Error, match="unbounded") as found:
                ALL[name].as_(other)
            assert found.value.code == "unsupported"
    outward = Z.as_("zonotope", rounding="outward")
    thirds = np.array([[1 / 3, 1 / 7], [0, 1 / 3]]) @ outward
    assert thirds.sizes["generators"] > 2  # what was rounded is added


def test_polytopes_of_every_representation():
    for name in ("constrained_zonotope", "line_zonotope", "polytope"):
        if name not in _cordon.components("backend"):
            continue
        X = co.polytope(H, h, name)
        assert X.claim == "exact" and X.representation == name
        compare(X, corners("TRIANGLE"), True)
        flat = co.polytope([[1, 0], [-1, 0], [0, 1], [0, -1]], [1, -1, 2, 0], name)  # x = 1
        compare(flat, [[1, 0], [1, 2]], True)
        assert co.polytope([[1, 0], [-1, 0]], [1, -2], name).is_empty().yes
    for name in ("interval", "zonotope", "ellipsoid"):
        X = co.polytope(H, h, name)
        for x in corners("TRIANGLE"):
            assert not X.contains(0.999 * x).no
    band = co.polytope([[1, -1], [-1, 1]], [1, 1], "line_zonotope")
    assert band.claim == "exact" and abs(band.support([-1, 1]).value - 1) < EPS
    assert co.polytope([[1, 0]], [1], "line_zonotope").claim == "outer"  # a half-plane
    with pytest.raises(co.Error, match="unbounded"):
        co.polytope([[1, 0]], [1], "zonotope")
    assert co.polytope(np.zeros((0, 2)), [], "line_zonotope").is_bounded().no


@pytest.mark.parametrize("seed", range(30))
def test_polytopes_are_the_numbers_that_were_given(seed):
    """Vertices, hulls and copies of half-spaces of any numbers, against pairs of rows solved."""
    rng = np.random.default_rng(seed)
    angles = np.sort(rng.uniform(0, 2 * np.pi, 3)) + [0, 2 * np.pi, 4 * np.pi]
    rows = np.stack([np.cos(angles), np.sin(angles)], 1) * rng.uniform(1, 9, (3, 1))
    H = np.vstack([rows, [[3, 0], [-3, 0], [0, 7], [0, -0.3]]])
    h = rng.uniform(0.5, 2, len(H))
    X = co.polytope(H, h)
    assert X.claim == "exact" and X.has_exact_form
    corners = []
    for i in range(len(H)):
        for j in range(i):
            if abs(np.linalg.det(H[[i, j]])) > 1e-9:
                x = np.linalg.solve(H[[i, j]], h[[i, j]])
                if (H @ x <= h + 1e-9).all():
                    corners.append(x)
    found = X.vertices()
    for x in corners:
        assert np.abs(found - x).max(axis=1).min() < 1e-9
    for x in found:
        assert np.abs(np.array(corners) - x).max(axis=1).min() < 1e-9
    again = pickle.loads(pickle.dumps(X))
    assert again.claim == "exact"
    assert again.vertices().tobytes() == found.tobytes()


def test_vertices_of_many_half_spaces():
    angles = 2 * np.pi * np.arange(100) / 100
    X = co.polytope(np.stack([np.cos(angles), np.sin(angles)], 1), np.ones(100))
    assert len(X.vertices()) == 100 and X.vertices().max() < 1.001
    assert len(co.polytope([[1, 0], [-1, 0]], [-1, 0]).vertices()) == 0
    with pytest.raises(co.Error, match="unbounded"):
        co.polytope([[3, 0.1], [-1, 3]], [1, 1]).vertices()


def test_vertices_of_what_numbers_do_not_hold():
    X = np.array([[0.9, 0.1], [0.2, 0.7]]) @ co.polytope([[3, 0.1], [-1, 3], [-0.7, -2]], [1, 1, 1])
    for Y in (X, Z.as_("ellipsoid").reduce(1)):
        advice = r'X.as_\("constrained_zonotope"\).vertices\(\)'
        with pytest.raises(co.Error, match=advice) as found:
            Y.vertices()
        assert found.value.code == "unsupported"
        around = Y.as_("constrained_zonotope").vertices()
        for d in np.eye(2):
            assert (around @ d).max() >= Y.support(d).value * (1 - 1e-9)
    assert X.claim == "exact"


def test_long_work_hears_of_signals():
    code = """
import signal, threading, os, time, numpy as np, cordon as co
rng = np.random.default_rng(1)
H = rng.normal(size=(400, 5))
H /= np.linalg.norm(H, axis=1)[:, None]
signal.signal(signal.SIGINT, signal.default_int_handler)
at = []
threading.Timer(0.5, lambda: (at.append(time.time()), os.kill(os.getpid(), signal.SIGINT))).start()
try:
    co.polytope(H, np.ones(400), "constrained_zonotope")
    print("done")
except KeyboardInterrupt:
    print("ended", time.time() - at[0] < 2)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=300)
    assert done.stdout == "ended True\n", done.stdout + done.stderr


def test_constructors_of_representations():
    for name in _cordon.components("backend"):
        for made, empty in ((co.point([1, 2], name), False), (co.empty(2, name), True)):
            assert made.representation == name and made.dim == 2
            assert made.is_empty() == ("yes" if empty else "no")
        assert co.point([1, 2], name).contains([1, 2]).yes
        assert co.point([1, 2], name).contains([1, 2.1]).no
    assert co.space(3, "interval").is_bounded().no
    assert co.point([1, 2], "zonotope", rounding="outward").contains([1, 2]).yes
    with pytest.raises(co.Error, match="unbounded"):
        co.space(2, "zonotope")
    with pytest.raises(co.Error):
        co.interval([0, 0], [np.inf, 1])  # on one side only
    with pytest.raises(co.Error):
        co.line_zonotope([0], [[1]], [[1]], b=[1])._set.of_view({"c": [0]}, "exact", "nonsense", {})


def test_line_zonotopes_by_blocks():
    """{(δ, ξ) : 2δ + ξ = 1}: δ between 0 and 1."""
    X = co.line_zonotope([0], [[1]], [[0]], [[2]], [[1]], [1])
    np.testing.assert_allclose(X.hull()[:2], ([0], [1]), atol=EPS)
    assert X.is_bounded().yes
    Y = co.line_zonotope([0], [[1]], [[0]], S=[[0]], b=[1])
    assert Y.is_empty().yes
    assert co.line_zonotope([0, 0], np.zeros((2, 0)), np.eye(2)).is_bounded().yes
    view = X.view()
    assert {name: value.shape for name, value in view.items() if name != "claim"} == {
        "c": (1,), "M": (1, 1), "G": (1, 1), "S": (1, 1), "A": (1, 1), "b": (1,), "H": (0, 1),
        "h": (0,)}


@pytest.mark.parametrize("seed", range(20))
def test_against_numpy(seed):
    """Zonotopes: support functions, hulls and sums computed again."""
    rng = np.random.default_rng(seed)
    n, g = int(rng.integers(1, 6)), int(rng.integers(0, 9))
    c, G, A = rng.normal(size=n), rng.normal(size=(n, g)), rng.normal(size=(3, n))
    K = rng.normal(size=(n, 2))
    X, Y = co.zonotope(c, G), co.zonotope(np.zeros(n), K)
    np.testing.assert_array_equal(X.view()["G"], G)
    np.testing.assert_allclose(X.hull().upper, c + np.abs(G).sum(1), rtol=EPS, atol=EPS)
    for d in rng.normal(size=(10, n)):
        value = d @ c + np.abs(d @ G).sum()
        assert abs(X.support(d).value - value) < EPS
        assert abs((X + Y).support(d).value - value - np.abs(d @ K).sum()) < EPS
    for d in rng.normal(size=(10, 3)):
        value = d @ A @ c + np.abs(d @ A @ G).sum()
        assert abs((A @ X).support(d).value - value) < 1e-11
    xi = rng.uniform(-1, 1, g)
    assert not X.contains(c + G @ xi).no
    assert X.contains(c + np.abs(G).sum(1) + 0.1).no
    box = co.interval(c - np.abs(K).sum(1), c + np.abs(K).sum(1))
    assert (Y + c).is_subset(box).yes or (Y + c).is_subset(box).unknown
    assert not X.is_disjoint(co.point(c + G @ xi)).yes


@pytest.mark.parametrize("h", [np.ones(1), np.ones(7), np.ones(100_000), np.ones(0)])
@pytest.mark.parametrize("representation", ["polytope", "zonotope", "line_zonotope"])
def test_half_spaces_have_a_bound_each(h, representation):
    with pytest.raises(co.ArgumentError, match="h has"):
        co.polytope([[1, 0], [-1, 0], [0, 1], [0, -1]], h, representation)


def test_intervals_are_pickled_as_they_are():
    X = co.interval([0.1, -1], [0.3, 1])
    again = pickle.loads(pickle.dumps(X))
    for _ in range(5):
        again = pickle.loads(pickle.dumps(again))
    assert again.hull().upper.tobytes() == X.hull().upper.tobytes()
