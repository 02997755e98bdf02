# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of Python as studies write them: arrays, sets and components as JSON."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import _cordon
from .arguments import told, wrong_kind
from .errors import ArgumentError, ArgumentTypeError, Error
from .sets import Set

if TYPE_CHECKING:
    from .study import Study


def set_json(X: Set) -> Dict[str, Any]:
    """A set as studies write sets: with an exact form, or one of "polytope", whose numbers are
    rounded outward where they are none of 64 bits."""
    if X._bounds is not None:
        return {"type": "box", **{name: to_json(bound) for name, bound in
                                  zip(("lower", "upper"), X._bounds)}}
    view = X.view()
    if X.representation == "polytope":
        if view["h"].size > 0:
            return {"type": "polytope", "H": view["H"].tolist(), "h": view["h"].tolist()}
    elif view["claim"] != "exact" or view["h"].size > 0:
        raise Error(f"a set of \"{X.representation}\" has no exact form that a study could hold: "
                    "take an enclosure, X.as_(\"constrained_zonotope\")", "unsupported")
    made: Dict[str, Any] = {"type": "zonotope", "center": view["c"].tolist()}
    if view["G"].shape[1]:
        made["generators"] = view["G"].tolist()
    if view["M"].shape[1]:
        made["lines"] = view["M"].tolist()
    if view["b"].size:
        made["b"] = view["b"].tolist()
        for name in ("A", "S"):
            if view[name].shape[1]:
                made[name] = view[name].tolist()
    if "lines" in made:
        made["type"] = "line_zonotope"
    elif "b" in made:
        made["type"] = "constrained_zonotope"
    return made


def to_json(value: Any, where: str = "") -> Any:
    """What JSON holds, of arrays, sets, numbers, texts, lists and dictionaries. Infinite numbers
    become the texts that bounds of boxes have; NaN and what is no number raise."""
    if isinstance(value, Set):
        return set_json(value)
    if value is None or isinstance(value, (bool, str)):
        return value
    if isinstance(value, (np.bool_,)):
        return bool(value)
    if isinstance(value, (int, np.integer)):
        return int(value)
    if isinstance(value, (float, np.floating)):
        number = float(value)
        if math.isnan(number):
            raise ArgumentError(f"{where or 'a value'} is NaN; a study holds none", "not_finite")
        return number if math.isfinite(number) else "inf" if number > 0 else "-inf"
    if isinstance(value, np.ndarray):
        if value.dtype.kind not in "fiub":
            raise ArgumentTypeError(f"{where or 'an array'}: real numbers are needed, not "
                                    f"{value.dtype}")
        return to_json(value.tolist(), where)
    if isinstance(value, Mapping):
        return {str(key): to_json(entry, f"{where}/{key}") for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [to_json(entry, f"{where}/{i}") for i, entry in enumerate(value)]
    if hasattr(value, "to_json"):
        return value.to_json()
    raise ArgumentTypeError(f"{where or 'a value'}: {told(value)} is nothing that a study holds; "
                            "numbers, texts, arrays, sets, lists and dictionaries are")


def component_json(component: Union[str, Mapping[str, Any]], parameters: Mapping[str, Any] = {},
                   where: str = "") -> Any:
    """A component by its name, or as {"type": …}, with parameters; None leaves one out."""
    if not isinstance(component, (str, Mapping)):
        wrong_kind(where, 'a name is needed, or {"type": name} with parameters', component)
    written = dict(component) if isinstance(component, Mapping) else {"type": component}
    written.update({name: value for name, value in parameters.items() if value is not None})
    return to_json(written, where)


def read(study: Mapping[str, Any], file: Optional[Path] = None, settings: Sequence[str] = (),
         needs_data: bool = True, trusts_plugins: bool = False) -> _cordon.Study:
    """The study as the library knows it; every problem of it at once in `InputError.problems`."""
    text = json.dumps(to_json(study), ensure_ascii=False, allow_nan=False, indent=1)
    return _cordon.read_study(text, file if file is not None else Path("study"), list(settings),
                              needs_data, trusts_plugins)


def study_of(given: object) -> "Study":
    """What is given for a study, if it is one."""
    from .study import Study
    if not isinstance(given, Study):
        wrong_kind("study", 'a cordon.Study is needed, as cordon.Study("study.json")', given)
    return given


def pipeline_of(study: "Study", pipeline: Union[str, int]) -> Tuple[_cordon.Study, int]:
    """A study as the library knows it, and where a pipeline stands."""
    return study_of(study).checked(needs_data=False), study.index_of(pipeline)


class Model:
    """A system and its bounds, from what studies write in "system" (docs/study_format.md):

        x⁺ = A x + B u + Bw w,   y = C x + D u + Dv v,   x₀ ∈ X0, w ∈ W, v ∈ V

    Matrices have the shapes given there; sets are `cordon` sets, or dictionaries as in studies.
    `type` is "descriptor" where there is an E, "nonlinear" where there are formulas `f`, else
    "lti".
    Wrong arguments raise `InputError` where the model is used, and by `check()`. Of a set of
    "polytope" the model has an enclosure, larger by rounding only.

        model = cordon.Model(A=[[1, 0.1], [0, 1]], C=[[1, 0]], X0=cordon.interval([-1, -1], [1, 1]),
                             W=cordon.interval([-0.01, -0.02], [0.01, 0.02]),
                             V=cordon.interval([-0.1], [0.1]))
    """

    def __init__(self, *, type: Optional[str] = None, **system: Any) -> None:
        if type is None:
            type = "descriptor" if "E" in system else "nonlinear" if "f" in system else "lti"
        self.system: Dict[str, Any] = to_json(
            {"type": type, **{name: value for name, value in system.items() if value is not None}},
            "system")

    @staticmethod
    def given(model: object) -> "Model":
        """What is given for a model, if it is one."""
        if not isinstance(model, Model):
            wrong_kind("model", "a cordon.Model is needed, as cordon.Model(A=[[1]], C=[[1]], ...); "
                       "of a dictionary it is cordon.Model(**system)", model)
        return model

    def to_json(self) -> Dict[str, Any]:
        """The "system" of a study."""
        return self.system

    def study(self, pipelines: List[Dict[str, Any]], **more: Any) -> Dict[str, Any]:
        """A study of this model with these pipelines."""
        return {"cordon": 1, "system": self.system, "pipelines": pipelines, **more}

    def check(self) -> None:
        """Raises `InputError` with every problem of the model."""
        pipeline = {"name": "check", "backend": "line_zonotope",
                    "observer": "nonlinear" if self.system["type"] == "nonlinear" else "descriptor"}
        read(self.study([pipeline]), needs_data=False)

    def __repr__(self) -> str:
        return f"<cordon.Model {self.system['type']}: {', '.join(self.system)}>"
