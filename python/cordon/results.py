# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run has left, as arrays: the same numbers as in its files, bit by bit."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, Iterator, List, Mapping, NamedTuple, Optional, Union

import numpy as np

from . import _cordon
from .arguments import count, suggestion, wrong_kind
from .errors import ArgumentError, Error
from .sets import Set

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .study import SweepResults

    Floats = NDArray[np.float64]


def _number(value: Any) -> float:
    return np.nan if value is None else float(value)  # "inf" and "-inf" are texts there


def _column(values: List[Any]) -> Any:
    """An array of numbers where they are numbers; of objects where they are texts or answers."""
    if all(value is None or (isinstance(value, (int, float)) and not isinstance(value, bool)) or
           value in ("inf", "-inf") for value in values):
        return np.array([_number(value) for value in values])
    return np.array(values, dtype=object)


def _bounds(steps: List[Dict[str, Any]], key: str, side: str) -> "Floats":
    return np.array([[_number(bound) for bound in step[key][side]] for step in steps])


class Pipeline:
    """What became of one pipeline. `summary` has its numbers by name, `steps` the steps as they are
    in results.json."""

    def __init__(self, results: "Results", found: Dict[str, Any]) -> None:
        self._results = results
        self.written = found
        self.name: str = found["name"]
        self.backend: str = found["backend"]
        self.summary: Dict[str, Any] = {name: float(value) if value in ("inf", "-inf") else value
                                        for name, value in found["summary"].items()}
        self.steps: List[Dict[str, Any]] = found.get("steps", [])

    @property
    def k(self) -> "NDArray[np.int64]":
        """Times of the steps, shape (steps,)."""
        return np.array([step["k"] for step in self.steps], dtype=np.int64)

    @property
    def lower(self) -> "Floats":
        """Lower bounds of the states, shape (steps, n)."""
        return self._hull("lower")

    @property
    def upper(self) -> "Floats":
        """Upper bounds of the states, shape (steps, n)."""
        return self._hull("upper")

    def _hull(self, side: str) -> "Floats":
        if "observer" not in self.written:
            raise Error(f"pipeline \"{self.name}\" has no observer, and so no bounds of all states")
        return _bounds(self.steps, "hull", side)

    def column(self, name: str) -> Any:
        """What the steps have under a name ("radius", "consistent", "decision", …): an array of
        numbers, or of objects."""
        known = sorted({key for step in self.steps for key in step})
        if name not in known:
            raise KeyError(f"steps have no {name!r}; they have {', '.join(known)}" if known else
                           "the run has kept no steps")
        return _column([step.get(name) for step in self.steps])

    @property
    def sets(self) -> List[Set]:
        """The estimates' sets, as far as the run has kept them. Of a representation whose sets have
        no exact form, as ellipsoids, sets that hold them."""
        return [Set(_cordon.ConvexSet.of_view(*arguments)) for arguments in self._written_sets()]

    def _written_sets(self) -> Iterator[Any]:
        file = self._results.directory / "sets.jsonl"
        if not file.exists():
            return
        with open(file, encoding="utf-8") as lines:
            for line in lines:
                written = json.loads(line)
                if written["pipeline"] == self.name:
                    exact = written["exchange"] == "exact" and written["tightness"] == "exact"
                    yield _blocks(written), "exact" if exact else "outer", self.backend, {}

    def frame(self) -> Any:
        """The steps as a pandas frame with the columns of steps.csv."""
        import pandas
        rows = pandas.read_csv(self._results.directory / "steps.csv", float_precision="round_trip")
        return rows[rows["pipeline"] == self.name].dropna(axis="columns", how="all")

    def __repr__(self) -> str:
        return f"<pipeline {self.name!r}: {self.backend}, {len(self.steps)} steps>"


def _blocks(written: Mapping[str, Any]) -> Dict[str, Any]:
    n, rows = written["dim"], len(written["b"])
    shapes = {"M": (n, written["lines"]), "G": (n, written["generators"]),
              "S": (rows, written["lines"]), "A": (rows, written["generators"])}
    blocks: Dict[str, Any] = {name: np.array(written[name], dtype=float).reshape(shape)
                              for name, shape in shapes.items()}
    blocks["c"] = np.array(written["c"], dtype=float)
    blocks["b"] = np.array(written["b"], dtype=float)
    if written.get("h"):
        blocks["H"] = np.array(written["H"], dtype=float).reshape(len(written["h"]), n)
        blocks["h"] = np.array(written["h"], dtype=float)
    return blocks


class Results(Mapping[str, Pipeline]):
    """The results of a run in `directory`, by the names of its pipelines."""

    def __init__(self, directory: Union[str, "os.PathLike[str]"], keeper: Any = None) -> None:
        self.directory = Path(directory)
        self._keeper = keeper  # of a temporary directory
        with open(self.directory / "results.json", encoding="utf-8") as file:
            self.written: Dict[str, Any] = json.load(file)
        self.title: str = self.written["title"]
        self._pipelines = {found["name"]: Pipeline(self, found)
                           for found in self.written["pipelines"]}

    def __getitem__(self, name: str) -> Pipeline:
        if name not in self._pipelines:
            names = list(self._pipelines)
            raise KeyError(f"there is no pipeline {name!r}; {suggestion(str(name), names)}")
        return self._pipelines[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._pipelines)

    def __len__(self) -> int:
        return len(self._pipelines)

    @property
    def data(self) -> Dict[str, Any]:
        """The columns of data.csv: k, u_1, …, y_1, …, x_1, …; NaN where a field is empty."""
        with open(self.directory / "data.csv", encoding="utf-8") as file:
            names = [name.split(" ")[0] for name in file.readline().rstrip("\n").split(",")]
            rows = [line.rstrip("\n").split(",") for line in file]
        return {name: np.array([float(row[i]) if row[i] else np.nan for row in rows])
                for i, name in enumerate(names)}

    @property
    def truth(self) -> Optional["Floats"]:
        """The true states, shape (samples, n), where they are known."""
        columns = [values for name, values in self.data.items() if name.startswith("x_")]
        return np.column_stack(columns) if columns else None

    def verify(self, every: int = 1, progress: Any = None) -> Dict[str, Any]:
        """Checks every `every`-th step again, as `cordon verify` does: per pipeline how many checks
        held and how many stayed undecided, and the first "violation", None where there is none."""
        if progress is not None and not callable(progress):
            wrong_kind("progress", "a function of (pipeline, done, in all) is needed, or None",
                       progress)
        return _cordon.verify(self.directory, count(every, "every", 1), progress)

    def summary(self) -> Any:
        """A pandas frame with the numbers of all pipelines (summary.csv)."""
        import pandas
        return pandas.read_csv(self.directory / "summary.csv", float_precision="round_trip")

    def __repr__(self) -> str:
        return f"<results of {self.title!r}: {', '.join(self._pipelines)}>"


class ComparedNumber(NamedTuple):
    """A number of a pipeline in one of several runs: its mean over repetitions, at how many points
    it differs from that of the first run, and its ratio to it (NaN: none). `significant`, of
    measured times: it differs by more than the noise of machines."""

    number: str
    measured: bool
    pipeline: str
    at: List[str]  #: values of the sweep's axes, as JSON
    run: int
    mean: float
    different: int
    ratio: float
    significant: bool


class Comparison(NamedTuple):
    """Finished runs or sweeps side by side, as `cordon compare` puts them."""

    runs: List[str]
    axes: List[str]
    rows: List[ComparedNumber]
    warnings: List[str]

    @property
    def different(self) -> List[ComparedNumber]:
        """Numbers that are not those of the first run; times are told apart by `significant`."""
        return [row for row in self.rows if row.different > 0 and not row.measured]

    def frame(self) -> Any:
        """The rows as a pandas frame."""
        import pandas
        return pandas.DataFrame(self.rows, columns=ComparedNumber._fields)


def compare(*results: Union["Results", "SweepResults", str, "os.PathLike[str]"]) -> Comparison:
    """Compares two or more finished runs or sweeps, by names of pipelines and values of axes."""
    directories = []
    for one in results:
        where = getattr(one, "directory", one)  # of runs and of sweeps
        if not isinstance(where, (str, os.PathLike)):
            wrong_kind("results", "finished runs are needed, or their directories", one)
        directories.append(Path(where))
    if len(directories) < 2:
        raise ArgumentError(f"results: two or more are compared, here there are {len(directories)}")
    told = _cordon.compare(directories)
    return Comparison(told["runs"], told["axes"], [ComparedNumber(*row) for row in told["rows"]],
                      told["warnings"])
