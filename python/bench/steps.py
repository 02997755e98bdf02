# SPDX-License-Identifier: GPL-3.0-or-later
"""What a step from Python costs beside the work of the library, and what threads gain.

    PYTHONPATH=build/python/package python3 python/bench/steps.py
"""

import statistics
import subprocess
import sys
import threading
import time

import numpy as np

import cordon as co


def model(n=3, outputs=2, seed=1):
    rng = np.random.default_rng(seed)
    A = rng.normal(size=(n, n))
    A *= 0.9 / np.abs(np.linalg.eigvals(A)).max()
    return co.Model(A=A, B=rng.normal(size=(n, 1)), C=rng.normal(size=(outputs, n)),
                    X0=co.interval(-np.ones(n), np.ones(n)),
                    W=co.interval(-0.01 * np.ones(n), 0.01 * np.ones(n)),
                    V=co.interval(-0.1 * np.ones(outputs), 0.1 * np.ones(outputs)))


def overhead(steps=20_000):
    """µs of a step beside the phases that the library has timed: medians over steps."""
    observer = co.Observer("luenberger", model(), backend="zonotope", gain="kalman",
                           max_generators=20)
    u, y = np.zeros(1), np.zeros(2)
    whole, inside = [], []
    for _ in range(steps):
        begin = time.perf_counter()
        observer.step(u, y)
        whole.append((time.perf_counter() - begin) * 1e6)
        inside.append(sum(observer.times.values()))
    return statistics.median(whole), statistics.median(inside)


def run(steps, generators=60):
    observer = co.Observer("prediction_correction", model(), backend="zonotope",
                           max_generators=generators)
    observer.estimates(np.zeros((steps, 1)), np.zeros((steps, 2)))


def speed_up(steps=4000, count=8):
    """Time of `count` observers one after another, over that of as many threads."""
    begin = time.perf_counter()
    for _ in range(count):
        run(steps)
    alone = time.perf_counter() - begin
    threads = [threading.Thread(target=run, args=(steps,)) for _ in range(count)]
    begin = time.perf_counter()
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return alone / (time.perf_counter() - begin)


def import_time():
    code = "import time; t = time.perf_counter(); import cordon; print(time.perf_counter() - t)"
    return statistics.median(float(subprocess.run([sys.executable, "-c", code], check=True,
                                                  capture_output=True, text=True).stdout)
                             for _ in range(10))


if __name__ == "__main__":
    whole, inside = overhead()
    print(f"a step: {whole:.2f} µs, of which the library's phases {inside:.2f} µs")
    print(f"8 threads: {statistics.median(speed_up() for _ in range(3)):.2f} times as fast as one")
    print(f"import: {import_time() * 1e3:.0f} ms")
