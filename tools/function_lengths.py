"""Lengths of functions in lines, from the first word of the head to the last brace.

C++ and Rust are scanned by their braces, TypeScript by its indents, Python is parsed. A function of C++
counts with its lambdas; in the others, a function inside another counts for itself, too.
"""

import ast
import bisect
import re

CPP_BLANKS = re.compile(r"""
    //(?:[^\n\\]|\\.|\\\n)* | /\*.*?\*/
  | (?:u8|[uUL])?R"([^()\\\s]*)\(.*?\)\1"
  | "(?:[^"\\\n]|\\.|\\\n)*"
  | (?<![\w'])'(?:[^'\\\n]|\\.)+'
  | ^[ \t]*\#(?:[^\n\\/]|\\\n|\\.|/(?![/*]))*
""", re.VERBOSE | re.DOTALL | re.MULTILINE)
RUST_BLANKS = re.compile(r"""
    //[^\n]* | /\*.*?\*/
  | b?r(\#*)".*?"\1
  | b?"(?:[^"\\]|\\.)*"
  | b?'(?:[^'\\\n]|\\u\{[^}\n]*\}|\\x..|\\.)'
""", re.VERBOSE | re.DOTALL)
TOKEN = re.compile(r"[{}();]")
RUST_TOKEN = re.compile(r"[{}()\[\];]")
RUST_HEAD = re.compile(r"^[ \t]*(?:(?:pub(?:\([^)]*\))?|const|async|unsafe|extern)\s+)*fn\s+(\w+)", re.MULTILINE)
BEFORE_HEAD = re.compile(r"\s*(?:(?:public|private|protected)\s*:\s*)?")
NO_NAMES = re.compile(r"^\s*(?:public|private|protected)\s*:|\btemplate\s*<(?:[^<>]|<[^<>]*>)*>|\[\[.*?\]\]")
CPP_NAME = re.compile(r"((?:~?\w+(?:<[^()]*?>)?::)*(?:operator\s*(?:\(\)|[^\s\w(]+|[\w: ]+)|~?\w+))\s*\(")
INITIALISERS = re.compile(r"\)\s*(?:noexcept\s*)?:(?!:)")
TYPESCRIPT_HEAD = re.compile(r"(\s*)(?:export |default |async |static |public |private |protected |get |set |const )*"
                             r"(?:function )?\*?(#?\w+)")
KEYWORDS = {"if", "for", "while", "switch", "catch", "return", "decltype", "noexcept", "requires", "alignas",
            "explicit"}


def _blanks(match):
    text = match[0]
    return re.sub(r"[^\n]", " ", text) if "\n" in text else " " * len(text)


def _line_finder(text):
    ends = [match.start() for match in re.finditer("\n", text)]
    return lambda at: bisect.bisect_left(ends, at) + 1


def _behind(text, at):
    """Position behind the parenthesis or brace that closes the one at `at`."""
    depth = 0
    for match in TOKEN.finditer(text, at):
        depth += {"{": 1, "(": 1, "}": -1, ")": -1}.get(match.group(0), 0)
        if depth == 0:
            return match.end()
    return len(text)


def _cpp_name(head):
    """Name of the function that the head begins, or None where it begins none."""
    names = (re.sub(r"\s+", " ", match[1]) for match in CPP_NAME.finditer(head))
    return next((name for name in names if name not in KEYWORDS), None)


def cpp_functions(text):
    """(name, first line, lines) of each function of a C++ file."""
    text = CPP_BLANKS.sub(_blanks, text)  # without comments, literals and directives
    line_of = _line_finder(text)
    found = []
    start = at = 0  # of the head; of the search
    head = ""
    while match := TOKEN.search(text, at):
        token = match.group(0)
        head += text[at:match.start()]
        at = match.end()
        if token == "(":
            at = _behind(text, match.start())
            head += "()"
            continue
        if token == "{":
            plain = NO_NAMES.sub("", head)
            is_value = re.search(r"(?<!operator)(?<![=!<>])=(?!=)", plain)
            if is_value or INITIALISERS.search(plain) and re.search(r"[\w>]\s*$", plain):
                at = _behind(text, match.start())
                head += "()"
                continue
            if name := _cpp_name(plain):
                at = _behind(text, match.start())
                first = line_of(BEFORE_HEAD.match(text, start).end())
                found.append((name, first, line_of(at - 1) - first + 1))
        start, head = at, ""
    return found


def rust_functions(text):
    """(name, first line, lines) of each function of a Rust file that has a body."""
    text = RUST_BLANKS.sub(_blanks, text)
    line_of = _line_finder(text)
    found = []
    for head in RUST_HEAD.finditer(text):
        depth = 0
        for token in RUST_TOKEN.finditer(text, head.end()):
            if depth == 0 and token[0] in "{;":  # not that of an array
                if token[0] == "{":
                    first, end = line_of(head.start()), line_of(_behind(text, token.start()) - 1)
                    found.append((head[1], first, end - first + 1))
                break
            depth += {"(": 1, "[": 1, ")": -1, "]": -1}.get(token[0], 0)
    return found


def python_functions(text):
    """(name, first line, lines) of each function of a Python file."""
    found = []
    waiting = [ast.parse(text)]
    while waiting:
        node = waiting.pop()
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            found.append((node.name, node.lineno, node.end_lineno - node.lineno + 1))
        for part in ("body", "orelse", "finalbody", "handlers", "cases"):
            inner = getattr(node, part, ())
            waiting += inner if isinstance(inner, list) else ()
    return found


def typescript_functions(text):
    """(name, first line, lines) of each function of a TypeScript file with the usual indents.

    A function ends at the first line with a brace and the indent of its head.
    """
    lines = text.splitlines()
    open_heads = {}  # indent -> (number, text) of the latest line that begins there
    found = []
    for number, line in enumerate(lines, 1):
        indent = len(line) - len(line.lstrip())
        if line.strip() and not re.match(r"\s*[)}\]]", line):
            open_heads[indent] = (number, line)
        if not line.endswith("{") or not re.search(r"=> \{$|\)(?:: [^()]*)? \{$", line):
            continue
        first, head = open_heads.get(indent, (number, line))
        name = TYPESCRIPT_HEAD.match(head)[2] if TYPESCRIPT_HEAD.match(head) else "=>"
        if name == "describe" or name in KEYWORDS and "=> {" not in line:  # a suite is no function
            continue
        end = next((i for i, other in enumerate(lines[number:], number + 1)
                    if other.startswith(" " * indent + "}")), number)
        found.append((name, first, end - first + 1))
    return found
