#!/usr/bin/env python3
"""Prints a study of chains of tanks of growing length, every third level measured: the time of a
step against the number of states.

    python3 bench/tank_chain.py > chain.json && cordon run chain.json --out results/chain
"""
import json

LENGTHS = (5, 10, 20, 50, 100)


def box(half, count, center=0.0):
    return {"type": "box", "lower": [center - half] * count, "upper": [center + half] * count}


def chain(n):
    f = ["x1 + h*(u - a*sqrt(x1)) + w1"]
    f += [f"x{i} + h*a*(sqrt(x{i - 1}) - sqrt(x{i})) + w{i}" for i in range(2, n + 1)]
    measured = range(2, n + 1, 3)
    return {
        "type": "nonlinear",
        "states": [f"x{i}" for i in range(1, n + 1)], "inputs": ["u"],
        "disturbances": [f"w{i}" for i in range(1, n + 1)],
        "noises": [f"v{i}" for i in measured],
        "parameters": {"h": 0.5, "a": 0.06644},
        "f": f,
        "g": [f"x{i} + v{i}" for i in measured],
        "X0": box(2, n, 20.0), "W": box(0.001, n), "V": box(0.2, len(measured)),
    }


study = {
    "cordon": 1,
    "title": "Chains of tanks by formulas: a step against the number of states",
    "system": chain(LENGTHS[0]),
    "data": {"simulate": {"steps": 60, "seed": 1, "input": [{"type": "constant", "offset": 0.3}]}},
    "pipelines": [
        {"name": "interval", "backend": "interval",
         "observer": {"type": "nonlinear", "method": "interval", "max_generators": 400}},
        {"name": "zonotope",
         "backend": {"type": "zonotope", "strip": "segment", "reduction": "girard"},
         "observer": {"type": "nonlinear", "max_generators": 400}},
    ],
    "metrics": ["radius", "contains_truth", "step_time"],
    "sweep": [{"name": "tanks", "path": "/system", "values": [chain(n) for n in LENGTHS],
               "labels": [str(n) for n in LENGTHS]}],
}
print(json.dumps(study, indent=1))
