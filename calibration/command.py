"""Command lines: their usage, and words that are refused in one line, with exit code 2, before anything is made."""
import argparse
import sys
from pathlib import Path

from rockwear.kernels.checks import ParameterError


class Parser(argparse.ArgumentParser):
    """argparse's parser, which says what is wrong in one line and takes no part of an option for the whole."""

    def __init__(self, **options):
        super().__init__(allow_abbrev=False, **options)

    def error(self, message):
        print(f"error: {message} (--help says more)", file=sys.stderr)
        sys.exit(2)


def help_if_asked():
    """Where the command line asks for help, print the docstring of the command and end the program."""
    if {"--help", "-h"} & set(sys.argv[1:]):
        print(sys.modules["__main__"].__doc__.strip())
        sys.exit(0)


def split(words, name, usage, *, least=1, most=1, known=()):
    """([Path, ...], the other words) of a command line: at least and at most so many paths, and words out of `known`.

    name: of the module; usage: what may follow it. Ends the program where the words are of another form.
    """
    options = [word for word in words if word.startswith("-")]
    others = [word for word in words if not word.startswith("-")]
    paths, found = others[:most], [*others[most:], *options]
    unknown = [word for word in found if word not in known]
    if unknown or len(paths) < least:
        said = f" (unknown: {', '.join(unknown)})" if unknown else ""
        print(f"usage: python3 -m {name.removesuffix('.__main__')} {usage}{said}", file=sys.stderr)
        sys.exit(2)
    return [Path(path) for path in paths], found


def made(path, name="out"):
    """`path`, the folder that the parameter `name` gives, there from now on. Raises ParameterError."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ParameterError(name, str(path), f"a folder that can be written ({error.strerror})") from None
    return path


def folder(name, default=None):
    """Folder of the command line [DIR] of the module `name`; without a default it must be given."""
    help_if_asked()
    paths, _ = split(sys.argv[1:], name, "DIR" if default is None else "[DIR]", least=int(default is None))
    return paths[0] if paths else Path(default)
