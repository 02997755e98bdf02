# SPDX-License-Identifier: GPL-3.0-or-later
"""Answers, errors, copies, and several threads at once."""

import copy
import inspect
import os
import pickle
import re
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
import random_sets

import cordon as co
from cordon import _cordon
from cordon.answers import Answer

X = co.constrained_zonotope([0, 0], np.eye(2), [[1, 1]], [1])
PACKAGE = Path(co.__file__).parent


@pytest.mark.parametrize("answer", [X.contains([0.5, 0.5]), X.contains([3, 3]), X.is_empty(),
                                    X.is_bounded(), Answer("unknown", question="contains")])
def test_answers_are_no_truth_values(answer):
    for use in (bool, lambda a: not a, lambda a: 1 if a else 2, lambda a: a and True,
                lambda a: all([a]), lambda a: np.array([a], dtype=bool)):
        with pytest.raises(TypeError, match=r"no truth value: write \.yes .*\.no") as found:
            use(answer)
        assert str(found.value).startswith(answer.question)
    with pytest.raises(TypeError):
        float(answer)


def test_what_answers_say():
    yes, no, unknown = X.contains([0.5, 0.5]), X.contains([3, 3]), Answer("unknown")
    for answer, flags in ((yes, (True, False, False)), (no, (False, True, False)),
                          (unknown, (False, False, True))):
        assert (answer.yes, answer.no, answer.unknown) == flags
        assert all(isinstance(flag, bool) for flag in flags)
        assert answer.status == str(answer) and answer == answer.status
        assert hash(answer) == hash(answer.status)
    assert yes == Answer("yes") and yes != no and yes != "no" and yes != 1 and yes is not None
    assert repr(yes).startswith("<contains: yes, by <proof of contains by point")
    assert repr(unknown) == "<the question: unknown>"
    assert unknown.certificate is None and unknown.witness is None
    assert X.is_bounded().question == "is_bounded"
    with pytest.raises(AttributeError):
        yes.sure = True


def same(a, b):
    """Bit by bit, the sign of 0 included."""
    return (a.dtype, a.shape) == (b.dtype, b.shape) and a.tobytes() == b.tobytes()


def assert_same_set(Y, Z, claim):
    left, right = Y.view(), Z.view()
    assert left.keys() == right.keys()
    assert all(same(left[name], right[name]) for name in left if name != "claim")
    assert (Z.representation, Z.dim, Z.claim) == (Y.representation, Y.dim, claim)
    assert Y.sizes == Z.sizes or not Y.has_exact_form


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_sets_go_through_pickle(protocol):
    representations = set()
    for seed in range(300):
        try:
            Y, _ = random_sets.of(seed)
        except co.Error:
            continue
        Z = pickle.loads(pickle.dumps(Y, protocol))
        if Y.has_exact_form and Y.representation not in ("interval", "polytope"):
            assert_same_set(Y, Z, Y.claim)
        else:  # an enclosure
            assert Z.representation == Y.representation
            lower, upper, _ = Z.hull()
            tight = Y.hull()
            size = np.abs(np.nan_to_num(tight[:2], posinf=0, neginf=0)).max(0, initial=0)
            assert (lower <= tight.lower + 1e-14 * size).all() or Y.is_empty().yes, seed
            assert (upper >= tight.upper - 1e-14 * size).all() or Y.is_empty().yes, seed
        assert Z.is_empty().status in (Y.is_empty().status, "unknown")
        representations.add(Y.representation)
    assert representations >= {"interval", "zonotope", "constrained_zonotope", "line_zonotope",
                               "ellipsoid"}


def test_boxes_go_through_pickle():
    """Their bounds are written as a middle and a radius, which are rounded outward."""
    for lower, upper in (([-1, 2], [3, 2]), ([-np.inf, 0.1], [np.inf, 0.3]), ([0.1], [0.7])):
        Y = co.interval(lower, upper)
        Z = pickle.loads(pickle.dumps(Y))
        assert (Z.hull().lower <= lower).all() and (Z.hull().upper >= upper).all()
        np.testing.assert_allclose(Z.hull().lower, lower, rtol=1e-14)
        again = pickle.loads(pickle.dumps(Z))
        np.testing.assert_allclose(again.hull().lower, lower, rtol=1e-14)


def test_parameters_go_through_pickle():
    Y = co.zonotope([0, 0], np.eye(2)).as_("zonotope", rounding="outward", reduction="girard")
    A = np.array([[1 / 3, 1 / 7], [0.1, 0.2]])
    for made in (A @ Y, A @ Y + [0.1, 0.3], (A @ Y).convex_hull(Y), (A @ Y).reduce(2)):
        Z = pickle.loads(pickle.dumps(made))
        assert_same_set(made, Z, made.claim)
        nominal = co.zonotope([0, 0], made.view()["G"])
        assert (A @ Z).sizes == (A @ made).sizes != (A @ nominal).sizes
        assert same((A @ Z).view()["G"], (A @ made).view()["G"])
    G = np.random.default_rng(4).normal(size=(3, 12))
    ways = {name: co.zonotope([0, 0, 0], G).as_("zonotope", reduction=name)
            for name in ("girard", "pca")}
    reduced = {name: (-made).reduce(6).view()["G"] for name, made in ways.items()}
    assert not same(reduced["girard"], reduced["pca"])
    for name, made in ways.items():
        for again in (pickle.loads(pickle.dumps(made)), pickle.loads(pickle.dumps(-(-made)))):
            assert same((-again).reduce(6).view()["G"], reduced[name])


def test_answers_and_proofs_go_through_pickle():
    counts = 0
    for seed in range(120):
        try:
            Y, rng = random_sets.of(seed)
        except co.Error:
            continue
        Z = random_sets.zonotope(rng, Y.dim)
        support = Y.support(rng.normal(size=Y.dim))
        for given in (Y.is_empty(), Y.contains(np.ones(Y.dim)), Y.is_disjoint(Z), Y.is_subset(Z),
                      support, Y.hull()):
            got = pickle.loads(pickle.dumps(given))
            assert type(got) is type(given)
            if isinstance(given, Answer):
                assert got == given and got.question == given.question
                assert (got.witness is None) == (given.witness is None)
                assert got.witness is None or same(got.witness, given.witness)
                proofs = [(given.certificate, got.certificate)]
            elif isinstance(given, co.Support):
                assert (got.value, got.at is None) == (given.value, given.at is None)
                proofs = [(given.certificate, got.certificate)]
            else:
                assert same(got.lower, given.lower) and same(got.upper, given.upper)
                proofs = list(zip(given.proofs, got.proofs))
            for before, after in proofs:
                assert (before is None) == (after is None)
                if before is None or not all(S.has_exact_form for S in before.statement.sets):
                    continue
                assert (before.kind, before.margin) == (after.kind, after.margin)
                assert same(before.data, after.data)
                assert before.statement.what == after.statement.what
                if Y.representation not in ("interval", "polytope"):  # written anew
                    assert after.check()
                    counts += 1
    assert counts > 300


def test_copies():
    assert copy.copy(X) is X and copy.deepcopy(X) is X
    answer = X.contains([0.5, 0.5])
    for made in (copy.copy(answer), copy.deepcopy(answer)):
        assert made == answer and made.certificate.check()
    deep = copy.deepcopy({"a": [answer, X]})
    assert deep["a"][1] is X and deep["a"][0].certificate is not answer.certificate


def test_errors():
    with pytest.raises(co.Error) as found:
        X.contains([1])
    error = found.value
    assert (error.code, error.problems) == ("dimension", [])
    for made in (pickle.loads(pickle.dumps(error)), copy.copy(error), copy.deepcopy(error)):
        assert type(made) is co.ArgumentError and str(made) == str(error)
        assert made.code == "dimension"
    problem = ("/a/0", "what", "do", 3)
    several = co.InputError("two", "invalid", [problem, ("", "else", "", 0)])
    got = pickle.loads(pickle.dumps(several))
    assert type(got) is co.InputError and isinstance(got, ValueError) and isinstance(got, co.Error)
    assert got.problems == several.problems and got.problems[0] == co.Problem(*problem)
    assert got.problems[0].pointer == "/a/0" and got.problems[0].line == 3


def test_eight_threads_with_the_same_sets():
    sets = []
    for seed in range(60):
        try:
            sets.append(random_sets.of(seed)[0])
        except co.Error:
            continue

    def figures():
        made = []
        for Y in sets:
            d = np.arange(1.0, Y.dim + 1)
            proof = Y.support(d).certificate
            made.append((Y.support(d).value, Y.contains(d).status, Y.is_empty().status,
                         Y.hull().upper.tobytes(), str(-Y + d), Y.is_disjoint(Y).status,
                         Y.view()["G"].tobytes(), proof is None or proof.check(),
                         (np.eye(Y.dim) @ Y).hull().lower.tobytes()))
        return made

    wanted, got, failures = figures(), [None] * 8, []
    barrier = threading.Barrier(8)

    def work(i):
        try:
            barrier.wait()
            got[i] = figures()
        except BaseException as error:  # noqa: B902
            failures.append(error)

    threads = [threading.Thread(target=work, args=(i,)) for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failures
    assert all(found == wanted for found in got)


def run(code, **environment):
    """In an interpreter of its own, without the variables of this one but for the path."""
    clean = {"PATH": os.environ["PATH"], "PYTHONPATH": str(PACKAGE.parent), **environment}
    return subprocess.run([sys.executable, "-c", code], env=clean, cwd="/", check=True,
                          capture_output=True, text=True).stdout.strip()


def test_plugins_are_found_from_anywhere():
    assert run("import cordon; print(cordon.zonotope([0], [[1]]))") == \
        "zonotope in R^1: 1 generator (exact)"
    code = ("import threading, cordon as co\n"  # the first use by several threads at once
            "made = []\n"
            "ts = [threading.Thread(target=lambda: made.append(co.empty(2))) for _ in range(8)]\n"
            "[t.start() for t in ts]; [t.join() for t in ts]; print(len(made))")
    assert run(code) == "8"


def test_import_reads_nothing_that_is_for_plots_and_tables():
    code = ("import sys, cordon; "
            "print(*(m in sys.modules for m in ('matplotlib', 'pandas', 'tqdm')))")
    assert run(code).split() == ["False"] * 3


def names_of_stub():
    """Of every class, and of the module, the names that the stub tells."""
    found, where = {"": set()}, ""
    for line in (PACKAGE / "_cordon.pyi").read_text(encoding="utf-8").splitlines():
        made = re.match(r"class (\w+)", line)
        if made:
            where = made.group(1)
            found[""].add(where)
            found[where] = set()
        made = re.match(r"(    )?def (\w+)\(", line)
        if made:
            found[where if made.group(1) else ""].add(made.group(2))
    return found


def test_the_stub_tells_all_names():
    stub = names_of_stub()
    public = {name for name in vars(_cordon) if not name.startswith("_")}
    assert stub[""] == public
    for name, value in vars(_cordon).items():
        if inspect.isclass(value):
            own = {member for member in vars(value) if not member.startswith("_")}
            assert {member for member in stub[name] if not member.startswith("_")} == own, name
