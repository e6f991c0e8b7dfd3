#!/usr/bin/env python3
"""The faces of segments by GEOS, through shapely: for benches/faces.rs and tests/faces/reference.csv.

Usage: faces_geos.py FAMILY:FILE... [--times N]

Each FILE holds 32-bit little-endian integers, four a segment (x, y, x, y) in steps of the 0.1 mm grid.
Prints a line of comma-separated values for each, see COLUMNS. Times are processor times, medians over N runs
(default 1) of `unary_union` and `polygonize` together, with the segments already in shapely's form.

- plain: `unary_union`, nodes in full precision. Its faces differ from ours by slivers below the grid.
- snapped: `unary_union(grid_size=1)`, nodes snap-rounded to the grid as ours are. Coordinates are whole,
  so that areas and the sums below are exact. All columns but the times are of these faces.

The sums (64-bit FNV-1a) are over sorted items, so that they do not depend on the order of faces:
`areas` over the doubled areas, `rings` over the faces with all their rings, less nodes in the middle of a
straight piece, from each ring's smallest point, outer rings counter-clockwise and holes clockwise.
"""
import statistics
import sys
import time

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


def main():
    arguments = sys.argv[1:]
    times = 1
    if "--times" in arguments:
        at = arguments.index("--times")
        times = int(arguments[at + 1])
        del arguments[at : at + 2]
    print(f"# shapely {shapely.__version__}, GEOS {shapely.geos_version_string}, Python {sys.version.split()[0]}")
    print(COLUMNS)
    for argument in arguments:
        family, path = argument.split(":", 1)
        ends = np.fromfile(path, dtype="<i4").reshape(-1, 2, 2)
        lines = shapely.linestrings(ends.astype(float))
        plain = [faces_of(lines, None) for _ in range(times)]
        snapped = [faces_of(lines, 1.0) for _ in range(times)]
        faces = shapely.get_parts(snapped[0][1])
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
