"""Hook of MkDocs: API pages of the site, made from the code when the site is built.

reference/cpp/ROOM.md: the headers of a room that cmake/public_headers.txt lists: what the comment of a
header says, then each struct, class and function with its comment. Private members and bodies of
functions are left out. reference/python/: the package by mkdocstrings, from build/docs_python, where
`make docs` installs it with the stubs of its extension.
"""

import os
import pathlib
import re

import check_modules
import house_rules

ROOT = pathlib.Path(__file__).resolve().parent.parent
PYTHON = {
    "hapticgiant": "The package. How to install it, and examples: [C++ and Python](../../start/packages.md).\n\n"
                   "::: hapticgiant\n    options: {show_root_heading: false}\n",
    **{f"hapticgiant.{name}": f"::: hapticgiant._core.{name}\n    options: {{show_root_heading: false}}\n"
       for name in ("limits", "hqp", "model", "haptic_giant")},
}
TOKEN = re.compile(r'//[^\n]*|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\])\'|[{};()]')
TEMPLATE = r"(?:template <[^\n]*>\n)?\s*"
TYPE = re.compile(TEMPLATE + r"(?:struct|class|union|enum(?: class)?) (\w+)")
FORWARD = re.compile(TEMPLATE + r"(?:struct|class|enum class) \w+(?: : [\w:]+)?;")
USING = re.compile(TEMPLATE + r"using (\w+)")
CONSTANT = re.compile(TEMPLATE + r"(?:inline )?(?:constexpr|concept|extern)\b[^({=]*?(\w+)\s*(?:\[\w*\])?\s*[={;]")
FUNCTION = re.compile(r"(operator\S+?|~?\w+)\s*\(")
INITIALISERS = re.compile(r"(\)(?: noexcept)?)\s*:\s+\w+[({].*$", re.DOTALL)
PAGE = re.compile(r"\bdocs/([\w/]+/)(\w+)\.md")
LONGEST_VALUE = 12  # lines of a constant's initialiser


def rooms():
    """Room -> its public headers, of the rooms that have some."""
    modules = check_modules.read_modules()
    listed = house_rules.listed_headers((ROOT / house_rules.PUBLIC_HEADERS).read_text())
    for room in modules:
        headers = [name for name in listed
                   if check_modules.module_of(modules, pathlib.PurePath(name).parts[1:]) == room]
        if headers:
            yield room, headers


def matching(code, at):
    """The end of the block that begins with the brace at `at`."""
    depth = 0
    for token in TOKEN.finditer(code, at):
        depth += {"{": 1, "}": -1}.get(token[0], 0)
        if depth == 0:
            return token.end()
    raise ValueError(f"unbalanced: {code[at:at + 60]}")


def without_bodies(code):
    """Without private sections, bodies of functions, and what constructors initialise."""
    code = re.sub(r"\n *private:\n.*?(?=\n\};|\n *public:\n|\Z)", "", code, flags=re.DOTALL)
    at = 0
    while token := TOKEN.search(code, at):
        at = token.end()
        head = code[:token.start()].rstrip()
        if token[0] == "{" and re.search(r"(\)|\bconst|\bnoexcept|\boverride)$", head):
            start = head.rfind(";") + 1
            end = matching(code, token.start())
            head = head[:start] + INITIALISERS.sub(r"\1", head[start:])
            code = head + ";" + code[end:].removeprefix(";")
            at = len(head)
    return code


def end_of_declaration(text, at):
    """Where a declaration ends: behind its ; or behind the body of a function."""
    depth = end = 0
    for token in TOKEN.finditer(text, at):
        depth += {"(": 1, ")": -1}.get(token[0], 0)
        if depth > 0 or token.start() < end:
            continue
        if token[0] == "{":
            end = matching(text, token.start())
            if text[end] != ";" and not TYPE.match(text, at):
                return end
        elif token[0] == ";":
            return token.end()
    raise ValueError(f"no end: {text[at:at + 60]}")


def declarations(text):
    """(comment, code) of what stands in the namespace of a header."""
    text = re.sub(r"^(#|namespace|\}  // namespace)[^\n]*$", "", text, flags=re.MULTILINE)
    at, comment = 0, []
    while at < len(text):
        end = text.index("\n", at)
        line = text[at:end]
        if line.startswith("///"):
            comment.append(line[4:])
        elif not line.strip() or line.startswith("//"):
            comment = []
        else:
            end = text.index("\n", end_of_declaration(text, at))  # with a comment behind it
            yield "\n".join(comment), text[at:end]
            comment = []
        at = end + 1


def name_of(code):
    """What a declaration declares; None for what has no place in a reference."""
    plain = re.sub(r"requires [^\n]*|\[\[\w+\]\]|//[^\n]*", "", code)
    for pattern in (TYPE, USING, CONSTANT, FUNCTION):
        found = pattern.search(plain) if pattern is FUNCTION else pattern.match(plain)
        if found:
            return None if found[1] == "static_assert" or FORWARD.fullmatch(plain.strip()) else found[1]
    return None


def prose(comment, folder):
    """A comment as Markdown: formulas, which are indented, as code; paths of pages as links."""
    lines = []
    for line in comment.splitlines():
        is_code = line.startswith("  ")
        if not is_code:
            line = "".join(part if i % 2 else part.replace("<", "&lt;").replace("*", r"\*")
                           for i, part in enumerate(re.split(r"(`[^`]*`)", line)))
            line = PAGE.sub(lambda m: f"[{m[2]}]({os.path.relpath(m[1] + m[2] + '.md', folder)})", line)
        if lines and lines[-1] and (is_code != lines[-1].startswith("    ") or line.startswith("- ")):
            lines.append("")
        lines.append("    " + line.strip("\n")[2:] if is_code else line)
    return "\n".join(lines) + "\n"


def header_page(path):
    text = path.read_text()
    head, _, body = text.partition("#pragma once\n")
    folder = "reference/cpp"
    page = [f"## {path.relative_to(ROOT)}\n",
            prose("\n".join(line[4:] for line in head.splitlines() if line.startswith("///")), folder)]
    last = None
    try:
        items = list(declarations(body))
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from error
    for comment, code in items:
        name, code = name_of(code), without_bodies(code)
        if name is None:
            continue
        if code.count("\n") > LONGEST_VALUE and not TYPE.match(code):
            code = re.sub(r"\{.*\}", "{ ... }", code, flags=re.DOTALL)
        page += [f"### {name}\n"] if name != last else []
        page += [prose(comment, folder)] if comment else []
        page.append(f"```cpp\n{code}\n```\n")
        last = name
    return "\n".join(page)


def cpp_pages():
    """Room -> (name of its page, text)."""
    return {room: (f"reference/cpp/{room.replace('/', '_')}.md",
                   f"# {room}\n\nLibrary `hapticgiant::{room.split('/')[-1]}`, written when this site is built "
                   "from the comments of its headers.\n\n"
                   + "\n".join(header_page(ROOT / header) for header in headers))
            for room, headers in rooms()}


def on_config(config):
    pages = [{room.split("/")[-1]: name} for room, (name, _) in cpp_pages().items()]
    python = [{name: f"reference/python/{name}.md"} for name in PYTHON]
    for section in config["nav"]:
        if "Reference" in section:
            section["Reference"] += [{"Python": python}, {"C++": pages}]
    return config


def on_files(files, config):
    from mkdocs.structure.files import File  # only where the site is built: tests have no MkDocs

    for name, text in PYTHON.items():
        files.append(File.generated(config, f"reference/python/{name}.md", content=f"# {name}\n\n{text}"))
    for name, text in cpp_pages().values():
        files.append(File.generated(config, name, content=text))
    return files
