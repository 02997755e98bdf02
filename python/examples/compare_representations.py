# SPDX-License-Identifier: GPL-3.0-or-later
"""How tight are the bounds of each representation, and what does a step cost?"""

from pathlib import Path

import cordon as co

STUDIES = Path(__file__).resolve().parents[2] / "examples" / "studies"

study = co.Study(STUDIES / "linear_two_states.json")
results = study.run(progress=True)

for name, pipeline in results.items():
    widths = pipeline.upper - pipeline.lower
    print(f"{name:22} mean width {widths[20:].mean():.4f}")

ax = co.plot.sets(results["Line zonotope"].sets[2:6], label="line zonotope")
co.plot.sets(results["Zonotope"].sets[2:6], ax=ax, facecolor="none", edgecolor=co.plot.PALETTE[1])
ax.set_title("Estimates at k = 2 … 5: exact intersections, and zonotopes around them")
ax.figure.savefig("compare_representations.png", dpi=100)
