#!/usr/bin/env python3
"""Clear areas of the rooms of plans, computed with Shapely alone: each room less the union of its buffered walls.

    pip install shapely==2.2.0
    python3 tests/features/net_areas.py plans/*.plan.json > tests/features/net_areas.csv

It shares no code with Enfilade: the test beside it compares both.
"""

import csv
import json
import sys

import shapely
from shapely.geometry import LineString, Polygon


def bodies(plan, at):
    """The walls as one area: each buffered by half its thickness, and each pair that meets as one bent line, so that
    their faces meet in a mitre."""
    walls = [(wall["from"], wall["to"], wall["thickness"]) for wall in plan["walls"] if wall["thickness"] > 0]
    parts = [LineString([at[a], at[b]]).buffer(t / 2, cap_style="flat") for a, b, t in walls]
    meeting = {}
    for a, b, thickness in walls:
        meeting.setdefault(a, []).append((b, thickness))
        meeting.setdefault(b, []).append((a, thickness))
    for corner, ends in meeting.items():
        for i, (one, thickness) in enumerate(ends):
            for other, other_thickness in ends[:i]:
                # Walls of two thicknesses: the joint of the thinner, which lies within the true one.
                half = min(thickness, other_thickness) / 2
                bent = LineString([at[one], at[corner], at[other]])
                parts.append(bent.buffer(half, cap_style="flat", join_style="mitre", mitre_limit=4))
    return shapely.union_all(parts)


def main(paths):
    table = csv.writer(sys.stdout, lineterminator="\n")
    table.writerow(["plan", "id", "room", "along_axes_m2", "clear_m2"])
    for path in paths:
        with open(path, encoding="utf-8") as file:
            plan = json.load(file)
        at = {corner["id"]: (corner["x"], corner["y"]) for corner in plan["corners"]}
        walls = bodies(plan, at)
        for room in plan["rooms"]:
            if "outer" not in room:
                continue
            ring = [at[corner] for corner in room["outer"]]
            holes = [[at[corner] for corner in hole] for hole in room.get("holes", [])]
            whole = Polygon(ring, holes)
            clear = whole.difference(walls)
            table.writerow([path, room["id"], room.get("name", ""), f"{whole.area:.6f}", f"{clear.area:.6f}"])


if __name__ == "__main__":
    main(sys.argv[1:])
