#!/usr/bin/env python3
"""Breaks each rule in turn and expects a red test: what survives is not tested.

    ./dev mutate [--list] [--limit N] [--seed N] [FILE...]

Works in a copy of the tree under build-mutate, so that nothing here is touched. Takes some seconds per mutant: not part
of CI. Exit code 1 where a mutant survives.
"""

import argparse
import pathlib
import random
import re
import shutil
import subprocess
import sys

root = pathlib.Path(__file__).resolve().parents[2]
work = root / "build-mutate"
copy, build = work / "source", work / "build"

# Each file with where its rules begin, and the tests that must notice.
files = {
    "lang/ir/derive/derivative_rules.cpp": ("Term zero_where_zero", ["derivative*"]),
    "lang/ir/bounds/interval.cpp": ("", ["intervals*,bounds*,slope*,class*"]),
    "lang/ir/bounds/interval_call.cpp": ("", ["intervals*,bounds*,slope*,class*"]),
    "lang/ir/bounds/variation.cpp": ("", ["intervals*,bounds*,slope*,class*"]),
}

# What is broken, and into what: one place of a rule at a time.
changes = [
    (r" \+ ", " - "),
    (r" - ", " + "),
    (r" \* ", " / "),
    (r" / ", " * "),
    (r"Op::sin\b(?!:)", "Op::cos"),
    (r"Op::cos\b(?!:)", "Op::sin"),
    (r"Op::sinh\b(?!:)", "Op::cosh"),
    (r"Op::cosh\b(?!:)", "Op::sinh"),
    (r"Op::sinturn\b(?!:)", "Op::costurn"),
    (r"Op::costurn\b(?!:)", "Op::sinturn"),
    (r"Op::floor\b(?!:)", "Op::ceil"),
    (r"Op::log\b(?!:)", "Op::log2"),
    (r"Op::sqrt\b(?!:)", "Op::abs"),
    (r"Op::sign\b(?!:)", "Op::floor"),
    (r"Op::lt\b(?!:)", "Op::le"),
    (r"Op::land\b(?!:)", "Op::lor"),
    (r"\b1\.0\b", "2.0"),
    (r"\b0\.5\b", "0.25"),
    (r"\b2 \* pi", "3 * pi"),
    (r"\bln2 \* ", ""),
    (r"-apply", "apply"),
    (r"-\(da", "(da"),
    (r"\(-da\)", "(da)"),
    (r"-2 \* pi", "2 * pi"),
    (r"term\((\w), 1\)", r"term(\1, 2)"),
    (r"term\((\w), 0\)", r"term(\1, 1)"),
    (r"zero_where_zero\(([\w]+), ", r"unguarded(\1, "),
    (r"pick\(a, b, (\w+), (\w+)\)", r"pick(a, b, \2, \1)"),
    (r"\bdb, dc\b", "dc, db"),
    (r"return (\(.*\)|pick.*|da|where.*)\.value;", "return {};"),
    (r"return unary\((.*)\);$", "return {};"),
    (r" < ", " <= "),
    (r" <= ", " < "),
    (r" > ", " >= "),
    (r"\bmin\(", "max("),
    (r"\bmax\(", "min("),
    (r"\blow\b", "high"),
    (r"\bhigh\b", "low"),
]
prelude = "[[maybe_unused]] Term unguarded(const Term&, const Term& partial)\n{\n    return partial;\n}\n\n"


def mutants_of(name, text):
    """(what, text) of each."""
    start, _ = files[name]
    begin = text.index(start) if start else text.index("{")
    made, at, rule = [], 0, ""
    for line in text.splitlines(keepends=True):
        position, at = at, at + len(line)
        code = line.split("//")[0]
        found = re.search(r"case Op::(\w+):|^(?:\w+ )+(\w+)\(", code)
        if found:
            rule = found.group(1) or found.group(2)
        # Which operations have rules at all is a promise to callers: without it their rules return nothing, too. What
        # stands behind the end of the operands is never used.
        if rule == "has_derivative" or "operands.size()" in code or "tangents.size()" in code:
            continue
        if position < begin or code.lstrip().startswith(("#", "using", "namespace", "for ", "template")):
            continue
        for pattern, replacement in changes:
            for match in re.finditer(pattern, code):
                new = match.expand(replacement)
                place = position + match.start()
                whole = text[:place] + new + text[place + len(match.group(0)):]
                if "unguarded(" in new:
                    mark = whole.index("// Taken side where")
                    whole = whole[:mark] + prelude + whole[mark:]
                number = text.count("\n", 0, position) + 1
                made.append((f"{name}:{number} {rule}: '{match.group(0).strip()}' -> '{new.strip()}'", whole))
    return made


def run(command, limit_s=900):
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=limit_s, check=False)
    except subprocess.TimeoutExpired:
        return 124, b"too long"
    return done.returncode, done.stdout


def prepare():
    work.mkdir(exist_ok=True)
    tracked = subprocess.run(["git", "-C", root, "ls-files", "-z"], stdout=subprocess.PIPE, check=True).stdout
    for name in tracked.decode().split("\0"):
        source, target = root / name, copy / name
        if not name or not source.is_file():
            continue
        if target.is_file() and target.read_bytes() == source.read_bytes():
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source, target)
    if not (build / "build.ninja").exists():
        code, said = run(["cmake", "-S", copy, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug",
                          "-DCMAKE_CXX_FLAGS_DEBUG=-O1", "-DHAPTEL_TOOLS=OFF", "-DHAPTEL_WERROR=OFF"])
        if code:
            sys.exit(said.decode())


def is_caught(name):
    """None where it does not compile."""
    code, said = run(["cmake", "--build", build, "--target", "lang_ir_test"])
    if code:
        return None, said
    code, said = run([build / "bin" / "lang_ir_test", *files[name][1]], 300)
    return code != 0, said


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", action="store_true", help="show the mutants, run none")
    parser.add_argument("--limit", type=int, help="run so many, chosen at random")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("files", nargs="*", metavar="FILE", help=" ".join(files))
    arguments = parser.parse_args()
    names = arguments.files or ["lang/ir/derive/derivative_rules.cpp"]
    mutants = [(name, *mutant) for name in names for mutant in mutants_of(name, (root / name).read_text())]
    if arguments.limit and arguments.limit < len(mutants):
        mutants = random.Random(arguments.seed).sample(mutants, arguments.limit)
    if arguments.list:
        print("\n".join(what for _, what, _ in mutants))
        return 0

    prepare()
    for name in names:
        caught, said = is_caught(name)
        if caught is not False:
            sys.exit(said.decode() + f"\nthe tests of {name} must pass before it is broken")
    survivors, caught_count, broken = [], 0, 0
    for number, (name, what, text) in enumerate(mutants, 1):
        original = (copy / name).read_text()
        (copy / name).write_text(text)
        try:
            caught, _ = is_caught(name)
        finally:
            (copy / name).write_text(original)
        broken += caught is None
        caught_count += caught is True
        if caught is False:
            survivors.append(what)
        word = {None: "does not compile", True: "caught", False: "SURVIVED"}[caught]
        print(f"{number}/{len(mutants)} {word}: {what}", flush=True)
    print(f"\n{caught_count} of {len(mutants) - broken} mutants caught; {broken} did not compile")
    for what in survivors:
        print(f"survived: {what}")
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main())
