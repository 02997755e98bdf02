# SPDX-License-Identifier: GPL-3.0-or-later
"""Arguments: the right numbers give the right set, and what holds none is refused by its name.
"""

import decimal
import fractions
import gc

import numpy as np
import pandas
import pytest

import cordon as co

C, G = np.array([1.0, -2.0]), np.array([[1.0, 2.0, 0.0], [0.0, -1.0, 3.0]])


def blocks(X):
    view = X.view()
    return view["c"], view["G"]


def check(c, matrix, wanted_c=C, wanted_G=G):
    got_c, got_G = blocks(co.zonotope(c, matrix))
    np.testing.assert_array_equal(got_c, wanted_c)
    np.testing.assert_array_equal(got_G, wanted_G)


@pytest.mark.parametrize("dtype", ["int8", "int16", "int32", "int64", "float16", "float32",
                                   "float64", ">f8", ">i4", "<f4"])
def test_dtypes(dtype):
    check(C.astype(dtype), G.astype(dtype))


@pytest.mark.parametrize("dtype", ["uint8", "uint16", "uint32", "uint64"])
def test_unsigned_dtypes(dtype):
    c, matrix = np.abs(C).astype(dtype), np.abs(G).astype(dtype)
    check(c, matrix, np.abs(C), np.abs(G))
    X = co.zonotope([0, 0], np.eye(2))
    np.testing.assert_array_equal((X - c).view()["c"], [-1, -2])
    np.testing.assert_array_equal((X - np.array([-128, 0], dtype="int8")).view()["c"], [128, 0])
    np.testing.assert_array_equal((X + c).view()["c"], [1, 2])


def test_small_floats_are_the_numbers_that_they_are():
    got, _ = blocks(co.zonotope(np.array([0.1, 0.2], dtype="float32"), np.eye(2)))
    assert got[0] == float(np.float32(0.1)) and got[0] != 0.1
    got, _ = blocks(co.zonotope(np.array([0.1, 0.2], dtype="float16"), np.eye(2)))
    assert got[0] == float(np.float16(0.1))


@pytest.mark.parametrize("given", [
    [1, -2], (1, -2), [1.0, -2], [np.int8(1), np.float32(-2)], np.array([1, -2]),
    [np.array(1.0), np.array(-2)], range(1, -4, -3), pandas.Series([1.0, -2.0]),
    np.ma.array([1.0, -2.0]), np.ma.array([1.0, -2.0], mask=False),
], ids=repr)
def test_vectors(given):
    check(given, G)


@pytest.mark.parametrize("given", [
    G.tolist(), tuple(map(tuple, G)), list(G), np.asfortranarray(G), G.T.copy().T,
    np.flip(np.flip(G, 0).copy(), 0), np.repeat(np.repeat(G, 2, 0), 3, 1)[::2, ::3],
    np.broadcast_to(G, (4, 2, 3))[2], pandas.DataFrame(G), G.view(np.matrix),
    np.lib.stride_tricks.as_strided(G.copy()[:, ::-1], (2, 3), (24, -8))[:, ::-1][:, ::-1][:, ::-1],
], ids=lambda given: type(given).__name__)
def test_matrices_in_any_order(given):
    check(C, given)


def test_read_only_and_unaligned_arrays():
    frozen = G.copy()
    frozen.flags.writeable = False
    check(C, frozen)
    raw = np.zeros(G.nbytes + 1, dtype="uint8")
    unaligned = raw[1:].view("float64").reshape(G.shape)
    unaligned[:] = G
    assert not unaligned.flags.aligned
    check(C, unaligned)


def test_nothing_of_the_callers_memory_is_kept():
    c, matrix = C.copy(), G.copy()
    X = co.zonotope(c[:], matrix[:, :])
    c[:], matrix[:] = 7, 7
    del c, matrix
    gc.collect()
    np.full(1000, 9.0)
    np.testing.assert_array_equal(X.view()["c"], C)
    np.testing.assert_array_equal(X.view()["G"], G)
    Y = co.zonotope(np.arange(20.0)[1::9][:2], np.ones((40, 40))[::20, ::15])
    gc.collect()
    np.testing.assert_array_equal(Y.view()["c"], [1, 10])
    np.testing.assert_array_equal(Y.view()["G"], np.ones((2, 3)))


def test_nothing_of_the_sets_memory_is_given():
    X = co.zonotope(C, G)
    X.view()["c"][:] = 9
    X.hull().lower[:] = 9
    X.vertices()[:] = 9
    X.support([1, 0]).at[:] = 9
    np.testing.assert_array_equal(X.view()["c"], C)
    np.testing.assert_allclose(X.hull().lower, C - np.abs(G).sum(1), rtol=1e-14)
    with pytest.raises(ValueError, match="read-only"):
        X.blocks()["c"][:] = 9
    X.view().clear()
    assert set(X.view()) == {"c", "M", "G", "S", "A", "b", "H", "h", "claim"}


def test_empty_arrays():
    check([0, 0], np.zeros((2, 0)), [0, 0], np.zeros((2, 0)))
    check([0, 0], [[], []], [0, 0], np.zeros((2, 0)))
    nothing = co.zonotope([], np.zeros((0, 3)))
    assert nothing.dim == 0 and nothing.is_empty().no and nothing.contains([]).yes
    X = np.zeros((0, 2)) @ co.zonotope(C, G)
    assert X.dim == 0
    assert co.constrained_zonotope(C, G, np.zeros((0, 3)), []).contains(C).yes
    assert co.interval([], []).dim == 0


REFUSED = {
    "complex": (np.array([1j, 2]), TypeError, "real numbers .* complex128"),
    "bool": (np.array([True, False]), TypeError, "real numbers .* bool"),
    "bools": ([True, False], TypeError, "bool"),
    "text": (["1", "2"], TypeError, "real numbers"),
    "a text": ("12", TypeError, "real numbers"),
    "bytes": (b"12", TypeError, "real numbers"),
    "objects": (np.array([1, 2], dtype=object), TypeError, "object"),
    "fractions": ([fractions.Fraction(1, 3), 1], TypeError, "object"),
    "decimals": ([decimal.Decimal("0.1"), 1], TypeError, "object"),
    "None": (None, TypeError, "object"),
    "None inside": ([1, None], TypeError, "object"),
    "a mapping": ({"a": 1}, TypeError, "object"),
    "a set": ({1, 2}, TypeError, "object"),
    "a generator": ((v for v in (1, 2)), TypeError, "object"),
    "times": (np.array([1, 2], dtype="datetime64[s]"), TypeError, "datetime64"),
    "durations": (np.array([1, 2], dtype="timedelta64[s]"), TypeError, "timedelta64"),
    "records": (np.zeros(2, dtype=[("a", "f8")]), TypeError, "real numbers"),
    "long doubles": (np.array([1, 2], dtype="longdouble"), TypeError, "64 bits"),
    "masked": (np.ma.array([1, 2], mask=[1, 0]), TypeError, "masked"),
    "masked inside": ([np.ma.array(1.0, mask=True), 2.0], TypeError, "masked"),
    "ragged": ([[1], [1, 2]], (TypeError, ValueError), ""),
    "missing": (pandas.Series([1, None], dtype="Int64"), TypeError, "object"),
    "big": ([2**53 + 1, 0], ValueError, "2.53"),
    "big among floats": ([2**53 + 1, 0.5], ValueError, "2.53"),
    "big below 0": ([-2**53 - 1, 0.5], ValueError, "2.53"),
    "beyond 64 bits": ([2**70, 0], (TypeError, ValueError), "2.53"),
    "int64": (np.array([2**53 + 1, 0]), ValueError, "2.53"),
    "least int64": (np.array([-2**63, 0]), ValueError, "2.53"),
    "the least": ([-2.0**53, -2**53], ValueError, "2.53"),
    "uint64": (np.array([2**64 - 1, 0], dtype="uint64"), ValueError, "2.53"),
    "both signs": ([np.uint64(2**63), np.int64(-1)], ValueError, "2.53"),
    "arrays inside": ([np.array(2**53 + 1), 0.5], ValueError, "2.53"),
    "0-d": (np.array(1.0), ValueError, r"shape \(\)"),
    "a number": (1.0, ValueError, r"shape \(\)"),
    "a column": ([[1], [2]], ValueError, r"shape \(2, 1\)"),
    "three dimensions": (np.zeros((1, 1, 2)), ValueError, r"shape \(1, 1, 2\)"),
    "a matrix": (np.array([[1, 2]]).view(np.matrix), ValueError, r"shape \(1, 2\)"),
    "NaN": ([1, np.nan], co.Error, "NaN|finite"),
    "inf": ([np.inf, 1], co.Error, "infinite|finite"),
    "overflow": (np.array([np.float32("inf"), 1], dtype="float32"), co.Error, "infinite|finite"),
}

X2 = co.zonotope([0, 0], np.eye(2))
VECTORS = {
    "c": lambda v: co.zonotope(v, np.eye(2)),
    "c of others": lambda v: co.constrained_zonotope(v, np.eye(2), np.zeros((0, 2)), []),
    "lower": lambda v: co.interval(v, [9, 9]),
    "upper": lambda v: co.interval([-9, -9], v),
    "rho": lambda v: co.strip(v, 0, 1),
    "b": lambda v: co.line_zonotope([0], [[1]], [[1]], S=np.zeros((2, 1)), A=np.eye(2)[:, :1], b=v),
    "x": lambda v: co.point(v),
    "x of contains": lambda v: X2.contains(v),
    "x of gauge": lambda v: X2.gauge(v),
    "d": lambda v: X2.support(v),
    "t": lambda v: X2 + v,
    "t of -": lambda v: X2 - v,
    "t of affine_map": lambda v: X2.affine_map(np.eye(2), v),
    "y": lambda v: X2.correct(np.eye(2), v, X2),
    "h": lambda v: co.polytope(np.eye(2), v, "line_zonotope"),
}


@pytest.mark.parametrize("what", REFUSED)
@pytest.mark.parametrize("argument", VECTORS)
def test_refused_vectors(what, argument):
    given, kind, message = REFUSED[what]
    if what == "a generator":
        given = (v for v in (1, 2))
    if what == "None" and argument == "b":
        pytest.skip("None is no block")
    if what in ("inf", "overflow") and argument in ("lower", "upper"):
        pytest.skip("infinite bounds are for free coordinates")
    with pytest.raises(kind, match=message) as found:
        VECTORS[argument](given)
    if kind is not co.Error:
        assert str(found.value).startswith(argument.split()[0] + ":"), found.value


MATRICES = {
    "G": lambda A: co.zonotope([0, 0], A),
    "G of others": lambda A: co.line_zonotope([0, 0], np.zeros((2, 0)), A),
    "M": lambda A: co.line_zonotope([0, 0], A, np.zeros((2, 0))),
    "A": lambda A: A @ X2 if not isinstance(A, np.ma.MaskedArray) else X2.affine_map(A, [0, 0]),
    "A of affine_map": lambda A: X2.affine_map(A, [0, 0]),
    "A of constraints": lambda A: co.constrained_zonotope([0, 0], np.eye(2), A, [0, 0]),
    "S": lambda A: co.line_zonotope([0, 0], np.eye(2), np.zeros((2, 0)), S=A, b=[0, 0]),
    "C": lambda A: X2.correct(A, [0, 0], X2),
    "R": lambda A: X2.intersect(A, X2),
    "H": lambda A: co.polytope(A, [1, 1], "line_zonotope"),
}
REFUSED_MATRICES = {
    "a vector": (np.ones(2), ValueError, r"a matrix is needed.*\(2,\)"),
    "three dimensions": (np.ones((2, 2, 1)), ValueError, r"\(2, 2, 1\)"),
    "a text": ([["a", "b"], ["c", "d"]], TypeError, "real numbers"),
    "bool": (np.eye(2, dtype=bool), TypeError, "bool"),
    "complex": (1j * np.eye(2), TypeError, "complex"),
    "objects": (np.eye(2).astype(object), TypeError, "object"),
    "long doubles": (np.eye(2).astype("longdouble"), TypeError, "64 bits"),
    "big": ([[2**53 + 1, 0], [0, 1]], ValueError, "2.53"),
    "big among floats": ([[2**53 + 1, 0.5], [0, 1]], ValueError, "2.53"),
    "masked": (np.ma.array(np.eye(2), mask=np.eye(2)), TypeError, "masked"),
    "masked rows": ([np.ma.array([1, 2], mask=[1, 0]), [0, 1]], TypeError, "masked"),
    "NaN": (np.nan * np.eye(2), co.Error, "NaN|finite"),
    "inf": ([[np.inf, 0], [0, 1]], co.Error, "infinite|finite"),
}


@pytest.mark.parametrize("what", REFUSED_MATRICES)
@pytest.mark.parametrize("argument", MATRICES)
def test_refused_matrices(what, argument):
    given, kind, message = REFUSED_MATRICES[what]
    if argument == "A" and not isinstance(given, np.ndarray):
        pytest.skip("lists have operators of their own")
    with pytest.raises(kind, match=message) as found:
        MATRICES[argument](given)
    if kind is not co.Error:
        assert str(found.value).startswith(argument.split()[0] + ":"), found.value


@pytest.mark.parametrize("call", [
    lambda: co.zonotope([0, 0], np.eye(3)), lambda: co.interval([0, 0], [1]),
    lambda: co.constrained_zonotope([0, 0], np.eye(2), [[1]], [1]),
    lambda: co.constrained_zonotope([0, 0], np.eye(2), [[1, 1]], [1, 2]),
    lambda: co.constrained_zonotope([0, 0], np.eye(2), np.zeros((3, 0)), [0, 0, 0]),
    lambda: co.line_zonotope([0, 0], np.eye(2), np.eye(2), S=[[1, 1]]),
    lambda: co.line_zonotope([0, 0], np.eye(2), np.eye(2), S=[[1]], b=[1]),
    lambda: co.line_zonotope([0, 0], np.zeros((2, 0)), np.eye(2), S=np.zeros((5, 0)), A=[[1, 1]],
                             b=[1]),
    lambda: co.line_zonotope([0], np.eye(2), np.eye(1)),
    lambda: co.polytope(np.eye(2), [1], "line_zonotope"), lambda: np.eye(3) @ X2,
    lambda: X2 + co.zonotope([0], [[1]]), lambda: X2 & co.zonotope([0], [[1]]), lambda: X2 + [1],
    lambda: X2 - [1, 2, 3], lambda: X2.affine_map(np.eye(2), [1]), lambda: X2.contains([1]),
    lambda: X2.support([1]), lambda: X2.gauge([1]), lambda: X2.intersect(np.eye(1), X2),
    lambda: X2.intersect(np.eye(2), co.zonotope([0], [[1]])),
    lambda: X2.correct(np.eye(2), [1], X2), lambda: X2.correct([[1, 0]], [1], X2),
    lambda: X2.correct([[1]], [1], co.zonotope([0], [[1]])),
    lambda: X2.is_subset(co.point([0])), lambda: X2.is_disjoint(co.point([0])),
    lambda: X2.convex_hull(co.point([0])),
])
def test_sizes_that_do_not_fit(call):
    with pytest.raises(co.Error) as found:
        call()
    assert found.value.code == "dimension", found.value


@pytest.mark.parametrize("s", [2, 2.0, np.float32(2), np.int8(2), np.uint64(2), np.array(2.0)])
def test_factors(s):
    for X in (s * X2, X2 * s):
        np.testing.assert_array_equal(X.view()["G"], 2 * np.eye(2))


@pytest.mark.parametrize("s", [True, np.bool_(True), "2", b"2", 2j, None, [2], np.ones(1),
                               np.eye(2),
                               fractions.Fraction(1, 3), decimal.Decimal(2), 2**53 + 1, 10**40,
                               np.longdouble(2), X2, np.ma.array(2.0, mask=True)], ids=repr)
def test_refused_factors(s):
    with pytest.raises((TypeError, ValueError)):
        s * X2
    with pytest.raises((TypeError, ValueError)):
        X2 * s


def test_factors_that_are_not_finite():
    for s in (np.nan, np.inf):
        with pytest.raises(co.Error, match="NaN|finite"):
            s * X2


def test_numbers_of_a_strip():
    assert co.strip([1, 0], np.int32(1), np.float32(0.5)).contains([1.5, 9]).yes
    for d, sigma, name in (("1", 1, "d"), (0, True, "sigma"), ([0], 1, "d"), (0, 2**60 + 1,
                           "sigma"),
                           (None, 1, "d"), (0, 1j, "sigma"), (0, np.longdouble(1), "sigma")):
        with pytest.raises((TypeError, ValueError), match=f"^{name}:"):
            co.strip([1, 0], d, sigma)
    for d, sigma in ((np.nan, 1), (0, np.nan), (0, np.inf), (0, -1)):
        with pytest.raises(co.Error):
            co.strip([1, 0], d, sigma)


@pytest.mark.parametrize("n", [-1, 2.0, "2", True, None, [2], 2**70, np.array([2, 3]), 2j],
                         ids=repr)
def test_refused_counts(n):
    for call in (co.space, co.empty, lambda n: co.empty(n, "zonotope")):
        with pytest.raises((TypeError, ValueError), match="^n: an integer"):
            call(n)
    for name in ("generators", "constraints"):
        if n is not None:
            with pytest.raises((TypeError, ValueError), match=f"^{name}: an integer"):
                X2.reduce(**{name: n})


def test_counts():
    for n in (0, 1, np.int64(3), np.uint8(2)):
        assert co.space(n).dim == n and co.empty(n, "zonotope").dim == n
    assert X2.reduce(np.int16(2)).sizes["generators"] == 2
    assert X2.reduce(None, None).sizes["generators"] == 2


def test_sets_where_arrays_are_needed_and_the_reverse():
    for call in (lambda: co.zonotope(X2, np.eye(2)), lambda: X2.contains(X2),
                 lambda: X2.support(X2)):
        with pytest.raises(TypeError, match="^[cxd]: real numbers"):
            call()
    for call, name in ((lambda: X2.is_subset([0, 0]), "other"), (lambda: X2 & [0, 0], "right"),
                       (lambda: X2.correct(np.eye(2), [0, 0], [1, 1]), "V"),
                       (lambda: X2.product(None), "other"), (lambda: X2.convex_hull(1), "other"),
                       (lambda: X2.is_disjoint("x"), "other")):
        with pytest.raises(TypeError, match=f"{name}.*a cordon set is needed"):
            call()
    with pytest.raises(TypeError, match="X . Y is no operation"):
        X2 - X2
    with pytest.raises(TypeError):
        co.Set(X2)
    with pytest.raises(TypeError):
        X2 @ np.eye(2)


def test_parameters_of_representations():
    assert X2.as_("zonotope", rounding="outward").representation == "zonotope"
    assert X2.as_("constrained_zonotope", rescale=True).claim == "exact"
    assert X2.as_("constrained_zonotope", rescale=np.bool_(True)).claim == "exact"
    for parameters in ({"rounding": "sideways"}, {"nonsense": 1}, {"rounding": 3},
                       {"rescale": "yes"}, {"rescale": np.longdouble(1)}, {"rescale": 10**40},
                       {"rescale": object()}):
        with pytest.raises((co.Error, TypeError, ValueError)) as found:
            X2.as_("constrained_zonotope", **parameters)
        assert next(iter(parameters)) in str(found.value)
    with pytest.raises(co.Error, match="zonotope") as found:
        X2.as_("zonotop")
    assert found.value.code == "invalid"
