"""Command lines of the subcommands that are Python's: a word that does not exist is an error with the nearest one, as
in `hapticgiant`; how they end.
"""

from __future__ import annotations

import argparse
import difflib
import os
import pathlib
import re
import sys

BAD_INPUT = 2  # exit code
INTERRUPTED = 130  # exit code after Ctrl-C


def nearest(name: str, names) -> str:
    """Of these names the most similar one."""
    return max(names, key=lambda known: difflib.SequenceMatcher(None, name, known).ratio())


def shipped_files() -> pathlib.Path | None:
    """The folder of docs/, examples/ and models/: of the sources, of a system package, or within this one."""
    package = pathlib.Path(__file__).resolve().parent
    found = (folder for folder in (package.parents[1], package / "share" / "hapticgiant") if (folder / "docs/start").is_dir())
    return next(found, None)


class Parser(argparse.ArgumentParser):
    """argparse's, with the nearest subcommand, option or choice, and where the files are that a help names."""

    def format_help(self):
        text = super().format_help()
        folder = shipped_files()
        if folder and re.search(r"\b(docs|examples|models)/", text):
            text += f"\nFiles that this names are in {folder}\n"
        return text

    def wrong(self, word: str, what: str, names) -> None:
        """Ends the program: this word is no such thing as these names."""
        self.exit(2, f"{word}: no such {what} of {self.prog}, did you mean '{nearest(word, names)}'?\n"
                     "Run with --help for more information.\n")

    def parse_known_args(self, args=None, namespace=None):
        found, rest = super().parse_known_args(args, namespace)
        option = next((word.partition("=")[0] for word in rest if word.startswith("-")), None)
        if option and self._subparsers is None:
            self.wrong(option, "option", self._option_string_actions)
        return found, rest

    def _check_value(self, action, value):
        if action.choices is None or value in action.choices:
            return
        if isinstance(action, argparse._SubParsersAction):
            self.wrong(value, "subcommand", action.choices)
        raise argparse.ArgumentError(action, f"expected {' or '.join(map(str, action.choices))}, got '{value}', did you "
                                             f"mean '{nearest(str(value), action.choices)}'?")


def whole_number(least: int):
    """For argparse: the type of whole numbers from this one on."""
    def whole(text):
        if not (text.isdigit() and int(text) >= least):
            raise argparse.ArgumentTypeError(f"expected a whole number from {least} on, got '{text}'")
        return int(text)
    return whole


def exit_code_of(name: str, call, bad_input: tuple[type[Exception], ...]) -> int:
    """The exit code that call() returns, of the subcommand of this name. Errors of the types bad_input, and of files, are
    printed and give 2; a reader of the output that has closed it is no error."""
    try:
        return call()
    except bad_input as error:
        print(error, file=sys.stderr)
        return BAD_INPUT
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except OSError as error:
        print(f"{name}: {error}", file=sys.stderr)
        return BAD_INPUT
