"""Writes the members of LCM messages as C++ data (field.hpp says in which form), so that no program lists them again.

Usage: message_fields.py HEADER FILE.lcm...

HEADER gets, for each struct, its channel and its members: name, type, length, names of elements, comment, access. The tuple `Messages`
of the files' package holds every message that has a channel, in the order of the files.

Three conventions in the files' comments, which change no message's type hash:
- the comment before a struct that is sent begins with its channel: "// Channel STATE: ...";
- the comment behind an array of fixed length names its elements in brackets: "double gyro_rad_s[3];  // [x, y, z] of the IMU";
- the comment behind a number that means one of several constants names the first and the last of them: "int8_t bus;  // OK to LOST", or those
  of another struct: "int8_t mode;  // PASSIVE to FAULT of mode_t".

Exit codes: 0 done, 2 a file that can't be used.
"""

import re
import sys
from dataclasses import dataclass, field
from pathlib import Path

TOKEN = re.compile(r"(?P<comment>//[^\n]*|/\*.*?\*/)|(?P<word>[\w.+-]+)|(?P<mark>[{}\[\];,=])|(?P<space>\s+)|(?P<other>.)", re.S)
INTEGERS = {"int8_t", "int16_t", "int32_t", "int64_t"}
PLAIN = INTEGERS | {"byte", "float", "double", "string", "boolean"}


@dataclass
class Member:
    type: str
    name: str
    line: int
    length: str = ""
    comment: str = ""
    is_length: bool = False
    constants: list[tuple[str, int]] = field(default_factory=list)

    def elements(self) -> list[str]:
        """Names in the first bracket of the comment that has as many as the array has elements."""
        for inside in re.findall(r"\[([^\]]*)\]", self.comment):
            names = [name.strip() for name in inside.split(",")]
            if self.length == str(len(names)) and all(re.fullmatch(r"\w+", name) for name in names):
                return names
        return []


@dataclass
class Struct:
    package: str
    name: str
    channel: str
    members: list[Member]
    constants: dict[str, int]


def tokens(text: str) -> list[tuple[str, str, int]]:
    """(kind, text, line) of all but spaces."""
    found, line = [], 1
    for match in TOKEN.finditer(text):
        if match.lastgroup != "space":
            found.append((match.lastgroup, match.group(), line))
        line += match.group().count("\n")
    return found


def without_marks(comment: str) -> str:
    return " ".join(comment.removeprefix("//").removeprefix("/*").removesuffix("*/").split())


def comment_behind(stream: list, at: int, line: int) -> str:
    """Of a member that ends in this line."""
    kind, text, where = stream[at] if at < len(stream) else ("", "", 0)
    return without_marks(text) if kind == "comment" and where == line else ""


def read_members(stream: list, at: int, file: str) -> tuple[list[Member], dict[str, int], int]:
    """From behind a struct's opening brace: members, constants, the place behind its closing brace. lcm-gen has checked the grammar."""
    members: list[Member] = []
    constants: dict[str, int] = {}
    while stream[at][1] != "}":
        kind, word, line = stream[at]
        if kind == "comment":
            at += 1
            continue
        end = next(i for i in range(at, len(stream)) if stream[i][1] == ";")
        declared = [text for kind, text, _ in stream[at:end] if kind != "comment"]
        if word == "const":
            for name, value in re.findall(r"(\w+) = ([-+\w]+)", " ".join(declared)):
                constants[name] = int(value, 0)
        else:
            comment = comment_behind(stream, end + 1, stream[end][2])
            for one in " ".join(declared[1:]).split(","):
                name, *lengths = re.findall(r"[\w.]+", one)
                if len(lengths) > 1:
                    raise ValueError(f"{file}:{line}: {name} has {len(lengths)} dimensions; expected one at most")
                members.append(Member(word, name, line, "".join(lengths), comment))
        at = end + 1
    lengths = {member.length for member in members}
    for member in members:
        member.is_length = member.name in lengths
        if member.length and member.type not in PLAIN:
            raise ValueError(f"{file}:{member.line}: {member.name} is an array of messages; expected elements of a plain type")
    return members, constants, at + 1


def read(file: str) -> list[Struct]:
    """The structs of one .lcm file."""
    stream, structs, package, before, at = tokens(Path(file).read_text()), [], "", "", 0
    while at < len(stream):
        kind, text, _ = stream[at]
        if text == "package":
            package = stream[at + 1][1]
        elif text == "struct":
            channel = re.match(r"Channel (\w+)", before)
            members, constants, end = read_members(stream, at + 3, file)
            structs.append(Struct(package, stream[at + 1][1], channel.group(1) if channel else "", members, constants))
            at = end - 1
        before = f"{before} {without_marks(text)}".strip() if kind == "comment" else ""
        at += 1
    return structs


def name_constants(structs: list[Struct], file_of: dict[str, str]) -> None:
    """Gives each member the constants that its comment names."""
    of_struct = {struct.name: struct.constants for struct in structs}
    for struct in structs:
        for member in struct.members:
            named = re.search(r"\b([A-Z][A-Z_]*) to ([A-Z][A-Z_]*)\b(?: of (\w+))?", member.comment)
            if named is None or member.type not in INTEGERS:
                continue
            first, last, other = named.groups()
            constants = of_struct.get(other or struct.name, {})
            if first not in constants or last not in constants:
                raise ValueError(f"{file_of[struct.name]}:{member.line}: {member.name}: no constants {first} to {last} in {other or struct.name}")
            names = list(constants)
            member.constants = [(name, constants[name]) for name in names[names.index(first) : names.index(last) + 1]]


def quoted(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def field_text(struct: Struct, member: Member) -> str:
    names = member.elements()
    elements = f"{struct.package}::element_names::{struct.name}_{member.name}" if names else "{}"
    constants = f"{struct.package}::constants_of::{struct.name}_{member.name}" if member.constants else "{}"
    flag = "true" if member.is_length else "false"
    return (
        f"    Field<{struct.package}::{struct.name}, decltype({struct.package}::{struct.name}::{member.name})>{{"
        f"{quoted(member.name)}, {quoted(member.type)}, {quoted(member.length)}, {flag}, {elements}, {constants}, {quoted(member.comment)}, "
        f"&{struct.package}::{struct.name}::{member.name}}}"
    )


def header(structs: list[Struct]) -> str:
    """The text of the C++ header."""
    lines = [
        "// Made by msgs/message_fields.py from the .lcm files.",
        "#pragma once",
        "#include <array>",
        "#include <tuple>",
        "",
        '#include "pmg_msgs/field.hpp"',
    ]
    lines += [f'#include "{struct.package}/{struct.name}.hpp"' for struct in structs]
    lines.append("")
    for struct in structs:
        for member in struct.members:
            if names := member.elements():
                lines.append(
                    f"namespace {struct.package}::element_names {{ inline constexpr std::array<std::string_view, {len(names)}> "
                    f"{struct.name}_{member.name} = {{{', '.join(map(quoted, names))}}}; }}"
                )
            if member.constants:
                values = ", ".join(f"pmg_msgs::Constant{{{value}, {quoted(name)}}}" for name, value in member.constants)
                lines.append(
                    f"namespace {struct.package}::constants_of {{ inline constexpr std::array<pmg_msgs::Constant, {len(member.constants)}> "
                    f"{struct.name}_{member.name} = {{{values}}}; }}"
                )
    lines += ["", "namespace pmg_msgs {"]
    for struct in structs:
        lines += [
            "template <>",
            f"inline constexpr auto kFields<{struct.package}::{struct.name}> = std::tuple{{",
            ",\n".join(field_text(struct, member) for member in struct.members) + "};",
        ]
        if struct.channel:
            lines += ["template <>", f"inline constexpr std::string_view kChannel<{struct.package}::{struct.name}> = {quoted(struct.channel)};"]
    lines += ["", "}  // namespace pmg_msgs", ""]
    for package in dict.fromkeys(struct.package for struct in structs):
        names = [struct.name for struct in structs if struct.package == package and struct.channel]
        lines += [f"namespace {package} {{", f"using Messages = std::tuple<{', '.join(names)}>;", f"}}  // namespace {package}"]
    return "\n".join(lines) + "\n"


def main(arguments: list[str]) -> int:
    if len(arguments) < 2:
        print(__doc__, file=sys.stderr)
        return 2
    out, *files = arguments
    try:
        read_from = {file: read(file) for file in files}
        structs = [struct for file in files for struct in read_from[file]]
        name_constants(structs, {struct.name: file for file in files for struct in read_from[file]})
        Path(out).write_text(header(structs))
    except (OSError, ValueError) as error:
        print(f"message_fields.py: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
