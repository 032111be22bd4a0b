#!/usr/bin/env python3
"""attacks.py HAPTEL: texture files that somebody wrote to do harm. Each is checked by the command, which must end with 0
or 1, say something where it ends with 1, not be long about it, and stay within limits of processor time and memory.

    --seconds S  of processor time for each, 2 unless said otherwise
    --keep DIR   writes the files there, to be looked at
    --only PART  those whose name has this in it
    --slowest N  says which took longest
"""

import argparse
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

MEMORY_MAX = 512 << 20 # resident
SAID_MAX = 1 << 20
HANG_S = 60 # of processor time: then it is ended

DEPTHS = (10, 200, 256, 257, 5_000, 100_000)
COUNTS = (1_000, 100_000)


def texture(body, before="", parameters=""):
    return f"{before}\n/// An attack.\ntexture t({parameters}) {{ {body} }}\n"


def nesting():
    """What a parser might descend into, one call a level."""
    pairs = {
        "parentheses": ("(", "p.x", ")"),
        "minus": ("-(", "p.x", ")"),
        "not": ("!(", "true", ") ? 1um : 0um"),
        "calls": ("abs(", "p.x", ")"),
        "constructors": ("vec2(", "p.x", ").x"),
        "ternaries": ("p.x > 0.0 ? 0.0 : (", "p.x", ")"),
        "grads": ("grad(", "abs", ")"),
        "indices": ("vec3(1.0)[int(", "p.x", ")]"),
        "brackets": ("[", "p.x", "]"),
    }
    for name, (opens, middle, closes) in pairs.items():
        for depth in DEPTHS:
            yield f"nested_{name}_{depth}", texture("return " + opens * depth + middle + closes * depth + ";")
    statements = {
        "blocks": ("{", "", "}"),
        "ifs": ("if (p.x > 0.0) {", "", "}"),
        "elses": ("if (p.x > 0.0) {} else ", "{}", ""),
        "loops": ("for (int i = 0; i < 2; i++) {", "", "}"),
    }
    for name, (opens, middle, closes) in statements.items():
        for depth in DEPTHS:
            yield f"nested_{name}_{depth}", texture(opens * depth + middle + closes * depth + " return 0.0;")
    for depth in DEPTHS:
        yield f"unclosed_parentheses_{depth}", texture("return " + "(" * depth)
        yield f"unclosed_blocks_{depth}", "texture t() " + "{" * depth
        yield f"closing_only_{depth}", "}" * depth + ")" * depth + "]" * depth
        yield f"nested_comments_{depth}", "/*" * depth + "*/" * depth + texture("return 0.0;")


def length():
    for count in COUNTS:
        yield f"sum_of_{count}", texture("return " + " + ".join(["p.x"] * count) + ";")
        yield f"product_of_{count}", texture("return " + " * ".join(["1.0"] * count) + " * p.x;")
        yield f"statements_{count}", texture("float a = p.x; " + "a = a * 0.5 + p.y; " * count + "return a;")
        yield f"variables_{count}", texture(" ".join(f"float a{i} = p.x;" for i in range(count)) + " return a0;")
        yield f"functions_{count}", texture("return f0(p.x);", " ".join(f"float f{i}(float x) {{ return x; }}" for i in
                                                                        range(count)))
        yield f"overloads_{count}", texture("return f(p.x);", "float f(float x) { return x; }\n" * count)
        yield f"parameters_{count}", texture("return 0.0;", "", ", ".join(f"float a{i} = 0.0 in 0.0 .. 1.0"
                                                                          for i in range(count)))
        yield f"textures_{count}", "".join(f"/// x\ntexture t{i}() {{ return 0.0; }}\n" for i in range(count))
        yield f"mistakes_{count}", texture("".join(f"float a{i} = b{i};" for i in range(count)) + " return 0.0;")
        yield f"chain_of_functions_{count}", texture(
            "return f0(p.x);", " ".join(f"float f{i}(float x) {{ return f{i + 1}(x); }}" for i in range(count)) +
            f" float f{count}(float x) {{ return x; }}")
        yield f"table_of_{count}", texture("return 1um * A[int(p.x)];", f"const float A[{count}] = {{" + ", ".join(
            ["1.0"] * count) + "};")
        yield f"semicolons_{count}", texture(";" * count + "return 0.0;")
        yield f"documentation_{count}", "/// x\n" * count + "texture t() { return 0.0; }\n"
        yield f"swizzles_{count}", texture("return p" + ".xyz" * count + ".x;")
        yield f"arguments_{count}", texture("return max(" + ", ".join(["p.x"] * count) + ");")
        yield f"imports_{count}", "".join(f'import "nowhere{i}.haptel";\n' for i in range(count)) + texture("return 0.0;")
    yield "name_of_a_million", texture("float " + "a" * 1_000_000 + " = p.x; return 0.0;")
    yield "unknown_name_of_a_million", texture("return " + "a" * 1_000_000 + ";")
    yield "number_of_a_million_digits", texture("return " + "9" * 1_000_000 + ".0;")
    yield "fraction_of_a_million_digits", texture("return 0." + "3" * 1_000_000 + ";")
    yield "line_of_ten_million_blanks", texture(" " * 10_000_000 + "return 0.0;")
    yield "ten_million_lines", "\n" * 10_000_000 + texture("return 0.0;")
    yield "text_of_a_million", 'import "' + "a" * 1_000_000 + '";\n' + texture("return 0.0;")


def cost():
    """Little text, much work: what is unrolled, inlined, differentiated or bounded."""
    for levels in (2, 4, 8, 16, 40):
        loops = "".join(f"for (int i{k} = 0; i{k} < 1000; i{k}++) " for k in range(levels))
        yield f"loops_to_the_{levels}", texture("float a = 0.0; " + loops + "a += p.x; return a;")
        yield f"doubling_functions_{levels}", texture(
            "return f0(p.x);", " ".join(f"float f{i}(float x) {{ return f{i + 1}(x) + f{i + 1}(x + 1.0); }}"
                                        for i in range(levels)) + f" float f{levels}(float x) {{ return x; }}")
        yield f"doubling_functions_of_functions_{levels}", texture(
            "return f0(sin, p.x);", " ".join(
                f"float f{i}(float g(float), float x) {{ return f{i + 1}(g, g(x)) + f{i + 1}(g, x); }}"
                for i in range(levels)) + f" float f{levels}(float g(float), float x) {{ return g(x); }}")
        yield f"doubling_variables_{levels}", texture("float a0 = p.x; " + " ".join(
            f"float a{i + 1} = a{i} * a{i};" for i in range(levels)) + f" return a{levels};")
        yield f"functions_of_a_new_type_{levels}", texture(
            "return f0(p);", " ".join(f"float f{i}(vec3 x) {{ return f{i + 1}(x.yzx) * f{i + 1}(x.zxy); }}"
                                      for i in range(levels)) + f" float f{levels}(vec3 x) {{ return x.x; }}")
        yield f"grads_of_grads_{levels}", texture(
            f"return g{levels}(p.x);", "float g0(float x) { return sin(x) * exp(x) / (1.0 + x * x); }" + "".join(
                f" float g{i + 1}(float x) {{ return grad(g{i})(x); }}" for i in range(levels)))
        yield f"noise_of_noise_{levels}", texture("return 1um * " + "noise(vec3(" * levels + "p.x" + "))" * levels + ";")
        yield f"branches_{levels}", texture("float a = p.x; " + "if (a > 0.5) a = a * 2.0; else a = a + p.y; " * levels *
                                            100 + "return a;")
        yield f"matrices_{levels}", texture("mat4 m = mat4(p.x); " + "m = m * m + m; " * levels * 20 + "return m[0][0];")
        yield f"minima_{levels}", texture("float a = p.x; " + "".join(
            f"a = min(a, abs(p.y - {i}.0) + fract(a * {i}.5)); " for i in range(levels * 50)) + "return a;")
    # Facts are tried at many points, each of which takes as long as the loop.
    yield "facts_of_a_long_loop", texture(
        "return f(p.x);", "/// @facts value -1 .. 1, slope 1, class C1\nfloat f(float x) { float a = x; "
        "for (int i = 0; i < 100000; i++) a = 0.5 * a + x; return 0.1 * a; }")
    for octaves in (16, 1_000, 1_000_000, 2_147_483_647):
        yield f"octaves_{octaves}", texture("return 1um * fbm(p, octaves);", "", f"int octaves = 4 in 1 .. {octaves}")
    for size in (1_000, 1_000_000, 2_147_483_647, 4_294_967_296, -1, 0):
        yield f"array_of_{size}", texture("float a[" + str(size) + "]; return a[0];")
        yield f"table_declared_{size}", texture("return A[0];", f"const float A[{size}] = {{1.0}};")
    yield "loop_by_zero", texture("float a = 0.0; for (int i = 0; i < 10; i += 0) a += p.x; return a;")
    yield "loop_backwards", texture("float a = 0.0; for (int i = 0; i < 10; i--) a += p.x; return a;")
    yield "loop_that_wraps", texture("float a = 0.0; for (int i = 2147483646; i > 0; i++) a += p.x; return a;")
    yield "loop_by_float", texture("float a = 0.0; for (float x = 0.0; x < 1.0; x += 1e-300) a += p.x; return a;")
    yield "loop_changed_inside", texture("float a = 0.0; for (int i = 0; i < 10; i++) { i = 0; a += p.x; } return a;")
    yield "loop_without_end", texture("for (;;) {} return 0.0;")
    yield "while", texture("while (true) {} return 0.0;")


def recursion():
    yield "itself", texture("return f(p.x);", "float f(float x) { return f(x); }")
    yield "each_other", texture("return f(p.x);", "float f(float x) { return g(x); } float g(float x) { return f(x); }")
    yield "by_function", texture("return f(f, p.x);", "float f(float g(float), float x) { return g(x); }")
    yield "by_grad", texture("return f(p.x);", "float f(float x) { return grad(f)(x); }")
    yield "texture_itself", texture("return t();")
    yield "import_itself", 'import "import_itself.haptel";\n' + texture("return 0.0;")
    yield "import_cycle", 'import "import_cycle_b.haptel";\n' + texture("return 0.0;"), {
        "import_cycle_b.haptel": 'import "import_cycle.haptel";\nfloat g(float x) { return x; }\n'}
    diamond = {f"diamond_{i}{side}.haptel": "".join(f'import "diamond_{i + 1}{other}.haptel";\n' for other in "ab") +
               f"float d{i}{side}(float x) {{ return x; }}\n" for i in range(40) for side in "ab"}
    diamond |= {f"diamond_40{side}.haptel": f"float d40{side}(float x) {{ return x; }}\n" for side in "ab"}
    yield "import_diamond", 'import "diamond_0a.haptel";\nimport "diamond_0b.haptel";\n' + texture("return 0.0;"), diamond
    chain = {f"chain_{i}.haptel": f'import "chain_{i + 1}.haptel";\nfloat c{i}(float x) {{ return x; }}\n'
             for i in range(2_000)}
    yield "import_chain", 'import "chain_0.haptel";\n' + texture("return 0.0;"), chain
    for name, path in (("zero", "/dev/zero"), ("random", "/dev/urandom"), ("itself_as_device", "/proc/self/mem"),
                       ("terminal", "/dev/tty"), ("folder", "."), ("root", "/"), ("above", "../../../../../../etc/passwd"),
                       ("nothing", ""), ("long", "a/" * 5_000), ("nul", "a\0b"), ("home", "~/x.haptel"),
                       ("library", "wood"), ("colon", "C:\\x"), ("line", "a\nb")):
        yield f"import_{name}", f'import "{path}";\n' + texture("return 0.0;")
    yield "import_library", "import wood.oak.pine.a.b.c.d;\n" + texture("return 0.0;")
    yield "import_library_of_dots", "import " + ".".join(["a"] * 10_000) + ";\n" + texture("return 0.0;")


def numbers():
    for name, index in (("below", "-1"), ("above", "4"), ("least", "-2147483648"), ("most", "2147483647"),
                        ("beyond", "99999999999999999999"), ("unsigned", "4294967295u"), ("by_zero", "1 / 0"),
                        ("modulo_zero", "1 % 0"), ("not_a_number", "int(0.0 / 0.0)"), ("infinite", "int(1e300)"),
                        ("of_itself", "int(A[int(A[int(A[int(p.x)])])])"), ("of_the_place", "int(1e30 * p.x)"),
                        ("shifted", "1 << 31"), ("shifted_far", "1 << 1000"), ("least_by_minus_one", "-2147483648 / -1"),
                        ("least_negated", "-(-2147483648)"), ("overflowing", "2147483647 * 2147483647")):
        yield f"index_{name}", texture(f"return 1um * A[{index}];", "const float A[4] = {1.0, 2.0, 3.0, 4.0};")
    for name, value in (("huge", "1e308 * 1e308"), ("tiny", "1e-308 * 1e-308"), ("exponent", "1e999999999999"),
                        ("negative_exponent", "1e-999999999999"), ("zero_by_zero", "0.0 / 0.0"),
                        ("logarithm", "log(-1.0)"), ("root", "sqrt(-1.0)"), ("power", "pow(-1.0, 0.5)"),
                        ("power_of_zero", "pow(0.0, -1e300)"), ("sine_of_huge", "sin(1e300 * p.x)"),
                        ("tangent", "tan(1.5707963267948966)"), ("arc", "asin(2.0)"), ("hex", "0x1p1000000"),
                        ("hexadecimal", "0xffffffffffffffffffff"), ("octal", "0777777777777777777777777"),
                        ("units", "1mmmmmmm"), ("unit_of_unit", "1mm mm"), ("dots", "1.2.3.4.5"), ("exponents", "1e1e1e1"),
                        ("sign", "1e+-+-1"), ("suffixes", "1fuFUlL"), ("clamp_turned", "clamp(p.x, 1.0, -1.0)"),
                        ("step_of_nothing", "smoothstep(0.0, 0.0, p.x)"), ("normal_of_nothing", "normalize(vec3(0.0)).x"),
                        ("mod_zero", "mod(p.x, 0.0)")):
        yield f"number_{name}", texture(f"return {value};")
    for name, text in (("turned", "float a = 0.5 in 1.0 .. 0.0"), ("infinite", "float a = 0.5 in 0.0 .. 1e999"),
                       ("outside", "float a = 5.0 in 0.0 .. 1.0"), ("not_a_number", "float a = 0.0/0.0 in 0.0 .. 1.0"),
                       ("of_itself", "float a = a in a .. a"), ("of_another", "float b = 1.0 in 0.0 .. 1.0, float a = b"),
                       ("named_as_input", "vec3 p = vec3(0.0)"), ("twice", "float a = 0.0, float a = 0.0"),
                       ("image", "image a = 3.0"), ("array", "float a[1000000] = 0.0"), ("choices", "int a = 0 in 0 .. 1e9"),
                       ("int_beyond", "int a = 99999999999 in 0 .. 999999999999")):
        yield f"parameter_{name}", texture("return 0.0;", "", text)


def letters():
    plain = texture("return 0.0;").encode()
    yield "nothing", b""
    yield "one_nul", b"\0"
    yield "nuls", b"\0" * 1_000_000
    yield "nul_inside", plain.replace(b"0.0", b"0\0.0")
    yield "byte_order_mark", b"\xef\xbb\xbf" + plain
    yield "two_byte_order_marks", b"\xef\xbb\xbf\xef\xbb\xbf" + plain
    yield "utf16", plain.decode().encode("utf-16")
    yield "utf32", plain.decode().encode("utf-32")
    yield "every_byte", bytes(range(256)) * 100
    yield "bytes_ff", b"\xff" * 100_000
    yield "overlong_slash", plain.replace(b"return", b"\xc0\xaf return")
    yield "surrogate", plain.replace(b"return", b"\xed\xa0\x80 return")
    yield "beyond_unicode", plain.replace(b"return", b"\xf7\xbf\xbf\xbf return")
    yield "cut_letter", plain + b"\xe2\x82"
    yield "carriage_returns", plain.replace(b"\n", b"\r")
    yield "mixed_lines", plain.replace(b"\n", b"\n\r\r\n\n")
    yield "escape_sequences", b"\x1b[2J\x1b]0;title\x07" + plain.replace(b"return", b"retrun \x1b[31m")
    for name, text in (("right_to_left", "\u202e"), ("zero_width", "\u200b"), ("line_separator", "\u2028"),
                       ("next_line", "\u0085"), ("no_break_space", "\u00a0"), ("ideographic_space", "\u3000"),
                       ("soft_hyphen", "\u00ad"), ("tag_letters", "\U000e0041" * 1_000), ("combining", "\u0301" * 100_000),
                       ("emoji", "\U0001f468\u200d\U0001f469\u200d\U0001f467" * 1_000), ("homoglyph", "r\u0435turn"),
                       ("full_width", "\uff46\uff4c\uff4f\uff41\uff54"), ("not_a_letter", "\uffff"),
                       ("mathematical", "\U0001d465"), ("arabic_digits", "\u0661\u0662\u0663"), ("minus_sign", "\u2212 1.0"),
                       ("quotes", "\u201cx\u201d"), ("trojan", "/*\u202e } \u2066if (true)\u2069 \u2066 begin */")):
        yield f"letters_{name}", texture(f"float x{text} = p.x; return 0.0;")
        yield f"letters_{name}_in_comment", texture(f"return 0.0; // {text}")
    for cut in range(1, len(plain), 3):
        yield f"cut_at_{cut}", plain[:cut]


FAMILIES = (nesting, length, cost, recursion, numbers, letters)


def cases():
    for family in FAMILIES:
        for name, text, *others in family():
            yield name, text if isinstance(text, bytes) else text.encode("utf-8", "surrogatepass"), *others


def limit_processor_time():
    resource.setrlimit(resource.RLIMIT_CPU, (HANG_S, HANG_S))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def attack(haptel, file, seconds_max):
    """What is wrong, or nothing, and the seconds and bytes that it took."""
    process = subprocess.Popen([haptel, "check", file.name], cwd=file.parent, stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, preexec_fn=limit_processor_time,
                               env=os.environ | {"HAPTEL_CACHE": "off"})
    said = process.stdout.read()
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    seconds, memory = used.ru_utime + used.ru_stime, used.ru_maxrss * 1024
    if process.returncode not in (0, 1):
        return f"ended with {process.returncode}: {said[-300:]!r}", seconds, memory
    if process.returncode == 1 and not said.strip():
        return "was refused without a word", seconds, memory
    if len(said) > SAID_MAX:
        return f"said {len(said)} bytes", seconds, memory
    if memory > MEMORY_MAX:
        return f"took {memory >> 20} MiB of memory", seconds, memory
    if seconds > seconds_max:
        return f"took {seconds:.1f} s of processor time", seconds, memory
    return None, seconds, memory


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("haptel")
    parser.add_argument("--seconds", type=float, default=2)
    parser.add_argument("--keep")
    parser.add_argument("--only", default="")
    parser.add_argument("--slowest", type=int, default=0)
    options = parser.parse_args()
    haptel, failed, count = os.path.abspath(options.haptel), 0, 0
    times, largest = [(0, "")], (0, "")
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(options.keep or temporary)
        folder.mkdir(exist_ok=True)
        for name, text, *others in cases():
            if options.only not in name:
                continue
            file = folder / f"{name}.haptel"
            file.write_bytes(text)
            for other, its_text in (others[0] if others else {}).items():
                (folder / other).write_text(its_text)
            wrong, seconds, memory = attack(haptel, file, options.seconds)
            count += 1
            times.append((seconds, name))
            largest = max(largest, (memory, name))
            if wrong:
                failed += 1
                print(f"{name}: {wrong}", flush=True)
    times.sort(reverse=True)
    for seconds, name in times[:options.slowest]:
        print(f"{seconds:6.2f} s {name}")
    print(f"{count} attacks, {failed} did harm; longest {times[0][0]:.2f} s ({times[0][1]}), "
          f"largest {largest[0] >> 20} MiB ({largest[1]})")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
