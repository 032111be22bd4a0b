#!/usr/bin/env python3
"""Draws bricks.png: bricks in running bond as heights, 16 bits, that close on all four sides.

    python3 examples/scenes/make_bricks.py
"""
import pathlib
import struct
import zlib

WIDTH, HEIGHT = 512, 256    # texels; twice as wide as high, as a sphere is unrolled
ACROSS, COURSES = 16, 16    # bricks in a course, and courses; even, so that the shifted ones close too
JOINT, EDGE = 0.10, 0.10    # of a course's height: half of the mortar's width, and the rounding of a brick's edge


def smoothstep(low, high, x):
    t = min(max((x - low) / (high - low), 0.0), 1.0)
    return t * t * (3 - 2 * t)


def chance(column, course):
    """0 .. 1, the same for the same brick."""
    bits = (column * 374761393 + course * 668265263) & 0xFFFFFFFF
    bits = ((bits ^ bits >> 13) * 1274126177) & 0xFFFFFFFF
    return (bits ^ bits >> 16) / 0xFFFFFFFF


def height(u, v):
    """Of the wall, 0 .. 1, at u, v in 0 .. 1."""
    y = v * COURSES
    course = int(y)
    x = u * ACROSS + (0.5 if course % 2 else 0.0)
    column = int(x) % ACROSS
    x, y = x % 1 - 0.5, y % 1 - 0.5
    aspect = (WIDTH / ACROSS) / (HEIGHT / COURSES)
    to_joint = min((0.5 - abs(x)) * aspect, 0.5 - abs(y))
    level = 0.8 + 0.12 * chance(column, course)
    return 0.15 + (level - 0.15) * smoothstep(JOINT - EDGE, JOINT + EDGE, to_joint)


def chunk(kind, content):
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


rows = b""
for row in range(HEIGHT):
    v = 1 - (row + 0.5) / HEIGHT
    texels = [round(65535 * height((column + 0.5) / WIDTH, v)) for column in range(WIDTH)]
    rows += b"\0" + struct.pack(">%dH" % WIDTH, *texels)

file = pathlib.Path(__file__).with_name("bricks.png")
file.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", WIDTH, HEIGHT, 16, 0, 0, 0, 0))
                 + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))
