"""Command lines of the subcommands that are Python's: a word that does not exist is reported with the nearest one, as
`hapticgiant` does for its own.
"""

from __future__ import annotations

import argparse
import difflib


def nearest(name: str, names) -> str:
    """Of these names the most similar one."""
    return max(names, key=lambda known: difflib.SequenceMatcher(None, name, known).ratio())


class Parser(argparse.ArgumentParser):
    """argparse's, with the nearest subcommand, option or choice."""

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
