# SPDX-License-Identifier: GPL-3.0-or-later
"""A study's pipeline beside a plant, with alarms (docs/online.md).

    session = cordon.Session(cordon.Study("watch.json"), "bank")
    for u, y in plant:
        for step in session.take(u, y).steps:
            for change in step.alarms:
                print(change.what, change.alarm.text)
"""

from __future__ import annotations

import json
from typing import (TYPE_CHECKING, Any, Dict, List, NamedTuple, Optional, Sequence, Union)

from . import _cordon
from .arguments import array, count, wrong_kind
from .diagnose import Diagnosis
from .errors import ArgumentError
from .estimate import Estimate
from .samples import missing_outputs
from .written import study_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from .study import Study


class Alarm(NamedTuple):
    """What is proven to be wrong: it stands until it is acknowledged and its cause is gone.
    `cause`: "fault" (the nominal mode is excluded), "contradiction" (no state explains the samples)
    or "outlier" (outputs were left out). `text` says in words what is proven, by which samples and
    since when; `proof` is the certificate of the sample that has raised it, as in results.json."""

    cause: str
    raised_at: int
    since: int
    times: int
    active: bool
    acknowledged: bool
    text: str
    proof: Optional[Dict[str, Any]] = None


class AlarmChange(NamedTuple):
    """What has become of an alarm: "raised", "again", "specified", "passed", "acknowledged" or
    "gone"."""

    what: str
    k: int
    alarm: Alarm


class SessionStep(NamedTuple):
    """What a sample has told. Of observers `estimate`, None while one that lags waits for its first
    estimate. Of diagnosers `diagnosis`, and `events`, as results.json has them."""

    k: int
    estimate: Optional[Estimate]
    diagnosis: Optional[Diagnosis]
    events: List[Dict[str, Any]]
    alarms: List[AlarmChange]
    #: Outputs that were left out as outliers.
    left_out: List[int]
    contradiction: Optional[Dict[str, Any]]
    #: The observer has begun anew, after an estimate that was proven empty.
    restarted: bool
    #: Why it has begun anew as formulas had no bounded enclosure; "": it has not.
    not_enclosed: str
    #: Limits of work have left questions open.
    left_open: bool
    #: The seconds that the sample came with.
    t: Optional[float] = None


class Taken(NamedTuple):
    """What became of a sample: "taken", "filled" (times before it were taken without outputs),
    "corrected" (an earlier time was taken again, and all that followed), "late" or "repeated" (it
    was left out); `said` is the rule in words. `steps` are in the order of times."""

    how: str
    said: str
    steps: List[SessionStep]


def _change_of(written: str) -> AlarmChange:
    told: Dict[str, Any] = json.loads(written)
    alarm = Alarm(told["cause"], told["raised_at"], told["since"], told["times"], told["active"],
                  told["acknowledged"], told["text"], told.get("proof"))
    return AlarmChange(told["what"], told["k"], alarm)


def _step_of(told: Dict[str, Any], modes: List[str]) -> SessionStep:
    diagnosis = told.get("diagnosis")
    return SessionStep(
        told["k"],
        Estimate.with_hull(told["estimate"], told.get("hull")) if "estimate" in told else None,
        Diagnosis(diagnosis, modes) if diagnosis is not None else None,
        json.loads(told.get("events", "[]")), [_change_of(one) for one in told["alarms"]],
        told.get("left_out", []), told.get("contradiction"), told.get("restarted", False),
        told.get("not_enclosed", ""), told["left_open"], told["t"])


class Session:
    """A pipeline of a study that takes samples from a plant, by the study's rules ("online") for
    those that come late, twice or not at all. The study needs no data.

    What a step says is what `Study.run` says of the same data, to the last bit. One thread at a
    time; other threads run on while it computes.
    """

    def __init__(self, study: "Study", pipeline: Union[str, int, None] = None) -> None:
        names = study_of(study).pipelines
        if pipeline is None and len(names) > 1:
            raise ArgumentError("pipeline: the study has several, name one of "
                                f"{', '.join(map(repr, names))}")
        place = study.index_of(0 if pipeline is None else pipeline)
        checked = study.checked(needs_data=False)
        self._made = _cordon.Session(checked, checked.pipelines[place])

    def take(self, u: "ArrayLike | None", y: "ArrayLike", k: Optional[int] = None,
             missing: Sequence[int] = (), *, t: Optional[float] = None) -> Taken:
        """Takes the input u_k (None: the model has none) and the outputs y_k of time k; None: of
        the next time. Outputs without a value are named by their indices in `missing`. Where the
        system has a sampling time, `t` may stand in place of k: seconds on the plant's clock, by
        which k is told from the last sample's. Of both, k counts, and the clock is set.

        Raises `Error` for a sample that the rules refuse, and nothing has happened then; an error
        of a component ends the session, as `has_ended` says."""
        time = None if k is None else count(k, "k")
        seconds = None if t is None else float(array(t, "t", (), "() of a number"))
        told = self._made.take(time, u, y, missing_outputs(missing), seconds)
        return Taken(told["how"], told["said"], [_step_of(one, self.modes) for one in told["steps"]])

    def acknowledge(self) -> List[AlarmChange]:
        """Takes note of all alarms that stand."""
        return [_change_of(one) for one in self._made.acknowledge()]

    def start(self) -> List[AlarmChange]:
        """Begins anew. Alarms stay until they are acknowledged; their causes are gone."""
        return [_change_of(one) for one in self._made.start()]

    def save(self) -> bytes:
        """All that later steps depend on, alarms included."""
        return self._made.save()

    def restore(self, saved: bytes) -> None:
        """Goes on from what a session of the same pipeline has saved, bit by bit. Raises `Error`
        for what is damaged, or of another pipeline, study or version."""
        if not isinstance(saved, bytes):
            wrong_kind("saved", "the bytes are needed that save() has returned", saved)
        self._made.restore(saved)

    @property
    def alarms(self) -> List[Alarm]:
        """Those that stand."""
        return [_change_of(one).alarm for one in self._made.alarms]

    @property
    def counts(self) -> Dict[str, int]:
        """How many samples were taken, filled, corrected, late and repeated, and the times that
        were filled."""
        return self._made.counts

    @property
    def k(self) -> Optional[int]:
        """Time of the last sample; None: there has been none."""
        return self._made.last

    @property
    def has_ended(self) -> bool:
        """Has an error of a component ended it? It takes no samples until `start` or `restore`."""
        return self._made.has_ended

    @property
    def pipeline(self) -> str:
        """Its name."""
        return self._made.pipeline

    @property
    def modes(self) -> List[str]:
        """Of a pipeline with a diagnoser: their names, the nominal mode first."""
        return self._made.modes

    def __repr__(self) -> str:
        return f"<cordon.Session {self.pipeline!r}: last sample {self.k}, {len(self.alarms)} alarms>"
