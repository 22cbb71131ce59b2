"""What can go wrong."""


class RenderError(Exception):
    """Bad input: what, where, what was expected."""


class MissingPart(Exception):
    """A package or program that is not installed, and how to get it."""


class RenderFailure(Exception):
    """The browser or the encoder has failed."""
