#!/usr/bin/env python3
"""Breaks the product in one place at a time, at random, and expects a red test: what survives is not tested.

    ./dev mutate [--folder FOLDER]... [--count N] [--seed S] [--programs N] [--list] [--resume]

A mutant differs by one token: a comparison, a sign, a constant, a condition turned round, a statement that is gone, two
arguments swapped, nothing returned. Places are drawn kind by kind from the folders or files that are named (all of the
product's otherwise); the same tree and seed give the same mutants. Each is built as far as a test program needs, the
programs of the nearest tests first, and is killed by the first one that fails, crashes or takes many times as long as
it does otherwise. One that does not compile is replaced by the next. Exit code 1 where one survives.

Works in a copy of the tree under build-mutate, so that nothing here is touched. Some seconds to minutes for each mutant,
and a build of all that it needs before the first: not part of CI. --resume goes on where a run was stopped.
"""

import argparse
import collections
import json
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import time

root = pathlib.Path(__file__).resolve().parents[2]
work = root / "build-mutate"
copy = work / "tree"
build = copy / "build-test"  # where the preset has it: a compiler cache finds what another tree has built
everything = ["lang", "jit", "runtime", "device", "tools"]
memory_max = 8 << 30  # bytes of one test program

# A broken line may leave a variable unused, or compare what is never less: it is to be found by a test, not by that.
quiet = "".join(
    f'#pragma GCC diagnostic ignored "-W{warning}"\n'
    for warning in ["pragmas", "unknown-warning-option", "unused-variable", "unused-but-set-variable", "type-limits",
                    "unused-parameter", "unused-function", "unused-value", "div-by-zero", "parentheses", "conversion",
                    "unused-const-variable", "unused-private-field", "unused-lambda-capture", "bool-compare",
                    "tautological-compare", "float-conversion", "int-in-bool-context", "sign-compare", "empty-body"])

Place = collections.namedtuple("Place", "file line kind start end before after")  # start, end: in the file's text


def code_of(text):
    """The text with comments, literals in quotes and preprocessor lines blanked, every other character in its place."""
    pattern = r'//[^\n]*|/\*.*?\*/|R"\w*\(.*?\)\w*"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'|(?m:^[ \t]*#(?:\\\n|[^\n])*)'
    digits = re.compile(r"\d'\d")

    def blank(match):
        found = match.group(0)
        if found[0] == "'" and digits.match(text, match.start() - 1):
            return found  # 1'000
        return re.sub(r"[^\n]", " ", found)

    return re.sub(pattern, blank, text, flags=re.S)


def one_more(number):
    if re.fullmatch(r"\d+", number):
        return str(int(number) + 1)
    return f"(2 * {number})" if float(number.replace("'", "").rstrip("f") or 0) else "1.0"


swaps = {
    "comparison": {" < ": " <= ", " <= ": " < ", " > ": " >= ", " >= ": " > ", " == ": " != ", " != ": " == "},
    "arithmetic": {" + ": " - ", " - ": " + ", " * ": " / ", " / ": " * ", " += ": " -= ", " -= ": " += ",
                   " *= ": " /= ", "::min(": "::max(", "::max(": "::min(", "++": "--"},
    "logic": {" && ": " || ", " || ": " && ", "true": "false", "false": "true"},
    "operation": {"Op::sin": "Op::cos", "Op::cos": "Op::sin", "Op::floor": "Op::ceil", "Op::add": "Op::sub",
                  "Op::mul": "Op::div", "Op::min": "Op::max", "Op::max": "Op::min", "Op::sqrt": "Op::abs",
                  "Op::lt": "Op::le", "Op::land": "Op::lor", ".minimum": ".maximum", ".maximum": ".minimum"},
}


def words(table):
    return "|".join(re.escape(word) + (r"\b" if word[-1].isalnum() else "") for word in table)


patterns = [(kind, re.compile(words(table)), lambda m, table=table: table[m.group(0)]) for kind, table in swaps.items()]
patterns += [
    ("constant", re.compile(r"(?<![\w.'<\[])(?:\d+\.\d*(?:e[-+]?\d+)?|\d+e[-+]?\d+|\d+)(?![\w.'\]]|\s*>)"),
     lambda m: one_more(m.group(0))),
    ("condition", re.compile(r"\b(if|while) (\((?:[^();{}]|\((?:[^();{}]|\([^();{}]*\))*\))*\))"),
     lambda m: f"{m.group(1)} (!{m.group(2)})"),
    ("statement", re.compile(r"(?<=[;{}\n])(?<!,\n)[ \t]*(?:\+\+|--)?[\w:]+(?:(?:\.|->)\w+|\[[^;\[\]]*\])*"
                             r"(?: [-+*/|&]?= [^;{}]*|\([^;{}]*\))?;(?=\n)"), lambda m: ";"),
    ("arguments", re.compile(r"(?<=\w)(?<!::min)(?<!::max)(?<!glm::dot)\(([\w.]+(?:\([\w., ]*\))?), ([\w.]+(?:\([\w., ]*\))?)\)"),
     lambda m: f"({m.group(2)}, {m.group(1)})"),
    ("return", re.compile(r"\breturn (?!(?:false|0|0\.0|nullptr|std::nullopt);)[^;{}]+;"), lambda m: "return {};"),
]


def places_of(name):
    text = (root / name).read_text()
    code = code_of(text)
    found = []
    for kind, pattern, replace in patterns:
        for match in pattern.finditer(code):
            before, after = text[match.start():match.end()], replace(match)
            head = code[code.rfind("\n", 0, match.start()) + 1:match.start()]
            declares = kind == "statement" and re.match(r"\s*(return|break|continue|using|friend|else|default)\b", before)
            if before == after or declares or re.match(r"\s*(static_assert|template|namespace|enum|case)\b", head):
                continue
            if kind == "arguments" and match.group(1) == match.group(2):
                continue
            if kind == "statement" and not re.search(r"[;{})]\s*$|^\s*$|\belse\s*$", code[:match.start()]):
                continue
            line = code.count("\n", 0, match.end() - len(before.lstrip())) + 1
            found.append(Place(name, line, kind, match.start(), match.end(), before.strip(), after.strip()))
    return found


def drawn(names, seed):
    """All places, the kinds in turn."""
    chance, by_kind = random.Random(seed), collections.defaultdict(list)
    for name in names:
        for place in places_of(name):
            by_kind[place.kind].append(place)
    for kind in sorted(by_kind):
        chance.shuffle(by_kind[kind])
    while by_kind:
        for kind in chance.sample(sorted(by_kind), len(by_kind)):
            yield by_kind[kind].pop()
            if not by_kind[kind]:
                del by_kind[kind]


def run(command, **how):
    """Exit code, and what it said."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False, **how)
    return done.returncode, done.stdout.decode(errors="replace")


def tracked():
    listed = subprocess.run(["git", "-C", root, "ls-files", "-z"], stdout=subprocess.PIPE, check=True).stdout
    return [name for name in listed.decode().split("\0") if name and (root / name).is_file()]


def prepare():
    """The copy as the tree is, with the times of what is the same, and configured."""
    names = set(tracked())
    for name in names:
        source, target = root / name, copy / name
        if not target.is_file() or target.read_bytes() != source.read_bytes():
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, target)
            shutil.copymode(source, target)
    for old in copy.rglob("*"):
        if old.is_file() and build not in old.parents and str(old.relative_to(copy)) not in names:
            old.unlink()
    code, said = run(["cmake", "-S", copy, "--preset", "test"])
    if code:
        sys.exit(said)


class Tests:
    """Each as (folder, name, targets, programs), and how long it takes, once that is known."""

    def __init__(self):
        self.all, self.took_s = [], {}
        for listing in sorted(build.rglob("CTestTestfile.cmake")):
            folder = listing.parent.relative_to(build).as_posix()
            for name, rest in re.findall(r"^add_test\(\[=\[(.*?)\]=\]((?: \"[^\"]*\")+)\)", listing.read_text(), re.M):
                programs = [pathlib.Path(word) for word in re.findall(r'"([^"]*)"', rest) if f"{build}/bin/" in word]
                if programs:
                    self.all.append((folder, name, programs))

    def nearest(self, file):
        """Those of the folder that mirrors the file's first, then in the order of how much of the way is the same."""
        folders = pathlib.PurePath(file).parent.parts

        def distance(test):
            own = pathlib.PurePath(test[0]).parts[1:]
            same = next((i for i, (a, b) in enumerate(zip(folders, own)) if a != b), min(len(folders), len(own)))
            return -same, len(own) - same, test[1].startswith("link_")

        return sorted(self.all, key=distance)

    def build_programs(self, test):
        return run(["cmake", "--build", build, "--target", *{program.name for program in test[2]}])

    def run_one(self, test):
        """True where it is green, None where it takes too long. What is broken may fill the memory, or a home."""
        limit_s = 30 + 5 * self.took_s[test[1]] if test[1] in self.took_s else 3600
        begun = time.monotonic()
        code, said = run(["ctest", "--test-dir", build, "-R", f"^{re.escape(test[1])}$", "--timeout", str(int(limit_s))],
                         env={**os.environ, "HOME": str(work)},
                         preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (memory_max, memory_max)))
        if "***Timeout" in said:
            return None
        self.took_s.setdefault(test[1], time.monotonic() - begun)
        return code == 0

    def verdict(self, place, programs):
        """(word, by which test) of a mutant; "does not compile"."""
        target = copy / place.file
        original = target.read_text()
        broken = quiet + original[:place.start] + place.after + original[place.end:]

        def times(test):
            return [program.stat().st_mtime_ns for program in test[2]]

        asked = 0
        for test in self.nearest(place.file):
            if asked == programs:
                break
            code, said = self.build_programs(test)
            if code or (test[1] not in self.took_s and not self.run_one(test)):
                sys.exit(f"{said[-4000:]}\n{test[1]} must pass before anything is broken")
            before = times(test)
            target.write_text(broken)
            os.environ["CCACHE_READONLY"] = "1"
            try:
                code, said = self.build_programs(test)
                if code:
                    return "does not compile", ""
                if times(test) == before:
                    continue  # nothing of it is in there
                asked += 1
                green = self.run_one(test)
                if not green:
                    return "killed" if green is False else "killed by time", test[1]
            finally:
                del os.environ["CCACHE_READONLY"]
                target.write_text(original)
        return "SURVIVED", ""


def table(results):
    lines = [f"{'folder':24}{'mutants':>8}{'killed':>8}{'by time':>8}{'survived':>9}"]
    folders = collections.defaultdict(collections.Counter)
    for place, word, _ in results:
        for row in (str(pathlib.PurePath(place.file).parent), "in all"):
            folders[row][word] += 1
    for name, count in sorted(folders.items(), key=lambda row: (row[0] == "in all", row[0])):
        killed = count["killed"] + count["killed by time"]
        lines.append(f"{name:24}{count.total() if hasattr(count, 'total') else sum(count.values()):>8}{killed:>8}"
                     f"{count['killed by time']:>8}{count['SURVIVED']:>9}")
    return "\n".join(lines)


def shown(place):
    def one_line(text):
        return " ".join(text.split())

    return f"{place.file}:{place.line} {place.kind}: `{one_line(place.before)}` -> `{one_line(place.after)}`"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--folder", action="append", help=f"or a file; {' '.join(everything)} where none is named")
    parser.add_argument("--count", type=int, default=20, help="mutants that compile; 0: all there are")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--programs", type=int, default=0, help="run at most so many tests on each; 0: all that it is in")
    parser.add_argument("--list", action="store_true", help="show the mutants, run none")
    parser.add_argument("--resume", action="store_true", help="go on with the list of the last run")
    arguments = parser.parse_args()
    folders = [folder.rstrip("/") for folder in arguments.folder or everything]
    names = sorted(name for name in tracked() if name.endswith((".cpp", ".h"))
                   and any(name == folder or name.startswith(folder + "/") for folder in folders))
    if not names:
        parser.error(f"no C++ below {' '.join(folders)}")
    mutants = drawn(names, arguments.seed)
    wanted = arguments.count or sys.maxsize
    if arguments.list:
        for _, place in zip(range(wanted), mutants):
            print(shown(place))
        return 0

    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # restores what is broken on the way
    work.mkdir(exist_ok=True)
    record, known, results = work / "results.jsonl", {}, []
    if arguments.resume and record.is_file():
        known = {tuple(place): (word, by) for place, word, by in map(json.loads, record.read_text().splitlines())}
    prepare()
    tests = Tests()
    with record.open("a" if arguments.resume else "w") as kept:
        for place in mutants:
            if len(results) == wanted:
                break
            word, by = known.get(tuple(place)) or tests.verdict(place, arguments.programs or sys.maxsize)
            if tuple(place) not in known:
                kept.write(json.dumps([place, word, by]) + "\n")
                kept.flush()
            if word == "does not compile":
                continue
            results.append((place, word, by))
            print(f"{len(results)} {word}{f' by {by}' if by else ''}: {shown(place)}", flush=True)
    survivors = [place for place, word, _ in results if word == "SURVIVED"]
    print(f"\n{table(results)}")
    for place in survivors:
        print(f"\nsurvived: {place.file}:{place.line} {place.kind}\n  - {place.before}\n  + {place.after}")
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main())
