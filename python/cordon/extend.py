# SPDX-License-Identifier: GPL-3.0-or-later
"""Observers, metrics and plants that are written in Python, for studies of the same process.

    @co.extend.register
    class Boxes(co.extend.Observer):
        '''Predicts, and cuts by the outputs.'''

        name = "my_boxes"

        def begin(self, X0, sample):
            return X0.correct(self.model.C, sample.y, self.model.Dv @ self.model.V)

        def advance(self, X, before, now):
            ...

The first line of the class's docstring is what tables and messages say of it.
`co.conform("my_boxes", kind="observer")` checks the laws that observers keep.
"""

from __future__ import annotations

from typing import (Any, Callable, ClassVar, Dict, List, Mapping, NamedTuple, Optional, Sequence,
                    Tuple, Type, TypeVar)

import numpy as np

from . import _cordon
from .answers import Answer
from .estimate import Estimate
from .sets import Set


class Parameter(NamedTuple):
    """A parameter of a component: `kind` is "integer", "real", "flag", "choice", "text", "vector",
    "matrix" or "set"; `doc` one sentence, with unit and meaning of the limits. Without a default,
    and not required, it is left out of the keyword arguments where a study does not give it."""

    kind: str
    doc: str
    default: Any = None
    lowest: float = -np.inf
    highest: float = np.inf
    choices: Sequence[str] = ()
    required: bool = False


class Sample(NamedTuple):
    """What is known at time k; outputs of `missing` have no value, and are NaN in y."""

    k: int
    u: "np.ndarray[Any, Any]"
    y: "np.ndarray[Any, Any]"
    missing: List[int]


class LinearModel(NamedTuple):
    """Matrices and sets of the model; E and F have no entries where there are none."""

    A: "np.ndarray[Any, Any]"
    B: "np.ndarray[Any, Any]"
    Bw: "np.ndarray[Any, Any]"
    C: "np.ndarray[Any, Any]"
    D: "np.ndarray[Any, Any]"
    Dv: "np.ndarray[Any, Any]"
    E: "np.ndarray[Any, Any]"
    F: "np.ndarray[Any, Any]"
    X0: Set
    W: Set
    V: Set


class _Component:
    kind: ClassVar[str]
    name: ClassVar[str] = ""  #: snake_case, unique among components of its kind
    parameters: ClassVar[Mapping[str, Parameter]] = {}


class Observer(_Component):
    """Derive, and define `begin` and `advance`. What is raised there ends the pipeline with an
    error; a ValueError of `__init__` is a problem of the study."""

    kind = "observer"
    #: "exact" only if each set is all that model and data allow, where operations are exact.
    claim: ClassVar[str] = "outer"
    #: Does each estimate hold all successors of the one before that fit the samples?
    follows_its_sets: ClassVar[bool] = False
    #: Does it take samples with missing outputs?
    takes_missing_outputs: ClassVar[bool] = False
    #: Does it take E x⁺ = A x + … as well? Otherwise such models are refused.
    takes_descriptors: ClassVar[bool] = False
    #: Do estimates use the outputs of their time?
    uses_outputs_of_its_time: ClassVar[bool] = True

    def __init__(self, model: LinearModel, representation: str, **parameters: Any) -> None:
        if model.E.size and not self.takes_descriptors:
            raise ValueError("systems with a matrix E are not taken")
        self.model = model
        self.representation = representation
        self.settings = parameters

    def begin(self, X0: Set, sample: Sample) -> Set:
        """The states of the first sample's time, of those in X0."""
        raise NotImplementedError

    def advance(self, X: Set, before: Sample, now: Sample) -> Set:
        """The states of time now.k, of those in X at before.k."""
        raise NotImplementedError

    @classmethod
    def _made(cls, blocks: Dict[str, Any], representation: str, parameters: Dict[str, Any]) -> Any:
        model = LinearModel(**{name: _as_set(value) for name, value in blocks.items()})
        return cls(model, representation, **_with_sets(parameters))

    def _begin(self, X0: Any, sample: Tuple[Any, ...]) -> Any:
        return _returned(self.begin(Set(X0), Sample(*sample)))

    def _advance(self, X: Any, before: Tuple[Any, ...], now: Tuple[Any, ...]) -> Any:
        return _returned(self.advance(Set(X), Sample(*before), Sample(*now)))


class Metric(_Component):
    """Derive, and define `step` and `summary`: numbers or words by name, always the same names."""

    kind = "metric"

    def __init__(self, **parameters: Any) -> None:
        self.settings = parameters

    def step(self, estimate: Estimate, lower: "np.ndarray[Any, Any]", upper: "np.ndarray[Any, Any]",
             truth: "Optional[np.ndarray[Any, Any]]") -> Dict[str, Any]:
        """The values of one step; lower > upper where the estimate is empty."""
        raise NotImplementedError

    def summary(self) -> Dict[str, Any]:
        """The values of the run so far."""
        raise NotImplementedError

    @classmethod
    def _made(cls, parameters: Dict[str, Any]) -> Any:
        return cls(**_with_sets(parameters))

    def _step(self, k: int, made: Any, answer: Any, hull: Any, truth: Any) -> Dict[str, Any]:
        lower, upper = hull
        return self.step(Estimate(k, made, answer), lower, upper, truth)


class Plant(_Component):
    """Derive, and define `next` and `output`: what is simulated in place of the model."""

    kind = "plant"
    states: int = 0
    inputs: int = 0
    outputs: int = 0

    def __init__(self, **parameters: Any) -> None:
        self.settings = parameters

    def next(self, k: int, x: "np.ndarray[Any, Any]", u: "np.ndarray[Any, Any]") -> Any:
        """x_{k+1}, shape (states,)."""
        raise NotImplementedError

    def output(self, k: int, x: "np.ndarray[Any, Any]", u: "np.ndarray[Any, Any]") -> Any:
        """y_k without noise, shape (outputs,)."""
        raise NotImplementedError

    @classmethod
    def _made(cls, parameters: Dict[str, Any]) -> Any:
        return cls(**_with_sets(parameters))


Made = TypeVar("Made", bound=Type[Any])


def register(component: Made) -> Made:
    """Makes a class known to studies of this process, by its `name`; a decorator. A name is taken
    for as long as the process lives."""
    bases = (Observer, Metric, Plant)
    is_one: bool = isinstance(component, type) and issubclass(component, bases)
    if not is_one:
        raise TypeError("register takes a class that derives from Observer, Metric or Plant")
    sentence = (component.__doc__ or "").strip().split("\n")[0].rstrip(".")
    if not component.name or not sentence:
        raise ValueError(f"{component.__name__} needs a `name`, and a docstring of its own")
    parameters = [(name, p.kind, p.doc, p.default, p.lowest, p.highest, list(p.choices), p.required)
                  for name, p in component.parameters.items()]
    _cordon.register_type(component.kind, component, component.name, sentence, parameters)
    return component


class Law(NamedTuple):
    """What became of a law: "passed", "failed" (with the reason and the smallest failing case) or
    "skipped"."""

    law: str
    status: str
    reason: str
    cases: int
    refused: int
    witness: str


def conform(name: str, kind: str = "observer", *, laws: str = "*", seed: int = 1, cases: int = 80,
            tell: Optional[Callable[[str], None]] = None, **parameters: Any) -> List[Law]:
    """Checks the laws of a kind on random systems, as `cordon conform` does, in this process: a
    component that crashes or hangs takes the process along. `tell` hears of each law that
    failed."""
    found = [Law(*result) for result in _cordon.conform(kind, name, parameters, laws, seed, cases)]
    for law in found:
        if tell is not None and law.status == "failed":
            tell(f"{law.law}: {law.reason}\n{law.witness}")
    return found


def _as_set(value: Any) -> Any:
    return Set(value) if isinstance(value, _cordon.ConvexSet) else value


def _with_sets(parameters: Dict[str, Any]) -> Dict[str, Any]:
    return {name: _as_set(value) for name, value in parameters.items()}


def _returned(X: Any) -> Any:
    if not isinstance(X, Set):
        raise TypeError(f"a cordon set is to be returned, not {type(X).__name__}")
    return X._set
