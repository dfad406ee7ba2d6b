"""One curve of the benchmarks as a command of its own."""
import sys
from pathlib import Path

from calibration import command, generated
from calibration.campaigns.runs import RunFailed


def main(curve, *flags):
    """python3 -m calibration.benchmarks.NAME DIR [FLAGS]: curve(DIR) gives lines of Markdown, which go into
    DIR/NAME.md; curve(DIR, flag=True) where a flag --flag out of `flags` is given.

    Ends with 1 where a run failed, with 2 without a folder.
    """
    command.help_if_asked()
    name = Path(sys.argv[0]).stem
    usage = " ".join(["DIR", *(f"[{flag}]" for flag in flags)])
    (place,), given = command.split(sys.argv[1:], f"calibration.benchmarks.{name}", usage, known=flags)
    try:
        lines = curve(place, **{flag.removeprefix("--"): True for flag in given})
    except RunFailed as error:
        sys.exit(f"{name}: {error}")
    print(generated.write_page(place / f"{name}.md", lines))
