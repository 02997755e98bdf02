# SPDX-License-Identifier: GPL-3.0-or-later
"""Fault diagnosis: which of the modes of a plant do the data leave?"""

from __future__ import annotations

import json
from typing import (TYPE_CHECKING, Any, Dict, Iterator, List, Mapping, NamedTuple, Optional,
                    Sequence, Union)

from . import _cordon
from .arguments import count, flag
from .samples import missing_outputs, samples
from .sets import Set
from .written import Model, component_json, pipeline_of, read

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from .study import Study


class FaultBound(NamedTuple):
    """Proven bounds of an additive fault at time `at`; `fault` counts columns of F from 0."""

    fault: int
    at: int
    lower: float
    upper: float
    estimate: float


class Diagnosis:
    """What is known after a sample. `decision`: "monitoring" (`mode` is the only one that is not
    excluded, or was assumed), "isolating", "ambiguous" or "unknown_fault". A mode is excluded on a
    proof only."""

    __slots__ = ("k", "decision", "mode", "since", "reset", "suggested", "candidates", "faults",
                 "estimate", "evidence")

    def __init__(self, found: Dict[str, Any], modes: List[str]) -> None:
        self.k: int = found["k"]
        self.decision: str = found["decision"]
        self.mode: Optional[str] = modes[found["mode"]] if found["mode"] >= 0 else None
        self.since: int = found["since"]
        self.reset: bool = found["reset"]
        hint: int = found["suggested"]
        self.suggested: Optional[str] = modes[hint] if hint >= 0 else None
        #: Names of the modes that are not excluded.
        self.candidates: List[str] = [name for name, mode in zip(modes, found["modes"])
                                      if mode["candidate"]]
        self.faults = [FaultBound(*bound) for bound in found["faults"]]
        self.estimate: Optional[Set] = None if found["estimate"] is None else Set(found["estimate"])
        #: By mode: "candidate", "consistent" ("yes", "no", "unknown"), perhaps "residual".
        self.evidence: Dict[str, Dict[str, Any]] = {
            name: {**mode, "consistent": mode["consistent"][0]}
            for name, mode in zip(modes, found["modes"])}

    def __repr__(self) -> str:
        what = self.mode if self.mode is not None else ", ".join(self.candidates)
        return f"<diagnosis at {self.k}: {self.decision}{': ' if what else ''}{what}>"


class Diagnoser:
    """A diagnoser of the modes of a model (`Model(..., modes=[...])`), with parameters by the names
    of studies.

        diagnoser = cordon.Diagnoser("consistency_bank", model, backend="constrained_zonotope",
                                     observer={"type": "prediction_correction"})
    """

    def __init__(self, type: str, model: Model, backend: Union[str, Mapping[str, Any]] = "zonotope",
                 **parameters: Any) -> None:
        pipeline = {"name": "diagnoser", "backend": component_json(backend, where="backend"),
                    "diagnoser": component_json(type, parameters, "diagnoser")}
        study = Model.given(model).study([pipeline])
        self._made = _cordon.Diagnoser(read(study, needs_data=False), 0)

    @classmethod
    def of(cls, study: "Study", pipeline: Union[str, int] = 0) -> "Diagnoser":
        """The diagnoser of a study's pipeline."""
        diagnoser = object.__new__(cls)
        diagnoser._made = _cordon.Diagnoser(*pipeline_of(study, pipeline))
        return diagnoser

    @property
    def modes(self) -> List[str]:
        """Names, the nominal mode first."""
        return self._made.modes

    @property
    def k(self) -> int:
        """Time of the next sample."""
        return self._made.next

    def start(self, k: int = 0) -> None:
        """Begins anew at time k, in the nominal mode."""
        self._made.start(count(k, "k"))

    def step(self, u: "ArrayLike | None", y: "ArrayLike", missing: Sequence[int] = ()) -> Diagnosis:
        """Takes the sample of the next time, as `Observer.step` does."""
        return Diagnosis(self._made.step(u, y, missing_outputs(missing)), self.modes)

    def run(self, u: "ArrayLike | None", y: "ArrayLike",
            nan_is_missing: bool = False) -> Iterator[Diagnosis]:
        """Steps over rows, as `Observer.run` does."""
        return (self.step(*sample) for sample in samples(u, y, nan_is_missing))

    def diagnoses(self, u: "ArrayLike | None", y: "ArrayLike",
                  nan_is_missing: bool = False) -> List[Diagnosis]:
        """Takes all rows in one go, as `Observer.estimates` does."""
        missing, modes = flag(nan_is_missing, "nan_is_missing"), self.modes
        return [Diagnosis(found, modes) for found in self._made.diagnoses(u, y, missing)]

    def guarantees(self) -> Optional[Dict[str, Any]]:
        """What can be said before any experiment (docs/results_format.md); None: nothing."""
        found = self._made.guarantees()
        return None if found is None else json.loads(found)

    def __repr__(self) -> str:
        made = self._made
        return (f"<diagnoser {made.type}: modes {', '.join(made.modes)}, {made.backend}, next "
                f"sample k = {made.next}>")
