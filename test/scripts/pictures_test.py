"""Every name of code in the pictures of docs/explanation/architecture.md stands in the sources of the room that the picture puts it in."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PICTURES = ("way-of-a-command", "way-of-a-measured-joint", "way-of-a-parameter")
TEXT = re.compile(r'<text class="(room|code)"[^>]*>([^<]*)</text>')


def names(picture):
    """(room, name) of each line of code in a picture."""
    room = None
    for kind, text in TEXT.findall(picture):
        if kind == "room":
            room = text
        else:
            yield room, text


def missing(picture):
    found = []
    for room, name in names(picture):
        files = [file for file in (ROOT / room).glob("*") if file.suffix in (".hpp", ".cpp", ".py")]
        text = "\n".join([file.stem for file in files] + [file.read_text() for file in files])
        if not files or not all(re.search(rf"\b{part}\b", text) for part in name.split("::")):
            found.append(f"{room}: {name}")
    return found


class Pictures(unittest.TestCase):
    def test_every_name_is_in_its_room(self):
        page = (ROOT / "docs/explanation/architecture.md").read_text()
        for name in PICTURES:
            with self.subTest(picture=name):
                picture = (ROOT / f"docs/images/{name}.svg").read_text()
                self.assertGreater(len(list(names(picture))), 8)
                self.assertEqual(missing(picture), [])
                self.assertIn(f"(../images/{name}.svg)", page)

    def test_a_name_that_moved_away_is_found(self):
        picture = '<text class="room" x="1">src/hal</text><text class="code" x="1">BusCycle::run</text>'
        self.assertEqual(missing(picture), [])
        self.assertEqual(missing(picture.replace("src/hal", "src/policy")), ["src/policy: BusCycle::run"])
        self.assertEqual(missing(picture.replace("run", "walk")), ["src/hal: BusCycle::walk"])


if __name__ == "__main__":
    unittest.main()
