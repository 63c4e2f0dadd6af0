"""The members of a message are listed once, in its .lcm file: what message_fields.py makes of it, and what it refuses."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SCRIPT = ROOT / "msgs/message_fields.py"
sys.path.insert(0, str(SCRIPT.parent))

import message_fields  # noqa: E402


class MessageFields(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def file(self, members, before="// Channel THING: a thing."):
        path = self.folder / "thing_t.lcm"
        path.write_text(f"package pmg_msgs;\n\n{before}\nstruct thing_t {{\n{members}\n}}\n")
        return str(path)

    def members(self, text):
        return message_fields.read(self.file(text))[0].members

    def run_on(self, text):
        out = self.folder / "fields.hpp"
        run = subprocess.run([sys.executable, SCRIPT, out, self.file(text)], capture_output=True, text=True)
        return run, out

    def test_a_member_that_is_added_to_a_message_is_in_the_table(self):
        path = self.folder / "status_t.lcm"
        text = (ROOT / "msgs/status_t.lcm").read_text()
        path.write_text(text.replace("  boolean realtime;", "  boolean realtime;\n  double supply_V;  // of the battery\n "))
        before = message_fields.header(message_fields.read(str(ROOT / "msgs/status_t.lcm")))
        after = message_fields.header(message_fields.read(str(path)))
        added = set(after.splitlines()) - set(before.splitlines())
        self.assertTrue(any('{"supply_V", "double", "", false, {}, {}, "of the battery"' in line for line in added), added)

    def test_every_message_that_logs_keep_has_a_channel(self):
        for path in (ROOT / "msgs").glob("*.lcm"):
            for struct in message_fields.read(str(path)):
                # proof_t and seal_t stand behind others; no log keeps a camera's pictures.
                kept = path.name not in ("proof_t.lcm", "seal_t.lcm", "camera_t.lcm")
                self.assertEqual(bool(struct.channel), kept, path.name)

    def test_constants_and_comments_are_no_members(self):
        members = self.members("  const int8_t A = 0, B = 1;  // bits\n  // int8_t old;\n  /* int8_t older; */\n  int64_t stamp_ns;  // clock")
        self.assertEqual([(m.name, m.type, m.comment) for m in members], [("stamp_ns", "int64_t", "clock")])

    def test_a_length_is_known_as_one(self):
        members = self.members("  int32_t count;\n  double value[ count ];\n  int32_t other;")
        self.assertEqual([(m.name, m.length, m.is_length) for m in members], [("count", "", True), ("value", "count", False), ("other", "", False)])

    def test_names_of_elements_are_taken_only_when_there_are_as_many(self):
        for comment, names in (
            ("[left, right] foot", ["left", "right"]),
            ("[0, 1) each", []),
            ("[m/s]", []),
            ("[x, y, z]", []),
            ("[m/s] of [front, back]", ["front", "back"]),
            ("left, right", []),
        ):
            (member,) = self.members(f"  double value[2];  // {comment}")
            self.assertEqual(member.elements(), names, comment)

    def test_a_comment_may_hold_quotes(self):
        run, out = self.run_on('  string policy;  // "none": \\no policy')
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn(r'"\"none\": \\no policy"', out.read_text())

    def test_what_has_no_columns_is_refused_in_one_line(self):
        for text, said in (
            ("  double a[2][3];", ":5: a has 2 dimensions; expected one at most"),
            ("  int32_t n;\n  pmg_msgs.part_t part[n];", ":6: part is an array of messages; expected elements of a plain type"),
        ):
            run, out = self.run_on(text)
            self.assertEqual((run.returncode, run.stderr.count("\n")), (2, 1), run.stderr)
            self.assertTrue(run.stderr.startswith("message_fields.py: "), run.stderr)
            self.assertIn("thing_t.lcm" + said, run.stderr)
            self.assertFalse(out.exists())

    def test_a_missing_file_is_named(self):
        run = subprocess.run([sys.executable, SCRIPT, self.folder / "out.hpp", self.folder / "none_t.lcm"], capture_output=True, text=True)
        self.assertEqual((run.returncode, run.stderr.count("\n")), (2, 1), run.stderr)
        self.assertIn("none_t.lcm", run.stderr)


if __name__ == "__main__":
    unittest.main()
