"""scripts/check-pages on small pages: what is typed, in which order, and what makes it fail."""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "scripts"))
import typed_blocks  # noqa: E402


class Pages(unittest.TestCase):
    def setUp(self):
        """A small project with the script, a page and a build without programs."""
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = pathlib.Path(self.folder.name)
        (self.root / "scripts").mkdir()
        for name in ("check-pages", "typed_blocks.py"):
            shutil.copy(ROOT / "scripts" / name, self.root / "scripts")
        (self.root / "build/release/bin").mkdir(parents=True)

    def check(self, *blocks):
        """(exit code, all that it says) on a page of these fences."""
        (self.root / "page.md").write_text("\n\ntext\n\n".join(block if block.startswith("`") else f"```\n{block}\n```" for block in blocks) + "\n")
        run = subprocess.run(
            [self.root / "scripts/check-pages", "--here", "page.md"], text=True, timeout=120, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
        )
        return run.returncode, run.stdout

    def expect(self, code, words, *blocks):
        got, said = self.check(*blocks)
        self.assertEqual(got, code, said)
        self.assertIn(words, said)
        return said

    def test_commands_are_typed_in_the_pages_order_from_the_root_into_a_clean_folder(self):
        self.expect(
            0,
            "4 commands of 1 pages",
            "test -f page.md && mkdir out\necho one > out/order",
            "echo two >> out/order",
            "test \"$(cat out/order | tr '\\n' ' ')\" = 'one two '",
        )

    def test_a_typing_error_fails(self):
        self.expect(1, "no such program", "build/release/bin/pmg_sill --robot z1")

    def test_an_exit_code_that_the_page_doesnt_say_fails(self):
        self.expect(1, "ended with 1; expected 0", "false")
        self.expect(1, "ended with 0; expected 1", "true   # exit code 1")
        self.expect(0, "1 commands", "false  # what it found is bad: exit code 1")

    def test_nothing_is_typed_after_a_failure(self):
        self.assertNotIn("echo later", self.expect(1, "1 failed", "false", "echo later"))

    def test_a_promised_output_that_isnt_there_fails(self):
        self.expect(1, "out/here isn't there", "true --out out/here")
        self.expect(1, "names report.html", "mkdir -p out/here   # report.html, and pictures")
        self.expect(0, "1 commands", "mkdir -p out/here && touch out/here/report.html   # report.html, and pictures")

    def test_an_output_of_an_earlier_command_isnt_taken_for_a_new_one(self):
        self.expect(1, "out/here wasn't written", "mkdir -p out/here", "sleep 0.1", "true --out out/here")

    def test_a_block_that_builds_and_isnt_marked_fails_however_deep_it_calls_the_compiler(self):
        self.expect(1, "expected the mark (builds)", "sh -c 'cmake --version'")
        self.expect(1, "expected the mark (builds)", "sh -c 'ninja --version || true'")
        self.expect(0, "2 left out", "# (builds)\nsh -c 'cmake --version'\ncmake --version")

    def test_what_needs_something_is_left_out_a_block_or_a_line(self):
        self.expect(0, "0 commands of 1 pages", "# (needs a robot)\nfalse")
        said = self.expect(0, "1 commands of 1 pages", "true\nfalse    # (needs a screen) a window")
        self.assertIn("(needs a screen)", said)

    def test_terminals_side_by_side_run_until_the_last_has_ended(self):
        waits = "mkfifo out/pipe; cat out/pipe"
        self.expect(
            0, "3 commands", "mkdir out", "# (a terminal each)\nsh -c 'trap \"exit 130\" INT; echo up; while :; do sleep 0.1; done'\necho last"
        )
        self.expect(1, "expected 0 or 130", "mkdir out", "# (a terminal each)\nsh -c 'echo up; exit 1'\necho last")
        self.expect(1, "ended with 1", "mkdir out", f"# (a terminal each)\nsh -c 'echo up; {waits}'\nfalse")

    def test_no_window_opens_and_no_other_robot_is_heard(self):
        self.expect(0, "1 commands", 'test -z "$DISPLAY" && test -n "$LCM_DEFAULT_URL"')

    def test_other_languages_are_shown_only(self):
        self.expect(0, "0 commands", "```yaml\nfalse: 1\n```", "```text\nfalse\n```")
        self.expect(2, "a command in a fence of text", "```text\nbuild/release/bin/pmg_sil --help\n```")

    def test_a_page_that_is_wrong_is_refused_with_its_line(self):
        self.expect(2, "page.md:2: the mark (needs nothing)", "# (needs nothing)\ntrue")
        self.expect(2, "never closed", "```\ntrue")
        self.expect(2, "here-document", "cat <<END\nEND")
        self.expect(2, "stands in its first line", "true\n# (needs a robot)")

    def test_without_a_build_it_says_so(self):
        (self.root / "build/release/bin").rmdir()
        self.expect(2, "expected a build", "true")

    def test_every_page_of_the_project_can_be_read(self):
        for page in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]:
            typed_blocks.read_blocks(page.read_text(), page.name)


class Lines(unittest.TestCase):
    def read(self, text):
        return [(c.text, c.comment) for block in typed_blocks.read_blocks(f"```\n{text}\n```", "page") for c in block.commands]

    def test_a_hash_within_a_word_or_quotes_is_no_comment(self):
        self.assertEqual(self.read("a 'b # c' d#e  # f # g"), [("a 'b # c' d#e", "f # g")])

    def test_continued_lines_are_one_command(self):
        self.assertEqual(self.read("a \\\n  b   # c\nd"), [("a b", "c"), ("d", "")])

    def test_a_fence_within_a_list_loses_its_indent(self):
        blocks = typed_blocks.read_blocks("- item\n\n  ```\n  a\n  ```\n", "page")
        self.assertEqual(blocks[0].commands[0].text, "a")
        self.assertEqual(blocks[0].commands[0].line, 4)


if __name__ == "__main__":
    unittest.main()
