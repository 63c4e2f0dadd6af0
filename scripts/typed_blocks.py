"""Reads from a Markdown page what its reader is meant to type (the conventions: docs/reference/pages.md)."""

import re
import textwrap
from dataclasses import dataclass, field

TYPED = ("", "sh", "bash")  # languages of fences that are typed; any other is shown only
COMMAND = re.compile(r"\s*(?:\$ )?(?:scripts/\w|third_party/fetch|build/\w|pmg_\w|cmake |sudo |apt-get )")
PROMISED_FILE = re.compile(r"[\w.-]+\.(?:csv|html|json|lcm|mcap|mp4|png|svg|urdf|yaml)\b")


class PageError(Exception):
    """What is wrong with a page, with its place."""


@dataclass
class Command:
    line: int
    text: str  # as bash takes it, without the comment
    comment: str = ""  # behind it
    marks: list = field(default_factory=list)  # of the whole block, then of this line

    def mark(self, beginning):
        """The first mark that begins so, or None."""
        return next((mark for mark in self.marks if mark.startswith(beginning)), None)

    @property
    def exit_code(self):
        """What the page says that it ends with."""
        said = re.search(r"exit code (\d+)", self.comment)
        return int(said.group(1)) if said else 0

    @property
    def promised_files(self):
        """Files that the comment names."""
        return PROMISED_FILE.findall(self.comment)


@dataclass
class Block:
    line: int
    commands: list
    side_by_side: bool = False


def read_blocks(text, page):
    """The typed blocks of a page in its order; page: its name in messages. Throws PageError."""
    blocks, lines, at = [], text.splitlines(), 0
    while at < len(lines):
        fence = re.match(r"(\s*)(`{3,})\s*(\S*)", lines[at])
        at += 1
        if not fence:
            continue
        _, ticks, language = fence.groups()
        first = at
        while at < len(lines) and lines[at].strip() != ticks:
            at += 1
        if at == len(lines):
            raise PageError(f"{page}:{first}: this fence is never closed")
        body = textwrap.dedent("\n".join(lines[first:at])).splitlines()
        at += 1
        if language in TYPED:
            blocks.append(read_block(body, first + 1, page))
        else:
            for offset, line in enumerate(body):
                if COMMAND.match(line):
                    raise PageError(f"{page}:{first + 1 + offset}: a command in a fence of {language}; expected a fence without a language")
    return blocks


def read_block(body, first_line, page):
    block, commands, marks = Block(first_line, []), [], []
    number = 0
    while number < len(body):
        line, start = body[number], first_line + number
        number += 1
        while line.endswith("\\") and number < len(body):
            line = line[:-1] + body[number].strip()
            number += 1
        text, comment = split_comment(line, f"{page}:{start}")
        own, comment = read_marks(comment, f"{page}:{start}")
        if text:
            commands.append(Command(start, text, comment, own))
        elif own and commands:
            raise PageError(f"{page}:{start}: a mark of the whole block stands in its first line")
        else:
            marks += own
    for command in commands:
        command.marks = marks + command.marks
    block.commands = commands
    block.side_by_side = "a terminal each" in marks
    return block


def split_comment(line, place):
    """(command, comment) of one line; a # within quotes or within a word is no comment."""
    quote, before = "", " "
    for at, char in enumerate(line):
        if quote:
            quote = "" if char == quote else quote
        elif char in "'\"":
            quote = char
        elif char == "#" and before.isspace():
            return line[:at].strip(), line[at + 1 :].strip()
        before = char
    if quote:
        raise PageError(f"{place}: a quotation that doesn't end")
    if "<<" in line:
        raise PageError(f"{place}: a here-document; expected commands of one line each")
    return line.strip(), ""


def read_marks(comment, place):
    """(marks, the rest) of a comment that begins with marks in brackets: (needs a robot; a terminal each)."""
    bracket = re.match(r"\(([^)]*)\)[:,.]?\s*", comment)
    if not bracket:
        return [], comment
    marks = [mark.strip() for mark in bracket.group(1).split(";")]
    for mark in marks:
        if not re.match(r"builds$|needs (a|an) \w|takes \w|a terminal each$", mark):
            raise PageError(f"{place}: the mark ({mark}); expected (builds), (needs a ...), (takes ...) or (a terminal each)")
    return marks, comment[bracket.end() :]
