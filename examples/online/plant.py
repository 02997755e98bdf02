#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Three tanks that send a line per sample to standard output: the plant of three_tanks.json.

    python3 plant.py --steps 1000 --leak 500 | cordon stream three_tanks.json --pipeline supervision

Gauges drop out at random, and now and then the line is down for some samples, during which the
pumps go on as they are; what a gauge has measured may come late. With the same seed the plant sends
the same, whatever part of it was taken already.
"""
import argparse
import json
import math
import random
import sys
import time


class Tanks:
    """x⁺ = A x + B u + w, y = x + v, and a leak in the middle tank from some time on."""

    def __init__(self, leak, seed):
        self.levels = [0.1, -0.1, 0.05]
        self.leak = leak
        self.random = random.Random(seed)
        self.pumps = [0.0, 0.0]

    def sample(self, k, is_down):
        """(u, y) of time k; moves on to the next."""
        if not is_down:
            self.pumps = [0.6 if k % 80 < 40 else -0.6, 0.4 * math.sin(0.1 * k)]
        u, draw = self.pumps, self.random.uniform
        y = [level + draw(-0.01, 0.01) for level in self.levels]
        a, b, c = self.levels
        w = [draw(-0.001, 0.001) for _ in range(3)]
        lost = 0.03 * draw(0.5, 1)
        self.levels = [
            0.94 * a + 0.04 * b + 0.03 * u[0] + w[0],
            0.04 * a + 0.9 * b + 0.04 * c + w[1] - (lost if k >= self.leak else 0),
            0.04 * b + 0.93 * c + 0.03 * u[1] + w[2],
        ]
        return u, y


def samples(steps, leak, dropouts, seed):
    """(k, samples that are sent then): that of k, perhaps without outputs, and late ones."""
    tanks, chance = Tanks(leak, seed), random.Random(seed + 1)
    late, down_until = [], -1
    for k in range(steps):
        if 0 < k and down_until < k and chance.random() < 0.01:
            down_until = k + chance.randint(0, 4)
        u, y = tanks.sample(k, k <= down_until)
        sent = [None if chance.random() < dropouts else value for value in y]
        if k > 0 and None in sent and chance.random() < 0.3:
            late.append((k + chance.randint(1, 4), {"k": k, "u": u, "y": y}))
        now = [] if k <= down_until else [{"k": k, "u": u, "y": sent}]
        if k > down_until:
            now += [sample for due, sample in late if due <= k]
            late = [(due, sample) for due, sample in late if due > k]
        yield k, now


def with_time(sample, begin):
    """Seconds in place of k, on a clock that runs 50 ppm fast."""
    return {"t": begin + 5 * 1.00005 * sample["k"], "u": sample["u"], "y": sample["y"]}


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--steps", type=int, default=1000, help="samples [1000]")
    options.add_argument("--leak", type=int, default=500, help="the leak begins at this k [500]")
    options.add_argument("--dropouts", type=float, default=0.3, help="share of outputs [0.3]")
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--skip", type=int, default=0, help="lines that were taken already [0]")
    options.add_argument("--every", type=float, default=0, help="seconds between samples [0]")
    options.add_argument("--clock", type=float, help="send seconds in place of k, from this time on")
    given = options.parse_args()
    try:
        count = 0
        for _, sent in samples(given.steps, given.leak, given.dropouts, given.seed):
            for sample in sent:
                if given.clock is not None:
                    sample = with_time(sample, given.clock)
                count += 1
                if count > given.skip:
                    print(json.dumps(sample), flush=True)
            if count > given.skip:
                time.sleep(given.every)
    except (BrokenPipeError, KeyboardInterrupt):
        sys.stderr.close()


if __name__ == "__main__":
    main()
