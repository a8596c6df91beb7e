#!/usr/bin/env python3
"""The path of a hand that opens the mastoid of the built-in temporal bone, as CSV for `burr mill --path`.

    scripts/mastoidectomy.py > path.csv
    burr mill phantom:temporal-bone --path path.csv --stiffness 2000 --arm rigid --undo-bricks 60000 \
        --record mastoid.mcap --embed
    burr replay mastoid.mcap --picture mastoid.png --height-mm 40

The hand mills in rows, layer by layer from the cortex inwards, a funnel as a surgeon makes it, then a fine pass over its
walls. The centre of the burr (5 mm) keeps its distance from sinus, dura, ear canal, facial nerve and the lateral canal,
whose places are those of src/burr/phantom/temporal_bone_model.h. This makes the picture of README.md.
"""
import math

BURR, MARGIN, START = 2.5, 0.6, -9.0  # radius, bone left over what must be spared, first layer [mm]
TOOL = (-0.86, -0.34, -0.30)          # direction of the shaft, from the head


def curve(through, steps=8):
    """Catmull-Rom curves, as in src/burr/phantom/sculpt.h."""
    points, last = [], len(through) - 1
    for i in range(last):
        p = [through[min(max(i + by, 0), last)] for by in (-1, 0, 1, 2)]
        for s in range(steps):
            t = s / steps
            points.append(tuple(0.5 * (2 * b + t * (c - a) + t * t * (2 * a - 5 * b + 4 * c - d) + t**3 * (3 * b - a - 3 * c + d))
                                for a, b, c, d in zip(*p)))
    return points + [through[-1]]


SINUS = curve([(27, 44, 12), (18.5, 33.5, 9.5), (13.6, 26.5, 3.5), (12.2, 22.5, -4.5), (14.5, 19.5, -11.5), (19.5, 14, -14.5),
               (23.6, 7.5, -13), (24.6, 3.6, -11)])
CANAL = curve([(-9, 1, -1), (0, 0, 0), (7, -1.2, 0.6), (17.2, -4, -0.4)])
FACIAL = curve([(25.2, -9, 5.2), (23.4, -6.4, 5), (21.8, -2.4, 4.4), (19.6, 1.4, 3.4), (17.6, 4, 1), (16.8, 4.8, -3),
                (16.2, 5.2, -10), (15.6, 5.4, -18)])
# outline of the opening, seen from the side: (y, z)
OPENING = [(4.5, 9.5), (8, 10.5), (21, 9.5), (23.5, 2), (20, -8), (14, -15), (9.5, -16), (7, -8)]


def to_segment(p, a, b):
    along = [v - u for u, v in zip(a, b)]
    t = sum((x - u) * d for x, u, d in zip(p, a, along)) / sum(d * d for d in along)
    t = min(max(t, 0), 1)
    return math.dist(p, [u + t * d for u, d in zip(a, along)])


def to_curve(points, p):
    return min(to_segment(p, a, b) for a, b in zip(points, points[1:]))


def inside(y, z):
    """Distance from the edge of the opening; negative outside."""
    rim, within = math.inf, False
    for a, b in zip(OPENING, OPENING[1:] + OPENING[:1]):
        rim = min(rim, to_segment((y, z), a, b))
        if (a[1] > z) != (b[1] > z) and y < (b[0] - a[0]) * (z - a[1]) / (b[1] - a[1]) + a[0]:
            within = not within
    return rim if within else -rim


def clear(p):
    return (to_curve(SINUS, p) > 4.3 + BURR + MARGIN and to_curve(CANAL, p) > 5.3 + BURR
            and to_curve(FACIAL, p) > 2.25 + BURR and math.dist(p, (22, 2.6, 4.4)) > 4.75 + BURR
            and p[2] < 11.6 - 0.09 * (p[0] - 14) - BURR - MARGIN - 0.3 and math.dist(p, (70, 6, 30)) > 66.6 + BURR + MARGIN)


def deepest(y, z, step):
    """How deep the burr may go at (y, z); None: not at all."""
    from_rim = inside(y, z)
    if from_rim < 0:
        return None
    x, found = START, None
    while x <= min(START + 9 + 2.2 * from_rim, 15) and clear((x, y, z)):
        x, found = x + step, x
    return found


def rows(spacing, step):
    """Rows over the opening, forwards and backwards in turn: lists of (deepest, y, z)."""
    for n in range(int(29 / spacing)):
        z = -18 + n * spacing
        row = [(deepest(y, z, step), y, z) for y in (3 + m * spacing for m in range(int(23 / spacing)))]
        row = [point for point in row if point[0] is not None]
        yield row[::-1] if n % 2 else row


def way():
    yield (START - 4, 11, 5)
    coarse = list(rows(1.1, 0.25))
    layer = 0
    while START + 0.5 * layer < 15:
        x = START + 0.5 * layer
        for row in coarse if layer % 2 == 0 else coarse[::-1]:
            yield from ((min(x, deep), y, z) for deep, y, z in row if deep >= x - 0.8)
        layer += 1
    for row in rows(0.55, 0.2):
        yield from row
    y, z = 12.9, 0.15
    end = deepest(y, z, 0.2)
    yield (end, y, z)
    yield (end - 0.2, y, z)


def main():
    length = math.hypot(*TOOL)
    tool = [v / length for v in TOOL]
    turn = (1 + tool[2], -tool[1], tool[0], 0)  # rotates z to the shaft
    turn = [v / math.hypot(*turn) for v in turn]
    print("t,x_mm,y_mm,z_mm,qw,qx,qy,qz")
    t, before = 0.0, None
    for p in way():
        if before is not None:
            gap = math.dist(p, before)
            t += gap / (80 if gap > 3.3 else 9) + 0.001  # [mm/s]
        before = p
        print("%.4f,%.3f,%.3f,%.3f," % (t, *p) + ",".join("%.6f" % v for v in turn))


if __name__ == "__main__":
    main()
