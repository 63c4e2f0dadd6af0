"""Every program that a shell script or CMake calls comes with the base system or with a package that the project lists.

A shell parser (shfmt) finds the commands, so that words within strings and comments are none. Where a program isn't installed, no listed
package brought it; where it is, the package that owns it must be essential, listed, or needed by a listed one."""

import functools
import json
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PATH = "/usr/local/sbin:/usr/sbin:/usr/bin:/sbin:/bin"  # the distribution's programs: no user's own python3
LISTS = ("third_party/apt-packages", "third_party/apt-packages-checks", "third_party/apt-packages-slow")
PREFIXES = {"command", "env", "exec", "nice", "nohup", "setsid", "sudo", "time", "xargs"}  # what follows is a command, too
NO_COMMAND = re.compile(r"[-$\d]|\w+=")  # a prefix's options, their numbers, assignments, and what only a run knows
OUTSIDE = {"sudo": "a user without root has it or is told so"}


def run(*command, text=None):
    return subprocess.run(command, input=text, capture_output=True, text=True, check=True).stdout


def parsed(script):
    tools = run(ROOT / "third_party/python-packages", "tools", "--cached").strip()
    return json.loads(run(f"{tools}/bin/shfmt", "--to-json", text=script))


def nodes(tree):
    """Every object of the parser's tree."""
    if isinstance(tree, dict):
        yield tree
        tree = list(tree.values())
    if isinstance(tree, list):
        for child in tree:
            yield from nodes(child)


def literal(word):
    """A word that has no quotes and no variables, else None."""
    parts = word["Parts"]
    return parts[0]["Value"] if len(parts) == 1 and parts[0]["Type"] == "Lit" else None


def commands(script):
    """Names of the programs that a script calls: neither builtins nor its own functions, nor paths."""
    tree = parsed(script)
    functions = {node["Name"]["Value"] for node in nodes(tree) if node.get("Type") == "FuncDecl"}
    names = set()
    for node in nodes(tree):
        words = [literal(word) for word in node.get("Args", [])] if node.get("Type") == "CallExpr" else []
        while words:
            if words[0]:
                names.add(words[0])
            if words[0] not in PREFIXES:
                break
            words = words[1:]
            while words and NO_COMMAND.match(words[0] or "$"):
                words = words[1:]
    return {name for name in names if "/" not in name} - functions - builtins()


@functools.cache
def builtins():
    return set(run("bash", "-c", "compgen -b -k").split()) | {"["}


@functools.cache
def packages():
    """({package: names that it needs}, {name: packages that are or provide it}, essential packages) of what is installed."""
    needs, provides, essential = {}, {}, set()
    fields = "${Package}\t${Essential}\t${Priority}\t${Provides}\t${Pre-Depends}, ${Depends}\n"
    for line in run("dpkg-query", "-W", "-f", fields).splitlines():
        package, is_essential, priority, provided, depends = line.split("\t")
        bare = lambda names: [re.split(r"[ (:]", name.strip())[0] for name in re.split("[,|]", names) if name.strip()]
        needs[package] = bare(depends)
        for name in [package, *bare(provided)]:
            provides.setdefault(name, set()).add(package)
        if is_essential == "yes" or priority == "required":
            essential.add(package)
    return needs, provides, essential


@functools.cache
def listed_packages():
    """Listed and essential packages with all that they need."""
    needs, provides, essential = packages()
    names = {word for path in LISTS for word in re.sub(r"#.*", "", (ROOT / path).read_text()).split()}
    missing, reached = [package for name in names for package in provides.get(name, ())] + sorted(essential), set()
    while missing:
        package = missing.pop()
        if package not in reached:
            reached.add(package)
            missing += [other for name in needs[package] for other in provides.get(name, ())]
    return reached


def owners(program):
    """Packages that own a program's file, under its own name or the one that it had before /bin became /usr/bin."""
    file = str(pathlib.Path(program).resolve())
    names = (program, file, file.removeprefix("/usr"))
    found = subprocess.run(["dpkg-query", "-S", *names], capture_output=True, text=True).stdout
    return {line.split(":")[0] for line in found.splitlines() if not line.startswith("diversion")}


@functools.cache
def wrong(name):
    """Why a command isn't there for everyone; None if it is."""
    program = shutil.which(name, path=PATH)
    if name in OUTSIDE:
        return None
    if not program:
        return f"{name}: not installed, so that no listed package has it"
    if not owners(program) & listed_packages():
        return f"{name}: from {', '.join(sorted(owners(program))) or 'no package'}, which third_party/apt-packages* don't list"
    return None


def shell_scripts():
    listed = run("git", "-C", ROOT, "grep", "-lzE", "--untracked", r"^#!.*\b(ba)?sh$").split("\0")
    return [ROOT / name for name in listed if name] + sorted(path for folder in ("scripts", "third_party") for path in ROOT.glob(f"{folder}/*.bash"))


class Commands(unittest.TestCase):
    def test_every_command_of_a_script_is_in_a_listed_package(self):
        scripts = shell_scripts()
        self.assertIn(ROOT / "scripts/setup", scripts)
        own = {node["Name"]["Value"] for path in scripts for node in nodes(parsed(path.read_text())) if node.get("Type") == "FuncDecl"}
        for path in scripts:
            with self.subTest(script=path.relative_to(ROOT)):
                self.assertEqual([why for name in sorted(commands(path.read_text()) - own) if (why := wrong(name))], [])

    def test_every_program_that_cmake_looks_for_is_in_a_listed_package(self):
        names = set()
        for path in (ROOT / "CMakeLists.txt", *ROOT.glob("cmake/*.cmake"), *ROOT.glob("[a-z]*/**/CMakeLists.txt")):
            names |= set(re.findall(r"find_program\(\w+\s+(?:NAMES\s+)?([\w.-]+)", path.read_text()))
        self.assertIn("lcm-gen", names)
        self.assertEqual([why for name in sorted(names) if (why := wrong(name))], [])

    def test_commands_are_found_wherever_a_script_calls_them(self):
        script = """
            tell() { inner | second; }   # comment $(hidden)
            FOO=1 third "$(fourth a)" '$(hidden)' && if fifth; then tell <<<"hidden"; fi
            command -v sixth >/dev/null || exec env A=1 seventh
            for x in $(eighth); do printf x | xargs -0 -n 1 ninth > "$(tenth)"; done
            ./hidden; src/hidden; "$program" hidden; [ -f hidden ] && echo hidden
        """
        names = ["inner", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth", "tenth"]
        self.assertEqual(commands(script), {*names, "env", "xargs"})

    def test_a_command_that_no_listed_package_has_is_found(self):
        self.assertIn("not installed", wrong("no-such-program"))
        self.assertIsNone(wrong("sed"))
        self.assertIsNone(wrong("cmake"))
        self.assertIn("don't list", wrong(unlisted_program()))


def unlisted_program():
    """Some program of this machine from a package that is neither listed nor needed."""
    for package in sorted(set(packages()[0]) - listed_packages()):
        for file in run("dpkg-query", "-L", package).split():
            if file.startswith("/usr/bin/") and shutil.which(pathlib.Path(file).name, path=PATH) == file:
                return pathlib.Path(file).name
    raise unittest.SkipTest("every installed package is listed")


if __name__ == "__main__":
    if not shutil.which("dpkg-query"):
        sys.exit(77)
    if subprocess.run([ROOT / "third_party/python-packages", "tools", "--cached"], stdout=subprocess.DEVNULL).returncode != 0:
        sys.exit(77)
    unittest.main()
