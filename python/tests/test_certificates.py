# SPDX-License-Identifier: GPL-3.0-or-later
"""Proofs of sets at random: true ones pass their check, corrupted ones do not."""

import copy
from collections import Counter
from fractions import Fraction

import numpy as np
import pytest
import random_sets

import cordon as co
from cordon.certificates import Certificate, Statement

SEEDS = range(1000)
BATCH = 100


def asked(X, Y, rng):
    """Proofs of answers about the sets, by the question."""
    n = X.dim
    questions = {
        "is_empty": X.is_empty(), "contains": X.contains(random_sets.numbers(rng, n)),
        "contains far": X.contains(1e7 * random_sets.numbers(rng, n)),
        "is_subset": X.is_subset(Y), "is_subset back": Y.is_subset(X),
        "is_disjoint": X.is_disjoint(Y), "is_disjoint far": (Y + 1e3 * np.ones(n)).is_disjoint(X),
    }
    found = X.support(random_sets.numbers(rng, n))
    if found.at is not None:
        questions["contains at"] = X.contains(found.at)
    for name, answer in questions.items():
        if not answer.unknown and answer.certificate is not None:
            yield name, answer.certificate
    if found.certificate is not None:
        yield "support", found.certificate
    for proof in X.hull().proofs:
        if proof is not None:
            yield "hull", proof


def pairs(seeds):
    for seed in seeds:
        try:
            X, rng = random_sets.of(seed)
        except co.Error as error:  # a lid of a representation's
            assert error.code in ("unsupported", "not_finite"), f"{seed}: {error}"
            continue
        yield seed, X, random_sets.zonotope(rng, X.dim) if seed % 2 else \
            random_sets.line_zonotope(rng, X.dim), rng


def moved(proof, **changes):
    """The same proof of another statement, or another proof of the same."""
    statement = proof.statement._replace(**{key: value for key, value in changes.items()
                                            if key in Statement._fields})
    return Certificate(changes.get("kind", proof.kind), changes.get("data", proof.data),
                       proof.margin, statement)


def size_of(X):
    view = X.view()
    return 1 + np.abs(view["c"]).sum() + np.abs(view["G"]).sum() + np.abs(view["b"]).sum()


def must_fail(proof, empty):
    """Corruptions after which a proof cannot hold, by their names. `empty`: of the sets, what is
    said of nothing is true of it in many ways."""
    X = proof.statement.sets[0]
    what, data = proof.statement.what, proof.data
    for kind in ("none", "nonsense", "dual" if what != "support" else "point",
                 "point" if what in ("excludes", "empty", "disjoint") else "farkas"):
        if kind != proof.kind and not (empty and kind == "farkas"):
            yield f"kind {kind}", moved(proof, kind=kind)
    yield "longer", moved(proof, data=np.append(data, 1.0))
    if data.size:
        yield "shorter", moved(proof, data=data[:-1])
        for value in (np.nan, np.inf):
            yield f"{value}", moved(proof, data=np.append(data[:-1], value))
    if proof.kind == "farkas" or (proof.kind == "direction" and what != "not a subset" and
                                  not empty):
        yield "sign", moved(proof, data=-data)
        yield "zero", moved(proof, data=0 * data)
    if what == "support" and not empty:
        bound = proof.statement.bound - 1e-6 * size_of(X) * np.abs(proof.statement.vector).sum()
        if proof.statement.vector.any():
            yield "bound", moved(proof, bound=bound)
        yield "NaN bound", moved(proof, bound=np.nan)
        yield "lowest", moved(proof, bound=-np.inf)
    if proof.statement.vector is not None:
        yield "long vector", moved(proof, vector=np.append(proof.statement.vector, 0.0))
        yield "NaN vector", moved(proof, vector=np.nan * proof.statement.vector)
    if what == "contains" and X.is_bounded().yes:
        yield "far", moved(proof, vector=X.hull().upper + size_of(X))
    if what == "excludes" and not empty:
        inside = X.is_empty().witness
        middle = X.blocks()["c"] if inside is None else inside
        if X.contains(middle).yes:
            yield "a point of the set", moved(proof, vector=middle)


def opposite(proof):
    """The statement that is wrong if this one is right."""
    names = ("empty", "not empty"), ("contains", "excludes"), ("subset", "not a subset"), \
        ("disjoint", "meet")
    for a, b in names:
        if proof.statement.what in (a, b):
            return moved(proof, what=b if proof.statement.what == a else a)
    return None


def is_empty(proof):
    return any(X.is_empty().status != "no" for X in proof.statement.sets)


@pytest.mark.parametrize("first", SEEDS[::BATCH])
def test_proofs_hold(first, record_property):
    counts = Counter()
    for seed, X, Y, rng in pairs(range(first, first + BATCH)):
        for name, proof in asked(X, Y, rng):
            assert proof.check(), f"{seed}: {name}: {proof} of {X} and {Y}"
            counts[proof.statement.what] += 1
    record_property("proofs", dict(counts))
    # nearly every answer and bound has one
    assert sum(counts.values()) > 6 * BATCH
    assert min(counts[what] for what in ("empty", "not empty", "contains", "excludes", "support",
                                         "disjoint", "meet", "not a subset")) > 0


@pytest.mark.parametrize("first", SEEDS[::BATCH])
def test_corrupted_proofs_fail(first):
    kinds = Counter()
    for seed, X, Y, rng in pairs(range(first, first + BATCH, 3)):
        for name, proof in asked(X, Y, rng):
            if name == "hull" and rng.random() < 0.7:
                continue
            wrong = opposite(proof)
            if wrong is not None:
                assert not wrong.check(), f"{seed}: {wrong} of {X} and {Y}"
            for corruption, bad in must_fail(proof, is_empty(proof)):
                assert not bad.check(), f"{seed}: {name}: {corruption} of {proof}, {X}, {Y}"
                kinds[corruption] += 1
    assert min(kinds[name] for name in ("longer", "shorter", "nan", "sign", "zero", "bound", "far",
                                        "a point of the set", "kind nonsense")) > 2, kinds


def form_of(X):
    return {name: [[Fraction(v) for v in row] for row in value] if value.ndim == 2 else
            [Fraction(v) for v in value]
            for name, value in X.view().items() if name != "claim"}


def transposed_times(A, y, columns):
    return [sum((row[j] * v for row, v in zip(A, y)), Fraction(0)) for j in range(columns)]


def test_changed_multipliers_prove_what_they_prove():
    """Without lines nothing is moved: the margin and the bound are computed here by themselves."""
    farkas, duals, refused = 0, 0, 0
    for seed in range(2, 1200, 10):  # constrained zonotopes
        X, rng = random_sets.of(seed)
        if X.view()["M"].size or not X.view()["b"].size:
            continue
        form = form_of(X)
        g = X.view()["G"].shape[1]
        answer, d = X.is_empty(), np.round(rng.normal(size=X.dim), 3)
        bound = X.support(d)
        for _ in range(6):
            if answer.yes:
                data = answer.certificate.data.copy()
                data[rng.integers(data.size)] *= rng.choice([-1e3, -1, 0, 0.5, 1.5, 1e3])
                y = [Fraction(v) for v in data]
                margin = sum(b * v for b, v in zip(form["b"], y)) - sum(
                    abs(v) for v in transposed_times(form["A"], y, g))
                assert moved(answer.certificate, data=data).check() == (margin > 0)
                farkas += 1
                refused += margin <= 0
            elif np.isfinite(bound.value):
                data = bound.certificate.data.copy()
                data[rng.integers(data.size)] += rng.choice([-1e3, -0.1, 0, 1e-3, 1e3])
                y, direction = [Fraction(v) for v in data], [Fraction(v) for v in d]
                along = [a - b for a, b in zip(transposed_times(form["G"], direction, g),
                                               transposed_times(form["A"], y, g))]
                value = sum(a * b for a, b in zip(direction, form["c"])) + sum(
                    a * b for a, b in zip(form["b"], y)) + sum(abs(v) for v in along)
                changed = moved(bound.certificate, data=data)
                assert changed.proven_bound() == value
                if abs(value - Fraction(bound.value)) > 1e-12 * (1 + abs(value)):
                    assert changed.check() == (value <= Fraction(bound.value))
                duals += 1
                refused += value > Fraction(bound.value)
    assert farkas > 50 and duals > 100 and refused > 60


def test_the_exchange_of_proofs():
    """A proof of one set says nothing of another one."""
    X = co.constrained_zonotope([0, 0], np.eye(2), [[1, 1]], [3])
    Y = co.constrained_zonotope([0, 0], np.eye(2), [[1, 1]], [1])
    proof = X.is_empty().certificate
    assert proof.check()
    assert not moved(proof, sets=(Y,)).check()
    assert not moved(proof, sets=(co.zonotope([0, 0], np.eye(2)),)).check()
    assert not moved(proof, sets=(X, Y)).check()
    assert not moved(proof, what="nonsense").check()
    both = X.is_disjoint(Y).certificate
    assert both.check()
    assert not moved(both, sets=(X, co.zonotope([0], [[1]]))).check()


def test_bounds_are_those_of_the_proofs():
    X = co.constrained_zonotope([1, 2], [[2, 0], [0, 1]], [[1, 1]], [1])
    found = X.support([1, 1])  # 3 + max{2a + b : a + b = 1, |a|, |b| ≤ 1} = 3 + 2
    assert found.certificate.kind == "dual"
    assert found.certificate.proven_bound() == 5 and 5 <= found.value < 5 + 1e-13
    plain = co.zonotope([1, 2], [[2, 0], [0, 1]]).support([1, -1])
    assert plain.certificate.kind in ("structure", "dual") and plain.certificate.proven_bound() == 2
    assert X.is_empty().certificate.proven_bound() is None
    empty = co.constrained_zonotope([0], [[1]], [[1]], [2]).support([1])
    assert empty.value == -np.inf and empty.certificate.check()
    assert empty.certificate.proven_bound() is None
    assert co.space(2).support([1, 0]).certificate is None


def test_long_sums_stay_within_the_slack():
    rng = np.random.default_rng(1)
    X = co.zonotope(rng.normal(size=3), rng.normal(size=(3, 4000)))
    for d in rng.normal(size=(5, 3)):
        proof = X.support(d).certificate
        assert proof.check()
        assert not moved(proof, bound=proof.statement.bound * (1 - 1e-9)).check()


def test_what_no_exact_form_has_gives_no_proof_of_points():
    E = np.array([[2, 1], [0, 1]]) @ co.zonotope([0, 0], np.eye(2)).as_("ellipsoid") + co.zonotope(
        [0, 0], [[0.1], [0.1]])
    assert not E.has_exact_form and E.view()["claim"] == "outer"
    for answer in (E.is_empty(), E.contains([0, 0]), E.contains([0.1, 0.1])):
        assert answer.status in ("no", "yes") and answer.certificate is None
    # a set that holds it does hold the point, which proves nothing
    fake = Certificate("structure", [], 1, Statement("not empty", (E,)))
    assert not fake.check()
    # what the box around an ellipsoid holds, and the ellipsoid does not
    ball = co.zonotope([0, 0], np.eye(2)).as_("ellipsoid").reduce(1)
    corner = co.point(0.9 * ball.hull().upper)
    assert ball.contains(corner.view()["c"]).no
    apart = ball.is_disjoint(corner)
    assert apart.yes and apart.certificate.kind == "direction" and apart.certificate.check()
    assert not moved(apart.certificate, data=-apart.certificate.data).check()
    assert not moved(apart.certificate, sets=(ball, co.point([0, 0]))).check()


def test_a_direction_needs_both_sets():
    X, Y = co.zonotope([0, 0], np.eye(2)), co.constrained_zonotope([3, 0], np.eye(2), [[0, 1]], [0])
    statement = Statement("disjoint", (X, Y))
    assert Certificate("direction", [1, 0], 1, statement).check()
    assert not Certificate("direction", [-1, 0], 1, statement).check()
    assert not Certificate("direction", [0, 1], 1, statement).check()
    outside = Statement("excludes", (X,), np.array([2.0, 0.5]))
    assert Certificate("direction", [1, 0], 1, outside).check()
    assert not Certificate("direction", [0, 1], 1, outside).check()
    assert not Certificate("direction", [-1, 0], 1, outside).check()
    assert not Certificate("direction", [1, 0, 0], 1, outside).check()
    touching = Statement("disjoint", (X, Y + np.array([-1.0, 0.0])))
    assert not Certificate("direction", [1, 0], 1, touching).check()  # at x = 1 both
    beyond = Statement("not a subset", (Y, X))
    assert Certificate("direction", [1, 0], 1, beyond).check()
    assert not Certificate("direction", [0, 1], 1, beyond).check()
    line = Statement("not a subset", (co.space(2), X))
    assert Certificate("direction", [0, 1], 1, line).check()
    assert not Certificate("direction", [0, 1], 1, Statement("not a subset", (X, X))).check()


def test_flat_sets_that_reach_beyond_others():
    """No point of them is one of doubles: the factors are found."""
    A = np.array([[0.1, 0.3, 0.7]])
    X = co.constrained_zonotope([0.1, 0.2], [[0.3, 0.1, 0.7], [0.1, 0.9, 0.2]],
                                np.vstack([A, [[0.2, 0.1, -0.4]]]), [0.11, 0.07])
    far = X.is_subset(co.zonotope([0, 0], 0.01 * np.eye(2)))
    assert far.no and far.certificate.kind == "direction" and far.certificate.check()


def test_witnesses_are_points_and_directions_of_their_own():
    X, Y = co.zonotope([0, 0], np.eye(2)), co.zonotope([1, 1], np.eye(2))
    answer = X.is_disjoint(Y)
    assert answer.no and X.contains(answer.witness).yes and Y.contains(answer.witness).yes
    inside = co.constrained_zonotope([0, 0], np.eye(2), [[1, 1]], [1]).is_empty()
    assert inside.no and abs(inside.witness.sum() - 1) < 1e-12
    held = X.contains([0.5, 0.5])
    held.witness[:] = 7
    assert held.certificate.check()
    assert X.is_empty().witness is None


def test_proofs_are_values():
    proof = co.zonotope([0, 0], np.eye(2)).contains([3, 0]).certificate
    with pytest.raises(ValueError, match="data"):
        Certificate("farkas", [[1.0]], 1, proof.statement)
    data = proof.data.copy()
    made = Certificate("farkas", data, 1, proof.statement)
    data[:] = 0
    assert made.check() and copy.copy(made).check() and copy.deepcopy(made).check()
    assert repr(proof).startswith("<proof of excludes by farkas, margin ")
