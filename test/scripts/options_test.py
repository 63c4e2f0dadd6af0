"""Every threshold that a diagnosis lists in diagnosis.json decides something: a source file of the diagnosis' rooms reads it."""

import collections
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
LISTS = (  # where options are listed, and the rooms that decide by them
    ("src/evidence/signature_options.cpp", ("evidence",)),
    ("src/diagnosis/options.cpp", ("diagnosis", "effects")),
    ("src/robot_diagnosis/robot_options.cpp", ("robot_diagnosis",)),
)
LISTED = re.compile(r"\w+\.((?:\w+\.)*\w+)(?=,\s+(?:\"|unit))")  # the value of an Option: o.window_s, size.wide


def members(text):
    """How many options each name of a member has."""
    return collections.Counter(path.split(".")[-1] for path in LISTED.findall(text))


def uses(member, text):
    """Reads of a struct's member: options.window_s, sizes_.imu_rad.wide, &Options::gain_tolerance."""
    return len(re.findall(rf"\w(?:\.|->|::){member}\b(?!\s*=[^=])(?!\()", text))


def unused(listed, text):
    """Names with more options than reads."""
    return sorted(member for member, options in members(listed).items() if uses(member, text) < options)


class Options(unittest.TestCase):
    def test_every_listed_option_is_used(self):
        for name, rooms in LISTS:
            listing = ROOT / name
            own = {listing, listing.with_suffix(".hpp")}
            files = [file for room in rooms for file in sorted((ROOT / "src" / room).glob("*.[ch]pp")) if file not in own]
            listed = listing.read_text()
            self.assertGreater(len(members(listed)), 20, name)
            self.assertEqual(unused(listed, "\n".join(file.read_text() for file in files)), [], name)

    def test_finds_an_unused_one(self):
        listed = '{"a_s", o.a_s, "s", "why", x}, {"one.b", o.b, "", "why", x}, {"two.b", p.b, "", "why", x}, add("c", o.c, "");'
        self.assertEqual(unused(listed, "if (t > options.a_s && f(one.b) < two->b) return size(sizes_.c.wide);"), [])
        self.assertEqual(unused(listed, "if (t > 0.1 && f(one.b) < 2.0) options.c = 3.0;"), ["a_s", "b", "c"])


if __name__ == "__main__":
    unittest.main()
