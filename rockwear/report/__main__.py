"""python3 -m rockwear.report FOLDER"""
import sys

from rockwear.report import write

if len(sys.argv) != 2:
    sys.exit("usage: python3 -m rockwear.report FOLDER")
try:
    print(write(sys.argv[1]))
except FileNotFoundError as error:
    sys.exit(f"error: {error.filename} is missing: not the folder of a run that has ended")
