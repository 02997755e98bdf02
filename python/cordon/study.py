# SPDX-License-Identifier: GPL-3.0-or-later
"""Studies: read, changed, checked, run and verified.

    study = cordon.Study("two_tanks.json")
    study["data"]["simulate"]["seed"] = 3
    results = study.run()
    results["Zonotope"].upper
"""

from __future__ import annotations

import copy
import json
import os
import tempfile
import warnings
from pathlib import Path
from typing import (Any, Callable, Dict, Iterator, List, Mapping, MutableMapping, NamedTuple,
                    Optional, Union)

from . import _cordon
from .arguments import choice, count, flag, index, mapping, suggestion, text, wrong_kind
from .errors import Error, InputError, Problem
from .results import Results
from .written import read, to_json

Progress = Callable[[int, int, int], None]


class Study(MutableMapping[str, Any]):
    """A study file (docs/study_format.md) as a dictionary: `Study(path)` reads one,
    `Study({"cordon": 1, ...})` makes one; entries are read and changed as those of dictionaries,
    and may hold arrays and sets. Files that it names are looked for in the folder of `file`."""

    def __init__(self, source: Union[str, "os.PathLike[str]", Mapping[str, Any]],
                 file: Optional["os.PathLike[str]"] = None) -> None:
        if isinstance(source, Mapping):
            self._data: Dict[str, Any] = dict(source)
            self.file = Path(file) if file is not None else Path("study")
            return
        if not isinstance(source, (str, os.PathLike)):
            wrong_kind("source", 'the path of a study is needed, as "study.json", or a dictionary',
                       source)
        self.file = Path(file) if file is not None else Path(source)
        written = Path(source).read_text(encoding="utf-8-sig")
        try:
            self._data = json.loads(written)
        except ValueError:
            _cordon.read_study(written, self.file, [], True, False)  # tells place and reason
            raise
        if not isinstance(self._data, dict):
            _cordon.read_study(written, self.file, [], True, False)

    def __getitem__(self, key: str) -> Any:
        return self._data[key]

    def __setitem__(self, key: str, value: Any) -> None:
        self._data[key] = value

    def __delitem__(self, key: str) -> None:
        del self._data[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._data)

    def __len__(self) -> int:
        return len(self._data)

    def __repr__(self) -> str:
        return f"<cordon.Study {self._data.get('title', self.file)!r}: {', '.join(self.pipelines)}>"

    @property
    def pipelines(self) -> List[str]:
        """Names of the pipelines, as far as they are written."""
        entries = self._data.get("pipelines", [])
        return [str(entry.get("name", f"pipeline {i}")) if isinstance(entry, Mapping) else "?"
                for i, entry in enumerate(entries if isinstance(entries, list) else [])]

    def index_of(self, pipeline: Union[str, int]) -> int:
        """Where a pipeline stands."""
        names = self.pipelines
        if not isinstance(pipeline, str):
            return index(pipeline, "pipeline", "pipeline", len(names))
        if pipeline not in names:
            raise KeyError(f"there is no pipeline {pipeline!r}; {suggestion(pipeline, names)}")
        return names.index(pipeline)

    def copy(self) -> "Study":
        """A copy that is changed by itself."""
        return Study(copy.deepcopy(self._data), self.file)

    def save(self, file: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the study as a file."""
        Path(file).write_text(json.dumps(to_json(self._data), ensure_ascii=False, indent=2) + "\n",
                              encoding="utf-8")

    def checked(self, settings: Mapping[str, Any] = {}, needs_data: bool = True,
                trusts_plugins: bool = False) -> _cordon.Study:
        """The study as the library knows it; raises `InputError` with all problems."""
        example = '{"/data/simulate/seed": 3}'
        written = [f"{text(path, 'a path of settings', '/data/simulate/seed')}="
                   f"{json.dumps(to_json(value, str(path)))}"
                   for path, value in mapping(settings, "settings", example).items()]
        return read(self._data, self.file, written, needs_data, trusts_plugins)

    def problems(self) -> List[Problem]:
        """Everything that is wrong with the study; an empty list: nothing."""
        try:
            self.checked()
        except InputError as error:
            return error.problems
        return []

    def run(self, out: Union[str, "os.PathLike[str]", None] = None, *,
            settings: Mapping[str, Any] = {}, pipeline: str = "", sets: str = "all",
            report: bool = False, progress: Union[bool, Progress] = False) -> Results:
        """Runs the study, as `cordon run` does, and returns the results.

        `out`: their directory, in place of earlier ones; None: a temporary one that goes with the
        results. `settings`: values in other places, {"/data/simulate/seed": 3}. `sets`: "all",
        "last" or "none". `progress`: True for a bar (tqdm where it is installed), or a function of
        (pipeline, done, in all). Ctrl-C ends the run, and leaves earlier results as they were.
        """
        choice(sets, "sets", ["all", "last", "none"])
        text(pipeline, "pipeline", "name of a pipeline")
        flag(report, "report")
        study = self.checked(settings)
        if study.has_sweep:
            raise Error("the study has a sweep: run it by sweep()")
        keeper = tempfile.TemporaryDirectory(prefix="cordon-") if out is None else None
        directory = Path(keeper.name if keeper else out)  # type: ignore[arg-type]
        with _Bar(progress, study.pipelines) as bar:
            told = _cordon.run(study, directory, sets, pipeline, report, bar.tell)
        for found in told["pipelines"]:
            if found["error"]:
                warnings.warn(f"pipeline {found['name']!r} ended with an error: {found['error']}",
                              RuntimeWarning, stacklevel=2)
        if told["report_error"]:
            raise Error(f"the results are complete, but there is no report: {told['report_error']}")
        return Results(directory, keeper)

    def sweep(self, out: Union[str, "os.PathLike[str]"], *, jobs: Optional[int] = None,
              resume: bool = False, report: bool = False,
              progress: Union[bool, Progress] = False) -> "SweepResults":
        """Runs all points of the study's sweep, as `cordon run` does, `jobs` at a time (None: as
        many as there are cores). `resume` goes on after what an interrupted one has left in
        `out`."""
        study = self.checked()
        if not study.has_sweep:
            raise Error("the study has no sweep: run it by run()")
        used = count(jobs, "jobs", 1, 1024) if jobs is not None else os.cpu_count() or 1
        with _Bar(progress, ["points"]) as bar:
            told = _cordon.sweep(study, Path(out), used, flag(resume, "resume"),
                                 flag(report, "report"), bar.tell)
        return SweepResults(Path(out), told["points"], told["failed"], told["violated"])


class SweepResults(NamedTuple):
    """What a sweep has left in `directory`: points.csv and more (docs/sweeps.md)."""

    directory: Path
    points: int
    failed: int
    violated: int

    def frame(self) -> Any:
        """points.csv as a pandas frame."""
        import pandas
        return pandas.read_csv(self.directory / "points.csv", float_precision="round_trip")


class _Bar:
    """Tells how far work is: by a function, by tqdm, or not at all."""

    def __init__(self, progress: Union[bool, Progress], names: List[str]) -> None:
        self._names = names
        self._bar: Any = None
        self._of = -1
        self.tell: Optional[Progress] = None
        if callable(progress):
            self.tell = progress
        elif flag(progress, "progress"):
            self.tell = self._show

    def _show(self, pipeline: int, done: int, total: int) -> None:
        if self._of != pipeline:
            self._close()
            try:
                from tqdm.auto import tqdm
            except ImportError:
                tqdm = None
            self._of = pipeline
            if tqdm is not None:
                self._bar = tqdm(total=total or None, desc=self._names[pipeline])
        if self._bar is not None:
            self._bar.update(done - self._bar.n)

    def _close(self) -> None:
        if self._bar is not None:
            self._bar.close()
            self._bar = None

    def __enter__(self) -> "_Bar":
        return self

    def __exit__(self, *_: object) -> None:
        self._close()
