"""The virtual laboratory and the measurements behind defaults."""
import importlib.util
import sys

if missing := [name for name in ("numpy", "scipy", "matplotlib") if not importlib.util.find_spec(name)]:
    print(f"error: {sys.executable} has no {', '.join(missing)}: use /usr/bin/python3, whose packages `make setup` "
          "installs", file=sys.stderr)
    sys.exit(2)
