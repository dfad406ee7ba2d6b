"""Draw the report of a run again.

    python3 -m rockwear.report FOLDER

FOLDER is that of a run that has ended. Writes report.html and figures/ into it.
"""
import sys

from rockwear.report import write

if "--help" in sys.argv:
    print(__doc__.strip())
    sys.exit(0)
if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
    print("usage: python3 -m rockwear.report FOLDER", file=sys.stderr)
    sys.exit(2)
try:
    print(write(sys.argv[1]))
except (OSError, ValueError) as error:
    print(f"error: folder = {sys.argv[1]}: must be that of a run that has ended ({str(error).splitlines()[0]})",
          file=sys.stderr)
    sys.exit(2)
