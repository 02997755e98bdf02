# SPDX-License-Identifier: GPL-3.0-or-later
"""Set-based observers, sample by sample.

    observer = cordon.Observer("prediction_correction", model, max_generators=20)
    for estimate in observer.run(u, y):
        print(estimate.k, estimate.hull.lower, estimate.hull.upper)
"""

from __future__ import annotations

from typing import (TYPE_CHECKING, Any, Dict, Iterator, List, Mapping, NamedTuple, Optional,
                    Sequence, Tuple, Union)

from . import _cordon
from .answers import Answer
from .arguments import count, flag
from .certificates import Certificate, Statement
from .samples import missing_outputs, samples
from .sets import Hull, Set, _set
from .written import Model, component_json, pipeline_of, read

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from .study import Study


class Estimate:
    """What a sample has told: `set` holds every state of time `k` that model, bounds and the data
    so far allow. `consistent.no`: the set is proven empty, so that the data contradict them."""

    __slots__ = ("k", "set", "_answer", "_hull")

    def __init__(self, k: int, made: _cordon.ConvexSet, answer: Any) -> None:
        self.k = k
        self.set = Set(made)
        self._answer = answer
        self._hull: Optional[Hull] = None

    @classmethod
    def with_hull(cls, told: Tuple[Any, ...], hull: Optional[Tuple[Any, ...]]) -> "Estimate":
        """Of a session, which has computed the hull already where the set is not empty."""
        estimate = cls(*told)
        if hull is not None:
            estimate._hull = estimate.set._hull_of(*hull)
        return estimate

    @property
    def consistent(self) -> Answer:
        """Is the set not empty?"""
        status: str = self._answer[0]
        statement = Statement.of_emptiness(self.set, "yes" if status == "no" else "no")
        certificate = Certificate.of(self._answer[1], statement) if status != "unknown" else None
        return Answer(status, certificate, question="consistent")

    @property
    def hull(self) -> Hull:
        """The bounds of every state, computed when first asked for."""
        if self._hull is None:
            self._hull = self.set.hull()
        return self._hull

    def __repr__(self) -> str:
        return f"<estimate of time {self.k}: {self.set}, consistent: {self._answer[0]}>"


class Gain(NamedTuple):
    """A gain that an observer works with, shape (n, outputs)."""

    name: str
    type: str
    L: "NDArray[np.float64]"


class Observer:
    """An observer of a model: `type`, and its parameters, as `cordon info` lists them; wrong ones
    raise `InputError` with a suggestion. `backend` is the representation of its sets: a name, or a
    dictionary with parameters, {"type": "zonotope", "rounding": "outward"}.

    One thread at a time; other threads run on while it computes.
    """

    def __init__(self, type: str, model: Model, backend: Union[str, Mapping[str, Any]] = "zonotope",
                 **parameters: Any) -> None:
        pipeline = {"name": "observer", "backend": component_json(backend, where="backend"),
                    "observer": component_json(type, parameters, "observer")}
        study = Model.given(model).study([pipeline])
        self._made = _cordon.Observer(read(study, needs_data=False), 0)

    @classmethod
    def of(cls, study: "Study", pipeline: Union[str, int] = 0) -> "Observer":
        """The observer of a study's pipeline."""
        observer = object.__new__(cls)
        observer._made = _cordon.Observer(*pipeline_of(study, pipeline))
        return observer

    def start(self, X0: Optional[Set] = None, k: int = 0) -> None:
        """Begins anew at time k, from X0 in place of the model's initial set."""
        self._made.start(None if X0 is None else _set(X0, "X0"), count(k, "k"))

    def step(self, u: "ArrayLike | None", y: "ArrayLike", missing: Sequence[int] = ()) -> Estimate:
        """Takes the sample of the next time: the input u_k (None: the model has none) and the
        outputs y_k. Outputs without a value are named by their indices in `missing`; NaN elsewhere
        is refused."""
        return Estimate(*self._made.step(u, y, missing_outputs(missing)))

    def run(self, u: "ArrayLike | None", y: "ArrayLike",
            nan_is_missing: bool = False) -> Iterator[Estimate]:
        """Steps over rows: u of shape (samples, inputs) or None, y of shape (samples, outputs).
        With `nan_is_missing`, outputs that are NaN are missing ones."""
        return (self.step(*sample) for sample in samples(u, y, nan_is_missing))

    def estimates(self, u: "ArrayLike | None", y: "ArrayLike",
                  nan_is_missing: bool = False) -> List[Estimate]:
        """Takes all rows in one go, as `run` does one by one, and returns all estimates: the way
        for long records, and for several observers in threads, which wait for each other
        otherwise."""
        missing = flag(nan_is_missing, "nan_is_missing")
        return [Estimate(*found) for found in self._made.estimates(u, y, missing)]

    def replace(self, X: Set) -> None:
        """Replaces the set of states at the time of the last sample."""
        self._made.replace(_set(X, "X"))

    @property
    def k(self) -> int:
        """Time of the next sample."""
        return self._made.next

    @property
    def lag(self) -> int:
        """By how many samples estimates lag."""
        return self._made.lag

    @property
    def gains(self) -> List[Gain]:
        """The gains it works with."""
        return [Gain(*gain) for gain in self._made.gains]

    @property
    def times(self) -> Dict[str, float]:
        """Of the last step, in µs: predict, correct, reduce, question."""
        return self._made.times

    @property
    def contradiction(self) -> Optional[Dict[str, Any]]:
        """What the data contradict, since the observer began: of the first sample whose estimate is
        proven empty, or the last one of which outputs were left out. None: nothing."""
        return self._made.contradiction

    def __repr__(self) -> str:
        made = self._made
        return (f"<observer {made.type}: {made.states} states, {made.backend}, next sample k = "
                f"{made.next}>")

    @property
    def left_out(self) -> List[int]:
        """Outputs of the last sample that were left out as outliers."""
        return self._made.left_out
