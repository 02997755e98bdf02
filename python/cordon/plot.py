# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures with matplotlib, in the colours of the report.

`sets`, `modes` and `tubes` return the axes, `bounds` and `residuals` an array of axes, one for each
state or residual. Each takes the axes to draw in as `ax`.
"""

from __future__ import annotations

from typing import (TYPE_CHECKING, Any, Iterable, List, Mapping, NamedTuple, Optional, Sequence,
                    Tuple, Union)

import numpy as np

from .arguments import array, choice, index, indices, pair, wrong_kind
from .arguments import count as number
from .errors import ArgumentError, Error
from .sets import Set

if TYPE_CHECKING:
    from .design import Design
    from .estimate import Estimate
    from .results import Pipeline, Results

__all__ = ["INK", "PALETTE", "bounds", "modes", "outline", "residuals", "sets", "tubes"]

#: Of the report: told apart with any kind of colour vision.
PALETTE = ["#0072b2", "#d55e00", "#009e73", "#b5548a", "#d99000", "#4ba3dc", "#6b4c9a", "#8a8000"]
INK = "#1b2230"


def __dir__() -> List[str]:
    return __all__


def _axes(ax: Any) -> Any:
    """The axes that were given, or new ones."""
    if ax is not None:
        if not hasattr(ax, "fill_between"):
            wrong_kind("ax", "axes of matplotlib are needed, as matplotlib.pyplot.gca()", ax)
        return ax
    return _rows(None, 1)[0]


def _rows(ax: Any, count: int) -> Any:
    """An array of `count` axes, one below the other: those that were given, or new ones."""
    if ax is not None:
        made = np.array([_axes(one) for one in np.ravel(ax)], dtype=object)
        if len(made) != count:
            raise ArgumentError(f"ax: {count} axes are needed, one for each row, not {len(made)}; "
                                f"they are matplotlib.pyplot.subplots({count})[1]")
        return made
    import matplotlib.pyplot as plt
    _, made = plt.subplots(count, 1, sharex=count > 1, squeeze=False,
                           figsize=(7, 2.2 * count + 1) if count > 1 else None)
    return made[:, 0]


def outline(X: Set, dims: Tuple[int, int] = (0, 1), count: int = 128) -> "np.ndarray[Any, Any]":
    """A polygon, shape (corners, 2), around two coordinates of a bounded set: where lines of
    `count` directions that touch the set meet. It holds the set up to rounding; a polytope's own
    edges are met where `vertices()` can tell them."""
    if not isinstance(X, Set):
        wrong_kind("X", "a cordon set is needed, as cordon.interval([-1, -1], [1, 1])", X)
    first, second = pair(dims, "dims", X.dim)
    count = number(count, "count", 3, 100_000)
    angles = 2 * np.pi * np.arange(count) / count
    directions = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    shadow = np.zeros((2, X.dim))
    shadow[0, first] = shadow[1, second] = 1
    flat = shadow @ X if X.dim != 2 or (first, second) != (0, 1) else X
    if flat.is_empty().yes:
        return np.zeros((0, 2))
    try:
        return flat.vertices()
    except Error:
        pass  # no polytope, or one that is too large
    h = np.array([flat.support(d).value for d in directions])
    if not np.isfinite(h).all():
        raise Error("the set is unbounded in these coordinates, or its bounds are not known; what "
                    "a figure shows of it is a part, X & cordon.interval(lower, upper)",
                    "unsupported")
    following = np.roll(np.arange(count), -1)
    a, b = directions, directions[following]
    det = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    corners = np.stack([h * b[:, 1] - h[following] * a[:, 1],
                        h[following] * a[:, 0] - h * b[:, 0]], axis=1) / det[:, None]
    return np.asarray(corners)


def sets(given: Union[Set, Iterable[Set]], dims: Tuple[int, int] = (0, 1), ax: Any = None,
         **style: Any) -> Any:
    """Sets in two coordinates, each as a polygon around it."""
    if isinstance(given, Set):
        given = [given]
    if isinstance(given, (str, bytes, Mapping)) or not isinstance(given, Iterable):
        wrong_kind("given", "sets are needed, as [cordon.interval([-1, -1], [1, 1])]", given)
    outlines = [outline(X, dims) for X in given]  # before there is a figure
    from matplotlib.patches import Polygon
    ax = _axes(ax)
    look = {"facecolor": (*_rgb(PALETTE[0]), 0.15), "edgecolor": PALETTE[0], **style}
    for corners in outlines:
        if len(corners):
            ax.add_patch(Polygon(corners, closed=True, **look))
    ax.autoscale_view()
    ax.set_xlabel(f"$x_{dims[0] + 1}$")
    ax.set_ylabel(f"$x_{dims[1] + 1}$")
    return ax


class _Band(NamedTuple):
    name: str
    k: Any
    lower: Any
    upper: Any


_DRAWN = ("results, pipelines with an observer, or estimates of one are needed, as study.run() or "
          "observer.estimates(u, y)")


def _bands(given: Any) -> List[_Band]:
    from .estimate import Estimate
    from .results import Pipeline, Results
    if isinstance(given, Pipeline):
        given = [given]
    if isinstance(given, Results):
        given = [found for found in given.values() if "observer" in found.written]
    if not isinstance(given, Iterable) or isinstance(given, (str, bytes, Mapping, Set)):
        wrong_kind("given", _DRAWN, given)
    found = given
    given = list(given)
    if given and all(isinstance(one, Estimate) for one in given):
        k = np.array([one.k for one in given])
        lower, upper = (np.array([getattr(one.hull, side) for one in given])
                        for side in ("lower", "upper"))
        return [_Band("estimate", k, lower, upper)]
    if not given or not all(isinstance(one, Pipeline) for one in given):
        wrong_kind("given", _DRAWN, found)
    return [_Band(one.name, one.k, one.lower, one.upper) for one in given]


def _with_gaps(band: _Band) -> _Band:
    """Nothing is drawn where an estimate is empty: its lower bounds are above its upper ones."""
    lower, upper = band.lower.copy(), band.upper.copy()
    empty = (lower > upper).any(axis=1)
    lower[empty] = upper[empty] = np.nan
    return band._replace(lower=lower, upper=upper)


def bounds(given: Union["Results", "Pipeline", Sequence["Pipeline"], Sequence["Estimate"]],
           states: Optional[Sequence[int]] = None, truth: Any = None, ax: Any = None) -> Any:
    """Bounds of states over time as bands, one for each pipeline of results, or of a list of
    estimates, with the true states where they are known (`truth`, shape (samples, n)); empty
    estimates are gaps. `states` counts from 0; None: all. Returns an array of axes, one per state,
    also where there is one alone."""
    drawn = [_with_gaps(band) for band in _bands(given)]
    sizes = {band.lower.shape[1] for band in drawn}
    if len(sizes) > 1:
        raise ArgumentError("given: the pipelines have different numbers of states, "
                            f"{', '.join(map(str, sorted(sizes)))}; one figure has one number")
    n = sizes.pop()
    truth = (getattr(given, "truth", None) if truth is None else
             array(truth, "truth", (None, n), "(samples, states)"))
    chosen = list(range(n)) if states is None else indices(states, "states", "state", n)
    axes = _rows(ax, len(chosen))
    for one, i in zip(axes, chosen):
        for j, band in enumerate(drawn):
            colour = PALETTE[j % len(PALETTE)]
            one.fill_between(band.k, band.lower[:, i], band.upper[:, i], color=colour, alpha=0.2,
                             linewidth=0)
            one.plot(band.k, band.lower[:, i], color=colour, linewidth=0.8, label=band.name)
            one.plot(band.k, band.upper[:, i], color=colour, linewidth=0.8)
        if truth is not None:
            one.plot(np.arange(len(truth)), truth[:, i], color=INK, linewidth=1, linestyle="--",
                     label="truth")
        one.set_ylabel(f"$x_{i + 1}$")
    axes[0].legend(loc="best", fontsize="small")
    axes[-1].set_xlabel("k")
    return axes


def _modes_of(pipeline: object) -> List[str]:
    """Names of the modes of a pipeline with a diagnoser."""
    from .results import Pipeline
    if not isinstance(pipeline, Pipeline):
        wrong_kind("pipeline", "a pipeline of results is needed, as study.run()['banks']", pipeline)
    if "modes" not in pipeline.written:
        raise ArgumentError(f"pipeline {pipeline.name!r} has no diagnoser, and so no modes that "
                            "data leave")
    return list(pipeline.written["modes"])


def modes(pipeline: "Pipeline", ax: Any = None) -> Any:
    """Which modes are possible over time: a row per mode, dark where it is the only one."""
    names = _modes_of(pipeline)
    ax = _axes(ax)
    k = pipeline.k
    for row, name in enumerate(names):
        possible = np.array([step["modes"][row]["candidate"] for step in pipeline.steps])
        isolated = np.array([step["mode"] == name for step in pipeline.steps])
        for mask, colour, alpha in ((possible, PALETTE[1], 0.55), (isolated, PALETTE[0], 1.0)):
            ax.fill_between(k, row - 0.35, row + 0.35, where=mask, step="mid", color=colour,
                            alpha=alpha, linewidth=0)
    ax.set_yticks(range(len(names)))
    ax.set_yticklabels(names)
    ax.invert_yaxis()
    ax.set_xlabel("k")
    return ax


def residuals(pipeline: "Pipeline", mode: Union[str, int] = 0, ax: Any = None) -> Any:
    """The hull of what has to hold 0 as long as the plant is in a mode. Returns an array of axes,
    one per residual, also where there is one alone."""
    names = _modes_of(pipeline)
    chosen = (names.index(choice(mode, "mode", names)) if isinstance(mode, str) else
              index(mode, "mode", "mode", len(names)))
    found = [step["modes"][chosen].get("residual") for step in pipeline.steps]
    if not any(found):
        raise Error(f"the diagnoser of pipeline {pipeline.name!r} tells no residuals of "
                    f"{names[chosen]!r}", "unsupported")
    size = next(len(box["lower"]) for box in found if box)
    gap = {"lower": [np.nan] * size, "upper": [np.nan] * size}
    lower, upper = (np.array([[float(v) for v in (box or gap)[side]] for box in found])
                    for side in ("lower", "upper"))
    axes = _rows(ax, size)
    for i, one in enumerate(axes):
        one.fill_between(pipeline.k, lower[:, i], upper[:, i], color=PALETTE[0], alpha=0.3)
        one.axhline(0, color=INK, linewidth=0.8)
        one.set_ylabel(f"residual {i + 1}")
    axes[0].set_title(names[chosen])
    axes[-1].set_xlabel("k")
    return axes


def tubes(design: "Design", output: int = 0, ax: Any = None) -> Any:
    """The outputs that each mode can show under a designed input; `output` counts from 0."""
    from .design import Design
    if not isinstance(design, Design):
        wrong_kind("design", "a design is needed, as cordon.designs_of(study)[0]", design)
    tubes_of = [tube for tube in design.outcome.get("tubes", []) if tube.get("outputs")]
    if not tubes_of or design.u is None:
        raise Error(f"the design {design.name!r} tells no output tubes", "unsupported")
    samples = len(design.u) if design.outcome.get("outputs") == "all" else 1
    index(output, "output", "output", len(tubes_of[0]["outputs"]["lower"]) // samples)
    ax = _axes(ax)
    times = np.arange(len(design.u) - samples, len(design.u))
    for j, tube in enumerate(tubes_of):
        lower, upper = (np.array([float(v) for v in tube["outputs"][side]]).reshape(samples, -1)
                        for side in ("lower", "upper"))
        colour = PALETTE[j % len(PALETTE)]
        ax.fill_between(times, lower[:, output], upper[:, output], alpha=0.25, color=colour,
                        label=tube["mode"])
    ax.legend(fontsize="small")
    ax.set_xlabel("k")
    return ax


def _rgb(colour: str) -> Tuple[float, float, float]:
    return tuple(int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5))  # type: ignore[return-value]
