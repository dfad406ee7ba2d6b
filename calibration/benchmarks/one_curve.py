"""One curve of the benchmarks as a command of its own."""
import sys
from pathlib import Path

from calibration import command, generated
from calibration.campaigns.runs import RunFailed


def main(curve):
    """python3 -m calibration.benchmarks.NAME DIR: curve(DIR) gives lines of Markdown, which go into DIR/NAME.md.

    Ends with 1 where a run failed, with 2 without a folder.
    """
    name = Path(sys.argv[0]).stem
    place = command.folder(f"calibration.benchmarks.{name}")
    try:
        lines = curve(place)
    except RunFailed as error:
        sys.exit(f"{name}: {error}")
    print(generated.write_page(place / f"{name}.md", lines))
