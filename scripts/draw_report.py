#!/usr/bin/python3
"""Draws the points of a report and the cycles of one symmetry as an SVG picture.

    draw_report.py REPORT.json OUT.svg [--symmetry ID]

Grey dots are all points, coloured lines the cycles, joined in order; closed cycles are closed. The view is oblique.
Needs only the standard library.
"""
import argparse
import json
import math
from xml.sax.saxutils import escape

# Okabe and Ito's palette: told apart by colour-blind readers, too.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"]
WIDTH, HEIGHT, MARGIN = 900, 520, 40


def view(p, axis_up=0.45, turn=0.6):
    """Parallel projection: turned about z, tilted towards the viewer."""
    x, y, z = (list(p) + [0.0])[:3]
    u = x * math.cos(turn) - y * math.sin(turn)
    v = x * math.sin(turn) + y * math.cos(turn)
    return u, v * axis_up + z * math.sqrt(1 - axis_up * axis_up)


def to_page(points):
    flat = [view(p) for p in points]
    low = [min(p[k] for p in flat) for k in (0, 1)]
    high = [max(p[k] for p in flat) for k in (0, 1)]
    scale = min((WIDTH - 2 * MARGIN) / max(1e-300, high[0] - low[0]),
                (HEIGHT - 3 * MARGIN) / max(1e-300, high[1] - low[1]))
    left = (WIDTH - scale * (high[0] - low[0])) / 2
    return [(left + scale * (x - low[0]), HEIGHT - 1.6 * MARGIN - scale * (y - low[1])) for x, y in flat]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("report")
    parser.add_argument("out")
    parser.add_argument("--symmetry", type=int, default=1)
    options = parser.parse_args()
    with open(options.report, encoding="utf-8") as file:
        report = json.load(file)
    symmetry = next(s for s in report["symmetries"] if s["id"] == options.symmetry)
    page = to_page(report["points"])
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif">',
             f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>']
    lines += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="#9a9a9a"/>' for x, y in page]
    for k, cycle in enumerate(symmetry["cycles"]):
        colour = COLOURS[k % len(COLOURS)]
        path = " ".join(f"{page[i][0]:.1f},{page[i][1]:.1f}" for i in cycle["points"])
        shape = "polygon" if cycle["closed"] else "polyline"
        lines.append(f'<{shape} points="{path}" fill="none" stroke="{colour}" stroke-width="2.5"/>')
        lines += [f'<circle cx="{page[i][0]:.1f}" cy="{page[i][1]:.1f}" r="5" fill="{colour}"/>'
                  for i in cycle["points"]]
    iso = symmetry["isometry"]
    words = [f'{symmetry["type"]}', f'order {symmetry["order"]}' if symmetry["order"] else "",
             f'{iso["angle_deg"]:.4g}°' if iso["angle_deg"] else "", f'step {iso["step"]:.5g}' if iso["step"] else "",
             f'{len(symmetry["cycles"])} cycles', f'significance {symmetry["significance"]:.0f}']
    title = f'{report["input"]["path"]}: ' + ", ".join(w for w in words if w)
    lines.append(f'<text x="{MARGIN}" y="{HEIGHT - 14}" font-size="17" fill="#333333">{escape(title)}</text>')
    lines.append("</svg>")
    with open(options.out, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
