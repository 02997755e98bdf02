# SPDX-License-Identifier: GPL-3.0-or-later
"""Which mode is a plant in? A bank over recorded data, sample by sample."""

from pathlib import Path

import numpy as np

import cordon as co

STUDIES = Path(__file__).resolve().parents[2] / "examples" / "studies"

study = co.Study(STUDIES / "three_tanks_recorded_faults.json")
pipeline = study.pipelines[0]
results = study.run()
data = results.data
u, y = (np.column_stack([values for name, values in data.items() if name.startswith(letter)])
        for letter in ("u_", "y_"))

diagnoser = co.Diagnoser.of(study, pipeline)
before = None
for diagnosis in diagnoser.run(u, y, nan_is_missing=True):
    if (diagnosis.decision, diagnosis.mode) != before:
        print(f"k = {diagnosis.k:4}: {diagnosis.decision} {diagnosis.mode or diagnosis.candidates}")
        before = diagnosis.decision, diagnosis.mode

ax = co.plot.modes(results[pipeline])
ax.set_title("Modes that the data leave; dark: the only one")
ax.figure.tight_layout()
ax.figure.savefig("fault_bank.png", dpi=100)
