# SPDX-License-Identifier: GPL-3.0-or-later
"""Components that are written in Python, in studies of the same process."""

import numpy as np
import pytest

import cordon as co


def is_free(kind, name):
    return name not in co.components(kind)


class Corrected(co.extend.Observer):
    """Predicts, and cuts by the outputs."""

    name = "python_corrected"
    parameters = {"max_generators": co.extend.Parameter("integer", "Most generators", 30, 1, 1000)}

    def __init__(self, model, representation, **parameters):
        super().__init__(model, representation, **parameters)
        if parameters["max_generators"] < len(model.A):
            raise ValueError("fewer generators than states enclose no set")

    def corrected(self, X, sample):
        y = sample.y - self.model.D @ sample.u
        return X.correct(self.model.C, y, self.model.Dv @ self.model.V)

    def begin(self, X0, sample):
        return self.corrected(X0, sample)

    def advance(self, X, before, now):
        moved = self.model.A @ X + self.model.Bw @ self.model.W + self.model.B @ before.u
        return self.corrected(moved, now).reduce(self.settings["max_generators"])


class Lossy(Corrected):
    """Forgets the disturbance."""

    name = "python_lossy"

    def advance(self, X, before, now):
        return self.corrected(self.model.A @ X + self.model.B @ before.u, now)


class Broken(Corrected):
    """Divides by zero at k = 3."""

    name = "python_broken"

    def advance(self, X, before, now):
        if now.k == 3:
            1 / 0
        return super().advance(X, before, now)


class Picky(Corrected):
    """Takes three states only."""

    name = "python_picky"

    def __init__(self, model, representation, **parameters):
        super().__init__(model, representation, **parameters)
        if len(model.A) != 3:
            raise ValueError(f"three states are needed, the model has {len(model.A)}")


class Width(co.extend.Metric):
    """The width of the first state."""

    name = "python_width"

    def __init__(self, **parameters):
        super().__init__(**parameters)
        self.widths = []

    def step(self, estimate, lower, upper, truth):
        self.widths.append(upper[0] - lower[0])
        return {"python_width": self.widths[-1]}

    def summary(self):
        return {"python_width_mean": float(np.mean(self.widths)) if self.widths else np.nan}


class Pendulum(co.extend.Plant):
    """A pendulum with friction."""

    name = "python_pendulum"
    parameters = {"friction": co.extend.Parameter("real", "Friction, 1/s", 0.1, 0, 1)}
    states, inputs, outputs = 2, 0, 1

    def next(self, k, x, u):
        h = 0.05
        return [x[0] + h * x[1], x[1] - h * (np.sin(x[0]) + self.settings["friction"] * x[1])]

    def output(self, k, x, u):
        return x[:1]


@pytest.fixture(scope="module", autouse=True)
def registered():
    for component in (Corrected, Lossy, Broken, Picky, Width, Pendulum):
        if is_free(component.kind, component.name):
            co.extend.register(component)


@pytest.fixture()
def study(examples):
    made = co.Study(examples / "linear_two_states.json")
    made["data"]["simulate"]["steps"] = 40
    return made


def pipelines(*observers, backend="zonotope"):
    return [{"name": name, "backend": backend, "observer": {"type": name, "max_generators": 30}}
            for name in observers]


def test_observer_in_a_study_encloses_what_the_library_does(study):
    study["pipelines"] = pipelines("python_corrected", "prediction_correction",
                                   backend="constrained_zonotope")
    results = study.run()
    mine, theirs = results["python_corrected"], results["prediction_correction"]
    np.testing.assert_allclose(mine.upper[:4], theirs.upper[:4], atol=1e-9)
    assert mine.summary["contains_truth_no"] == 0
    assert results.verify()["violation"] is None


def test_two_threads_of_a_sweep_call_python(study, tmp_path):
    study["pipelines"] = pipelines("python_corrected")
    study["sweep"] = [{"name": "seed", "path": "/data/simulate/seed", "values": [1, 2, 3, 4]}]
    told = study.sweep(tmp_path, jobs=2)
    assert (told.points, told.failed, told.violated) == (4, 0, 0)


def test_an_exception_ends_its_pipeline_only(study):
    study["pipelines"] = pipelines("python_broken", "prediction_correction")
    with pytest.warns(RuntimeWarning, match="python_broken"):
        results = study.run()
    assert "ZeroDivisionError" in results["python_broken"].summary["error"]
    assert len(results["prediction_correction"].k) == 41


def test_what_a_class_refuses_is_a_problem_of_the_study(study):
    study["pipelines"] = pipelines("python_picky")
    problem = study.problems()[0]
    assert problem.pointer.startswith("/pipelines/0/observer")
    assert "three states are needed" in problem.message
    study["pipelines"] = [{"name": "p", "backend": "zonotope",
                           "observer": {"type": "python_corrected", "max_generators": 0}}]
    assert "max_generators" in study.problems()[0].pointer


def test_laws_catch_what_is_unsound():
    for seed in (1, 2, 3):
        sound = co.conform("python_corrected", seed=seed)
        assert [law.law for law in sound if law.status == "failed"] == []
        assert sum(law.status == "passed" for law in sound) >= 8
    told = []
    found = co.conform("python_lossy", cases=20, tell=told.append)
    failed = [law for law in found if law.status == "failed"]
    assert failed and failed[0].witness and told
    assert any("true" in law.law or "sound" in law.law or "state" in law.reason for law in failed)


def test_metric_in_a_study(study):
    study["metrics"] = ["radius", "python_width"]
    results = study.run()
    for pipeline in results.values():
        widths = pipeline.upper[:, 0] - pipeline.lower[:, 0]
        assert pipeline.column("python_width").tolist() == widths.tolist()
        assert pipeline.summary["python_width_mean"] == np.mean(widths)


def test_plant_in_a_study():
    study = co.Study({
        "cordon": 1,
        "system": {"type": "nonlinear", "states": ["a", "w"], "disturbances": ["d"],
                   "noises": ["e"], "f": ["a + 0.05*w", "w - 0.05*(sin(a) + 0.1*w) + d"],
                   "g": ["a + e"], "X0": co.interval([0.4, -0.1], [0.6, 0.1]),
                   "W": co.interval([-0.001], [0.001]), "V": co.interval([-0.01], [0.01])},
        "data": {"simulate": {"steps": 20, "x0": [0.5, 0]}},
        "pipelines": [{"name": "p", "backend": "zonotope", "observer": "nonlinear"}]})
    assert study.problems() == []
    linear = co.Study({
        "cordon": 1,
        "system": {"type": "lti", "A": [[1, 0.05], [-0.05, 0.995]], "C": [[1, 0]],
                   "X0": co.interval([0.1, -0.1], [0.3, 0.1]),
                   "W": co.interval([-0.001, -0.001], [0.001, 0.001]),
                   "V": co.interval([-0.01], [0.01])},
        "data": {"simulate": {"steps": 20, "x0": [0.2, 0],
                              "plant": {"type": "python_pendulum", "friction": 0.1}}},
        "pipelines": [{"name": "p", "backend": "zonotope", "observer": "prediction_correction"}],
        "metrics": ["contains_truth"]})
    results = linear.run()
    truth = results.truth
    assert truth[1].tolist() == [0.2, 0.0 - 0.05 * np.sin(0.2)]
    assert results["p"].summary["contains_truth_no"] == 0


def test_what_ends_programs_is_not_swallowed(study):
    class Interrupted(Corrected):
        """Is interrupted at k = 3."""

        name = "python_interrupted"

        def advance(self, X, before, now):
            if now.k == 3:
                raise KeyboardInterrupt
            return super().advance(X, before, now)

    co.extend.register(Interrupted)
    study["pipelines"] = pipelines("python_interrupted", "prediction_correction")
    with pytest.raises(KeyboardInterrupt):
        study.run()
    observer = co.Observer.of(study, "python_interrupted")
    with pytest.raises(KeyboardInterrupt):
        observer.estimates(None, np.zeros((9, 1)))


def test_a_class_that_is_written_again_takes_the_place(study):
    def made(shift):
        class Shifted(Corrected):
            """Widens."""

            name = "python_shifted"

            def begin(self, X0, sample):
                return X0 + shift * co.interval([-1, -1], [1, 1])
        return Shifted
    study["pipelines"] = pipelines("python_shifted")
    widths = []
    for shift in (1, 2):
        co.extend.register(made(shift))
        result = study.run(sets="none")["python_shifted"]
        widths.append(result.upper[0, 0] - result.lower[0, 0])
    assert widths == pytest.approx([8, 10])


def test_names_are_taken_once_and_classes_are_checked():
    class Taken(co.extend.Observer):
        """Has a name of the library's."""

        name = "prediction_correction"
    with pytest.raises(co.Error, match="prediction_correction"):
        co.extend.register(Taken)

    class Other(Corrected):
        """Has other parameters than before."""

        parameters = {}
    with pytest.raises(co.Error, match="python_corrected"):
        co.extend.register(Other)
    with pytest.raises(TypeError):
        co.extend.register(int)

    class Nameless(co.extend.Observer):
        pass
    with pytest.raises(ValueError, match="name"):
        co.extend.register(Nameless)

    class Strange(co.extend.Observer):
        """Has a parameter of no kind."""

        name = "python_strange"
        parameters = {"x": co.extend.Parameter("number", "A number")}
    with pytest.raises(co.Error, match="number"):
        co.extend.register(Strange)
    assert is_free("observer", "python_strange")
