"""The Python module against closed forms: a sine's heights and slopes, a table's spring, what is refused and how."""

import math
import sys
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


if __name__ == "__main__":
    sys.exit(unittest.main())
