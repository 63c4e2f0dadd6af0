"""Every threshold that a diagnosis lists in diagnosis.json decides something: a source file of its rooms reads it."""

import collections
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DECLARED = re.compile(r"\b(?:work::(?:Count)?Threshold|CauseSize) (\w+)(?=\{| = )")  # a row in a struct of thresholds
DECIDES_TOO = {"diagnosis": ("effects",)}  # rooms beside its own that decide by a room's thresholds


def members(text):
    """How many thresholds each name of a member has."""
    return collections.Counter(DECLARED.findall(text))


def uses(member, text):
    """Reads of a struct's member: options.window_s, e.options().row_gain, sizes_.imu_rad.wide, &Options::gain_tolerance."""
    return len(re.findall(rf"[\w)](?:\.|->|::){member}\b(?!\s*=[^=])(?!\()", text))


def unused(listed, text):
    """Names with more options than reads."""
    return sorted(member for member, options in members(listed).items() if uses(member, text) < options)


class Options(unittest.TestCase):
    def test_every_threshold_is_used(self):
        headers = [file for file in sorted((ROOT / "src").glob("*/*.hpp")) if members(file.read_text()) and file.name != "threshold.hpp"]
        self.assertGreater(len(headers), 8)
        for header in headers:
            rooms = (header.parent.name, *DECIDES_TOO.get(header.parent.name, ()))
            files = [file for room in rooms for file in sorted((ROOT / "src" / room).glob("*.[ch]pp")) if file != header]
            self.assertEqual(unused(header.read_text(), "\n".join(file.read_text() for file in files)), [], header)

    def test_finds_an_unused_one(self):
        declared = 'work::Threshold a_s{1.0, "s"}; work::CountThreshold b{2}; CauseSize c = cause_size(1); struct Two { work::Threshold b{1.0}; };'
        self.assertEqual(unused(declared, "if (t > options.a_s && f(one.b) < two->b) return size(sizes_.c.wide);"), [])
        self.assertEqual(unused(declared, "if (t > 0.1 && f(one.b) < 2.0) options.c = 3.0;"), ["a_s", "b", "c"])


if __name__ == "__main__":
    unittest.main()
