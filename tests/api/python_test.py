"""The Python module against closed forms: a sine's heights and slopes, a table's spring, what is refused and how."""

import math
import os
import pathlib
import sys
import tempfile
import unittest

import haptel

WAVES = "/// Waves.\ntexture waves(float depth = 100um in 0um .. 1mm) { return depth * sinturn(p.x / 4mm); }\n"


class Textures(unittest.TestCase):
    def test_heights_and_gradients_are_those_of_the_formula(self):
        points = [(1e-5 * i, 0.01 * i, 0) for i in range(1000)]
        heights, gradients = haptel.Texture(WAVES, depth="0.2mm").evaluate(points)
        for (x, _, _), height, (gx, gy, gz) in zip(points, heights, gradients):
            angle = 2 * math.pi * x / 4e-3
            self.assertAlmostEqual(height, 2e-4 * math.sin(angle), delta=1e-17)
            self.assertAlmostEqual(gx, 2e-4 * 2 * math.pi / 4e-3 * math.cos(angle), delta=1e-14)
            self.assertEqual((gy, gz), (0, 0))

    def test_facts_are_those_of_a_sine(self):
        facts = haptel.Texture(WAVES).facts
        self.assertAlmostEqual(facts.height_max_m, 1e-4, delta=1e-8)
        self.assertAlmostEqual(facts.slope_max, 1e-4 * 2 * math.pi / 4e-3, delta=1e-3)

    def test_mistakes_are_told_as_the_command_tells_them(self):
        for text, name, values, said in (("texture t() { return dept; }", "", {}, "error: "),
                                         (WAVES, "wave", {}, "did you mean 'waves'?"),
                                         (WAVES, "", {"depht": "1um"}, "did you mean 'depth'?")):
            with self.assertRaisesRegex(haptel.Error, said.replace("?", r"\?")):
                haptel.Texture(text, name, **values)
        for points in ([(1, 2)], [(1, 2), (3, 4, 5, 6)]):
            with self.assertRaisesRegex(haptel.Error, "of three numbers each"):
                haptel.Texture(WAVES).evaluate(points)


class Scenes(unittest.TestCase):
    material = haptel.Material(500, 0, 0, 0)

    def table(self):
        build = haptel.SceneBuilder()
        self.assertEqual(build.add("plane", 0.2, self.material), 1)
        return build.finish(haptel.Settings(force_rise_s=0))

    def test_a_table_is_a_spring(self):
        renderer = haptel.Renderer(self.table())
        self.assertEqual(renderer.tick((0, 0, 1e-3)).force_n[2], 0)
        self.assertAlmostEqual(renderer.tick((0, 0, -2e-3)).force_n[2], 1, delta=1e-9)

    def test_a_mesh_of_ones_own_lies_where_it_is_put(self):
        build = haptel.SceneBuilder()
        build.add_mesh([(-1, -1, 0), (1, -1, 0), (0, 1, 0)], [(0, 1, 2)], self.material, position_m=(0, 0, 0.5))
        renderer = haptel.Renderer(build.finish(haptel.Settings(force_rise_s=0)))
        renderer.tick((0, 0, 0.501))
        self.assertAlmostEqual(renderer.tick((0, 0, 0.498)).force_n[2], 1, delta=1e-6)

    def test_a_simulated_hand_feels_the_same_twice(self):
        one, other = self.table().run(seconds=2), self.table().run(seconds=2)
        self.assertEqual(one.ticks, 2000)
        self.assertGreater(one.contact_ticks, 100)
        self.assertEqual(one.force_max_n, other.force_max_n)

    def test_what_is_refused_raises(self):
        with self.assertRaisesRegex(haptel.Error, "a scene needs something to touch"):
            haptel.SceneBuilder().finish()
        with self.assertRaisesRegex(haptel.Error, "object 1: error: mesh `nowhere.obj`"):
            build = haptel.SceneBuilder()
            build.add("nowhere.obj", 0)
            build.finish()
        with self.assertRaisesRegex(haptel.Error, "the object has no texture"):
            self.table().set(1, depth="1um")
        with self.assertRaisesRegex(haptel.Error, "did you mean 'falcon'"):
            self.table().run("falkon")
        with self.assertRaisesRegex(haptel.Error, "`virtual_time` is for simulated devices"):
            self.table().run("falcon", virtual_time=True)
        with self.assertRaisesRegex(haptel.Error, "`seconds` must be at least 0"):
            self.table().run(seconds=-1)


class Traces(unittest.TestCase):
    names = ("tick,time_s,x_m,y_m,z_m,tail_x_m,tail_y_m,tail_z_m,fx_n,fy_n,fz_n,contact,depth_m,height_m,compute_ns,"
             "binding")
    row = "7,0.007,1e-3,-2E-05,0.25,0,0,0,0,0,-1.5,1,0.001,0,123456789012345678,1"

    def read(self, *lines):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "trace.csv")
            file.write_bytes("\n".join(lines).encode())
            return haptel.read_trace(file)

    def test_numbers_stand_under_their_names_to_the_bit(self):
        trace = self.read(self.names + ",other", self.row + ",0.5\r", "", self.row + ",0.1\n")
        self.assertEqual(list(trace), self.names.split(",") + ["other"])
        for name, value in (("tick", 7), ("time_s", 0.007), ("x_m", 1e-3), ("y_m", -2e-5), ("fz_n", -1.5),
                            ("compute_ns", 123456789012345678)):
            self.assertEqual(list(trace[name]), [value, value])
        self.assertEqual(list(trace["other"]), [0.5, 0.1])
        self.assertEqual([len(column) for column in self.read(self.names).values()], 16 * [0])

    def test_columns_are_arrays_where_numpy_is(self):
        try:
            import numpy
        except ImportError:
            self.assertIs(type(self.read(self.names, self.row)["fz_n"]), list)
            return
        trace = self.read(self.names, self.row)
        self.assertIs(type(trace["fz_n"]), numpy.ndarray)
        self.assertEqual((trace["fz_n"].dtype, trace["tick"].dtype), (numpy.float64, numpy.int64))

    def test_what_is_no_trace_is_refused_with_its_place(self):
        cut = self.row.rsplit(",", 6)[0]
        for lines, said in (([""], "csv:1: expected a trace .*, but there is no header$"),
                            (["time,force", "0,1"], "csv:1: the trace has no column `tick`$"),
                            ([self.names, self.row, cut], "csv:3: expected 16 values, found 10$"),
                            ([self.names, self.row + ",1"], "csv:2: expected 16 values, found 17$"),
                            ([self.names, self.row.replace("0.25", "high")],
                             "csv:2: expected a number in column `z_m`, found `high`$"),
                            ([self.names, "", self.row.replace("0.25", "")],
                             "csv:3: expected a number in column `z_m`, found ``$"),
                            ([self.names, self.row.replace("0.25", "nan")], "column `z_m`, found `nan`$"),
                            ([self.names, self.row.replace("7,", "7.5,", 1)],
                             "expected a whole number in column `tick`, found `7.5`$"),
                            ([self.names, self.row.replace("7,", "1_0,", 1)], "column `tick`, found `1_0`$"),
                            ([self.names, "9" + 19 * "0" + self.row[1:]], "column `tick`, found `90+`$"),
                            (["HAPTRACE\4\3\2\1"], "is a recording: `haptel replay FILE --csv trace.csv`"),
                            (["\0\xff\n\0"], "csv:1: the trace has no column `tick`$")):
            with self.assertRaisesRegex(haptel.Error, said):
                self.read(*lines)
        with tempfile.TemporaryDirectory() as folder:
            os.mkfifo(folder + "/pipe")
            for file, said in ((folder, "the trace is a folder"), (folder + "/none.csv", "the trace does not exist"),
                               (folder + "/pipe", "the trace is not a regular file")):
                with self.assertRaisesRegex(haptel.Error, "^" + file + ": " + said + "$"):
                    haptel.read_trace(file)


if __name__ == "__main__":
    sys.exit(unittest.main())
