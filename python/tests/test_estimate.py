# SPDX-License-Identifier: GPL-3.0-or-later
import subprocess
import sys
import threading

import numpy as np
import pytest

import cordon as co
from conftest import inputs_and_outputs


def mass(**changed):
    system = dict(A=[[1, 0.1], [0, 1]], B=[[0.005], [0.1]], C=[[1, 0]],
                  X0=co.interval([-1, -1], [1, 1]), W=co.interval([-0.01, -0.02], [0.01, 0.02]),
                  V=co.interval([-0.1], [0.1]))
    system.update(changed)
    return co.Model(**system)


@pytest.mark.parametrize("name", ["linear_two_states.json", "descriptor_four_representations.json",
                                  "three_tanks_with_gaps.json", "smoothing.json",
                                  "interval_observers_monotone.json", "ellipsoids.json"])
def test_steps_give_the_numbers_of_a_run(examples, name):
    study = co.Study(examples / name)
    if "sweep" in study:
        del study["sweep"]
    results = study.run(sets="none")
    u, y = inputs_and_outputs(results)
    for pipeline in study.pipelines:
        found = results[pipeline]
        if "observer" not in found.written or found.written["summary"].get("error"):
            continue
        observer = co.Observer.of(study, pipeline)
        made = {estimate.k: estimate for estimate in observer.run(u, y, nan_is_missing=True)}
        assert len(found.k) > 10
        for k, lower, upper in zip(found.k, found.lower, found.upper):
            if made[k].consistent.no:
                continue
            assert made[k].hull.lower.tobytes() == lower.tobytes(), (pipeline, k)
            assert made[k].hull.upper.tobytes() == upper.tobytes(), (pipeline, k)


def test_estimate_of_hand():
    # One state that stays: X1 = [-1, 1] + w, y = x + v.
    model = co.Model(A=[[1]], C=[[1]], X0=co.interval([-1], [1]), W=co.interval([-0.5], [0.5]),
                     V=co.interval([-0.25], [0.25]))
    observer = co.Observer("prediction_correction", model, backend="interval")
    first = observer.step(None, [0.5])
    assert (first.hull.lower[0], first.hull.upper[0]) == pytest.approx((0.25, 0.75), abs=1e-12)
    second = observer.step(None, [1.0])
    assert (second.hull.lower[0], second.hull.upper[0]) == pytest.approx((0.75, 1.25), abs=1e-12)
    assert second.consistent.yes and second.consistent.certificate.check()
    third = observer.step(None, [9.0])
    assert third.consistent.no and third.set.is_empty().yes
    assert observer.contradiction["k"] == 2 and observer.contradiction["output"] == 0


def test_contradiction_is_proven():
    observer = co.Observer("prediction_correction", mass(), backend="constrained_zonotope")
    observer.step([0], [0.0])
    estimate = observer.step([0], [5.0])
    assert estimate.consistent.no
    assert estimate.consistent.certificate.kind == "farkas"
    assert estimate.consistent.certificate.check()


def test_contradictions_are_told_after_all_samples():
    for go in (co.Observer.estimates, lambda *given: list(co.Observer.run(*given))):
        observer = co.Observer("prediction_correction", mass(), backend="constrained_zonotope")
        go(observer, np.zeros((6, 1)), [[0], [0], [9], [0], [0], [0]])
        assert observer.contradiction["k"] == 2 and observer.contradiction["output"] == 0
        observer.start()
        assert observer.contradiction is None
        go(observer, np.zeros((2, 1)), np.zeros((2, 1)))
        assert observer.contradiction is None


def test_wrong_arguments_have_the_messages_of_studies():
    with pytest.raises(co.InputError) as raised:
        co.Observer("prediction_correction", mass(), max_generatrs=20)
    assert [problem.pointer for problem in raised.value.problems] == [
        "/pipelines/0/observer/max_generatrs"]
    assert "max_generators" in raised.value.problems[0].suggestion
    with pytest.raises(co.InputError) as raised:
        wrong = mass(C=[[1, 0, 0]], V=co.interval([-1, -1], [1, 1]))
        co.Observer("luenberger", wrong, gain="kalman")
    assert len(raised.value.problems) >= 2
    with pytest.raises(co.InputError, match="did you mean"):
        co.Observer("prediction_corection", mass())


def test_samples_that_are_wrong():
    observer = co.Observer("prediction_correction", mass())
    for y in ([0, 0], [[0]], 0, "0", [None], [1j], []):
        with pytest.raises((TypeError, ValueError, co.Error)):
            observer.step([0], y)
    for u in ([0, 0], [], None, ["a"], [np.inf]):
        with pytest.raises((TypeError, ValueError, co.Error)):
            observer.step(u, [0])
    with pytest.raises(ValueError, match=r"missing=\[0\]"):
        observer.step([0], [np.nan])
    for missing in ([1], [-1]):
        with pytest.raises(IndexError):
            observer.step([0], [0], missing=missing)
    assert observer.k == 0  # none of them was taken
    estimate = observer.step([0], [np.nan], missing=[0])
    assert estimate.hull.upper == pytest.approx([1, 1]) and observer.k == 1


def test_masks_are_no_indices():
    model = mass(C=[[1, 0], [0, 1]], V=co.interval([-0.1, -0.1], [0.1, 0.1]))
    observer = co.Observer("prediction_correction", model)
    for mask in (np.array([False, True]), [False, True], np.isnan([0, np.nan])):
        with pytest.raises(TypeError, match="flatnonzero"):
            observer.step([0], [0, np.nan], missing=mask)
    estimate = observer.step([0], [np.nan, np.nan], missing=np.array([1, 0, 1]))
    assert estimate.k == 0 and observer.k == 1


def test_signals_end_long_records():
    code = """
import signal, threading, os, time, numpy as np, cordon as co
model = co.Model(A=np.eye(6) * 0.9, C=np.eye(6), X0=co.interval(-np.ones(6), np.ones(6)),
                 W=co.interval(-np.ones(6), np.ones(6)), V=co.interval(-np.ones(6), np.ones(6)))
observer = co.Observer("prediction_correction", model, backend="constrained_zonotope",
                       max_generators=200, max_constraints=60)
signal.signal(signal.SIGINT, signal.default_int_handler)
threading.Timer(1, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
try:
    observer.estimates(None, np.zeros((100_000, 6)))
except KeyboardInterrupt:
    print("ended", observer.k < 100_000)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=300)
    assert done.stdout == "ended True\n", done.stderr


def test_rows_that_do_not_fit():
    observer = co.Observer("prediction_correction", mass())
    for u, y in ((np.zeros((3, 1)), np.zeros((2, 1))), (np.zeros(3), np.zeros((3, 1))),
                 (np.zeros((3, 1)), np.zeros(3))):
        with pytest.raises(ValueError):
            observer.run(u, y)


def test_begin_anew_and_replace():
    observer = co.Observer("prediction_correction", mass(), backend="interval")
    first = observer.step([0], [0.0]).hull
    observer.step([1], [0.1])
    observer.start()
    again = observer.step([0], [0.0])
    assert again.k == 0 and again.hull.upper.tobytes() == first.upper.tobytes()
    observer.start(co.interval([-0.5, -0.5], [0.5, 0.5]), k=7)
    estimate = observer.step([0], [0.0])
    assert estimate.k == 7 and estimate.hull.upper[1] == pytest.approx(0.5)
    observer.replace(co.interval([0, 0], [0, 0]))
    moved = observer.step([0], [0.0])
    assert moved.hull.upper[1] <= 0.02 + 1e-12
    with pytest.raises(co.Error):
        observer.replace(co.interval([0], [0]))


def test_threads_each_with_an_observer():
    rng = np.random.default_rng(3)
    y = rng.uniform(-0.1, 0.1, (200, 1))
    u = np.zeros((200, 1))

    def run():
        observer = co.Observer("prediction_correction", mass(), max_generators=60)
        return [estimate.hull.upper.tobytes() for estimate in observer.run(u, y)]

    expected = run()
    found = [None] * 8
    threads = [threading.Thread(target=lambda i=i: found.__setitem__(i, run())) for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(one == expected for one in found)


def test_one_observer_in_two_threads_is_refused_or_in_turn():
    observer = co.Observer("prediction_correction", mass(), backend="constrained_zonotope",
                           max_generators=60, max_constraints=30)
    outcomes = []

    def work():
        for _ in range(50):
            try:
                observer.step([0], [0])
                outcomes.append("taken")
            except RuntimeError as error:
                outcomes.append(str(error))

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert outcomes.count("taken") == observer.k
    assert all(text == "taken" or "another thread" in text for text in outcomes)


def test_all_rows_at_once():
    rng = np.random.default_rng(4)
    u, y = rng.uniform(-1, 1, (60, 1)), rng.uniform(-0.1, 0.1, (60, 1))
    y[[7, 8, 30]] = np.nan
    one_by_one = co.Observer("prediction_correction", mass())
    at_once = co.Observer("prediction_correction", mass())
    expected = list(one_by_one.run(u, y, nan_is_missing=True))
    found = at_once.estimates(u, y, nan_is_missing=True)
    assert [e.k for e in found] == list(range(60)) and at_once.k == 60
    for mine, theirs in zip(found, expected):
        assert mine.hull.upper.tobytes() == theirs.hull.upper.tobytes()
        assert mine.consistent == theirs.consistent
    with pytest.raises(ValueError, match="nan_is_missing"):
        at_once.estimates(u, y)
    with pytest.raises(ValueError, match="samples"):
        at_once.estimates(u[:5], y, nan_is_missing=True)
    with pytest.raises(co.Error):
        at_once.estimates(np.zeros((3, 2)), np.zeros((3, 1)))
    assert at_once.k == 60


def test_gains_lag_and_times():
    observer = co.Observer("luenberger", mass(), gain="kalman")
    assert observer.gains[0].L.shape == (2, 1) and observer.lag == 0
    observer.step([0], [0])
    assert set(observer.times) == {"predict", "correct", "reduce", "question"}
    lagging = co.Observer("fixed_lag", mass(), backend="constrained_zonotope", lag=2)
    assert lagging.lag == 2
    assert [lagging.step([0], [0]).k for _ in range(4)] == [0, 0, 0, 1]


def test_model_from_numbers_of_numpy():
    model = mass(A=np.array([[1, 0.1], [0, 1]], dtype=np.float32), B=np.array([[0], [1]]))
    assert model.system["B"] == [[0], [1]]
    assert model.system["A"][0][1] == float(np.float32(0.1))
    model.check()
    with pytest.raises(co.InputError):
        mass(A=[[1, 0.1]]).check()
    with pytest.raises(ValueError, match="NaN"):
        mass(A=[[1, np.nan], [0, 1]])
    with pytest.raises(TypeError):
        mass(A=np.array([[1j, 0], [0, 1]]))


def test_sets_of_models_are_those_that_were_given():
    X0 = co.constrained_zonotope([0, 0], [[1, 0, 1], [0, 1, 1]], [[1, 1, 1]], [0.5])
    observer = co.Observer("prediction_correction", mass(X0=X0), backend="constrained_zonotope")
    estimate = observer.step([0], [0.0], missing=[0])
    assert estimate.hull.upper.tobytes() == X0.hull().upper.tobytes()
    with pytest.raises(co.Error, match=r'X.as_\("constrained_zonotope"\)'):
        mass(X0=co.interval([-1, -1], [1, 1]).as_("ellipsoid").reduce(1))


SKEW = np.array([[3, 0.1], [-1, 3.0], [-0.7, -2], [1, 1]])


def test_polytopes_bound_models():
    X0 = co.polytope(SKEW, [1, 1, 1, 0.3])
    W = 0.1 * np.array([[0.9, 0.1], [0.2, 0.7]]) @ X0  # corners are no doubles any more
    model = mass(X0=X0, W=W, V=co.polytope([[3], [-7]], [1, 1]))
    assert model.system["X0"]["type"] == "polytope"
    model.check()
    for backend in ("polytope", "constrained_zonotope", "zonotope"):
        observer = co.Observer("prediction_correction", model, backend=backend)
        hull = observer.step([0], [0.0], missing=[0]).hull
        for corner in X0.vertices():
            assert (hull.lower <= corner).all() and (corner <= hull.upper).all()
        assert observer.step([0], [0.0]).consistent.yes
    first = co.Observer("prediction_correction", model, backend="constrained_zonotope").step(
        [0], [0.0], missing=[0])
    np.testing.assert_allclose(first.hull.upper, X0.hull().upper, rtol=1e-12)
    study = co.Study({"cordon": 1, "system": model, "data": {"simulate": {
                          "steps": 3, "input": [{"type": "constant", "offset": 1}]}},
                      "pipelines": [{"name": "p", "backend": "polytope",
                                     "observer": "prediction_correction"}]})
    study["system"] = {**model.system, "X0": X0}
    results = study.run()
    assert results.verify()["violation"] is None


def test_half_planes_bound_no_models():
    with pytest.raises(co.InputError, match="unbounded"):
        mass(X0=co.polytope([[1, 0]], [1])).check()
