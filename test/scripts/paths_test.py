"""What the pages name is there: relative links with their anchors, images, paths and source files in code, builds. So is every page of
docs/ that a source file names."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FOLDERS = ("apps", "cmake", "config", "docs", "include", "msgs", "scripts", "src", "test", "training")
BUILDS = ("release", "ci", "tidy", "debug", "asan", "tsan")  # of CMakePresets.json, each in build/NAME
OUTPUTS = ("build", "out")  # there or not, as the tree was used; which builds there can be is checked apart
FENCE = re.compile(r"^ *```.*?^ *```", re.M | re.S)
SOURCE_NAME = re.compile(r"[\w-]+\.(?:cpp|hpp|md|py|sh)")
PATH = re.compile(r"[\w.*-]+(?:/[\w.*-]*)+")  # without <name>, {a,b} and other placeholders


def anchors(text):
    """GitHub's, of the headings."""
    headings = re.findall(r"^#+ +(.*)$", FENCE.sub("", text), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def link_is_there(page, target):
    name, _, anchor = target.partition("#")
    file = page.parent / name if name else page
    return file.exists() and (not anchor or anchor in anchors(file.read_text()))


def path_is_there(page, path):
    """From the project's root or the page's folder; true of a path that begins in a folder of another project or of outputs."""
    first = path.split("/")[0]
    if first in OUTPUTS:
        return True
    ours = first in (*FOLDERS, "third_party") or (page.parent / first).is_dir()
    return not ours or any(any(folder.glob(path.rstrip("/"))) for folder in (ROOT, page.parent))


def wrong_names(page, text, source_names):
    """All that the text of a page names and that isn't there."""
    prose = FENCE.sub("", text)
    links = [link for link in re.findall(r"\]\(([^)\s]+)\)", prose) if "://" not in link]
    code = " ".join(FENCE.findall(text) + re.findall(r"`([^`\n]+)`", prose))
    words = set(re.split(r"[\s=`'\"]+", code))
    return sorted(
        [link for link in links if not link_is_there(page, link)]
        + [word for word in words if SOURCE_NAME.fullmatch(word) and word not in source_names]
        + [word for word in words if PATH.fullmatch(word) and not path_is_there(page, word)]
        + [f"build/{name}" for name in re.findall(r"\bbuild/(\w+)/", text) if name not in BUILDS]
    )


class Names(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.files = [file for folder in FOLDERS for file in (ROOT / folder).rglob("*") if file.is_file()]
        cls.source_names = {file.name for file in (*ROOT.iterdir(), *cls.files)}

    def wrong(self, page, text):
        return wrong_names(ROOT / page, text, self.source_names)

    def test_everything_that_a_page_names_is_there(self):
        for page in ("README.md", "training/README.md", *(ROOT / "docs").rglob("*.md")):
            with self.subTest(page=page):
                self.assertEqual(self.wrong(page, (ROOT / page).read_text()), [])

    def test_every_page_is_in_the_index(self):
        index = (ROOT / "docs/README.md").read_text()
        for page in (ROOT / "docs").glob("*/*.md"):
            self.assertIn(f"]({page.relative_to(ROOT / 'docs')})", index)

    def test_every_page_that_a_source_file_names_is_there(self):
        for file in (ROOT / "CMakeLists.txt", *self.files):
            if file.suffix in (".cpp", ".hpp", ".lcm", ".md", ".py", ".txt", ".yaml", ""):
                for name in re.findall(r"\bdocs/[\w/-]+\.(?:json|md|png|svg)", file.read_text(errors="replace")):
                    self.assertTrue((ROOT / name).is_file(), f"{file.relative_to(ROOT)}: {name}")

    def test_a_name_that_is_not_there_is_found(self):
        page = "docs/how-to/operation.md"
        for text in (
            "[a](nowhere.md)",
            "[a](operation.md#nowhere)",
            "![a](../images/nowhere.png)",
            "`src/runtime/nowhere.*`",
            "`nowhere_test.cpp`",
            "```\npmg_sil --scenario config/scenarios/nowhere.yaml\n```",
            "`a=1 build/bin/pmg_sil`",
        ):
            self.assertEqual(len(self.wrong(page, text)), 1, text)
        for text in (
            "[a](operation.md#logs)",
            "`src/control/supervisor.*`",
            "`supervisor_test.cpp`",
            "`out/why/report.html`",
            "`runs/*.csv`",
            "`build/release/bin/pmg_sil`",
            "[a](https://example.org/nowhere.md)",
        ):
            self.assertEqual(self.wrong(page, text), [], text)


if __name__ == "__main__":
    unittest.main()
