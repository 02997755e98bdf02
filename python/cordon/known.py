# SPDX-License-Identifier: GPL-3.0-or-later
"""What components there are, and what they say of themselves: `cordon list` and `cordon info`.

    print(cordon.info("observer", "prediction_correction"))
    cordon.info("backend", "zonotope").parameters["rounding"].default
"""

from __future__ import annotations

import math
import textwrap
from typing import Any, Dict, List, NamedTuple

from . import _cordon
from .arguments import choice, text


class ParameterInfo(NamedTuple):
    """A parameter of a component. `type` is "integer", "real", "flag", "choice", "text", "vector",
    "matrix", "matrices", "set" or "component"; `default` is None where there is none, and the
    parameter is left out unless it is `required`. Numbers lie between `lowest` and `highest`;
    `choices` are those of a choice, `kind` that of a component."""

    name: str
    type: str
    doc: str
    required: bool
    default: Any
    lowest: float
    highest: float
    choices: List[str]
    kind: str
    takes_matrix: bool  #: a matrix stands for a component
    takes_at_most: bool  #: {"at_most": n} stands for an integer

    @property
    def range(self) -> str:
        """The values that it takes, as text."""
        if self.type == "component":
            return self.kind + (", or a matrix" if self.takes_matrix else "")
        if self.type == "choice":
            return " | ".join(self.choices)
        if self.type not in ("integer", "real"):
            return ""
        widest = 2.0**63 if self.type == "integer" else math.inf
        below, above = abs(self.lowest) < widest, abs(self.highest) < widest
        if below and above:
            most = ', or {"at_most": …}' if self.takes_at_most else ""
            return f"[{self.lowest:.17g}, {self.highest:.17g}]{most}"
        return (f"≥ {self.lowest:.17g}" if below else f"≤ {self.highest:.17g}" if above else "")

    def __str__(self) -> str:
        value = ("required" if self.required else
                 "no default" if self.default is None else f"default {_written(self.default)}")
        head = ", ".join(part for part in (self.type, value, self.range) if part)
        return f"{self.name}: {head}\n" + textwrap.fill(self.doc, 96, initial_indent="    ",
                                                        subsequent_indent="    ")


class ComponentInfo(NamedTuple):
    """A component: what it does in a sentence, then at length, the key of its source in the
    literature, and its parameters by name."""

    kind: str
    name: str
    plugin: str
    summary: str
    citation: str
    details: str
    parameters: Dict[str, ParameterInfo]

    def __str__(self) -> str:
        parts = [f"{self.kind} {self.name}" + (f" (plugin {self.plugin})" if self.plugin else ""),
                 self.summary]
        if self.citation:
            parts.append(f"Source: {self.citation}")
        if self.details:
            parts += ["", self.details.rstrip("\n")]
        parts += ["", *(map(str, self.parameters.values()) if self.parameters else
                        ["It takes no parameters."])]
        return "\n".join(parts)


def _written(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def components(kind: str) -> List[str]:
    """Names of the components of a kind: "backend", "observer", "diagnoser", "designer", "gain",
    "metric" or "plant"."""
    return _cordon.components(choice(kind, "kind", _cordon.kinds()))


def info(kind: str, name: str) -> ComponentInfo:
    """What a component says of itself, as `cordon info` does: print it, or read its parameters."""
    found = _cordon.info(choice(kind, "kind", _cordon.kinds()), text(name, "name", "zonotope"))
    parameters = {one["name"]: ParameterInfo(**one) for one in found.pop("parameters")}
    return ComponentInfo(**found, parameters=parameters)
