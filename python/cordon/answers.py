# SPDX-License-Identifier: GPL-3.0-or-later
"""Three-valued answers about sets, with the proof as an object."""

from __future__ import annotations

from typing import TYPE_CHECKING, Optional

from .certificates import Certificate

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


class Answer:
    """Answer to a question about sets: "yes" and "no" on a proof only, else "unknown".

    `certificate` is the proof, where there is one that can be checked again; `witness` a point or a
    direction that shows the answer, where one is known. An answer is no truth value: write
    `answer.yes`, `answer.no` or `answer.unknown`.
    """

    __slots__ = ("status", "certificate", "witness", "question")

    def __init__(self, status: str, certificate: Optional[Certificate] = None,
                 witness: Optional[Floats] = None, question: str = "the question") -> None:
        self.status = status
        self.certificate = certificate
        self.witness = witness
        self.question = question

    @property
    def yes(self) -> bool:
        """Proven."""
        return self.status == "yes"

    @property
    def no(self) -> bool:
        """Proven not to be so."""
        return self.status == "no"

    @property
    def unknown(self) -> bool:
        """Neither is proven."""
        return self.status == "unknown"

    def __bool__(self) -> bool:
        raise TypeError(f"{self.question} is answered by yes, no or unknown, which is no truth "
                        "value: write .yes (proven), .no (proven not to be so), or compare .status")

    def __eq__(self, other: object) -> bool:
        if isinstance(other, bool):
            self.__bool__()
        if isinstance(other, str):
            return self.status == other
        return isinstance(other, Answer) and self.status == other.status

    def __hash__(self) -> int:
        return hash(self.status)

    def __str__(self) -> str:
        return self.status

    def __repr__(self) -> str:
        proof = "" if self.certificate is None else f", by {self.certificate}"
        return f"<{self.question}: {self.status}{proof}>"
