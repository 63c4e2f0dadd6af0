"""Makes man pages and shell completions of programs, from what each says of its own command line (--describe-as-json).

Usage: manuals.py SHARE VERSION PROGRAM...     SHARE: the prefix' share folder, which gets man/man1, bash-completion/completions,
zsh/site-functions and fish/vendor_completions.d.  Exit codes: 0 done, 2 a program that doesn't say
"""

import gzip
import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

FOLDERS = {"man": "man/man1", "bash": "bash-completion/completions", "zsh": "zsh/site-functions", "fish": "fish/vendor_completions.d"}


def commands_of(program: dict) -> list[tuple[str, dict]]:
    """(words before its options, command): the program itself first."""
    return [("", program)] + [(command["name"], command) for command in program["commands"]]


# Man pages


def roff(text: str) -> str:
    """Text that roff prints as it is."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\n".join("\\&" + line if line[:1] in (".", "'") else line for line in text.split("\n"))


def roff_option(option: dict) -> list[str]:
    names = ", ".join(f"\\fB{roff(name)}\\fR" for name in option["names"])
    kind = f" \\fI{roff(option['type'])}\\fR" if option["type"] else ""
    told = roff(option["description"])
    if option["default"]:
        told += roff(f" [{option['default']}]")
    if option["required"]:
        told += " (required)"
    return [".TP", names + kind, told]


def roff_options(command: dict) -> list[str]:
    return [line for option in command["positionals"] + command["options"] for line in roff_option(option)]


def man_page(program: dict, version: str) -> str:
    name = program["name"]
    lines = [f'.TH {name.upper()} 1 "" "PMG {version}" "PMG"', ".SH NAME", roff(f"{name} - {program['description'].rstrip('.')}")]
    lines.append(".SH SYNOPSIS")
    synopsis = [f"\\fB{roff(name)}\\fR"]
    if program["commands"]:
        synopsis.append("\\fICOMMAND\\fR")
    synopsis.append("[\\fIOPTION\\fR]...")
    synopsis += [f"\\fI{roff(one['names'][-1])}\\fR" + ("..." if one["many"] else "") for one in program["positionals"]]
    lines += [" ".join(synopsis), ".SH OPTIONS", *roff_options(program)]
    if program["commands"]:
        lines.append(".SH COMMANDS")
    for command in program["commands"]:
        lines += [f".SS {roff(command['name'])}", roff(command["description"]), *roff_options(command)]
    if program["footer"].strip():
        lines += [".SH NOTES", ".nf", roff(program["footer"].strip()), ".fi"]
    return "\n".join(lines) + "\n"


# Completions


def names_of(command: dict) -> list[str]:
    return [name for option in command["options"] for name in option["names"]]


def bash(program: dict) -> str:
    function = "_" + program["name"]
    commands = [name for name, _ in commands_of(program)[1:]]
    values, files, words = [], [], []
    for name, command in commands_of(program):
        for option in command["options"]:
            pattern = "|".join(shlex.quote(f"{name} {one}") for one in option["names"])
            if option["values"]:
                choices = shlex.quote(" ".join(option["values"]))
                values.append(f'    {pattern}) COMPREPLY=($(compgen -W {choices} -- "$word")); return ;;')
            elif option["type"]:
                files.append(pattern)  # -o default completes files
        known = names_of(command) + (commands if not name else [])
        words.append(f"    {shlex.quote(name)}) known={shlex.quote(' '.join(known))} ;;")
    find = (
        f"""  local one
  for one in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    case $one in {"|".join(commands)}) command=$one; break ;; esac
  done
"""
        if commands
        else ""
    )
    value_cases = "\n".join(values + ([f"    {'|'.join(files)}) return ;;"] if files else []))
    return f"""# Made by cmake/manuals.py.
{function}() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} command= known=
  COMPREPLY=()
{find}  case "$command $before" in
{value_cases}
  esac
  case $command in
{chr(10).join(words)}
  esac
  COMPREPLY=($(compgen -W "$known" -- "$word"))
}}
complete -o default -F {function} {program["name"]}
"""


def zsh_quoted(text: str) -> str:
    return re.sub(r"([\[\]:\\])", r"\\\1", text).replace("'", "'\\''")


def zsh_options(command: dict) -> str:
    specs = []
    for option in command["options"]:
        value = ""
        if option["values"]:
            value = f":value:({' '.join(option['values'])})"
        elif option["type"]:
            value = ":value:_files"
        specs += [f"'{name}[{zsh_quoted(option['description'])}]{value}'" for name in option["names"]]
    return " \\\n    ".join(["_arguments", *specs, "'*:file:_files'"])


def zsh(program: dict) -> str:
    cases = "".join(f"  {name})\n    {zsh_options(command)} ;;\n" for name, command in commands_of(program)[1:])
    described = " ".join(f"'{name}:{zsh_quoted(command['description'])}'" for name, command in commands_of(program)[1:])
    choose = f"  local -a commands=({described})\n  (( CURRENT == 2 )) && _describe command commands\n" if described else ""
    return f"""#compdef {program["name"]}
# Made by cmake/manuals.py.
case $words[2] in
{cases}  *)
  {choose.strip()}
    {zsh_options(program)} ;;
esac
"""


def fish(program: dict) -> str:
    name, lines = program["name"], ["# Made by cmake/manuals.py."]
    commands = [command for command, _ in commands_of(program)[1:]]
    for word, command in commands_of(program):
        if word:
            lines.append(
                f"complete -c {name} -f -n 'not __fish_seen_subcommand_from {' '.join(commands)}' -a {word} -d {shlex.quote(command['description'])}"
            )
        only = f" -n '__fish_seen_subcommand_from {word}'" if word else ""
        for option in command["options"]:
            for one in option["names"]:
                line = f"complete -c {name}{only} " + (f"-l {one[2:]}" if one.startswith("--") else f"-s {one[1:]}")
                if option["values"]:
                    line += f" -x -a {shlex.quote(' '.join(option['values']))}"
                elif option["type"]:
                    line += " -r"
                lines.append(line + f" -d {shlex.quote(option['description'])}")
    return "\n".join(lines) + "\n"


def main(arguments: list[str]) -> int:
    if len(arguments) < 3:
        print(__doc__, file=sys.stderr)
        return 2
    share, version, *programs = arguments
    for folder in FOLDERS.values():
        Path(share, folder).mkdir(parents=True, exist_ok=True)
    for path in programs:
        told = subprocess.run([path, "--describe-as-json"], capture_output=True, text=True)
        if told.returncode != 0:
            print(f"manuals.py: {path} says nothing of its command line: {told.stderr.strip()}", file=sys.stderr)
            return 2
        program = json.loads(told.stdout)
        name = os.path.basename(path)
        # As distributions want it; without a date the same page is the same file.
        Path(share, FOLDERS["man"], f"{name}.1.gz").write_bytes(gzip.compress(man_page(program, version).encode(), mtime=0))
        Path(share, FOLDERS["bash"], name).write_text(bash(program))
        Path(share, FOLDERS["zsh"], f"_{name}").write_text(zsh(program))
        Path(share, FOLDERS["fish"], f"{name}.fish").write_text(fish(program))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
