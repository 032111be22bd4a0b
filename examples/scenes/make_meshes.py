#!/usr/bin/env python3
"""Writes rod.obj, a rod with lids, and vault.obj, a barrel vault with coordinates for a picture. Metres.

    python3 examples/scenes/make_meshes.py
"""
import math
import pathlib

ROD_RADIUS, ROD_LENGTH, ROD_SIDES = 0.015, 0.12, 48           # along z
VAULT_RADIUS, VAULT_LENGTH = 0.06, 0.14                       # along x, its crest in +z
VAULT_ARC, VAULT_STRIPS = math.radians(120), 24
PICTURE = (0.128, 0.064)                                      # of the vault that it covers once: bricks of 8 mm x 4 mm


def rod():
    yield "# A rod with lids, by make_meshes.py"
    for z in (-ROD_LENGTH / 2, ROD_LENGTH / 2):
        for i in range(ROD_SIDES):
            angle = 2 * math.pi * i / ROD_SIDES
            yield f"v {ROD_RADIUS * math.cos(angle):.7f} {ROD_RADIUS * math.sin(angle):.7f} {z:.7f}"
    for i in range(ROD_SIDES):
        j = (i + 1) % ROD_SIDES
        yield f"f {i + 1} {j + 1} {ROD_SIDES + j + 1} {ROD_SIDES + i + 1}"
    yield "f " + " ".join(str(ROD_SIDES - i) for i in range(ROD_SIDES))
    yield "f " + " ".join(str(ROD_SIDES + i + 1) for i in range(ROD_SIDES))


def vault():
    yield "# A barrel vault, by make_meshes.py: u along it, v along its arc, so that no brick is stretched"
    corners = 0
    for i in range(VAULT_STRIPS + 1):
        angle = VAULT_ARC * (i / VAULT_STRIPS - 0.5)
        y, z = -VAULT_RADIUS * math.sin(angle), VAULT_RADIUS * (math.cos(angle) - 1)
        for x in (-VAULT_LENGTH / 2, VAULT_LENGTH / 2):
            corners += 1
            yield f"v {x:.7f} {y:.7f} {z:.7f}"
            yield f"vt {x / PICTURE[0]:.7f} {VAULT_RADIUS * angle / PICTURE[1]:.7f}"  # of the arc
            yield f"vt {y / PICTURE[0]:.7f} {z / PICTURE[1]:.7f}"                     # of the ends
            yield f"vt {x / PICTURE[0]:.7f} {y / PICTURE[1]:.7f}"                     # of the underside

    def face(corner_numbers, coordinates):
        return "f " + " ".join(f"{k}/{3 * k - 3 + coordinates}" for k in corner_numbers)

    for first in range(1, corners - 1, 2):
        yield face((first, first + 2, first + 3, first + 1), 1)
    yield face(range(corners - 1, 0, -2), 2)
    yield face(range(2, corners + 1, 2), 2)
    yield face((1, 2, corners, corners - 1), 3)


for name, lines in (("rod.obj", rod()), ("vault.obj", vault())):
    pathlib.Path(__file__).with_name(name).write_text("\n".join(lines) + "\n")
