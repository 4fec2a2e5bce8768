#!/usr/bin/env python3
"""Small faults put into the core one at a time, and whether core_tests notices.

    test/mutation.py BUILD [COUNT [SEED]]    BUILD: a built tree of this checkout; 50 faults by seed 1

A fault is another sign, comparison, bound or constant in a line of src/core. It is noticed if the tests of its room fail, or,
where they do not, any other of core_tests; a run of more than five minutes counts as a failure. What does not compile does not
count. The file is restored after each; the tree must not be worked on in the meantime.
"""
import pathlib
import random
import re
import subprocess
import sys

CHECKOUT = pathlib.Path(__file__).resolve().parent.parent
CORE = CHECKOUT / "src" / "core"
TIME_LIMIT = 300  # [s]

# What is looked for, and what takes its place; spaces on both sides keep templates and pointers out. Bounds of loops are moved by
# one; of real numbers that would be nothing, so that other comparisons are turned round.
FAULTS = [(r"(?<=for \().* < ", lambda m: m[0][:-3] + " <= "), (r" < ", " >= "), (r" <= ", " > "), (r" > ", " <= "),
          (r" >= ", " < "), (r" == ", " != "), (r" \+ ", " - "), (r" - ", " + "), (r" \* ", " / "), (r" / ", " * "),
          (r" && ", " || "), (r" \|\| ", " && "), (r" \+= ", " -= "),
          (r"\bstd::min\(", "std::max("), (r"\bstd::max\(", "std::min("), (r"(?<== )-(?=\w)", ""), (r"\breturn !", "return "),
          (r"(?<![\w.\"])(\d+\.\d+)(?![\w\"])", lambda m: str(1.5 * float(m[1]) or 0.5)),
          (r"(?<![\w.\"<\[])([1-9]\d*)(?![\w.\">])", lambda m: str(int(m[1]) + 1))]


def code(line):
    """The line without its comment; nothing where it holds no work to be done: text, headers, templates."""
    line = line.split("//")[0]
    is_work = not re.match(r"\s*(#|\*|/\*|template|namespace|using|static_assert)|.*\"", line)
    return line if is_work else ""


def faults():
    """All places: file, number of the line, the line with the fault."""
    found = []
    for path in sorted(CORE.rglob("*.cpp")):
        for number, line in enumerate(path.read_text().splitlines()):
            for wanted, other in FAULTS:
                for match in re.finditer(wanted, code(line)):
                    found.append((path, number, line[:match.start()] + match.expand(other) + line[match.end():]
                                  if isinstance(other, str) else line[:match.start()] + other(match) + line[match.end():]))
    return found


def suites(room):
    """The names of the tests of a room as a filter."""
    names = set()
    for path in (CHECKOUT / "test" / "core" / room).glob("*.cpp"):
        names.update(re.findall(r"\bTEST(?:_F|_P)?\((\w+),", path.read_text()))
    return ":".join(f"*{name}.*" for name in sorted(names))


def passes(program, chosen):
    try:
        return subprocess.run([program, "--gtest_brief=1", "--gtest_fail_fast", f"--gtest_filter={chosen}"],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=TIME_LIMIT).returncode == 0
    except subprocess.TimeoutExpired:
        return False


def is_noticed(build, path):
    """None where it does not compile."""
    if subprocess.run(["cmake", "--build", build, "--target", "core_tests"], stdout=subprocess.DEVNULL,
                      stderr=subprocess.DEVNULL).returncode != 0:
        return None
    program, room = build / "test" / "core_tests", suites(path.relative_to(CORE).parts[0])
    return not (passes(program, room) and passes(program, "-" + room))


def main():
    if len(sys.argv) not in (2, 3, 4):
        sys.exit(__doc__)
    build, count, seed = pathlib.Path(sys.argv[1]).resolve(), *map(int, (sys.argv[2:] + ["50", "1"][len(sys.argv) - 2:]))
    places = faults()
    random.Random(seed).shuffle(places)
    noticed = tried = 0
    for path, number, changed in places:
        original = path.read_text()
        lines = original.splitlines()
        before, lines[number] = lines[number].strip(), changed
        try:
            path.write_text("\n".join(lines) + "\n")
            verdict = is_noticed(build, path)
        finally:
            path.write_text(original)
        if verdict is None:
            continue
        noticed, tried = noticed + verdict, tried + 1
        print(f"{'noticed ' if verdict else 'SURVIVED'} {path.relative_to(CHECKOUT)}:{number + 1}: {before}"
              f"  ->  {changed.strip()}", flush=True)
        if tried == count:
            break
    print(f"{noticed} of {tried} faults were noticed, of {len(places)} places, seed {seed}")


if __name__ == "__main__":
    main()
