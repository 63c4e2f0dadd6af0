"""Each pattern of SLOW and REALTIME (cmake/PmgTargets.cmake) is that of a test: one that was renamed would lose its label in silence.

Usage: labels_test.py BUILD_DIR; test programs that aren't built are left out, with a word
"""

import pathlib
import subprocess
import sys


def matching(program, pattern):
    """How many of a GoogleTest program's tests a pattern lets through."""
    command = [program, f"--gtest_filter={pattern}", "--gtest_list_tests"]
    listed = subprocess.run(command, capture_output=True, text=True, check=True, timeout=60).stdout
    return sum(line.startswith("  ") for line in listed.splitlines())


def main():
    build = pathlib.Path(sys.argv[1])
    rows = [line.split(" ", 1) for line in (build / "labelled_tests.txt").read_text().splitlines()]
    built = [(name, pattern) for name, pattern in rows if (build / "bin" / name).exists()]
    empty = [f"{name}: no test is {pattern}" for name, pattern in built if not matching(build / "bin" / name, pattern)]
    print(f"{len(built)} of {len(rows)} patterns looked at; the programs of the others aren't built")
    print("\n".join(empty))
    return 1 if empty or not built else 0


if __name__ == "__main__":
    sys.exit(main())
