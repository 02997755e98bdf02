# SPDX-License-Identifier: GPL-3.0-or-later
"""What there is: the names of the package, components and their parameters."""

import json
import re
import shutil
import subprocess
import sys

import numpy as np
import pytest
from conftest import REPOSITORY
from test_estimate import mass

import cordon as co


def test_names_of_the_package():
    version = re.search(r"project\(cordon VERSION ([0-9.]+)",
                        (REPOSITORY / "CMakeLists.txt").read_text(encoding="utf-8")).group(1)
    assert co.__version__ == version
    assert "plot" in dir(co) and "info" in dir(co)
    assert set(dir(co)) == {*co.__all__, "__doc__", "__version__"}
    for name in dir(co):
        assert getattr(co, name) is not None
        assert not name.startswith("_") or name.startswith("__")
    assert "np" not in dir(co.plot) and "bounds" in dir(co.plot)
    assert "Any" not in dir(co.extend) and "Observer" in dir(co.extend)
    with pytest.raises(AttributeError, match="no attribute 'List'"):
        co.List
    code = "import sys; from cordon import *; plot.PALETTE; print('matplotlib' in sys.modules)"
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert told.stdout == "False\n"


def test_every_component_tells_its_parameters():
    for kind in ("backend", "observer", "diagnoser", "designer", "gain", "metric", "plant"):
        assert co.components(kind)
        for name in co.components(kind):
            found = co.info(kind, name)
            assert (found.kind, found.name) == (kind, name) and found.summary
            assert found.summary in str(found)
            for parameter in found.parameters.values():
                assert parameter.doc and f"{parameter.name}: {parameter.type}" in str(found)


def test_parameters_are_those_of_the_command():
    program = shutil.which("cordon")
    if program is None:
        pytest.skip("there is no program beside the package")
    for kind, name in (("observer", "prediction_correction"), ("backend", "zonotope"),
                       ("diagnoser", "consistency_bank"), ("gain", "h_infinity")):
        told = subprocess.run([program, "info", name, "--json"], capture_output=True, text=True,
                              check=True)
        theirs = next(one for one in json.loads(told.stdout)["components"] if one["kind"] == kind)
        mine = co.info(kind, name)
        assert (mine.summary, mine.details) == (theirs["summary"], theirs["details"])
        assert list(mine.parameters) == [one["name"] for one in theirs["params"]]
        for one in theirs["params"]:
            parameter = mine.parameters[one["name"]]
            assert (parameter.type, parameter.doc) == (one["type"], one["doc"])
            assert parameter.required == one["required"]
            if "default" in one:
                assert parameter.default == (float(one["default"]) if parameter.type == "real" else
                                             one["default"])
            else:
                assert parameter.default is None
            for limit in ("lowest", "highest"):
                assert limit not in one or getattr(parameter, limit) == float(one[limit])
            assert parameter.choices == one.get("choices", [])


def test_components_of_python_are_known_too():
    class Told(co.extend.Metric):
        """Tells nothing."""

        name = "python_told"
        parameters = {"scale": co.extend.Parameter("real", "Unit of what is told", 0.5, 0, 1)}
    co.extend.register(Told)
    found = co.info("metric", "python_told")
    assert (found.summary, found.plugin) == ("Tells nothing", "")
    assert str(found.parameters["scale"]) == (
        "scale: real, default 0.5, [0, 1]\n    Unit of what is told")


def test_what_objects_say_of_themselves(examples):
    observer = co.Observer("prediction_correction", mass(), backend="interval")
    observer.step([0], [0])
    assert repr(observer) == (
        "<observer prediction_correction: 2 states, interval, next sample k = 1>")
    diagnoser = co.Diagnoser.of(co.Study(examples / "two_tank_leak.json"), "intervals")
    assert repr(diagnoser).startswith("<diagnoser ") and "healthy" in repr(diagnoser)
    assert repr(np.eye(2) @ co.point([1, 2])).startswith("<zonotope in R^2")
