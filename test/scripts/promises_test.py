"""Every test that a table of docs/reference/safety.md and network.md names is there, and no promise is without one."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PAGES = ("docs/reference/safety.md", "docs/reference/network.md")
TEST = re.compile(r"^TEST(?:_F|_P)?\(\s*(\w+)\s*,\s*(\w+)\s*\)", re.M)


def rows(text):
    """(header cells, cells) of each row of each Markdown table."""
    header = None
    for line in text.splitlines():
        if not line.startswith("|"):
            header = None
            continue
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if header is None:
            header = cells
        elif not set(line) <= set("|-: "):
            yield header, cells


def named_tests(text):
    """(promise, the tests that its row names)."""
    for header, cells in rows(text):
        for column, title in enumerate(header):
            if title in ("test", "tests") and column < len(cells):
                yield header[0], cells[0], re.findall(r"`([^`]+)`", cells[column])


def missing(names, known, root):
    """Names that are no test, no test's beginning (Name...), no suite, and no file."""
    wrong = []
    for name in names:
        path = name.split()[0]
        if name.endswith("..."):
            found = any(test.startswith(name[:-3]) for test in known)
        elif "/" in path:
            found = (root / path).exists()
        elif path.endswith((".cpp", ".py")):
            found = any((root / "test").rglob(path))
        else:
            found = name in known
        if not found:
            wrong.append(name)
    return wrong


class Promises(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        found = [match for file in (ROOT / "test").rglob("*.cpp") for match in TEST.findall(file.read_text())]
        cls.known = {name for match in found for name in match}

    def test_every_named_test_is_there(self):
        for page in PAGES:
            for _, promise, names in named_tests((ROOT / page).read_text()):
                self.assertEqual(missing(names, self.known, ROOT), [], f"{page}: {promise}")

    def test_every_promise_names_a_test(self):
        promises = [(promise, names) for title, promise, names in named_tests((ROOT / PAGES[0]).read_text()) if title == "promise"]
        self.assertGreater(len(promises), 30)
        for promise, names in promises:
            self.assertTrue(names, promise)

    def test_a_name_that_is_no_test_is_found(self):
        page = "| promise | tests |\n|---|---|\n| it flies | `NoSuchTest`, `NoSuchFile.cpp` |\n| it stands | |\n"
        (_, _, wrong), (_, _, none) = named_tests(page)
        self.assertEqual(missing(wrong, self.known, ROOT), ["NoSuchTest", "NoSuchFile.cpp"])
        self.assertEqual(none, [])


if __name__ == "__main__":
    unittest.main()
