#!/usr/bin/env python3
"""Breaks the product in one place at a time, at random, and expects a red test: what survives is not tested.

    ./dev mutate [--folder FOLDER]... [--count N] [--seed S] [--seconds S] [--jobs N] [--list] [--resume]

A mutant differs by one token: a comparison, a sign, a constant, a condition turned round, a statement that is gone, two
arguments swapped, nothing returned. Places are drawn kind by kind from the folders or files that are named (all of the
product's otherwise); the same tree and seed give the same mutants. Each is built as far as a test program needs, the
programs of the nearest tests first and the quick ones before the slow, and is killed by the first one that fails,
crashes or takes many times as long as it does otherwise. One that does not compile is replaced by the next, and so is one
that leaves every program as it is to the byte: no test can tell it apart. Exit code 1 where one survives.

Works in copies of the tree under build-mutate, one for each job, so that nothing here is touched. Some seconds to
minutes for each mutant, and a build and a run of all tests before the first: not part of CI. --resume goes on where a
run was stopped.
"""

import argparse
import collections
import concurrent.futures
import hashlib
import itertools
import json
import math
import os
import pathlib
import queue
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile

root = pathlib.Path(__file__).resolve().parents[2]
work = root / "build-mutate"
everything = ["lang", "jit", "runtime", "device", "tools"]
memory_max = 8 << 30  # bytes of one test program

# A broken line may leave a variable unused, or compare what is never less: it is to be found by a test, not by that.
quiet = "".join(
    f'#pragma GCC diagnostic ignored "-W{warning}"\n'
    for warning in ["pragmas", "unknown-warning-option", "unused-variable", "unused-but-set-variable", "type-limits",
                    "unused-parameter", "unused-function", "unused-value", "div-by-zero", "parentheses", "conversion",
                    "unused-const-variable", "unused-private-field", "unused-lambda-capture", "bool-compare",
                    "tautological-compare", "float-conversion", "int-in-bool-context", "sign-compare", "empty-body"])
quiet += "#line 1\n"  # every line keeps its number, or programs would differ by that

no_mutant = ["does not compile", "cannot differ"]
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
    ("arguments", re.compile(r"(?<=\w)(?<!::min)(?<!::max)(?<!::swap)(?<!::dot)(?<!::distance)\(([\w.]+(?:\([\w., ]*\))?), ([\w.]+(?:\([\w., ]*\))?)\)"),
     lambda m: f"({m.group(2)}, {m.group(1)})"),
    ("return", re.compile(r"\breturn (?!(?:false|0|0\.0|nullptr|std::nullopt);)[^;{}]+;"), lambda m: "return {};"),
]


class Found:
    """A match in the blanked text, with the words of the text itself."""

    def __init__(self, match, text):
        self.match, self.text = match, text

    def group(self, number):
        return self.text[self.match.start(number):self.match.end(number)]


def places_of(name):
    text = (root / name).read_text()
    code = code_of(text)
    found = []
    for kind, pattern, replace in patterns:
        for match in pattern.finditer(code):
            before, after = text[match.start():match.end()], replace(Found(match, text))
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


def digest(program):
    """Of all that runs."""
    with tempfile.NamedTemporaryFile(dir=work) as bare:
        subprocess.run(["objcopy", "--strip-debug", "--remove-section=.note.gnu.build-id", program, bare.name], check=True)
        return hashlib.sha256(pathlib.Path(bare.name).read_bytes()).digest()


class Tree:
    """A copy of the tree, built, with its tests as (folder, name, programs, whether a program alone is the command)."""

    def __init__(self, number):
        self.copy = work / f"tree{number}"
        self.build = self.copy / "build-test"  # where the preset has it: a compiler cache finds what another tree built
        self.tests, self.cost_s, self.made_of, self.unbroken = [], {}, {}, {}

    def prepare(self):
        """As the tree is, with the times of what is the same; everything built, every test green and its cost known."""
        names = set(tracked())
        for name in names:
            source, target = root / name, self.copy / name
            if not target.is_file() or target.read_bytes() != source.read_bytes():
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(source, target)
                shutil.copymode(source, target)
        for old in self.copy.rglob("*"):
            if old.is_file() and self.build not in old.parents and str(old.relative_to(self.copy)) not in names:
                old.unlink()
        for command in (["cmake", "-S", self.copy, "--preset", "test"], ["cmake", "--build", self.build]):
            code, said = run(command)
            if code:
                sys.exit(said)
        for listing in sorted(self.build.rglob("CTestTestfile.cmake")):
            folder = listing.parent.relative_to(self.build).as_posix()
            for name, rest in re.findall(r"^add_test\(\[=\[(.*?)\]=\]((?: \"[^\"]*\")+)\)", listing.read_text(), re.M):
                command = re.findall(r'"([^"]*)"', rest)
                programs = [pathlib.Path(word) for word in command if f"{self.build}/bin/" in word]
                if programs:
                    self.tests.append((folder, name, programs, len(command) == 1))

    def measure(self, kept):
        """What each test costs in seconds; kept in a file, since the same for all copies."""
        if not kept.is_file():
            names = "|".join(re.escape(test[1]) for test in self.tests)
            code, said = run(["ctest", "--test-dir", self.build, "--parallel", str(os.cpu_count()), "--output-on-failure",
                              "-R", f"^({names})$"])
            if code:
                sys.exit(f"{said[-4000:]}\nall tests must pass before anything is broken")
            shutil.copyfile(self.build / "Testing" / "Temporary" / "CTestCostData.txt", kept)
        for line in kept.read_text().splitlines():
            words = line.split()
            if len(words) == 3:
                self.cost_s[words[0]] = float(words[2])

    def find_uses(self):
        """Which programs are made of which files, by what the compilers read."""
        reads, name = collections.defaultdict(set), ""
        for line in run(["ninja", "-C", self.build, "-t", "deps"])[1].splitlines():
            if line.startswith("    "):
                reads[name].add(os.path.normpath(self.build / line.strip()))
            else:
                name = line.split(":")[0]
        for program in {program for test in self.tests for program in test[2]}:
            _, said = run(["ninja", "-C", self.build, "-t", "inputs", program.relative_to(self.build)])
            files = set().union(*(reads[line] for line in said.splitlines() if line in reads))
            self.made_of[program] = {os.path.relpath(file, self.copy) for file in files}
            self.unbroken[program] = digest(program)

    def nearest(self, file):
        """Tests of programs that the file is in: those of its top folder first, and the quick before the slow."""
        top = pathlib.PurePath(file).parts[0]
        within = [test for test in self.tests if any(file in self.made_of[program] for program in test[2])]
        return sorted(within, key=lambda test: (top not in pathlib.PurePath(test[0]).parts, self.cost_s.get(test[1], 0)))

    def is_green(self, test):
        """None where it takes too long. What is broken may fill the memory, or a home."""
        _, name, programs, is_alone = test
        limit_s = 30 + 5 * self.cost_s.get(name, 600)
        command = [programs[0], "--abort"] if is_alone else ["ctest", "--test-dir", self.build, "-R", f"^{re.escape(name)}$"]
        with tempfile.TemporaryDirectory(dir=work) as home, subprocess.Popen(
                command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True, cwd=self.build,
                env={**os.environ, "HOME": home, "HAPTEL_CACHE": str(self.build / "test-cache")},
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (memory_max, memory_max))) as running:
            try:
                return running.wait(limit_s) == 0
            except subprocess.TimeoutExpired:
                os.killpg(running.pid, signal.SIGKILL)
                return None

    def verdict(self, place, seconds):
        """(word, by which test) of a mutant; one of `no_mutant`, by none."""
        target = self.copy / place.file
        original = target.read_text()
        tests, spent_s = self.nearest(place.file), 0
        same = bool(tests)
        lines = "\n" * (original.count("\n", place.start, place.end) - place.after.count("\n"))
        target.write_text(quiet + original[:place.start] + place.after + lines + original[place.end:])
        try:
            for test in tests:
                cost_s = self.cost_s.get(test[1], 0)
                if spent_s and spent_s + cost_s > seconds:
                    continue
                code, _ = run(["cmake", "--build", self.build, "--target", *{program.name for program in test[2]}])
                if code:
                    return "does not compile", ""
                if all(digest(program) == self.unbroken[program] for program in test[2]):
                    continue
                same = False
                spent_s += cost_s
                green = self.is_green(test)
                if not green:
                    return "killed" if green is False else "killed by time", test[1]
            return "cannot differ" if same else "SURVIVED", ""
        finally:
            target.write_text(original)


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
    parser.add_argument("--count", type=int, default=20, help="mutants that compile to something else; 0: all there are")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=math.inf, help="what the tests of a mutant may cost together")
    parser.add_argument("--jobs", type=int, default=1, help="mutants at once, each in a copy of some gigabytes")
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
    trees = queue.Queue()
    for number in range(arguments.jobs):
        tree = Tree(number)
        tree.prepare()
        tree.find_uses()
        tree.measure(work / "seconds.txt")
        trees.put(tree)
    os.environ["CCACHE_READONLY"] = "1"

    def judged(place):
        if tuple(place) in known:
            return place, *known[tuple(place)]
        tree = trees.get()
        try:
            word, by = tree.verdict(place, arguments.seconds)
        finally:
            trees.put(tree)
        kept.write(json.dumps([place, word, by]) + "\n")
        kept.flush()
        return place, word, by

    with record.open("a" if arguments.resume else "w") as kept, \
            concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        while len(results) < wanted:
            places = list(itertools.islice(mutants, min(wanted - len(results), 20)))
            for place, word, by in pool.map(judged, places):
                if word in no_mutant:
                    continue
                results.append((place, word, by))
                print(f"{len(results)} {word}{f' by {by}' if by else ''}: {shown(place)}", flush=True)
            if not places:
                break
    survivors = [place for place, word, _ in results if word == "SURVIVED"]
    print(f"\n{table(results)}")
    for place in survivors:
        print(f"\nsurvived: {place.file}:{place.line} {place.kind}\n  - {place.before}\n  + {place.after}")
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main())
