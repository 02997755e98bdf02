# SPDX-License-Identifier: GPL-3.0-or-later
import json
import shutil
import subprocess

import numpy as np
import pytest

import cordon as co


@pytest.fixture()
def study(examples):
    return co.Study(examples / "linear_two_states.json")


def test_results_are_those_of_the_files(study, tmp_path):
    results = study.run(tmp_path / "out")
    written = json.loads((tmp_path / "out" / "results.json").read_text())
    assert list(results) == [found["name"] for found in written["pipelines"]]
    for found in written["pipelines"]:
        mine = results[found["name"]]
        assert mine.lower.tolist() == [step["hull"]["lower"] for step in found["steps"]]
        assert mine.column("radius").tolist() == [step["radius"] for step in found["steps"]]
    rows = (tmp_path / "out" / "data.csv").read_text().splitlines()
    assert results.truth.shape == (len(rows) - 1, 2)
    assert results.data["y_1"][3] == float(rows[4].split(",")[1])


def test_sets_of_results_have_the_bounds_of_the_steps(study):
    results = study.run()
    found = results["Line zonotope"]
    sets = found.sets
    assert len(sets) == len(found.k)
    for i in (0, 5, 60):
        assert sets[i].representation == "line_zonotope"
        np.testing.assert_allclose(sets[i].hull().upper, found.upper[i], rtol=1e-9, atol=1e-9)
        assert sets[i].contains(results.truth[i]).yes


def test_settings_and_changes(study):
    changed = study.copy()
    changed["data"]["simulate"]["seed"] = 7
    by_change = changed.run(sets="none")
    by_setting = study.run(sets="none", settings={"/data/simulate/seed": 7})
    as_it_was = study.run(sets="none")
    assert by_change.data["y_1"].tolist() == by_setting.data["y_1"].tolist()
    assert by_change.data["y_1"].tolist() != as_it_was.data["y_1"].tolist()


def test_all_problems_at_once(study):
    assert study.problems() == []
    study["pipelines"][0]["observer"]["max_generator"] = 3
    study["system"]["A"] = [[0, -0.5]]
    pointers = [problem.pointer for problem in study.problems()]
    assert "/pipelines/0/observer/max_generator" in pointers and "/system/A" in pointers
    with pytest.raises(co.InputError):
        study.run()


def test_saved_and_read_again(study, tmp_path):
    study["system"]["A"] = np.array(study["system"]["A"])
    study["system"]["X0"] = co.interval([-3, -3], [3, 3])
    study.save(tmp_path / "saved.json")
    again = co.Study(tmp_path / "saved.json")
    assert again["system"]["X0"] == {"type": "box", "lower": [-3, -3], "upper": [3, 3]}
    as_box = co.Study(study.file)
    assert co.compare(study.run(sets="none"), as_box.run(sets="none")).different == []
    assert again.problems() == []


def test_files_that_are_no_studies(tmp_path):
    for text in ("{", "[1, 2]", "", '{"cordon": 1, "cordon": 1}', '"x"'):
        file = tmp_path / "wrong.json"
        file.write_text(text)
        with pytest.raises(co.InputError) as raised:
            co.Study(file).checked()
        assert raised.value.problems
    with pytest.raises(FileNotFoundError):
        co.Study(tmp_path / "none.json")


def test_progress_is_told_and_can_end_the_run(study, tmp_path):
    told = []
    study.run(sets="none", progress=lambda *numbers: told.append(numbers))
    assert told[-1] == (3, 101, 101)

    def end(*_):
        raise KeyboardInterrupt

    study["data"]["simulate"]["steps"] = 3000
    study.run(tmp_path / "kept", sets="none", pipeline="Interval")
    before = (tmp_path / "kept" / "results.json").read_bytes()
    with pytest.raises(KeyboardInterrupt):
        study.run(tmp_path / "kept", progress=end)
    assert (tmp_path / "kept" / "results.json").read_bytes() == before


def test_verify(study, tmp_path):
    results = study.run(tmp_path / "out")
    told = results.verify(every=20)
    assert told["violation"] is None
    assert [one["steps"] for one in told["pipelines"]] == [6] * 4
    file = tmp_path / "out" / "results.json"
    written = json.loads(file.read_text())
    written["pipelines"][3]["steps"][20]["hull"]["upper"][0] = -50
    file.write_text(json.dumps(written))
    with pytest.raises(co.InputError, match="manifest"):
        co.Results(tmp_path / "out").verify()
    (tmp_path / "out" / "manifest.json").unlink()
    told = co.Results(tmp_path / "out").verify(every=20)
    assert told["violation"]["k"] == 20


def test_sweep(examples, tmp_path):
    study = co.Study(examples / "linear_two_states.json")
    study["sweep"] = [{"name": "seed", "path": "/data/simulate/seed", "values": [1, 2, 3]}]
    with pytest.raises(co.Error, match="sweep"):
        study.run()
    told = study.sweep(tmp_path / "out", jobs=2)
    assert (told.points, told.failed, told.violated) == (12, 0, 0)
    assert len(told.frame()) == 12


def test_compare(study, tmp_path):
    first = study.run(tmp_path / "first", sets="none")
    again = study.run(tmp_path / "again", sets="none")
    other = study.run(tmp_path / "other", sets="none", settings={"/data/simulate/seed": 5})
    same = co.compare(first, again)
    assert same.different == [] and len(same.runs) == 2
    found = co.compare(first, tmp_path / "other")
    means = {(row.pipeline, row.run): row.mean for row in found.different
             if row.number == "radius_mean"}
    assert ("Zonotope", 1) not in means  # its widths do not depend on the data
    assert means["Interval", 1] == other["Interval"].summary["radius_mean"]
    assert found.warnings  # another seed is another study
    with pytest.raises(co.Error):
        co.compare(first, tmp_path / "nothing")


def test_runs_of_the_command_have_the_same_bytes(study, tmp_path):
    program = shutil.which("cordon") or next(
        (str(path) for path in (study.file.parents[2] / "build").glob("*/bin/cordon")), None)
    if program is None:
        pytest.skip("there is no program beside the package")
    study.run(tmp_path / "mine")
    subprocess.run([program, "run", str(study.file), "--out", str(tmp_path / "its"), "--quiet"],
                   check=True)
    for name in ("results.json", "sets.jsonl", "data.csv", "steps.csv", "summary.csv"):
        mine, its = ((tmp_path / folder / name).read_bytes() for folder in ("mine", "its"))
        if name == "results.json":  # numbers of studies that are written again may have other texts
            mine, its = (json.loads(text) for text in (mine, its))
            for head in ("study_hash", "study"):
                mine.pop(head), its.pop(head)
        assert mine == its, name


def test_frames(study):
    pandas = pytest.importorskip("pandas")
    results = study.run(sets="none")
    frame = results["Zonotope"].frame()
    assert isinstance(frame, pandas.DataFrame)
    assert frame["upper_1"].to_numpy().tolist() == results["Zonotope"].upper[:, 0].tolist()
    assert len(results.summary()) == 4


def test_names_that_are_wrong(study):
    results = study.run(sets="none")
    with pytest.raises(KeyError, match="Zonotope"):
        results["Zonotop"]
    with pytest.raises(KeyError, match="radius"):
        results["Zonotope"].column("radus")
    with pytest.raises(KeyError):
        co.Observer.of(study, "zonotop")


def test_diagnosis_equals_that_of_a_run(examples):
    study = co.Study(examples / "two_tank_leak.json")
    results = study.run(sets="none")
    data = results.data
    u, y = (np.column_stack([data[c] for c in data if c.startswith(letter)])
            for letter in ("u_", "y_"))
    for name, found in results.items():
        diagnoser = co.Diagnoser.of(study, name)
        for step, mine in zip(found.steps, diagnoser.run(u, y)):
            assert (mine.k, mine.decision, mine.mode) == (step["k"], step["decision"], step["mode"])
            assert [mode["candidate"] for mode in mine.evidence.values()] == [
                mode["candidate"] for mode in step["modes"]]


def test_all_diagnoses_at_once(examples):
    study = co.Study(examples / "two_tank_leak.json")
    data = study.run(sets="none").data
    u, y = (np.column_stack([data[c] for c in data if c.startswith(letter)])
            for letter in ("u_", "y_"))
    one_by_one = list(co.Diagnoser.of(study, "intervals").run(u, y))
    diagnoser = co.Diagnoser.of(study, "intervals")
    at_once = diagnoser.diagnoses(u, y)
    assert diagnoser.k == len(u) == len(at_once)
    for mine, theirs in zip(at_once, one_by_one):
        assert (mine.k, mine.decision, mine.mode) == (theirs.k, theirs.decision, theirs.mode)
        assert mine.candidates == theirs.candidates
    diagnoser.start(k=5)
    assert diagnoser.diagnoses(u[:2], y[:2])[1].k == 6
    with pytest.raises(co.ArgumentError, match="nan_is_missing"):
        diagnoser.diagnoses(u, np.full_like(y, np.nan))


def test_designs(examples):
    study = co.Study(examples / "active_diagnosis_two_tanks.json")
    designed = co.designs_of(study, "designed")[0]
    assert designed.separates.yes and designed.u.shape == (6, 1)
    assert designed.outcome["u"] == designed.u.tolist()
    with pytest.raises(co.InputError):
        co.designs_of(study, "nothing")


def test_plots(examples, study):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    results = study.run()
    axes = co.plot.bounds(results)
    assert len(axes) == 2 and len(axes[0].lines) == 9
    ax = co.plot.sets(results["Zonotope"].sets[:3])
    assert len(ax.patches) == 3
    ax = co.plot.modes(co.Study(examples / "two_tank_leak.json").run()["intervals"])
    assert [label.get_text() for label in ax.get_yticklabels()][0] == "healthy"
    design = co.designs_of(co.Study(examples / "active_diagnosis_two_tanks.json"), "designed")[0]
    assert len(co.plot.tubes(design).collections) == 4
    turbine = co.Study(examples / "wind_turbine_sensor_faults.json").run(sets="none")
    assert co.plot.residuals(next(iter(turbine.values())))[0].lines


def test_axes_are_an_array_however_many_there_are(study):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    results = study.run(sets="none")
    assert co.plot.bounds(results).shape == (2,)
    assert co.plot.bounds(results, states=[1]).shape == (1,)
    model = co.Model(A=[[1]], C=[[1]], X0=co.interval([-1], [1]), W=co.interval([-1], [1]),
                     V=co.interval([-1], [1]))
    estimates = co.Observer("prediction_correction", model).estimates(None, [[0], [0]])
    assert co.plot.bounds(estimates).shape == (1,)
    figure, ax = pyplot.subplots()
    assert co.plot.bounds(estimates, ax=ax)[0] is ax
    _, axes = pyplot.subplots(2, 1)
    assert co.plot.bounds(results, ax=axes).tolist() == axes.tolist()
    with pytest.raises(co.ArgumentError, match="ax: 2 axes are needed.*not 1"):
        co.plot.bounds(results, ax=ax)


def test_infinite_numbers_are_numbers(study):
    class Endless(co.extend.Metric):
        """Is infinite."""

        name = "python_endless"

        def step(self, estimate, lower, upper, truth):
            return {"python_endless": np.inf}

        def summary(self):
            return {"python_endless_most": np.inf, "python_endless_least": -np.inf}

    co.extend.register(Endless)
    study["metrics"] = ["python_endless"]
    found = study.run(sets="none", pipeline="Interval")["Interval"]
    assert found.summary["python_endless_most"] == np.inf
    assert found.summary["python_endless_least"] == -np.inf
    assert np.isinf(found.column("python_endless")).all()


def test_empty_estimates_are_gaps(examples):
    pytest.importorskip("matplotlib").use("Agg")
    model = co.Model(A=[[1]], C=[[1]], X0=co.interval([-1], [1]), W=co.interval([-1], [1]),
                     V=co.interval([-1], [1]))
    estimates = co.Observer("prediction_correction", model).estimates(None, [[0], [0], [9], [9]])
    assert [e.consistent.no for e in estimates] == [False, False, True, True]
    line = co.plot.bounds(estimates)[0].lines[0]
    assert np.isnan(line.get_ydata()).tolist() == [False, False, True, True]


def test_outlines_hold_their_sets():
    rng = np.random.default_rng(1)
    for representation in ("zonotope", "constrained_zonotope", "ellipsoid", "interval"):
        X = co.zonotope([1, 2, 3], rng.normal(size=(3, 5))).as_(representation)
        X = X.reduce(1) if representation == "ellipsoid" else X  # an ellipsoid from now on
        corners = co.plot.outline(X, (0, 2))
        for angle in np.linspace(0, 6, 17):
            d = np.array([np.cos(angle), 0, np.sin(angle)])
            assert (corners @ d[[0, 2]]).max() >= X.support(d).value - 1e-9
