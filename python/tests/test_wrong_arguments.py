# SPDX-License-Identifier: GPL-3.0-or-later
"""What is wrong is refused by a message that says what was given, what is needed and what to do."""

import re
import subprocess
import sys

import numpy as np
import pytest
from test_estimate import mass

import cordon as co

X = co.zonotope([0, 0], np.eye(2))
LINE = co.interval([0], [1])
#: What no user has written.
INTERNALS = re.compile(r"incompatible function|has no attribute|subscriptable|not iterable|C\+\+|"
                       r"_cordon|cannot unpack|unsupported operand|out of bounds|bad_alloc|"
                       r"positional|Unable to cast|unhashable|to_json", re.IGNORECASE)


class Nothing(co.extend.Metric):
    """Measures nothing."""

    name = "python_nothing"


def with_parameters(given):
    return type("Parametrised", (Nothing,), {"__doc__": "Has parameters.", "parameters": given})


def observer():
    return co.Observer("prediction_correction", mass())


@pytest.fixture(scope="module")
def study():
    from conftest import REPOSITORY
    return co.Study(REPOSITORY / "examples" / "studies" / "linear_two_states.json")


@pytest.fixture(scope="module")
def results(study):
    return study.run(sets="none")


WRONG_KINDS = {
    "a dictionary for a model": (lambda: co.Observer("prediction_correction", {"A": [[1]]}),
                                 "model: .*cordon.Model.*, not {'A'"),
    "a number for an observer": (lambda: co.Observer(3, mass()), "observer: a name.*not 3"),
    "a list for a backend": (lambda: co.Observer("luenberger", mass(), backend=[1]), "backend: a "),
    "a model for a diagnoser": (lambda: co.Diagnoser("consistency_bank", 3), "model: .*not 3"),
    "a model for a design": (lambda: co.design_input("open_loop", None), "model: .*not None"),
    "a path for a study": (lambda: co.Observer.of("study.json"), "study: .*cordon.Study"),
    "a number for a study": (lambda: co.Study(3), "source: the path.*not 3"),
    "designs of nothing": (lambda: co.designs_of(None), "study: .*cordon.Study"),
    "a text for a time": (lambda: observer().start(k="a"), "k: an integer.*not 'a'"),
    "a list for a set": (lambda: observer().start([0, 1]), r"X0: a cordon set.*not \[0, 1\]"),
    "a number for indices": (lambda: observer().step([0], [0], missing=0), "missing: a list"),
    "texts for indices": (lambda: observer().step([0], [0], missing=["y"]), "missing: ind.*'y'"),
    "a text for a flag": (lambda: observer().run([[0]], [[0]], "yes"), "nan_is_missing: True"),
    "a number for a flag": (lambda: observer().estimates([[0]], [[0]], 1), "nan_is_missing: True"),
    "a number for a representation": (lambda: X.as_(3), "representation: a text.*not 3"),
    "a set for a representation": (lambda: co.polytope([[1]], [1], X), "representation: a text"),
    "a dictionary of parameters": (lambda: X.as_("zonotope", parameters={"rounding": "outward"}),
                                   "parameters: .*by their names"),
    "a number for a kind": (lambda: co.components(3), "kind: a text.*not 3"),
    "a number for a name": (lambda: co.info("observer", 3), "name: a text.*not 3"),
    "a text for cases": (lambda: co.conform("luenberger", cases="9"), "cases: an integer.*'9'"),
    "a text for a seed": (lambda: co.conform("luenberger", seed=1.5), "seed: an integer.*1.5"),
    "a parameter without its kind": (lambda: co.extend.register(with_parameters({"n": 3})),
                                     r"parameters\['n'\]: a Parameter is needed.*not 3"),
    "a list of parameters": (lambda: co.extend.register(with_parameters(["n"])),
                             "parameters: a dictionary"),
    "a default of another kind": (lambda: co.extend.register(with_parameters(
        {"n": co.extend.Parameter("integer", "A number", "three")})), "default: an int.*'three'"),
    "limits that are texts": (lambda: co.extend.register(with_parameters(
        {"n": co.extend.Parameter("integer", "A number", 3, "1")})), "lowest: a number.*'1'"),
    "an object for a component": (lambda: co.extend.register(Nothing()), "a class that derives"),
    "a set in a list of nothing": (lambda: co.Model(A=object()), "system/A: .*nothing that"),
    "plots of a number": (lambda: co.plot.sets(3), "given: sets are needed.*not 3"),
    "plots of numbers": (lambda: co.plot.sets([3]), "X: a cordon set.*not 3"),
    "coordinates that are one": (lambda: X.plot(dims=1), "dims: a list of indices.*not 1"),
    "coordinates that are texts": (lambda: X.plot(dims="ab"), "dims: a list of indices.*'ab'"),
    "coordinates by names": (lambda: X.plot(dims=("x", "y")), "dims: an index.*'x'"),
    "axes that are none": (lambda: X.plot(ax=3), "ax: axes of matplotlib.*not 3"),
    "bounds of a number": (lambda: co.plot.bounds(3), "given: results.*not 3"),
    "bounds of nothing": (lambda: co.plot.bounds([]), r"given: results.*not \[\]"),
    "bounds of a set": (lambda: co.plot.bounds(X), "given: results"),
    "modes of a text": (lambda: co.plot.modes("banks"), "pipeline: .*not 'banks'"),
    "residuals of nothing": (lambda: co.plot.residuals(None), "pipeline: .*not None"),
    "tubes of a number": (lambda: co.plot.tubes(1), "design: .*not 1"),
    "an outline of an array": (lambda: co.plot.outline(np.eye(2)), "X: a cordon set"),
    "comparing numbers": (lambda: co.compare(1, 2), "results: .*not 1"),
}


@pytest.mark.parametrize("what", WRONG_KINDS)
def test_wrong_kinds(what):
    call, message = WRONG_KINDS[what]
    with pytest.raises(TypeError, match=message) as found:
        call()
    assert not INTERNALS.search(str(found.value)), found.value


WRONG_VALUES = {
    "a time before 0": (lambda: observer().start(k=-1), "k: an integer.*0 or more.*-1"),
    "a time of a diagnoser": (lambda: co.Observer("luenberger", mass(), gain="kalman").start(
        k=2**60), "k: an integer"),
    "no cases": (lambda: co.conform("luenberger", cases=0), "cases: an integer.*1 or more.*0"),
    "no law": (lambda: co.conform("luenberger", laws="nothing"), "laws: none of .*'nothing'"),
    "a kind in the plural": (lambda: co.components("observers"), "did you mean 'observer'"),
    "no kind": (lambda: co.info("thing", "zonotope"), "kind: 'thing' is none of 'backend'"),
    "no component": (lambda: co.info("observer", "luenburger"), 'did you mean "luenberger"'),
    "a kind without a component": (lambda: co.conform("luenberger", "observers"), "did you mean"),
    "one coordinate": (lambda: LINE.plot(), "1 coordinate, and a figure needs two"),
    "a coordinate below 0": (lambda: X.plot(dims=(-1, 0)), "dims: there is no coordinate -1"),
    "a coordinate beyond": (lambda: X.plot(dims=(0, 2)), "dims: there is no coordinate 2"),
    "a coordinate twice": (lambda: X.plot(dims=(1, 1)), r"dims: two different.*\(1, 1\)"),
    "three coordinates": (lambda: co.space(3).plot(dims=(0, 1, 2)), "dims: two different"),
    "a million coordinates": (lambda: co.space(10**6), "n: an integer.*10000"),
    "an empty set of a million": (lambda: co.empty(10**6), "n: an integer.*10000"),
    "a box of a million": (lambda: co.interval(np.zeros(10**6), np.ones(10**6)), "1000000 coord"),
    "a point of a million": (lambda: co.point(np.zeros(10**6)), "1000000 coordinates"),
    "division by three": (lambda: X / 3, r"X / 3: .*\(1 / 3\) \* X"),
    "division by zero": (lambda: X / 0, "X / 0"),
    "an unknown in y": (lambda: observer().run([[0], [0]], [[0], [np.nan]]),
                        r"y\[1, 0\] is NaN.*nan_is_missing=True"),
    "an unknown among estimates": (lambda: observer().estimates([[0]], [[np.nan]]),
                                   "nan_is_missing=True"),
    "two unequal records": (lambda: observer().run([[0]], [[0], [0]]), "1 samples, y has 2"),
    "one run": (lambda: co.compare("."), "two or more"),
    "a pipeline beyond": (lambda: co.Observer.of(co.Study({"pipelines": []}), 3), "pipeline"),
}


@pytest.mark.parametrize("what", WRONG_VALUES)
def test_wrong_values(what):
    call, message = WRONG_VALUES[what]
    with pytest.raises(co.Error, match=message) as found:
        call()
    assert isinstance(found.value, ValueError)
    assert not INTERNALS.search(str(found.value)), found.value


def test_wrong_arguments_of_studies(study, results):
    for call, message in (
            (lambda: study.run(sets="al"), "sets: 'al' is none of.*did you mean 'all'"),
            (lambda: study.run(settings=[1]), r"settings: a dictionary is needed.*not \[1\]"),
            (lambda: study.run(settings={3: 1}), "a path of settings: a text.*not 3"),
            (lambda: study.run(sets=None), "sets: a text is needed"),
            (lambda: study.run(report="html"), "report: True or False"),
            (lambda: study.run(progress=3), "progress: True or False"),
            (lambda: study.run(pipeline=0), "pipeline: a text"),
            (lambda: results.verify(every=0), "every: an integer.*1 or more"),
            (lambda: results.verify(progress=True), "progress: a function"),
            (lambda: co.plot.bounds(results, states=[7]), "states: there is no state 7.*are 2"),
            (lambda: co.plot.bounds(results, states=[-1]), "states: there is no state -1"),
            (lambda: co.plot.bounds(results, states=0), "states: a list of indices.*not 0"),
            (lambda: co.plot.bounds(results, states=[]), "states: at least one"),
            (lambda: co.plot.bounds(results, truth=[1, 2]), r"truth: .*samples, states.*\(2,\)"),
            (lambda: co.plot.bounds(results, truth=np.zeros((9, 3))), r"truth: .*not \(9, 3\)"),
            (lambda: co.plot.bounds(results, truth="known"), "truth: an array"),
            (lambda: co.plot.modes(results["Zonotope"]), "no diagnoser"),
            (lambda: co.plot.modes(results), "pipeline: a pipeline of results")):
        with pytest.raises(co.ArgumentError, match=message) as found:
            call()
        assert not INTERNALS.search(str(found.value)), found.value


OPERATORS = {
    "[0, 0] in X": (lambda: [0, 0] in X, r"X.contains\(x\)"),
    "X @ A": (lambda: X @ np.eye(2), "A @ X"),
    "bool(X)": (lambda: bool(X), r"X.is_empty\(\)"),
    "not X": (lambda: not X, r"X.is_empty\(\)"),
    "len(X)": (lambda: len(X), "X.dim"),
    "list(X)": (lambda: list(X), r"X.vertices\(\)"),
    "X / A": (lambda: X / np.eye(2), "divided by a number"),
    "X / True": (lambda: X / True, "divided by a number"),
    "1 / X": (lambda: 1 / X, "s . X"),
    "X - X": (lambda: X - X, "no operation of sets"),
}


@pytest.mark.parametrize("what", OPERATORS)
def test_operators_that_sets_do_not_have(what):
    call, message = OPERATORS[what]
    with pytest.raises(TypeError, match=message):
        call()


def test_division_by_powers_of_two():
    for s, factor in ((2, 0.5), (0.25, 4.0), (-1, -1.0), (np.float32(8), 0.125), (np.int8(4), .25)):
        assert (X / s).view()["G"].tolist() == (factor * np.eye(2)).tolist()


def test_nothing_is_drawn_where_something_is_wrong():
    pyplot = pytest.importorskip("matplotlib.pyplot")
    before = pyplot.get_fignums()
    for call in (lambda: X.plot(dims=(0, 2)), lambda: co.plot.sets([X, 3]), lambda: LINE.plot(),
                 lambda: co.plot.bounds([])):
        with pytest.raises(co.ArgumentError):
            call()
    assert pyplot.get_fignums() == before


def test_masked_records_are_refused():
    y = np.ma.array([[0.0], [9.0]], mask=[[False], [True]])
    for call in (observer().run, observer().estimates):
        with pytest.raises(TypeError, match="mask"):
            call([[0], [0]], y)
    estimates = list(observer().run([[0], [0]], y.filled(np.nan), nan_is_missing=True))
    assert len(estimates) == 2 and estimates[1].consistent.yes


def test_what_does_not_fit_into_memory_says_so():
    code = """
import resource, numpy as np, cordon as co
resource.setrlimit(resource.RLIMIT_AS, (2**31, 2**31))
box = co.interval(-np.ones(9000), np.ones(9000))
try:
    for _ in range(9):
        box.view(), box.as_("zonotope") + box
        keep = [box.as_("line_zonotope") for _ in range(9)]
except MemoryError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert "do not fit into memory" in done.stdout, done.stdout + done.stderr
