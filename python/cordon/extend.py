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
from .arguments import choice, count, flag, mapping, text, told, wrong_kind
from .errors import ArgumentError
from .estimate import Estimate
from .sets import Set


__all__ = ["Law", "LinearModel", "Metric", "Observer", "Parameter", "Plant", "Sample", "conform",
           "register"]


def __dir__() -> List[str]:
    return __all__


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
        wrong_kind("register", "a class that derives from Observer, Metric or Plant is needed",
                   component)
    sentence = (component.__doc__ or "").strip().split("\n")[0].rstrip(".")
    if not component.name or not sentence:
        raise ArgumentError(f"{component.__name__} needs a `name`, and a docstring of its own")
    where = f"{component.__name__}.parameters"
    example = '{"gain": Parameter("real", "Gain of the error", 0.5, 0, 1)}'
    parameters = [_checked(f"{where}[{name!r}]", text(name, where, "gain"), given)
                  for name, given in mapping(component.parameters, where, example).items()]
    _cordon.register_type(component.kind, component, text(component.name, "name", "my_observer"),
                          sentence, parameters)
    return component


#: Of parameters by kind: what a default is, and an example of one.
_DEFAULTS: Dict[str, Tuple[Tuple[type, ...], str]] = {
    "integer": ((int, np.integer), "an integer"),
    "real": ((int, float, np.integer, np.floating), "a number"),
    "flag": ((bool, np.bool_), "True or False"), "text": ((str,), "a text"),
    "choice": ((str,), "one of the choices"),
}
_KINDS = [*_DEFAULTS, "vector", "matrix", "set"]


def _checked(where: str, name: str, p: object) -> Tuple[Any, ...]:
    """What a parameter is registered by."""
    if not isinstance(p, Parameter):
        wrong_kind(where, 'a Parameter is needed, as Parameter("integer", "What it is for", 3)', p)
    choice(p.kind, f"{where}, kind", _KINDS)
    text(p.doc, f"{where}, doc", "What it is for")
    kinds, needed = _DEFAULTS.get(p.kind, ((), ""))
    is_bool = isinstance(p.default, (bool, np.bool_)) and p.kind != "flag"
    if kinds and p.default is not None and (is_bool or not isinstance(p.default, kinds)):
        wrong_kind(f"{where}, default", f"{needed} is needed", p.default)
    if not kinds and p.default is not None:
        raise ArgumentError(f"{where}, default: a {p.kind} has none; take None, and look in "
                            "`settings` whether it is there")
    if p.kind == "choice" and (not p.choices or p.default not in p.choices):
        raise ArgumentError(f"{where}: a choice has `choices`, and one of them is its default")
    for limit, value in (("lowest", p.lowest), ("highest", p.highest)):
        if isinstance(value, bool) or not isinstance(value, _DEFAULTS["real"][0]):
            wrong_kind(f"{where}, {limit}", "a number is needed", value)
    return (name, p.kind, p.doc, p.default, float(p.lowest), float(p.highest), list(p.choices),
            flag(p.required, f"{where}, required"))


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
    if tell is not None and not callable(tell):
        wrong_kind("tell", "a function of a text is needed, as print", tell)
    found = [Law(*result) for result in _cordon.conform(
        choice(kind, "kind", _cordon.kinds()), text(name, "name", "prediction_correction"),
        parameters, text(laws, "laws", "*"), count(seed, "seed"), count(cases, "cases", 1))]
    if not found:
        raise ArgumentError(f"laws: none of the laws of {kind}s is called {laws!r}; '*' is all of "
                            "them (docs/conformance.md)")
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
        raise TypeError(f"a cordon set is to be returned, not {told(X)}")
    return X._set
