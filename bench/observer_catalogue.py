#!/usr/bin/env python3
"""Draws docs/images/observer_catalogue.svg from a run of the catalogue of observers: the width of
every estimate as a multiple of the exact one against the time of a step with its hull.

    cordon run examples/studies/observer_catalogue.json --out results/catalogue --jobs 1
    python3 bench/observer_catalogue.py results/catalogue > docs/images/observer_catalogue.svg
"""
import csv
import math
import sys

FAMILIES = [  # first words of a pipeline's name, what the figure calls it, colour and mark
    (("exact", "constrained"), "constrained zonotopes", "#0072b2", "square"),
    (("zonotope",), "zonotopes cut by strips", "#d55e00", "circle"),
    (("gain_correction", "error_hull"), "gains, outputs up to now", "#009e73", "circle"),
    (("luenberger",), "gains, outputs up to the time before", "#8a6bb1", "square"),
    (("ellipsoid",), "ellipsoids", "#c04f8e", "square"),
    (("boxes",), "boxes", "#5b6573", "circle"),
]
PLANTS = ("2dim", "vehicle_2", "three_states")
LABELS = {  # of the marks that the text speaks of
    "exact": "exact", "constrained 20/5": "20/5", "zonotope bravo n": "bravo n",
    "error_hull kalman": "error_hull", "luenberger steady kalman 30": "steady", "boxes": "boxes",
}
TIMES, WIDTHS = (0.5, 20000.0), (0.9, 35.0)
WIDTH, HEIGHT, LEFT, TOP, GAP = 230, 260, 52, 26, 16


def numbers(directory):
    """Width and time by plant and pipeline."""
    found = {}
    for name in ("summary.csv", "times.csv"):
        with open(f"{directory}/{name}", newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                of = found.setdefault((row["plant"], row["pipeline"]), {})
                if row["mean"]:
                    of[row["measure"]] = float(row["mean"])
    return {key: (of["relative_width_mean"], of["step_us"] + of["hull_us"])
            for key, of in found.items()}


def share(value, ends):
    return math.log(value / ends[0]) / math.log(ends[1] / ends[0])


def mark(shape, x, y, colour):
    if shape == "circle":
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{colour}"/>'
    return f'<rect x="{x - 3.5:.1f}" y="{y - 3.5:.1f}" width="7" height="7" fill="{colour}"/>'


def text(x, y, words, anchor="middle", colour="#33404f", size=11):
    return (f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="{size}" '
            f'fill="{colour}">{words}</text>')


def axes(plant, left):
    yield (f'<rect x="{left}" y="{TOP}" width="{WIDTH}" height="{HEIGHT}" fill="none" '
           'stroke="#8a94a5"/>')
    yield text(left + WIDTH / 2, TOP - 9, plant, size=12)
    for time in (1, 10, 100, 1000, 10000):
        x = left + WIDTH * share(time, TIMES)
        yield (f'<line x1="{x:.1f}" y1="{TOP}" x2="{x:.1f}" y2="{TOP + HEIGHT}" '
               'stroke="#e3e7ec"/>')
        yield text(x, TOP + HEIGHT + 15, f"{time // 1000} ms" if time >= 1000 else f"{time} µs")
    for width in (1, 2, 5, 10, 20):
        y = TOP + HEIGHT * (1 - share(width, WIDTHS))
        yield f'<line x1="{left}" y1="{y:.1f}" x2="{left + WIDTH}" y2="{y:.1f}" stroke="#e3e7ec"/>'
        if plant == PLANTS[0]:
            yield text(left - 6, y + 4, str(width), "end")


def points(found, plant, left):
    for (of, pipeline), (width, time) in sorted(found.items()):
        if of != plant:
            continue
        _, _, colour, shape = next(one for one in FAMILIES if pipeline.startswith(one[0]))
        x = left + WIDTH * share(time, TIMES)
        y = TOP + HEIGHT * (1 - share(width, WIDTHS))
        yield mark(shape, x, y, colour)
        if pipeline in LABELS:
            yield text(x + 6, y - 5, LABELS[pipeline], "start", colour, 9.5)


def figure(found):
    whole = LEFT + len(PLANTS) * (WIDTH + GAP)
    high = TOP + HEIGHT + 58
    yield (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {whole} {high}" '
           f'width="{whole}" height="{high}" role="img" '
           "font-family=\"Helvetica, Arial, 'Liberation Sans', sans-serif\">")
    yield "<title>Width of estimates against the time of a step, observers on three plants</title>"
    yield f'<rect width="{whole}" height="{high}" fill="#ffffff"/>'
    for i, plant in enumerate(PLANTS):
        left = LEFT + i * (WIDTH + GAP)
        yield from axes(plant, left)
        yield from points(found, plant, left)
    y = TOP + HEIGHT / 2
    yield (f'<text transform="translate(16 {y:.1f}) rotate(-90)" text-anchor="middle" '
           'font-size="11" fill="#33404f">width, as a multiple of the exact one</text>')
    x = LEFT
    for _, words, colour, shape in FAMILIES:
        yield mark(shape, x + 4, high - 18, colour)
        yield text(x + 13, high - 14, words, "start")
        x += 24 + 5 * len(words)
    yield "</svg>"


print("\n".join(figure(numbers(sys.argv[1]))))
