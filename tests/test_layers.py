"""The house's layers: kernels know nothing of YADE or of the rooms above them; engines know kernels; scripts know scenes."""
import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
ALLOWED = {"kernels": {"kernels", "materials"}, "engines": {"engines", "kernels", "materials"}}


def imports(file):
    """Names of the modules that a file imports, our own by their path below rockwear."""
    package = file.relative_to(ROOT).with_suffix("").parts[:-1]
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = ".".join(package[:len(package) - node.level + 1]) if node.level else ""
            module = ".".join(filter(None, [base, node.module]))
            yield from ([module] if node.module else [f"{module}.{alias.name}" for alias in node.names])


@pytest.mark.parametrize("room", sorted(ALLOWED))
def test_rooms_import_only_what_lies_below(room):
    for file in sorted((ROOT / "rockwear" / room).glob("*.py")):
        for name in imports(file):
            parts = name.split(".")
            if parts[0] == "rockwear" and len(parts) > 1:
                assert parts[1] in ALLOWED[room], f"{file.name} imports {name}"
            if room == "kernels":
                assert parts[0] != "yade", f"{file.name} imports {name}"


def test_kernels_need_numpy_and_scipy_only():
    standard = {"ast", "collections", "csv", "dataclasses", "functools", "heapq", "math", "typing", "warnings"}
    for file in sorted((ROOT / "rockwear/kernels").glob("*.py")):
        for name in imports(file):
            assert name.split(".")[0] in standard | {"numpy", "scipy", "rockwear"}, f"{file.name} imports {name}"
