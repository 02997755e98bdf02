# SPDX-License-Identifier: GPL-3.0-or-later
import math
import threading

import numpy as np
import pytest

import cordon as co
from conftest import REPOSITORY, inputs_and_outputs


def tanks():
    return co.Study(REPOSITORY / "examples" / "online" / "three_tanks.json")


def samples_of(results):
    """Inputs, outputs and missing outputs of the samples of a run."""
    for inputs, outputs in zip(*inputs_and_outputs(results)):
        yield inputs, outputs, np.flatnonzero(np.isnan(outputs)).tolist()


@pytest.mark.parametrize("name", ["linear_two_states.json", "descriptor_four_representations.json",
                                  "three_tanks_with_gaps.json", "smoothing.json",
                                  "two_tank_leak.json", "ellipsoids.json"])
def test_steps_are_those_of_a_run(examples, name):
    study = co.Study(examples / name)
    if "sweep" in study:
        del study["sweep"]
    results = study.run(sets="none")
    for pipeline in study.pipelines:
        found = results[pipeline]
        if found.written["summary"].get("error"):
            continue
        session = co.Session(study, pipeline)
        told = [step for sample in samples_of(results)
                for step in session.take(sample[0], sample[1], missing=sample[2]).steps]
        if "diagnoser" in found.written:
            assert [step.diagnosis.decision for step in told] == [
                step["decision"] for step in found.written["steps"]]
            continue
        estimates = [step.estimate for step in told if step.estimate is not None]
        assert [estimate.k for estimate in estimates] == list(found.k)
        for estimate, lower, upper in zip(estimates, found.lower, found.upper):
            if not estimate.consistent.no:
                assert estimate.hull.lower.tobytes() == lower.tobytes(), (pipeline, estimate.k)
                assert estimate.hull.upper.tobytes() == upper.tobytes(), (pipeline, estimate.k)


def test_hulls_have_their_proofs(examples):
    session = co.Session(co.Study(examples / "linear_two_states.json"), 0)
    hull = session.take(None, [0.1]).steps[0].estimate.hull
    assert len(hull.proofs) == 4 and all(proof.check() for proof in hull.proofs)


def test_rules_for_samples_out_of_order():
    session = co.Session(tanks(), "levels")
    assert session.k is None and session.pipeline == "levels" and session.modes == []
    session.take([0, 0], [0, 0, 0], k=5)
    filled = session.take([0, 0], [0, math.nan, 0], k=8, missing=[1])
    assert filled.how == "filled" and "2 times" in filled.said
    assert [step.k for step in filled.steps] == [6, 7, 8]
    corrected = session.take([0, 0], [0, 0.001, 0], k=8)
    assert corrected.how == "corrected" and [step.k for step in corrected.steps] == [8]
    assert (corrected.steps[0].estimate.hull.widths[1] <
            filled.steps[-1].estimate.hull.widths[1])
    assert session.take([0, 0], [0, 0.001, 0], k=8).how == "repeated"
    with pytest.raises(co.Error, match="other values"):
        session.take([0, 0], [0, 0.002, 0], k=8)
    with pytest.raises(co.Error, match="longest_gap"):
        session.take([0, 0], [0, 0, 0], k=1000)
    assert session.k == 8 and not session.has_ended
    assert session.counts == {"taken": 1, "filled": 1, "corrected": 1, "late": 0, "repeated": 1,
                              "filled_steps": 2}


def test_times_on_a_clock():
    timed, numbered = co.Session(tanks(), "levels"), co.Session(tanks(), "levels")
    for k in (0, 1, 4, 3, 5):  # the tanks are sampled every 5 s
        one = timed.take([0, 0], [0, 0.001, 0], t=1.7e9 + 5 * k + 0.01 * (-1)**k)
        two = numbered.take([0, 0], [0, 0.001, 0], k=k)
        assert (one.how, one.said) == (two.how, two.said)
        assert [step.k for step in one.steps] == [step.k for step in two.steps]
    with pytest.raises(co.Error, match="clock_tolerance"):
        timed.take([0, 0], [0, 0, 0], t=1.7e9 + 33)
    set_anew = timed.take([0, 0], [0, 0.001, 0], t=12.5, k=6).steps[0]  # the clock was set
    assert set_anew.t == 12.5 and timed.take([0, 0], [0, 0.001, 0], t=17.5).steps[0].k == 7
    with pytest.raises(co.Error):
        timed.take([0, 0], [0, 0, 0], t=math.nan)
    with pytest.raises(IndexError, match="missing: there is no output 1000"):
        timed.take([0, 0], [0, 0, 0], missing=[10**30])
    for wrong in ("noon", True, [1.0], 1j):
        with pytest.raises((co.ArgumentTypeError, co.ArgumentError), match="^t: "):
            timed.take([0, 0], [0, 0, 0], t=wrong)
    assert timed.k == 7


def test_alarms_and_states():
    session, other = co.Session(tanks(), "supervision"), co.Session(tanks(), "supervision")
    assert session.modes == ["healthy", "leak in tank 2", "pump 1 weak"]
    raised = []
    for k in range(40):
        level = 0 if k < 20 else -0.02 * (k - 19)
        sample = ([0, 0], [0, level, 0])
        before = other.save()
        steps, again = session.take(*sample).steps, other.take(*sample).steps
        raised += [change for step in steps for change in step.alarms]
        assert [step.alarms for step in steps] == [step.alarms for step in again]
        other.restore(before)  # and the same sample once more
        assert other.take(*sample).steps[0].alarms == steps[0].alarms
    assert raised[0].what == "raised" and raised[0].alarm.cause == "fault"
    assert "exclude" in raised[0].alarm.text and raised[0].alarm.proof["kind"] == "farkas"
    assert session.alarms == other.alarms and session.alarms[0].cause == "fault"
    changes = session.acknowledge()
    assert changes[0].what == "acknowledged" and session.alarms[0].acknowledged
    assert [change.what for change in session.start()] == ["gone"]
    assert session.k is None and not session.alarms


def test_states_that_are_damaged_or_of_others():
    session = co.Session(tanks(), "levels")
    session.take([0, 0], [0, 0, 0])
    saved = session.save()
    with pytest.raises(co.Error):
        session.restore(saved[:-1])
    with pytest.raises(co.Error):
        session.restore(b"")
    assert session.k == 0  # nothing has happened
    with pytest.raises(co.Error):
        co.Session(tanks(), "supervision").restore(saved)
    with pytest.raises(co.ArgumentTypeError, match="save"):
        session.restore(saved.decode("latin-1"))
    session.restore(saved)
    assert session.take([0, 0], [0, 0, 0]).steps[0].k == 1


def test_wrong_arguments():
    session = co.Session(tanks(), "levels")
    for u in ([0], None, [0, math.nan], "0"):
        with pytest.raises((TypeError, ValueError, co.Error)):
            session.take(u, [0, 0, 0])
    for y in ([0], None, [0, math.nan, 0], [0, None, 0]):
        with pytest.raises((TypeError, ValueError, co.Error)):
            session.take([0, 0], y)
    for k in (-1, 0.5, "0", True, 2 ** 60):
        with pytest.raises((TypeError, ValueError, co.Error)):
            session.take([0, 0], [0, 0, 0], k=k)
    assert session.k is None and not session.has_ended
    with pytest.raises(KeyError, match="did you mean"):
        co.Session(tanks(), "level")
    with pytest.raises(co.ArgumentTypeError):
        co.Session("study.json")
    with pytest.raises(co.InputError, match="designs an input"):
        co.Session(co.Study(REPOSITORY / "examples/studies/active_diagnosis_two_tanks.json"), 0)
    with pytest.raises(co.ArgumentError, match="several, name one of 'supervision', 'levels'"):
        co.Session(tanks())


def test_limits_of_work_are_said(examples):
    study = co.Study(examples / "descriptor_four_representations.json")
    samples = list(samples_of(study.run(sets="none", pipeline="LZ")))
    study["pipelines"][study.index_of("LZ")]["max_programs"] = 0
    free, limited = co.Session(co.Study(study.file), "LZ"), co.Session(study, "LZ")
    left_open = []
    for u, y, missing in samples[:20]:
        wide = limited.take(u, y, missing=missing).steps[0]
        tight = free.take(u, y, missing=missing).steps[0]
        assert not tight.left_open
        left_open.append(wide.left_open)
        assert (wide.estimate.hull.lower <= tight.estimate.hull.lower).all()
        assert (wide.estimate.hull.upper >= tight.estimate.hull.upper).all()
    assert sum(left_open) > 10


def test_one_thread_at_a_time():
    session, refused = co.Session(tanks(), "supervision"), []

    def work():
        for _ in range(200):
            try:
                session.take([0, 0], [0, 0, 0])
            except RuntimeError as error:
                refused.append(str(error))

    threads = [threading.Thread(target=work) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert session.counts["taken"] + len(refused) == 400
    assert all("another thread" in said for said in refused)


def test_the_plant_of_the_example():
    import runpy
    plant = runpy.run_path(str(REPOSITORY / "examples" / "online" / "plant.py"))
    session, changes = co.Session(tanks(), "supervision"), []
    for _, samples in plant["samples"](540, 500, 0.3, 1):
        for sent in samples:
            missing = [i for i, value in enumerate(sent["y"]) if value is None]
            y = [math.nan if value is None else value for value in sent["y"]]
            for step in session.take(sent["u"], y, k=sent["k"], missing=missing).steps:
                changes += step.alarms
    raised = [change for change in changes if change.what == "raised"]
    assert len(raised) == 1 and 500 <= raised[0].k < 510
    assert session.counts["corrected"] > 0 and session.counts["filled"] > 0
