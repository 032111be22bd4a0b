#!/usr/bin/env python3
"""Figures with the Python module of Haptel, to be changed and run again.

    figures.py [--out FOLDER] [--bench FOLDER] [--trace FILE] [--small]

Each part between the `# %%` lines is one cell for editors that run a script as a notebook. A figure is a table,
FOLDER/NAME.csv, and where matplotlib is installed also a picture, FOLDER/NAME.png. --bench names what `./dev bench` or
`haptel bench WHAT --out FOLDER` wrote: then the figures of docs/performance.md are among them. --trace names a
trace.csv of `haptel explore --out`. --small takes fewer points.
"""

# %% What is to be made, and how a figure is written
import argparse
import csv
import math
import pathlib
import time

import haptel

try:
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plot
except ImportError:
    plot = None

options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
options.add_argument("--out", type=pathlib.Path, default=pathlib.Path("figures"))
options.add_argument("--bench", type=pathlib.Path)
options.add_argument("--trace", type=pathlib.Path)
options.add_argument("--small", action="store_true")
options = options.parse_args()
options.out.mkdir(parents=True, exist_ok=True)
print("Haptel", haptel.version, "- tables in", options.out,
      "and pictures" if plot else "- no pictures: matplotlib is not installed")


def figure(name, columns, rows, **axes):
    """A table; and a picture of its second column over its first, a line for each text in its last one."""
    with open(options.out / (name + ".csv"), "w", newline="") as file:
        csv.writer(file).writerows([columns, *rows])
    print(f"{name}.csv: {len(rows)} rows of {', '.join(columns)}")
    if not plot or not axes.get("draw", True):
        return
    picture, ax = plot.subplots()
    labels = {row[-1] if isinstance(row[-1], str) else "" for row in rows}
    for label in sorted(labels):
        line = [row for row in rows if row[-1] == label or not label]
        ax.plot([row[0] for row in line], [row[1] for row in line], axes.get("style", "-"), label=label)
    ax.set(xlabel=columns[0], ylabel=columns[1], xscale=axes.get("xscale", "linear"), yscale=axes.get("yscale", "linear"))
    if len(labels) > 1:
        ax.legend(fontsize="small")
    picture.savefig(options.out / (name + ".png"), dpi=150)
    plot.close(picture)


def read_table(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


# %% A texture along a line: heights and gradients of many points at once
wave_m, depth_m = 4e-3, 50e-6
ripple = haptel.Texture("texture ripple() { return 50um * sinturn(p.x / 4mm); }")
xs = [2e-5 * i for i in range(100 if options.small else 1000)]
heights, gradients = ripple.evaluate([(x, 0, 0) for x in xs])
figure("profile", ["x_m", "height_m", "slope"], [(x, h, g[0]) for x, h, g in zip(xs, heights, gradients)])

# %% Error against time: the gradient that comes with the height, and differences of six more heights, which are exact
# at no step. The truth is the closed form.
count = 500 if options.small else 20000
points = [(0.02 * i / count - 0.01, 3e-6 * i, 0) for i in range(count)]
steepest = 2 * math.pi * depth_m / wave_m
truth = [steepest * math.cos(2 * math.pi * x / wave_m) for x, _, _ in points]


def timed(function):
    start = time.process_time()
    result = function()
    return result, (time.process_time() - start) / len(points) * 1e9


def differences(step_m):
    along = []
    for axis in range(3):
        step = [step_m if other == axis else 0 for other in range(3)]
        above, _ = ripple.evaluate([(x + step[0], y + step[1], z + step[2]) for x, y, z in points])
        below, _ = ripple.evaluate([(x - step[0], y - step[1], z - step[2]) for x, y, z in points])
        along.append([(a - b) / (2 * step_m) for a, b in zip(above, below)])
    return list(zip(*along))


def error(gradients):
    return max(abs(gradient[0] - true) for gradient, true in zip(gradients, truth)) / steepest


(_, exact), ns = timed(lambda: ripple.evaluate(points))
rows = [(ns, error(exact), 0, "gradient of Haptel")]
for exponent in range(-7, 0):
    step = wave_m * 10.0 ** exponent
    gradients, ns = timed(lambda: differences(step))
    rows.append((ns, error(gradients), step, "differences, step of 1e%d wavelengths" % exponent))
figure("error_of_differences", ["ns_per_point_with_python", "error", "step_m", "way"], rows, yscale="log", style="o")

# %% The figures of docs/performance.md, from the tables of `haptel bench`
if options.bench and (options.bench / "accuracy.csv").exists():
    table = read_table(options.bench / "accuracy.csv")
    near = [row for row in table if float(row["wavelengths"]) == 10]
    for texture in sorted({row["texture"] for row in near}):
        rows = [(float(row["median_ns"]), float(row["gradient_error_max"]),
                 {"haptel": "Haptel", "haptel_difference": "differences of Haptel's heights"}.get(row["method"], "plain C++"))
                for row in near if row["texture"] == texture and row["mode"] == "batch"]
        figure("error_against_time_" + texture, ["ns_per_point", "gradient_error", "way"], rows, xscale="log",
               yscale="log", style="o")
    fastest = {} # of the ways that lanes are used
    for row in near:
        if row["method"] == "haptel":
            way = row["texture"], row["mode"], row["precision"]
            fastest[way] = min(float(row["median_ns"]), fastest.get(way, math.inf))
    figure("times", ["texture", "mode", "precision", "ns"], [(*way, ns) for way, ns in sorted(fastest.items())], draw=False)
if options.bench and (options.bench / "tick.csv").exists():
    figure("tick_against_triangles", ["triangles", "tick_ns", "tick_ns_p99", "scene"],
           [(int(row["triangles"]), float(row["tick_ns"]), float(row["tick_ns_p99"]), row["scene"])
            for row in read_table(options.bench / "tick.csv") if row["objects"] == "1"], xscale="log")

# %% A scene that a simulated hand explores, with a texture ever deeper
texture = options.out / "ripple.haptel"
texture.write_text("texture ripple(float depth = 50um in 0um .. 200um) { return depth * sinturn(p.x / 4mm); }\n")
build = haptel.SceneBuilder()
ball = build.add("icosphere", 0.1, texture=f"{texture}:ripple")
scene = build.finish(haptel.Settings(rate_hz=1000))
rows = []
for depth_um in range(0, 201, 100 if options.small else 20):
    scene.set(ball, depth=f"{depth_um}um")
    report = scene.run(seconds=1 if options.small else 3)
    rows.append((depth_um, report.force_rms_n, report.force_max_n, report.contact_ticks))
figure("force_against_depth", ["depth_um", "force_rms_n", "force_max_n", "contact_ticks"], rows)

# %% A hand of one's own: into the ball and along it, and the force at each tick
renderer = haptel.Renderer(scene)
rows = []
for tick in range(600):
    around = 0.2 * (tick - 300) / 300 # radians from the top
    at_m = 0.052 - 0.004 * min(1, tick / 300)
    at = (at_m * math.sin(around), 0, at_m * math.cos(around))
    force = renderer.tick(at)
    rows.append((tick * 1e-3, math.hypot(*force.force_n), force.depth_m, force.contacts))
figure("stroke", ["time_s", "force_n", "depth_m", "contacts"], rows)

# %% A trace of `haptel explore --out`: when the hand touched, how hard, and how long a tick took
if options.trace:
    trace = haptel.read_trace(options.trace)
    forces = [math.hypot(*force_n) for force_n in zip(trace["fx_n"], trace["fy_n"], trace["fz_n"])]
    figure("force_of_trace", ["time_s", "force_n"], list(zip(trace["time_s"], forces)))
    touched = sum(objects > 0 for objects in trace["contact"])
    nanoseconds = sorted(trace["compute_ns"])
    print(f"{options.trace}: {len(forces)} ticks, {touched} in contact, at most {max(forces):.3g} N, "
          f"median of a tick {nanoseconds[len(nanoseconds) // 2]} ns")
