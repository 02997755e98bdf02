# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures with matplotlib, in the colours of the report. Each function returns the axes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from .errors import Error
from .sets import Set

if TYPE_CHECKING:
    from .design import Design
    from .estimate import Estimate
    from .results import Pipeline, Results

#: Of the report: told apart with any kind of colour vision.
PALETTE = ["#0072b2", "#d55e00", "#009e73", "#b5548a", "#d99000", "#4ba3dc", "#6b4c9a", "#8a8000"]
INK = "#1b2230"


def _axes(ax: Any, count: int = 1) -> Any:
    import matplotlib.pyplot as plt
    if ax is not None:
        return ax
    _, made = plt.subplots(count, 1, sharex=count > 1, squeeze=False,
                           figsize=(7, 2.2 * count + 1) if count > 1 else None)
    return made[:, 0] if count > 1 else made[0, 0]


def outline(X: Set, dims: Tuple[int, int] = (0, 1), count: int = 128) -> "np.ndarray[Any, Any]":
    """A polygon, shape (corners, 2), around two coordinates of a bounded set: where lines of
    `count` directions that touch the set meet. It holds the set up to rounding; a polytope's own
    edges are met where `vertices()` can tell them."""
    angles = 2 * np.pi * np.arange(count) / count
    directions = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    shadow = np.zeros((2, X.dim))
    shadow[0, dims[0]] = shadow[1, dims[1]] = 1
    flat = shadow @ X if X.dim != 2 or tuple(dims) != (0, 1) else X
    if flat.is_empty().yes:
        return np.zeros((0, 2))
    try:
        return flat.vertices()
    except Error:
        pass  # no polytope, or one that is too large
    h = np.array([flat.support(d).value for d in directions])
    if not np.isfinite(h).all():
        raise Error("the set is unbounded in these coordinates, or its bounds are not known")
    following = np.roll(np.arange(count), -1)
    a, b = directions, directions[following]
    det = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    corners = np.stack([h * b[:, 1] - h[following] * a[:, 1],
                        h[following] * a[:, 0] - h * b[:, 0]], axis=1) / det[:, None]
    return np.asarray(corners)


def sets(given: Sequence[Set], dims: Tuple[int, int] = (0, 1), ax: Any = None,
         **style: Any) -> Any:
    """Sets in two coordinates, each as a polygon around it."""
    from matplotlib.patches import Polygon
    ax = _axes(ax)
    look = {"facecolor": (*_rgb(PALETTE[0]), 0.15), "edgecolor": PALETTE[0], **style}
    for X in given:
        corners = outline(X, dims)
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


def _bands(given: Any) -> List[_Band]:
    from .estimate import Estimate
    from .results import Pipeline, Results
    if isinstance(given, Pipeline):
        given = [given]
    if isinstance(given, Results):
        given = [found for found in given.values() if "observer" in found.written]
    given = list(given)
    if given and all(isinstance(one, Estimate) for one in given):
        k = np.array([one.k for one in given])
        lower, upper = (np.array([getattr(one.hull, side) for one in given])
                        for side in ("lower", "upper"))
        return [_Band("estimate", k, lower, upper)]
    if not given or not all(isinstance(one, Pipeline) for one in given):
        raise TypeError("bounds are drawn of results, of pipelines, or of a list of estimates")
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
    estimates are gaps. `states` counts from 0; None: all. One pair of axes per state."""
    truth = getattr(given, "truth", None) if truth is None else np.asarray(truth)
    drawn = [_with_gaps(band) for band in _bands(given)]
    chosen = list(range(drawn[0].lower.shape[1])) if states is None else list(states)
    axes = np.atleast_1d(_axes(ax, len(chosen)))
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
    return axes[0] if len(axes) == 1 else axes


def modes(pipeline: "Pipeline", ax: Any = None) -> Any:
    """Which modes are possible over time: a row per mode, dark where it is the only one."""
    names: List[str] = list(pipeline.written["modes"])
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
    """The hull of what has to hold 0 as long as the plant is in a mode, one pair of axes per
    residual."""
    names: List[str] = list(pipeline.written["modes"])
    index = names.index(mode) if isinstance(mode, str) else mode
    found = [step["modes"][index].get("residual") for step in pipeline.steps]
    if not any(found):
        raise Error("the diagnoser tells no residuals")
    size = next(len(box["lower"]) for box in found if box)
    gap = {"lower": [np.nan] * size, "upper": [np.nan] * size}
    lower, upper = (np.array([[float(v) for v in (box or gap)[side]] for box in found])
                    for side in ("lower", "upper"))
    axes = np.atleast_1d(_axes(ax, size))
    for i, one in enumerate(axes):
        one.fill_between(pipeline.k, lower[:, i], upper[:, i], color=PALETTE[0], alpha=0.3)
        one.axhline(0, color=INK, linewidth=0.8)
        one.set_ylabel(f"residual {i + 1}")
    axes[0].set_title(names[index])
    axes[-1].set_xlabel("k")
    return axes[0] if len(axes) == 1 else axes


def tubes(design: "Design", output: int = 0, ax: Any = None) -> Any:
    """The outputs that each mode can show under a designed input; `output` counts from 0."""
    tubes_of = [tube for tube in design.outcome.get("tubes", []) if tube.get("outputs")]
    if not tubes_of or design.u is None:
        raise Error("the design tells no output tubes")
    ax = _axes(ax)
    samples = len(design.u) if design.outcome.get("outputs") == "all" else 1
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
