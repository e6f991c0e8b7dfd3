#!/usr/bin/env python3
"""The faces of segments by GEOS, through shapely: for benches/faces.rs and tests/faces/reference.csv.

Usage: faces_geos.py FAMILY:FILE... [--times N] [--exact]

Each FILE holds 32-bit little-endian integers, four a segment (x, y, x, y) in steps of the 0.1 mm grid.
Prints a line of comma-separated values for each, see COLUMNS. Times are processor times, medians over N runs
(default 1) of `unary_union` and `polygonize` together, with the segments already in shapely's form.

- plain: `unary_union`, nodes in full precision. Its faces differ from ours by slivers below the grid.
- snapped: `unary_union(grid_size=1)`, nodes snap-rounded to the grid as ours are. Coordinates are whole,
  so that areas and the sums below are exact. All columns but the times are of these faces.

With --exact all columns but the times are of edges that are snap-rounded here, pair by pair, in rational
arithmetic, and given to `polygonize`. GEOS cuts segments at crossings in floating point before it looks
for the pixels they meet, and so takes a segment that runs exactly through a pixel's corner now as meeting
it, now as not: with segments of a few grid steps that happens, and both results are consistent.

The sums (64-bit FNV-1a) are over sorted items, so that they do not depend on the order of faces:
`areas` over the doubled areas, `rings` over the faces with all their rings, less nodes in the middle of a
straight piece, from each ring's smallest point, outer rings counter-clockwise and holes clockwise.
"""
import statistics
import sys
import time
from fractions import Fraction
from math import floor

import numpy as np
import shapely

COLUMNS = "family,segments,faces,holes,doubled_area,areas,rings,plain_ms,snapped_ms,plain_faces"
MASK = (1 << 64) - 1


def fnv(items):
    """FNV-1a over sorted items, each a tuple of integers written as 8 little-endian bytes."""
    total = 0xCBF29CE484222325
    for item in sorted(items):
        for value in item:
            for byte in (value & MASK).to_bytes(8, "little"):
                total = ((total ^ byte) * 0x100000001B3) & MASK
    return total


def ring_points(ring, clockwise):
    points = [(int(x), int(y)) for x, y in shapely.get_coordinates(ring)[:-1]]
    bent = []
    for i, (x, y) in enumerate(points):
        (px, py), (nx, ny) = points[i - 1], points[(i + 1) % len(points)]
        if (x - px) * (ny - y) != (y - py) * (nx - x):
            bent.append((x, y))
    if (doubled_area(bent) < 0) != clockwise:
        bent.reverse()
    start = bent.index(min(bent))
    return bent[start:] + bent[:start]


def doubled_area(points):
    return sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(points, points[1:] + points[:1]))


def faces_of(lines, grid_size):
    start = time.process_time()
    union = shapely.unary_union(lines, grid_size=grid_size)
    faces = shapely.polygonize([union])
    return time.process_time() - start, faces


def meets(segment, pixel):
    """Whether a segment meets a pixel, a square of side 1 with its left and lower sides only: exactly."""
    (ax, ay), (bx, by) = segment
    low, high = (Fraction(0), False), (Fraction(1), False)  # Parameter, and whether it is excluded.
    for start, step, centre in ((ax, bx - ax, pixel[0]), (ay, by - ay, pixel[1])):
        least, most = centre - Fraction(1, 2), centre + Fraction(1, 2)
        if step == 0:
            if not least <= start < most:
                return False
            continue
        enter, leave = ((least - start) / step, False), ((most - start) / step, True)
        if step < 0:
            enter, leave = leave, enter
        low = max(low, enter)
        high = min(high, leave, key=lambda end: (end[0], not end[1]))
    return low[0] < high[0] or (low[0] == high[0] and not low[1] and not high[1])


def exact_edges(lines, ends):
    """The edges of the snap-rounded segments."""
    segments = [tuple(map(tuple, pair)) for pair in ends.tolist()]
    hot = {end for pair in segments if pair[0] != pair[1] for end in pair}
    tree = shapely.STRtree(lines)
    for i, j in tree.query(lines).T.tolist():
        ((ax, ay), (bx, by)), ((cx, cy), (dx, dy)) = segments[i], segments[j]
        whole = (bx - ax) * (dy - cy) - (by - ay) * (dx - cx)
        if i >= j or whole == 0:
            continue
        s = Fraction((cx - ax) * (dy - cy) - (cy - ay) * (dx - cx), whole)
        t = Fraction((cx - ax) * (by - ay) - (cy - ay) * (bx - ax), whole)
        if 0 <= s <= 1 and 0 <= t <= 1:
            half = Fraction(1, 2)
            hot.add((floor(ax + s * (bx - ax) + half), floor(ay + s * (by - ay) + half)))
    hot = sorted(hot)
    chains = [[] for _ in segments]
    for node, i in tree.query(shapely.points(np.array(hot, dtype=float))).T.tolist():
        if segments[i][0] != segments[i][1] and meets(segments[i], hot[node]):
            chains[i].append(hot[node])
    edges = set()
    for ((ax, ay), (bx, by)), chain in zip(segments, chains):
        chain.sort(key=lambda p: ((p[0] - ax) * (bx - ax), (p[1] - ay) * (by - ay)))
        edges.update((min(p, q), max(p, q)) for p, q in zip(chain, chain[1:]))
    return shapely.linestrings(np.array(sorted(edges), dtype=float))


def main():
    arguments = sys.argv[1:]
    times = 1
    if "--times" in arguments:
        at = arguments.index("--times")
        times = int(arguments[at + 1])
        del arguments[at : at + 2]
    exact = "--exact" in arguments
    if exact:
        arguments.remove("--exact")
    print(f"# shapely {shapely.__version__}, GEOS {shapely.geos_version_string}, Python {sys.version.split()[0]}")
    print(COLUMNS)
    for argument in arguments:
        family, path = argument.split(":", 1)
        ends = np.fromfile(path, dtype="<i4").reshape(-1, 2, 2)
        lines = shapely.linestrings(ends.astype(float))
        plain = [faces_of(lines, None) for _ in range(times)]
        snapped = [faces_of(lines, 1.0) for _ in range(times)]
        found = shapely.polygonize(exact_edges(lines, ends)) if exact else snapped[0][1]
        faces = shapely.get_parts(found)
        areas, rings, holes = [], [], 0
        for face in faces:
            outer = ring_points(face.exterior, False)
            inner = sorted(ring_points(hole, True) for hole in face.interiors)
            holes += len(inner)
            areas.append((doubled_area(outer) + sum(doubled_area(hole) for hole in inner),))
            item = []
            for ring in [outer, *inner]:
                item.append(len(ring))
                item.extend(value for point in ring for value in point)
            rings.append(tuple(item))
        milliseconds = [statistics.median(taken for taken, _ in runs) * 1e3 for runs in (plain, snapped)]
        print(
            family, len(ends), len(faces), holes, sum(area for (area,) in areas), f"{fnv(areas):016x}",
            f"{fnv(rings):016x}", f"{milliseconds[0]:.3f}", f"{milliseconds[1]:.3f}",
            len(shapely.get_parts(plain[0][1])), sep=",", flush=True,
        )  # fmt: skip


if __name__ == "__main__":
    main()
