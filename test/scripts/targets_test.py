"""Each program of a build folder that a script or a page names is one that the build makes.

Usage: targets_test.py BUILD_DIR
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
NAMED = re.compile(r"build/[^ ]*bin/(?P<name>\w+)(?!\w*\$)")
TO_BUILD = re.compile(r"scripts/build(?: \S*)? (?P<name>test_\w+)")


def named(text):
    """Names of programs in a script's or a page's text; a name that a variable completes is none."""
    return {m["name"] for pattern in (NAMED, TO_BUILD) for m in pattern.finditer(text) if not m["name"].endswith("_")}


def main():
    lines = (pathlib.Path(sys.argv[1]) / "build.ninja").read_text().splitlines()
    made = {m[1] for line in lines if (m := re.match(r"build bin/(\w+)[ :]", line))}
    files = [f for folder in ("scripts", "docs", ".ci") for f in (ROOT / folder).rglob("*") if f.is_file()]
    texts = {f.relative_to(ROOT): f.read_text(errors="replace") for f in [*files, *ROOT.glob("*.md")]}
    names = {(file, name) for file, text in texts.items() for name in named(text)}
    wrong = [f"{file}: the build makes no {name}" for file, name in sorted(names) if name not in made]
    print(f"{len(names)} names in {len(texts)} files, {len(made)} programs")
    print("\n".join(wrong))
    return 1 if wrong or not names or not made else 0


if __name__ == "__main__":
    sys.exit(main())
