# SPDX-License-Identifier: GPL-3.0-or-later
"""An input that makes the modes of two tanks differ, whatever the disturbances are."""

from pathlib import Path

import cordon as co

STUDIES = Path(__file__).resolve().parents[2] / "examples" / "studies"

design = co.designs_of(co.Study(STUDIES / "active_diagnosis_two_tanks.json"), "designed")[0]
print(design)
print("separated, proven over the rationals:", design.separates)
print("u =", design.u.ravel())

ax = co.plot.tubes(design)
ax.set_title("What each mode can show under the designed input")
ax.figure.savefig("designed_input.png", dpi=100)
