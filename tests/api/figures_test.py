"""figures_test.py FIGURES HAPTEL SOURCE FOLDER: runs examples/python/figures.py in FOLDER on what `haptel` measures and
records, and compares its tables with closed forms, and a trace as the module reads it with its text."""

import csv
import math
import numbers
import pathlib
import re
import subprocess
import sys

import haptel as module

figures, haptel, source, folder = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3]), pathlib.Path(sys.argv[4])
subprocess.run([haptel, "explore", source / "examples/scenes/bricks.toml", "--seconds", "1.5", "--clock", "virtual",
                "--out", folder], check=True, stdout=subprocess.DEVNULL)
subprocess.run([haptel, "bench", "tick", "--quick", "--out", folder], check=True, stdout=subprocess.DEVNULL)
# `bench accuracy` takes minutes: two rows in its columns.
written = (source / "tools/figures/bench_accuracy.cpp").read_text()
columns = re.sub(r'"\s*"', "", re.search(r'"(texture,mode,.*?)\\n"', written, re.DOTALL).group(1))
row = dict.fromkeys(columns.split(","), "0") | {"texture": "noise", "mode": "batch", "precision": "f64",
                                                "median_ns": "9.5", "wavelengths": "10", "gradient_error_max": "1e-16"}
with open(folder / "accuracy.csv", "w", newline="") as file:
    table = csv.DictWriter(file, columns.split(","))
    table.writeheader()
    table.writerows([row | {"method": "haptel"}, row | {"method": "cpp_dual", "median_ns": "20"}])

subprocess.run([sys.executable, figures, "--small", "--out", folder / "out", "--bench", folder, "--trace",
                folder / "trace.csv"], check=True)


def read(name):
    with open(folder / "out" / (name + ".csv"), newline="") as file:
        return list(csv.DictReader(file))


def expect(condition, what):
    if not condition:
        sys.exit("figures_test.py: " + what)


for at in read("profile"):
    turn = 2 * math.pi * float(at["x_m"]) / 4e-3
    expect(abs(float(at["height_m"]) - 50e-6 * math.sin(turn)) < 1e-17, "the profile is not a sine")
    expect(abs(float(at["slope"]) - 50e-6 * 2 * math.pi / 4e-3 * math.cos(turn)) < 1e-14, "its slope is not a cosine")
ways = read("error_of_differences")
expect(float(ways[0]["error"]) < 1e-14, "the gradient is wrong")
# Where truncation rules, a central difference is off by (2 pi step / wavelength)^2 / 6.
for way in ways[-3:]:
    turn = 2 * math.pi * float(way["step_m"]) / 4e-3
    expect(abs(float(way["error"]) - (1 - math.sin(turn) / turn)) < 1e-6, "differences have another error")
expect([(r["ns_per_point"], r["way"]) for r in read("error_against_time_noise")] == [("9.5", "Haptel"), ("20.0", "plain C++")],
       "error against time is not that of the table")
expect(read("times") == [{"texture": "noise", "mode": "batch", "precision": "f64", "ns": "9.5"}], "times differ")
expect({r["scene"] for r in read("tick_against_triangles")} >= {"fbm4", "free"}, "the tick has no row")
flat, *textured = read("force_against_depth")
expect(float(flat["depth_um"]) == 0 and all(float(r["force_max_n"]) > float(flat["force_max_n"]) for r in textured),
       "a texture is not felt")
stroke = read("stroke")
expect(float(stroke[0]["force_n"]) == 0 and float(stroke[-1]["force_n"]) > 0.5, "the stroke does not press")
expect(len(read("force_of_trace")) == 1500 and any(float(r["force_n"]) > 0 for r in read("force_of_trace")), "no force in the trace")

trace = module.read_trace(folder / "trace.csv")
with open(folder / "trace.csv", newline="") as file:
    names, *rows = csv.reader(file)
expect(list(trace) == names and len(rows) == 1500, "the trace has other columns")
for name, texts in zip(names, zip(*rows)):
    expect([float(text) for text in texts] == list(trace[name]), f"{name} is read as other numbers")
# runtime/servo/tick_columns.cpp: what is a double there has a unit, but for nanoseconds.
whole = {name for name in names if isinstance(list(trace[name])[0], numbers.Integral)}
expect(whole == {name for name in names if not re.search("_(m|n|s)$", name)}, f"whole numbers are {whole}")
