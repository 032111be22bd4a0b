#!/usr/bin/env python3
"""Writes the tables of noise and perlin: ./make_tables.py, in this folder. Fixed seed, so that a texture feels the same for ever."""
import math
import random

generator = random.Random(1997)  # only random() is used: its sequence is the same in every Python


def permutation(size):
    """Fisher-Yates."""
    row = list(range(size))
    for last in range(size - 1, 0, -1):
        other = int(generator.random() * (last + 1))
        row[last], row[other] = row[other], row[last]
    return row


def unit_vector():
    """Uniform on the sphere: uniform height and azimuth (Archimedes)."""
    z = 2 * generator.random() - 1
    azimuth = 2 * math.pi * generator.random()
    radius = math.sqrt(1 - z * z)
    return (radius * math.cos(azimuth), radius * math.sin(azimuth), z)


def solid_directions():
    """12 corners of an icosahedron and 20 of its dual dodecahedron, turned so that none lies along the lattice."""
    golden = (1 + math.sqrt(5)) / 2
    corners = []
    for s in (-1, 1):
        for t in (-golden, golden):
            corners += [(0, s, t), (s, t, 0), (t, 0, s)]
    corners += [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    for s in (-1 / golden, 1 / golden):
        for t in (-golden, golden):
            corners += [(s, 0, t), (0, t, s), (t, s, 0)]
    turned = []
    for corner in corners:
        x, y, z = (c / math.sqrt(sum(c * c for c in corner)) for c in corner)
        for angle, axis in ((0.37, 0), (0.71, 1), (1.13, 2)):
            c, s = math.cos(angle), math.sin(angle)
            if axis == 0:
                y, z = c * y - s * z, s * y + c * z
            elif axis == 1:
                z, x = c * z - s * x, s * z + c * x
            else:
                x, y = c * x - s * y, s * x + c * y
        turned.append((x, y, z))
    return turned


def table(kind, name, values):
    """A constant table in Haptel, wrapped at 100 columns, as haptel fmt does."""
    lines, line = [], "   "
    for value in values:
        item = f" {value!r},"
        if len(line) + len(item) > 100:
            lines.append(line)
            line = "   "
        line += item
    lines.append(line)
    return f"const {kind} {name}[{len(values)}] = {{\n" + "\n".join(lines).rstrip(",") + "\n};\n"


def circle(count):
    return [2 * math.pi * (i + 0.5) / count for i in range(count)]


def write(path, comment, tables):
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"// {comment} Made by make_tables.py.\n\n" + "\n".join(tables))


permuted = permutation(256)
vectors = [unit_vector() for _ in range(256)]
angles = [2 * math.pi * generator.random() for _ in range(256)]
write("noise_tables.haptel", "G[256][3] and M[256] of the paper's Appendix C, and unit vectors of the plane.", [
    table("int", "noise_m", permuted),
    *(table("float", "noise_g" + "xyz"[axis], [v[axis] for v in vectors]) for axis in range(3)),
    table("float", "noise_plane_gx", [math.cos(a) for a in angles]),
    table("float", "noise_plane_gy", [math.sin(a) for a in angles]),
])

spread = solid_directions()
ring = circle(32)
write("perlin_tables.haptel", "32 directions spread evenly over the sphere, and 32 over the circle.", [
    table("int", "perlin_m", permutation(256)),
    *(table("float", "perlin_g" + "xyz"[axis], [v[axis] for v in spread]) for axis in range(3)),
    table("float", "perlin_plane_gx", [math.cos(a) for a in ring]),
    table("float", "perlin_plane_gy", [math.sin(a) for a in ring]),
])
