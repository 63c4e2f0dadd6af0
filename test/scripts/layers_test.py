"""Every room sees what docs/explanation/architecture.md lets it see: its includes and its CMake links hold to the table of that page."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PAGE = ROOT / "docs/explanation/architecture.md"
CORE = {"pmg": "include/pmg", "pmg_msgs": "msgs"}  # by the first folder of an include
TARGETS = {"pmg_core": "include/pmg", "pmg_msgs": "msgs"}


def allowed(page_text):
    """Of each room the set of rooms that it sees, in the page's order. Raises ValueError for a room that isn't above."""
    table = page_text.split("| room | it sees |", 1)[1].split("\n\n", 1)[0]
    sees = {}
    for left, right in re.findall(r"^\| (`.*?) \| (.*?) \|$", table, re.M):
        rooms = set()
        for phrase in [] if right == "nothing" else right.split(", "):
            if phrase == "all of them":
                rooms |= set(sees)
            elif phrase.startswith("what `"):
                rooms |= sees[phrase.split("`")[1]]
            else:
                rooms.add(phrase.strip("`"))
        if not rooms <= set(sees):
            raise ValueError(f"{left} sees {', '.join(sorted(rooms - set(sees)))}; expected rooms above it")
        for room in left.replace("`", "").split(", "):
            sees[room] = rooms
        # rooms of one row don't see each other: they are known only after it
    return sees


def included(text):
    """Rooms that a source file includes. A path that begins with .. hides its room and stands for itself; a name alone is of the same folder."""
    ours = {path.name for path in (ROOT / "src").iterdir()} | set(CORE)
    rooms = set()
    for mark, path in re.findall(r'^\s*#\s*include\s*(["<])(.+?)[">]', text, re.M):
        first, slash, _ = path.partition("/")
        if first == "..":
            rooms.add(path)
        elif slash and (mark == '"' or first in ours):
            rooms.add(CORE.get(first, f"src/{first}"))
    return rooms


def linked(text):
    """Rooms whose targets a CMakeLists.txt names."""
    rooms = {f"src/{room}" for room in re.findall(r"\bpmg_room_(\w+)", text)}
    return rooms | {room for target, room in TARGETS.items() if re.search(rf"\b{target}\b", text)}


def breaches(room, sees, texts):
    """Lines about what files of a room include or link and may not; texts: path -> content."""
    found = []
    for path, text in sorted(texts.items()):
        names = linked(text) if path.name == "CMakeLists.txt" else included(text)
        found += [f"{path} uses {name}" for name in sorted(names - {room} - sees[room])]
    return found


def files_of(room):
    paths = [path for path in (ROOT / room).rglob("*") if set(path.suffixes) & {".h", ".hpp", ".c", ".cpp"} or path.name == "CMakeLists.txt"]
    return {path.relative_to(ROOT): path.read_text() for path in paths}


class Layers(unittest.TestCase):
    def setUp(self):
        self.sees = allowed(PAGE.read_text())

    def test_the_table_has_every_room_and_no_other(self):
        rooms = {f"src/{path.name}" for path in (ROOT / "src").iterdir() if path.is_dir()}
        self.assertEqual(rooms, {room for room in self.sees if room.startswith("src/")})

    def test_every_room_uses_only_what_it_sees(self):
        found = []
        for room in self.sees:
            found += breaches(room, self.sees, files_of(room))
        self.assertEqual(found, [])

    def test_a_room_is_linked_in_its_own_folder(self):
        for path in ROOT.glob("[a-z]*/**/CMakeLists.txt"):
            for room in re.findall(r"target_link_libraries\(\s*pmg_room_(\w+)", path.read_text()):
                self.assertEqual(path.parent, ROOT / "src" / room, f"{path} links pmg_room_{room}")

    def test_a_breach_is_found(self):
        tick = pathlib.Path("src/control/tick.cpp")
        for line, used in (
            ('#include "sim/world.hpp"', "src/sim"),
            ("#include <sim/world.hpp>", "src/sim"),
            ('  # include "sim/world.hpp"', "src/sim"),
            ('#include "../sim/world.hpp"', "../sim/world.hpp"),
            ('#include "nowhere/a.hpp"', "src/nowhere"),
        ):
            text = f'#include "faults/fault.hpp"\n#include <vector>\n{line}\n'
            self.assertEqual(breaches("src/control", self.sees, {tick: text}), [f"src/control/tick.cpp uses {used}"])
        build = {pathlib.Path("src/model/CMakeLists.txt"): "pmg_add_room(model LINK pmg_core pmg_room_sil)"}
        self.assertEqual(breaches("src/model", self.sees, build), ["src/model/CMakeLists.txt uses src/sil"])

    def test_an_arrow_to_a_room_below_is_refused(self):
        page = "| room | it sees |\n|---|---|\n| `src/model` | `src/sim` |\n| `src/sim` | nothing |\n\n"
        with self.assertRaises(ValueError):
            allowed(page)


if __name__ == "__main__":
    unittest.main()
